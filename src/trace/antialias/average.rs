//! The weighted mean of a pixel's samples within one pass, in double precision.

use crate::math::{DVec3, Vec3};
use crate::trace::PixelValue;
use crate::trace::{Sample, Wants};

#[derive(Clone, Debug, Default)]
pub(super) struct Average {
    wants: Wants,
    weight: f64,
    radiance: DVec3,
    direct: DVec3,
    reflection: DVec3,
    refraction: DVec3,
    caustic: DVec3,
    indirect: DVec3,
    photons: DVec3,
    photon_density: f64,
    albedo: DVec3,
    normal: DVec3,
    position: DVec3,
    depth: f64,
    /// Object identities are not averaged: the first sample's counts.
    object: Option<u32>,
}

impl Average {
    /// An empty mean; what is not wanted stays 0.
    pub fn of(wants: Wants) -> Average {
        Average { wants, ..Average::default() }
    }

    /// Adds a sample of which nothing but the radiance is wanted.
    #[inline]
    pub fn add_radiance(&mut self, radiance: Vec3, weight: f64) {
        self.weight += weight;
        self.radiance += radiance.as_dvec3() * weight;
    }

    #[inline]
    pub fn add(&mut self, sample: &Sample, weight: f64) {
        let scaled = |v: Vec3| v.as_dvec3() * weight;
        self.weight += weight;
        self.radiance += scaled(sample.radiance);
        if self.wants.split {
            self.direct += scaled(sample.direct);
            self.reflection += scaled(sample.reflection);
            self.refraction += scaled(sample.refraction);
            self.caustic += scaled(sample.caustic);
            self.indirect += scaled(sample.indirect);
        }
        if self.wants.photons {
            self.photons += scaled(sample.photons);
            self.photon_density += f64::from(sample.photon_density) * weight;
        }
        if !self.wants.first_hit {
            return;
        }
        self.albedo += scaled(sample.first.albedo);
        self.normal += scaled(sample.first.normal);
        self.position += scaled(sample.first.position);
        self.depth += f64::from(sample.first.depth) * weight;
        self.object.get_or_insert(sample.first.object);
    }

    /// The mean, of `samples` camera samples. `None` where nothing was added.
    pub fn value(&self, samples: u32) -> Option<PixelValue> {
        if self.weight <= 0.0 {
            return None;
        }
        let inverse = 1.0 / self.weight;
        Some(PixelValue {
            radiance: self.radiance * inverse,
            direct: self.direct * inverse,
            reflection: self.reflection * inverse,
            refraction: self.refraction * inverse,
            caustic: self.caustic * inverse,
            indirect: self.indirect * inverse,
            photons: self.photons * inverse,
            photon_density: self.photon_density * inverse,
            albedo: self.albedo * inverse,
            normal: self.normal * inverse,
            position: self.position * inverse,
            depth: self.depth * inverse,
            object: self.object.unwrap_or(0),
            samples,
            bias: None,
            pair: None,
        })
    }
}

//! The weighted mean of a pixel's samples within one pass, in double precision.

use crate::math::{Color, DVec3};
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

impl PixelValue {
    /// Becomes the value of a pixel of which nothing but the radiance is wanted.
    #[inline]
    pub(super) fn of_radiance(&mut self, radiance: DVec3, samples: u32) {
        (self.radiance, self.samples) = (radiance, samples);
        (self.bias, self.pair) = (None, None);
    }

    /// Becomes the value of a pixel with one sample: that of an [`Average`] of it. What is not wanted stays as
    /// it is.
    #[inline]
    pub(super) fn set(&mut self, sample: &Sample, wants: Wants) {
        let value = self;
        value.of_radiance(sample.radiance.as_dvec3(), 1);
        if wants.split {
            value.direct = sample.direct.as_dvec3();
            value.reflection = sample.reflection.as_dvec3();
            value.refraction = sample.refraction.as_dvec3();
            value.caustic = sample.caustic.as_dvec3();
            value.indirect = sample.indirect.as_dvec3();
        }
        if wants.photons {
            value.photons = sample.photons.as_dvec3();
            value.photon_density = f64::from(sample.photon_density);
        }
        if wants.first_hit {
            value.albedo = sample.first.albedo.as_dvec3();
            value.normal = sample.first.normal.as_dvec3();
            value.position = sample.first.position.as_dvec3();
            value.depth = f64::from(sample.first.depth);
            value.object = sample.first.object;
        }
    }
}

impl Average {
    /// An empty mean; what is not wanted stays 0.
    pub fn of(wants: Wants) -> Average {
        Average { wants, ..Average::default() }
    }

    #[inline]
    pub fn add(&mut self, sample: &Sample, weight: f64) {
        let scaled = |v: Color| v.as_dvec3() * weight;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::sample::FirstHit;

    #[test]
    fn the_value_of_one_sample_is_its_average() {
        let v = |x: f32| Color::new(x, 0.1 * x, -x);
        let first = FirstHit { albedo: v(7.0), normal: v(0.3), depth: 9.1, position: v(8.0), object: 4 };
        let sample = Sample {
            radiance: v(0.7),
            direct: v(1.1),
            reflection: v(2.3),
            refraction: v(3.7),
            caustic: v(4.9),
            indirect: v(5.3),
            photons: v(6.1),
            photon_density: 0.77,
            first,
        };
        for bits in 0..8 {
            let on = |bit: u32| bits >> bit & 1 == 1;
            let wants = Wants { split: on(0), photons: on(1), first_hit: on(2), ..Wants::default() };
            let mut average = Average::of(wants);
            average.add(&sample, 1.0);
            let mut value = PixelValue { pair: Some(DVec3::ONE), samples: 7, ..PixelValue::default() };
            value.set(&sample, wants);
            assert_eq!(Some(value), average.value(1));
        }
    }
}

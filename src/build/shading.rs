//! The material at a surface point: weights looked up, normal bent, sides told apart.

use super::footprint::{Cone, squared_reach, texture_point};
use super::{Surface, World};
use crate::math::{Color, DVec3};
use crate::optics::{
    Coordinates, Material, Relief, TextureId, TexturePoint, Weight, bumped_normal, perturbed_normal_from_map,
};

/// A surface point ready for shading. Both normals are turned to the side of `wo`.
pub struct Shading<'a> {
    pub material: &'a Material,
    pub wo: DVec3,
    pub ng: DVec3,
    pub ns: DVec3,
    pub kd: Color,
    pub ks: Color,
    pub km: Color,
    pub kt: Color,
    emission: Color,
}

impl<'a> Shading<'a> {
    pub fn new(world: &'a World, surface: &Surface, wo: DVec3, cone: &Cone) -> Shading<'a> {
        let mut shading = Shading::bare(world, surface, wo);
        shading.look_up(world, surface, cone);
        shading
    }

    /// What the material is without its textures: they count as white, and bend no normal. To be followed by
    /// [`Shading::look_up`]; apart from it, so that neither copies the other's result.
    #[inline(always)]
    pub fn bare(world: &'a World, surface: &Surface, wo: DVec3) -> Shading<'a> {
        let material = &world.materials[surface.material.0 as usize];
        let outside = wo.dot(surface.ng) >= 0.0;
        let turn = if outside { 1.0 } else { -1.0 };
        Shading {
            material,
            wo,
            ng: surface.ng * turn,
            ns: surface.ns * turn,
            kd: material.diffuse.factor(),
            ks: material.specular.factor(),
            km: material.reflection.factor(),
            kt: material.transmission.factor(),
            emission: if outside || material.emits_back { material.emission.factor() } else { Color::ZERO },
        }
    }

    /// Looks up what textures say.
    #[inline(always)]
    pub fn look_up(&mut self, world: &World, surface: &Surface, cone: &Cone) {
        if self.material.textured {
            self.look_up_textures(world, surface, cone);
        }
    }

    #[inline(never)]
    fn look_up_textures(&mut self, world: &World, surface: &Surface, cone: &Cone) {
        let outside = self.wo.dot(surface.ng) >= 0.0;
        let material = self.material;
        let scale = world.instances[surface.instance as usize].placement.scale();
        let coordinates = world.coordinates(surface);
        let wo = self.wo;
        let reach2 = squared_reach(surface, &coordinates, wo, cone);
        let mut found = None;
        let mut point =
            || *found.get_or_insert_with(|| texture_point(surface, &coordinates, scale, wo, cone));
        let mut look = |id: TextureId, factor: Color| {
            let texture = &world.textures[id.0 as usize];
            factor * texture.color_within(coordinates.uv, reach2).unwrap_or_else(|| texture.color(&point()))
        };
        if let Weight::Texture(id, factor) = material.diffuse {
            self.kd = look(id, factor);
        }
        if let Weight::Texture(id, factor) = material.specular {
            self.ks = look(id, factor);
        }
        if let Weight::Texture(id, factor) = material.reflection {
            self.km = look(id, factor);
        }
        if let Weight::Texture(id, factor) = material.transmission {
            self.kt = look(id, factor);
        }
        if let Weight::Texture(id, factor) = material.emission
            && (outside || material.emits_back)
        {
            self.emission = look(id, factor);
        }
        if !material.relief.is_empty() {
            self.ns = bent_normal(world, material, surface, &coordinates, &point())
                * if outside { 1.0 } else { -1.0 };
        }
    }

    /// The same for a photon, which needs to know how it goes on, and the colours of what shades only where that
    /// `scatters` it: they are left at 0 elsewhere, and the normal as it is without relief.
    #[inline(always)]
    pub fn look_up_for_photon(&mut self, world: &World, surface: &Surface, scatters: bool) {
        if self.material.textured {
            self.look_up_textures_for_photon(world, surface, scatters);
        }
    }

    #[inline(never)]
    fn look_up_textures_for_photon(&mut self, world: &World, surface: &Surface, scatters: bool) {
        if scatters || self.material.specular_somewhere() {
            return self.look_up_textures(world, surface, &Cone { width: 0.0, spread: 0.0 });
        }
        (self.kd, self.ks, self.km, self.kt) = (Color::ZERO, Color::ZERO, Color::ZERO, Color::ZERO);
        self.emission = Color::ZERO;
    }

    /// For a photon: see [`Shading::look_up_for_photon`].
    #[inline(always)]
    pub fn of_photon(world: &'a World, surface: &Surface, wo: DVec3, scatters: bool) -> Shading<'a> {
        let mut shading = Shading::bare(world, surface, wo);
        shading.look_up_for_photon(world, surface, scatters);
        shading
    }

    /// Whether photons are stored here, on the side of `wo`. Where a texture is black, too: photons around such a
    /// place tell what arrives beside it.
    pub fn keeps_photons(&self) -> bool {
        let rest = (Color::ONE - self.km) * (Color::ONE - self.kt);
        let receives = self.material.shades() && (rest != Color::ZERO || !self.material.specular.is_zero());
        receives && self.wo.dot(self.ng) > 0.0
    }

    /// Radiance that the surface itself sends towards `wo`.
    pub fn emitted(&self) -> Color {
        self.emission
    }
}

/// The shading normal after bump and normal maps, in the hemisphere of the geometric one.
fn bent_normal(
    world: &World,
    material: &Material,
    surface: &Surface,
    coordinates: &Coordinates,
    point: &TexturePoint,
) -> DVec3 {
    let (mut ns, &Coordinates { dpdu, dpdv, .. }) = (surface.ns, coordinates);
    for relief in &material.relief {
        ns = match *relief {
            Relief::NormalMap { texture, strength } => {
                let rgb = world.textures[texture.0 as usize].color(point);
                perturbed_normal_from_map(rgb, strength, ns, dpdu, dpdv)
            }
            Relief::BumpMap { texture, height } => {
                let slope = world.textures[texture.0 as usize].slope(point, dpdu, dpdv);
                bumped_normal(slope * height, ns, surface.ng, dpdu, dpdv)
            }
        };
    }
    if ns.dot(surface.ng) > 0.0 { ns } else { surface.ns }
}

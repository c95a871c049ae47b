//! Textures are loaded, materials resolved. What no object's material names is not loaded.

use super::BuildError;
use super::examine::Findings;
use super::images::{Images, Limits, TextureUse};
use crate::description::{
    self, Dispersion, Ior, Kind, Material as Described, NAMED_IOR, Place, Scene, Severity, Source,
    used_materials,
};
use crate::math::Color;
use crate::optics::{Cauchy, Material, MaterialId, Relief, Texture, TextureId, Weight};
use crate::plan::{Effect, Plan};
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// The scene's textures and materials.
pub(super) struct Surfaces {
    pub textures: Vec<Texture>,
    pub materials: Vec<Material>,
    pub material_names: Vec<String>,
    ids: HashMap<String, MaterialId>,
    /// The image files that were read, for the environment to read from too.
    pub images: Images,
}

pub(super) fn rgb(c: &description::Rgb) -> Color {
    Color::new(c.0[0] as f32, c.0[1] as f32, c.0[2] as f32)
}

impl Surfaces {
    pub fn load(scene: &Scene, plan: &Plan) -> Result<Surfaces, BuildError> {
        let used = used_materials(scene);
        let images = Images::new(Path::new(""), Limits::default()).within(&scene.reach);
        let flat = plan.leaves_out(Effect::Textures);
        let mut textures = Textures { scene, flat, list: Vec::new(), ids: HashMap::new(), images };
        let (mut materials, mut material_names, mut ids) = (Vec::new(), Vec::new(), HashMap::new());
        for (name, described) in scene.materials.iter().filter(|(name, _)| used.contains(name)) {
            let mut material = textures.material(described)?;
            material.textured |= plan.forced();
            material.patchy = material.is_patchy(&textures.list);
            check_energy(name, &material, &textures.list)?;
            ids.insert(name.to_owned(), MaterialId(materials.len() as u32));
            materials.push(material);
            material_names.push(name.to_owned());
        }
        Ok(Surfaces { textures: textures.list, materials, material_names, ids, images: textures.images })
    }

    /// What is wrong with the images that used materials name, and with what these make of them; gives
    /// back the images.
    pub fn examine(scene: &Scene, findings: &mut Findings) -> Images {
        let used = used_materials(scene);
        let images = Images::new(Path::new(""), Limits::default()).within(&scene.reach);
        let mut textures = Textures { scene, flat: false, list: Vec::new(), ids: HashMap::new(), images };
        let mut broken = HashSet::new();
        for (name, described) in scene.materials.iter().filter(|(name, _)| used.contains(name)) {
            for (texture, usage) in named_textures(described) {
                let known = textures.images.warnings().len();
                let read = textures.id(texture, usage).map(drop);
                let place = Place::image_texture(texture);
                if !findings.image(&place, &read, &textures.images.warnings()[known..]) {
                    broken.insert(texture);
                }
            }
            if named_textures(described).any(|(texture, _)| broken.contains(texture)) {
                continue;
            }
            let material = textures.material(described);
            if let Err(error) = material.and_then(|m| check_energy(name, &m, &textures.list)) {
                let place = Place::of("materials").key(name);
                findings.add(Severity::Error, Kind::Invalid, &place, error.to_string());
            }
        }
        textures.images
    }

    pub fn id(&self, name: &str) -> Result<MaterialId, BuildError> {
        self.ids
            .get(name)
            .copied()
            .ok_or_else(|| BuildError::Invalid(format!("no material is named `{name}`")))
    }

    /// A material that only emits, for the light `name` with an extent.
    pub fn add_light(&mut self, name: &str, radiance: Color, emits_back: bool) -> MaterialId {
        self.material_names.push(name.to_owned());
        self.materials.push(Material {
            diffuse: Weight::ZERO,
            specular: Weight::ZERO,
            shininess: 1.0,
            reflection: Weight::ZERO,
            transmission: Weight::ZERO,
            ior: Cauchy::VACUUM,
            absorption: Color::ZERO,
            priority: 0,
            emission: Weight::Constant(radiance),
            emits_back,
            relief: Vec::new(),
            textured: false,
            patchy: false,
        });
        MaterialId(self.materials.len() as u32 - 1)
    }
}

/// The textures that a material names.
fn named_textures(m: &Described) -> impl Iterator<Item = (&str, TextureUse)> {
    let weights = [&m.diffuse, &m.specular, &m.reflection, &m.transmission, &m.emission];
    let colours = weights.into_iter().filter_map(Source::texture).map(|t| t.name.as_str());
    let maps = [m.bump_map.as_ref().map(|map| &map.texture), m.normal_map.as_ref().map(|map| &map.texture)];
    let data = maps.into_iter().flatten().map(String::as_str);
    colours.map(|name| (name, TextureUse::Color)).chain(data.map(|name| (name, TextureUse::Data)))
}

/// Textures are loaded when a material first names them.
struct Textures<'a> {
    scene: &'a Scene,
    /// Whether weights take each texture's mean in its place.
    flat: bool,
    list: Vec<Texture>,
    /// By name and by what its numbers are used for.
    ids: HashMap<(String, TextureUse), TextureId>,
    images: Images,
}

impl<'a> Textures<'a> {
    fn id(&mut self, name: &str, usage: TextureUse) -> Result<TextureId, BuildError> {
        if let Some(&id) = self.ids.get(&(name.to_owned(), usage)) {
            return Ok(id);
        }
        let texture = self.images.texture(self.described(name)?, usage)?;
        let id = TextureId(self.list.len() as u32);
        self.list.push(texture);
        self.ids.insert((name.to_owned(), usage), id);
        Ok(id)
    }

    /// The mean colour of a texture, which is not kept.
    fn mean(&mut self, name: &str) -> Result<Color, BuildError> {
        Ok(self.images.texture(self.described(name)?, TextureUse::Color)?.mean())
    }

    fn described(&self, name: &str) -> Result<&'a description::Texture, BuildError> {
        let scene = self.scene;
        scene.textures.get(name).ok_or_else(|| BuildError::Invalid(format!("no texture is named `{name}`")))
    }

    fn weight(&mut self, source: &Source) -> Result<Weight, BuildError> {
        Ok(match source {
            Source::Constant(c) => Weight::Constant(rgb(c)),
            Source::Texture(t) if self.flat => Weight::Constant(self.mean(&t.name)? * rgb(&t.scale)),
            Source::Texture(t) => Weight::Texture(self.id(&t.name, TextureUse::Color)?, rgb(&t.scale)),
        })
    }

    fn material(&mut self, m: &Described) -> Result<Material, BuildError> {
        let mut relief = Vec::new();
        if let Some(map) = &m.bump_map {
            relief.push(Relief::BumpMap {
                texture: self.id(&map.texture, TextureUse::Data)?,
                height: map.height_m,
            });
        }
        if let Some(map) = &m.normal_map {
            relief.push(Relief::NormalMap {
                texture: self.id(&map.texture, TextureUse::Data)?,
                strength: map.strength,
            });
        }
        let weights = [&m.diffuse, &m.specular, &m.reflection, &m.transmission, &m.emission];
        let [diffuse, specular, reflection, transmission, emission] = weights.map(|w| self.weight(w));
        let material = Material {
            diffuse: diffuse?,
            specular: specular?,
            shininess: m.shininess.unwrap_or(50.0),
            reflection: reflection?,
            transmission: transmission?,
            ior: dispersed(ior(m.ior.as_ref())?, m.dispersion),
            absorption: rgb(&m.absorption),
            priority: m.priority,
            emission: emission?,
            emits_back: true,
            relief,
            textured: false,
            patchy: false,
        };
        let textured = !material.relief.is_empty()
            || [
                material.diffuse,
                material.specular,
                material.reflection,
                material.transmission,
                material.emission,
            ]
            .iter()
            .any(Weight::textured);
        Ok(Material { textured, ..material })
    }
}

fn ior(described: Option<&Ior>) -> Result<f64, BuildError> {
    match described {
        None => Ok(1.5),
        Some(Ior::Number(n)) => Ok(*n),
        Some(Ior::Name(name)) => NAMED_IOR
            .iter()
            .find(|(known, _)| known == name)
            .map(|&(_, n)| n)
            .ok_or_else(|| BuildError::Invalid(format!("no index of refraction is named `{name}`"))),
    }
}

fn dispersed(ior: f64, dispersion: Option<Dispersion>) -> Cauchy {
    match dispersion {
        None => Cauchy::new(ior, 0.0),
        Some(Dispersion::Abbe(abbe)) => Cauchy::from_abbe(ior, abbe),
        Some(Dispersion::Cauchy(b)) => Cauchy::new(ior, b),
    }
}

/// Refuses what could send back more light than it gets: km + (1−km)(kt + (1−kt)·kd) + ks > 1 for the
/// brightest texels. Constants were checked with the scene.
fn check_energy(name: &str, m: &Material, textures: &[Texture]) -> Result<(), BuildError> {
    let [kd, ks, km, kt] = [m.diffuse, m.specular, m.reflection, m.transmission].map(|w| w.bound(textures));
    let one = Color::ONE;
    let total = (km + (one - km) * (kt + (one - kt) * kd) + ks).max_element();
    // Room for the rounding of sums such as 0.8 + 0.2 and of texels that stand for 1.
    if total <= 1.0 + 1e-5 {
        return Ok(());
    }
    Err(BuildError::Invalid(format!(
        "material `{name}` can send back {total:.3} of the light that it gets (reflection + (1 − reflection)·\
         (transmission + (1 − transmission)·diffuse) + specular, at the brightest texels); lower `specular`, or \
         scale a texture: texture(name: …, scale: {:.2})",
        (1.0 / total * 100.0).floor() / 100.0
    )))
}

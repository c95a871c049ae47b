//! The whole scene: the root of every scene file.

use super::{
    Animation, Antialiasing, Camera, Image, Indirect, IndirectBy, Light, Material, NameMap, Object, Photons,
    Reach, Render, Rgb, Texture,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A scene. Only `camera` has no default, and a file that is only included may leave it out too.
///
/// ```ron
/// include: ["lib/glasses.ron"],
/// camera: (eye: (0, 1, 5), target: (0, 1, 0)),
/// background: (0.2, 0.3, 0.5),
/// ambient: 0.05
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Scene {
    /// Scene files whose textures, materials, definitions, lights and objects are taken in; paths
    /// relative to this file.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub include: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera: Option<Camera>,
    /// What changes from frame to frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub animation: Option<Animation>,
    pub image: Image,
    pub antialiasing: Antialiasing,
    pub render: Render,
    /// Caustics: light focused by glass, water and mirrors.
    #[serde(skip_serializing_if = "Photons::is_default")]
    pub photons: Photons,
    /// Light that bounces between diffuse surfaces.
    #[serde(skip_serializing_if = "Indirect::is_off")]
    pub indirect: Indirect,
    /// How that light is found.
    #[serde(skip_serializing_if = "IndirectBy::is_default")]
    pub indirect_by: IndirectBy,
    /// Radiance seen by eye rays that leave the scene where no environment light shines. Lights nothing.
    pub background: Rgb,
    /// Classic constant ambient radiance: every diffuse surface reflects `diffuse · ambient`.
    pub ambient: Rgb,
    #[serde(skip_serializing_if = "NameMap::is_empty")]
    pub textures: NameMap<Texture>,
    #[serde(skip_serializing_if = "NameMap::is_empty")]
    pub materials: NameMap<Material>,
    #[serde(skip_serializing_if = "NameMap::is_empty")]
    pub lights: NameMap<Light>,
    /// Objects that are not placed by themselves: `instance` and `scatter` name them.
    #[serde(skip_serializing_if = "NameMap::is_empty")]
    pub definitions: NameMap<Object>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub objects: Vec<Object>,
    /// The files that may be read for it: its reader's decision.
    #[serde(skip)]
    pub reach: Reach,
}

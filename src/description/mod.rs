//! What a scene file says: plain data with defaults, in the file's own units and names.
//!
//! The same types read RON and TOML. Nothing here knows how to trace a ray: `build` translates a
//! checked description into the runtime world. Lengths are metres, angles degrees, colours linear
//! Rec. 709; point and spot lights are given in W/sr, emitting surfaces in W·m⁻²·sr⁻¹ and
//! directional light in W·m⁻².

mod camera;
mod light;
mod material;
mod names;
mod object;
mod scene;
mod settings;
mod texture;
mod transform;
mod value;

pub use camera::Camera;
pub use light::{EnvironmentMap, Light};
pub use material::{BumpMap, Ior, Material, NAMED_IOR, NormalMap};
pub use names::NameMap;
pub use object::{Object, Polyhedron, Scatter, Shape, Smooth};
pub use scene::Scene;
pub use settings::{Antialiasing, Image, Render};
pub use texture::{ColorSpace, Texture, UvMapping, Wrap};
pub use transform::{Scale, Transform};
pub use value::{Rgb, Source, TextureRef, Vector};

mod stub;
pub use stub::{Diagnostic, Format, Loaded, Report, Severity, json_schema, load, load_str, to_string};

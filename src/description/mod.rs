//! What a scene file says: plain data with defaults, in the file's own units and names.
//!
//! The same types read RON and TOML. Nothing here knows how to trace a ray: `build` translates a
//! checked description into the runtime world. Lengths are metres, angles degrees, colours linear
//! Rec. 709; point and spot lights are given in W/sr, emitting surfaces in W·m⁻²·sr⁻¹ and
//! directional light in W·m⁻².

mod animation;
mod assets;
mod camera;
mod check;
mod convert;
mod diagnostic;
mod dispersion;
mod instances;
mod light;
mod material;
mod names;
mod nature;
mod object;
mod photons;
mod placed;
mod places;
mod reach;
mod read;
mod scene;
mod schema;
mod settings;
mod simple;
mod source;
mod suggest;
mod terms;
mod texture;
mod track;
mod transform;
mod tree;
mod value;

pub use animation::{Animation, Key, KeyValue, Orbit, Track};
pub use camera::Camera;
pub use convert::{NotWritable, to_string};
pub use diagnostic::{Diagnostic, Finding, Kind, Report, Severity};
pub use dispersion::Dispersion;
pub use instances::{Instances, MAX_INSTANCES};
pub use light::{EnvironmentMap, Light};
pub use material::{BumpMap, Ior, Material, NAMED_IOR, NormalMap};
pub use names::NameMap;
pub use object::{Object, Polyhedron, Scatter, Shape, Smooth};
pub use photons::{Indirect, IndirectBy, Kernel, Photons};
pub use placed::{MAX_NESTING, used_materials};
pub(crate) use placed::{Use, uses};
pub use reach::{PROJECT_MARK, Reach};
pub use read::{Format, Loaded, load, load_as_written, load_on, load_str, load_str_as_written, load_str_on};
pub use scene::Scene;
pub use schema::json_schema;
pub use settings::{Antialiasing, Image, Render};
pub(crate) use suggest::{listed, question};
pub use terms::{Terms, Unread};
pub use texture::{ColorSpace, Texture, UvMapping, Wrap};
pub use transform::{Scale, Transform};
pub use tree::Path as Place;
pub use value::{Rgb, Source, TextureRef, Vector};

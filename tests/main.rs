//! All tests of the program and library as a user sees them, in one binary: linking is most of what
//! a test file costs. `cargo test --release --test all render::light` runs one theme.

#[path = "accuracy/main.rs"]
mod accuracy;
mod assets;
#[path = "batch/main.rs"]
mod batch;
mod command_line;
#[path = "corpus/main.rs"]
mod corpus;
#[path = "diff/main.rs"]
mod diff;
mod forecast;
mod frames;
mod gallery;
mod guide;
#[path = "hard_cases/mod.rs"]
mod hard_cases;
mod health;
mod layers;
mod makefile;
#[path = "messages/main.rs"]
mod messages;
#[path = "obj/main.rs"]
mod obj;
mod output;
#[path = "pairs/main.rs"]
mod pairs;
mod paths;
#[path = "photons/main.rs"]
mod photons;
#[path = "plan/main.rs"]
mod plan;
#[path = "properties/main.rs"]
mod properties;
#[path = "render/main.rs"]
mod render;
mod replay;
#[path = "scene_files/main.rs"]
mod scene_files;
mod shapes;
#[path = "study/main.rs"]
mod study;
mod textures;
mod watching;

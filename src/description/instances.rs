//! How many instances a scene places, told before any is made: definitions of groups and scatters multiply.

use super::{MAX_NESTING, Object, Scene, Shape};
use std::collections::HashMap;

/// Instances of a scene at most: indices are 32 bits, and each takes some 300 bytes.
pub const MAX_INSTANCES: usize = 50_000_000;

/// Counts of a scene's definitions. Definitions must not contain themselves, and all must be there.
pub struct Instances<'a> {
    scene: &'a Scene,
    known: HashMap<&'a str, f64>,
    nesting: u32,
}

impl<'a> Instances<'a> {
    pub fn of(scene: &'a Scene) -> Instances<'a> {
        Instances { scene, known: HashMap::new(), nesting: 0 }
    }

    /// Of all objects.
    pub fn all(mut self) -> f64 {
        self.scene.objects.iter().map(|object| self.least(object)).sum()
    }

    /// Instances that an object places at least: a scatter may choose the smallest of its definitions each time.
    pub fn least(&mut self, object: &'a Object) -> f64 {
        // What is nested deeper is refused when it is built.
        if self.nesting > MAX_NESTING {
            return 0.0;
        }
        self.nesting += 1;
        let least = match &object.shape {
            Shape::Group { objects } => objects.iter().map(|object| self.least(object)).sum(),
            Shape::Instance { of } => self.of_definition(of),
            Shape::Scatter(scatter) => {
                let each = scatter.of.iter().map(|of| self.of_definition(of)).fold(f64::INFINITY, f64::min);
                f64::from(scatter.count) * if each.is_finite() { each } else { 0.0 }
            }
            _ => 1.0,
        };
        self.nesting -= 1;
        least
    }

    fn of_definition(&mut self, name: &'a str) -> f64 {
        if let Some(&known) = self.known.get(name) {
            return known;
        }
        let scene = self.scene;
        let count = scene.definitions.get(name).map_or(0.0, |object| self.least(object));
        self.known.insert(name, count);
        count
    }
}

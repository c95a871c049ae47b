//! Which media overlap, by their bounds.

use crate::build::World;
use crate::math::Aabb;
use crate::plan::Decision;
use serde::Serialize;
use std::collections::BTreeSet;

/// Pairs of objects that transmit and whose bounds overlap.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Nested {
    /// Names, each pair once, in the order of the scene.
    pub pairs: Vec<[String; 2]>,
    /// Whether there may be more than were looked at.
    pub more: bool,
}

/// Comparisons after which no further pair is looked for.
const MOST: usize = 200_000;

impl Nested {
    pub(super) fn find(world: &World) -> Nested {
        let mut media: Vec<(u32, Aabb)> = world
            .media
            .iter()
            .map(|m| {
                let placement = &world.instances[m.instance as usize].placement;
                (m.instance, World::placed_bounds(world.geometry(m.instance), placement))
            })
            .filter(|(_, bounds)| !bounds.is_empty())
            .collect();
        // A sweep along x.
        media.sort_by(|a, b| a.1.min.x.total_cmp(&b.1.min.x));
        let (mut objects, mut left) = (BTreeSet::new(), MOST);
        'sweep: for (k, (i, a)) in media.iter().enumerate() {
            for (j, b) in media[k + 1..].iter().take_while(|(_, b)| b.min.x <= a.max.x) {
                if left == 0 {
                    break 'sweep;
                }
                left -= 1;
                if a.overlaps(b) {
                    let of = |instance: u32| world.instances[instance as usize].object;
                    objects.insert((of(*i).min(of(*j)), of(*i).max(of(*j))));
                }
            }
        }
        let name = |object: u32| world.object_names[object as usize].clone();
        Nested { pairs: objects.into_iter().map(|(a, b)| [name(a), name(b)]).collect(), more: left == 0 }
    }

    pub(super) fn refined(&self, decision: &Decision) -> Decision {
        let told = |[a, b]: &[String; 2]| {
            if a == b {
                format!("bounds of copies within `{a}` overlap")
            } else {
                format!("the bounds of `{a}` and `{b}` overlap")
            }
        };
        let reason = match self.pairs.as_slice() {
            [] => "no two objects that transmit overlap, not even by their bounds".to_owned(),
            [one] => told(one),
            [one, _] => format!("{}; and 1 more pair", told(one)),
            [one, rest @ ..] => format!("{}; and {} more pairs", told(one), rest.len()),
        };
        Decision { on: !self.pairs.is_empty(), reason, ..decision.clone() }
    }
}

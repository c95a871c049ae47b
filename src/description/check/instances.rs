//! How many instances are placed.

use super::Checker;
use super::objects::list;
use crate::description::{Instances, MAX_INSTANCES};

/// Refuses what places too many instances; of a scene whose references are sound.
pub(super) fn check(c: &mut Checker) {
    let (mut instances, mut sum) = (Instances::of(c.scene), 0.0);
    for (i, object) in c.scene.objects.iter().enumerate() {
        let here = instances.least(object);
        sum += here;
        if sum > MAX_INSTANCES as f64 {
            let others = if sum > here { format!(", {sum} with those before it") } else { String::new() };
            let message =
                format!("places {here} instances at least{others}: a scene has {MAX_INSTANCES} at most");
            c.error(&list().index(i), message);
            return;
        }
    }
}

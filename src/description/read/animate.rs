//! The frame of an animation: values at its keys' places, put into the tree before it is typed, so that
//! the same types and checks judge them; then the camera on its orbit.

use super::{Reading, set};
use crate::description::animation::{Animation, KeyValue, Orbit};
use crate::description::diagnostic::{Kind, Report, Severity};
use crate::description::tree::{Index, Node, Path, Span, Value};
use crate::description::{Camera, Vector};
use glam::DVec3;

/// Puts the values of a frame into `root`. Mistakes are reported; an animation in which some have been
/// reported already is left alone.
pub(super) fn apply(reading: &mut Reading, root: &mut Node, animation: &Animation, frame: u32) {
    let place = Path::of("animation");
    if root.entry("animation").is_some_and(|entry| has_hole(&entry.node)) {
        return;
    }
    let mut mistakes = settings(animation, frame);
    let mut edits = Vec::new();
    let index = Index::new(root);
    for (path, track) in animation.keys.iter().take(Animation::MOST_TRACKS) {
        let list = place.key("keys").key(path).key(track.kind());
        match track.odd_frames().map_or_else(|| track.at(frame), Err) {
            Ok(value) => {
                let before = list.index(track.before(frame)).key("value");
                edits.push((path, node(&value, index.find(&before).node.span)));
            }
            Err(odd) => mistakes.push((list.index(odd.key), odd.message.to_owned())),
        }
    }
    for (path, value) in edits {
        let keys = root.entry("animation").and_then(|animation| animation.node.entry("keys"));
        let key = keys.and_then(|keys| keys.node.entry(path)).map_or(value.span, |entry| entry.key_span);
        if let Err((_, message)) = set::put_at(root, path, key, value) {
            mistakes.push((place.key("keys").key(path), message));
        }
    }
    for (place, message) in mistakes.into_iter().take(Report::MOST) {
        let at = span(root, &place);
        let mut diagnostic = reading.sources.diagnostic(Severity::Error, Kind::Invalid, at, message);
        diagnostic.path = Some(place.to_string());
        reading.diagnostics.push(diagnostic);
    }
}

/// An override of a value that has keys does nothing: they are put after it.
pub(super) fn warn_of_overrides(
    reading: &mut Reading,
    root: &Node,
    animation: &Animation,
    overrides: &[String],
) {
    let within = |inner: &str, outer: &str| {
        inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    for path in overrides.iter().filter_map(|argument| Some(argument.split_once('=')?.0.trim())) {
        let Some(track) = animation.keys.names().find(|track| within(path, track) || within(track, path))
        else {
            continue;
        };
        let place = Path::of("animation").key("keys").key(track);
        let message = format!("`{track}` has keys, which replace what `--set {path}=…` says");
        let at = span(root, &place);
        let mut diagnostic = reading.sources.diagnostic(Severity::Warning, Kind::Invalid, at, message);
        diagnostic.path = Some(place.to_string());
        reading.diagnostics.push(diagnostic);
    }
}

/// What is wrong with all but the keys.
fn settings(animation: &Animation, frame: u32) -> Vec<(Path, String)> {
    let place = Path::of("animation");
    let mut mistakes = Vec::new();
    let most = Animation::MOST_FRAMES;
    if !(1..=most).contains(&animation.frames) {
        mistakes.push((place.key("frames"), format!("{} is outside [1, {most}]", animation.frames)));
    } else if !(1..=animation.frames).contains(&frame) {
        let message = format!("there is no frame {frame}: they are numbered from 1 to {}", animation.frames);
        mistakes.push((place.key("frames"), message));
    }
    if animation.fps <= 0.0 {
        mistakes.push((place.key("fps"), format!("{} is not above 0", animation.fps)));
    }
    if animation.keys.len() > Animation::MOST_TRACKS {
        let message = format!("more than {} values with keys are not read", Animation::MOST_TRACKS);
        mistakes.push((place.key("keys"), message));
    }
    if let Some(orbit) = &animation.orbit
        && DVec3::from(orbit.axis).try_normalize().is_none()
    {
        mistakes.push((place.key("orbit").key("axis"), "this is no direction".to_owned()));
    }
    mistakes
}

/// Whether something in it was wrong and has been reported.
fn has_hole(node: &Node) -> bool {
    match &node.value {
        Value::Hole => true,
        Value::Seq(items) => items.iter().any(has_hole),
        Value::Map(entries, _) => entries.iter().any(|entry| has_hole(&entry.node)),
        Value::Tagged(_, _, content) => has_hole(content),
        _ => false,
    }
}

fn span(root: &Node, place: &Path) -> Span {
    Index::new(root).find(place).node.span
}

fn node(value: &KeyValue, span: Span) -> Node {
    let value = match value {
        KeyValue::Number(x) if x.fract() == 0.0 && x.abs() < WHOLE => Value::Int(*x as i128),
        KeyValue::Number(x) => Value::Float(*x),
        KeyValue::List(items) => Value::Seq(items.iter().map(|item| node(item, span)).collect()),
        KeyValue::Flag(flag) => Value::Bool(*flag),
        // a name, or a word of the scene's types
        KeyValue::Text(text) => Value::Bare(text.clone()),
    };
    Node { value, span }
}

/// Whole numbers below 2⁵³ are exact; a zero's sign means nothing.
const WHOLE: f64 = 9_007_199_254_740_992.0;

/// The camera of a frame.
pub(super) fn orbit(camera: &mut Camera, orbit: &Orbit, frame: u32, frames: u32) {
    // exact at whole turns, where nothing may change
    let deg = (orbit.deg * f64::from(frame.saturating_sub(1)) / f64::from(frames.max(1))) % 360.0;
    let Some(axis) = DVec3::from(orbit.axis).try_normalize().filter(|_| deg != 0.0) else { return };
    let center = DVec3::from(orbit.center.unwrap_or(camera.target));
    let (sin, cos) = libm::sincos(deg.to_radians());
    // Rodrigues 1840, as what is added to the vector
    let turned = |v: DVec3| v + sin * axis.cross(v) + (1.0 - cos) * axis.cross(axis.cross(v));
    let around = |p: Vector| {
        let from = DVec3::from(p) - center;
        (DVec3::from(p) + (turned(from) - from)).to_array()
    };
    camera.eye = around(camera.eye);
    camera.target = around(camera.target);
    camera.up = turned(DVec3::from(camera.up)).to_array();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_orbit_keeps_distances_and_starts_and_ends_where_the_camera_is() {
        let camera = Camera {
            eye: [0.3, 0.46, 1.02],
            target: [0.025, 0.148, 0.0],
            up: [0.0, 1.0, 0.0],
            fov_deg: 20.0,
            aperture_m: 0.0,
            focus_m: None,
        };
        let distance = |c: &Camera| DVec3::from(c.eye).distance(DVec3::from(c.target));
        for (center, axis, deg) in [
            (None, [0.0, 1.0, 0.0], 360.0),
            (Some([1.0, 2.0, 3.0]), [0.0, 2.0, 0.0], -720.0),
            (Some([0.0; 3]), [1.0, 2.0, 3.0], 360.0),
        ] {
            let turn = Orbit { center, axis, deg };
            for frame in 1..=48 {
                let mut turned = camera.clone();
                orbit(&mut turned, &turn, frame, 48);
                assert!((distance(&turned) - distance(&camera)).abs() < 1e-14);
                let whole = (deg / 48.0 * f64::from(frame - 1)) % 360.0 == 0.0;
                assert_eq!(turned == camera, whole, "{frame}");
            }
        }
        // a quarter to the right-handed side: from +z to +x
        let mut side = Camera { eye: [0.0, 0.0, 2.0], target: [0.0; 3], ..camera };
        orbit(&mut side, &Orbit { center: None, axis: [0.0, 1.0, 0.0], deg: 90.0 }, 2, 1);
        assert!(DVec3::from(side.eye).distance(DVec3::new(2.0, 0.0, 0.0)) < 1e-15, "{:?}", side.eye);
    }
}

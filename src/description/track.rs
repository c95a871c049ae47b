//! The value of a track at a frame.
//!
//! `smooth` is the monotone cubic through the keys (Fritsch & Carlson, Monotone Piecewise Cubic
//! Interpolation, SIAM J. Numer. Anal. 17(2), 1980, with the weighted harmonic mean of Fritsch &
//! Butland, SIAM J. Sci. Stat. Comput. 5(2), 1984), at rest at both ends: a value stays between its two
//! keys, so what is valid at the keys is valid everywhere.

use super::animation::{KeyValue, Track};

/// Why a track has no value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Odd {
    /// The first key that does not fit, from 0.
    pub key: usize,
    pub message: &'static str,
}

impl Track {
    /// The keys' frames must ascend.
    pub(crate) fn odd_frames(&self) -> Option<Odd> {
        let keys = self.keys();
        if keys.is_empty() {
            return Some(Odd { key: 0, message: "a value needs at least one key" });
        }
        let later = (1..keys.len()).find(|&i| keys[i].frame <= keys[i - 1].frame)?;
        Some(Odd { key: later, message: "keys stand in the order of their frames, each frame once" })
    }

    /// The value at a frame, of keys whose frames ascend.
    pub(crate) fn at(&self, frame: u32) -> Result<KeyValue, Odd> {
        let keys = self.keys();
        let before = self.before(frame);
        if let Track::Step(_) = self {
            return Ok(keys[before].value.clone());
        }
        let curve = Curve {
            frames: keys.iter().map(|key| f64::from(key.frame)).collect(),
            smooth: matches!(self, Track::Smooth(_)),
            x: f64::from(frame),
            before,
        };
        curve.value(&keys.iter().map(|key| &key.value).collect::<Vec<_>>())
    }

    /// The last key up to a frame, or the first.
    pub(crate) fn before(&self, frame: u32) -> usize {
        self.keys().partition_point(|key| key.frame <= frame).saturating_sub(1)
    }
}

struct Curve {
    frames: Vec<f64>,
    smooth: bool,
    x: f64,
    before: usize,
}

impl Curve {
    /// Component by component; a number among lists stands for a list of it.
    fn value(&self, keys: &[&KeyValue]) -> Result<KeyValue, Odd> {
        let odd = |key, message| Err(Odd { key, message });
        let length = keys.iter().find_map(|key| match key {
            KeyValue::List(items) => Some(items.len()),
            _ => None,
        });
        for (i, key) in keys.iter().enumerate() {
            match key {
                KeyValue::Flag(_) | KeyValue::Text(_) => {
                    return odd(i, "there is nothing between this and another value: `step` takes it");
                }
                KeyValue::List(items) if Some(items.len()) != length => {
                    return odd(i, "the keys' values have different numbers of components");
                }
                _ => {}
            }
        }
        let Some(length) = length else {
            let number = |key: &&KeyValue| if let KeyValue::Number(x) = key { *x } else { 0.0 };
            return Ok(KeyValue::Number(self.number(&keys.iter().map(number).collect::<Vec<_>>())));
        };
        let component = |i: usize| {
            let of = |key: &&'_ KeyValue| match key {
                KeyValue::List(items) => items[i].clone(),
                single => (*single).clone(),
            };
            let values: Vec<KeyValue> = keys.iter().map(of).collect();
            self.value(&values.iter().collect::<Vec<_>>())
        };
        (0..length).map(component).collect::<Result<_, _>>().map(KeyValue::List)
    }

    fn number(&self, y: &[f64]) -> f64 {
        let (i, x) = (self.before, &self.frames);
        if i + 1 == x.len() || self.x <= x[i] {
            return y[i];
        }
        let h = x[i + 1] - x[i];
        let t = (self.x - x[i]) / h;
        let between = if self.smooth {
            let (from, to) = (h * self.slope(y, i), h * self.slope(y, i + 1));
            let rest = 1.0 - t;
            // the cubic Hermite basis
            (1.0 + 2.0 * t) * rest * rest * y[i] + t * rest * rest * from + t * t * (3.0 - 2.0 * t) * y[i + 1]
                - t * t * rest * to
        } else {
            y[i] + (y[i + 1] - y[i]) * t
        };
        between.clamp(y[i].min(y[i + 1]), y[i].max(y[i + 1]))
    }

    /// At key i: 0 at the ends and where the values turn.
    fn slope(&self, y: &[f64], i: usize) -> f64 {
        let x = &self.frames;
        if i == 0 || i + 1 == x.len() {
            return 0.0;
        }
        let (before, after) = (x[i] - x[i - 1], x[i + 1] - x[i]);
        let (rise, next) = ((y[i] - y[i - 1]) / before, (y[i + 1] - y[i]) / after);
        if !(rise > 0.0 && next > 0.0 || rise < 0.0 && next < 0.0) {
            return 0.0;
        }
        let (w, v) = (2.0 * after + before, after + 2.0 * before);
        (w + v) / (w / rise + v / next)
    }
}

#[cfg(test)]
mod tests {
    use super::super::animation::Key;
    use super::*;

    fn keys(values: &[(u32, f64)]) -> Vec<Key> {
        values.iter().map(|&(frame, x)| Key { frame, value: KeyValue::Number(x) }).collect()
    }

    fn at(track: &Track, frame: u32) -> f64 {
        match track.at(frame) {
            Ok(KeyValue::Number(x)) => x,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn each_kind_goes_through_its_keys_and_rests_outside() {
        let values = [(3, 1.0), (7, 5.0), (8, -2.0), (20, -2.0)];
        for kind in [Track::Linear, Track::Smooth, Track::Step] {
            let track = kind(keys(&values));
            for (frame, x) in values {
                assert_eq!(at(&track, frame), x, "{track:?}");
            }
            assert_eq!((at(&track, 0), at(&track, 99), at(&track, 13)), (1.0, -2.0, -2.0));
        }
        assert_eq!(at(&Track::Linear(keys(&values)), 4), 2.0);
        assert_eq!(at(&Track::Step(keys(&values)), 6), 1.0);
    }

    #[test]
    fn two_smooth_keys_are_the_curve_from_rest_to_rest() {
        let track = Track::Smooth(keys(&[(0, 0.0), (100, 1.0)]));
        for frame in 0..=100 {
            let t = f64::from(frame) / 100.0;
            assert!((at(&track, frame) - t * t * (3.0 - 2.0 * t)).abs() < 1e-15);
        }
    }

    #[test]
    fn smooth_values_never_overshoot_and_have_no_kink() {
        // a steep rise between flat parts, in both directions
        let values = [(0, 0.0), (1000, 0.01), (2000, 9.0), (3000, 10.0), (4000, 10.0), (5000, 3.0)];
        let track = Track::Smooth(keys(&values));
        let curve: Vec<f64> = (0..=5000).map(|frame| at(&track, frame)).collect();
        for pair in values.windows(2) {
            let (low, high) = (pair[0].1.min(pair[1].1), pair[0].1.max(pair[1].1));
            let part = &curve[pair[0].0 as usize..=pair[1].0 as usize];
            assert!(part.iter().all(|x| (low..=high).contains(x)));
            let rising = pair[1].1 >= pair[0].1;
            assert!(part.windows(2).all(|step| (step[1] >= step[0]) == rising || step[1] == step[0]));
        }
        let speed: Vec<f64> = curve.windows(2).map(|step| step[1] - step[0]).collect();
        let jump = speed.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        assert!(jump < 2e-4, "the speed jumps by {jump}");
    }

    #[test]
    fn values_that_do_not_match_are_named_by_their_key() {
        let list = |n: usize| KeyValue::List(vec![KeyValue::Number(1.0); n]);
        let track = |values: Vec<KeyValue>| {
            Track::Linear((1..).zip(values).map(|(frame, value)| Key { frame, value }).collect())
        };
        let text = || KeyValue::Text("glass".to_owned());
        let odd = |values| track(values).at(1).map_err(|odd| odd.key);
        assert_eq!(odd(vec![list(3), list(3), list(2)]), Err(2));
        assert_eq!(odd(vec![KeyValue::Number(1.0), text()]), Err(1));
        let grey = track(vec![KeyValue::Number(0.0), list(3)]).at(1);
        assert_eq!(grey, Ok(KeyValue::List(vec![KeyValue::Number(0.0); 3])));
        assert_eq!(Track::Step(vec![Key { frame: 1, value: text() }]).at(4), Ok(text()));
        assert_eq!(Track::Step(Vec::new()).odd_frames().map(|odd| odd.key), Some(0));
        assert_eq!(Track::Step(keys(&[(1, 0.0), (1, 0.0)])).odd_frames().map(|odd| odd.key), Some(1));
    }
}

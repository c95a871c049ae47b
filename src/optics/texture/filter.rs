//! Periodic patterns averaged over an interval, in closed form, and smooth steps.

/// Mean over [x − half, x + half] of the pulse train that is 1 where the fractional part lies in
/// [low, high) and 0 elsewhere; 0 ≤ low ≤ high ≤ 1. A non-finite `x` counts as 0.
#[inline]
pub fn pulses(x: f64, half: f64, low: f64, high: f64) -> f64 {
    let x = fraction(x);
    // Below this width the difference of integrals is rounding; the point value is its limit.
    if half.is_nan() || half <= 1e-9 {
        return if (low..high).contains(&x) { 1.0 } else { 0.0 };
    }
    // Wider than this the mean is constant to single precision.
    if half > 1e7 {
        return high - low;
    }
    // Wholly inside of a pulse, or of a gap within the period.
    let (from, to) = (x - half, x + half);
    if low <= from && to <= high {
        return 1.0;
    }
    if (0.0 <= from && to <= low) || (high <= from && to <= 1.0) {
        return 0.0;
    }
    let integral = |t: f64| {
        let whole = floor(t);
        whole * (high - low) + ((t - whole).clamp(low, high) - low)
    };
    ((integral(to) - integral(from)) / (2.0 * half)).clamp(0.0, 1.0)
}

/// Mean over the interval of the square wave of period 2 that is +1 on [0, 1) and −1 on [1, 2).
#[inline]
pub fn square_wave(x: f64, half: f64) -> f64 {
    2.0 * pulses(0.5 * x, 0.5 * half, 0.0, 0.5) - 1.0
}

/// Whether the square wave of [`square_wave`] is −1 over all of [x − √half2, x + √half2]; `None` where it changes,
/// and where numbers are too large or not numbers.
#[inline]
pub fn level(x: f64, half2: f64) -> Option<bool> {
    if x.abs() >= 1e15 {
        return None;
    }
    let truncated = x as i64;
    let step = truncated - i64::from(truncated as f64 > x);
    let above = x - step as f64;
    let nearest = if above < 0.5 { above } else { 1.0 - above };
    (half2 >= 0.0 && half2 <= nearest * nearest).then_some(step & 1 == 1)
}

/// The fractional part in [0, 1); 0 for NaN and infinities.
#[inline]
pub fn fraction(x: f64) -> f64 {
    let f = x - floor(x);
    // −1e-30 has the fraction 1 − 1e-30, which rounds to 1.
    if f < 1.0 { f } else { 0.0 }
}

/// The largest whole number that is not above `x`, without the call that machines without an instruction for
/// it need. From 2⁵² on every double is whole.
#[inline]
fn floor(x: f64) -> f64 {
    if x.abs() < 4_503_599_627_370_496.0 {
        let whole = x as i64 as f64;
        if whole > x { whole - 1.0 } else { whole }
    } else {
        x
    }
}

/// Hermite step: 0 up to `from`, 1 beyond `to`, C1 between; `from` < `to`.
pub fn smoothstep(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// How much of a feature of this size survives a footprint of this radius: 1 while the footprint's
/// diameter is below half the feature, 0 once it is larger than the feature.
pub fn survives(radius: f64, feature: f64) -> f64 {
    1.0 - smoothstep(0.5, 1.0, 2.0 * radius / feature)
}

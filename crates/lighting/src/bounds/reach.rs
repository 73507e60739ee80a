//! How far a light matters.

use crate::equations::{ATTENUATION_MAX, Light, Place, Real, Transcendental, attenuation, range_window};

/// Halvings of the interval that holds the reach of a light with a range: to 10⁻⁹ of it.
const HALVINGS: u32 = 30;

/// The distance from the light in world units beyond which it adds less than `epsilon` to a channel of any white point:
/// att·(Ld + Ls) < ε, and La too where it is attenuated. For a material whose reflectances are at most k, ask for ε/k.
///
/// Without a range it solves a + b·d + c·d² = colour/ε in closed form; with one, where the window takes part, by
/// bisection: both fall with the distance. Infinite for a directional light and for one that never falls so low, 0 for
/// one that is black or nowhere so bright. What is conservative: a cone is ignored, n·l and S count as 1, and the
/// result is rounded up by a millionth. A point at which the light counts as being
/// ([`COINCIDENT`](crate::equations::COINCIDENT)) is within its reach, whatever the distance.
///
/// A spatial structure that finds only the lights within their reach drops each of the others for less than ε, but the
/// sum of what they would add counts: subtract it from the tolerance of [`Receiver::select`](super::Receiver::select).
pub fn reach<T: Real>(light: &Light<T>, epsilon: T) -> T {
    let color = brightest(light);
    if color == 0.0 {
        return T::zero();
    }
    let Place::Point(_) = light.place else { return T::infinity() };
    let epsilon = to_f64(epsilon);
    let constants = light.attenuation.map(to_f64);
    let unwindowed = crossing(constants, color / epsilon);
    let reach = match light.range.map(to_f64) {
        None => unwindowed,
        Some(range) => {
            let bright = |d| color * attenuation(constants, d) * range_window(d, range) >= epsilon;
            last(bright, unwindowed.min(range))
        }
    };
    T::of(reach * (1.0 + 1e-6))
}

/// The largest channel of Ld + Ls, and La where it is attenuated.
pub(super) fn brightest<T: Real>(light: &Light<T>) -> f64 {
    let channel = |i: usize| {
        let ambient = if light.attenuate_ambient { to_f64(light.la[i]) } else { 0.0 };
        ambient + to_f64(light.ld[i]) + to_f64(light.ls[i])
    };
    channel(0).max(channel(1)).max(channel(2))
}

/// The d from which on a + b·d + c·d² ≥ `divisor`, in the form without cancellation.
fn crossing([a, b, c]: [f64; 3], divisor: f64) -> f64 {
    // Nowhere brighter than at the light itself, where the divisor is a, but for its least value.
    if divisor <= a.max(1.0 / f64::from(ATTENUATION_MAX)) {
        return 0.0;
    }
    let rest = divisor - a;
    let d = 2.0 * rest / (b + b.hypotenuse(2.0 * c.sqrt() * rest.sqrt()));
    // 0/0 and ∞/∞: the light does not fall, or falls beyond the number range.
    if d.is_nan() { f64::INFINITY } else { d }
}

/// An upper bound of the last d up to `end` where `holds`, which holds up to some d and not beyond.
fn last(holds: impl Fn(f64) -> bool, end: f64) -> f64 {
    let (mut low, mut high) = (0.0, end);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

fn to_f64<T: Real>(value: T) -> f64 {
    // Both number types convert.
    value.to_f64().unwrap_or(f64::NAN)
}

//! Three-component vectors as plain arrays, and the numbers they are made of.

use core::fmt::Debug;

use num_traits::Float;

use super::Transcendental;

/// The numbers the equations run in: `f32` and `f64`.
pub trait Real: Float + Transcendental + Debug + Send + Sync + 'static + sealed::Sealed {
    /// The number of this type nearest to `value`.
    fn from_f64(value: f64) -> Self;
}

impl Real for f32 {
    fn from_f64(value: f64) -> Self {
        value as f32
    }
}

impl Real for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// `a + b`.
pub fn add<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a − b`.
pub fn sub<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The product component by component: a light seen through a reflectance.
pub fn mul<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// `s·a`.
pub fn scale<T: Real>(a: [T; 3], s: T) -> [T; 3] {
    a.map(|x| x * s)
}

/// `−a`.
pub fn neg<T: Real>(a: [T; 3]) -> [T; 3] {
    a.map(|x| -x)
}

/// `a·b`.
pub fn dot<T: Real>(a: [T; 3], b: [T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a × b`, right-handed.
pub fn cross<T: Real>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `‖a‖`, at most the largest finite number; squares neither overflow nor underflow on the way.
pub fn length<T: Real>(a: [T; 3]) -> T {
    let m = largest(a);
    if m == T::zero() || !m.is_finite() {
        return m.min(T::max_value());
    }
    let u = a.map(|x| x / m);
    (m * dot(u, u).sqrt()).min(T::max_value())
}

/// `a/‖a‖`, or `None` where a is 0 or not finite. Any other magnitude will do.
pub fn normalize<T: Real>(a: [T; 3]) -> Option<[T; 3]> {
    let m = largest(a);
    if m > T::zero() && m.is_finite() && a.iter().all(|x| x.is_finite()) {
        let u = a.map(|x| x / m);
        Some(scale(u, dot(u, u).sqrt().recip()))
    } else {
        None
    }
}

/// `a/‖a‖`, or 0 where a is 0 or not finite.
pub fn normalize_or_zero<T: Real>(a: [T; 3]) -> [T; 3] {
    normalize(a).unwrap_or([T::zero(); 3])
}

/// The unit vector from p to q and the distance, for any finite p and q. `None` where they coincide.
///
/// A distance above the largest finite number is returned as that number.
pub fn toward<T: Real>(p: [T; 3], q: [T; 3]) -> (Option<[T; 3]>, T) {
    let offset = sub(q, p);
    if offset.iter().all(|x| x.is_finite()) {
        (normalize(offset), length(offset))
    } else {
        // The difference overflowed: half of it does not.
        let half = T::from_f64(0.5);
        (normalize(sub(scale(q, half), scale(p, half))), T::max_value())
    }
}

fn largest<T: Real>(a: [T; 3]) -> T {
    a[0].abs().max(a[1].abs()).max(a[2].abs())
}

//! The mappings between directions and points of an image.
//!
//! Directions are in the world's axes: +X right, +Y up, −Z ahead. They need not have length 1.

use crate::lookup::Number;

/// The mapping of an environment image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum EnvironmentShape {
    /// Longitude along u, latitude along v: u = ½ + atan2(x, −z)/2π, v = acos(y)/π for a direction of length 1. The
    /// direction ahead is in the middle. Twice as wide as high if its texels are square on the equator.
    ///
    /// A texel at the latitude φ is cos φ times as wide as on the equator.
    #[default]
    Equirectangular,
    /// A mirror ball seen from far away along −Z: (2u − 1, 1 − 2v) are the first two coordinates of its normal, halfway
    /// between the direction and +Z (Blinn and Newell 1976; the sphere map of OpenGL 1.x). Square; outside the
    /// inscribed circle it is empty.
    ///
    /// All of its texels cover equal solid angles, 4 for each unit of the disc's area; toward the rim, which is the
    /// single direction −Z, they become long and thin.
    MirrorBall,
    /// Six squares, in the order +X, −X, +Y, −Y, +Z, −Z, each oriented as in graphics APIs. u and v are those of the
    /// face.
    ///
    /// A texel in a corner covers 1/(3√3) of the solid angle of one in the middle.
    Cube,
}

impl EnvironmentShape {
    /// The images that make up this shape, in words.
    pub(crate) fn expected(self) -> &'static str {
        match self {
            Self::Equirectangular => "one image is",
            Self::MirrorBall => "one square image is",
            Self::Cube => "six square images of one size are",
        }
    }
}

/// The number of a cube map's faces.
pub(crate) const FACES: usize = 6;

/// The face of a cube map that a direction hits, and (u, v) there: the face of the coordinate of the largest magnitude,
/// among equal ones the first of x, y and z. The zero vector maps to the middle of face 0.
pub fn on_cube<T: Number>([x, y, z]: [T; 3]) -> (usize, [T; 2]) {
    let [a, b, c] = [x.abs(), y.abs(), z.abs()];
    let zero = T::zero();
    // As in the table of cube maps of OpenGL 4.6, §8.13.
    let (face, s, t, m) = if a >= b && a >= c {
        if x >= zero { (0, -z, -y, a) } else { (1, z, -y, a) }
    } else if b >= c {
        if y >= zero { (2, x, z, b) } else { (3, x, -z, b) }
    } else if z >= zero {
        (4, x, -y, c)
    } else {
        (5, -x, -y, c)
    };
    let half = T::from_f64(0.5);
    let place = |s: T| if m > zero && (s / m).is_finite() { half * (s / m + T::one()) } else { half };
    (face, [place(s), place(t)])
}

/// The direction of a point on a face, not normalized. Points outside 0 to 1 lie on the face's plane, beyond it.
pub fn from_cube<T: Number>(face: usize, [u, v]: [T; 2]) -> [T; 3] {
    let two = T::from_f64(2.0);
    let (one, s, t) = (T::one(), two * u - T::one(), two * v - T::one());
    match face {
        0 => [one, -t, -s],
        1 => [-one, -t, s],
        2 => [s, one, t],
        3 => [s, -one, -t],
        4 => [s, -t, one],
        _ => [-s, -t, -one],
    }
}

/// The point of an equirectangular image for a direction.
pub fn on_equirectangular<T: Number>([x, y, z]: [T; 3]) -> [T; 2] {
    let turn = T::from_f64(std::f64::consts::TAU);
    let u = T::from_f64(0.5) + x.arc_tangent(-z) / turn;
    let v = (x * x + z * z).sqrt().arc_tangent(y) / (T::from_f64(0.5) * turn);
    [u, v]
}

/// The direction, of length 1, of a point on an equirectangular image.
pub fn from_equirectangular<T: Number>([u, v]: [T; 2]) -> [T; 3] {
    let pi = T::from_f64(std::f64::consts::PI);
    let (longitude, from_pole) = ((T::from_f64(2.0) * u - T::one()) * pi, v * pi);
    let ring = from_pole.sine();
    [longitude.sine() * ring, from_pole.cosine(), -longitude.cosine() * ring]
}

/// The point of a mirror ball's image for a direction; −Z, which is the whole rim, is at the right.
pub fn on_mirror_ball<T: Number>(direction: [T; 3]) -> [T; 2] {
    let [x, y, z] = unit(direction);
    // h = d + (0, 0, 1); near −Z its third coordinate is computed from x and y, which cancels less.
    let ring = x * x + y * y;
    let up = if z < T::zero() { ring / (T::one() - z) } else { T::one() + z };
    let length = (ring + up * up).sqrt();
    let half = T::from_f64(0.5);
    if length > T::zero() { [half + half * x / length, half - half * y / length] } else { [T::one(), half] }
}

/// The direction, of length 1, of a point on a mirror ball's image; −Z, the rim's, outside its circle.
pub fn from_mirror_ball<T: Number>([u, v]: [T; 2]) -> [T; 3] {
    let two = T::from_f64(2.0);
    let (x, y) = (two * u - T::one(), T::one() - two * v);
    let up = (T::one() - x * x - y * y).max(T::zero()).sqrt();
    if up == T::zero() {
        return [T::zero(), T::zero(), -T::one()];
    }
    // (0, 0, 1) reflected at the normal: 2(n·z)n − z.
    [two * up * x, two * up * y, two * up * up - T::one()]
}

/// The normalized direction; −Z for the zero vector.
pub(crate) fn unit<T: Number>(d: [T; 3]) -> [T; 3] {
    let largest = d.iter().fold(T::zero(), |most, number| most.max(number.abs()));
    if !(largest > T::zero() && largest.is_finite()) {
        return [T::zero(), T::zero(), -T::one()];
    }
    let d = d.map(|number| number / largest);
    let length = d.iter().fold(T::zero(), |sum, number| sum + *number * *number).sqrt();
    d.map(|number| number / length)
}

//! Where on an image of all directions a direction lies, and back.
//!
//! Directions are in the world's axes: +X right, +Y up, −Z ahead. They need not have length 1.

use crate::lookup::Number;

/// How an image holds all directions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum EnvironmentShape {
    /// Longitude along u, latitude along v: u = ½ + atan2(x, −z)/2π, v = acos(y)/π for a direction of length 1. What
    /// lies ahead is in the middle. Twice as wide as high where its texels are square on the equator.
    ///
    /// A texel at the latitude φ is cos φ times as wide as on the equator: near the poles they crowd.
    #[default]
    Equirectangular,
    /// What a mirroring ball shows from far away, looked at along −Z: (2u − 1, 1 − 2v) are the first two coordinates of
    /// its normal, which is halfway between the direction and +Z (Blinn and Newell 1976; the sphere map of OpenGL 1.x).
    /// Square; outside the inscribed circle there is nothing.
    ///
    /// All of its texels see solid angles of one size, 4 for each unit of the disc's area; toward the rim, which is the
    /// one direction −Z, they become long and thin.
    MirrorBall,
    /// Six squares, in the order +X, −X, +Y, −Y, +Z, −Z, each turned as graphics interfaces have it. u and v are those
    /// of the face.
    ///
    /// A texel in a corner sees 1/(3√3) of the solid angle of one in a middle.
    Cube,
}

impl EnvironmentShape {
    /// Which images it is made of, in words.
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

/// On which face of a cube map a direction lies, and where: that of its largest number; of equal ones the first of x, y
/// and z. A direction without one lies in the middle of face 0.
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
    let half = T::of(0.5);
    let place = |s: T| if m > zero && (s / m).is_finite() { half * (s / m + T::one()) } else { half };
    (face, [place(s), place(t)])
}

/// The direction of a place on a face, not of length 1. Places outside 0 to 1 lie on the face's plane, beyond it.
pub fn from_cube<T: Number>(face: usize, [u, v]: [T; 2]) -> [T; 3] {
    let two = T::of(2.0);
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

/// Where a direction lies on an equirectangular image.
pub fn on_equirectangular<T: Number>([x, y, z]: [T; 3]) -> [T; 2] {
    let turn = T::of(std::f64::consts::TAU);
    let u = T::of(0.5) + x.arc_tangent(-z) / turn;
    let v = (x * x + z * z).sqrt().arc_tangent(y) / (T::of(0.5) * turn);
    [u, v]
}

/// The direction, of length 1, of a place on an equirectangular image.
pub fn from_equirectangular<T: Number>([u, v]: [T; 2]) -> [T; 3] {
    let pi = T::of(std::f64::consts::PI);
    let (longitude, from_pole) = ((T::of(2.0) * u - T::one()) * pi, v * pi);
    let ring = from_pole.sine();
    [longitude.sine() * ring, from_pole.cosine(), -longitude.cosine() * ring]
}

/// Where a direction lies on the image of a mirroring ball; −Z, which is all of its rim, at the right.
pub fn on_mirror_ball<T: Number>(direction: [T; 3]) -> [T; 2] {
    let [x, y, z] = unit(direction);
    // h = d + (0, 0, 1); its third number near −Z by what x and y say, which cancels less.
    let ring = x * x + y * y;
    let up = if z < T::zero() { ring / (T::one() - z) } else { T::one() + z };
    let length = (ring + up * up).sqrt();
    let half = T::of(0.5);
    if length > T::zero() { [half + half * x / length, half - half * y / length] } else { [T::one(), half] }
}

/// The direction, of length 1, of a place on the image of a mirroring ball; outside its circle that of the rim, −Z.
pub fn from_mirror_ball<T: Number>([u, v]: [T; 2]) -> [T; 3] {
    let two = T::of(2.0);
    let (x, y) = (two * u - T::one(), T::one() - two * v);
    let up = (T::one() - x * x - y * y).max(T::zero()).sqrt();
    if up == T::zero() {
        return [T::zero(), T::zero(), -T::one()];
    }
    // (0, 0, 1) mirrored at the normal: 2(n·z)n − z.
    [two * up * x, two * up * y, two * up * up - T::one()]
}

/// The same direction with length 1; −Z for one without.
pub(crate) fn unit<T: Number>(d: [T; 3]) -> [T; 3] {
    let largest = d.iter().fold(T::zero(), |most, number| most.max(number.abs()));
    if !(largest > T::zero() && largest.is_finite()) {
        return [T::zero(), T::zero(), -T::one()];
    }
    let d = d.map(|number| number / largest);
    let length = d.iter().fold(T::zero(), |sum, number| sum + *number * *number).sqrt();
    d.map(|number| number / length)
}

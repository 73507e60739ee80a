//! Where on an image a surface's coordinates lie.

use crate::lookup::Number;

/// An affine map of texture coordinates: scaled, then turned, then moved, as `KHR_texture_transform` has it. The
/// default leaves them as they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvTransform {
    /// Moved by, in widths and heights of the image. Finite. Default (0, 0).
    pub offset: [f32; 2],
    /// Turned by, in radians, counter-clockwise as the image is seen. Finite. Default 0.
    pub rotation: f32,
    /// Stretched by. Finite. Default (1, 1).
    pub scale: [f32; 2],
}

impl Default for UvTransform {
    fn default() -> Self {
        Self { offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2] }
    }
}

impl UvTransform {
    /// The first of its numbers that is not finite, with the name of its field.
    pub fn wrong(&self) -> Option<(&'static str, f32)> {
        let Self { offset: [x, y], rotation, scale: [a, b] } = *self;
        let numbers = [("offset", x), ("offset", y), ("rotation", rotation), ("scale", a), ("scale", b)];
        numbers.into_iter().find(|(_, number)| !number.is_finite())
    }

    /// The rows of the map: u' = r₀·(u, v, 1), v' = r₁·(u, v, 1). From `KHR_texture_transform`: translation · rotation
    /// · scale, with u' = cos·u + sin·v and v' = −sin·u + cos·v for the rotation, since v runs downward.
    pub fn rows(&self) -> [[f64; 3]; 2] {
        let [[x, y], [a, b]] = [self.offset, self.scale].map(|pair| pair.map(f64::from));
        let angle = f64::from(self.rotation);
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        [[cos * a, sin * b, x], [-sin * a, cos * b, y]]
    }

    /// A point through [`rows`](Self::rows).
    pub fn apply<T: Number>(rows: &[[T; 3]; 2], uv: [T; 2]) -> [T; 2] {
        rows.map(|[a, b, c]| a * uv[0] + b * uv[1] + c)
    }
}

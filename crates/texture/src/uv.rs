//! Transforms of texture coordinates.

use crate::lookup::Number;

/// An affine map of texture coordinates: scaled, then rotated, then translated, as in `KHR_texture_transform`. The
/// default is the identity.
///
/// ```
/// use halfway_texture::UvTransform;
///
/// let tiled = UvTransform { scale: [4.0, 2.0], offset: [0.5, 0.0], ..UvTransform::default() };
/// assert_eq!(UvTransform::apply(&tiled.rows(), [0.25, 0.5]), [1.5, 1.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvTransform {
    /// The translation, in widths and heights of the image. Finite. Default (0, 0).
    pub offset: [f32; 2],
    /// The rotation in radians, counter-clockwise as the image is seen. Finite. Default 0.
    pub rotation: f32,
    /// The scale. Finite. Default (1, 1).
    pub scale: [f32; 2],
}

impl Default for UvTransform {
    fn default() -> Self {
        Self { offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2] }
    }
}

impl UvTransform {
    /// The first field that is not finite, and its value.
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

    /// Applies [`rows`](Self::rows) to a point.
    pub fn apply<T: Number>(rows: &[[T; 3]; 2], uv: [T; 2]) -> [T; 2] {
        rows.map(|[a, b, c]| a * uv[0] + b * uv[1] + c)
    }
}

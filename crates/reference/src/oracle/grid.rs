//! The grid within a pixel that a rasteriser puts vertices on.

use bevy_math::DVec2;

/// The most bits of a grid within a pixel; more are as none.
const MOST_BITS: u32 = 24;

/// Places nearer to the middle between two of the grid, in shares of the picture's size, are rounded to either: a few
/// roundings of single precision, by which rasterisers find them.
const TIE: f64 = f32::EPSILON as f64;

/// How a rasteriser puts vertices on a grid of 2ᴺ places along each axis of a pixel: at the nearest ones, and which one
/// that is where single precision cannot tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexGrid {
    bits: u32,
    /// Below 0 the lower place is taken where it is a tie along this axis, above 0 the higher one, at 0 the nearer one.
    lean: DVec2,
}

impl From<u32> for VertexGrid {
    /// The nearest places, of a grid of so many bits.
    fn from(bits: u32) -> Self {
        Self { bits: bits.min(MOST_BITS), lean: DVec2::ZERO }
    }
}

impl VertexGrid {
    /// The nearest places, and then the four ways to have all ties lean to one side along each axis.
    pub fn all(bits: u32) -> [Self; 5] {
        let nearest = Self::from(bits);
        let leaning = |x, y| Self { lean: DVec2::new(x, y), ..nearest };
        [nearest, leaning(-1.0, -1.0), leaning(1.0, -1.0), leaning(-1.0, 1.0), leaning(1.0, 1.0)]
    }

    fn places(self) -> f64 {
        f64::from(1_u32 << self.bits)
    }

    /// The place of a point of a picture of this size, all in pixels.
    pub(super) fn place(self, pixel: DVec2, size: DVec2) -> DVec2 {
        let leaning = pixel + self.lean * TIE * size;
        (leaning * self.places()).round() / self.places()
    }

    /// Whether single precision cannot tell the place of a point.
    pub(super) fn is_tie(self, pixel: DVec2, size: DVec2) -> bool {
        let at = |lean| Self { lean, ..self }.place(pixel, size);
        at(DVec2::NEG_ONE) != at(DVec2::ONE)
    }
}

//! The sub-pixel grid that a rasterizer snaps vertices to.

use bevy_math::DVec2;

/// A grid of 2ᴺ points along each axis of a pixel. A vertex is snapped to the nearest one.
#[derive(Clone, Copy, Debug)]
pub(super) struct VertexGrid {
    places: f64,
}

/// The most bits of a sub-pixel grid; more make no difference.
const MOST_BITS: u32 = 24;

/// The distance from the middle between two grid points, as a share of the picture's size, within which single
/// precision cannot tell which one is nearer: a few roundings.
const TIE: f64 = f32::EPSILON as f64;

impl VertexGrid {
    pub(super) fn new(bits: u32) -> Self {
        Self { places: f64::from(1_u32 << bits.min(MOST_BITS)) }
    }

    /// The spacing of grid points, in pixels.
    pub(super) fn step(self) -> f64 {
        self.places.recip()
    }

    /// The grid point nearest to a point of the picture, both in pixels.
    pub(super) fn place(self, pixel: DVec2) -> DVec2 {
        (pixel * self.places).round() / self.places
    }

    /// Whether single precision may snap a point to another grid point; `size` is the picture's, in pixels, or of the
    /// numbers that the point is the sum of.
    pub(super) fn is_tie(self, pixel: DVec2, size: DVec2) -> bool {
        self.place(pixel - TIE * size) != self.place(pixel + TIE * size)
    }
}

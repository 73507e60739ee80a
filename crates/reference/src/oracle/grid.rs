//! The grid within a pixel that a rasterizer puts vertices on.

use bevy_math::DVec2;

/// A grid of 2ᴺ places along each axis of a pixel. A vertex goes to the nearest one.
#[derive(Clone, Copy, Debug)]
pub(super) struct VertexGrid {
    places: f64,
}

/// The most bits of a grid within a pixel; more are as none.
const MOST_BITS: u32 = 24;

/// In shares of the picture's size, how far from the middle between two places single precision cannot tell which one
/// is nearer: a few of its roundings, by which rasterizers find them.
const TIE: f64 = f32::EPSILON as f64;

impl VertexGrid {
    pub(super) fn new(bits: u32) -> Self {
        Self { places: f64::from(1_u32 << bits.min(MOST_BITS)) }
    }

    /// How far one place is from the next, in pixels.
    pub(super) fn step(self) -> f64 {
        self.places.recip()
    }

    /// The place of a point of the picture, both in pixels.
    pub(super) fn place(self, pixel: DVec2) -> DVec2 {
        (pixel * self.places).round() / self.places
    }

    /// Whether single precision may take a point of a picture of this size, in pixels, to another place.
    pub(super) fn is_tie(self, pixel: DVec2, size: DVec2) -> bool {
        self.place(pixel - TIE * size) != self.place(pixel + TIE * size)
    }
}

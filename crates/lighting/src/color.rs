//! Linear RGB colours, for builds without `bevy_color`.

use bytemuck::NoUninit;

/// A colour in linear RGB, with the fields and the layout of `bevy_color`'s, which takes its place with the feature
/// `ecs`.
#[derive(Clone, Copy, Debug, PartialEq, NoUninit)]
#[repr(C)]
pub struct LinearRgba {
    /// Red, 0 or more.
    pub red: f32,
    /// Green, 0 or more.
    pub green: f32,
    /// Blue, 0 or more.
    pub blue: f32,
    /// Opacity, 0 to 1.
    pub alpha: f32,
}

impl LinearRgba {
    /// Black, opaque.
    pub const BLACK: Self = Self::rgb(0.0, 0.0, 0.0);
    /// White, opaque. The default.
    pub const WHITE: Self = Self::rgb(1.0, 1.0, 1.0);

    /// A colour of these channels.
    pub const fn new(red: f32, green: f32, blue: f32, alpha: f32) -> Self {
        Self { red, green, blue, alpha }
    }

    /// An opaque colour of these channels.
    pub const fn rgb(red: f32, green: f32, blue: f32) -> Self {
        Self::new(red, green, blue, 1.0)
    }
}

impl Default for LinearRgba {
    fn default() -> Self {
        Self::WHITE
    }
}

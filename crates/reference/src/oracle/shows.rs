//! The values that the oracle's picture shows.

/// The values that a picture of the [`Oracle`](super::Oracle) shows. All are blended, cut by masks and averaged over
/// samples as the colors are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Shows {
    /// The intensities I.
    #[default]
    Color,
    /// The diffuse reflectance, linear RGB: of the material, times vertex colours, images and solids; over black.
    Albedo,
    /// The share of the pixel that is not background, 0 to 1, in each channel. An environment is background, too.
    Coverage,
}

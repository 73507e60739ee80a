//! The values that the oracle's picture shows.

use halfway_lighting::equations::vector::mul;
use halfway_texture::MapKind;

use super::raster::Hit;
use super::scene::OracleScene;
use super::solid::Color;

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

impl OracleScene {
    /// The diffuse reflectance at a hit.
    pub(super) fn albedo(&self, hit: &Hit) -> Color {
        let solid = &self.solids[hit.solid];
        let color = solid.color(hit.on_triangle()).truncate().to_array();
        let material = solid.side(hit.front).coefficients.tinted(color);
        let [r, g, b, _] = self.factor(hit, MapKind::Color);
        mul([r, g, b], mul(self.solid_color(hit), if solid.lit { material.kd } else { material.ka }))
    }
}

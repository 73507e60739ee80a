//! The values of an object's images, and of its solid texture, at a hit.

use bevy_math::DVec3;
use halfway_lighting::equations::vector::add;
use halfway_lighting::equations::{
    Coefficients, Eye, Light, ShadedPoint, axial_exponent, bumped_normal, incidence, lobe_axes, mapped_normal,
    view_vector,
};
use halfway_lighting::{Frequency, Reflectance};
use halfway_texture::normals::{SlopeSpread, lean_lobe, mean_length, spread_length, toksvig};
use halfway_texture::{FarNormals, MapKind, lookup};

use super::maps::SolidMap;
use super::raster::Hit;
use super::scene::OracleScene;
use super::solid::{Color, Solid};

/// The texture coordinates of a hit, and their change from a pixel to the next, along x and along y.
struct PointOnMap {
    uv: [f64; 2],
    footprint: [[f64; 2]; 2],
}

/// An anisotropic highlight lobe about a normal: see [`axial_exponent`].
#[derive(Clone, Copy, Debug)]
pub(super) struct AnisotropicLobe {
    axes: [Color; 2],
    widths: Color,
}

impl AnisotropicLobe {
    /// The material with the lobe's exponent in the direction of a light.
    pub(super) fn toward(
        &self,
        light: &Light<f64>,
        surface: &ShadedPoint<f64>,
        viewer: &Eye<f64>,
        material: &Coefficients<f64>,
    ) -> Coefficients<f64> {
        // A hemisphere light has no highlight.
        let Some(incident) = incidence(surface, light) else { return *material };
        let h = add(incident.l, view_vector(surface, viewer));
        Coefficients { shininess: axial_exponent(self.axes, self.widths, h, material.shininess), ..*material }
    }
}

/// How far the highlight's vector turns relative to the image's normals: a reflected direction turns twice as far.
fn angle_factor(solid: &Solid, map: &SolidMap) -> f64 {
    if solid.reflectance == Reflectance::Phong { 2.0 * map.amount } else { map.amount }
}

impl PointOnMap {
    /// The filtered normal as a texel, each number from 0 to 1.
    fn normal(&self, map: &SolidMap) -> Color {
        let [r, g, b, _] = lookup::filtered(&map.pyramid, &map.sampling, self.uv, self.footprint);
        [r, g, b].map(|number| number.clamp(0.0, 1.0))
    }

    /// The filtered moments of the normals' slopes.
    fn slopes(&self, map: &SolidMap) -> SlopeSpread<f64> {
        SlopeSpread::filtered(&map.pyramid, &map.sampling, self.uv, self.footprint)
    }
}

impl OracleScene {
    /// The factor of the image of a kind, channel by channel (the fourth is the opacity of a color image): 1 without an
    /// image.
    pub(super) fn factor(&self, hit: &Hit, kind: MapKind) -> [f64; 4] {
        let Some((map, point)) = self.map_at(hit, kind) else { return [1.0; 4] };
        let texel = lookup::filtered(&map.pyramid, &map.sampling, point.uv, point.footprint);
        texel.map(|number| 1.0 + map.amount * (number.clamp(0.0, 1.0) - 1.0))
    }

    /// The factor of an image of single numbers.
    pub(super) fn factor_of_one(&self, hit: &Hit, kind: MapKind) -> f64 {
        let channel = self.solids[hit.solid].maps.as_ref().and_then(|maps| maps.slots[kind as usize].as_ref());
        channel.map_or(1.0, |map| self.factor(hit, kind)[map.channel as usize])
    }

    /// The factor of the opacity by images.
    pub(super) fn mapped_opacity(&self, hit: &Hit) -> f64 {
        let maps = self.solids[hit.solid].maps.as_ref();
        match maps.map(|maps| maps.slots[MapKind::Opacity as usize].is_some()) {
            Some(true) => self.factor_of_one(hit, MapKind::Opacity),
            _ => self.factor(hit, MapKind::Color)[3],
        }
    }

    /// The front's normal under a normal or height map, from the interpolated one `n`; `otherwise` where `n` vanishes
    /// or there is no such map.
    pub(super) fn front_normal(&self, hit: &Hit, n: Color, otherwise: Color) -> Color {
        let solid = &self.solids[hit.solid];
        let (Some(maps), Some((triangle, weights))) = (&solid.maps, hit.on_triangle()) else { return otherwise };
        let vertices = solid.vertices(triangle);
        if let Some((map, point)) = self.map_at(hit, MapKind::Normal) {
            let texel = if map.far_normals == FarNormals::Lean { point.slopes(map).texel() } else { point.normal(map) };
            let (t, w) = maps.tangent(vertices, weights);
            return mapped_normal(n, t, w, texel, map.amount, otherwise);
        }
        let Some((map, point)) = self.map_at(hit, MapKind::Height) else { return otherwise };
        let d = lookup::level(map.pyramid.size(), point.footprint);
        let [along_u, along_v] = lookup::gradient(&map.pyramid, &map.sampling, point.uv, d, map.channel);
        let [a, b, c] = solid.lit_triangle(triangle);
        let uvs = vertices.map(|number| map.uvs[number]);
        let rise = |k: usize| map.amount * (along_u * (uvs[k][0] - uvs[0][0]) + along_v * (uvs[k][1] - uvs[0][1]));
        let m: DVec3 = (0..3).map(|i| maps.rises[vertices[i]] * weights[i]).sum();
        bumped_normal(n, m.to_array(), [(b - a).to_array(), (c - a).to_array()], [rise(1), rise(2)], otherwise)
    }

    /// The exponent of highlights under images at a hit, given the material's, and the factor of their strength.
    pub(super) fn highlight_exponent(&self, hit: &Hit, exponent: f64) -> [f64; 2] {
        let solid = &self.solids[hit.solid];
        let exponent = exponent * self.factor_of_one(hit, MapKind::Shininess);
        let map_at = self.map_at(hit, MapKind::Normal).filter(|_| solid.terms.has(Frequency::Fragment));
        let Some((map, point)) = map_at else { return [exponent, 1.0] };
        match map.far_normals {
            FarNormals::Mean => [exponent, 1.0],
            FarNormals::Toksvig => toksvig(mean_length(point.normal(map), angle_factor(solid, map)), exponent),
            FarNormals::Lean => {
                let covariance = point.slopes(map).covariance(angle_factor(solid, map));
                let [.., factor] = lean_lobe(covariance, exponent);
                let [even, _] = toksvig(spread_length(covariance), exponent);
                [even, factor]
            }
        }
    }

    /// The anisotropic lobe about a normal of the front, of a material with this exponent; `None` if the highlight is
    /// round.
    pub(super) fn axial(&self, hit: &Hit, n: Color, exponent: f64) -> Option<AnisotropicLobe> {
        let solid = &self.solids[hit.solid];
        let (maps, (triangle, weights)) = (solid.maps.as_ref()?, hit.on_triangle()?);
        let (map, point) = self.map_at(hit, MapKind::Normal)?;
        if map.far_normals != FarNormals::Lean {
            return None;
        }
        let exponent = exponent * self.factor_of_one(hit, MapKind::Shininess);
        let [aa, ab, bb, _] = lean_lobe(point.slopes(map).covariance(angle_factor(solid, map)), exponent);
        let (t, w) = maps.tangent(solid.vertices(triangle), weights);
        Some(AnisotropicLobe { axes: lobe_axes(n, t, w), widths: [aa, ab, bb] })
    }

    /// The image of a kind, and the texture coordinates of a hit on it.
    fn map_at(&self, hit: &Hit, kind: MapKind) -> Option<(&SolidMap, PointOnMap)> {
        let solid = &self.solids[hit.solid];
        let map = solid.maps.as_ref()?.slots[kind as usize].as_ref()?;
        let (triangle, weights) = hit.on_triangle()?;
        Some((map, self.point_on_map(solid, map, triangle, weights)))
    }

    /// The solid texture's factor of ambient and diffuse light: 1 without one.
    pub(super) fn solid_color(&self, hit: &Hit) -> Color {
        let solid = &self.solids[hit.solid];
        let (Some(cut_from), Some((triangle, weights))) = (&solid.cut_from, hit.on_triangle()) else { return [1.0; 3] };
        let positions = solid.mesh.positions();
        let places = solid.vertices(triangle).map(|number| positions[number].as_dvec3().to_array());
        let (place, ways) = self.interpolated(solid, places, triangle, weights);
        cut_from.color_at(place, ways)
    }

    fn point_on_map(&self, solid: &Solid, map: &SolidMap, triangle: u32, weights: [f64; 3]) -> PointOnMap {
        let uvs = solid.vertices(triangle).map(|number| map.uvs[number]);
        let (uv, footprint) = self.interpolated(solid, uvs, triangle, weights);
        PointOnMap { uv, footprint }
    }

    /// Interpolates numbers at the corners of a triangle, and gives their change from a pixel to the next, along x and
    /// along y.
    ///
    /// On a triangle u = Σ uᵢVᵢ/Σ Vᵢ, where Vᵢ is the volume of the point of the picture with the edge opposite to
    /// corner i. Vᵢ is linear over the picture, so the derivative follows by the quotient rule.
    fn interpolated<const N: usize>(
        &self,
        solid: &Solid,
        of_corners: [[f64; N]; 3],
        triangle: u32,
        weights: [f64; 3],
    ) -> ([f64; N], [[f64; N]; 2]) {
        let [a, b, c] = solid.triangle(triangle).map(|corner| self.view.homogeneous(corner));
        let here: [f64; N] = std::array::from_fn(|k| (0..3).map(|i| weights[i] * of_corners[i][k]).sum::<f64>());
        let [u, v, w] = weights;
        let sum: DVec3 = a * u + b * v + c * w;
        let at = sum / -sum.z;
        let normals = [b.cross(c), c.cross(a), a.cross(b)];
        let sum: f64 = normals.iter().map(|n| n.dot(at)).sum();
        let first = self.view.at(0.0, 0.0);
        let footprint = [self.view.at(1.0, 0.0), self.view.at(0.0, 1.0)].map(|next| {
            let grown = normals.map(|n| n.dot(next - first));
            std::array::from_fn(|k| (0..3).map(|i| (of_corners[i][k] - here[k]) * grown[i]).sum::<f64>() / sum)
        });
        (here, footprint)
    }
}

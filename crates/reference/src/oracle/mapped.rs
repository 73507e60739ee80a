//! What the images on an object, and the solid that it is cut from, have where it is seen.

use bevy_math::DVec3;
use halfway_lighting::equations::vector::add;
use halfway_lighting::equations::{
    Coefficients, Eye, Light, ShadedPoint, axial_exponent, bumped_normal, incidence, lobe_axes, mapped_normal,
    view_vector,
};
use halfway_lighting::{Frequency, Reflectance};
use halfway_texture::normals::{SlopeSpread, lean_lobe, mean_length, spread_length, toksvig};
use halfway_texture::{FarNormals, MapKind, lookup};

use super::gather::OracleScene;
use super::maps::SolidMap;
use super::raster::Hit;
use super::solid::{Color, Solid};

/// Where on an image a hit lies: u and v, and by how much they change from a pixel to the next, along x and along y.
struct PointOnMap {
    uv: [f64; 2],
    footprint: [[f64; 2]; 2],
}

/// Highlights about a normal that need not be round: see [`axial_exponent`].
pub(super) struct AxialLobe {
    axes: [Color; 2],
    widths: Color,
}

impl AxialLobe {
    /// The material as a light's highlight takes it.
    pub(super) fn toward(
        &self,
        light: &Light<f64>,
        surface: &ShadedPoint<f64>,
        viewer: &Eye<f64>,
        material: &Coefficients<f64>,
    ) -> Coefficients<f64> {
        // Light from all around has no highlight.
        let Some(incident) = incidence(surface, light) else { return *material };
        let h = add(incident.l, view_vector(surface, viewer));
        Coefficients { shininess: axial_exponent(self.axes, self.widths, h, material.shininess), ..*material }
    }
}

/// How many times as far as the image's normals what highlights go by turns: what is mirrored turns twice as far.
fn turned(solid: &Solid, map: &SolidMap) -> f64 {
    if solid.reflectance == Reflectance::Phong { 2.0 * map.amount } else { map.amount }
}

impl PointOnMap {
    /// A normal as its texel, each number from 0 to 1.
    fn normal(&self, map: &SolidMap) -> Color {
        let [r, g, b, _] = lookup::filtered(&map.pyramid, &map.sampling, self.uv, self.footprint);
        [r, g, b].map(|number| number.clamp(0.0, 1.0))
    }

    /// The slopes of normals.
    fn slopes(&self, map: &SolidMap) -> SlopeSpread<f64> {
        SlopeSpread::seen(&map.pyramid, &map.sampling, self.uv, self.footprint)
    }
}

impl OracleScene {
    /// What the image of a kind multiplies by, channel by channel and, of the color, the opacity: 1 where there is
    /// none.
    pub(super) fn factor(&self, hit: &Hit, kind: MapKind) -> [f64; 4] {
        let Some((map, place)) = self.looked_up(hit, kind) else { return [1.0; 4] };
        let texel = lookup::filtered(&map.pyramid, &map.sampling, place.uv, place.footprint);
        texel.map(|number| 1.0 + map.amount * (number.clamp(0.0, 1.0) - 1.0))
    }

    /// The same of a kind of which one number counts.
    pub(super) fn factor_of_one(&self, hit: &Hit, kind: MapKind) -> f64 {
        let channel = self.solids[hit.solid].maps.as_ref().and_then(|maps| maps.slots[kind as usize].as_ref());
        channel.map_or(1.0, |map| self.factor(hit, kind)[map.channel as usize])
    }

    /// What images multiply the opacity by.
    pub(super) fn mapped_opacity(&self, hit: &Hit) -> f64 {
        let maps = self.solids[hit.solid].maps.as_ref();
        match maps.map(|maps| maps.slots[MapKind::Opacity as usize].is_some()) {
            Some(true) => self.factor_of_one(hit, MapKind::Opacity),
            _ => self.factor(hit, MapKind::Color)[3],
        }
    }

    /// The normal of the front as the images turn it: from the interpolated one, and what stands for it where it
    /// vanishes or nothing turns it.
    pub(super) fn relief(&self, hit: &Hit, n: Color, otherwise: Color) -> Color {
        let solid = &self.solids[hit.solid];
        let (Some(maps), Some((triangle, weights))) = (&solid.maps, hit.on_triangle()) else { return otherwise };
        let vertices = solid.vertices(triangle);
        if let Some((map, place)) = self.looked_up(hit, MapKind::Normal) {
            let texel = if map.far_normals == FarNormals::Lean { place.slopes(map).texel() } else { place.normal(map) };
            let (t, w) = maps.tangent(vertices, weights);
            return mapped_normal(n, t, w, texel, map.amount, otherwise);
        }
        let Some((map, place)) = self.looked_up(hit, MapKind::Height) else { return otherwise };
        let d = lookup::level(map.pyramid.size(), place.footprint);
        let [along_u, along_v] = lookup::gradient(&map.pyramid, &map.sampling, place.uv, d, map.channel);
        let [a, b, c] = solid.lit_triangle(triangle);
        let uvs = vertices.map(|number| map.uvs[number]);
        let rise = |k: usize| map.amount * (along_u * (uvs[k][0] - uvs[0][0]) + along_v * (uvs[k][1] - uvs[0][1]));
        let m: DVec3 = (0..3).map(|i| maps.rises[vertices[i]] * weights[i]).sum();
        bumped_normal(n, m.to_array(), [(b - a).to_array(), (c - a).to_array()], [rise(1), rise(2)], otherwise)
    }

    /// The exponent of highlights of a material with this one, and what they are multiplied by, as images have it at a
    /// hit.
    pub(super) fn gloss(&self, hit: &Hit, exponent: f64) -> [f64; 2] {
        let solid = &self.solids[hit.solid];
        let exponent = exponent * self.factor_of_one(hit, MapKind::Shininess);
        let looked_up = self.looked_up(hit, MapKind::Normal).filter(|_| solid.terms.has(Frequency::Fragment));
        let Some((map, place)) = looked_up else { return [exponent, 1.0] };
        match map.far_normals {
            FarNormals::Mean => [exponent, 1.0],
            FarNormals::Toksvig => toksvig(mean_length(place.normal(map), turned(solid, map)), exponent),
            FarNormals::Lean => {
                let covariance = place.slopes(map).covariance(turned(solid, map));
                let [.., factor] = lean_lobe(covariance, exponent);
                let [even, _] = toksvig(spread_length(covariance), exponent);
                [even, factor]
            }
        }
    }

    /// Highlights about a normal of the front that are not round, of a material with this exponent; `None` where they
    /// are.
    pub(super) fn axial(&self, hit: &Hit, n: Color, exponent: f64) -> Option<AxialLobe> {
        let solid = &self.solids[hit.solid];
        let (maps, (triangle, weights)) = (solid.maps.as_ref()?, hit.on_triangle()?);
        let (map, place) = self.looked_up(hit, MapKind::Normal)?;
        if map.far_normals != FarNormals::Lean {
            return None;
        }
        let exponent = exponent * self.factor_of_one(hit, MapKind::Shininess);
        let [aa, ab, bb, _] = lean_lobe(place.slopes(map).covariance(turned(solid, map)), exponent);
        let (t, w) = maps.tangent(solid.vertices(triangle), weights);
        Some(AxialLobe { axes: lobe_axes(n, t, w), widths: [aa, ab, bb] })
    }

    /// The image of a kind, and where on it a hit lies.
    fn looked_up(&self, hit: &Hit, kind: MapKind) -> Option<(&SolidMap, PointOnMap)> {
        let solid = &self.solids[hit.solid];
        let map = solid.maps.as_ref()?.slots[kind as usize].as_ref()?;
        let (triangle, weights) = hit.on_triangle()?;
        Some((map, self.place(solid, map, triangle, weights)))
    }

    /// What the solid that an object is cut from multiplies ambient and diffuse light by: 1 where there is none.
    pub(super) fn cut_color(&self, hit: &Hit) -> Color {
        let solid = &self.solids[hit.solid];
        let (Some(cut_from), Some((triangle, weights))) = (&solid.cut_from, hit.on_triangle()) else { return [1.0; 3] };
        let positions = solid.mesh.positions();
        let places = solid.vertices(triangle).map(|number| positions[number].as_dvec3().to_array());
        let (place, ways) = self.over_triangle(solid, places, triangle, weights);
        cut_from.color_at(place, ways)
    }

    fn place(&self, solid: &Solid, map: &SolidMap, triangle: u32, weights: [f64; 3]) -> PointOnMap {
        let uvs = solid.vertices(triangle).map(|number| map.uvs[number]);
        let (uv, footprint) = self.over_triangle(solid, uvs, triangle, weights);
        PointOnMap { uv, footprint }
    }

    /// Numbers at a point of a triangle, from those of its corners, and by how much they change from a pixel to the
    /// next, along x and along y.
    ///
    /// The footprint is a pixel's. On a triangle u = Σ uᵢVᵢ/Σ Vᵢ, Vᵢ the volume of the point of the picture with the edge opposite to a
    /// corner, which is linear over the picture: the derivative follows by the rule of quotients.
    fn over_triangle<const N: usize>(
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

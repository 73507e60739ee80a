//! What the light from all directions adds at a hit, and what is seen of it.

use bevy_math::DVec3;
use halfway_lighting::Frequency;
use halfway_lighting::equations::vector::scale;
use halfway_lighting::equations::{
    Coefficients, ShadedPoint, interpolated_normal, lobe_angle, lobe_exponent, mirrored, side_normal,
    specular_exponent, surroundings, view_vector,
};

use super::gather::OracleScene;
use super::raster::{Hit, HitPoint};
use super::solid::{Color, Solid};

impl OracleScene {
    /// What is seen along a ray where nothing is drawn.
    pub(super) fn behind(&self, ray: DVec3) -> Color {
        let sky = self.surroundings.as_ref().and_then(|around| Some((around, around.sky?)));
        sky.map_or(self.background, |(around, level)| scale(around.at(ray, level), around.strength))
    }

    /// What the environment adds to the ambient and to the specular terms at a hit, whose material there is given.
    pub(super) fn surrounded(&self, hit: &Hit, material: &Coefficients<f64>) -> [Color; 2] {
        let Some(around) = &self.surroundings else { return [[0.0; 3]; 2] };
        let solid = &self.solids[hit.solid];
        let (p, n) = self.point(solid, hit);
        let surface = ShadedPoint { position: p.to_array(), normal: side_normal(n, hit.front) };
        let r = mirrored(surface.normal, view_vector(&surface, &self.viewer));
        let exponent = specular_exponent(solid.reflectance, material.shininess);
        let [exponent, _] = self.gloss(hit, exponent);
        let alpha = lobe_exponent(solid.reflectance, exponent);
        let level = around.map.level_of(lobe_angle(alpha));
        let arriving = [around.mean_light(surface.normal), around.at(DVec3::from_array(r), level)];
        surroundings([material.kd, material.ks], around.strength, arriving)
    }

    /// Where a hit lies, and the normal of the front there: that of the triangle under flat shading, and one that
    /// images turn only where light is shaded at the fragments.
    fn point(&self, solid: &Solid, hit: &Hit) -> (DVec3, Color) {
        let (triangle, [u, v, w]) = match hit.place {
            HitPoint::Triangle(triangle, weights) => (triangle, weights),
            HitPoint::Surface { p, n } => return (p, n.to_array()),
        };
        let [a, b, c] = solid.lit_triangle(triangle);
        let p = a * u + b * v + c * w;
        let geometric = solid.face(triangle).unwrap_or(DVec3::ZERO).to_array();
        if solid.terms.has(Frequency::Triangle) {
            return (p, geometric);
        }
        let [a, b, c] = solid.vertices(triangle).map(|number| solid.normals[number]);
        let n = (a * u + b * v + c * w).to_array();
        let smooth = interpolated_normal(n, geometric);
        let turns = solid.terms.has(Frequency::Fragment);
        (p, if turns { self.relief(hit, n, smooth) } else { smooth })
    }
}

//! The environment's light at a hit, and the sky behind the scene.

use bevy_math::DVec3;
use halfway_lighting::Frequency;
use halfway_lighting::equations::vector::scale;
use halfway_lighting::equations::{
    Coefficients, ShadedPoint, interpolated_normal, lobe_angle, lobe_exponent, mirrored, side_normal,
    specular_exponent, surroundings, view_vector,
};

use super::raster::{Hit, HitPoint};
use super::scene::OracleScene;
use super::shows::Shows;
use super::solid::{Color, Solid};

impl OracleScene {
    /// The colour along a ray that hits nothing: the sky or the background.
    pub(super) fn behind(&self, ray: DVec3) -> Color {
        if self.shows != Shows::Color {
            return [0.0; 3];
        }
        let sky = self.environment.as_ref().and_then(|environment| Some((environment, environment.sky?)));
        sky.map_or(self.background, |(environment, level)| scale(environment.at(ray, level), environment.strength))
    }

    /// The environment's ambient and specular terms at a hit, with the material there.
    pub(super) fn environment_terms(&self, hit: &Hit, material: &Coefficients<f64>) -> [Color; 2] {
        let Some(environment) = &self.environment else { return [[0.0; 3]; 2] };
        let solid = &self.solids[hit.solid];
        let (p, n) = self.point(solid, hit);
        let surface = ShadedPoint { position: p.to_array(), normal: side_normal(n, hit.front) };
        let r = mirrored(surface.normal, view_vector(&surface, &self.viewer));
        let exponent = specular_exponent(solid.reflectance, material.shininess);
        let [exponent, _] = self.highlight_exponent(hit, exponent);
        let alpha = lobe_exponent(solid.reflectance, exponent);
        let level = environment.map.level_of(lobe_angle(alpha));
        let arriving = [environment.mean_light(surface.normal), environment.at(DVec3::from_array(r), level)];
        surroundings([material.kd, material.ks], environment.strength, arriving)
    }

    /// The position of a hit and the front's normal there: the triangle's own under flat shading, else the interpolated
    /// one, which images turn only if a term is shaded at the fragments.
    pub(super) fn point(&self, solid: &Solid, hit: &Hit) -> (DVec3, Color) {
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
        (p, if turns { self.front_normal(hit, n, smooth) } else { smooth })
    }
}

//! I at a point of an object.

use bevy_math::DVec3;
use halfway_lighting::Frequency;
use halfway_lighting::equations::vector::{add, mul};
use halfway_lighting::equations::{Coefficients, ShadedPoint, interpolated_normal, light_terms, side_normal};

use super::gather::OracleScene;
use super::raster::{Hit, HitPoint};
use super::solid::{Color, Solid};

impl OracleScene {
    /// I of the side that is seen: emission and ambient, and the terms of the lights where they are evaluated.
    pub(super) fn value(&self, hit: &Hit) -> Color {
        let solid = &self.solids[hit.solid];
        let side = solid.side(hit.front);
        let material = side.coefficients.tinted(solid.color(hit.on_triangle()).truncate().to_array());
        let unlit = add(material.ke, mul(material.ka, self.ambient));
        let lit = match hit.place {
            HitPoint::Triangle(triangle, weights) => self.on_triangle(solid, hit.front, &material, triangle, weights),
            HitPoint::Surface { p, n } => self.lit(solid, hit.front, &material, p, n.to_array(), Frequency::Fragment),
        };
        add(unlit, lit)
    }

    /// What the lights add at a point of a triangle, whose material there is given. What is evaluated at the triangle or at
    /// its vertices is remembered.
    fn on_triangle(
        &self,
        solid: &Solid,
        front: bool,
        material: &Coefficients<f64>,
        triangle: u32,
        weights: [f64; 3],
    ) -> Color {
        let shaded = &solid.side(front).shaded;
        let corners = solid.triangle(triangle);
        // Triangles without area have no normal, and are not drawn.
        let geometric = || solid.face(triangle).unwrap_or(DVec3::ZERO).to_array();
        let mut i = [0.0; 3];
        if solid.terms.has(Frequency::Triangle) {
            let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
            let of_triangle = || self.lit(solid, front, material, centroid, geometric(), Frequency::Triangle);
            i = add(i, *shaded[triangle as usize].get_or_init(of_triangle));
        }
        if solid.terms.has(Frequency::Vertex) {
            let of_vertex = |number: usize| {
                let (p, n) = (solid.corners[number], solid.normals[number].to_array());
                let color = solid.colors.as_ref().map_or(DVec3::ONE, |colors| colors[number].truncate());
                let material = || solid.side(front).coefficients.tinted(color.to_array());
                *shaded[number].get_or_init(|| self.lit(solid, front, &material(), p, n, Frequency::Vertex))
            };
            let of_vertices = solid.vertices(triangle).map(|number| DVec3::from_array(of_vertex(number)));
            i = add(i, mixed(of_vertices, weights).to_array());
        }
        if solid.terms.has(Frequency::Fragment) {
            let n = mixed(solid.vertices(triangle).map(|number| solid.normals[number]), weights).to_array();
            let n = interpolated_normal(n, geometric());
            i = add(i, self.lit(solid, front, material, mixed(corners, weights), n, Frequency::Fragment));
        }
        i
    }

    /// What those terms of the lights add at a point of one side that have this frequency; `n` is the normal of the front.
    ///
    /// An ambient colour that attenuates goes with the diffuse term; one that does not is in the scene's ambient.
    fn lit(
        &self,
        solid: &Solid,
        front: bool,
        material: &Coefficients<f64>,
        p: DVec3,
        n: [f64; 3],
        at: Frequency,
    ) -> Color {
        let surface = ShadedPoint { position: p.to_array(), normal: side_normal(n, front) };
        self.lights.iter().fold([0.0; 3], |mut i, light| {
            let terms = light_terms(&surface, material, light, &self.viewer, solid.reflectance);
            if solid.terms.diffuse == at {
                i = add(i, terms.diffuse);
                if light.attenuate_ambient {
                    i = add(i, terms.ambient);
                }
            }
            if solid.terms.specular == at {
                i = add(i, terms.specular);
            }
            i
        })
    }
}

/// The mean of what the corners hold.
fn mixed([a, b, c]: [DVec3; 3], [u, v, w]: [f64; 3]) -> DVec3 {
    a * u + b * v + c * w
}

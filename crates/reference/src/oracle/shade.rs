//! I at a point of an object.

use bevy_math::DVec3;
use halfway_lighting::Frequency;
use halfway_lighting::equations::vector::{add, mul};
use halfway_lighting::equations::{Coefficients, ShadedPoint, interpolated_normal, light_terms, side_normal};
use halfway_texture::lookup;

use super::gather::OracleScene;
use super::raster::{Hit, HitPoint};
use super::solid::{Color, Parts, Solid};

impl OracleScene {
    /// I of the side that is seen: emission and ambient, and the terms of the lights where they are evaluated. An image
    /// multiplies the ambient and diffuse terms at the point itself.
    pub(super) fn value(&self, hit: &Hit) -> Color {
        let solid = &self.solids[hit.solid];
        let side = solid.side(hit.front);
        let material = side.coefficients.tinted(solid.color(hit.on_triangle()).truncate().to_array());
        let unlit = Parts { tinted: mul(material.ka, self.ambient), plain: material.ke };
        let lit = match hit.place {
            HitPoint::Triangle(triangle, weights) => self.on_triangle(solid, hit.front, &material, triangle, weights),
            HitPoint::Surface { p, n } => self.lit(solid, hit.front, &material, p, n.to_array(), Frequency::Fragment),
        };
        let Parts { tinted, plain } = unlit.plus(lit);
        let [r, g, b, _] = self.mapped(hit);
        add(mul(tinted, [r, g, b]), plain)
    }

    /// The opacity of what is seen; 1 where the object is not blended.
    pub(super) fn opacity(&self, hit: &Hit) -> f64 {
        let solid = &self.solids[hit.solid];
        if !solid.blend {
            return 1.0;
        }
        solid.side(hit.front).opacity * solid.color(hit.on_triangle()).w * self.mapped(hit)[3]
    }

    /// What the image has at the point that is seen, each number in 0 to 1; 1 where there is none.
    ///
    /// The footprint is a pixel's. On a triangle u = Σ uᵢVᵢ/Σ Vᵢ, Vᵢ the volume of the ray with the edge opposite to a corner,
    /// which is linear over the picture: the derivative follows by the rule of quotients.
    fn mapped(&self, hit: &Hit) -> [f64; 4] {
        let solid = &self.solids[hit.solid];
        let (Some(map), Some((triangle, weights))) = (&solid.map, hit.on_triangle()) else { return [1.0; 4] };
        let [a, b, c] = solid.triangle(triangle);
        let uvs = solid.vertices(triangle).map(|number| map.uvs[number]);
        let uv = [0, 1].map(|k| (0..3).map(|i| weights[i] * uvs[i][k]).sum::<f64>());
        let ray = mixed([a, b, c], weights) / hit.depth;
        let normals = [b.cross(c), c.cross(a), a.cross(b)];
        let sum: f64 = normals.iter().map(|n| n.dot(ray)).sum();
        let first = self.view.ray(0.0, 0.0);
        let footprint = [self.view.ray(1.0, 0.0), self.view.ray(0.0, 1.0)].map(|next| {
            let grown = normals.map(|n| n.dot(next - first));
            [0, 1].map(|k| (0..3).map(|i| (uvs[i][k] - uv[k]) * grown[i]).sum::<f64>() / sum)
        });
        lookup::filtered(&map.pyramid, &map.sampling, uv, footprint).map(|number| number.clamp(0.0, 1.0))
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
    ) -> Parts {
        let shaded = &solid.side(front).shaded;
        let corners = solid.triangle(triangle);
        // Triangles without area have no normal, and are not drawn.
        let geometric = || solid.face(triangle).unwrap_or(DVec3::ZERO).to_array();
        let mut i = Parts::default();
        if solid.terms.has(Frequency::Triangle) {
            let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
            let of_triangle = || self.lit(solid, front, material, centroid, geometric(), Frequency::Triangle);
            i = i.plus(*shaded[triangle as usize].get_or_init(of_triangle));
        }
        if solid.terms.has(Frequency::Vertex) {
            let of_vertex = |number: usize| {
                let (p, n) = (solid.corners[number], solid.normals[number].to_array());
                let color = solid.colors.as_ref().map_or(DVec3::ONE, |colors| colors[number].truncate());
                let material = || solid.side(front).coefficients.tinted(color.to_array());
                *shaded[number].get_or_init(|| self.lit(solid, front, &material(), p, n, Frequency::Vertex))
            };
            let of_vertices = solid.vertices(triangle).map(of_vertex);
            let mean = |of: fn(&Parts) -> Color| {
                mixed(of_vertices.each_ref().map(|parts| DVec3::from_array(of(parts))), weights).to_array()
            };
            i = i.plus(Parts { tinted: mean(|parts| parts.tinted), plain: mean(|parts| parts.plain) });
        }
        if solid.terms.has(Frequency::Fragment) {
            let n = mixed(solid.vertices(triangle).map(|number| solid.normals[number]), weights).to_array();
            let n = interpolated_normal(n, geometric());
            i = i.plus(self.lit(solid, front, material, mixed(corners, weights), n, Frequency::Fragment));
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
    ) -> Parts {
        let surface = ShadedPoint { position: p.to_array(), normal: side_normal(n, front) };
        self.lights.iter().fold(Parts::default(), |mut i, light| {
            let terms = light_terms(&surface, material, light, &self.viewer, solid.reflectance);
            if solid.terms.diffuse == at {
                i.tinted = add(i.tinted, terms.diffuse);
                if light.attenuate_ambient {
                    i.tinted = add(i.tinted, terms.ambient);
                }
            }
            if solid.terms.specular == at {
                i.plain = add(i.plain, terms.specular);
            }
            i
        })
    }
}

impl Parts {
    fn plus(self, other: Self) -> Self {
        Self { tinted: add(self.tinted, other.tinted), plain: add(self.plain, other.plain) }
    }
}

/// The mean of what the corners hold.
fn mixed([a, b, c]: [DVec3; 3], [u, v, w]: [f64; 3]) -> DVec3 {
    a * u + b * v + c * w
}

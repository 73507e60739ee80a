//! The intensity I at a point of an object.

use bevy_math::DVec3;
use halfway_lighting::equations::vector::{add, mul, scale};
use halfway_lighting::equations::{
    Coefficients, ShadedPoint, interpolated_normal, light_terms, side_normal, specular_exponent,
};
use halfway_lighting::lights::LightSource;
use halfway_lighting::{Frequency, Reflectance};
use halfway_texture::MapKind;

use super::mapped::AnisotropicLobe;
use super::raster::{Hit, HitPoint};
use super::scene::OracleScene;
use super::shows::Shows;
use super::solid::{Color, Solid, TermSums};

impl OracleScene {
    /// The value that the side that a ray hits shows.
    pub(super) fn value(&self, hit: &Hit) -> Color {
        match self.shows {
            Shows::Color => self.intensity_at(hit),
            Shows::Albedo => self.albedo(hit),
            Shows::Coverage => [1.0; 3],
        }
    }

    /// The diffuse reflectance at a hit.
    fn albedo(&self, hit: &Hit) -> Color {
        let solid = &self.solids[hit.solid];
        let color = solid.color(hit.on_triangle()).truncate().to_array();
        let material = solid.side(hit.front).coefficients.tinted(color);
        let [r, g, b, _] = self.factor(hit, MapKind::Color);
        mul([r, g, b], mul(self.solid_color(hit), if solid.lit { material.kd } else { material.ka }))
    }

    /// The intensity of the side that a ray hits: emission, ambient light, and the terms of the lights where they are
    /// evaluated. Images and solids multiply each of them at the point itself.
    fn intensity_at(&self, hit: &Hit) -> Color {
        let solid = &self.solids[hit.solid];
        let side = solid.side(hit.front);
        let material = side.coefficients.tinted(solid.color(hit.on_triangle()).truncate().to_array());
        let around = if solid.lit { self.ambient } else { [1.0; 3] };
        let unlit = TermSums { ambient: mul(material.ka, around), ..TermSums::default() };
        let lit = match hit.place {
            HitPoint::Triangle(triangle, weights) => self.on_triangle(solid, hit, &material, triangle, weights),
            HitPoint::Surface { p, n } => {
                self.light_sums(solid, hit.front, (&material, None), p, n.to_array(), Frequency::Fragment)
            }
        };
        let [of_normal, of_mirror] = self.environment_terms(hit, &material);
        let around = TermSums { ambient: of_normal, diffuse: [0.0; 3], specular: of_mirror };
        let TermSums { ambient, diffuse, specular } = unlit.plus(lit).plus(around);
        let color = |kind: MapKind| {
            let [r, g, b, _] = self.factor(hit, kind);
            [r, g, b]
        };
        let occlusion = self.factor_of_one(hit, MapKind::Occlusion);
        let tinted = mul(color(MapKind::Color), mul(self.solid_color(hit), add(scale(ambient, occlusion), diffuse)));
        let plain = add(mul(color(MapKind::Specular), specular), mul(color(MapKind::Emission), material.ke));
        add(tinted, plain)
    }

    /// The opacity at a hit, whether or not the object is blended.
    pub(super) fn surface_opacity(&self, hit: &Hit) -> f64 {
        let solid = &self.solids[hit.solid];
        solid.side(hit.front).coefficients.opacity * solid.color(hit.on_triangle()).w * self.mapped_opacity(hit)
    }

    /// The opacity at a hit; 1 if the object is not blended.
    pub(super) fn opacity(&self, hit: &Hit) -> f64 {
        if self.solids[hit.solid].blend { self.surface_opacity(hit) } else { 1.0 }
    }

    /// Whether the mask of an object cuts it away at a hit.
    pub(super) fn is_cut(&self, hit: &Hit) -> bool {
        self.solids[hit.solid].mask.is_some_and(|cutoff| self.surface_opacity(hit) < cutoff)
    }

    /// The terms of the lights at a point of a triangle, with the material there. Values at the triangle or at its
    /// vertices are cached.
    fn on_triangle(
        &self,
        solid: &Solid,
        hit: &Hit,
        material: &Coefficients<f64>,
        triangle: u32,
        weights: [f64; 3],
    ) -> TermSums {
        let front = hit.front;
        let shaded = &solid.side(front).shaded;
        let corners = solid.lit_triangle(triangle);
        // Triangles without area have no normal, and are not drawn.
        let geometric = || solid.face(triangle).unwrap_or(DVec3::ZERO).to_array();
        let mut i = TermSums::default();
        if solid.terms.has(Frequency::Triangle) {
            let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
            let of_triangle =
                || self.light_sums(solid, front, (material, None), centroid, geometric(), Frequency::Triangle);
            i = i.plus(*shaded[triangle as usize].get_or_init(of_triangle));
        }
        if solid.terms.has(Frequency::Vertex) {
            let of_vertex = |number: usize| {
                let (p, n) = (solid.corners[number], solid.normals[number].to_array());
                let color = solid.colors.as_ref().map_or(DVec3::ONE, |colors| colors[number].truncate());
                let material = || solid.side(front).coefficients.tinted(color.to_array());
                *shaded[number]
                    .get_or_init(|| self.light_sums(solid, front, (&material(), None), p, n, Frequency::Vertex))
            };
            let of_vertices = solid.vertices(triangle).map(of_vertex);
            let mean = |of: fn(&TermSums) -> Color| {
                weighted(of_vertices.each_ref().map(|parts| DVec3::from_array(of(parts))), weights).to_array()
            };
            i = i.plus(TermSums {
                ambient: mean(|parts| parts.ambient),
                diffuse: mean(|parts| parts.diffuse),
                specular: mean(|parts| parts.specular),
            });
        }
        if solid.terms.has(Frequency::Fragment) {
            let n = weighted(solid.vertices(triangle).map(|number| solid.normals[number]), weights).to_array();
            let n = self.front_normal(hit, n, interpolated_normal(n, geometric()));
            let (mut material, mut axial) = (*material, None);
            if solid.has_exponents_of_images() {
                // Images change the exponent after it is matched.
                let matched = specular_exponent(solid.reflectance, material.shininess);
                let [exponent, factor] = self.highlight_exponent(hit, matched);
                axial = self.axial(hit, n, matched);
                (material.shininess, material.ks) = (exponent, scale(material.ks, factor));
            }
            let p = weighted(corners, weights);
            i = i.plus(self.light_sums(solid, front, (&material, axial.as_ref()), p, n, Frequency::Fragment));
        }
        i
    }

    /// The sum of all lights' terms that have the frequency `at`, at a point of one side; `n` is the normal of the
    /// front.
    ///
    /// An ambient colour that attenuates goes with the diffuse term; one that does not is in the scene's ambient.
    fn light_sums(
        &self,
        solid: &Solid,
        front: bool,
        (material, axial): (&Coefficients<f64>, Option<&AnisotropicLobe>),
        p: DVec3,
        n: [f64; 3],
        at: Frequency,
    ) -> TermSums {
        let reflectance = match solid.reflectance {
            Reflectance::BlinnPhongMatched if at == Frequency::Fragment && solid.has_exponents_of_images() => {
                Reflectance::BlinnPhong
            }
            reflectance => reflectance,
        };
        let surface = ShadedPoint { position: p.to_array(), normal: side_normal(n, front) };
        self.lights.iter().fold(TermSums::default(), |mut i, light| {
            let material = axial.map_or(*material, |axial| axial.toward(light, &surface, &self.viewer, material));
            let terms = light_terms(&surface, &material, light, &self.viewer, reflectance);
            if solid.terms.diffuse == at {
                i.diffuse = add(i.diffuse, terms.diffuse);
                if light.steady_ambient().iter().all(|&channel| channel <= 0.0) {
                    i.ambient = add(i.ambient, terms.ambient);
                }
            }
            if solid.terms.specular == at {
                i.specular = add(i.specular, terms.specular);
            }
            i
        })
    }
}

impl TermSums {
    fn plus(self, other: Self) -> Self {
        Self {
            ambient: add(self.ambient, other.ambient),
            diffuse: add(self.diffuse, other.diffuse),
            specular: add(self.specular, other.specular),
        }
    }
}

/// The weighted mean of the corners' values.
fn weighted([a, b, c]: [DVec3; 3], [u, v, w]: [f64; 3]) -> DVec3 {
    a * u + b * v + c * w
}

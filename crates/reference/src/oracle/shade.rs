//! The intensity I at a point of an object.

use bevy_math::DVec3;
use halfway_lighting::equations::vector::{add, mul, scale};
use halfway_lighting::equations::{
    Coefficients, Light, LightTerms, ShadedPoint, interpolated_normal, light_terms, side_normal, specular_exponent,
};
use halfway_lighting::lights::LightSource;
use halfway_lighting::{Frequency, Reflectance, Terms};
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
    /// evaluated.
    fn intensity_at(&self, hit: &Hit) -> Color {
        self.parts(hit).intensity()
    }

    /// The parts of the intensity of the side that a ray hits.
    pub(super) fn parts(&self, hit: &Hit) -> IntensityParts {
        let solid = &self.solids[hit.solid];
        let material = self.material_at(hit);
        let around = if solid.lit { self.ambient } else { [1.0; 3] };
        let unlit = TermSums { ambient: mul(material.ka, around), ..TermSums::default() };
        let lit = match hit.place {
            HitPoint::Triangle(triangle, weights) => self.on_triangle(solid, hit, &material, triangle, weights),
            HitPoint::Surface { p, n } => self.light_sums(solid, hit.front, &Evaluation::on_surface(p, n, material)),
        };
        let [of_normal, of_mirror] = self.environment_terms(hit, &material);
        let environment = TermSums { ambient: of_normal, diffuse: [0.0; 3], specular: of_mirror };
        let color = |kind: MapKind| {
            let [r, g, b, _] = self.factor(hit, kind);
            [r, g, b]
        };
        IntensityParts {
            unlit,
            lit,
            environment,
            emission: material.ke,
            color: color(MapKind::Color),
            solid: self.solid_color(hit),
            occlusion: self.factor_of_one(hit, MapKind::Occlusion),
            specular: color(MapKind::Specular),
            glow: color(MapKind::Emission),
        }
    }

    /// The coefficients of the side that a ray hits, with the vertex colours there.
    pub(super) fn material_at(&self, hit: &Hit) -> Coefficients<f64> {
        let solid = &self.solids[hit.solid];
        solid.side(hit.front).coefficients.tinted(solid.color(hit.on_triangle()).truncate().to_array())
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
        let mut i = TermSums::default();
        if solid.terms.has(Frequency::Triangle) {
            let of_triangle = || self.light_sums(solid, front, &at_triangle(solid, *material, triangle));
            i = i.plus(*shaded[triangle as usize].get_or_init(of_triangle));
        }
        if solid.terms.has(Frequency::Vertex) {
            let of_vertex = |number: usize| {
                *shaded[number].get_or_init(|| self.light_sums(solid, front, &at_vertex(solid, front, number)))
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
            i = i.plus(self.light_sums(solid, front, &self.at_fragment(solid, hit, *material, (triangle, weights))));
        }
        i
    }

    /// The evaluation at a point of a triangle, with the material there.
    pub(super) fn at_fragment(
        &self,
        solid: &Solid,
        hit: &Hit,
        mut material: Coefficients<f64>,
        (triangle, weights): (u32, [f64; 3]),
    ) -> Evaluation {
        let n = weighted(solid.vertices(triangle).map(|number| solid.normals[number]), weights).to_array();
        let n = self.front_normal(hit, n, interpolated_normal(n, geometric(solid, triangle)));
        let mut axial = None;
        if solid.has_exponents_of_images() {
            // Images change the exponent after it is matched.
            let matched = specular_exponent(solid.reflectance, material.shininess);
            let [exponent, factor] = self.highlight_exponent(hit, matched);
            axial = self.axial(hit, n, matched);
            (material.shininess, material.ks) = (exponent, scale(material.ks, factor));
        }
        Evaluation { at: Frequency::Fragment, p: weighted(solid.lit_triangle(triangle), weights), n, material, axial }
    }

    /// The sum of all lights' terms that have the frequency of an evaluation, on one side.
    ///
    /// An ambient colour that attenuates goes with the diffuse term; one that does not is in the scene's ambient.
    fn light_sums(&self, solid: &Solid, front: bool, evaluation: &Evaluation) -> TermSums {
        self.lights.iter().fold(TermSums::default(), |i, light| {
            let (_, terms) = self.light_at(solid, front, evaluation, light);
            i.plus(evaluation.counted(solid.terms, light, &terms))
        })
    }

    /// The terms of a light at an evaluation on one side, and the material that they are of.
    pub(super) fn light_at(
        &self,
        solid: &Solid,
        front: bool,
        evaluation: &Evaluation,
        light: &Light<f64>,
    ) -> (Coefficients<f64>, LightTerms<f64>) {
        let Evaluation { material, axial, .. } = evaluation;
        let surface = evaluation.surface(front);
        let material = axial.as_ref().map_or(*material, |axial| axial.toward(light, &surface, &self.viewer, material));
        (material, light_terms(&surface, &material, light, &self.viewer, evaluation.reflectance(solid)))
    }
}

/// A point of an object at which terms of the lights are evaluated.
#[derive(Clone, Debug)]
pub(super) struct Evaluation {
    pub(super) at: Frequency,
    pub(super) p: DVec3,
    /// The normal of the front.
    pub(super) n: Color,
    pub(super) material: Coefficients<f64>,
    pub(super) axial: Option<AnisotropicLobe>,
}

impl Evaluation {
    pub(super) fn on_surface(p: DVec3, n: DVec3, material: Coefficients<f64>) -> Self {
        Self { at: Frequency::Fragment, p, n: n.to_array(), material, axial: None }
    }

    /// The point on one side.
    pub(super) fn surface(&self, front: bool) -> ShadedPoint<f64> {
        ShadedPoint { position: self.p.to_array(), normal: side_normal(self.n, front) }
    }

    /// The reflectance for the evaluation's material, whose exponent is matched already where images change it.
    pub(super) fn reflectance(&self, solid: &Solid) -> Reflectance {
        match solid.reflectance {
            Reflectance::BlinnPhongMatched if self.at == Frequency::Fragment && solid.has_exponents_of_images() => {
                Reflectance::BlinnPhong
            }
            reflectance => reflectance,
        }
    }

    /// The terms of a light that are evaluated here, and are not in the scene's ambient.
    pub(super) fn counted(&self, of: Terms, light: &Light<f64>, terms: &LightTerms<f64>) -> TermSums {
        let mut counted = TermSums::default();
        if of.diffuse == self.at {
            counted.diffuse = terms.diffuse;
            if light.steady_ambient().iter().all(|&channel| channel <= 0.0) {
                counted.ambient = terms.ambient;
            }
        }
        if of.specular == self.at {
            counted.specular = terms.specular;
        }
        counted
    }
}

/// The evaluation of a whole triangle, with the material at the visible point.
pub(super) fn at_triangle(solid: &Solid, material: Coefficients<f64>, triangle: u32) -> Evaluation {
    let [a, b, c] = solid.lit_triangle(triangle);
    let (p, n) = ((a + b + c) / 3.0, geometric(solid, triangle));
    Evaluation { at: Frequency::Triangle, p, n, material, axial: None }
}

/// The evaluation at a vertex, by its number in the mesh.
pub(super) fn at_vertex(solid: &Solid, front: bool, number: usize) -> Evaluation {
    let color = solid.colors.as_ref().map_or(DVec3::ONE, |colors| colors[number].truncate());
    let material = solid.side(front).coefficients.tinted(color.to_array());
    let (p, n) = (solid.corners[number], solid.normals[number].to_array());
    Evaluation { at: Frequency::Vertex, p, n, material, axial: None }
}

/// The normal of a triangle's front. Triangles without area have none, and are not drawn.
fn geometric(solid: &Solid, triangle: u32) -> Color {
    solid.face(triangle).unwrap_or(DVec3::ZERO).to_array()
}

/// The parts of an intensity, and the factors of images and solids, which multiply them at the point itself.
#[derive(Clone, Copy, Debug)]
pub(super) struct IntensityParts {
    /// ka·(Ga + Σ La), La of the lights that do not attenuate it.
    pub(super) unlit: TermSums,
    /// The terms of the lights.
    pub(super) lit: TermSums,
    /// The terms of the environment.
    pub(super) environment: TermSums,
    /// ke.
    pub(super) emission: Color,
    /// The factor of ambient and diffuse light by the colour image.
    pub(super) color: Color,
    /// The factor of ambient and diffuse light by the solid.
    pub(super) solid: Color,
    /// The factor of ambient light.
    pub(super) occlusion: f64,
    /// The factor of highlights.
    pub(super) specular: Color,
    /// The factor of the emission.
    pub(super) glow: Color,
}

impl IntensityParts {
    /// The sums of the terms, before images.
    pub(super) fn sums(&self) -> TermSums {
        self.unlit.plus(self.lit).plus(self.environment)
    }

    /// I.
    pub(super) fn intensity(&self) -> Color {
        let TermSums { ambient, diffuse, specular } = self.sums();
        let tinted = mul(self.color, mul(self.solid, add(scale(ambient, self.occlusion), diffuse)));
        add(tinted, add(mul(self.specular, specular), mul(self.glow, self.emission)))
    }
}

impl TermSums {
    pub(super) fn plus(self, other: Self) -> Self {
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

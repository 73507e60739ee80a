//! The intensity at a point of an object, by a student.
//!
//! The formulas are written out once more, so that each step has a place for the mistakes that are made there; a test
//! holds them against the oracle's.

use bevy_math::DVec3;
use halfway_lighting::equations::vector::{add, dot, length, mul, neg, normalize, scale, sub};
use halfway_lighting::equations::{
    COINCIDENT, Coefficients, ConeTerms, Eye, GRAZING, Light, Point, ShadedPoint, attenuation, half_vector,
    interpolated_normal, light_terms, power, range_window, reflect, side_normal, specular_exponent, spot_factor,
};
use halfway_lighting::{Frequency, Reflectance};
use halfway_texture::MapKind;

use super::plan::{Student, StudentSolid, as_position, turned, turns_normals};
use crate::mistakes::Mistake;
use crate::oracle::mapped::AnisotropicLobe;
use crate::oracle::raster::{Hit, HitPoint};
use crate::oracle::solid::{Color, Solid, TermSums};

/// A light at a point, before the cosines.
struct Arrival {
    /// Toward the light.
    l: Color,
    /// Up to this n·l the light is behind the surface.
    grazing: f64,
    attenuation: f64,
    /// Range and cone.
    window: f64,
}

impl Student<'_> {
    /// The intensity at a hit.
    pub(super) fn intensity(&self, hit: &Hit) -> Color {
        let hit = &self.interpolated(hit);
        let (solid, mine) = (&self.scene.solids[hit.solid], &self.solids[hit.solid]);
        let material = mine.sides[usize::from(!hit.front)].tinted(self.vertex_color(solid, mine, hit));
        let unlit = if solid.lit { add(mul(material.ka, self.ambient), self.bare_ambient) } else { material.ka };
        let [of_normal, of_mirror] = self.scene.environment_terms(hit, &material);
        let lit = match hit.place {
            HitPoint::Triangle(triangle, weights) => self.on_triangle(hit, &material, triangle, weights),
            HitPoint::Surface { .. } => TermSums::default(),
        };
        let ambient = add(unlit, add(lit.ambient, of_normal));
        let specular = add(lit.specular, of_mirror);
        let color = |kind: MapKind| {
            let [r, g, b, _] = self.scene.factor(hit, kind);
            [r, g, b]
        };
        let image = if self.makes(Mistake::TexturesIgnored) {
            [1.0; 3]
        } else {
            mul(color(MapKind::Color), self.scene.solid_color(hit))
        };
        let occlusion = self.scene.factor_of_one(hit, MapKind::Occlusion);
        let tinted = mul(image, add(scale(ambient, occlusion), lit.diffuse));
        add(tinted, add(mul(color(MapKind::Specular), specular), mul(color(MapKind::Emission), material.ke)))
    }

    /// The hit, with the weights by which values are interpolated there.
    fn interpolated(&self, hit: &Hit) -> Hit {
        let (HitPoint::Triangle(triangle, weights), true) = (hit.place, self.makes(Mistake::AffineInterpolation))
        else {
            return *hit;
        };
        // Weights of space are those of the picture divided by w.
        let corners = self.scene.solids[hit.solid].lit_triangle(triangle);
        let affine = [0, 1, 2].map(|i| weights[i] * self.scene.view.w(corners[i]));
        let sum: f64 = affine.iter().sum();
        Hit { place: HitPoint::Triangle(triangle, affine.map(|weight| weight / sum)), ..*hit }
    }

    fn vertex_color(&self, solid: &Solid, mine: &StudentSolid, hit: &Hit) -> Color {
        let (Some(colors), HitPoint::Triangle(triangle, weights)) = (&solid.colors, hit.place) else { return [1.0; 3] };
        if self.makes(Mistake::VertexColorsIgnored) {
            return [1.0; 3];
        }
        let weights = if mine.terms.has(Frequency::Triangle) { [1.0 / 3.0; 3] } else { weights };
        weighted(solid.vertices(triangle).map(|number| colors[number].truncate()), weights).to_array()
    }

    /// The geometric normal of a triangle's front.
    fn geometric(&self, solid: &Solid, triangle: u32) -> Color {
        let n = if turns_normals(self.mistakes) {
            let [a, b, c] = solid.vertices(triangle).map(|number| solid.mesh.positions()[number].as_dvec3());
            turned(self.scene, solid, (b - a).cross(c - a), self.mistakes)
        } else {
            solid.face(triangle).unwrap_or(DVec3::ZERO)
        };
        let winding = if self.makes(Mistake::WindingReversed) { -n } else { n };
        winding.to_array()
    }

    fn on_triangle(&self, hit: &Hit, material: &Coefficients<f64>, triangle: u32, weights: [f64; 3]) -> TermSums {
        let (solid, mine) = (&self.scene.solids[hit.solid], &self.solids[hit.solid]);
        let shaded = &mine.shaded[usize::from(!hit.front)];
        let (corners, vertices) = (solid.lit_triangle(triangle), solid.vertices(triangle));
        let mut i = TermSums::default();
        if mine.terms.has(Frequency::Triangle) {
            let of_triangle = || {
                let (p, n) = self.flat_point(solid, mine, triangle);
                self.light_sums(hit, (material, None), p, n, Frequency::Triangle)
            };
            i = plus(i, *shaded[triangle as usize].get_or_init(of_triangle));
        }
        if mine.terms.has(Frequency::Vertex) {
            let of_vertex = |number: usize| {
                let colors = solid.colors.as_ref().filter(|_| !self.makes(Mistake::VertexColorsIgnored));
                let color = colors.map_or(DVec3::ONE, |colors| colors[number].truncate());
                let material = || mine.sides[usize::from(!hit.front)].tinted(color.to_array());
                let (p, n) = (solid.corners[number], mine.normals[number].to_array());
                *shaded[number].get_or_init(|| self.light_sums(hit, (&material(), None), p, n, Frequency::Vertex))
            };
            let [a, b, c] = vertices.map(of_vertex);
            let mean = |of: fn(&TermSums) -> Color| {
                weighted([of(&a), of(&b), of(&c)].map(DVec3::from_array), weights).to_array()
            };
            let sums = TermSums {
                ambient: mean(|parts| parts.ambient),
                diffuse: mean(|parts| parts.diffuse),
                specular: mean(|parts| parts.specular),
            };
            i = plus(i, sums);
        }
        if mine.terms.has(Frequency::Fragment) {
            let n = self.fragment_normal(hit, triangle, weights);
            let (mut material, mut axial) = (*material, None);
            if solid.has_exponents_of_images() {
                let matched = specular_exponent(mine.reflectance, material.shininess);
                let [exponent, factor] = self.scene.highlight_exponent(hit, matched);
                axial = self.scene.axial(hit, n, matched);
                (material.shininess, material.ks) = (exponent, scale(material.ks, factor));
            }
            let p = weighted(corners, weights);
            i = plus(i, self.light_sums(hit, (&material, axial.as_ref()), p, n, Frequency::Fragment));
        }
        i
    }

    /// The point and the normal at which a flat triangle is shaded.
    fn flat_point(&self, solid: &Solid, mine: &StudentSolid, triangle: u32) -> (DVec3, Color) {
        let [a, b, c] = solid.lit_triangle(triangle);
        let vertices = solid.vertices(triangle);
        if self.makes(Mistake::FlatFromFirstVertex) {
            (a, mine.normals[vertices[0]].to_array())
        } else if self.makes(Mistake::FlatFromLastVertex) {
            (c, mine.normals[vertices[2]].to_array())
        } else {
            ((a + b + c) / 3.0, self.geometric(solid, triangle))
        }
    }

    fn fragment_normal(&self, hit: &Hit, triangle: u32, weights: [f64; 3]) -> Color {
        let (solid, mine) = (&self.scene.solids[hit.solid], &self.solids[hit.solid]);
        let geometric = self.geometric(solid, triangle);
        if self.makes(Mistake::FaceNormals) {
            return geometric;
        }
        let n = weighted(solid.vertices(triangle).map(|number| mine.normals[number]), weights).to_array();
        let smooth = if self.makes(Mistake::NormalsNotRenormalised) { n } else { interpolated_normal(n, geometric) };
        self.scene.front_normal(hit, n, smooth)
    }

    /// The sum of all lights' terms that have the frequency `at`, at a point; `n` is the normal of the front.
    fn light_sums(
        &self,
        hit: &Hit,
        (material, axial): (&Coefficients<f64>, Option<&AnisotropicLobe>),
        p: DVec3,
        n: Color,
        at: Frequency,
    ) -> TermSums {
        let (solid, mine) = (&self.scene.solids[hit.solid], &self.solids[hit.solid]);
        let is_imaged = at == Frequency::Fragment && solid.has_exponents_of_images();
        let reflectance = match mine.reflectance {
            Reflectance::BlinnPhongMatched if is_imaged => Reflectance::BlinnPhong,
            reflectance => reflectance,
        };
        let normal = side_normal(n, hit.front || self.makes(Mistake::NormalsNotFlipped));
        let surface = ShadedPoint { position: p.to_array(), normal };
        let mut i = TermSums::default();
        for light in &self.lights {
            let material = axial.map_or(*material, |axial| axial.toward(light, &surface, &self.viewer, material));
            let terms = self.terms(light, &surface, &material, reflectance);
            if mine.terms.diffuse == at {
                (i.diffuse, i.ambient) = (add(i.diffuse, terms.diffuse), add(i.ambient, terms.ambient));
            }
            if mine.terms.specular == at {
                i.specular = add(i.specular, terms.specular);
            }
        }
        i
    }

    /// The terms of one light; the ambient one only where it attenuates.
    fn terms(
        &self,
        light: &Light<f64>,
        surface: &ShadedPoint<f64>,
        material: &Coefficients<f64>,
        reflectance: Reflectance,
    ) -> TermSums {
        let (colors, arrival, point) = match light {
            Light::Directional(it) => (&it.colors, self.parallel(it.toward, surface), None),
            Light::Point(it) => (&it.colors, self.radiating(it, None, surface), Some(it)),
            Light::Spot(it) => (&it.point.colors, self.radiating(&it.point, Some(&it.cone), surface), Some(&it.point)),
            Light::Hemisphere(_) => {
                let terms = light_terms(surface, material, light, &self.viewer, reflectance);
                return TermSums { ambient: [0.0; 3], diffuse: terms.diffuse, specular: terms.specular };
            }
        };
        let weight = arrival.attenuation * arrival.window;
        let ambient = if point.is_some_and(|point| point.attenuate_ambient) { weight } else { 0.0 };
        let of_highlight = if self.makes(Mistake::AttenuationOfDiffuseOnly) { arrival.window } else { weight };
        TermSums {
            ambient: scale(mul(material.ka, colors.la), ambient),
            diffuse: scale(mul(material.kd, colors.ld), weight * self.cosine(surface.normal, &arrival)),
            specular: scale(
                mul(material.ks, colors.ls),
                of_highlight * self.highlight(surface, &arrival, (reflectance, material.shininess)),
            ),
        }
    }

    /// Rays from an infinite distance.
    fn parallel(&self, toward: Color, surface: &ShadedPoint<f64>) -> Arrival {
        let attenuation = if self.makes(Mistake::AttenuationOfDirectional) {
            attenuation(self.attenuation, length(sub(as_position(self.scene, toward), surface.position)))
        } else {
            1.0
        };
        Arrival { l: toward, grazing: GRAZING.into(), attenuation, window: 1.0 }
    }

    /// Rays from a position, through a cone if there is one.
    fn radiating(&self, light: &Point<f64>, cone: Option<&ConeTerms<f64>>, surface: &ShadedPoint<f64>) -> Arrival {
        let offset = sub(light.position, surface.position);
        let (distance, from_eye) = (length(offset), length(surface.position));
        let least = f64::from(GRAZING);
        let (l, d, grazing) = match normalize(offset) {
            Some(l) if distance > f64::from(COINCIDENT) * from_eye => {
                (l, distance, least + least * (from_eye / distance))
            }
            _ => (surface.normal, 0.0, 0.0),
        };
        let l = if self.makes(Mistake::LightNotUnit) { offset } else { l };
        let measured = if self.makes(Mistake::AttenuationByEyeDistance) { from_eye } else { d };
        let window = light.range.map_or(1.0, |range| range_window(d, range));
        let spot = cone.map_or(1.0, |cone| spot_factor(dot(neg(l), cone.direction), cone));
        Arrival { l, grazing, attenuation: attenuation(light.attenuation, measured), window: window * spot }
    }

    /// Lambert's cosine.
    fn cosine(&self, n: Color, arrival: &Arrival) -> f64 {
        let cosine = dot(n, arrival.l);
        if self.makes(Mistake::CosineAbsolute) {
            cosine.abs()
        } else if self.makes(Mistake::CosineNotClamped) || cosine > arrival.grazing {
            cosine
        } else {
            0.0
        }
    }

    /// S.
    fn highlight(
        &self,
        surface: &ShadedPoint<f64>,
        arrival: &Arrival,
        (reflectance, shininess): (Reflectance, f64),
    ) -> f64 {
        let (n, l) = (surface.normal, arrival.l);
        let cosine = dot(n, l);
        if cosine <= arrival.grazing && !self.makes(Mistake::HighlightBehind) {
            return 0.0;
        }
        let v = self.toward_viewer(surface);
        let exponent = specular_exponent(reflectance, shininess);
        let highlight = match reflectance {
            Reflectance::Phong => {
                let r = reflect(l, n);
                power(dot(if self.makes(Mistake::ReflectionReversed) { neg(r) } else { r }, v), exponent)
            }
            Reflectance::BlinnPhong | Reflectance::BlinnPhongMatched => {
                let h =
                    if self.makes(Mistake::HalfwayNotUnit) { Some(scale(add(l, v), 0.5)) } else { half_vector(l, v) };
                h.map_or(0.0, |h| power(dot(n, h), exponent))
            }
        };
        if self.makes(Mistake::HighlightTimesCosine) { highlight * cosine.max(0.0) } else { highlight }
    }

    fn toward_viewer(&self, surface: &ShadedPoint<f64>) -> Color {
        let v = match self.viewer {
            Eye::Local(eye) => {
                let offset = sub(eye, surface.position);
                let unit = normalize(offset).unwrap_or(surface.normal);
                if self.makes(Mistake::ViewNotUnit) { offset } else { unit }
            }
            Eye::Infinite(v) => v,
        };
        if self.makes(Mistake::ViewReversed) { neg(v) } else { v }
    }
}

fn plus(a: TermSums, b: TermSums) -> TermSums {
    TermSums {
        ambient: add(a.ambient, b.ambient),
        diffuse: add(a.diffuse, b.diffuse),
        specular: add(a.specular, b.specular),
    }
}

/// The weighted mean of the corners' values.
fn weighted([a, b, c]: [DVec3; 3], [u, v, w]: [f64; 3]) -> DVec3 {
    a * u + b * v + c * w
}

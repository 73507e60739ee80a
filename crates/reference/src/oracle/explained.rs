//! Explains a pixel, by the functions that draw it.

use bevy_math::{DVec3, UVec2};
use halfway_lighting::equations::vector::dot;
use halfway_lighting::equations::{
    Light, LightTerms, Real, half_vector, reflect, side_normal, specular_exponent, specular_term, view_vector,
};
use halfway_lighting::lights::LightSource;
use halfway_lighting::{Frequency, Intensity, Reflectance};

use super::Oracle;
use super::error::OracleError;
use super::layers::{blended, written};
use super::raster::{Hit, HitPoint};
use super::scene::OracleScene;
use super::shade::{Evaluation, IntensityParts, at_triangle, at_vertex};
use super::solid::{Color, Solid, TermSums};
use crate::Image;
use crate::explain::{
    ExplainedLayer, ExplainedLight, ExplainedPoint, ExplainedSample, ExplainedTriangle, Explanation, ImageFactors,
    LightWay, TermColors,
};
use crate::image::{byte, encoded};

impl Oracle {
    /// Explains the pixel in column `x` of row `y`: it is the one of [`draw`](Self::draw), to the bit, where the oracle
    /// shows colours. Under [`Intensity::Renormalize`] the whole picture is drawn, for its divisor.
    ///
    /// # Errors
    /// [`OracleError::Outside`] for a pixel outside the picture.
    pub fn explain(&self, x: u32, y: u32) -> Result<Explanation, OracleError> {
        let UVec2 { x: width, y: height } = self.size;
        if x >= width || y >= height {
            return Err(OracleError::Outside { x, y, width, height });
        }
        let samples: Vec<ExplainedSample> =
            self.offsets().map(|[u, v]| self.explain_sample([f64::from(x) + u, f64::from(y) + v])).collect();
        let mean = self.mean(samples.iter().map(|sample| sample.color));
        let policy = self.policy();
        let divisor = match policy {
            Intensity::Renormalize { .. } => self.draw().divisor(),
            _ => None,
        };
        let pixel = Image::new(1, 1, vec![mean]);
        let pixel = divisor.map_or_else(|| self.under_policy(pixel.clone()), |divisor| pixel.clone().divided(divisor));
        let color = pixel.pixel(0, 0);
        let encoding = self.scene.encoding;
        let encoded = color.map(|channel| encoded(channel, encoding));
        Ok(Explanation {
            pixel: [x, y],
            size: self.size.to_array(),
            global_ambient: self.scene.global_ambient,
            samples,
            clamps_surfaces: self.clamps(),
            mean,
            policy,
            divisor,
            color,
            encoding,
            encoded,
            bytes: encoded.map(byte),
        })
    }

    /// Explains the colour at a point of the picture.
    fn explain_sample(&self, at: [f64; 2]) -> ExplainedSample {
        let [x, y] = at;
        let clamp = self.clamps();
        let background = written(self.scene.behind(self.scene.view.direction(x, y)), clamp);
        let mut color = background;
        let mut layers = Vec::new();
        for hit in self.layers_of(&self.hits(x, y)).visible(&self.scene) {
            let layer = self.scene.explain_layer(hit, self.scene.view.ray(self.scene.view.at(x, y)).at(hit.depth));
            let behind = color;
            color = blended(layer.opacity, written(layer.intensity, clamp), behind);
            layers.push(ExplainedLayer { behind, blended: color, ..layer });
        }
        ExplainedSample { at, background, layers, color }
    }
}

impl OracleScene {
    /// Explains the side that a ray hits, as if nothing were behind it.
    fn explain_layer(&self, hit: &Hit, position: DVec3) -> ExplainedLayer {
        let solid = &self.solids[hit.solid];
        let parts = self.parts(hit);
        let (_, n) = self.point(solid, hit);
        let sums = parts.sums();
        let IntensityParts { color, solid: cut_from, occlusion, specular, glow, .. } = parts;
        let product = |a: Color, b: Color| [0, 1, 2].map(|k| a[k] * b[k]);
        let of_surface = product(color, cut_from);
        ExplainedLayer {
            object: solid.entity,
            name: solid.name.clone(),
            triangle: hit.on_triangle().map(|(number, weights)| ExplainedTriangle {
                number,
                vertices: solid.vertices(number).map(|vertex| vertex as u32),
                weights,
            }),
            front: hit.front,
            depth: hit.depth,
            position: position.to_array(),
            normal: side_normal(n, hit.front),
            lit: solid.lit,
            terms: solid.terms,
            reflectance: solid.reflectance,
            material: self.material_at(hit),
            points: self.explain_points(solid, hit),
            steady_ambient: parts.unlit.ambient,
            lights: parts.lit.into(),
            environment: parts.environment.into(),
            factors: ImageFactors { color, solid: cut_from, occlusion, specular, emission: glow },
            sums: TermColors {
                ambient: product(of_surface, sums.ambient.map(|channel| channel * occlusion)),
                diffuse: product(of_surface, sums.diffuse),
                specular: product(specular, sums.specular),
            },
            emission: product(glow, parts.emission),
            intensity: parts.intensity(),
            opacity: self.opacity(hit),
            behind: [0.0; 3],
            blended: [0.0; 3],
        }
    }

    /// The points at which the terms of an object's lights are evaluated for a hit.
    fn explain_points(&self, solid: &Solid, hit: &Hit) -> Vec<ExplainedPoint> {
        let material = self.material_at(hit);
        let (triangle, weights) = match hit.place {
            HitPoint::Triangle(triangle, weights) => (triangle, weights),
            HitPoint::Surface { p, n } => {
                let on_surface = Evaluation::on_surface(p, n, material);
                return vec![self.explain_point(solid, hit.front, &on_surface, None)];
            }
        };
        let mut points = Vec::new();
        if solid.terms.has(Frequency::Triangle) {
            points.push(self.explain_point(solid, hit.front, &at_triangle(solid, material, triangle), None));
        }
        if solid.terms.has(Frequency::Vertex) {
            for (number, weight) in solid.vertices(triangle).into_iter().zip(weights) {
                let at = at_vertex(solid, hit.front, number);
                points.push(self.explain_point(solid, hit.front, &at, Some((number as u32, weight))));
            }
        }
        if solid.terms.has(Frequency::Fragment) {
            let at = self.at_fragment(solid, hit, material, (triangle, weights));
            points.push(self.explain_point(solid, hit.front, &at, None));
        }
        points
    }

    fn explain_point(
        &self,
        solid: &Solid,
        front: bool,
        evaluation: &Evaluation,
        corner: Option<(u32, f64)>,
    ) -> ExplainedPoint {
        let surface = evaluation.surface(front);
        let mut sums = TermSums::default();
        let lights = self.lights.iter().zip(&self.light_names).map(|(light, (entity, name))| {
            let (material, terms) = self.light_at(solid, front, evaluation, light);
            let counted = evaluation.counted(solid.terms, light, &terms);
            sums = sums.plus(counted);
            let v = view_vector(&surface, &self.viewer);
            let LightTerms { ambient, diffuse, specular } = terms;
            ExplainedLight {
                light: *entity,
                name: name.clone(),
                kind: light.kind(),
                colors: light.colors(),
                way: light.arrival(&surface).map(|arrival| {
                    let reflectance = evaluation.reflectance(solid);
                    let (l, n) = (arrival.l, surface.normal);
                    let (direction, cosine) = highlight(reflectance, n, l, v);
                    LightWay {
                        l,
                        distance: arrival.distance,
                        constants: arrival.constants,
                        attenuation: arrival.attenuation,
                        window: arrival.window,
                        cos_phi: arrival.cos_phi,
                        spot: arrival.spot,
                        n_dot_l: dot(n, l),
                        is_behind: dot(n, l) <= arrival.grazing,
                        direction,
                        cosine,
                        exponent: specular_exponent(reflectance, material.shininess),
                        power: specular_term(reflectance, n, l, v, &material),
                    }
                }),
                is_steady: is_steady(light),
                terms: TermColors { ambient, diffuse, specular },
                counted: counted.into(),
            }
        });
        let mut lights: Vec<_> = lights.collect();
        lights.sort_by_key(|light| light.light.index());
        ExplainedPoint {
            at: evaluation.at,
            corner,
            position: surface.position,
            normal: surface.normal,
            view: view_vector(&surface, &self.viewer),
            material: evaluation.material,
            lights,
            sums: sums.into(),
        }
    }
}

fn is_steady(light: &Light<f64>) -> bool {
    light.steady_ambient().iter().any(|&channel| channel > 0.0)
}

/// The direction whose cosine shapes a highlight, and that cosine.
fn highlight<T: Real>(reflectance: Reflectance, n: [T; 3], l: [T; 3], v: [T; 3]) -> (Option<[T; 3]>, T) {
    match reflectance {
        Reflectance::Phong => {
            let r = reflect(l, n);
            (Some(r), dot(r, v))
        }
        Reflectance::BlinnPhong | Reflectance::BlinnPhongMatched => {
            let h = half_vector(l, v);
            (h, h.map_or(T::zero(), |h| dot(n, h)))
        }
    }
}

impl From<TermSums> for TermColors {
    fn from(TermSums { ambient, diffuse, specular }: TermSums) -> Self {
        Self { ambient, diffuse, specular }
    }
}

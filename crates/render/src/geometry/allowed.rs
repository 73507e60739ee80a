//! How coarse an object may be drawn: by a group's triangles where
//!
//! - no point of its surface moves by more than the tolerance's pixels on the picture, and
//! - turned normals change what is shown by no more than half of the tolerance's steps, all lights and terms together;
//!   or no edge is longer than those pixels and half a pixel of sampling, and no point of a triangle shows more or less
//!   than its corners do by more than that; or no point is farther than that from the nearest corner, by which
//!   fragments go ([`ShadedCorners`]).
//!
//! Corners are points of the mesh with its normals. What is interpolated between shades at corners never is more or
//! less than they: so Gouraud shading keeps to this however its normals turn, and `Auto`, and with it Phong shading,
//! shades such patches at the vertices.
//!
//! How far points move and normals turn is bounded, patch by patch ([`halfway_mesh::PatchGroup`]). A normal that turns
//! by δ changes a term with exponent n (1 for diffuse) by no more than
//!
//! - √n·((n − 1)/n)^((n − 1)/2)·δ, its steepest slope, of its largest value, twice that for Phong's reflection vector;
//!   for 0 < n < 1 there is none, and no normal may turn,
//! - and a highlight by what is cut off where n·l falls below 0: sinⁿ(β + δ) of its largest value, β half the angle
//!   between light and eye; −cosⁿ 2β for Phong's.
//!
//! Between corners a term may be off by ½·n·ω² + 6·w² of its largest value, an estimate of the second order: ω is how
//! far the vectors of its cosine turn against each other within a triangle, R + w for n·l, R + ½(w + u) for n·h and
//! twice that for r·v, R the spread of its normals, w = e/(√3·d) and u its size as seen from the nearest light and from
//! a local viewer (e the longest edge, within a circle of e/√3, Jung 1901); 6·w² is for attenuation, up to the inverse
//! square, also of ambient light. Where n·l, or the cosine of a highlight with an exponent below 2, falls to 0 the term
//! has a kink: what is shaded at vertices is off by up to a quarter of the cosine's span there, ½·ω; and by what is cut
//! off. Between what its corners show it stays all the same.
//!
//! Flat shading shows the triangles themselves, and keeps them all. Of more than eight lights only the length of edges
//! counts, or that no normal turns; likewise for vertices lit by spots, whose rims are sharp.
//!
//! With a window, coarser patches are made in the background once a mesh has been seen in two frames; until then it is
//! drawn as it is. Without one, the second frame waits for them: so a picture of one frame never has any, and a
//! recording repeats to the byte. Blended objects, whose triangles are drawn in the order of their mesh, and objects
//! that are scaled differently along different axes keep all triangles.

use crate::geometry::corners::ShadedCorners;
use crate::geometry::turned::{GroupErrors, TURNED, TurnedTerms, steepest};
use crate::lights::gather::Lights;
use crate::lights::lists::Reflector;
use crate::lights::places::tolerated;
use crate::view::matrices::ModelView;
use bevy_math::{DVec3, Vec3};
use halfway_lighting::bounds::STEP;
use halfway_lighting::equations::{Light, Place, attenuation, range_window};
use halfway_lighting::{Encoding, Frequency, Terms, Tolerance};

/// What coarser triangles may take of the steps of a tolerance: half, unless every mesh is drawn as it is.
pub(crate) fn geometry_steps(tolerance: Tolerance) -> f64 {
    if tolerance.pixels > 0.0 { 0.5 * f64::from(tolerance.steps) } else { 0.0 }
}

/// An object whose detail is chosen.
#[derive(Clone, Copy)]
pub(crate) struct Demand<'a> {
    pub(crate) tolerance: Tolerance,
    /// Its patches have light lists of their own.
    pub(crate) listed: bool,
    pub(crate) blinn_phong: bool,
    pub(crate) local_viewer: bool,
    pub(crate) reflector: &'a Reflector,
    pub(crate) lights: &'a Lights,
    pub(crate) encoding: Option<Encoding>,
    pub(crate) model_view: &'a ModelView,
    /// Around all of it, in eye space.
    pub(crate) sphere: (Vec3, f32),
    /// Where it is shaded at corners.
    pub(crate) corners: ShadedCorners,
    /// Of each of its errors the least that any of its groups has.
    pub(crate) least: &'a GroupErrors,
    /// The pixels that a unit of the mesh takes; `None` where that is asked patch by patch.
    pub(crate) pixels_per_unit: Option<f32>,
}

/// What one object may be drawn with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allowed {
    pixels: f32,
    corners: ShadedCorners,
    shading: ShownTerms,
    /// Everything is shaded at corners, where edges are no longer than what is allowed.
    by_corners: bool,
    /// Its patches have light lists of their own.
    listed: bool,
}

/// What is shown besides outlines.
#[derive(Clone, Copy, Debug)]
enum ShownTerms {
    /// A constant color.
    None,
    /// Terms of more lights than are looked at here: no normal may turn.
    Same,
    /// Terms of which nothing is known.
    Unknown,
    /// Terms that may change.
    Terms([TurnedTerms; 3]),
}

/// No mesh is drawn so small.
const NEVER: f32 = -1.0;

/// Up to this intensity a channel has [`FEW_STEPS`] of room below white, by either encoding.
const FAR_FROM_WHITE: f32 = 0.9;
const FEW_STEPS: f64 = 0.03;

/// The slope of the sRGB curve's inverse at white, 2.4/1.055, which is the largest.
const STEEPEST_OF_SRGB: f32 = 2.4 / 1.055;

impl Allowed {
    /// The mesh as it is.
    pub(crate) const NOTHING: Self = Self {
        pixels: 0.0,
        corners: ShadedCorners::NONE,
        shading: ShownTerms::Unknown,
        by_corners: false,
        listed: false,
    };

    pub(crate) fn new(demand: Demand) -> Self {
        let Demand { tolerance, listed, lights, model_view, reflector: &Reflector { terms, .. }, .. } = demand;
        if tolerance.pixels <= 0.0 || !model_view.keeps_angles() {
            return Self::NOTHING;
        }
        if terms.has(Frequency::Triangle) {
            return Self::NOTHING;
        }
        let by_corners = !terms.has(Frequency::Fragment);
        let by_vertices = terms.has(Frequency::Vertex);
        let keeps_corners = by_corners
            && demand.pixels_per_unit.is_none_or(|pixels| pixels <= demand.corners.pixels_per_unit(demand.least));
        let (shading, is_in_vain) = match terms {
            Terms::NONE => (ShownTerms::None, false),
            _ if by_vertices && (listed || lights.counts[2] > 0) => (ShownTerms::Unknown, true),
            _ if listed => (ShownTerms::Same, demand.least.normal_error > 0.0),
            _ if !keeps_corners && demand.turn_too_far() => (ShownTerms::Unknown, true),
            _ => (ShownTerms::Terms(demand.changes()), false),
        };
        if is_in_vain && !keeps_corners {
            return Self::NOTHING;
        }
        let corners = if by_corners { demand.corners } else { ShadedCorners::new(tolerance, false) };
        Self { pixels: tolerance.pixels, corners, shading, by_corners, listed }
    }

    pub(crate) fn is_nothing(&self) -> bool {
        self.pixels <= 0.0
    }

    /// The most pixels that a unit of the mesh may take where a group's parts will do. It is no more for a group than
    /// for one whose parts it joins, as its errors are no less.
    pub(crate) fn pixels_per_unit(&self, group: &GroupErrors) -> f32 {
        if self.listed && group.spoils_lists {
            return NEVER;
        }
        // Without an error it is infinite.
        let by_error = self.pixels / group.error;
        let sum = |changes: &[TurnedTerms; 3], of: fn(&TurnedTerms, &GroupErrors) -> f32| -> f32 {
            changes.iter().map(|change| of(change, group)).sum()
        };
        let keeps_shading = match &self.shading {
            ShownTerms::None => true,
            ShownTerms::Unknown => false,
            ShownTerms::Same => group.normal_error <= 0.0,
            ShownTerms::Terms(changes) => sum(changes, TurnedTerms::turned) <= 1.0,
        };
        let between_corners = || match &self.shading {
            ShownTerms::Terms(changes) => sum(changes, TurnedTerms::between_corners) <= 1.0,
            _ => false,
        };
        if keeps_shading {
            by_error
        } else if self.by_corners || between_corners() {
            by_error.min(self.corners.pixels_per_unit(group))
        } else {
            NEVER
        }
    }
}

impl Demand<'_> {
    /// Whether already the least errors change too much, by numbers that take no power: what may change is no more than
    /// the steepest part of the sRGB curve makes of it, and no slope is less than √(n/e). What is cut off of highlights
    /// is not looked at. Some that change too much are not told.
    fn turn_too_far(&self) -> bool {
        let &Self { reflector, lights, least, .. } = self;
        let steps = geometry_steps(self.tolerance) * STEP;
        // Where white is near, anything may change.
        let unlit = reflector.unlit(lights.ambient).max_element();
        if unlit > FAR_FROM_WHITE || steps > FEW_STEPS {
            return false;
        }
        let allowed = steps as f32 * if self.encoding == Some(Encoding::Srgb) { STEEPEST_OF_SRGB } else { 1.0 };
        let side = reflector.larger_side();
        let mut sums = [[0.0_f32; 3]; 2];
        for light in &lights.sources {
            let weight = self.weight(light);
            for k in [0, 1, 2] {
                sums[0][k] += weight * side.kd[k] * light.ld[k];
                sums[1][k] += weight * side.ks[k] * light.ls[k];
            }
        }
        let [diffuse, specular] = sums.map(|sum| sum.into_iter().fold(0.0, f32::max) / allowed);
        let [_, larger] = reflector.exponents();
        let (n, turn) = (larger.max(1.0), if self.blinn_phong { 1.0 } else { 2.0 });
        let turned = (diffuse + specular * turn * (n / std::f32::consts::E).sqrt()) * least.normal_error;
        let spread = least.normal_spread;
        let between = 0.5 * (diffuse + specular * n * turn * turn) * spread * spread;
        turned > 1.01 && between > 1.01
    }

    /// The largest part of a light that arrives anywhere at the object.
    fn weight(&self, light: &Light<f32>) -> f32 {
        let (center, radius) = self.sphere;
        match light.place {
            Place::Point(position) => {
                let distance = center.as_dvec3().distance(Vec3::from(position).as_dvec3()) as f32;
                let nearest = (distance - radius).max(0.0);
                attenuation(light.attenuation, nearest) * light.range.map_or(1.0, |range| range_window(nearest, range))
            }
            Place::Directional(_) => 1.0,
        }
    }

    /// What turned normals change of the object.
    fn changes(&self) -> [TurnedTerms; 3] {
        let &Self { reflector, lights, model_view, sphere: (center, radius), .. } = self;
        let side = reflector.larger_side();
        let unlit = reflector.unlit(lights.ambient).to_array();
        let allowed = unlit.map(|at_least| self.intensity(at_least));
        let exponents @ [smaller, larger] = reflector.exponents();
        // Sums over the lights, by channel: diffuse, specular, highlights that are cut off, and ambient where it
        // weakens with distance.
        let mut sums = [[0.0_f32; 3]; 4];
        let mut nearest_light = 0.0_f32;
        let scale = model_view.largest_scale();
        let inverse = |distance: f32| if distance > radius { scale / (distance - radius) } else { f32::INFINITY };
        for light in &lights.sources {
            let weight = self.weight(light);
            if let Place::Point(position) = light.place {
                let distance = center.as_dvec3().distance(Vec3::from(position).as_dvec3()) as f32;
                nearest_light = nearest_light.max(inverse(distance));
            }
            let cut = self.cut(light, smaller);
            for k in [0, 1, 2] {
                sums[0][k] += weight * side.kd[k] * light.ld[k];
                sums[1][k] += weight * side.ks[k] * light.ls[k];
                sums[2][k] += weight * side.ks[k] * light.ls[k] * cut;
                sums[3][k] += if light.attenuate_ambient { weight * side.ka[k] * light.la[k] } else { 0.0 };
            }
        }
        // Of the channel of which it is the largest part.
        let part = |sum: [f32; 3]| [0, 1, 2].map(|k| if sum[k] > 0.0 { sum[k] / allowed[k] } else { 0.0 });
        let [diffuse, specular, cut, ambient] = sums.map(|sum| part(sum).into_iter().fold(0.0, f32::max));
        let eye = if self.local_viewer { inverse(center.length()) } else { 0.0 };
        let by_vertices = |at| at == Frequency::Vertex;
        let Terms { diffuse: diffuse_at, specular: specular_at } = reflector.terms;
        let turn = if self.blinn_phong { 1.0 } else { 2.0 };
        // Between exponents of 0 and 1 the slope has no end.
        let is_steep = exponents.into_iter().any(|n| n > 0.0 && n < 1.0);
        let steepest = if is_steep { f32::INFINITY } else { steepest(smaller.max(1.0)).max(steepest(larger.max(1.0))) };
        [
            TurnedTerms {
                largest: diffuse,
                slope: diffuse,
                cut: 0.0,
                exponents: [1.0; 2],
                turn: 1.0,
                seen_from: [nearest_light; 2],
                by_vertices: by_vertices(diffuse_at),
            },
            TurnedTerms {
                largest: specular,
                slope: specular * steepest * turn,
                cut,
                exponents,
                turn,
                seen_from: [nearest_light, 0.5 * (nearest_light + eye)],
                by_vertices: by_vertices(specular_at),
            },
            // It does not depend on normals.
            TurnedTerms {
                largest: ambient,
                seen_from: [nearest_light, 0.0],
                by_vertices: by_vertices(diffuse_at),
                ..TurnedTerms::default()
            },
        ]
    }

    /// The change of an intensity of at least this that is allowed.
    fn intensity(&self, at_least: f32) -> f32 {
        tolerated(self.encoding, geometry_steps(self.tolerance) * STEP, at_least.into()) as f32
    }

    /// Where n·l is 0, h is no nearer to n than v and l are to each other: n·h ≤ sin β, 2β their angle. The reflected
    /// vector is −l there.
    fn cut(&self, light: &Light<f32>, exponent: f32) -> f32 {
        let (center, radius) = self.sphere;
        let center = center.as_dvec3();
        let subtended =
            |distance: f64| if distance > f64::from(radius) { (f64::from(radius) / distance).asin() } else { 4.0 };
        let (to_light, by_light) = match light.place {
            Place::Directional(toward) => (Vec3::from(toward).as_dvec3(), 0.0),
            Place::Point(position) => {
                let offset = Vec3::from(position).as_dvec3() - center;
                (offset.normalize_or_zero(), subtended(offset.length()))
            }
        };
        let (to_eye, by_eye) =
            if self.local_viewer { (-center.normalize_or_zero(), subtended(center.length())) } else { (DVec3::Z, 0.0) };
        let between = (to_light.dot(to_eye).clamp(-1.0, 1.0).acos() + by_light + by_eye).min(std::f64::consts::PI);
        let turned = f64::from(TURNED);
        let cosine = if self.blinn_phong { (0.5 * between).sin() + turned } else { 2.0 * turned - between.cos() };
        cosine.clamp(0.0, 1.0).powf(f64::from(exponent)) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_math::DAffine3;
    use halfway_lighting::Reflectance;
    use halfway_lighting::equations::Coefficients;

    const LEAST: GroupErrors = GroupErrors {
        error: 1e-6,
        normal_error: 0.0,
        normal_spread: 0.0,
        longest_edge: 1e-3,
        corner_reach: f32::INFINITY,
        spoils_lists: false,
    };

    /// What is told at once to turn too far is never allowed by all that is known; and of what is not, more than a
    /// quarter is told.
    #[test]
    fn what_is_in_vain_is_not_allowed() {
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            (state >> 8) as f32 / (1 << 24) as f32
        };
        let model_view = ModelView::new(&DAffine3::IDENTITY);
        let (mut told, mut never, mut allowed) = (0, 0, 0);
        for _ in 0..20_000 {
            let mut color = |most: f32| [random(), random(), random()].map(|c| most * c * c);
            let (kd, ks, ke, la, ld, ls) = (color(1.0), color(1.0), color(0.9), color(0.5), color(2.0), color(2.0));
            let shininess = 200.0_f32.powf(random());
            let material = Coefficients { ka: [1.0; 3], kd, ks, ke, shininess };
            let reflector = Reflector {
                sides: [material; 2],
                reflectance: if random() < 0.5 { Reflectance::BlinnPhong } else { Reflectance::Phong },
                terms: Terms::both(if random() < 0.5 { Frequency::Fragment } else { Frequency::Auto }),
            };
            // Where all terms may be shaded at corners, a thousand are too many for the edges.
            let pixels_per_unit = 2000.0 * random();
            let place = if random() < 0.5 {
                Place::Directional(Vec3::new(random() - 0.5, random() - 0.5, 1.0).normalize().to_array())
            } else {
                Place::Point([4.0 * random(), 4.0 * random(), 2.0])
            };
            let attenuation = [1.0, random(), random()];
            let (range, cone, attenuate_ambient) = (None, None, false);
            let light = Light { place, la, ld, ls, attenuation, range, cone, attenuate_ambient };
            let lights = Lights::of_sources(vec![light], la.into());
            let mut errors = LEAST;
            errors.normal_error = 10.0_f32.powf(-4.0 * random());
            errors.normal_spread = 10.0_f32.powf(-4.0 * random());
            let demand = |least| Demand {
                tolerance: Tolerance { steps: 1.0, pixels: 0.5 },
                corners: ShadedCorners::new(Tolerance { steps: 1.0, pixels: 0.5 }, true),
                listed: false,
                blinn_phong: reflector.reflectance == Reflectance::BlinnPhong,
                local_viewer: true,
                reflector: &reflector,
                lights: &lights,
                encoding: [None, Some(Encoding::Srgb), Some(Encoding::Raw)][told % 3],
                model_view: &model_view,
                sphere: (Vec3::new(0.0, 0.0, -5.0), 1.0),
                least,
                pixels_per_unit: Some(pixels_per_unit),
            };
            let in_full = Allowed::new(demand(&LEAST));
            assert!(!in_full.is_nothing());
            let is_never = in_full.pixels_per_unit(&errors) < pixels_per_unit;
            if Allowed::new(demand(&errors)).is_nothing() {
                assert!(is_never, "{material:?} {lights:?} {errors:?}");
                told += 1;
            }
            (never, allowed) = (never + usize::from(is_never), allowed + usize::from(!is_never));
        }
        assert!(allowed > 2_000 && never > 2_000, "{allowed} and {never}");
        assert!(4 * told > never, "{told} of {never} are told");
    }

    /// A cosine to a power between 0 and 1 rises without end from 0, so that no normal may turn; to the power 0 it does
    /// not.
    #[test]
    fn exponents_below_1_keep_every_normal() {
        let model_view = ModelView::new(&DAffine3::IDENTITY);
        let place = Place::Directional([0.0, 0.0, 1.0]);
        let color = [1.0; 3];
        let (range, cone, attenuate_ambient) = (None, None, false);
        let [la, ld] = [[0.0; 3], color];
        let light = Light { place, la, ld, ls: color, attenuation: [1.0, 0.0, 0.0], range, cone, attenuate_ambient };
        let lights = Lights::of_sources(vec![light], Vec3::ZERO);
        let turning = GroupErrors { normal_error: 1e-6, normal_spread: 1e-3, ..LEAST };
        for (shininess, [phong, gouraud, turned]) in [
            (0.0, [true, true, true]),
            (0.05, [true, false, false]),
            (0.9, [true, false, false]),
            (1.0, [true, true, true]),
            (20.0, [true, true, true]),
        ] {
            let black = [0.0; 3];
            let material = Coefficients { ka: black, kd: black, ks: [0.02; 3], ke: black, shininess };
            let allows = |terms, errors: &GroupErrors| {
                let reflector =
                    Reflector { sides: [material; 2], reflectance: Reflectance::Phong, terms: Terms::both(terms) };
                let allowed = Allowed::new(Demand {
                    tolerance: Tolerance { steps: 30.0, pixels: 0.5 },
                    corners: ShadedCorners::new(Tolerance { steps: 30.0, pixels: 0.5 }, true),
                    listed: false,
                    blinn_phong: false,
                    local_viewer: false,
                    reflector: &reflector,
                    lights: &lights,
                    encoding: Some(Encoding::Raw),
                    model_view: &model_view,
                    sphere: (Vec3::new(0.0, 0.0, -5.0), 1.0),
                    least: &LEAST,
                    pixels_per_unit: None,
                });
                // Edges are far too long for their corners to do.
                allowed.pixels_per_unit(&GroupErrors { longest_edge: 1.0, ..*errors }) > 2.0
            };
            let still = GroupErrors { normal_error: 0.0, ..turning };
            let found = [
                allows(Frequency::Fragment, &still),
                allows(Frequency::Vertex, &still),
                allows(Frequency::Fragment, &turning),
            ];
            assert_eq!(found, [phong, gouraud, turned], "shininess {shininess}");
        }
    }
}

//! The bound: an upper limit of each term of one light over a patch.

use super::Patch;
use super::angle::{Angle, Cap, slack};
use crate::equations::vector::{cross, dot, length, mul, neg, scale, sub};
use crate::equations::{
    COINCIDENT, Coefficients, ConeTerms, Eye, Real, power, reflect, specular_exponent, spot_factor,
};
use crate::light_colors::Colors;
use crate::{Faces, Reflectance};

/// Relative margin of every bound. It covers the rounding of the factors that are not cosines: about 2·10⁻⁵ in `f32`,
/// most of it from a rounded exponent where S is close to the smallest number.
pub const MARGIN: f64 = 1e-4;

/// Upper bounds of one light's terms over a patch, per channel; unclamped, linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TermBounds<T> {
    /// Bound of ka·La·att·spot for a light that attenuates its ambient. 0 for any other light: its ambient term is the
    /// same everywhere and is counted as part of the surface.
    pub ambient: [T; 3],
    /// Bound of att·spot·kd·Ld·max(n·l, 0).
    pub diffuse: [T; 3],
    /// Bound of att·spot·ks·Ls·S.
    pub specular: [T; 3],
}

impl<T: Real> TermBounds<T> {
    /// The bounds of a light that adds nothing.
    pub fn zero() -> Self {
        Self { ambient: [T::zero(); 3], diffuse: [T::zero(); 3], specular: [T::zero(); 3] }
    }
}

/// The terms of a light that may be above 0 somewhere on a patch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LitTerms {
    /// The ambient term of a light that attenuates it.
    pub ambient: bool,
    /// The diffuse term.
    pub diffuse: bool,
    /// The specular term.
    pub specular: bool,
}

/// A [`Patch`] with its material and its viewer, prepared for many lights.
#[derive(Clone, Copy, Debug)]
pub struct Receiver<T> {
    center: [T; 3],
    radius: T,
    /// A light within this distance of a point of the patch may count as being at that point.
    coincident: T,
    half_thickness: T,
    normals: Cap<T>,
    both_sides: bool,
    view: Cap<T>,
    ka: [T; 3],
    kd: [T; 3],
    ks: [T; 3],
    /// The exponent of S.
    exponent: T,
    lobe: Lobe<T>,
}

/// The two directions whose cosine S is a power of.
#[derive(Clone, Copy, Debug)]
enum Lobe<T> {
    /// n and h.
    Halfway { view_chord: T },
    /// r and v. `spread` is 2α + av.
    Mirror { spread: Angle<T> },
}

/// The position of a light relative to the middle of the patch.
#[derive(Clone, Copy)]
pub(crate) struct Offset<T> {
    /// L − c; the unit vector l of a directional light.
    vector: [T; 3],
    square: T,
    /// r, and half the thickness of the patch; both 0 for a directional light, whose l is the same everywhere.
    radius: T,
    half_thickness: T,
    /// Rounding errors of lengths, and the distance within which the light counts as being at a point.
    blur: T,
}

/// The directions and distances of a light at the points of a patch.
pub(crate) struct Arrival<T> {
    /// Every l.
    l: Cap<T>,
    /// The least angle between an l and the axis of the normals, known from the thickness; 0 if that is unknown.
    rise: Angle<T>,
    /// The least distance from a point of the patch.
    pub(crate) nearest: T,
}

impl<T: Real> Arrival<T> {
    /// The largest factor of a cone.
    pub(crate) fn largest_spot(&self, cone: &ConeTerms<T>) -> T {
        let cos = Angle::between(neg(self.l.axis), cone.direction).cos_within(self.l.spread);
        spot_factor(cos, cone)
    }
}

impl<T: Real> Receiver<T> {
    /// Prepares `patch` with the coefficients of its visible sides, all in one space. For coefficients that vary over
    /// the patch, give the largest value of each channel, and the smallest shininess.
    pub fn new(patch: &Patch<T>, material: &Coefficients<T>, view: &Eye<T>, reflectance: Reflectance) -> Self {
        let normals = patch.seen_normals();
        let view = Cap::toward_eye(patch.center, patch.radius, view);
        let lobe = match reflectance {
            Reflectance::Phong => Lobe::Mirror { spread: normals.spread.plus(normals.spread).plus(view.spread) },
            Reflectance::BlinnPhong | Reflectance::BlinnPhongMatched => {
                Lobe::Halfway { view_chord: view.spread.chord() }
            }
        };
        Self {
            center: patch.center,
            radius: patch.radius,
            coincident: T::from_f64(COINCIDENT.into()) * (length(patch.center) + patch.radius) * (T::one() + slack()),
            half_thickness: patch.half_thickness,
            normals,
            both_sides: patch.faces == Faces::Both,
            view,
            ka: material.ka,
            kd: material.kd,
            ks: material.ks,
            exponent: specular_exponent(reflectance, material.shininess),
            lobe,
        }
    }

    /// The bounds of the terms that may be lit, for a light with these colours, this arrival and at most this weight.
    #[inline]
    pub(crate) fn bounds_of(
        &self,
        lit: LitTerms,
        colors: &Colors<T>,
        arrival: impl FnOnce() -> Arrival<T>,
        weight: impl FnOnce(&Arrival<T>) -> T,
    ) -> TermBounds<T> {
        let mut bounds = TermBounds::zero();
        if lit == LitTerms::default() {
            return bounds;
        }
        let arrival = arrival();
        // A product that left the number range is small, not 0.
        let weight = weight(&arrival).max(T::min_positive_value()) * (T::one() + T::from_f64(MARGIN));
        let Arrival { l, rise, .. } = arrival;
        if lit.ambient {
            bounds.ambient = scale(mul(self.ka, colors.la), weight);
        }
        if lit.diffuse || lit.specular {
            let facing = self.facing(&l, rise);
            bounds.diffuse = scale(mul(self.kd, colors.ld), weight * facing);
            if lit.specular && facing > T::zero() {
                bounds.specular = scale(mul(self.ks, colors.ls), weight * self.highlight(&l));
            }
        }
        bounds
    }

    /// The sphere that a light's range overlaps if the light adds anything: that of the patch, widened by the distance
    /// within which a light may count as being at a point of it, and as much again for the rounding of positions.
    pub(crate) fn search_sphere(&self) -> ([T; 3], T) {
        (self.center, (self.radius + self.coincident * T::from_f64(2.0)) * (T::one() + slack()))
    }

    // The terms that may be above 0 are found by signs alone: no power, and seldom a root. That is the first step of a
    // bound, and all that a tolerance of 0 asks for. The tests are those of the second table at `bounds`, multiplied by
    // D. A test fails only by more than its rounding, and never with NaN.

    /// The offset of a light whose l is the same everywhere.
    pub(crate) fn offset_along(l: [T; 3]) -> Offset<T> {
        Offset { vector: l, square: T::one(), radius: T::zero(), half_thickness: T::zero(), blur: slack() }
    }

    /// The offset of a light at a position; `None` if its square leaves the number range.
    #[inline]
    pub(crate) fn offset_to(&self, position: [T; 3]) -> Option<Offset<T>> {
        let vector = sub(position, self.center);
        let square = dot(vector, vector);
        if !(square > T::min_positive_value() / T::epsilon() && square < T::max_value() * T::from_f64(0.25)) {
            return None;
        }
        let blur = self.coincident + slack::<T>() * (norm1(vector) + self.radius);
        Some(Offset { vector, square, radius: self.radius, half_thickness: self.half_thickness, blur })
    }

    /// The terms that may be above 0 by the directions of the normals, the light and the viewer.
    #[inline]
    pub(crate) fn facing_terms(&self, offset: &Offset<T>, colored: LitTerms) -> LitTerms {
        let faces = (colored.diffuse || colored.specular) && self.may_face(offset);
        LitTerms {
            ambient: colored.ambient,
            diffuse: faces && colored.diffuse,
            specular: faces && colored.specular && self.may_mirror(offset),
        }
    }

    /// The terms that neither the light nor the material makes black.
    #[inline]
    pub(crate) fn colored_terms(&self, colors: &Colors<T>, attenuate_ambient: bool) -> LitTerms {
        let is_lit = |k: [T; 3], color: [T; 3]| (0..3).any(|c| k[c] * color[c] != T::zero());
        LitTerms {
            ambient: attenuate_ambient && is_lit(self.ka, colors.la),
            diffuse: is_lit(self.kd, colors.ld),
            specular: is_lit(self.ks, colors.ls),
        }
    }

    /// Whether a range ends before the sphere.
    #[inline]
    pub(crate) fn is_beyond(&self, range: T, offset: &Offset<T>) -> bool {
        let end = range.max(self.coincident) + self.radius;
        offset.square * (T::one() - slack::<T>() * T::from_f64(4.0)) > end * end
    }

    /// Whether the range of a light ends before the slab of the patch, or its cone passes the patch by.
    #[inline]
    pub(crate) fn is_out_of_reach(&self, position: [T; 3], range: Option<T>, cone: Option<&ConeTerms<T>>) -> bool {
        let range = range.filter(|_| self.is_flat());
        if range.is_none() && cone.is_none() {
            return false;
        }
        let arrival = self.arrival(position);
        range.is_some_and(|range| arrival.nearest >= range)
            || cone.is_some_and(|cone| arrival.largest_spot(cone) == T::zero())
    }

    /// Whether n·(L − p) may be above 0 anywhere on the patch.
    fn may_face(&self, offset: &Offset<T>) -> bool {
        let &Offset { vector, radius, half_thickness, blur, .. } = offset;
        let Cap { axis, spread: Angle { cos, sin } } = self.normals;
        let height = dot(vector, axis);
        let height = if self.both_sides { height.abs() } else { height };
        if cos <= T::zero() || height + radius.min(half_thickness) > T::zero() {
            return true;
        }
        let across = cross(vector, axis);
        let aside = dot(across, across).sqrt();
        let by_sphere = height * cos + aside * sin + radius;
        let by_slab = (height + half_thickness) * cos + (aside + radius) * sin;
        !(by_sphere <= -blur || by_slab <= -blur)
    }

    /// Whether r·v may be above 0, for Phong's S. Always true for Blinn–Phong: n·h is above 0 wherever n·l and n·v are.
    fn may_mirror(&self, offset: &Offset<T>) -> bool {
        let Lobe::Mirror { spread } = self.lobe else { return true };
        let &Offset { vector, square, radius, blur, .. } = offset;
        let along = dot(reflect(vector, self.normals.axis), self.view.axis);
        // 0 to the power of 0 is 1.
        if along > T::zero() || self.exponent == T::zero() {
            return true;
        }
        let radius = radius + blur;
        let tangent = (square - radius * radius).sqrt();
        // Of 2α + av + al, times D.
        let (cos, sin) = (spread.cos * tangent - spread.sin * radius, spread.sin * tangent + spread.cos * radius);
        !(cos > T::zero() && along <= -sin - blur)
    }

    /// The arrival of a light whose l is the same everywhere.
    pub(crate) fn arrival_along(l: [T; 3]) -> Arrival<T> {
        Arrival { l: Cap::single(l), rise: Angle::zero(), nearest: T::zero() }
    }

    /// The arrival of a light at `position`.
    pub(crate) fn arrival(&self, position: [T; 3]) -> Arrival<T> {
        let offset = sub(position, self.center);
        let square = dot(offset, offset);
        let (l, distance) = Cap::toward(self.center, self.radius, position, offset, square);
        let beyond_sphere = distance * (T::one() - slack()) - self.radius * (T::one() + slack());
        let (beyond_slab, rise) = self.slab(offset, square, distance);
        let nearest = beyond_sphere.max(beyond_slab).max(T::zero());
        if nearest <= self.coincident {
            return Arrival { l: Cap::everything(), rise: Angle::zero(), nearest: T::zero() };
        }
        Arrival { l, rise, nearest }
    }

    /// Bounds that follow from the thickness for a light at `offset` and `distance` from the centre: its least distance
    /// from the patch, which lies in the disk of the sphere's radius and that thickness, and the least angle between
    /// the axis of the normals and the directions toward it.
    ///
    /// With the height H of the light over the middle plane, its distance ρ from the axis, and half the thickness t,
    /// the distance is at least √((|H| − t)₊² + (ρ − r)₊²), and k·l is at most (H + t)/d: d as small as it can be where
    /// that is positive, and as large as D + r where it is negative.
    fn slab(&self, offset: [T; 3], square: T, distance: T) -> (T, Angle<T>) {
        let k = self.normals.axis;
        // Squares beyond the number range say nothing.
        if !(self.is_flat() && square < T::max_value() * T::from_f64(0.25)) {
            return (T::zero(), Angle::zero());
        }
        let height = dot(offset, k);
        let height = if self.both_sides { height.abs() } else { height };
        let across = cross(offset, k);
        // Height and distance from the axis are known to a few ε of the distance.
        let blur = slack::<T>() * (distance + self.radius);
        let over = (height.abs() - self.half_thickness - blur).max(T::zero());
        let aside = (dot(across, across).sqrt() - self.radius - blur).max(T::zero());
        let nearest = (over * over + aside * aside).sqrt() * (T::one() - slack());
        let top = height + self.half_thickness + blur;
        let cos = if top < T::zero() { top / (distance + self.radius + blur) } else { top / nearest };
        // Also where the quotient is 0/0.
        let rise = if cos < T::one() { Angle::from_cos(cos) } else { Angle::zero() };
        (nearest, rise)
    }

    /// Whether the thickness tells anything: not for a ball, nor for unknown normals.
    fn is_flat(&self) -> bool {
        self.half_thickness < self.radius && self.normals.axis != [T::zero(); 3]
    }

    /// The largest n·l, at most 0 where no normal faces the light.
    fn facing(&self, l: &Cap<T>, rise: Angle<T>) -> T {
        let angle = self.side(Angle::between(self.normals.axis, l.axis));
        let by_sphere = angle.cos_within(self.normals.spread.plus(l.spread));
        by_sphere.min(rise.cos_within(self.normals.spread)).min(T::one()).max(T::zero())
    }

    /// The largest S, without its gate n·l > 0.
    fn highlight(&self, l: &Cap<T>) -> T {
        let cos = match self.lobe {
            Lobe::Halfway { view_chord } => {
                let h = l.halfway(&self.view, view_chord);
                let angle = self.side(Angle::between(self.normals.axis, h.axis));
                angle.cos_within(self.normals.spread.plus(h.spread))
            }
            // Both sides reflect alike.
            Lobe::Mirror { spread } => {
                let r = reflect(l.axis, self.normals.axis);
                Angle::between(r, self.view.axis).cos_within(spread.plus(l.spread))
            }
        };
        let peak = power(cos, self.exponent);
        // A power that left the number range is small, not 0.
        if cos > T::zero() { peak.max(T::min_positive_value()) } else { peak }
    }

    /// Whether the diffuse term gives back any of a colour.
    pub(crate) fn reflects_diffuse(&self, color: [T; 3]) -> bool {
        (0..3).any(|c| self.kd[c] * color[c] != T::zero())
    }

    /// The least and the largest n·d for a unit vector d, over the normals on the sides that are seen.
    pub(crate) fn cosines_with(&self, d: [T; 3]) -> [T; 2] {
        let most = |d| self.side(Angle::between(self.normals.axis, d)).cos_within(self.normals.spread);
        [-most(neg(d)), most(d)]
    }

    /// The bounds of a light that brings at most this colour to the diffuse term, and nothing else.
    pub(crate) fn diffuse_bounds(&self, color: [T; 3]) -> TermBounds<T> {
        let diffuse = scale(mul(self.kd, color), T::one() + T::from_f64(MARGIN));
        TermBounds { diffuse, ..TermBounds::zero() }
    }

    /// The angle from the nearer side's normals, for an angle from those of the front.
    fn side(&self, angle: Angle<T>) -> Angle<T> {
        if self.both_sides { angle.to_line() } else { angle }
    }
}

/// |x| + |y| + |z|: the length, or more.
fn norm1<T: Real>(v: [T; 3]) -> T {
    v[0].abs() + v[1].abs() + v[2].abs()
}

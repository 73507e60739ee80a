//! A patch with its material and its viewer, and what one light adds to it at most.

use super::Patch;
use super::angle::{Angle, Cap, slack};
use crate::equations::vector::{cross, dot, length, mul, neg, scale, sub};
use crate::equations::{
    COINCIDENT, Coefficients, Eye, Light, Place, Real, attenuation, power, range_window, reflect, specular_exponent,
    spot_factor,
};
use crate::{Faces, Reflectance};

/// What each bound is raised by, relative to itself: above the relative error that the factors other than cosines
/// gather in `f32`, which is some 2·10⁻⁵, most of it from a rounded exponent where S is near the smallest number.
pub const MARGIN: f64 = 1e-4;

/// Upper bounds, a channel each, of what one light adds to any point of a patch; unclamped, linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TermBounds<T> {
    /// Of ka·La·att·spot, for a light that attenuates its ambient. 0 for any other: that ambient is the same
    /// everywhere, and belongs to the surface rather than to the light.
    pub ambient: [T; 3],
    /// Of att·spot·kd·Ld·max(n·l, 0).
    pub diffuse: [T; 3],
    /// Of att·spot·ks·Ls·S.
    pub specular: [T; 3],
}

impl<T: Real> TermBounds<T> {
    /// Of a light that adds nothing.
    pub fn zero() -> Self {
        Self { ambient: [T::zero(); 3], diffuse: [T::zero(); 3], specular: [T::zero(); 3] }
    }
}

/// A [`Patch`] made ready for many lights: everything about it that does not depend on the light.
#[derive(Clone, Copy, Debug)]
pub struct Receiver<T> {
    pub(super) center: [T; 3],
    pub(super) radius: T,
    /// A light no farther than this from a point of the patch may count as being there.
    pub(super) coincident: T,
    pub(super) half_thickness: T,
    pub(super) normals: Cap<T>,
    pub(super) both_sides: bool,
    pub(super) view: Cap<T>,
    pub(super) ka: [T; 3],
    pub(super) kd: [T; 3],
    pub(super) ks: [T; 3],
    /// Of the specular term.
    pub(super) exponent: T,
    pub(super) lobe: Lobe<T>,
}

/// A light as it arrives at the points of a patch.
struct Arrival<T> {
    /// Every l.
    l: Cap<T>,
    /// The least angle between an l and the axis of the normals, by the patch's thickness; 0 where that says nothing.
    rise: Angle<T>,
    /// The largest att·spot.
    weight: T,
}

/// What the specular term's cosine is taken of.
#[derive(Clone, Copy, Debug)]
pub(super) enum Lobe<T> {
    /// n and h.
    Halfway { view_chord: T },
    /// r and v. `spread` is 2α + av.
    Mirror { spread: Angle<T> },
}

impl<T: Real> Receiver<T> {
    /// `patch` with the coefficients of the sides that are seen, all in one space. Where a coefficient varies over the
    /// patch, give the largest value of each channel, and of the shininess the smallest.
    pub fn new(patch: &Patch<T>, material: &Coefficients<T>, view: &Eye<T>, reflectance: Reflectance) -> Self {
        let normals = patch.seen_normals();
        let view = Cap::of_view(patch.center, patch.radius, view);
        let lobe = match reflectance {
            Reflectance::Phong => Lobe::Mirror { spread: normals.spread.plus(normals.spread).plus(view.spread) },
            Reflectance::BlinnPhong | Reflectance::BlinnPhongMatched => {
                Lobe::Halfway { view_chord: view.spread.chord() }
            }
        };
        Self {
            center: patch.center,
            radius: patch.radius,
            coincident: T::of(COINCIDENT.into()) * (length(patch.center) + patch.radius) * (T::one() + slack()),
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

    /// What `light` adds to any point of the patch at most.
    ///
    /// Formulas and their reasons are the table at [`bounds`](crate::bounds). What makes them more than the largest
    /// term: the sphere holds places where no surface is, the factors are bounded one by one, and a patch that is seen
    /// from both sides takes the better side for each factor.
    pub fn bounds(&self, light: &Light<T>) -> TermBounds<T> {
        self.reached(light).unwrap_or_else(TermBounds::zero)
    }

    /// [`Receiver::bounds`], or `None` where nothing of the light arrives, which is most of the lights of a large scene
    /// and found out first.
    pub(super) fn reached(&self, light: &Light<T>) -> Option<TermBounds<T>> {
        let arrival = self.arrival(light)?;
        let weight = arrival.weight * (T::one() + T::of(MARGIN));
        let mut bounds = TermBounds::zero();
        if light.attenuate_ambient {
            bounds.ambient = scale(mul(self.ka, light.la), weight);
        }
        let facing = self.facing(&arrival);
        if facing > T::zero() {
            bounds.diffuse = scale(mul(self.kd, light.ld), weight * facing);
            let specular = mul(self.ks, light.ls);
            if specular.iter().any(|&x| x > T::zero()) {
                bounds.specular = scale(specular, weight * self.highlight(&arrival.l));
            }
        }
        Some(bounds)
    }

    /// Whether its numbers are far from the ends of their range, so that none of what is computed of them and of a
    /// light, whose squared distance is a normal number and not near the largest, is infinite or no number.
    pub(super) fn is_moderate(&self) -> bool {
        let most = T::max_value().sqrt().sqrt();
        let lengths = [self.center[0], self.center[1], self.center[2], self.radius, self.exponent];
        lengths.iter().all(|length| length.abs() < most)
    }

    /// `None` where att·spot is 0 all over the patch.
    fn arrival(&self, light: &Light<T>) -> Option<Arrival<T>> {
        let arrival = match light.place {
            Place::Directional(l) => Arrival { l: Cap::single(l), rise: Angle::zero(), weight: T::one() },
            Place::Point(position) => self.fall(light, position)?,
        };
        let Some(cone) = &light.cone else { return Some(arrival) };
        let l = &arrival.l;
        let spot = spot_factor(Angle::between(neg(l.axis), cone.direction).cos_within(l.spread), cone);
        (spot > T::zero()).then(|| Arrival { weight: (arrival.weight * spot).max(T::min_positive_value()), ..arrival })
    }

    /// The arrival of a light at `position` without its cone; `None` out of its range.
    fn fall(&self, light: &Light<T>, position: [T; 3]) -> Option<Arrival<T>> {
        let offset = sub(position, self.center);
        let square = dot(offset, offset);
        if let Some(range) = light.range {
            // Without a root: most lights of a large scene get no farther. Squares below the normal numbers say
            // nothing.
            let end = range.max(self.coincident) + self.radius;
            if square * (T::one() - slack::<T>() * T::of(4.0)) > end * end && square > T::min_positive_value() {
                return None;
            }
        }
        let (l, distance) = Cap::toward(self.center, self.radius, position, offset, square);
        let beyond_sphere = distance * (T::one() - slack()) - self.radius * (T::one() + slack());
        let (beyond_slab, rise) = self.slab(offset, square, distance);
        let nearest = beyond_sphere.max(beyond_slab).max(T::zero());
        if nearest <= self.coincident {
            let weight = attenuation(light.attenuation, T::zero());
            return Some(Arrival { l: Cap::everything(), rise: Angle::zero(), weight });
        }
        let window = light.range.map_or(T::one(), |range| range_window(nearest, range));
        // A divisor beyond the number range gives 0 where the quotient only is smaller than any normal number.
        let weight = (attenuation(light.attenuation, nearest) * window).max(T::min_positive_value());
        (window > T::zero()).then_some(Arrival { l, rise, weight })
    }

    /// What the thickness says of a place at `offset` and `distance` from the centre: its least distance from the
    /// patch, which lies in the disk of the sphere's radius and that thickness, and the least angle between the axis of
    /// the normals and the directions toward it.
    ///
    /// With the height H of the place over the middle plane, its distance ρ from the axis, and the half thickness t,
    /// the distance is at least √((|H| − t)₊² + (ρ − r)₊²), and k·l is at most (H + t)/d: d as small as it can be where
    /// that is positive, and as large as D + r where it is negative.
    fn slab(&self, offset: [T; 3], square: T, distance: T) -> (T, Angle<T>) {
        let k = self.normals.axis;
        // Nor squares beyond the number range.
        if !(self.is_flat() && square < T::max_value() * T::of(0.25)) {
            return (T::zero(), Angle::zero());
        }
        let height = dot(offset, k);
        let height = if self.both_sides { height.abs() } else { height };
        let across = cross(offset, k);
        // Height and distance from the axis are known to some ε of the distance.
        let blur = slack::<T>() * (distance + self.radius);
        let over = (height.abs() - self.half_thickness - blur).max(T::zero());
        let aside = (dot(across, across).sqrt() - self.radius - blur).max(T::zero());
        let nearest = (over * over + aside * aside).sqrt() * (T::one() - slack());
        let top = height + self.half_thickness + blur;
        let cos = if top < T::zero() { top / (distance + self.radius + blur) } else { top / nearest };
        // Also where the quotient is 0/0.
        let rise = if cos < T::one() { Angle::of_cos(cos) } else { Angle::zero() };
        (nearest, rise)
    }

    /// Whether the thickness says anything: of neither a ball nor any normal.
    pub(super) fn is_flat(&self) -> bool {
        self.half_thickness < self.radius && self.normals.axis != [T::zero(); 3]
    }

    /// The largest n·l, at most 0 where no normal faces the light.
    fn facing(&self, Arrival { l, rise, .. }: &Arrival<T>) -> T {
        let angle = self.side(Angle::between(self.normals.axis, l.axis));
        let by_sphere = angle.cos_within(self.normals.spread.plus(l.spread));
        by_sphere.min(rise.cos_within(self.normals.spread)).min(T::one())
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

    /// The angle from the nearer side's normals, for an angle from those of the front.
    fn side(&self, angle: Angle<T>) -> Angle<T> {
        if self.both_sides { angle.to_line() } else { angle }
    }
}

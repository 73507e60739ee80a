//! What is changed by shading a light's terms at the vertices of triangles, beside shading them at each point.

#[expect(clippy::inline_always, reason = "what is not inlined is not compiled for the CPU's vectors")]
mod wide;

use super::angle::{Angle, Cap, slack};
use super::quick::power_within;
use super::slopes::PowerSlopes;
use super::{Patch, Receiver};
use crate::equations::vector::{dot, length, neg, sub};
use crate::equations::{
    ATTENUATION_MAX, COINCIDENT, Coefficients, Eye, GRAZING, Light, Place, Real, attenuation, range_window, reflect,
};
use crate::{Faces, Reflectance};

pub use wide::VertexChanges;

/// How finely a patch is cut into triangles: of each of the two, the largest of all its triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grain<T> {
    /// The radius of the smallest circle around the three unit normals of a triangle's corners, taken as points: sin R,
    /// R the half angle of the smallest cone around them.
    pub normals: T,
    /// The radius r of the smallest circle around a triangle's corners, in the space of the evaluation.
    pub corners: T,
}

impl<T: Real> Grain<T> {
    /// Of a patch without triangles.
    pub fn none() -> Self {
        Self { normals: T::zero(), corners: T::zero() }
    }

    /// This, and a triangle with these corners and these unit normals at them.
    #[must_use]
    pub fn with(self, corners: [[T; 3]; 3], normals: [[T; 3]; 3]) -> Self {
        Self { normals: self.normals.max(circle(normals)), corners: self.corners.max(circle(corners)) }
    }
}

/// The radius of the smallest circle around three points: of the longest side, or around all corners where no angle is
/// obtuse.
fn circle<T: Real>([a, b, c]: [[T; 3]; 3]) -> T {
    let sides = [sub(b, c), sub(c, a), sub(a, b)];
    // Powers of it stay in the number range, whatever the triangle's size.
    let unit = sides.as_flattened().iter().fold(T::zero(), |most, side| most.max(side.abs()));
    if unit == T::zero() || !unit.is_finite() {
        return unit;
    }
    let mut sides = sides.map(|side| {
        let side = side.map(|along| along / unit);
        dot(side, side)
    });
    sides.sort_unstable_by(|x, y| x.partial_cmp(y).unwrap_or(core::cmp::Ordering::Equal));
    let [x, y, z] = sides;
    // 16 times the square of the area.
    let area = T::of(2.0) * (x * y + y * z + z * x) - (x * x + y * y + z * z);
    let by_side = T::of(0.25) * z;
    let square = if z >= x + y { by_side } else { (x * (y / area) * z).max(by_side) };
    // Of an angle near 90° either formula is right to some ε.
    unit * (square * (T::one() + slack())).sqrt()
}

/// Of one term of a light, without its colours: what shading it at the vertices changes at any point at most, and what
/// it has at every point at least.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TermChange<T> {
    /// By how much it may come out brighter.
    pub brighter: T,
    /// By how much it may come out darker.
    pub darker: T,
    /// Neither the term nor what is interpolated is less anywhere.
    pub least: T,
}

impl<T: Real> TermChange<T> {
    /// Of a term that is 0 everywhere.
    fn none() -> Self {
        Self { brighter: T::zero(), darker: T::zero(), least: T::zero() }
    }

    /// Neither by more than that. What rounding in `f32` may add is within the margin.
    fn limited(self, largest: T, weight: T) -> Self {
        let raise = |change: T| change.min(largest) * T::of(RAISE) + weight * T::of(LEAST);
        Self { brighter: raise(self.brighter), darker: raise(self.darker), least: self.least * T::of(1.0 / RAISE) }
    }
}

/// What each bound is multiplied by, and what is added to it of a light's largest att·spot: ten times what was found to
/// be lost in `f32`.
const RAISE: f64 = 1.001;
const LEAST: f64 = 2e-6;

/// What shading a light's terms at the vertices changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexChange<T> {
    /// Of att·spot itself, which an attenuated ambient colour is multiplied by.
    pub ambient: TermChange<T>,
    /// Of att·spot·max(n·l, 0).
    pub diffuse: TermChange<T>,
    /// Of att·spot·S.
    pub specular: TermChange<T>,
}

/// One side of a patch whose triangles may be shaded at their vertices: everything about it that does not depend on the
/// light.
///
/// What is interpolated over a triangle, perspective-correctly and unclamped, is Σ bᵢ·f(vᵢ) with f the term at each
/// corner and b the barycentric coordinates of a point; what it stands for is f at that point, with the interpolated,
/// renormalised normal. [`VertexShading::change`] bounds their difference, above and below.
///
/// # The bound
/// p = Σ bᵢ·pᵢ, m = Σ bᵢ·nᵢ, N = m/‖m‖. As the mean square of distances about a mean is no more than about any other
/// point, Σ bᵢ·‖pᵢ − p‖² ≤ r² and Σ bᵢ·‖nᵢ − m‖² = 1 − ‖m‖² ≤ sin² R ([`Grain`]), so ‖m‖ ≥ cos R. Along the straight
/// way to the corner i, N turns with a speed ωᵢ of at most ‖nᵢ − m‖/cos R, and Σ bᵢ·ωᵢ² ≤ tan² R. By Taylor's theorem
/// along the three ways, Σ bᵢ·f(vᵢ) − f(b) lies in ½·Σ bᵢ·[inf f″, sup f″].
///
/// With A, A′ and A″ the largest att·spot and the largest sizes of its first and second derivatives along a unit way, d
/// the least distance to the light and all cosines over the cones of [`Receiver`]:
///
/// | term | change | because |
/// |---|---|---|
/// | att·spot | ½·A″·r² | the above |
/// | diffuse | 2 sin(R/2)·L·r + ½·W·r², and (1 − cos R)·A·x more where it is darker | w = A·l: Σ bᵢ·nᵢ·wᵢ − N·w = −(1 − ‖m‖)·N·w + Σ bᵢ·(nᵢ − N)·(wᵢ − w) + N·(Σ bᵢ·wᵢ − w); L and W bound w′ and w″ |
/// | diffuse, where n·l changes sign | ½·(A·sin R + L·r) more where it is brighter | the gap of max(z, 0) over zᵢ with a span s is s/4, and s is at most 2·(A·sin R + L·r) |
/// | diffuse, where the light may count as in the plane | A·g more, g the largest [`Incidence::grazing`](crate::equations::Incidence::grazing) | the step from n·l = g to 0 is A·g high, at the point or at its corners |
/// | specular, n the exponent and f the angle of its cosine | ½·A·(M·ω² + K·a) + A′·r·K·ω + ½·A″·r² S | ω and a bound speed and acceleration of that angle, M and K the second and the first derivative of cosⁿ f |
/// | specular, where n·l changes sign | A·min(S, cⁿ), if that is more | it is cut off there, where its cosine is at most c: of h, (x + N·v)/‖l + v‖ with x the span of n·l and g |
///
/// No change is larger than the difference between the term's largest value and its smallest.
#[derive(Clone, Copy, Debug)]
pub struct VertexShading<T> {
    receiver: Receiver<T>,
    slopes: PowerSlopes<T>,
    is_mirror: bool,
    sin_r: T,
    cos_r: T,
    tan_r: T,
    /// r.
    corners: T,
    /// How far v turns on a way of length r at most.
    view_turn: T,
}

/// A light's att·spot over a patch.
#[derive(Clone, Copy)]
struct Weight<T> {
    largest: T,
    least: T,
    /// The largest size of its first derivative along a unit way, and of its second one.
    slope: T,
    bend: T,
    /// 1/d, d the least distance; 0 of a directional light.
    nearness: T,
    /// It varies across l, not only along it.
    is_spot: bool,
}

/// For a way p + u·s at distance d of a light, with a along the light's direction and t across it of u, l′ has the size
/// t/d, and l″ t·√(t² + 4·a²)/d² ≤ 2/√3·‖u‖²/d².
const TURNING: f64 = 1.154_700_6;

impl<T: Real> VertexShading<T> {
    /// The front of a patch, or its back, with the coefficients of that side and `slopes` of their exponent; `None`
    /// where nothing can be said: normals that are spread too wide, an eye among the points.
    pub fn new(
        patch: &Patch<T>,
        grain: &Grain<T>,
        slopes: PowerSlopes<T>,
        view: &Eye<T>,
        reflectance: Reflectance,
    ) -> Option<Self> {
        let patch = match patch.faces {
            Faces::Both => &Patch { faces: Faces::Front, ..*patch },
            Faces::Front | Faces::Back => patch,
        };
        patch.normals?;
        let receiver = Receiver::new(patch, &black(), view, reflectance);
        let sin_r = grain.normals;
        // Up to 60°.
        if !(receiver.is_moderate() && sin_r < T::of(0.866) && receiver.normals.spread.cos > T::zero()) {
            return None;
        }
        let view_turn = match *view {
            Eye::Infinite(_) => T::zero(),
            Eye::Local(eye) => {
                let nearest = length(sub(eye, patch.center)) * (T::one() - slack()) - patch.radius;
                // Also where it is no number.
                if nearest <= grain.corners || nearest.is_nan() {
                    return None;
                }
                grain.corners / nearest
            }
        };
        let cos_r = ((T::one() - sin_r) * (T::one() + sin_r)).sqrt();
        Some(Self {
            receiver,
            slopes,
            is_mirror: reflectance == Reflectance::Phong,
            sin_r,
            cos_r,
            tan_r: sin_r / cos_r,
            corners: grain.corners,
            view_turn,
        })
    }

    /// What shading the terms of `light` at the vertices changes; `None` where nothing can be said, as of a light among
    /// the points, or at the edge of its cone.
    pub fn change(&self, light: &Light<T>) -> Option<VertexChange<T>> {
        let (l, weight) = self.arrival(light)?;
        let zero = T::zero();
        let by_weight = T::of(0.5) * weight.bend * self.corners * self.corners;
        let ambient = TermChange { brighter: by_weight, darker: by_weight, least: weight.least };
        let ambient = ambient.limited(weight.largest - weight.least, weight.largest);
        let normals = &self.receiver.normals;
        let angle = Angle::between(normals.axis, l.axis);
        let spread = normals.spread.plus(l.spread);
        let facing = angle.cos_within(spread).min(T::one());
        if facing <= zero {
            return Some(VertexChange { ambient, diffuse: TermChange::none(), specular: TermChange::none() });
        }
        // The most that counts as in the plane of the surface.
        let over_distance = self.receiver.coincident * T::of((GRAZING / COINCIDENT).into()) * weight.nearness;
        let grazing = (T::of(GRAZING.into()) + over_distance) * (T::one() + slack());
        let least_facing = angle.plus(spread).cos - slack() - grazing;
        let diffuse = self.diffuse(&weight, facing, least_facing, grazing);
        let specular = self.specular(&l, &weight, least_facing, grazing);
        Some(VertexChange { ambient, diffuse, specular })
    }

    /// The directions of a light, and how much of it arrives.
    fn arrival(&self, light: &Light<T>) -> Option<(Cap<T>, Weight<T>)> {
        let (zero, one) = (T::zero(), T::one());
        let (l, weight) = match light.place {
            Place::Directional(l) => {
                let weight =
                    Weight { largest: one, least: one, slope: zero, bend: zero, nearness: zero, is_spot: false };
                (Cap::single(l), weight)
            }
            Place::Point(position) => self.fall(light, position)?,
        };
        let Some(cone) = &light.cone else { return Some((l, weight)) };
        let angle = Angle::between(neg(l.axis), cone.direction);
        let nearest = angle.cos_within(l.spread).min(one);
        let none = Weight { largest: zero, least: zero, slope: zero, bend: zero, ..weight };
        if nearest < cone.cos_cutoff {
            return Some((l, none));
        }
        let farthest = angle.plus(l.spread).cos - slack();
        if farthest < cone.cos_cutoff.max(cone.cos_inner.unwrap_or(cone.cos_cutoff)) || farthest <= zero {
            return None;
        }
        if cone.exponent == zero {
            return Some((l, weight));
        }
        let slopes = PowerSlopes::new(cone.exponent);
        let [steepest, falling, rising, largest] = slopes.from(nearest);
        if !falling.is_finite() {
            return None;
        }
        let turn = T::of(TURNING);
        let Weight { largest: a, slope, bend, nearness, .. } = weight;
        let spot = Weight {
            largest: a * largest,
            least: weight.least * power_within(farthest, cone.exponent)[0],
            slope: slope * largest + a * steepest * nearness,
            bend: bend * largest
                + T::of(2.0) * slope * steepest * nearness
                + a * (falling.max(rising) + turn * steepest) * nearness * nearness,
            nearness,
            is_spot: true,
        };
        Some((l, spot))
    }

    /// The same of a light at `position`, without its cone.
    fn fall(&self, light: &Light<T>, position: [T; 3]) -> Option<(Cap<T>, Weight<T>)> {
        let Receiver { center, radius, coincident, .. } = self.receiver;
        let offset = sub(position, center);
        let (l, distance) = Cap::toward(center, radius, position, offset, dot(offset, offset));
        let nearest = distance * (T::one() - slack()) - radius * (T::one() + slack());
        let farthest = (distance + radius) * (T::one() + slack());
        if nearest <= coincident || nearest.is_nan() {
            return None;
        }
        let [a, b, c] = light.attenuation;
        if a + nearest * (b + c * nearest) <= T::of(2.0 / f64::from(ATTENUATION_MAX)) {
            return None;
        }
        let nearness = nearest.recip();
        let (largest, least) = (attenuation([a, b, c], nearest), attenuation([a, b, c], farthest));
        // 1/q with q = a + b·d + c·d²: −q′/q² and 2·q′²/q³ − q″/q².
        let growth = b + T::of(2.0) * c * farthest;
        let square = largest * largest;
        let slope = growth * square;
        let bend = (T::of(2.0) * growth * growth * square * largest).max(T::of(2.0) * c * square);
        let [largest, least, slope, bend] = match light.range {
            None => [largest, least, slope, bend],
            Some(range) => {
                // (1 − t⁴)² with t = d/R: −8·t³·(1 − t⁴)/R and −8·(3·t² − 7·t⁶)/R², the first within 2.43/R.
                let near = nearest / range;
                let far = (farthest / range).min(T::one());
                let window = range_window(nearest, range);
                let steep = (T::of(8.0) * far * far * far).min(T::of(2.43)) / range;
                let far2 = far * far;
                let curved = (T::of(24.0) * far2).max(T::of(56.0) * far2 * far2 * far2 - T::of(24.0) * near * near)
                    / (range * range);
                [
                    largest * window,
                    least * range_window(farthest, range),
                    slope * window + largest * steep,
                    bend * window + T::of(2.0) * slope * steep + largest * curved,
                ]
            }
        };
        // A function of d bends across the way to the light too, by its slope over d.
        let bend = bend.max(slope * nearness);
        Some((l, Weight { largest, least, slope, bend, nearness, is_spot: false }))
    }

    fn diffuse(&self, weight: &Weight<T>, facing: T, least_facing: T, grazing: T) -> TermChange<T> {
        let (one, half) = (T::one(), T::of(0.5));
        let Weight { largest, least, slope, bend, nearness, is_spot } = *weight;
        let r = self.corners;
        let around = largest * nearness;
        let [first, second] = if is_spot {
            [(slope * slope + around * around).sqrt(), T::of(2.0) * slope * nearness]
        } else {
            [slope.max(around), slope * nearness]
        };
        let second = bend + second + T::of(TURNING) * around * nearness;
        let turned = self.sin_r / (half * (one + self.cos_r)).sqrt();
        let both = turned * first * r + half * second * r * r;
        let shorter = self.sin_r * self.sin_r / (one + self.cos_r) * largest * facing;
        let [kink, step] = if least_facing < T::zero() {
            let (span, step) = (half * (largest * self.sin_r + first * r), largest * grazing);
            let below = (-largest * (least_facing + grazing)).max(T::zero());
            [span.min(largest * facing).min(below) + step, step]
        } else {
            [T::zero(); 2]
        };
        let at_least = least * least_facing.max(T::zero());
        let change = TermChange { brighter: both + kink, darker: both + shorter + step, least: at_least };
        change.limited(largest * facing - at_least, largest)
    }

    fn specular(&self, l: &Cap<T>, weight: &Weight<T>, least_facing: T, grazing: T) -> TermChange<T> {
        let (zero, half) = (T::zero(), T::of(0.5));
        let Weight { largest, least, slope, bend, nearness, .. } = *weight;
        let (receiver, r) = (&self.receiver, self.corners);
        let (normals, view) = (&receiver.normals, &receiver.view);
        let (light_turn, view_turn) = (r * nearness, self.view_turn);
        let turns = T::of(TURNING) * (light_turn * light_turn + view_turn * view_turn);
        // ‖l + v‖ is twice the cosine of half their angle.
        let between = Angle::between(l.axis, view.axis).plus(l.spread).plus(view.spread);
        let sum = (T::of(2.0) * (T::one() + between.cos - slack()).max(zero)).sqrt();
        let tan2 = self.tan_r * self.tan_r;
        let (speed, acceleration, axis, other, spread) = if self.is_mirror {
            let speed = T::of(2.0) * self.tan_r + light_turn + view_turn;
            let acceleration =
                T::of(2.0) * tan2 + T::of(4.0) * self.tan_r * light_turn + turns + T::of(8.0) * tan2 * self.tan_r;
            let spread = normals.spread.plus(normals.spread).plus(view.spread).plus(l.spread);
            (speed, acceleration, reflect(l.axis, normals.axis), view.axis, spread)
        } else {
            let turn = (light_turn + view_turn) / sum;
            let acceleration = turns / sum + turn * turn + T::of(4.0) * tan2 * self.tan_r;
            let h = l.halfway(view, view.spread.chord());
            (self.tan_r + turn, acceleration, h.axis, normals.axis, normals.spread.plus(h.spread))
        };
        let angle = Angle::between(axis, other);
        let [steepest, falling, rising, peak] = self.slopes.from(angle.cos_within(spread).min(T::one()));
        let [lowest, _] = if least_facing < zero {
            [zero; 2]
        } else {
            power_within(angle.plus(spread).cos - slack(), self.slopes.exponent())
        };
        let range = largest * peak - least * lowest;
        let first = largest * steepest * speed + slope * r * peak;
        let extra = T::of(2.0) * slope * r * steepest * speed + bend * r * r * peak;
        // Where the power itself has a kink at 0.
        let is_smooth = self.slopes.exponent() >= T::of(2.0);
        let second = |bending: T| half * (largest * (bending * speed * speed + steepest * acceleration) + extra);
        let mut change = [rising, falling].map(|bending| {
            let change = if is_smooth { second(bending).min(first) } else { first };
            if change.is_nan() { range } else { change }
        });
        if least_facing < zero {
            let facing_span = T::of(2.0) * (self.sin_r + r * nearness) + grazing;
            let seen = Angle::between(normals.axis, view.axis).cos_within(normals.spread.plus(view.spread));
            let cut = if self.is_mirror {
                T::of(2.0) * facing_span * seen.max(zero) - between.cos + slack()
            } else {
                (facing_span + seen) / sum
            };
            let cut = if cut.is_nan() { peak } else { power_within(cut, self.slopes.exponent())[1].min(peak) };
            change = change.map(|change| change.max(largest * cut));
        }
        let [brighter, darker] = change;
        TermChange { brighter, darker, least: least * lowest }.limited(range, largest)
    }
}

/// The terms are bounded without their colours.
fn black<T: Real>() -> Coefficients<T> {
    let black = [T::zero(); 3];
    Coefficients { ka: black, kd: black, ks: black, ke: black, shininess: T::zero() }
}

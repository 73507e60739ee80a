//! What shading at the vertices changes of eight lights at once: the text of the module on lanes. What the plain text
//! decides by a branch is a selection here; powers are those of the other bounds on lanes, no less exact.
//!
//! Lights with a cone, and those whose squared distance leaves the range of numbers, are for the plain text.

use super::{LEAST, RAISE, TURNING, TermChange, VertexChange, VertexShading};
use crate::bounds::chunk::{CHUNK, Chunk};
use crate::bounds::lanes::{F, M, SLACK, V3, WideAngle, dot, load, load3, max, min, scale, splat, splat3, stored};
use crate::bounds::power;
use crate::equations::{ATTENUATION_MAX, COINCIDENT, GRAZING, Light};
use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd};

/// Finds the changes of many lights for one patch after the other. Its memory is kept.
#[derive(Clone, Debug)]
pub struct VertexChanges {
    level: Level,
    /// The lights asked for last, and the same side by side: neighbouring patches often ask for the same.
    numbers: Vec<u32>,
    chunks: Vec<Chunk>,
    found: Vec<Option<VertexChange<f32>>>,
}

impl Default for VertexChanges {
    fn default() -> Self {
        Self { level: Level::new(), numbers: Vec::new(), chunks: Vec::new(), found: Vec::new() }
    }
}

impl VertexChanges {
    /// Starts over with other lights.
    pub fn begin(&mut self) {
        self.numbers.clear();
    }

    /// [`VertexShading::change`] of each of the lights with these numbers; `lights` are the same since it was begun.
    pub fn find<'a>(
        &'a mut self,
        shading: &VertexShading<f32>,
        lights: &[Light<f32>],
        numbers: &[u32],
    ) -> &'a [Option<VertexChange<f32>>] {
        let Self { level, found, .. } = self;
        found.clear();
        // One light is found sooner by itself.
        if numbers.len() < 2 || !shading.suits_lanes() {
            found.extend(numbers.iter().map(|&number| shading.change(&lights[number as usize])));
            return found;
        }
        if self.numbers != numbers {
            self.numbers.clear();
            self.numbers.extend_from_slice(numbers);
            self.chunks.clear();
            for numbers in numbers.chunks(CHUNK) {
                let mut chunk = Chunk::EMPTY;
                for (lane, &number) in numbers.iter().enumerate() {
                    chunk.put(lane, &lights[number as usize]);
                }
                self.chunks.push(chunk);
            }
        }
        for (chunk, numbers) in self.chunks.iter().zip(numbers.chunks(CHUNK)) {
            let wide = changes(*level, shading, chunk);
            for (lane, &number) in numbers.iter().enumerate() {
                let has_cone = chunk.has_cone[lane] > 0.0;
                found.push(if has_cone || wide.odd >> lane & 1 == 1 {
                    shading.change(&lights[number as usize])
                } else {
                    wide.change(lane)
                });
            }
        }
        found
    }
}

/// The changes of a chunk's lights, each bound eight times.
struct WideChanges {
    /// The lanes that are for the plain text, a bit each.
    odd: u32,
    /// Those of which something can be said.
    said: u32,
    terms: [[[f32; CHUNK]; 3]; 3],
}

impl WideChanges {
    fn change(&self, lane: usize) -> Option<VertexChange<f32>> {
        let term = |term: &[[f32; CHUNK]; 3]| TermChange {
            brighter: term[0][lane],
            darker: term[1][lane],
            least: term[2][lane],
        };
        let [ambient, diffuse, specular] = &self.terms;
        (self.said >> lane & 1 == 1).then(|| VertexChange {
            ambient: term(ambient),
            diffuse: term(diffuse),
            specular: term(specular),
        })
    }
}

impl VertexShading<f32> {
    /// Whether powers have the derivatives that the lanes take for granted.
    fn suits_lanes(&self) -> bool {
        self.slopes.exponent() >= 2.0
    }
}

fn changes(level: Level, shading: &VertexShading<f32>, lights: &Chunk) -> WideChanges {
    match level {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx512(simd) => changes_with(simd, shading, lights),
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx2(simd) => changes_with(simd, shading, lights),
        level => fearless_simd::dispatch!(level, simd => changes_with(simd, shading, lights)),
    }
}

#[inline(always)]
fn changes_with<S: Simd>(simd: S, shading: &VertexShading<f32>, lights: &Chunk) -> WideChanges {
    simd.vectorize(
        #[inline(always)]
        || found(simd, shading, lights),
    )
}

/// A light's att·spot over a patch; see [`super::Weight`].
#[derive(Clone, Copy)]
struct WideWeight<S: Simd> {
    largest: F<S>,
    least: F<S>,
    slope: F<S>,
    bend: F<S>,
    nearness: F<S>,
}

#[inline(always)]
fn found<S: Simd>(simd: S, shading: &VertexShading<f32>, lights: &Chunk) -> WideChanges {
    let (zero, one) = (splat(simd, 0.0), splat(simd, 1.0));
    let WideIncidence { l, spread, weight, said, odd } = arrival(simd, shading, lights);
    let normals = &shading.receiver.normals;
    let by_weight = splat(simd, 0.5 * shading.corners * shading.corners) * weight.bend;
    let ambient = limited(simd, [by_weight, by_weight, weight.least], weight.largest - weight.least, weight.largest);
    let angle = WideAngle::between(splat3(simd, normals.axis), l);
    let around = WideAngle::of(simd, normals.spread).plus(simd, spread);
    let facing = min::<S>(angle.cos_within(simd, around), one);
    // The most that counts as in the plane of the surface.
    let share = shading.receiver.coincident * (GRAZING / COINCIDENT) * (1.0 + SLACK);
    let grazing = splat(simd, GRAZING * (1.0 + SLACK)) + splat(simd, share) * weight.nearness;
    let least_facing = angle.plus(simd, around).cos - splat(simd, SLACK) - grazing;
    let faces = facing.simd_gt(zero);
    let diffuse = diffuse(simd, shading, &weight, [facing, least_facing, grazing]);
    let specular = specular(simd, shading, (l, spread), &weight, [least_facing, grazing]);
    let lit = |change: [F<S>; 3]| change.map(|value| stored::<S>(faces.select(value, zero)));
    WideChanges {
        odd: odd.to_bitmask() as u32,
        said: said.to_bitmask() as u32,
        terms: [ambient.map(stored::<S>), lit(diffuse), lit(specular)],
    }
}

/// Lights as they arrive at the points of a patch.
struct WideIncidence<S: Simd> {
    l: V3<S>,
    spread: WideAngle<S>,
    weight: WideWeight<S>,
    /// Something can be said of these.
    said: M<S>,
    /// And these are for the plain text.
    odd: M<S>,
}

#[inline(always)]
fn arrival<S: Simd>(simd: S, shading: &VertexShading<f32>, lights: &Chunk) -> WideIncidence<S> {
    let (zero, one) = (splat(simd, 0.0), splat(simd, 1.0));
    let receiver = &shading.receiver;
    let radius = splat(simd, receiver.radius);
    let is_point = load(simd, &lights.is_point).simd_gt(zero);
    let place = load3(simd, &lights.place);
    let center = splat3(simd, receiver.center);
    let offset = [place[0] - center[0], place[1] - center[1], place[2] - center[2]];
    let square = dot::<S>(offset, offset);
    let safe =
        square.simd_gt(splat(simd, f32::MIN_POSITIVE / f32::EPSILON)) & square.simd_lt(splat(simd, f32::MAX * 0.25));
    let distance = square.sqrt();
    let nearest = distance * splat(simd, 1.0 - SLACK) - splat(simd, receiver.radius * (1.0 + SLACK));
    let farthest = (distance + radius) * splat(simd, 1.0 + SLACK);
    let [a, b, c] = load3(simd, &lights.attenuation);
    let divisor = |d: F<S>| a + d * (b + c * d);
    let said = nearest.simd_gt(splat(simd, receiver.coincident))
        & divisor(nearest).simd_gt(splat(simd, 2.0 / ATTENUATION_MAX));
    // What is not said is computed all the same, of numbers that do no harm.
    let nearest = said.select(nearest, one);
    let farthest = said.select(farthest, one);
    let nearness = one / nearest;
    let capped = |divisor: F<S>| one / max::<S>(divisor, splat(simd, ATTENUATION_MAX.recip()));
    let (largest, least) = (capped(divisor(nearest)), capped(divisor(farthest)));
    let two = splat(simd, 2.0);
    let growth = b + two * c * farthest;
    let squared = largest * largest;
    let slope = growth * squared;
    let bend = max::<S>(two * growth * growth * squared * largest, two * c * squared);
    // The range's window; without a range it is 1 and flat.
    let range = load(simd, &lights.range);
    let window = |d: F<S>| {
        let t = d / range;
        let t2 = t * t;
        let window = min::<S>(max::<S>(one - t2 * t2, zero), one);
        window * window
    };
    let over = one / range;
    let near = nearest * over;
    let far = min::<S>(farthest * over, one);
    let far2 = far * far;
    let steep = min::<S>(splat(simd, 8.0) * far * far2, splat(simd, 2.43)) * over;
    let curved =
        max::<S>(splat(simd, 24.0) * far2, splat(simd, 56.0) * far2 * far2 * far2 - splat(simd, 24.0) * near * near)
            * over
            * over;
    let near_window = window(nearest);
    let bend = bend * near_window + two * slope * steep + largest * curved;
    let slope = slope * near_window + largest * steep;
    let least = least * window(farthest);
    let largest = largest * near_window;
    let bend = max::<S>(bend, slope * nearness);
    // A directional light arrives as it is.
    let of_point = |value: F<S>, directional: f32| is_point.select(value, splat(simd, directional));
    let weight = WideWeight {
        largest: of_point(largest, 1.0),
        least: of_point(least, 1.0),
        slope: of_point(slope, 0.0),
        bend: of_point(bend, 0.0),
        nearness: of_point(nearness, 0.0),
    };
    let axis = scale::<S>(offset, one / distance);
    let l = [0, 1, 2].map(|k| is_point.select(axis[k], place[k]));
    let spread = WideAngle::subtended(simd, radius, distance);
    let spread = WideAngle::select(is_point, spread, WideAngle::splat(simd, 1.0, 0.0));
    WideIncidence { l, spread, weight, said: said | !is_point, odd: is_point & !safe }
}

/// Brighter and darker by no more than `largest`, raised by what rounding may add, and the least lowered.
#[inline(always)]
fn limited<S: Simd>(simd: S, [brighter, darker, least]: [F<S>; 3], largest: F<S>, weight: F<S>) -> [F<S>; 3] {
    let raise =
        |change: F<S>| min::<S>(change, largest) * splat(simd, RAISE as f32) + weight * splat(simd, LEAST as f32);
    [raise(brighter), raise(darker), least * splat(simd, (1.0 / RAISE) as f32)]
}

#[inline(always)]
fn diffuse<S: Simd>(
    simd: S,
    shading: &VertexShading<f32>,
    weight: &WideWeight<S>,
    [facing, least_facing, grazing]: [F<S>; 3],
) -> [F<S>; 3] {
    let (zero, half) = (splat(simd, 0.0), splat(simd, 0.5));
    let WideWeight { largest, least, slope, bend, nearness } = *weight;
    let r = splat(simd, shading.corners);
    let around = largest * nearness;
    let first = max::<S>(slope, around);
    let second = bend + slope * nearness + splat(simd, TURNING as f32) * around * nearness;
    let turned = shading.sin_r / (0.5 * (1.0 + shading.cos_r)).sqrt();
    let both = splat(simd, turned) * first * r + half * second * r * r;
    let shorter = splat(simd, shading.sin_r * shading.sin_r / (1.0 + shading.cos_r)) * largest * facing;
    let span = half * (largest * splat(simd, shading.sin_r) + first * r);
    let step = largest * grazing;
    let below = max::<S>(-largest * (least_facing + grazing), zero);
    let kink = min::<S>(min::<S>(span, largest * facing), below);
    let [kink, step] = [kink + step, step].map(|change| least_facing.simd_lt(zero).select(change, zero));
    let at_least = least * max::<S>(least_facing, zero);
    limited(simd, [both + kink, both + shorter + step, at_least], largest * facing - at_least, largest)
}

#[inline(always)]
fn specular<S: Simd>(
    simd: S,
    shading: &VertexShading<f32>,
    (l, l_spread): (V3<S>, WideAngle<S>),
    weight: &WideWeight<S>,
    [least_facing, grazing]: [F<S>; 2],
) -> [F<S>; 3] {
    let (zero, one, two, half) = (splat(simd, 0.0), splat(simd, 1.0), splat(simd, 2.0), splat(simd, 0.5));
    let WideWeight { largest, least, slope, bend, nearness } = *weight;
    let (receiver, r) = (&shading.receiver, splat(simd, shading.corners));
    let (normals, view) = (&receiver.normals, &receiver.view);
    let (normal_axis, view_axis) = (splat3(simd, normals.axis), splat3(simd, view.axis));
    let (normal_spread, view_spread) = (WideAngle::of(simd, normals.spread), WideAngle::of(simd, view.spread));
    let (light_turn, view_turn) = (r * nearness, splat(simd, shading.view_turn));
    let turns = splat(simd, TURNING as f32) * (light_turn * light_turn + view_turn * view_turn);
    let between = WideAngle::between(l, view_axis).plus(simd, l_spread).plus(simd, view_spread);
    let sum = (two * max::<S>(one + between.cos - splat(simd, SLACK), zero)).sqrt();
    let tan_r = shading.tan_r;
    let (speed, acceleration, angle, spread) = if shading.is_mirror {
        let speed = splat(simd, 2.0 * tan_r) + light_turn + view_turn;
        let acceleration = splat(simd, 2.0 * tan_r * tan_r + 8.0 * tan_r * tan_r * tan_r)
            + splat(simd, 4.0 * tan_r) * light_turn
            + turns;
        let twice = dot::<S>(normal_axis, l) * two;
        let mirrored = [0, 1, 2].map(|k| normal_axis[k] * twice - l[k]);
        let spread = normal_spread.plus(simd, normal_spread).plus(simd, view_spread).plus(simd, l_spread);
        (speed, acceleration, WideAngle::between(mirrored, view_axis), spread)
    } else {
        let turn = (light_turn + view_turn) / sum;
        let acceleration = turns / sum + turn * turn + splat(simd, 4.0 * tan_r * tan_r * tan_r);
        let halfway = [l[0] + view_axis[0], l[1] + view_axis[1], l[2] + view_axis[2]];
        let length = dot::<S>(halfway, halfway).sqrt();
        let moved = l_spread.chord(simd) + splat(simd, view.spread.chord()) + splat(simd, SLACK);
        let spread = WideAngle::subtended(simd, moved, length);
        let h = scale::<S>(halfway, one / max::<S>(length, splat(simd, SLACK)));
        let speed = splat(simd, tan_r) + turn;
        (speed, acceleration, WideAngle::between(normal_axis, h), normal_spread.plus(simd, spread))
    };
    let [steepest, falling, rising, peak] = slopes(simd, shading, min::<S>(angle.cos_within(simd, spread), one));
    let faces_all = least_facing.simd_ge(zero);
    let farthest = angle.plus(simd, spread).cos - splat(simd, SLACK);
    let lowest = faces_all.select(power_of(simd, farthest, shading.slopes.exponent(), false), zero);
    let range = largest * peak - least * lowest;
    let first = largest * steepest * speed + slope * r * peak;
    let extra = two * slope * r * steepest * speed + bend * r * r * peak;
    let of_bending = |bending: F<S>| {
        let second = half * (largest * (bending * speed * speed + steepest * acceleration) + extra);
        let change = min::<S>(second, first);
        // What is no number is not below anything.
        change.simd_lt(range).select(change, range)
    };
    let change = [of_bending(rising), of_bending(falling)];
    let span = two * (splat(simd, shading.sin_r) + r * nearness) + grazing;
    let seen = WideAngle::between(normal_axis, view_axis).cos_within(simd, normal_spread.plus(simd, view_spread));
    let cut = if shading.is_mirror {
        two * span * max::<S>(seen, zero) - between.cos + splat(simd, SLACK)
    } else {
        (span + seen) / sum
    };
    let is_number = cut.simd_eq(cut);
    let cut = is_number.select(min::<S>(power_of(simd, cut, shading.slopes.exponent(), true), peak), peak);
    let [brighter, darker] = change.map(|change| faces_all.select(change, max::<S>(change, largest * cut)));
    limited(simd, [brighter, darker, least * lowest], range, largest)
}

/// [`PowerSlopes::from`](crate::bounds::PowerSlopes) for exponents from 2 on.
#[inline(always)]
fn slopes<S: Simd>(simd: S, shading: &VertexShading<f32>, c: F<S>) -> [F<S>; 4] {
    let (zero, one) = (splat(simd, 0.0), splat(simd, 1.0));
    let n = shading.slopes.exponent();
    let c = max::<S>(c, zero);
    let lower = power_of(simd, c, n - 2.0, true);
    let lower = c.simd_gt(zero).select(lower, zero);
    let squared = (one - c) * (one + c);
    let along = splat(simd, n) * lower * c;
    let at_c = [along * squared.sqrt(), splat(simd, n * (n - 1.0)) * lower * squared, along * (one - c)];
    let peaks = shading.slopes.peaks();
    let of = |i: usize| c.simd_gt(splat(simd, peaks[i][0])).select(splat(simd, peaks[i][1]), at_c[i]);
    [of(0), along, of(1) + of(2), lower * c * c]
}

/// What max(x, 0) to the power of `e` is at most, or at least.
#[inline(always)]
fn power_of<S: Simd>(simd: S, x: F<S>, e: f32, at_most: bool) -> F<S> {
    let (zero, one) = (splat(simd, 0.0), splat(simd, 1.0));
    if e == 0.0 {
        return one;
    }
    let smallest = splat(simd, f32::MIN_POSITIVE);
    let power = power::power(simd, min::<S>(max::<S>(x, smallest), one), e);
    let off = if at_most { 1.0 + power::POWER_ERROR } else { 1.0 - power::POWER_ERROR };
    let power = min::<S>(power * splat(simd, off), one);
    let is_there = if at_most { x.simd_gt(zero) } else { power.simd_gt(splat(simd, 2.0 * f32::MIN_POSITIVE)) };
    x.simd_ge(one).select(one, is_there.select(power, zero))
}

//! What images leave of a patch's reflectance at most, and how far they turn its normals: for bounds of lights.

use crate::batch::key::{MapLook, MapLooks};
use crate::batch::table::{MapUse, MapsBits, MapsUse};
use crate::geometry::detail::Detail;
use crate::geometry::meshes::{Form, Geometry};
use crate::geometry::uv_boxes::UvBox;
use crate::lights::places::PatchShares;
use bevy_asset::{AssetId, Assets};
use bevy_platform::collections::HashMap;
use halfway_lighting::bounds::NormalCone;
use halfway_mesh::Mesh;
use halfway_texture::{LevelFilter, MapKind, Pyramid, Texture, UvSet};
use std::sync::Arc;

/// What is known of the patches of objects with images, kept while they are drawn.
#[derive(Debug, Default)]
pub(crate) struct Paints(HashMap<PaintKey, PaintedObject>);

/// A mesh as it is laid out, with images.
type PaintKey = (AssetId<Mesh>, Form, MapLooks, MapsBits);

/// An object with images, while its patches are lit.
#[derive(Debug)]
pub(crate) struct PaintedObject {
    looks: MapLooks,
    maps: MapsUse,
    pyramids: [Option<Pyramid>; MapKind::COUNT],
    detail: Arc<Detail>,
    /// By the numbers of patches.
    found: HashMap<u32, PatchPaint>,
    is_used: bool,
}

/// What images do to a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PatchPaint {
    pub(crate) shares: PatchShares,
    pub(crate) lean: Lean,
}

/// By how much images turn normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Lean {
    /// By nothing is known how much.
    Any,
    /// A normal of length 1 is moved by no more than this, aside or not.
    Within(f32),
}

impl PatchPaint {
    /// Of a patch of which nothing is known.
    pub(crate) const UNKNOWN: Self = Self { shares: PatchShares::ALL, lean: Lean::Any };
}

impl Lean {
    /// Of texels from these least to these largest ones, that count so much.
    fn of(amount: f32, [least, most]: [[f32; 4]; 2]) -> Self {
        let aside = [0, 1].map(|k: usize| (2.0 * most[k] - 1.0).abs().max((2.0 * least[k] - 1.0).abs()));
        let moved = amount.abs() * aside[0].hypot(aside[1]) / (2.0 * least[2] - 1.0).max(0.0);
        if moved.is_finite() { Self::Within(moved) } else { Self::Any }
    }

    /// The cone of the normals that come of those of this one, interpolated between vertices; `None` for any.
    ///
    /// Interpolated ones are no shorter than cos α, and tangents no longer than 1. What is moved by δ then turns by no
    /// more than arcsin(δ/cos α).
    pub(crate) fn widened(self, cone: NormalCone<f32>) -> Option<NormalCone<f32>> {
        let Self::Within(moved) = self else { return None };
        let sine = moved / cone.half_angle.cos();
        (sine < 1.0).then(|| NormalCone { half_angle: cone.half_angle + sine.asin() + SLACK, ..cone })
    }
}

/// What rounding in f32 may turn a normal by, in radians.
const SLACK: f32 = 1e-3;

impl Paints {
    /// Forgets what the frame before has not drawn.
    pub(crate) fn begin(&mut self) {
        self.0.retain(|_, object| std::mem::replace(&mut object.is_used, false));
    }

    /// What is known of an object, taken out.
    pub(crate) fn take(
        &mut self,
        (mesh, form, geometry): (AssetId<Mesh>, Form, &Geometry),
        looks: MapLooks,
        maps: &MapsUse,
        textures: &Assets<Texture>,
    ) -> PaintedObject {
        let pyramids = maps.slots.map(|slot| slot.map(|of: MapUse| of.pyramid(textures)));
        let known = self.0.remove(&(mesh, form, looks, maps.bits())).filter(|known| {
            let mut both = known.pyramids.iter().flatten().zip(pyramids.iter().flatten());
            Arc::ptr_eq(&known.detail, &geometry.detail) && both.all(|(a, b)| a.is_same(b))
        });
        known.unwrap_or_else(|| PaintedObject {
            looks,
            maps: *maps,
            pyramids,
            detail: geometry.detail.clone(),
            found: HashMap::default(),
            is_used: true,
        })
    }

    /// Keeps what is known of it by now.
    pub(crate) fn keep(&mut self, (mesh, form): (AssetId<Mesh>, Form), object: PaintedObject) {
        let key = (mesh, form, object.looks, object.maps.bits());
        self.0.insert(key, PaintedObject { is_used: true, ..object });
    }
}

impl PaintedObject {
    /// What images do to a patch of it.
    pub(crate) fn of(&self, geometry: &Geometry, patch: u32) -> PatchPaint {
        let found = || geometry.uv_boxes.of(patch).map_or(PatchPaint::UNKNOWN, |around| self.on(&around));
        self.found.get(&patch).copied().unwrap_or_else(found)
    }

    /// Keeps that for the next frame.
    pub(crate) fn remember(&mut self, patch: u32, paint: PatchPaint) {
        self.found.entry(patch).or_insert(paint);
    }

    /// What they do to points with these coordinates.
    fn on(&self, around: &UvBox) -> PatchPaint {
        let of = |kind: MapKind| {
            let slot = kind as usize;
            let (look, of) = (self.looks.0[slot]?, self.maps.slots[slot]?);
            Some((look, of.amount, range_on(look, &of, self.pyramids[slot].as_ref()?, around)))
        };
        // 1 + a(t − 1) at most.
        let largest = |kind: MapKind, channels: fn(MapLook) -> [usize; 3]| {
            of(kind).map_or([1.0; 3], |(look, amount, [_, most])| {
                channels(look).map(|channel| 1.0 + amount * (most[channel] - 1.0))
            })
        };
        let colors = |_: MapLook| [0, 1, 2];
        let color = largest(MapKind::Color, colors);
        let occlusion = largest(MapKind::Occlusion, |look| [look.channel as usize; 3]);
        let lean = match of(MapKind::Normal) {
            _ if self.looks.has(MapKind::Height) || self.looks.take_moments() => Lean::Any,
            Some((_, amount, range)) => Lean::of(amount, range),
            None => Lean::Within(0.0),
        };
        let shares = PatchShares {
            ambient: [0, 1, 2].map(|c| color[c] * occlusion[c]),
            diffuse: color,
            specular: largest(MapKind::Specular, colors),
        };
        PatchPaint { shares, lean }
    }
}

/// The least and the largest of what an image has where a mesh's coordinates are these, taken into 0 to 1.
fn range_on(look: MapLook, of: &MapUse, pyramid: &Pyramid, around: &UvBox) -> [[f32; 4]; 2] {
    let [low, high] = [around.low, around.high].map(|corner| {
        let [u, v, s, t] = corner.to_array();
        if look.uv_set == UvSet::First { [u, v] } else { [s, t] }
    });
    // The middle and half the sides, as the transform moves them.
    let boxed = of.rows().map(|[a, b, c]| {
        let [a, b, c] = [a, b, c].map(f64::from);
        let half = [0, 1].map(|k: usize| 0.5 * (f64::from(high[k]) - f64::from(low[k])));
        let middle = [0, 1].map(|k: usize| 0.5 * (f64::from(high[k]) + f64::from(low[k])));
        let size = a.abs() * (half[0] + middle[0].abs()) + b.abs() * (half[1] + middle[1].abs()) + c.abs();
        let (at, around) = (a * middle[0] + b * middle[1] + c, a.abs() * half[0] + b.abs() * half[1] + ROUNDED * size);
        [at - around, at + around]
    });
    // A pixel is sampled up to half its size beside a triangle, which is no more than a texel of the level that it
    // takes; without levels it may be any number of texels.
    let end = |at: usize, sign: f32| match look.sampling.levels {
        LevelFilter::None => [sign * f32::INFINITY; 2],
        _ => [boxed[0][at] as f32, boxed[1][at] as f32],
    };
    let range = pyramid.range_within(look.sampling, end(0, -1.0), end(1, 1.0));
    let within = |number: f32| if number > 0.0 { number.min(1.0) } else { 0.0 };
    range.map_or([[0.0; 4], [1.0; 4]], |range| [range.least, range.most].map(|ends| ends.map(within)))
}

/// What f32 rounds of a coordinate on an image, in parts of what it is the sum of.
const ROUNDED: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;
    use halfway_lighting::equations::mapped_normal;
    use halfway_lighting::equations::vector::{add, dot, normalize_or_zero, scale};

    /// Numbers from 0 to 1 that follow from no other.
    struct Hashed(u64);

    impl Hashed {
        fn next(&mut self) -> f32 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 40) as f32 / (1_u64 << 24) as f32
        }

        fn between(&mut self, low: f32, high: f32) -> f32 {
            low + self.next() * (high - low)
        }

        /// A direction within an angle of +Z.
        fn direction(&mut self, within: f32) -> [f32; 3] {
            let (angle, around) = (self.next() * within, self.next() * std::f32::consts::TAU);
            [angle.sin() * around.cos(), angle.sin() * around.sin(), angle.cos()]
        }

        /// The mean of three vectors, weighted anyhow.
        fn mean(&mut self, mut of: impl FnMut(&mut Self) -> [f32; 3]) -> [f32; 3] {
            let [a, b, c] = [0; 3].map(|_| self.next() + 1e-3);
            let mean = [a, b, c].map(|weight| scale(of(self), weight / (a + b + c)));
            add(add(mean[0], mean[1]), mean[2])
        }
    }

    /// How many normals of images leave the widened cone, and how many cones there are.
    fn outside(widened: impl Fn(Lean, NormalCone<f32>) -> Option<NormalCone<f32>>) -> [u32; 2] {
        let mut hashed = Hashed(11);
        let mut counts = [0; 2];
        for _ in 0..4000 {
            let cone = NormalCone { axis: [0.0, 0.0, 1.0], half_angle: hashed.between(0.0, 1.2) };
            let amount = hashed.between(-2.0, 2.0);
            let range = [0; 4].map(|_| {
                let middle = hashed.between(0.35, 0.65);
                let half = hashed.between(0.0, 0.1);
                [middle - half, middle + half]
            });
            let least_z = hashed.between(0.6, 0.99);
            let least = [range[0][0], range[1][0], least_z, 0.0];
            let most = [range[0][1], range[1][1], 1.0, 0.0];
            let Some(wide) = widened(Lean::of(amount, [least, most]), cone) else { continue };
            counts[1] += 1;
            for _ in 0..30 {
                let n = hashed.mean(|hashed| hashed.direction(cone.half_angle));
                let t = hashed.mean(|hashed| hashed.direction(std::f32::consts::PI));
                let texel = [0, 1, 2].map(|k: usize| hashed.between(least[k], most[k]));
                let w = hashed.between(-1.0, 1.0).signum();
                let otherwise = normalize_or_zero(n);
                let turned = mapped_normal(n, t, w, texel, amount, otherwise);
                counts[0] += u32::from(dot(turned, wide.axis).clamp(-1.0, 1.0).acos() > wide.half_angle);
            }
        }
        counts
    }

    #[test]
    fn normals_of_images_stay_in_the_widened_cone() {
        let [outside_of_it, cones] = outside(Lean::widened);
        assert!(cones > 1000, "of {cones} cones something is known");
        assert_eq!(outside_of_it, 0);
        // A planted fault: half as wide.
        let [found, _] = outside(|lean, cone| {
            let wide = lean.widened(cone)?;
            Some(NormalCone { half_angle: 0.5 * (cone.half_angle + wide.half_angle), ..wide })
        });
        assert!(found > 20, "{found}");
    }

    #[test]
    fn nothing_is_known_of_normals_that_lie_flat() {
        let all = [[0.0; 4], [1.0; 4]];
        assert_eq!(Lean::of(1.0, all), Lean::Any);
        let cone = NormalCone { axis: [0.0, 0.0, 1.0], half_angle: 0.1 };
        assert_eq!(Lean::Any.widened(cone), None);
        assert_eq!(Lean::Within(1.0).widened(cone), None);
        // What does not count turns nothing.
        assert_eq!(Lean::of(0.0, [[0.0, 0.0, 0.6, 0.0], [1.0; 4]]), Lean::Within(0.0));
    }
}

//! The visible hits on one ray, and their blended colour.

use halfway_lighting::Faces;

use super::raster::Hit;
use super::scene::OracleScene;
use super::solid::Color;

/// The hits on one ray that can be seen: the nearest opaque one, and the blended ones. They have to be added in the
/// order of drawing.
#[derive(Clone, Debug, Default)]
pub(super) struct Layers {
    opaque: Option<Hit>,
    blended: Vec<Hit>,
}

/// Depths that differ by this share are equal: far above the rounding of f64, and far below what a depth buffer in f32
/// can tell apart.
const EQUAL_DEPTH: f64 = 1e-9;

/// Whether a surface at depth `a` hides one that was drawn before at depth `b`.
fn hides(a: f64, b: f64) -> bool {
    // An orthographic camera may see what is behind itself.
    a < b - EQUAL_DEPTH * b.abs()
}

impl Layers {
    pub(super) fn add(&mut self, scene: &OracleScene, hit: Hit) {
        if scene.is_cut(&hit) {
            return;
        }
        if scene.solids[hit.solid].blend {
            self.blended.push(hit);
        } else if self.opaque.is_none_or(|known| hides(hit.depth, known.depth)) {
            self.opaque = Some(hit);
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.opaque.is_none() && self.blended.is_empty()
    }

    /// The visible hits in drawing order: the opaque one, then the blended ones before it.
    pub(super) fn visible(&self, scene: &OracleScene) -> impl Iterator<Item = &Hit> {
        let before = |hit: &&Hit| self.opaque.is_none_or(|opaque| hides(hit.depth, opaque.depth));
        let mut blended: Vec<&Hit> = self.blended.iter().filter(before).collect();
        // A two-sided object draws its far side first. Stable: in one pass triangles keep their order.
        blended.sort_by_key(|hit| (hit.solid, hit.front && scene.solids[hit.solid].faces == Faces::Both));
        self.opaque.iter().chain(blended)
    }

    /// The intensities of all visible hits, blended over `behind`; each is first clamped to 1 if `clamp` is set.
    pub(super) fn color(&self, scene: &OracleScene, behind: Color, clamp: bool) -> Color {
        self.visible(scene).fold(written(behind, clamp), |behind, hit| {
            blended(scene.opacity(hit), written(scene.value(hit), clamp), behind)
        })
    }
}

/// An intensity as it is written: clamped to 1 if `clamp` is set.
pub(super) fn written(i: Color, clamp: bool) -> Color {
    if clamp { i.map(|channel| channel.min(1.0)) } else { i }
}

/// A colour of this opacity over the one behind it.
pub(super) fn blended(opacity: f64, over: Color, behind: Color) -> Color {
    [0, 1, 2].map(|k| if opacity < 1.0 { opacity * over[k] + (1.0 - opacity) * behind[k] } else { over[k] })
}

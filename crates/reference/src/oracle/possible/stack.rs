//! The possible orders of surfaces near a sampling point, and the blended colours of each.

use halfway_lighting::Faces;

use super::covering::{CoveringGroup, coverings};
use super::footprint::{Footprint, Zone};
use super::range::{ColorRange, Possible};
use super::values::{SideColors, cuts};
use crate::oracle::scene::OracleScene;
use crate::oracle::solid::Color;

/// A side of a triangle that may be visible.
#[derive(Clone)]
struct Layer {
    /// The footprint's index, in drawing order among those of its object.
    footprint: usize,
    front: bool,
    values: SideColors,
}

/// Alternative blended layers: at most one covers the sampling point.
struct Choice {
    layers: Vec<Layer>,
    /// Exactly one does.
    is_certain: bool,
}

/// Everything that may be visible near a sampling point.
pub(super) struct Stack {
    footprints: Vec<Footprint>,
    opaque: Vec<Layer>,
    /// Whether the ray may miss every opaque surface.
    is_bare: bool,
    blended: Vec<Choice>,
}

/// The most combinations of blended layers; more are merged into one range.
const MOST_COMBINATIONS: usize = 256;

impl Stack {
    pub(super) fn new(scene: &OracleScene, footprints: Vec<Footprint>, shading: &[&Zone]) -> Self {
        let mut coverings = coverings(scene, &footprints);
        for covering in &mut coverings {
            cut(scene, &footprints, covering, shading);
        }
        coverings.retain(|covering| !covering.members.is_empty());
        let is_blended = |covering: &&CoveringGroup| scene.solids[footprints[covering.members[0]].solid].blend;
        let (blended, opaque): (Vec<&CoveringGroup>, Vec<&CoveringGroup>) = coverings.iter().partition(is_blended);
        // The farthest point of each surface that certainly covers the point.
        let farthest = |covering: &&CoveringGroup| {
            let shown = covering.members.iter().map(|member| &footprints[*member]).filter(|it| is_shown(scene, it));
            shown.map(|footprint| footprint.nearness[0]).fold(f64::INFINITY, f64::min)
        };
        let certain: Vec<f64> = opaque.iter().filter(|it| it.is_certain).map(farthest).collect();
        let cover = certain.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let layer = |footprint: usize, front: bool| {
            let values = SideColors::new(scene, &footprints[footprint], front, shading);
            Layer { footprint, front, values }
        };
        let layers = |covering: &&CoveringGroup| -> Vec<Layer> {
            let visible = covering.members.iter().copied().filter(|m| {
                let it = &footprints[*m];
                let is_first = || !footprints[..*m].iter().any(|earlier| is_hidden_by(scene, it, earlier));
                it.nearness[1] >= cover && is_first()
            });
            let sides =
                visible.flat_map(|m| sides(scene, &footprints[m], covering.is_certain).map(move |side| (m, side)));
            sides.map(|(m, front)| layer(m, front)).collect()
        };
        let opaque_layers = opaque.iter().flat_map(&layers).collect();
        let choices = blended.iter().flat_map(|covering| choices(covering, layers(covering), &footprints));
        Self { opaque: opaque_layers, is_bare: certain.is_empty(), blended: choices.collect(), footprints }
    }

    /// The colours of all combinations, over the background `behind_all`.
    pub(super) fn possible(&self, scene: &OracleScene, behind_all: Color, clamp: bool) -> Possible {
        let written =
            |range: &ColorRange| range.through(range, |channel, _| if clamp { channel.min(1.0) } else { channel });
        let mut ranges: Vec<ColorRange> = Vec::new();
        let mut layers = 0;
        let behind = self.opaque.iter().map(Some).chain(self.is_bare.then_some(None));
        for opaque in behind {
            let range = opaque.map_or_else(|| ColorRange::from_colors([behind_all]), |layer| layer.values.range);
            let visible = self.visible_over(scene, opaque);
            layers = layers.max(most_layers(&visible));
            for range in self.over(scene, &visible, written(&range), &written) {
                if !ranges.contains(&range) {
                    ranges.push(range);
                }
            }
        }
        let blended = self.blended.iter().flat_map(|choice| &choice.layers);
        let jumps = self.opaque.iter().chain(blended).any(|layer| layer.values.jumps);
        Possible { is_edge: ranges.len() > 1 || jumps, ranges, layers }
    }

    /// For each choice, the blended layers that may lie over an opaque one, or over the background, and whether none
    /// may.
    fn visible_over(&self, scene: &OracleScene, opaque: Option<&Layer>) -> Vec<(Vec<&Layer>, bool)> {
        self.blended.iter().map(|choice| self.before(scene, choice, opaque)).collect()
    }

    /// The colours of all combinations of blended layers over the colours behind them.
    fn over(
        &self,
        scene: &OracleScene,
        visible: &[(Vec<&Layer>, bool)],
        behind: ColorRange,
        written: &impl Fn(&ColorRange) -> ColorRange,
    ) -> Vec<ColorRange> {
        let blend = |behind: &ColorRange, layer: &Layer| {
            let over = written(&layer.values.range);
            let [least, greatest] = layer.values.opacity.map(|opacity| {
                behind.through(
                    &over,
                    |behind, over| if opacity < 1.0 { opacity * over + (1.0 - opacity) * behind } else { over },
                )
            });
            least.with(&greatest)
        };
        let combinations = visible.iter().try_fold(1_usize, |product, (layers, may_be_missed)| {
            let ways = layers.len() + usize::from(*may_be_missed);
            product.checked_mul(ways.max(1)).filter(|product| *product <= MOST_COMBINATIONS)
        });
        if combinations.is_none() {
            return vec![self.over_at_once(scene, behind, visible, blend)];
        }
        let mut ways: Vec<Vec<&Layer>> = vec![Vec::new()];
        for (layers, may_be_missed) in visible {
            let missed = (*may_be_missed || layers.is_empty()).then_some(None);
            let choices: Vec<Option<&Layer>> = layers.iter().map(|layer| Some(*layer)).chain(missed).collect();
            ways = ways
                .iter()
                .flat_map(|way| choices.iter().map(move |choice| way.iter().copied().chain(*choice).collect()))
                .collect();
        }
        let over = ways.into_iter().map(|mut way| {
            way.sort_by_key(|layer| self.order(scene, layer));
            way.dedup_by_key(|layer| (layer.footprint, layer.front));
            way.into_iter().fold(behind, |behind, layer| blend(&behind, layer))
        });
        over.collect()
    }

    /// All combinations in one range: each layer may be missed.
    fn over_at_once(
        &self,
        scene: &OracleScene,
        behind: ColorRange,
        visible: &[(Vec<&Layer>, bool)],
        blend: impl Fn(&ColorRange, &Layer) -> ColorRange,
    ) -> ColorRange {
        let mut layers: Vec<&Layer> = visible.iter().flat_map(|(layers, _)| layers).copied().collect();
        layers.sort_by_key(|layer| self.order(scene, layer));
        layers.dedup_by_key(|layer| (layer.footprint, layer.front));
        layers.into_iter().fold(behind, |behind, layer| behind.with(&blend(&behind, layer)))
    }

    /// The layers of a choice that may lie before an opaque one, and whether none may.
    fn before<'a>(&self, scene: &OracleScene, choice: &'a Choice, opaque: Option<&Layer>) -> (Vec<&'a Layer>, bool) {
        let Some(opaque) = opaque.map(|layer| &self.footprints[layer.footprint]) else {
            return (choice.layers.iter().collect(), !choice.is_certain);
        };
        let of = |layer: &Layer| &self.footprints[layer.footprint];
        let may_be_before =
            |layer: &&Layer| of(layer).nearness[1] >= opaque.nearness[0] && !of(layer).coincides(opaque, scene);
        let layers: Vec<&Layer> = choice.layers.iter().filter(may_be_before).collect();
        let is_before = |layer: &&Layer| of(layer).nearness[0] > opaque.nearness[1];
        let all_are = layers.len() == choice.layers.len() && layers.iter().all(is_before);
        (layers, !(choice.is_certain && all_are))
    }

    /// The drawing order: by object; the back first if it is two-sided; then by triangle.
    fn order(&self, scene: &OracleScene, layer: &Layer) -> (usize, bool, u32) {
        let footprint = &self.footprints[layer.footprint];
        let in_two_passes = scene.solids[footprint.solid].faces == Faces::Both;
        (footprint.solid, layer.front && in_two_passes, footprint.triangle)
    }
}

/// The most blended layers over one another: one of each choice, and each layer once.
fn most_layers(visible: &[(Vec<&Layer>, bool)]) -> usize {
    let choices = visible.iter().filter(|(layers, _)| !layers.is_empty()).count();
    let mut layers: Vec<_> =
        visible.iter().flat_map(|(layers, _)| layers).map(|layer| (layer.footprint, layer.front)).collect();
    layers.sort_unstable();
    layers.dedup();
    choices.min(layers.len())
}

/// Removes the members of a covering that a mask certainly cuts away; members that it may cut away no longer cover
/// anything for certain.
fn cut(scene: &OracleScene, footprints: &[Footprint], covering: &mut CoveringGroup, shading: &[&Zone]) {
    let ways: Vec<[bool; 2]> =
        covering.members.iter().map(|member| cuts(scene, &footprints[*member], shading)).collect();
    if ways.iter().any(|[may_be_cut, _]| *may_be_cut) {
        (covering.is_certain, covering.is_single) = (false, false);
        let mut ways = ways.iter();
        covering.members.retain(|_| ways.next().is_some_and(|[_, may_be_there]| *may_be_there));
    }
}

fn is_shown(scene: &OracleScene, footprint: &Footprint) -> bool {
    scene.solids[footprint.solid].side(footprint.front).shown
}

/// Whether an earlier opaque triangle hides this one: the same triangle of an object with an equal mesh and transform
/// that was spawned before. Other coincident triangles may be drawn in either order.
fn is_hidden_by(scene: &OracleScene, footprint: &Footprint, earlier: &Footprint) -> bool {
    let [solid, first] = [footprint, earlier].map(|it| &scene.solids[it.solid]);
    let are_twins = || solid.mesh.positions() == first.mesh.positions() && solid.mesh.indices() == first.mesh.indices();
    let are_the_same = footprint.triangle == earlier.triangle && footprint.coincides(earlier, scene);
    !solid.blend && !first.blend && is_shown(scene, earlier) && are_the_same && are_twins()
}

/// The drawn sides that may be visible: the one that faces the eye, or both for a thin triangle at a silhouette or of a
/// blended object, which rounding may flip.
fn sides(scene: &OracleScene, footprint: &Footprint, is_certain: bool) -> impl Iterator<Item = bool> {
    let solid = &scene.solids[footprint.solid];
    let may_turn = footprint.thin && (!is_certain || solid.blend);
    let front = footprint.front;
    [true, false].into_iter().filter(move |side| (may_turn || *side == front) && solid.side(*side).shown)
}

/// The layers of one covering as one choice, since a ray hits each side at most once; or a choice for each layer, if
/// they overlap or the surface may fold.
fn choices(covering: &CoveringGroup, layers: Vec<Layer>, footprints: &[Footprint]) -> Vec<Choice> {
    let all_are_there = covering.members.iter().all(|m| layers.iter().any(|layer| layer.footprint == *m));
    if covering.is_single && all_are_there {
        return vec![Choice { layers, is_certain: true }];
    }
    if covering.may_fold && covering.is_certain && all_are_there {
        // A fold adds one more layer.
        return [true, false].map(|is_certain| Choice { layers: layers.clone(), is_certain }).into();
    }
    let (front, back): (Vec<Layer>, Vec<Layer>) = layers.into_iter().partition(|layer| layer.front);
    let mut choices = Vec::new();
    for layers in [back, front].into_iter().filter(|layers| !layers.is_empty()) {
        let number = layers.iter().filter(|layer| footprints[layer.footprint].at_centre).count();
        if number > 1 || covering.may_fold {
            choices.extend(layers.into_iter().map(|layer| Choice { layers: vec![layer], is_certain: false }));
        } else {
            choices.push(Choice { layers, is_certain: false });
        }
    }
    choices
}

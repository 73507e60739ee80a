//! What may lie over what near a sampling point, and the colours that this makes.

use halfway_lighting::Faces;

use super::covering::{CoveringGroup, coverings};
use super::footprint::{Footprint, Zone};
use super::range::{ColorRange, Possible};
use super::values::{SideColors, cuts};
use crate::oracle::gather::OracleScene;
use crate::oracle::solid::Color;

/// A side of a triangle that may be seen.
#[derive(Clone)]
struct Layer {
    /// The footprint's number, which is its place in the order of drawing among those of its object.
    footprint: usize,
    front: bool,
    values: SideColors,
}

/// Blended layers of which at most one lies over the sampling point.
struct Choice {
    layers: Vec<Layer>,
    /// Exactly one does.
    is_certain: bool,
}

/// Everything that may be seen near a sampling point.
pub(super) struct Stack {
    footprints: Vec<Footprint>,
    opaque: Vec<Layer>,
    /// Whether no opaque surface may be met.
    is_bare: bool,
    blended: Vec<Choice>,
}

/// More combinations of blended layers become one range.
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
        // The farthest point of each surface that cannot be missed.
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

    /// The colours of all combinations, before what is `behind` everything.
    pub(super) fn possible(&self, scene: &OracleScene, behind_all: Color, clamp: bool) -> Possible {
        let written =
            |range: &ColorRange| range.through(range, |channel, _| if clamp { channel.min(1.0) } else { channel });
        let mut ranges: Vec<ColorRange> = Vec::new();
        let mut layers = 0;
        let behind = self.opaque.iter().map(Some).chain(self.is_bare.then_some(None));
        for opaque in behind {
            let range = opaque.map_or_else(|| ColorRange::of([behind_all]), |layer| layer.values.range);
            let seen = self.seen_over(scene, opaque);
            layers = layers.max(most_layers(&seen));
            for range in self.over(scene, &seen, written(&range), &written) {
                if !ranges.contains(&range) {
                    ranges.push(range);
                }
            }
        }
        let blended = self.blended.iter().flat_map(|choice| &choice.layers);
        let jumps = self.opaque.iter().chain(blended).any(|layer| layer.values.jumps);
        Possible { is_edge: ranges.len() > 1 || jumps, ranges, layers }
    }

    /// Of each choice the blended layers that may lie over an opaque one, or over the background, and whether perhaps
    /// none does.
    fn seen_over(&self, scene: &OracleScene, opaque: Option<&Layer>) -> Vec<(Vec<&Layer>, bool)> {
        self.blended.iter().map(|choice| self.before(scene, choice, opaque)).collect()
    }

    /// The colours of all combinations of blended layers over what is behind them.
    fn over(
        &self,
        scene: &OracleScene,
        seen: &[(Vec<&Layer>, bool)],
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
        let combinations = seen.iter().try_fold(1_usize, |product, (layers, may_be_missed)| {
            let ways = layers.len() + usize::from(*may_be_missed);
            product.checked_mul(ways.max(1)).filter(|product| *product <= MOST_COMBINATIONS)
        });
        if combinations.is_none() {
            return vec![self.over_at_once(scene, behind, seen, blend)];
        }
        let mut ways: Vec<Vec<&Layer>> = vec![Vec::new()];
        for (layers, may_be_missed) in seen {
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
        seen: &[(Vec<&Layer>, bool)],
        blend: impl Fn(&ColorRange, &Layer) -> ColorRange,
    ) -> ColorRange {
        let mut layers: Vec<&Layer> = seen.iter().flat_map(|(layers, _)| layers).copied().collect();
        layers.sort_by_key(|layer| self.order(scene, layer));
        layers.dedup_by_key(|layer| (layer.footprint, layer.front));
        layers.into_iter().fold(behind, |behind, layer| behind.with(&blend(&behind, layer)))
    }

    /// Which layers of a choice may lie before an opaque one, and whether perhaps none does.
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

    /// The order of drawing: by object; of a two-sided one the back first; then by triangle.
    fn order(&self, scene: &OracleScene, layer: &Layer) -> (usize, bool, u32) {
        let footprint = &self.footprints[layer.footprint];
        let in_two_passes = scene.solids[footprint.solid].faces == Faces::Both;
        (footprint.solid, layer.front && in_two_passes, footprint.triangle)
    }
}

/// How many blended layers may lie over one another: one of each choice, and each layer once.
fn most_layers(seen: &[(Vec<&Layer>, bool)]) -> usize {
    let choices = seen.iter().filter(|(layers, _)| !layers.is_empty()).count();
    let mut layers: Vec<_> =
        seen.iter().flat_map(|(layers, _)| layers).map(|layer| (layer.footprint, layer.front)).collect();
    layers.sort_unstable();
    layers.dedup();
    choices.min(layers.len())
}

/// Leaves out what a mask has certainly cut out of a covering; what it may have cut out covers nothing for certain.
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

/// Whether an opaque triangle takes the place of another one: the same of an object with an equal mesh and the same
/// transform that was spawned before. Of others that coincide either may be drawn first.
fn is_hidden_by(scene: &OracleScene, footprint: &Footprint, earlier: &Footprint) -> bool {
    let [solid, first] = [footprint, earlier].map(|it| &scene.solids[it.solid]);
    let are_twins = || solid.mesh.positions() == first.mesh.positions() && solid.mesh.indices() == first.mesh.indices();
    let are_the_same = footprint.triangle == earlier.triangle && footprint.coincides(earlier, scene);
    !solid.blend && !first.blend && is_shown(scene, earlier) && are_the_same && are_twins()
}

/// The sides that may be seen: the one that is turned to the eye, and of a thin triangle at a silhouette or of a
/// blended object, which rounding may turn over, both; if they are shown.
fn sides(scene: &OracleScene, footprint: &Footprint, is_certain: bool) -> impl Iterator<Item = bool> {
    let solid = &scene.solids[footprint.solid];
    let may_turn = footprint.thin && (!is_certain || solid.blend);
    let front = footprint.front;
    [true, false].into_iter().filter(move |side| (may_turn || *side == front) && solid.side(*side).shown)
}

/// The layers of one covering, of which each side is met once at most; or each by itself, where they overlap or the
/// surface may be folded.
fn choices(covering: &CoveringGroup, layers: Vec<Layer>, footprints: &[Footprint]) -> Vec<Choice> {
    let all_are_there = covering.members.iter().all(|m| layers.iter().any(|layer| layer.footprint == *m));
    if covering.is_single && all_are_there {
        return vec![Choice { layers, is_certain: true }];
    }
    if covering.may_fold && covering.is_certain && all_are_there {
        // A fold lies over one layer, once more.
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

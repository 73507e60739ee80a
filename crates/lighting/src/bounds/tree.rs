//! Many lights, found by where they are.

use super::Region;
use super::reach::brightest;
use crate::equations::{COINCIDENT, Light, Place, attenuation};

/// How many lights a leaf holds at most, and of how many nodes one above is made.
const LEAF: usize = 16;
const BRANCHES: usize = 8;

/// What distances are shortened by and sums raised by, relative to themselves: more than all rounding on the way, and
/// than what the bounds widen by.
const SLACK: f32 = 1e-3;

/// Lights in a hierarchy of boxes, so that those which reach a region are found without looking at the others.
///
/// [`NearLights`](super::NearLights) takes from it the lights that a region may need and what all the others add at
/// most: nothing where they are out of their range, and otherwise so little that it can be told from a bound for many
/// of them. Directional lights reach everything.
///
/// Made by [`LightTree::rebuild`], in a time that is as good as linear in the lights. Where they have only been moved
/// or turned together, as by a camera that moves, [`LightTree::follow`] is sooner. Its memory is kept.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightTree {
    /// Those that have no place.
    everywhere: Vec<u32>,
    /// Those that have one, in an order in which neighbours are neighbours in space.
    leaves: Vec<LightLeaf>,
    /// Level upon level, the leaves' first; each node of those above has up to eight below it.
    levels: Vec<Vec<LightNode>>,
    /// Places on a curve that fills space, and the numbers of the lights.
    keys: Vec<u64>,
}

/// A light, as far as is known without its patch.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LightLeaf {
    number: u32,
    position: [f32; 3],
    falloff: Falloff,
}

/// Lights that lie together.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LightNode {
    around: LightBox,
    falloff: Falloff,
    count: u32,
}

/// A box around lights.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LightBox {
    low: [f32; 3],
    high: [f32; 3],
}

/// What lights add at a distance at most.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Falloff {
    /// The largest; infinite where one has none.
    range: f32,
    /// The least numbers.
    attenuation: [f32; 3],
    /// The sum of their colours' brightest channels.
    color: f32,
}

impl Falloff {
    fn of(light: &Light<f32>) -> Self {
        Self {
            range: light.range.unwrap_or(f32::INFINITY),
            attenuation: light.attenuation,
            color: brightest(light) as f32 * (1.0 + SLACK),
        }
    }

    fn joined<'a>(all: impl Iterator<Item = &'a Self>) -> Self {
        let nothing = Self { range: 0.0, attenuation: [f32::INFINITY; 3], color: 0.0 };
        all.fold(nothing, |all, one| Self {
            range: all.range.max(one.range),
            attenuation: [0, 1, 2].map(|k| all.attenuation[k].min(one.attenuation[k])),
            color: all.color + one.color,
        })
    }
}

/// A region as lights are looked for around it.
struct LightSearch<'a> {
    region: &'a Region,
    /// The distance from which a light may count as being at a point of it, and what its corners are rounded by.
    margin: f32,
    /// What each light may add unseen.
    quota: f64,
}

/// What is to be done with lights.
enum Visit {
    /// They add nothing.
    Nothing,
    /// They add so little at most that they need not be looked at.
    Little(f64),
    Open,
}

impl LightSearch<'_> {
    /// Of lights in a box.
    fn visit_to(&self, LightBox { low, high }: &LightBox, falloff: &Falloff, count: u32) -> Visit {
        let beside = |k: usize| (low[k] - self.region.high[k]).max(self.region.low[k] - high[k]).max(0.0);
        let [x, y, z] = [beside(0), beside(1), beside(2)];
        let distance = (x * x + y * y + z * z).sqrt() * (1.0 - SLACK) - self.margin;
        // Nothing is known where a square left the number range.
        if !(distance > 0.0 && distance < f32::INFINITY) {
            return Visit::Open;
        }
        if distance > falloff.range {
            return Visit::Nothing;
        }
        let weight = attenuation(falloff.attenuation, distance).max(f32::MIN_POSITIVE) * (1.0 + SLACK);
        let most = f64::from(self.region.brightest * falloff.color * weight);
        if most <= self.quota * f64::from(count) { Visit::Little(most) } else { Visit::Open }
    }
}

impl LightTree {
    /// Takes these lights in place of those it had.
    pub fn rebuild(&mut self, lights: &[Light<f32>]) {
        let position = |number: u32| match lights[number as usize].place {
            Place::Point(position) => Some(position),
            Place::Directional(_) => None,
        };
        let mut all = LightBox::EMPTY;
        self.everywhere.clear();
        self.keys.clear();
        for number in 0..lights.len() as u32 {
            match position(number) {
                Some(position) => {
                    all = all.with(&LightBox::at(position));
                    self.keys.push(number.into());
                }
                None => self.everywhere.push(number),
            }
        }
        let cells = [0, 1, 2].map(|k| 1023.0 / (all.high[k] - all.low[k]).max(f32::MIN_POSITIVE));
        for key in &mut self.keys {
            let Some(position) = position(*key as u32) else { continue };
            let cell = |k: usize| u64::from(spread(((position[k] - all.low[k]) * cells[k]) as u32)) << k;
            *key |= (cell(0) | cell(1) | cell(2)) << 32;
        }
        self.keys.sort_unstable();
        self.leaves.clear();
        self.leaves.extend(self.keys.iter().filter_map(|&key| LightLeaf::of(key as u32, lights)));
        self.build_levels();
    }

    /// Takes the places of these lights, which are otherwise those it has, in the same order. What it finds is what it
    /// would find after [`LightTree::rebuild`], and as soon, if they have only been moved or turned together.
    ///
    /// # Panics
    ///
    /// Where there are more or fewer lights than it has.
    pub fn follow(&mut self, lights: &[Light<f32>]) {
        assert_eq!(self.everywhere.len() + self.leaves.len(), lights.len(), "as many lights as before");
        for leaf in &mut self.leaves {
            let (Place::Point(position) | Place::Directional(position)) = lights[leaf.number as usize].place;
            leaf.position = position;
        }
        for height in 0..self.levels.len() {
            let (below, above) = self.levels.split_at_mut(height);
            match below.last() {
                None => {
                    for (node, leaves) in above[0].iter_mut().zip(self.leaves.chunks(LEAF)) {
                        node.around = LightBox::of_leaves(leaves);
                    }
                }
                Some(nodes) => {
                    for (node, nodes) in above[0].iter_mut().zip(nodes.chunks(BRANCHES)) {
                        node.around = LightBox::of_nodes(nodes);
                    }
                }
            }
        }
    }

    fn build_levels(&mut self) {
        let Self { leaves, levels, .. } = self;
        let mut height = 0;
        loop {
            if levels.len() == height {
                levels.push(Vec::new());
            }
            let (below, above) = levels.split_at_mut(height);
            let above = &mut above[0];
            above.clear();
            match below.last() {
                None => above.extend(leaves.chunks(LEAF).map(LightNode::of_leaves)),
                Some(nodes) => above.extend(nodes.chunks(BRANCHES).map(LightNode::of_nodes)),
            }
            height += 1;
            if above.len() <= 1 {
                break;
            }
        }
        levels.truncate(height);
    }

    /// The numbers of the lights that may reach a region, in any order, without some that add no more than `unseen` of
    /// its tolerance together; and what those add at most.
    pub(super) fn find(&self, region: &Region, unseen: f64, numbers: &mut Vec<u32>) -> f64 {
        let quota = unseen * region.tolerance / self.leaves.len().max(1) as f64;
        numbers.extend(&self.everywhere);
        let margin = (COINCIDENT + 4.0 * f32::EPSILON) * region.farthest() * (1.0 + SLACK);
        let search = LightSearch { region, margin, quota };
        let mut spent = 0.0;
        if let Some(top) = self.levels.len().checked_sub(1) {
            self.visit(&search, top, 0..self.levels[top].len(), numbers, &mut spent);
        }
        spent * (1.0 + f64::from(SLACK))
    }

    fn visit(
        &self,
        search: &LightSearch,
        level: usize,
        nodes: core::ops::Range<usize>,
        numbers: &mut Vec<u32>,
        spent: &mut f64,
    ) {
        for (place, node) in nodes.clone().zip(&self.levels[level][nodes]) {
            match search.visit_to(&node.around, &node.falloff, node.count) {
                Visit::Nothing => {}
                Visit::Little(most) => *spent += most,
                Visit::Open if level > 0 => {
                    let start = place * BRANCHES;
                    let below = start..(start + BRANCHES).min(self.levels[level - 1].len());
                    self.visit(search, level - 1, below, numbers, spent);
                }
                Visit::Open => {
                    for leaf in &self.leaves[place * LEAF..place * LEAF + node.count as usize] {
                        match search.visit_to(&LightBox::at(leaf.position), &leaf.falloff, 1) {
                            Visit::Nothing => {}
                            Visit::Little(most) => *spent += most,
                            Visit::Open => numbers.push(leaf.number),
                        }
                    }
                }
            }
        }
    }
}

impl LightLeaf {
    /// `None` for a light without a place.
    fn of(number: u32, lights: &[Light<f32>]) -> Option<Self> {
        let light = &lights[number as usize];
        match light.place {
            Place::Point(position) => Some(Self { number, position, falloff: Falloff::of(light) }),
            Place::Directional(_) => None,
        }
    }
}

impl LightBox {
    const EMPTY: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    fn at(position: [f32; 3]) -> Self {
        Self { low: position, high: position }
    }

    fn of_leaves(leaves: &[LightLeaf]) -> Self {
        leaves.iter().fold(Self::EMPTY, |all, leaf| all.with(&Self::at(leaf.position)))
    }

    fn of_nodes(nodes: &[LightNode]) -> Self {
        nodes.iter().fold(Self::EMPTY, |all, node| all.with(&node.around))
    }

    fn with(self, other: &Self) -> Self {
        // One instruction each, where `min` and `max` take three.
        let [lower, higher] = [|a, b| if b < a { b } else { a }, |a: f32, b| if b > a { b } else { a }];
        Self {
            low: [0, 1, 2].map(|k| lower(self.low[k], other.low[k])),
            high: [0, 1, 2].map(|k| higher(self.high[k], other.high[k])),
        }
    }
}

impl LightNode {
    fn of_leaves(leaves: &[LightLeaf]) -> Self {
        let falloff = Falloff::joined(leaves.iter().map(|leaf| &leaf.falloff));
        Self { around: LightBox::of_leaves(leaves), falloff, count: leaves.len() as u32 }
    }

    fn of_nodes(nodes: &[Self]) -> Self {
        let falloff = Falloff::joined(nodes.iter().map(|node| &node.falloff));
        Self { around: LightBox::of_nodes(nodes), falloff, count: nodes.iter().map(|node| node.count).sum() }
    }
}

/// The ten lowest bits with two zeros between each.
fn spread(bits: u32) -> u32 {
    let bits = (bits | bits << 16) & 0x0300_00ff;
    let bits = (bits | bits << 8) & 0x0300_f00f;
    let bits = (bits | bits << 4) & 0x030c_30c3;
    (bits | bits << 2) & 0x0924_9249
}

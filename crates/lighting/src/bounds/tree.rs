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
/// Made anew for each frame by [`LightTree::rebuild`], in a time that is as good as linear in the lights, or by
/// [`LightTree::rebuild_in_order`], which sorts none; its memory is kept.
#[derive(Clone, Debug, Default)]
pub struct LightTree {
    /// Those that have no place.
    everywhere: Vec<u32>,
    /// Those that have one, in an order in which neighbours are neighbours in space.
    leaves: Vec<LightLeaf>,
    /// Level upon level, the leaves' first; each node of those above has up to eight below it.
    levels: Vec<Vec<LightNode>>,
    /// Where no other is given.
    order: LightOrder,
}

/// An order of lights in which neighbours are neighbours in space; those without a place are not in it.
///
/// Lights that have only been moved or turned together are still neighbours: the order of those that stand still is
/// good for every frame, wherever they are seen from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LightOrder {
    /// Places on a curve, and the numbers of the lights.
    keys: Vec<u64>,
}

impl LightOrder {
    /// Puts these lights in order, in place of those it had.
    pub fn sort(&mut self, lights: &[Light<f32>]) {
        self.keys.clear();
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for (light, number) in lights.iter().zip(0..) {
            if let Place::Point(at) = light.place {
                low = [0, 1, 2].map(|k| low[k].min(at[k]));
                high = [0, 1, 2].map(|k| high[k].max(at[k]));
                self.keys.push(number);
            }
        }
        let cells = [0, 1, 2].map(|k| 1023.0 / (high[k] - low[k]).max(f32::MIN_POSITIVE));
        for key in &mut self.keys {
            let (Place::Point(at) | Place::Directional(at)) = lights[*key as usize].place;
            let cell = |k: usize| u64::from(spread(((at[k] - low[k]) * cells[k]) as u32)) << k;
            *key |= (cell(0) | cell(1) | cell(2)) << 32;
        }
        self.keys.sort_unstable();
    }

    fn numbers(&self) -> impl Iterator<Item = u32> {
        self.keys.iter().map(|&key| key as u32)
    }
}

/// A light, as far as is known without its patch.
#[derive(Clone, Copy, Debug)]
struct LightLeaf {
    number: u32,
    position: [f32; 3],
    falloff: Falloff,
}

/// Lights that lie together.
#[derive(Clone, Copy, Debug)]
struct LightNode {
    /// A box around them.
    low: [f32; 3],
    high: [f32; 3],
    falloff: Falloff,
    count: u32,
}

/// What lights add at a distance at most.
#[derive(Clone, Copy, Debug)]
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

    fn join(&mut self, other: &Self) {
        self.range = self.range.max(other.range);
        self.attenuation = [0, 1, 2].map(|k| self.attenuation[k].min(other.attenuation[k]));
        self.color += other.color;
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
    fn visit_to(&self, low: [f32; 3], high: [f32; 3], falloff: &Falloff, count: u32) -> Visit {
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
        let mut order = core::mem::take(&mut self.order);
        order.sort(lights);
        self.rebuild_in_order(lights, &order);
        self.order = order;
    }

    /// Takes these lights in place of those it had, in the order of the same lights where they were before. What it
    /// finds does not depend on the order, only how soon it finds it.
    ///
    /// # Panics
    ///
    /// Where `order` has more or fewer lights than have a place here, or a number that none of them has.
    pub fn rebuild_in_order(&mut self, lights: &[Light<f32>], order: &LightOrder) {
        let has_place = |light: &Light<f32>| matches!(light.place, Place::Point(_));
        self.everywhere.clear();
        self.everywhere.extend((0..).zip(lights).filter(|(_, light)| !has_place(light)).map(|(number, _)| number));
        self.leaves.clear();
        self.leaves.extend(order.numbers().map(|number| {
            let light = &lights[number as usize];
            let (Place::Point(position) | Place::Directional(position)) = light.place;
            LightLeaf { number, position, falloff: Falloff::of(light) }
        }));
        assert_eq!(self.everywhere.len() + self.leaves.len(), lights.len(), "each light once");
        self.build_levels();
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
            match search.visit_to(node.low, node.high, &node.falloff, node.count) {
                Visit::Nothing => {}
                Visit::Little(most) => *spent += most,
                Visit::Open if level > 0 => {
                    let start = place * BRANCHES;
                    let below = start..(start + BRANCHES).min(self.levels[level - 1].len());
                    self.visit(search, level - 1, below, numbers, spent);
                }
                Visit::Open => {
                    for leaf in &self.leaves[place * LEAF..place * LEAF + node.count as usize] {
                        match search.visit_to(leaf.position, leaf.position, &leaf.falloff, 1) {
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

impl LightNode {
    fn of_leaves(leaves: &[LightLeaf]) -> Self {
        let node = |leaf: &LightLeaf| Self { low: leaf.position, high: leaf.position, falloff: leaf.falloff, count: 1 };
        Self::joined(leaves.iter().map(node))
    }

    fn of_nodes(nodes: &[Self]) -> Self {
        Self::joined(nodes.iter().copied())
    }

    fn joined(mut nodes: impl Iterator<Item = Self>) -> Self {
        let falloff = Falloff { range: 0.0, attenuation: [0.0; 3], color: 0.0 };
        let mut all = nodes.next().unwrap_or(Self { low: [0.0; 3], high: [0.0; 3], falloff, count: 0 });
        for node in nodes {
            all.low = [0, 1, 2].map(|k| all.low[k].min(node.low[k]));
            all.high = [0, 1, 2].map(|k| all.high[k].max(node.high[k]));
            all.falloff.join(&node.falloff);
            all.count += node.count;
        }
        all
    }
}

/// The ten lowest bits with two zeros between each.
fn spread(bits: u32) -> u32 {
    let bits = (bits | bits << 16) & 0x0300_00ff;
    let bits = (bits | bits << 8) & 0x0300_f00f;
    let bits = (bits | bits << 4) & 0x030c_30c3;
    (bits | bits << 2) & 0x0924_9249
}

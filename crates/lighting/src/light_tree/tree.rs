//! A tree of many lights, which finds those whose range reaches a patch.

use super::Selected;
use crate::bounds::Receiver;
use crate::lights::{Light, LightSource};

/// The number of boxes that are tested together.
const WIDTH: usize = 8;

/// Relative margin of ranges: more than the rounding of the boxes.
const SLACK: f32 = 1e-5;

/// Lights in a hierarchy of boxes around what they reach, to find those that reach a patch without visiting the others.
///
/// A light without a range reaches everything. [`LightTree::rebuild`] sorts the others along a curve that fills space,
/// which takes about 35 ns a light; it keeps its memory.
///
/// ```
/// use halfway_lighting::bounds::{LightTree, Patch, Receiver, Selected};
/// use halfway_lighting::equations::{Coefficients, Eye, Light};
/// use halfway_lighting::{Faces, Material, PointLight, Reflectance, Viewer};
///
/// let lamp = PointLight { range: Some(3.0), ..PointLight::white() };
/// let lights: Vec<Light<f32>> = (0..1000u16).map(|i| lamp.at([f32::from(i), 2.0, 0.0])).collect();
/// let mut tree = LightTree::default();
/// tree.rebuild(&lights);
///
/// let patch =
///     Patch { center: [500.0, 0.0, 0.0], radius: 0.5, normals: None, half_thickness: 0.5, faces: Faces::Front };
/// let material = Coefficients::from(&Material::BRASS);
/// let receiver = Receiver::new(&patch, &material, &Eye::in_eye_space(Viewer::Local), Reflectance::BlinnPhong);
/// let mut selected = Selected::default();
/// tree.select(&lights, &receiver, [0.0; 3], &mut selected);
/// assert_eq!(selected.diffuse, [498, 499, 500, 501, 502]);
/// assert!(selected.evaluated < 10);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightTree {
    /// The numbers of the lights that reach everything, ascending.
    everywhere: Vec<u32>,
    /// The other lights in the order of the curve: the place on the curve, above the number.
    keys: Vec<u64>,
    /// Level after level. The first level has a box for each key, and each box of another level holds a block of the
    /// level before.
    blocks: Vec<Block>,
    /// The first block of each level. The last one has one block.
    levels: Vec<usize>,
}

/// A box along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Aabb {
    low: [f32; 3],
    high: [f32; 3],
}

/// Up to eight boxes, side by side so that the compiler tests them together. A lane without a box overlaps none.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Block {
    low: [[f32; WIDTH]; 3],
    high: [[f32; WIDTH]; 3],
}

impl Aabb {
    const EMPTY: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };
    const EVERYTHING: Self = Self { low: [-f32::MAX; 3], high: [f32::MAX; 3] };

    /// The box around a sphere, if it is finite.
    fn around(center: [f32; 3], radius: f32) -> Option<Self> {
        let around = Self { low: center.map(|x| x - radius), high: center.map(|x| x + radius) };
        around.low.iter().chain(&around.high).all(|x| x.is_finite()).then_some(around)
    }

    /// The box around what the range of a light reaches, if it is finite.
    fn reached_by(light: &Light<f32>) -> Option<Self> {
        light.reach().and_then(|(center, range)| Self::around(center, range * (1.0 + SLACK)))
    }

    fn join(self, other: Self) -> Self {
        // One instruction each, where `min` and `max` take three.
        let [lower, higher] = [|a, b| if b < a { b } else { a }, |a: f32, b| if b > a { b } else { a }];
        Self {
            low: [0, 1, 2].map(|k| lower(self.low[k], other.low[k])),
            high: [0, 1, 2].map(|k| higher(self.high[k], other.high[k])),
        }
    }
}

impl Block {
    fn new(boxes: impl Iterator<Item = Aabb>) -> Self {
        let mut block = Self { low: [[f32::INFINITY; WIDTH]; 3], high: [[f32::NEG_INFINITY; WIDTH]; 3] };
        for (lane, Aabb { low, high }) in boxes.enumerate() {
            for k in 0..3 {
                (block.low[k][lane], block.high[k][lane]) = (low[k], high[k]);
            }
        }
        block
    }

    fn joined(&self) -> Aabb {
        let lane = |i| Aabb { low: self.low.map(|x| x[i]), high: self.high.map(|x| x[i]) };
        (0..WIDTH).map(lane).fold(Aabb::EMPTY, Aabb::join)
    }

    fn overlaps(&self, with: &Aabb) -> [bool; WIDTH] {
        let mut overlaps = [true; WIDTH];
        for k in 0..3 {
            for (overlaps, (low, high)) in overlaps.iter_mut().zip(self.low[k].iter().zip(&self.high[k])) {
                *overlaps &= *low <= with.high[k];
                *overlaps &= *high >= with.low[k];
            }
        }
        overlaps
    }
}

impl LightTree {
    /// Replaces the lights of the tree by these.
    pub fn rebuild(&mut self, lights: &[Light<f32>]) {
        let Self { everywhere, keys, blocks, levels } = self;
        everywhere.clear();
        keys.clear();
        let mut all = Aabb::EMPTY;
        for (number, light) in (0..).zip(lights) {
            match Aabb::reached_by(light) {
                Some(reached) => {
                    all = all.join(reached);
                    keys.push(u64::from(number));
                }
                None => everywhere.push(number),
            }
        }
        let light = |key: u64| &lights[key as u32 as usize];
        let cells = [0, 1, 2].map(|k| 1023.0 / (all.high[k] - all.low[k]).max(f32::MIN_POSITIVE));
        for key in keys.iter_mut() {
            let Some((position, _)) = light(*key).reach() else { continue };
            let cell = |k: usize| u64::from(spread(((position[k] - all.low[k]) * cells[k]) as u32)) << k;
            *key |= (cell(0) | cell(1) | cell(2)) << 32;
        }
        keys.sort_unstable();
        blocks.clear();
        blocks.extend(
            keys.chunks(WIDTH).map(|keys| Block::new(keys.iter().filter_map(|&key| Aabb::reached_by(light(key))))),
        );
        levels.clear();
        levels.push(0);
        let mut start = 0;
        while blocks.len() - start > 1 {
            let end = blocks.len();
            for first in (start..end).step_by(WIDTH) {
                let joined = Block::new(blocks[first..end.min(first + WIDTH)].iter().map(Block::joined));
                blocks.push(joined);
            }
            levels.push(end);
            start = end;
        }
    }

    /// Fills `selected` as [`Receiver::select`] does with all of `lights`, the same as given to [`LightTree::rebuild`].
    ///
    /// # Panics
    ///
    /// If there are fewer lights than the tree has.
    pub fn select(
        &self,
        lights: &[Light<f32>],
        receiver: &Receiver<f32>,
        tolerance: [f64; 3],
        selected: &mut Selected,
    ) {
        let mut near = core::mem::take(&mut selected.near);
        near.clear();
        near.extend(&self.everywhere);
        if !self.keys.is_empty() {
            let (center, radius) = receiver.search_sphere();
            let around = Aabb::around(center, radius).unwrap_or(Aabb::EVERYTHING);
            self.find(self.levels.len() - 1, 0, &around, &mut near);
            near.sort_unstable();
        }
        receiver.select(near.iter().map(|&number| (number, &lights[number as usize])), tolerance, selected);
        selected.near = near;
    }

    /// Appends the lights below a block of a level whose boxes overlap `around`.
    fn find(&self, level: usize, block: usize, around: &Aabb, found: &mut Vec<u32>) {
        let overlaps = self.blocks[self.levels[level] + block].overlaps(around);
        for (place, _) in (block * WIDTH..).zip(overlaps).filter(|&(_, overlaps)| overlaps) {
            match level {
                0 => found.push(self.keys[place] as u32),
                _ => self.find(level - 1, place, around, found),
            }
        }
    }
}

/// The ten lowest bits with two zeros between each.
fn spread(bits: u32) -> u32 {
    let bits = (bits | bits << 16) & 0x0300_00ff;
    let bits = (bits | bits << 8) & 0x0300_f00f;
    let bits = (bits | bits << 4) & 0x030c_30c3;
    (bits | bits << 2) & 0x0924_9249
}

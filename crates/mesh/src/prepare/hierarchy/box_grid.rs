//! Boxes, found by place.

use bevy_math::{DVec3, Vec3A};

/// The boxes around triangles or other small things, in the cells of a grid across the two longest sides of the box
/// around all: surfaces are flat, more or less.
pub(super) struct BoxGrid {
    /// The two directions of the grid.
    sides: [GridSide; 2],
    /// Where the boxes of each cell begin; one more at the end.
    starts: Vec<u32>,
    /// By the cells in which their least corners are, each with its number.
    boxes: Vec<(Vec3A, Vec3A, u32)>,
}

/// One direction of a grid.
#[derive(Clone, Copy)]
struct GridSide {
    axis: usize,
    low: f64,
    per_unit: f64,
    cells: usize,
    /// No box is longer than this.
    longest: f64,
}

impl GridSide {
    /// The cell of a coordinate; of one beside the grid, the nearest.
    fn cell(&self, x: f64) -> usize {
        (((x - self.low) * self.per_unit) as usize).min(self.cells - 1)
    }

    /// The first and the last cell that have least corners of boxes that reach into a range.
    fn range(&self, low: f64, high: f64) -> [usize; 2] {
        [self.cell(low - self.longest), self.cell(high)]
    }
}

/// Cells along a side of the grid at most.
const MOST_CELLS: usize = 64;

/// How many boxes a cell has, where they lie evenly.
const BOXES_OF_A_CELL: f64 = 2.0;

impl BoxGrid {
    /// Boxes by their least and greatest corners, which are finite.
    pub(super) fn new(boxes: &[(Vec3A, Vec3A)]) -> Self {
        let nothing = (Vec3A::INFINITY, Vec3A::NEG_INFINITY);
        let (low, high) = boxes.iter().fold(nothing, |all, (low, high)| (all.0.min(*low), all.1.max(*high)));
        let size = high.as_dvec3() - low.as_dvec3();
        let longest = boxes.iter().map(|(low, high)| high.as_dvec3() - low.as_dvec3()).fold(DVec3::ZERO, DVec3::max);
        let left_out = size.min_position();
        let axes = [(left_out + 1) % 3, (left_out + 2) % 3];
        let edge = (size[axes[0]] * size[axes[1]] * BOXES_OF_A_CELL / boxes.len() as f64).sqrt();
        let sides = axes.map(|axis| {
            let cells = ((size[axis] / edge).ceil() as usize).clamp(1, MOST_CELLS);
            let per_unit = if size[axis] > 0.0 { cells as f64 / size[axis] } else { 0.0 };
            // A little more, for what rounding takes off.
            GridSide { axis, low: f64::from(low[axis]), per_unit, cells, longest: longest[axis] * (1.0 + 1e-6) }
        });
        let cell = |(low, _): &(Vec3A, Vec3A)| {
            let [x, y] = sides.map(|side| side.cell(f64::from(low[side.axis])));
            y * sides[0].cells + x
        };
        let cells: Vec<u32> = boxes.iter().map(|of| cell(of) as u32).collect();
        let mut starts = vec![0; sides[0].cells * sides[1].cells + 1];
        for &cell in &cells {
            starts[cell as usize] += 1;
        }
        let mut before = 0;
        for start in &mut starts {
            before += *start;
            *start = before;
        }
        let mut sorted = vec![(Vec3A::ZERO, Vec3A::ZERO, 0); boxes.len()];
        for ((number, &(low, high)), &cell) in boxes.iter().enumerate().zip(&cells).rev() {
            starts[cell as usize] -= 1;
            sorted[starts[cell as usize] as usize] = (low, high, number as u32);
        }
        Self { sides, starts, boxes: sorted }
    }

    /// The numbers of the boxes that meet this one, in any order.
    pub(super) fn meeting(&self, low: DVec3, high: DVec3, mut each: impl FnMut(u32)) {
        let [x, y] = self.sides.map(|side| side.range(low[side.axis], high[side.axis]));
        // The corners of the boxes are of single precision: no less than `low` are those no less than the next such
        // number.
        let (low, high) = (low.map(|x| f64::from(not_less(x))), high.map(|x| f64::from(-not_less(-x))));
        let (low, high) = (low.as_vec3a(), high.as_vec3a());
        for row in (y[0]..=y[1]).map(|y| y * self.sides[0].cells) {
            let of_row = self.starts[row + x[0]] as usize..self.starts[row + x[1] + 1] as usize;
            for (least, most, number) in &self.boxes[of_row] {
                if (least.cmple(high) & most.cmpge(low)).all() {
                    each(*number);
                }
            }
        }
    }
}

/// The least `f32` that is not less.
pub(super) fn not_less(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) < x { near.next_up() } else { near }
}

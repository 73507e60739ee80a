//! The pieces of an instance on the picture: the tiles that they may cover, and whether all of their faces turn away.

use crate::input::pass::{DrawCall, Pass};
use crate::input::pieces::{Piece, PieceExtent};
use halfway_lighting::record::Cull;
use halfway_lighting::record::InstanceRecord;
use halfway_lighting::{DepthSpan, Lens};

/// Pixels along a side of a tile. It is part of the picture's bits: interpolation counts from a tile's corner.
pub(crate) const TILE: usize = 64;

/// An instance's transform, ready to place spheres.
pub(crate) struct PlacedInstance {
    rows: [[f32; 4]; 3],
    /// An upper bound of how much it stretches lengths.
    stretch: f32,
    /// 1 or −1, the side of a face's normal that is culled; 0 if whole pieces cannot be culled.
    left_out: f32,
    lens: Lens,
    /// Surfaces no nearer are behind the near plane, even after rounding.
    inner_near: f32,
    size: [f32; 2],
}

impl PlacedInstance {
    pub(crate) fn new(pass: &Pass, instance: &InstanceRecord, draw: &DrawCall) -> Self {
        let rows = instance.eye_from_model;
        let column = |c: usize| [rows[0][c], rows[1][c], rows[2][c]].map(f64::from);
        let (x, y, z) = (column(0), column(1), column(2));
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let (xx, yy, zz) = (dot(x, x), dot(y, y), dot(z, z));
        let largest = xx.max(yy).max(zz);
        let right = dot(x, y).abs().max(dot(y, z).abs()).max(dot(z, x).abs()) <= 1e-6 * largest;
        let even = right && xx.min(yy).min(zz) >= (1.0 - 1e-5) * largest;
        let stretch = if right { largest * (1.0 + 4e-6) } else { xx + yy + zz };
        let det = dot(x, [y[1] * z[2] - y[2] * z[1], y[2] * z[0] - y[0] * z[2], y[0] * z[1] - y[1] * z[0]]);
        // The transformed normal of a face is that of its front unless its winding is flipped, too.
        let side = if (det < 0.0) == draw.clockwise { 1.0 } else { -1.0 };
        let left_out = match draw.cull {
            Cull::None => 0.0,
            Cull::Back => side,
            Cull::Front => -side,
        };
        Self {
            rows,
            stretch: stretch.sqrt() as f32,
            left_out: if even && largest > 0.0 { left_out } else { 0.0 },
            lens: pass.lens,
            inner_near: inner_near(pass.lens.near),
            size: pass.size.map(|side| side as f32),
        }
    }

    fn place(&self, p: [f32; 3]) -> [f32; 3] {
        self.rows.map(|row| row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3])
    }

    /// Whether all faces of a piece show the culled side.
    pub(crate) fn turns_away(&self, piece: &Piece) -> bool {
        let Some(cone) = piece.cone.filter(|_| self.left_out != 0.0) else { return false };
        let center = self.place(piece.extent.center);
        let axis = self.rows.map(|row| row[0] * cone.axis[0] + row[1] * cone.axis[1] + row[2] * cone.axis[2]);
        let axis = axis.map(|along| along * self.left_out / self.stretch);
        self.lens.hides((center, piece.extent.radius * self.stretch), axis, [cone.cos, cone.sin])
    }

    /// The tiles that points of an extent may be in; `None` if they are outside the picture.
    pub(crate) fn tiles(&self, extent: &PieceExtent) -> Option<TileBox> {
        let [x, y, z] = self.place(extent.center);
        let radius = extent.radius * self.stretch * 1.0001;
        // Along each axis of eye space the smaller of the box and the sphere counts. A flat box needs a margin for the
        // rounding of vertices.
        let reach = self.rows.map(|row| {
            let terms = [0, 1, 2].map(|k| (row[k].abs() * extent.half[k], row[k].abs() * extent.center[k].abs()));
            let of_box = terms[0].0 + terms[1].0 + terms[2].0;
            let rounding = 1e-6 * (terms[0].1 + terms[1].1 + terms[2].1 + row[3].abs());
            radius.min(of_box * 1.0001) + rounding
        });
        let depth = DepthSpan { middle: -z, reach: reach[2], radius };
        if depth.middle + depth.reach < self.lens.near {
            return None;
        }
        let [left, right] = self.lens.span(0, (x, reach[0]), &depth)?;
        let [bottom, top] = self.lens.span(1, (y, reach[1]), &depth)?;
        let (columns, wide) = tiles_of(0.5 + 0.5 * left, 0.5 + 0.5 * right, self.size[0])?;
        let (rows, high) = tiles_of(0.5 - 0.5 * top, 0.5 - 0.5 * bottom, self.size[1])?;
        let tiles = [columns[0], columns[1], rows[0], rows[1]];
        let is_inside = wide && high && depth.middle - depth.reach >= self.inner_near;
        Some(TileBox { tiles, is_inside })
    }
}

fn inner_near(near: f32) -> f32 {
    if near > 0.0 { near * 1.0001 } else { near - near * 1e-4 }
}

/// The position of an extent on the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TileBox {
    /// First and last column, first and last row of tiles.
    pub(crate) tiles: [u16; 4],
    /// All of it is beyond the near plane and inside the picture.
    is_inside: bool,
}

impl TileBox {
    /// Whether all its points lie in neighbouring tiles: then nothing is clipped, and 16 bits hold the offsets from a
    /// tile's center.
    pub(crate) fn is_at_hand(&self) -> bool {
        let [left, right, top, bottom] = self.tiles;
        self.is_inside && right - left <= 1 && bottom - top <= 1
    }

    /// Whether it is at hand and lies in a single tile.
    pub(crate) fn is_in_one(&self) -> bool {
        let [left, right, top, bottom] = self.tiles;
        self.is_inside && left == right && top == bottom
    }
}

/// The tiles from `low` to `high`, given as shares of a side, with a margin of a pixel; and whether all of it is in the
/// picture.
fn tiles_of(low: f32, high: f32, size: f32) -> Option<([u16; 2], bool)> {
    let (low, high) = (low * size - 1.0, high * size + 1.0);
    if low >= size || high < 0.0 {
        return None;
    }
    // NaN reaches everywhere.
    let first = if low > 0.0 { low } else { 0.0 };
    let last = if high < size - 1.0 { high } else { size - 1.0 };
    Some(([first, last].map(|x| (x as u32 / TILE as u32) as u16), low > 0.0 && high < size - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SIZE: [f32; 2] = [1280.0, 720.0];

    fn placed(rows: [[f32; 4]; 3]) -> PlacedInstance {
        seen_by(Lens::perspective([1.0, 16.0 / 9.0], 0.1), rows)
    }

    fn seen_by(lens: Lens, rows: [[f32; 4]; 3]) -> PlacedInstance {
        let column = |k: usize| (0..3).map(|row| f64::from(rows[row][k]).powi(2)).sum::<f64>();
        let stretch = (column(0) + column(1) + column(2)).sqrt() as f32;
        PlacedInstance { rows, stretch, left_out: 0.0, lens, inner_near: inner_near(lens.near), size: SIZE }
    }

    /// The tile of a point, projected as vertices are; `None` if it is before the near plane or outside the picture.
    fn tile_of(placed: &PlacedInstance, point: [f32; 3]) -> Option<[u16; 2]> {
        let [x, y, z] =
            placed.rows.map(|[a, b, c, d]| c.mul_add(point[2], b.mul_add(point[1], a.mul_add(point[0], d))));
        let w = placed.lens.w(-z);
        let [right, up] = placed.lens.center;
        let share = [placed.lens.scale[0] * x / w + right, -placed.lens.scale[1] * y / w - up].map(|at| 0.5 + 0.5 * at);
        let inside = -z >= placed.lens.near && share.iter().all(|at| (0.0..1.0).contains(at));
        inside.then(|| [0, 1].map(|axis| (share[axis] * SIZE[axis]) as u16 / TILE as u16))
    }

    proptest! {
        // Boxes from flat to wide, near and far from the origin of the model, under any transform.
        #[test]
        fn every_visible_triangle_is_in_its_tiles_list(
            middle in prop::array::uniform3(-1.0_f32..1.0),
            away in prop::sample::select(vec![0.0_f32, 1.0, 100.0, 10_000.0]),
            half in prop::array::uniform3(prop::sample::select(vec![0.0_f32, 0.001, 0.1, 2.0])),
            points in prop::collection::vec(prop::array::uniform3(-1.0_f32..=1.0), 3..20),
            rows in prop::array::uniform3(prop::array::uniform3(-1.5_f32..1.5)),
            to in [-4.0_f32..4.0, -3.0..3.0, -9.0..-0.2],
            lens in prop::sample::select(vec![
                Lens::perspective([1.0, 16.0 / 9.0], 0.1),
                Lens::orthographic([0.3, 0.3 * 16.0 / 9.0], [-1.0, 20.0]),
                Lens::orthographic([0.3, 0.3 * 16.0 / 9.0], [2.0, 20.0]),
                Lens::perspective([1.0, 16.0 / 9.0], 0.1).with_center([0.6, -1.3]),
                Lens::orthographic([0.3, 0.3 * 16.0 / 9.0], [2.0, 20.0]).with_center([-0.7, 0.4]),
            ]),
        ) {
            let points = points.into_iter().map(|p| [0, 1, 2].map(|k| away * middle[k] + half[k] * p[k]));
            let points: Vec<[f32; 3]> = points.collect();
            let rows = [0, 1, 2].map(|row: usize| {
                let [a, b, c] = rows[row];
                [a, b, c, to[row] - away * (a * middle[0] + b * middle[1] + c * middle[2])]
            });
            let placed = seen_by(lens, rows);
            let tiles = placed.tiles(&PieceExtent::around(points.iter().copied()));
            let at_hand = tiles.filter(TileBox::is_at_hand);
            for point in points {
                let at = tile_of(&placed, point);
                prop_assert!(at_hand.is_none() || at.is_some(), "{point:?} is out of sight, and at hand by {at_hand:?}");
                let Some([column, row]) = at else { continue };
                let listed = tiles.is_some_and(|TileBox { tiles: [left, right, top, bottom], .. }| {
                    (left..=right).contains(&column) && (top..=bottom).contains(&row)
                });
                prop_assert!(listed, "{point:?} is in {column}, {row}, and {tiles:?} are listed");
            }
        }
    }

    /// Whether a plate at a place, and with a near plane, is at hand.
    #[test]
    fn clipped_and_wide_boxes_are_not_at_hand() {
        let at_hand = |x: f32, z: f32, near: f32| {
            let rows = [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, z]];
            let plate = [[-0.1, -0.1, 0.0], [0.1, -0.1, 0.0], [0.1, 0.1, 0.0], [-0.1, 0.1, 0.0]];
            let placed = seen_by(Lens::perspective([1.0, 16.0 / 9.0], near), rows);
            placed.tiles(&PieceExtent::around(plate.into_iter())).is_some_and(|tiles| tiles.is_at_hand())
        };
        assert!(at_hand(0.3, -4.0, 0.1));
        assert!(!at_hand(3.95, -4.0, 0.1), "part of it is beside the picture");
        assert!(!at_hand(0.3, -4.0, 4.0), "part of it may be before the near plane");
        assert!(!at_hand(0.0, -0.5, 0.1), "it is in more than two columns of tiles");
    }

    /// A plate seen edge-on lies in one column of tiles, and its sphere in many.
    #[test]
    fn boxes_leave_out_tiles_that_spheres_meet() {
        let placed = placed([[1.0, 0.0, 0.0, 0.02], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, -4.0]]);
        let plate = [[0.0, -1.0, -1.0], [0.0, 1.0, -1.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0]];
        let extent = PieceExtent::around(plate.into_iter());
        assert_eq!(placed.tiles(&extent).map(|of| of.tiles), Some([10, 10, 2, 8]));
        let ball = PieceExtent { half: [extent.radius; 3], ..extent };
        assert_eq!(placed.tiles(&ball).map(|TileBox { tiles: [left, right, ..], .. }| right - left), Some(11));
    }
}

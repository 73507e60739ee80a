//! Values of triangles: their normals, or their colors under flat shading.

use crate::input::pass::Pass;
use crate::input::pieces::{PIECE_TRIANGLES, Piece, Pieces};
use crate::lighting::state::{Stage, State};
use crate::lighting::{Points, reflected, tinted, to_viewer};
use crate::simd::lanes::{
    F, MOST_LANES, Simd, V3, add, cross, each, load, max, neg, safe_normalize, scale, splat, sub,
};
use crate::triangles::mapped::FlatParts;
use crate::vertices::lane_triangles::{LaneTriangles, spread};
use crate::vertices::transform::{transformed, turned};
use fearless_simd::prelude::*;
use halfway_lighting::record::InstanceRecord;

/// For each triangle of a piece 0 and its own normal, or 0 and its color if the draw is flat, front and back. The 0 is
/// replaced by the vertices' mean opacity if they have colors.
pub(crate) struct PieceFaces {
    pub(crate) each: [[[f32; 4]; PIECE_TRIANGLES]; 2],
    /// The parts of flat draws with images or a mask.
    pub(crate) parts: FlatParts,
}

impl PieceFaces {
    pub(crate) fn new() -> Self {
        Self { each: [[[0.0; 4]; PIECE_TRIANGLES]; 2], parts: FlatParts::new() }
    }

    /// Fills the own normals of triangles, or their colors if the draw is flat. `fronts` and `backs` are the triangles
    /// that may show that side.
    #[inline(always)]
    pub(crate) fn fill<S: Simd>(
        &mut self,
        simd: S,
        (mesh, piece): (&Pieces, &Piece),
        instance: &InstanceRecord,
        (pass, state): (&Pass, &State),
        [fronts, backs]: [u64; 2],
    ) {
        if state.stage != Stage::Flat {
            let mut left = fronts | backs;
            while left != 0 {
                let these = LaneTriangles::first_of::<S>(&mut left);
                let n = unit_normal(simd, corners(simd, &these, (mesh, piece)), instance);
                for side in &mut self.each {
                    spread::<S>([splat(simd, 0.0), n[0], n[1], n[2]], &these, side);
                }
            }
            return;
        }
        for (back, mut left) in [(false, fronts), (true, if state.backs { backs } else { 0 })] {
            while left != 0 {
                let these = LaneTriangles::first_of::<S>(&mut left);
                self.light(simd, &these, (mesh, piece), instance, (pass, state), back);
            }
        }
    }

    /// The colors of one side of flat triangles.
    #[inline(always)]
    fn light<S: Simd>(
        &mut self,
        simd: S,
        these: &LaneTriangles,
        place: (&Pieces, &Piece),
        instance: &InstanceRecord,
        (pass, state): (&Pass, &State),
        back: bool,
    ) {
        let corners = corners(simd, these, place);
        let n = unit_normal(simd, corners, instance);
        let [a, b, c] = corners;
        let middle = scale::<S>(add::<S>(add::<S>(a, b), c), splat(simd, 1.0 / 3.0));
        let p = transformed(simd, &instance.eye_from_model, middle);
        if state.maps.is_some() {
            spread::<S>([n[0], n[1], n[2], splat(simd, 0.0)], these, &mut self.parts.normals);
        }
        let n = if back { neg::<S>(n) } else { n };
        let points = Points::new(simd, p, n, to_viewer(simd, p, n, pass.local_viewer));
        let terms = state.vertex_terms(simd, pass, &points, back);
        let side = state.side(pass, back);
        let own = state.colored.then(|| mean_color(simd, these, place));
        if state.maps.is_some() {
            self.parts.store(simd, &terms, side, back, own, these);
            return;
        }
        let (color, opacity) = match own {
            Some([r, g, b, opacity]) => (tinted(simd, &terms, side, [r, g, b]), opacity),
            None => (reflected(simd, &terms, side), splat(simd, 0.0)),
        };
        spread::<S>([opacity, color[0], color[1], color[2]], these, &mut self.each[usize::from(back)]);
    }
}

#[inline(always)]
fn corners<S: Simd>(simd: S, these: &LaneTriangles, (mesh, piece): (&Pieces, &Piece)) -> [V3<S>; 3] {
    let mut corners = [[[0.0; MOST_LANES]; 3]; 3];
    for (lane, number) in these.each() {
        let triangle = mesh.triangles[piece.triangles.start as usize + number];
        for k in 0..3 {
            let vertex = piece.first_vertex as usize + usize::from(triangle[k]);
            for axis in 0..3 {
                corners[k][axis][lane] = mesh.positions[axis][vertex];
            }
        }
    }
    each!(k in 3 => each!(axis in 3 => load(simd, &corners[k][axis], 0)))
}

#[inline(always)]
fn unit_normal<S: Simd>(simd: S, corners: [V3<S>; 3], instance: &InstanceRecord) -> V3<S> {
    safe_normalize(simd, turned(simd, &instance.normal, face_normal(simd, corners)))
}

/// The means of the colors of triangles' corners.
#[inline(always)]
fn mean_color<S: Simd>(simd: S, these: &LaneTriangles, (mesh, piece): (&Pieces, &Piece)) -> [F<S>; 4] {
    let mut sums = [[0.0; MOST_LANES]; 4];
    for (lane, number) in these.each() {
        for corner in mesh.triangles[piece.triangles.start as usize + number] {
            for channel in 0..4 {
                sums[channel][lane] += mesh.colors[channel][piece.first_vertex as usize + usize::from(corner)];
            }
        }
    }
    each!(channel in 4 => load(simd, &sums[channel], 0) * splat(simd, 1.0 / 3.0))
}

/// Unit normals of triangles of any size; 0 if a triangle has no area.
#[inline(always)]
fn face_normal<S: Simd>(simd: S, [a, b, c]: [V3<S>; 3]) -> V3<S> {
    let (e, f) = (sub::<S>(b, a), sub::<S>(c, a));
    // Scaled to a size of 1, so that the product neither overflows nor vanishes.
    let mut longest = splat(simd, f32::MIN_POSITIVE);
    for axis in 0..3 {
        longest = max::<S>(max::<S>(e[axis].abs(), f[axis].abs()), longest);
    }
    let size = splat(simd, 1.0) / longest;
    safe_normalize(simd, cross::<S>(scale::<S>(e, size), scale::<S>(f, size)))
}

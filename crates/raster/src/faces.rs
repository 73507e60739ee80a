//! What triangles have of their own, as many at once as there are lanes: their normals, or what flat shading makes of them.

use crate::lanes::{
    F, MOST_LANES, Simd, V3, add, cross, each, load, max, neg, safe_normalize, scale, splat, store_fours, sub,
};
use crate::lighting::{Points, reflected, tinted, to_viewer};
use crate::mapped::FlatParts;
use crate::pass::{InstanceData, Pass};
use crate::pieces::{Piece, Pieces};
use crate::state::{Stage, State};
use crate::vertices::{transformed, turned};
use fearless_simd::prelude::*;

/// Of each lane's triangle 0 and its own normal, or 0 and its color where the draw is flat, front and back. In place of 0
/// stands the vertices' mean opacity where they have colors.
pub(crate) struct LaneFaces {
    pub(crate) each: [[[f32; 4]; MOST_LANES]; 2],
    /// Of flat draws with images or a mask.
    pub(crate) parts: FlatParts,
}

impl LaneFaces {
    pub(crate) fn new() -> Self {
        Self { each: [[[0.0; 4]; MOST_LANES]; 2], parts: FlatParts::new() }
    }

    /// The lanes' triangles' own normals, or their colors where the draw is flat.
    #[inline(always)]
    pub(crate) fn fill<S: Simd>(
        &mut self,
        simd: S,
        triangles: &[[u8; 3]],
        (mesh, piece): (&Pieces, &Piece),
        instance: &InstanceData,
        (pass, state): (&Pass, &State),
        backs: bool,
    ) {
        let mut corners = [[[0.0; MOST_LANES]; 3]; 3];
        for (lane, triangle) in triangles.iter().enumerate() {
            for k in 0..3 {
                let vertex = piece.first_vertex as usize + usize::from(triangle[k]);
                for axis in 0..3 {
                    corners[k][axis][lane] = mesh.positions[axis][vertex];
                }
            }
        }
        let corners = each!(k in 3 => each!(axis in 3 => load(simd, &corners[k][axis], 0)));
        let n = safe_normalize(simd, turned(simd, &instance.normal, face_normal(simd, corners)));
        if state.stage != Stage::Flat {
            self.store(simd, 0, n, splat(simd, 0.0));
            self.store(simd, 1, n, splat(simd, 0.0));
            return;
        }
        if state.maps.is_some() {
            store_fours::<S>([n[0], n[1], n[2], splat(simd, 0.0)], &mut self.parts.normals, 0);
        }
        let [a, b, c] = corners;
        let middle = scale::<S>(add::<S>(add::<S>(a, b), c), splat(simd, 1.0 / 3.0));
        let p = transformed(simd, &instance.eye_from_model, middle);
        let own = if state.colored { mean_color(simd, triangles, (mesh, piece)) } else { [splat(simd, 0.0); 4] };
        for back in [false, true] {
            if back && !(backs && state.backs) {
                break;
            }
            let n = if back { neg::<S>(n) } else { n };
            let points = Points::new(simd, p, n, to_viewer(simd, p, n, pass.local_viewer));
            let terms = state.vertex_terms(simd, pass, &points, back);
            let side = state.side(pass, back);
            let [r, g, b, opacity] = own;
            if state.maps.is_some() {
                self.parts.store(simd, &terms, side, back, state.colored.then_some(own));
                continue;
            }
            let color =
                if state.colored { tinted(simd, &terms, side, [r, g, b]) } else { reflected(simd, &terms, side) };
            self.store(simd, usize::from(back), color, opacity);
        }
    }

    #[inline(always)]
    fn store<S: Simd>(&mut self, _: S, side: usize, v: V3<S>, first: F<S>) {
        store_fours::<S>([first, v[0], v[1], v[2]], &mut self.each[side], 0);
    }
}

/// The means of the colors of triangles' corners.
#[inline(always)]
fn mean_color<S: Simd>(simd: S, triangles: &[[u8; 3]], (mesh, piece): (&Pieces, &Piece)) -> [F<S>; 4] {
    let mut sums = [[0.0; MOST_LANES]; 4];
    for (lane, triangle) in triangles.iter().enumerate() {
        for corner in triangle {
            for channel in 0..4 {
                sums[channel][lane] += mesh.colors[channel][piece.first_vertex as usize + usize::from(*corner)];
            }
        }
    }
    each!(channel in 4 => load(simd, &sums[channel], 0) * splat(simd, 1.0 / 3.0))
}

/// Unit normals of triangles of any size; 0 where they have none.
#[inline(always)]
fn face_normal<S: Simd>(simd: S, [a, b, c]: [V3<S>; 3]) -> V3<S> {
    let (e, f) = (sub::<S>(b, a), sub::<S>(c, a));
    // Brought to a size of 1, so that the product neither overflows nor vanishes.
    let mut longest = splat(simd, f32::MIN_POSITIVE);
    for axis in 0..3 {
        longest = max::<S>(max::<S>(e[axis].abs(), f[axis].abs()), longest);
    }
    let size = splat(simd, 1.0) / longest;
    safe_normalize(simd, cross::<S>(scale::<S>(e, size), scale::<S>(f, size)))
}

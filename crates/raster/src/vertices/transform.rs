//! A piece's vertices: transformed, lit where the draw lights vertices, and put onto the picture's grid.

use crate::input::attributes::{Attributes, MappedVertices, SLOTS};
use crate::input::pass::Pass;
use crate::input::pieces::{Piece, Pieces};
use crate::lighting::state::{Stage, State};
use crate::lighting::{Points, reflected, tinted, tinted_terms, to_viewer};
use crate::simd::lanes::{
    F, I, MOST_LANES, Simd, V3, each, fma, lanes, load, load3, max, min, safe_normalize, splat, splat_i, store,
    store_fours, store_i,
};
use crate::vertices::placed::TILE;
use crate::vertices::screen::Screen;
use fearless_simd::prelude::*;
use halfway_lighting::record::InstanceRecord;

/// Steps of the grid in a pixel.
pub(crate) const GRID: i32 = 256;
/// The longest side of a triangle's box on the grid for which 32-bit arithmetic cannot overflow.
pub(crate) const SMALL: i32 = 64 * GRID;
/// The lower limit of picture coordinates, in pixels. The limits are 2¹⁵ apart, so that edges fit into the arithmetic
/// of coverage.
pub(crate) const SCREEN_LOW: f32 = -8190.0;
/// The upper limit.
pub(crate) const SCREEN_HIGH: f32 = 24_574.0;

/// Reasons to clip the triangles of a vertex.
pub(crate) const CLIPPED: i32 = 0b1_1111;
/// It is nearer than the near plane, or behind the eye.
pub(crate) const TOO_NEAR: i32 = 1;
/// It is too far from the tile for 16 bits; [`Vertices::places`] holds a nearer point on the same side.
pub(crate) const FAR_AWAY: i32 = 0b10_0000;

/// The position of a piece relative to a tile.
pub(crate) enum PlacedPiece {
    /// It covers no pixel of the tile.
    Beside,
    /// It may cover some.
    Anywhere,
    /// It is small: the first and last column and row of pixels of the tile that it may cover, and its greatest nearness.
    Box { first: [usize; 2], last: [usize; 2], nearest: f32 },
}

/// Whether the places of vertices are in a list for each axis: the widest vectors gather them by shuffles, and others
/// copy pairs.
#[inline(always)]
pub(crate) const fn places_by_axis<S: Simd>() -> bool {
    lanes::<S>() == MOST_LANES
}

/// A number a vertex.
type List = [f32; SLOTS];

/// The transformed vertices of a piece.
pub(crate) struct Vertices {
    pub(crate) eye: [List; 3],
    /// In pixels.
    pub(crate) screen: [List; 2],
    pub(crate) inverse_w: List,
    pub(crate) nearness: List,
    /// In steps of the grid.
    pub(crate) grid: [[i32; SLOTS]; 2],
    /// x and y from the tile's center, in 65,536ths of a step of the grid: rounded to whole steps they are `grid`. They
    /// are pairs, or all x and then all y: see [`places_by_axis`].
    pub(crate) places: [[i32; 2]; SLOTS],
    pub(crate) codes: [i32; SLOTS],
    /// All codes together.
    pub(crate) any_code: i32,
    /// Normal, color of the front, color of the back; in painted draws the vertex color, opacity first.
    pub(crate) raw: [List; 13],
    /// The nearness and the first three interpolated numbers over w, of front and back.
    pub(crate) lead: [Box<Attributes>; 2],
    /// Whether the leading numbers are colors, which differ between the sides.
    pub(crate) sides_lead: bool,
    /// An unused number and three more of them.
    pub(crate) second: [Box<Attributes>; 2],
    /// Of colored draws the opacity and the color, over w.
    pub(crate) paint: Box<Attributes>,
    /// The numbers of draws with images or a mask.
    pub(crate) mapped: MappedVertices,
}

impl Vertices {
    pub(crate) fn new() -> Self {
        let none = || Box::new([[0.0; 4]; SLOTS]);
        Self {
            eye: [[0.0; SLOTS]; 3],
            screen: [[0.0; SLOTS]; 2],
            inverse_w: [0.0; SLOTS],
            nearness: [0.0; SLOTS],
            grid: [[0; SLOTS]; 2],
            places: [[0; 2]; SLOTS],
            codes: [0; SLOTS],
            any_code: 0,
            raw: [[0.0; SLOTS]; 13],
            lead: [none(), none()],
            sides_lead: false,
            second: [none(), none()],
            paint: none(),
            mapped: MappedVertices::new(),
        }
    }

    /// Fills the inputs of shading for the groups of vertices that visible triangles use: bit k is the k-th vector of
    /// vertices.
    #[inline(always)]
    pub(crate) fn light<S: Simd>(
        &mut self,
        simd: S,
        (mesh, piece): (&Pieces, &Piece),
        instance: &InstanceRecord,
        (pass, state): (&Pass, &State),
        groups: u32,
    ) {
        self.sides_lead = state.stage == Stage::Vertex && state.maps.is_none();
        if state.maps.is_some() {
            self.fill_mapped(simd, (mesh, piece), instance, (pass, state), groups);
        }
        let lit = state.maps.is_none() && matches!(state.stage, Stage::Vertex | Stage::Fragment | Stage::Mixed);
        for at in places_of::<S>(groups) {
            let first = piece.first_vertex as usize + at;
            if state.paints() {
                let color = each!(k in 4 => load(simd, &mesh.colors[k], first));
                for k in 0..4 {
                    store::<S>(color[(k + 3) % 4], &mut self.raw[9 + k], at);
                }
                let i = load(simd, &self.inverse_w, at);
                store_fours::<S>(each!(k in 4 => color[(k + 3) % 4] * i), &mut self.paint[..], at);
            }
            if lit {
                let n = safe_normalize(simd, turned(simd, &instance.normal, load3(simd, &mesh.normals, first)));
                self.shade(simd, at, load3(simd, &self.eye, at), n, pass, state);
            }
            self.gather(simd, at, state);
        }
    }

    /// Projects a piece's vertices onto the picture; returns its position. `at_hand` means that none is clipped or far
    /// from the tile (see [`TileBox::is_at_hand`](crate::vertices::placed::TileBox::is_at_hand)); `boxed` requests the box of
    /// small pieces.
    #[inline(always)]
    pub(crate) fn place<S: Simd>(
        &mut self,
        simd: S,
        (mesh, piece): (&Pieces, &Piece),
        instance: &InstanceRecord,
        (screen, tile): (&Screen, [u32; 2]),
        (at_hand, boxed): (bool, bool),
    ) -> PlacedPiece {
        if at_hand {
            self.place_all::<S, true>(simd, (mesh, piece), instance, (screen, tile), boxed)
        } else {
            self.place_all::<S, false>(simd, (mesh, piece), instance, (screen, tile), boxed)
        }
    }

    #[inline(always)]
    fn place_all<S: Simd, const AT_HAND: bool>(
        &mut self,
        simd: S,
        (mesh, piece): (&Pieces, &Piece),
        instance: &InstanceRecord,
        (screen, tile): (&Screen, [u32; 2]),
        boxed: bool,
    ) -> PlacedPiece {
        let center = tile.map(|place| (place as i32 * TILE as i32 + TILE as i32 / 2) * GRID);
        let mut any_code = splat_i(simd, 0);
        let (mut low, mut high) = ([splat_i(simd, i32::MAX); 2], [splat_i(simd, i32::MIN); 2]);
        let mut nearest = splat(simd, 0.0);
        for at in (0..piece.vertex_count as usize).step_by(lanes::<S>()) {
            let p = load3(simd, &mesh.positions, piece.first_vertex as usize + at);
            let p = transformed(simd, &instance.eye_from_model, p);
            let (code, grid, nearness) = self.project::<S, AT_HAND>(simd, at, p, screen, center);
            any_code |= code;
            nearest = max::<S>(nearness, nearest);
            for axis in 0..2 {
                low[axis] = SimdBase::min(low[axis], grid[axis]);
                high[axis] = SimdBase::max(high[axis], grid[axis]);
            }
        }
        self.any_code = if AT_HAND { 0 } else { any_code.as_slice().iter().fold(0, |all, code| all | code) };
        // Clipped triangles may lie anywhere.
        if self.any_code & CLIPPED != 0 {
            return PlacedPiece::Anywhere;
        }
        let (low, high) = (each!(axis in 2 => low[axis].reduce_min()), each!(axis in 2 => high[axis].reduce_max()));
        for axis in 0..2 {
            let [first, last] = each!(end in 2 => center[axis] + (end as i32 * TILE as i32 - TILE as i32 / 2) * GRID);
            if high[axis] < first || low[axis] > last {
                return PlacedPiece::Beside;
            }
        }
        if !boxed || self.any_code != 0 {
            return PlacedPiece::Anywhere;
        }
        // The depths of larger triangles may exceed those of their corners by rounding.
        if (high[0] - low[0]).max(high[1] - low[1]) > SMALL {
            return PlacedPiece::Anywhere;
        }
        let place = |grid: i32, axis: usize| (grid >> 8) - (tile[axis] as i32 * TILE as i32);
        PlacedPiece::Box {
            first: each!(axis in 2 => place(low[axis], axis).max(0) as usize),
            last: each!(axis in 2 => place(high[axis], axis).min(TILE as i32 - 1) as usize),
            nearest: nearest.reduce_max(),
        }
    }

    /// Stores the place on the screen; returns the codes, the place on the grid, and the nearness.
    #[inline(always)]
    fn project<S: Simd, const AT_HAND: bool>(
        &mut self,
        simd: S,
        at: usize,
        p: V3<S>,
        screen: &Screen,
        center: [i32; 2],
    ) -> (I<S>, [I<S>; 2], F<S>) {
        let depth = -p[2];
        let zero = splat_i(simd, 0);
        let in_front = depth.simd_ge(splat(simd, screen.lens.near));
        let shown = if AT_HAND { depth } else { in_front.select(depth, splat(simd, 1.0)) };
        let inverse_w = screen.inverse_w(simd, shown);
        let nearness = screen.nearness(simd, shown, inverse_w);
        let mut code = if AT_HAND { zero } else { in_front.select(zero, splat_i(simd, TOO_NEAR)) };
        let (mut relative, mut on_grid) = ([zero; 2], [zero; 2]);
        for axis in 0..2 {
            let x = fma::<S>(p[axis] * inverse_w, splat(simd, screen.scale[axis]), splat(simd, screen.center[axis]));
            let mut inside = x;
            if !AT_HAND {
                let (low, high) = (splat(simd, SCREEN_LOW), splat(simd, SCREEN_HIGH));
                // NaN is beyond both ends.
                code |= x.simd_ge(low).select(zero, splat_i(simd, 2 << (2 * axis)));
                code |= x.simd_le(high).select(zero, splat_i(simd, 4 << (2 * axis)));
                inside = min::<S>(max::<S>(x, low), high);
            }
            let steps = inside * splat(simd, GRID as f32);
            let whole = steps.round_ties_even();
            let grid: I<S> = whole.to_int();
            // Less than half a step, so that rounding gives the whole steps again.
            let part = min::<S>((steps - whole) * splat(simd, 65_536.0), splat(simd, 32_767.0));
            let from_center = grid - splat_i(simd, center[axis]);
            let mut near = from_center;
            if !AT_HAND {
                near = SimdBase::max(SimdBase::min(from_center, splat_i(simd, 32_766)), splat_i(simd, -32_767));
                code |= near.simd_eq(from_center).select(zero, splat_i(simd, FAR_AWAY));
            }
            relative[axis] = (near << 16) + part.round_ties_even().to_int::<I<S>>();
            store::<S>(inside, &mut self.screen[axis], at);
            store_i::<S>(grid, &mut self.grid[axis], at);
            on_grid[axis] = grid;
        }
        for axis in 0..3 {
            store::<S>(p[axis], &mut self.eye[axis], at);
        }
        store::<S>(inverse_w, &mut self.inverse_w, at);
        store::<S>(nearness, &mut self.nearness, at);
        let places = self.places.as_flattened_mut();
        if places_by_axis::<S>() {
            store_i::<S>(relative[0], places, at);
            store_i::<S>(relative[1], places, SLOTS + at);
        } else {
            let (low, high) = relative[0].interleave(relative[1]);
            store_i::<S>(low, places, 2 * at);
            store_i::<S>(high, places, 2 * at + lanes::<S>());
        }
        if !AT_HAND {
            store_i::<S>(code, &mut self.codes, at);
        }
        (code, on_grid, nearness)
    }

    #[inline(always)]
    fn shade<S: Simd>(&mut self, simd: S, at: usize, p: V3<S>, n: V3<S>, pass: &Pass, state: &State) {
        if state.stage != Stage::Vertex {
            for axis in 0..3 {
                store::<S>(n[axis], &mut self.raw[axis], at);
            }
        }
        if state.stage == Stage::Fragment {
            return;
        }
        for back in [false, true] {
            if back && !state.backs {
                break;
            }
            let n = if back { crate::simd::lanes::neg::<S>(n) } else { n };
            let points = Points::new(simd, p, n, to_viewer(simd, p, n, pass.local_viewer));
            let terms = state.vertex_terms(simd, pass, &points, back);
            let side = state.side(pass, back);
            let color = if state.colored {
                let own = each!(k in 3 => load(simd, &self.raw[10 + k], at));
                // Fragments add the base themselves.
                let shade = if state.stage == Stage::Vertex { tinted } else { tinted_terms };
                shade(simd, &terms, side, own)
            } else {
                reflected(simd, &terms, side)
            };
            for c in 0..3 {
                store::<S>(color[c], &mut self.raw[3 + 3 * usize::from(back) + c], at);
            }
        }
    }

    /// Interleaves each vertex's numbers.
    #[inline(always)]
    fn gather<S: Simd>(&mut self, simd: S, at: usize, state: &State) {
        let Self { raw, inverse_w, nearness, lead: [lead, lead_of_backs], second: [second, second_of_backs], .. } =
            self;
        let i = (load(simd, nearness, at), load(simd, inverse_w, at));
        let normal = each!(k in 3 => &raw[k]);
        let front = each!(k in 3 => &raw[3 + k]);
        let back = each!(k in 3 => &raw[6 + k]);
        match state.stage {
            _ if state.maps.is_some() => over_w_alone(simd, i, lead, at),
            Stage::Unlit | Stage::Flat => over_w_alone(simd, i, lead, at),
            Stage::Fragment => over_w(simd, i, normal, lead, at),
            Stage::Vertex => {
                over_w(simd, i, front, lead, at);
                if state.backs {
                    over_w(simd, i, back, lead_of_backs, at);
                }
            }
            Stage::Mixed => {
                over_w(simd, i, normal, lead, at);
                over_w(simd, i, front, second, at);
                if state.backs {
                    over_w(simd, i, back, second_of_backs, at);
                }
            }
        }
    }
}

/// The first vertices of groups.
#[inline(always)]
pub(crate) fn places_of<S: Simd>(groups: u32) -> impl Iterator<Item = usize> {
    let mut left = groups;
    std::iter::from_fn(move || {
        let group = left.trailing_zeros() as usize;
        (left != 0).then(|| {
            left &= left - 1;
            group * lanes::<S>()
        })
    })
}

#[inline(always)]
fn over_w_alone<S: Simd>(simd: S, (nearness, _): (F<S>, F<S>), to: &mut Attributes, at: usize) {
    let zero = splat(simd, 0.0);
    store_fours::<S>([nearness, zero, zero, zero], to, at);
}

#[inline(always)]
fn over_w<S: Simd>(simd: S, (nearness, inverse_w): (F<S>, F<S>), raw: [&List; 3], to: &mut Attributes, at: usize) {
    let [a, b, c] = each!(k in 3 => load(simd, raw[k], at) * inverse_w);
    store_fours::<S>([nearness, a, b, c], to, at);
}

/// Points transformed by rows.
#[inline(always)]
pub(crate) fn transformed<S: Simd>(simd: S, rows: &[[f32; 4]; 3], p: V3<S>) -> V3<S> {
    each!(axis in 3 => {
        let [a, b, c, d] = each!(k in 4 => splat(simd, rows[axis][k]));
        fma::<S>(c, p[2], fma::<S>(b, p[1], fma::<S>(a, p[0], d)))
    })
}

/// Directions transformed by columns.
#[inline(always)]
pub(crate) fn turned<S: Simd>(simd: S, columns: &[[f32; 3]; 3], n: V3<S>) -> V3<S> {
    each!(axis in 3 => {
        let [a, b, c] = each!(k in 3 => splat(simd, columns[k][axis]));
        fma::<S>(c, n[2], fma::<S>(b, n[1], a * n[0]))
    })
}

//! Draws a tile, from its pieces to its pixels.

use crate::input::pass::{DrawCall, Pass, PixelFormat};
use crate::input::pieces::{PIECE_TRIANGLES, Piece, Pieces};
use crate::lighting::state::{Stage, State};
use crate::pixels::clip::{Ready, each_part};
use crate::pixels::cover::{EdgeFunctions, Kept, TileBuffer};
use crate::pixels::look::Look;
use crate::shading::encode::{bytes, cleared, kept};
use crate::shading::shade::{Even, shader_of};
use crate::shading::surroundings::behind;
use crate::simd::lanes::{I, LEAST_LANES, MOST_LANES, Simd, V3, each, f32x4, lanes, max_one, min_one};
use crate::tiles::bands::{Bands, Own, Rows, make_room};
use crate::tiles::bins::{Bins, Job};
use crate::triangles::faces::PieceFaces;
use crate::triangles::mapped::MappedTriangle;
use crate::triangles::planes::{LaneSlopes, Planes, Slopes};
use crate::triangles::setup::{Batch, Corners, Covering};
use crate::vertices::placed::TILE;
use crate::vertices::screen::Screen;
use crate::vertices::transform::{PlacedPiece, Vertices};
use fearless_simd::prelude::*;
use halfway_lighting::Samples;
use halfway_lighting::record::InstanceRecord;

/// Draws tiles, one after the other, in memory of its own.
pub(crate) struct Worker {
    vertices: Vertices,
    corners: Corners,
    /// The triangles of a piece, in batches of one vector.
    batches: Box<[Batch; PIECE_TRIANGLES / LEAST_LANES]>,
    faces: PieceFaces,
    nearest: TileBuffer,
    /// Memory for the tile's pixels.
    own: Own,
}

/// The shared data of a frame's tiles.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub(crate) pass: &'a Pass<'a>,
    pub(crate) bins: &'a Bins,
    pub(crate) screen: &'a Screen,
}

/// A job with its draw, instance and piece.
#[derive(Clone, Copy)]
struct Work<'a> {
    job: Job,
    mesh: &'a Pieces,
    piece: &'a Piece,
    instance: &'a InstanceRecord,
    state: &'a State,
    covering: Covering,
    /// Something was drawn before it in the tile, with one sample a pixel, which may hide it.
    behind: bool,
    blend: bool,
}

impl Worker {
    pub(crate) fn new() -> Self {
        Self {
            vertices: Vertices::new(),
            corners: Corners::new(),
            batches: Box::default(),
            faces: PieceFaces::new(),
            nearest: TileBuffer::new(),
            own: Own::default(),
        }
    }

    /// Draws a tile into its place in the picture.
    pub(crate) fn draw<S: Simd>(&mut self, simd: S, scene: &Scene, tile: [u32; 2], bands: &Bands) {
        let Scene { pass, bins, screen } = *scene;
        let mut look = Look { pass, states: &bins.states, screen, painted: false, tile };
        let last = [0, 1].map(|axis| (pass.size[axis] - tile[axis] * TILE as u32).min(TILE as u32) as i32 - 1);
        let mut jobs = bins.of_tile(tile[0], tile[1]).peekable();
        let is_clear = jobs.peek().is_none();
        let was_clear = bands.set_clear(tile, is_clear && !pass.shows_sky());
        if is_clear {
            // A sky may have come.
            if !was_clear || pass.shows_sky() {
                bands.fill(tile, &mut self.own, |rows| {
                    simd.vectorize(
                        #[inline(always)]
                        || fill_with_clear(simd, &look, last[1], rows),
                    );
                });
            }
            return;
        }
        self.nearest.clear();
        let mut shaded = false;
        let first = jobs.peek().map(|&number| bins.jobs[number as usize]);
        for number in jobs {
            let blend = number >= bins.first_blended;
            if blend && !shaded {
                self.shade(simd, &look, last[1]);
                shaded = true;
            }
            let work = Work::new(scene, number, last, (first, blend));
            look.painted |= work.state.shades_apart();
            let shows = simd.vectorize(
                #[inline(always)]
                || {
                    let place = (work.mesh, work.piece);
                    match self.vertices.place(
                        simd,
                        place,
                        work.instance,
                        (screen, tile),
                        (work.job.at_hand, work.behind),
                    ) {
                        PlacedPiece::Beside => false,
                        PlacedPiece::Anywhere => true,
                        PlacedPiece::Box { first, last, nearest } => !self.nearest.hides(simd, first, last, nearest),
                    }
                },
            );
            if shows {
                simd.vectorize(
                    #[inline(always)]
                    || self.triangles(simd, &look, &work),
                );
            }
        }
        let Self { nearest, own, .. } = self;
        bands.fill(tile, own, |rows| {
            simd.vectorize(
                #[inline(always)]
                || {
                    if shaded {
                        encode(simd, nearest, pass, last[1], rows);
                    } else if pass.samples == Samples::One {
                        shade_and_encode(simd, nearest, &look, last[1], rows);
                    } else {
                        shade_and_encode_four(simd, nearest, &look, last[1], rows);
                    }
                },
            );
        });
    }

    fn shade<S: Simd>(&mut self, simd: S, look: &Look, last_row: i32) {
        simd.vectorize(
            #[inline(always)]
            || self.nearest.shade(simd, look, last_row as usize + 1),
        );
    }

    /// Draws a piece's triangles. Vertices without a visible triangle are not lit.
    #[inline(always)]
    fn triangles<S: Simd>(&mut self, simd: S, look: &Look, work: &Work) {
        let range = work.piece.triangles.start as usize..work.piece.triangles.end as usize;
        let triangles = &work.mesh.triangles[range];
        let (shown, [fronts, backs]) = self.find_shown(simd, work, triangles);
        // Triangles and vertices are lit only if they may be visible.
        let lit_before = matches!(work.state.stage, Stage::Flat | Stage::Vertex);
        let shown = if lit_before && work.behind { self.not_hidden::<S>(triangles, shown) } else { shown };
        if shown == 0 {
            return;
        }
        let (place, state) = ((work.mesh, work.piece), (look.pass, work.state));
        if work.state.stage == Stage::Flat || work.state.opposite_normals {
            self.faces.fill(simd, place, work.instance, state, [fronts & shown, backs & shown]);
        }
        // Where the lights of vertices are summed, only those are lit that triangles need.
        let groups = if matches!(work.state.stage, Stage::Vertex | Stage::Mixed) || work.state.maps.is_some() {
            groups_of::<S>(triangles, shown)
        } else {
            (1 << (work.piece.vertex_count as usize).div_ceil(lanes::<S>())) - 1
        };
        self.vertices.light(simd, place, work.instance, state, groups);
        let one = work.covering.is_plain && work.covering.samples == Samples::One;
        // In their order, which matters for blended and coincident surfaces.
        let mut left = shown;
        while left != 0 {
            let number = left.trailing_zeros() as usize % PIECE_TRIANGLES;
            left &= left - 1;
            let (batch, bit) = (&self.batches[number / lanes::<S>()], 1 << (number % lanes::<S>()));
            let (tiny, small) = (batch.tiny & bit != 0, batch.small & bit != 0);
            if tiny || one && small {
                self.plain(simd, work, triangles[number], number, tiny);
            } else if small {
                self.small(simd, look, work, triangles[number], number);
            } else {
                self.other(simd, look, work, triangles[number], number);
            }
        }
    }

    /// Finds the triangles of a piece that may be visible, and those that may show their fronts and backs.
    #[inline(always)]
    fn find_shown<S: Simd>(&mut self, simd: S, work: &Work, triangles: &[[u8; 3]]) -> (u64, [u64; 2]) {
        let (first, vertex_count) = (work.piece.triangles.start as usize, work.piece.vertex_count as usize);
        self.corners.fill(simd, (&work.mesh.triangles[first..], triangles.len()), &self.vertices, vertex_count);
        let (mut shown, mut fronts, mut backs) = (0, 0, 0);
        for (at, batch) in (0..triangles.len()).step_by(lanes::<S>()).zip(&mut *self.batches) {
            batch.fill(simd, &self.corners, at, (triangles.len() - at).min(lanes::<S>()), &work.covering);
            let here = batch.tiny | batch.small | batch.others;
            shown |= here << at;
            // The visible side of the others is not known yet.
            fronts |= (here & !batch.backs | batch.others) << at;
            backs |= (here & batch.backs | batch.others) << at;
        }
        (shown, [fronts, backs])
    }

    /// Removes tiny triangles that are behind drawn surfaces.
    #[inline(always)]
    fn not_hidden<S: Simd>(&self, triangles: &[[u8; 3]], mut shown: u64) -> u64 {
        for (at, batch) in (0..triangles.len()).step_by(lanes::<S>()).zip(&*self.batches) {
            let mut left = batch.tiny;
            while left != 0 {
                let lane = left.trailing_zeros() as usize % MOST_LANES;
                left &= left - 1;
                let [a, b, c] = triangles[at + lane].map(|corner| self.vertices.nearness[usize::from(corner)]);
                let first = [batch.bounds[0][lane], batch.bounds[2][lane]];
                if self.nearest.hides_tiny((batch.pixels[lane], first), max_one(max_one(a, b), c)) {
                    shown &= !(1 << (at + lane));
                }
            }
        }
        shown
    }

    /// Draws a triangle that is large, or has to be clipped.
    fn other<S: Simd>(&mut self, simd: S, look: &Look, work: &Work, triangle: [u8; 3], number: usize) {
        let (faces, nearest, vertices) = (&self.faces, &mut self.nearest, &self.vertices);
        let place = (look.tile, &work.covering);
        each_part(vertices, triangle, look.screen, place, |mut ready| {
            let back = ready.back;
            ready.planes.set_face(&faces.each[usize::from(back)][number], work.state, &look.pass.lens);
            if work.state.maps.is_some() {
                let [left, _, top, _] = ready.edges.bounds;
                let mut mapped = MappedTriangle::large(
                    vertices,
                    (triangle, back),
                    (work.state, &ready.planes),
                    ([left, top], &ready.gradient),
                    &ready.corners,
                );
                faces.parts.set((&mut mapped, work.state), back, number);
                nearest.mapped_triangles.push(mapped);
            }
            let Ready { edges, planes, .. } = ready;
            simd.vectorize(
                #[inline(always)]
                || draw(simd, nearest, &edges, &planes, back, look, work),
            );
        });
    }

    /// Draws a tiny triangle that covers a pixel, or a larger one with one sample a pixel, that stores only its depth
    /// and the leading numbers.
    #[inline(always)]
    fn plain<S: Simd>(&mut self, simd: S, work: &Work, triangle: [u8; 3], number: usize, tiny: bool) {
        let (batch, lane) = (&self.batches[number / lanes::<S>()], number % lanes::<S>());
        let back = batch.backs >> lane & 1 != 0;
        let numbers = each!(k in 3 => usize::from(triangle[k]));
        let lead = &self.vertices.lead[usize::from(back && self.vertices.sides_lead)];
        let corners = each!(k in 3 => &lead[numbers[k]]);
        let mut slopes = batch.slopes(simd, lane, corners);
        if work.state.stage == Stage::Flat {
            slopes.base += f32x4::load_array_ref(simd, &self.faces.each[usize::from(back)][number]);
        }
        let (shader, keeps_lead) = (shader_of(work.job.state, back), work.state.stage != Stage::Unlit);
        if !tiny {
            self.nearest.cover_small(simd, (batch, lane), &slopes, range(corners), shader, keeps_lead);
            return;
        }
        let first = [batch.bounds[0][lane], batch.bounds[2][lane]];
        let place = (batch.pixels[lane], batch.samples[lane], first);
        let to = (&mut self.nearest, work.covering.samples);
        cover_tiny(simd, to, place, &slopes, range(corners), shader, keeps_lead);
    }

    /// Draws one that stores more.
    fn small<S: Simd>(&mut self, simd: S, look: &Look, work: &Work, triangle: [u8; 3], number: usize) {
        simd.vectorize(
            #[inline(always)]
            || {
                let (batch, lane) = (&self.batches[number / lanes::<S>()], number % lanes::<S>());
                let back = batch.backs >> lane & 1 != 0;
                let numbers = each!(k in 3 => usize::from(triangle[k]));
                let v = &self.vertices;
                let lead = &v.lead[usize::from(back && v.sides_lead)];
                let corners = each!(k in 3 => &lead[numbers[k]]);
                let mut planes = Planes {
                    lead: Slopes::of_lane(&batch.slopes(simd, lane, corners)),
                    range: range(corners),
                    depth: batch.depth(simd, lane, corners),
                    ..Planes::default()
                };
                if work.state.stage == Stage::Mixed && work.state.maps.is_none() {
                    let second = &v.second[usize::from(back)];
                    planes.second = Slopes::of_lane(&batch.slopes(simd, lane, each!(k in 3 => &second[numbers[k]])));
                }
                if work.state.paints() {
                    planes.paint = Slopes::of_lane(&batch.slopes(simd, lane, each!(k in 3 => &v.paint[numbers[k]])));
                }
                planes.set_face(&self.faces.each[usize::from(back)][number], work.state, &look.pass.lens);
                if work.state.maps.is_some() {
                    let slopes = |values: [&[f32; 4]; 3]| Slopes::of_lane(&batch.slopes_near(simd, lane, values));
                    let first = [batch.bounds[0][lane], batch.bounds[2][lane]];
                    let mut mapped = MappedTriangle::small(v, (numbers, back), (work.state, &planes), (first, slopes));
                    self.faces.parts.set((&mut mapped, work.state), back, number);
                    self.nearest.mapped_triangles.push(mapped);
                }
                let edges = EdgeFunctions::of_lane(batch, lane, look.pass.samples);
                draw(simd, &mut self.nearest, &edges, &planes, back, look, work);
            },
        );
    }

    /// Allocates the memory of a tile.
    pub(crate) fn prepare(&mut self, pass: &Pass) {
        let any = |has: fn(&DrawCall) -> bool| pass.draws.iter().any(has);
        self.nearest.prepare(pass.samples, any(|draw| draw.colored), any(|draw| draw.maps.is_some()));
        make_room(&mut self.own, pass.pixels);
    }
}

/// Encodes a tile's colors as pixels.
#[inline(always)]
fn encode<S: Simd>(simd: S, nearest: &TileBuffer, pass: &Pass, last_row: i32, rows: &mut Rows) {
    for at in (0..(last_row as usize + 1) * TILE).step_by(lanes::<S>()) {
        put(simd, rows, at, nearest.resolved(simd, at, pass.samples), pass.pixels);
    }
}

/// Shades and encodes the nearest surfaces, with one sample a pixel and without blending.
#[inline(always)]
fn shade_and_encode<S: Simd>(simd: S, nearest: &TileBuffer, look: &Look, last_row: i32, rows: &mut Rows) {
    let pass = look.pass;
    let clear = cleared(simd, pass.clear, pass.pixels);
    let mut even = [Even::clear(simd, pass); 2];
    let places = (0..(last_row as usize + 1) * TILE).step_by(lanes::<S>());
    if pass.pixels == PixelFormat::Floats || pass.shows_sky() {
        for at in places {
            let color = nearest.shade_one_apart(simd, look, at, behind(simd, look, at, clear));
            put(simd, rows, at, kept(simd, color, pass.pixels), pass.pixels);
        }
    } else if look.painted {
        for at in places {
            put_bytes::<S>(rows, at, nearest.bytes_of_one::<S, true>(simd, look, at, clear, &mut even));
        }
    } else {
        for at in places {
            put_bytes::<S>(rows, at, nearest.bytes_of_one::<S, false>(simd, look, at, clear, &mut even));
        }
    }
}

/// The same of pixels with four samples.
#[inline(always)]
fn shade_and_encode_four<S: Simd>(simd: S, nearest: &mut TileBuffer, look: &Look, last_row: i32, rows: &mut Rows) {
    let pass = look.pass;
    let clear = cleared(simd, pass.clear, pass.pixels);
    for at in (0..(last_row as usize + 1) * TILE).step_by(lanes::<S>()) {
        let color = nearest.color_of_four(simd, look, at, behind(simd, look, at, clear));
        put(simd, rows, at, color, pass.pixels);
    }
}

#[inline(always)]
fn fill_with_clear<S: Simd>(simd: S, look: &Look, last_row: i32, rows: &mut Rows) {
    let pass = look.pass;
    let color = cleared(simd, pass.clear, pass.pixels);
    for at in (0..(last_row as usize + 1) * TILE).step_by(lanes::<S>()) {
        put(simd, rows, at, behind(simd, look, at, color), pass.pixels);
    }
}

#[inline(always)]
fn put<S: Simd>(simd: S, rows: &mut Rows, at: usize, color: V3<S>, pixels: PixelFormat) {
    if pixels == PixelFormat::Floats {
        let place = rows.place(at);
        for lane in 0..lanes::<S>() {
            let place = place + 4 * lane;
            let values = [color[0][lane], color[1][lane], color[2][lane], 1.0];
            rows.values.floats[place..place + 4].copy_from_slice(&values);
        }
    } else {
        put_bytes::<S>(rows, at, bytes(simd, color, pixels));
    }
}

#[inline(always)]
fn put_bytes<S: Simd>(rows: &mut Rows, at: usize, pixels: I<S>) {
    let place = rows.place(at);
    pixels.bitcast::<S::u8s>().store_slice(&mut rows.values.bytes[place..place + 4 * lanes::<S>()]);
}

/// Draws a triangle of few pixels.
#[inline(always)]
fn cover_tiny<S: Simd>(
    simd: S,
    (nearest, count): (&mut TileBuffer, Samples),
    (centers, samples, first): (i32, [i32; 4], [i32; 2]),
    slopes: &LaneSlopes<S>,
    range: [f32; 2],
    shader: i32,
    keeps_lead: bool,
) {
    match count {
        Samples::One => nearest.cover_tiny(simd, (centers, first), slopes, range, shader, keeps_lead),
        _ => {
            nearest.cover_tiny_four(simd, (centers, samples, first), slopes, range, shader, keeps_lead);
        }
    }
}

/// The groups of vertices, each of one vector, that contain corners of the triangles.
#[inline(always)]
fn groups_of<S: Simd>(triangles: &[[u8; 3]], shown: u64) -> u32 {
    let (mut left, mut groups) = (shown, 0);
    while left != 0 {
        for corner in triangles[left.trailing_zeros() as usize] {
            groups |= 1 << (usize::from(corner) / lanes::<S>());
        }
        left &= left - 1;
    }
    groups
}

/// The least and the greatest nearness of corners.
#[inline(always)]
fn range([a, b, c]: [&[f32; 4]; 3]) -> [f32; 2] {
    [min_one(min_one(a[0], b[0]), c[0]), max_one(max_one(a[0], b[0]), c[0])]
}

#[inline(always)]
fn draw<S: Simd>(
    simd: S,
    nearest: &mut TileBuffer,
    edges: &EdgeFunctions,
    planes: &Planes,
    back: bool,
    look: &Look,
    work: &Work,
) {
    let mapped = (nearest.mapped_triangles.len() as i32).checked_sub(1);
    let (shader, kept) = (shader_of(work.job.state, back), Kept::new(look, work.state, back, mapped));
    match look.pass.samples {
        _ if work.blend => nearest.blend(simd, edges, planes, shader, look),
        Samples::One => nearest.cover_strips(simd, edges, planes, shader, kept),
        _ => nearest.cover_four(simd, edges, planes, shader, kept),
    }
}

impl<'a> Work<'a> {
    fn new(scene: &Scene<'a>, number: u32, last: [i32; 2], (first, blend): (Option<Job>, bool)) -> Self {
        let Scene { pass, bins, .. } = *scene;
        let job = bins.jobs[number as usize];
        let draw = &pass.draws[job.draw as usize];
        let mesh = pass.meshes[draw.mesh as usize];
        let state = &bins.states[job.state as usize];
        Self {
            job,
            mesh,
            piece: &mesh.each[job.piece as usize],
            instance: &pass.instances[job.instance as usize],
            state,
            covering: Covering {
                cull: draw.cull,
                clockwise: draw.clockwise,
                samples: pass.samples,
                last,
                is_plain: !blend && state.stage != Stage::Mixed && !state.opposite_normals && !state.is_painted(),
            },
            behind: pass.samples == Samples::One && first.is_some_and(|first| first.instance != job.instance),
            blend,
        }
    }
}

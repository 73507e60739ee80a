//! A tile from its pieces to its pixels.

use crate::bins::{Bins, Job, TILE};
use crate::clip::each_part;
use crate::cover::{Edges, Kept, Nearest, PIXELS};
use crate::encode::{bytes, cleared};
use crate::lanes::{
    MOST_LANES, Simd, V3, add, cross, each, lanes, load, max, max_one, min_one, neg, safe_normalize, scale, splat,
    store, store_i, sub,
};
use crate::lighting::{Points, reflected, to_viewer};
use crate::pass::{InstanceData, Pass, PixelFormat, SampleCount};
use crate::pieces::{Piece, Pieces};
use crate::planes::{Gradient, Planes, Slopes};
use crate::shade::{Look, shader_of};
use crate::state::{Stage, State};
use crate::triangle::{Batch, Covering};
use crate::vertices::{GRID, Screen, Vertices, transformed, turned};
use fearless_simd::prelude::*;

/// What draws tiles, one after the other, in memory of its own.
pub(crate) struct Worker {
    vertices: Vertices,
    batch: Batch,
    faces: Faces,
    nearest: Nearest,
    /// Whether the pixels are all of the clear color.
    is_clear: bool,
    /// The tile's pixels as bytes.
    pub(crate) bytes: Vec<i32>,
    /// Or as numbers, four a pixel.
    pub(crate) floats: Vec<f32>,
}

/// Of each lane's triangle its own normal, or what flat shading makes of it, front and back.
struct Faces {
    each: [[[f32; MOST_LANES]; 3]; 2],
}

/// A frame as tiles see it.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub(crate) pass: &'a Pass<'a>,
    pub(crate) bins: &'a Bins,
    pub(crate) screen: &'a Screen,
}

/// A job with what it names.
#[derive(Clone, Copy)]
struct Work<'a> {
    job: Job,
    mesh: &'a Pieces,
    piece: &'a Piece,
    instance: &'a InstanceData,
    state: &'a State,
    covering: Covering,
    blend: bool,
}

impl Worker {
    pub(crate) fn new() -> Self {
        Self {
            vertices: Vertices::new(),
            batch: Batch::default(),
            faces: Faces { each: [[[0.0; MOST_LANES]; 3]; 2] },
            nearest: Nearest::new(),
            is_clear: false,
            bytes: Vec::new(),
            floats: Vec::new(),
        }
    }

    /// Draws a tile into `bytes` or `floats`.
    pub(crate) fn draw<S: Simd>(&mut self, simd: S, scene: &Scene, tile: [u32; 2]) {
        let Scene { pass, bins, screen } = *scene;
        let look = Look { pass, states: &bins.states, screen, tile };
        let last = [0, 1].map(|axis| (pass.size[axis] - tile[axis] * TILE as u32).min(TILE as u32) as i32 - 1);
        let mut jobs = bins.of_tile(tile[0], tile[1]).peekable();
        if jobs.peek().is_none() {
            if !std::mem::replace(&mut self.is_clear, true) {
                simd.vectorize(
                    #[inline(always)]
                    || self.fill_with_clear(simd, pass),
                );
            }
            return;
        }
        self.is_clear = false;
        self.nearest.clear(pass.samples);
        let mut shaded = false;
        for number in jobs {
            let blend = number >= bins.first_blended;
            if blend && !shaded {
                self.shade(simd, &look, last[1]);
                shaded = true;
            }
            let work = Work::of(scene, number, last, blend);
            simd.vectorize(
                #[inline(always)]
                || self.vertices.fill(simd, (work.mesh, work.piece), work.instance, (screen, tile), (pass, work.state)),
            );
            simd.vectorize(
                #[inline(always)]
                || self.triangles(simd, &look, &work),
            );
        }
        if !shaded {
            self.shade(simd, &look, last[1]);
        }
        simd.vectorize(
            #[inline(always)]
            || self.encode(simd, pass, last[1]),
        );
    }

    fn shade<S: Simd>(&mut self, simd: S, look: &Look, last_row: i32) {
        simd.vectorize(
            #[inline(always)]
            || self.nearest.shade(simd, look, last_row as usize + 1),
        );
    }

    /// Draws a piece's triangles.
    #[inline(always)]
    fn triangles<S: Simd>(&mut self, simd: S, look: &Look, work: &Work) {
        let range = work.piece.triangles.start as usize..work.piece.triangles.end as usize;
        for triangles in work.mesh.triangles[range].chunks(lanes::<S>()) {
            self.batch.fill(simd, triangles, &self.vertices, &work.covering);
            let (small, others) = (self.batch.small, self.batch.others);
            if small | others == 0 {
                continue;
            }
            if work.state.stage == Stage::Flat || work.state.opposite_normals {
                // Which side a triangle shows that is not small is not known yet.
                let backs = self.batch.backs & small | others;
                self.faces.fill(simd, triangles, look, work, backs != 0);
            }
            // In their order, which decides where surfaces blend or lie in one depth.
            let mut left = small | others;
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                if small >> lane & 1 != 0 {
                    self.small(simd, look, work, triangles[lane], lane);
                } else {
                    self.other(simd, look, work, triangles[lane], lane);
                }
            }
        }
    }

    /// A triangle that is large, or has to be clipped.
    fn other<S: Simd>(&mut self, simd: S, look: &Look, work: &Work, triangle: [u8; 3], lane: usize) {
        let (faces, nearest) = (&self.faces, &mut self.nearest);
        let place = (look.tile, &work.covering);
        each_part(&self.vertices, triangle, look.screen, place, |(edges, mut planes, back)| {
            faces.put(&mut planes, lane, back, work.state);
            draw_more(simd, nearest, &edges, &planes, back, look, work);
        });
    }

    #[inline(always)]
    fn small<S: Simd>(&mut self, simd: S, look: &Look, work: &Work, triangle: [u8; 3], lane: usize) {
        let edges = Edges::of_lane(&self.batch, lane, look.pass.samples);
        if look.pass.samples == SampleCount::One && edges.miss_all() {
            return;
        }
        let back = self.batch.backs >> lane & 1 != 0;
        let positive = self.batch.clockwise >> lane & 1 != 0;
        let numbers = each!(k in 3 => usize::from(triangle[k]));
        let v = &self.vertices;
        let [x, y] = each!(axis in 2 => {
            let first = look.tile[axis] as f32 * TILE as f32 + 0.5;
            each!(k in 3 => v.screen[axis][numbers[k]] - first)
        });
        let mut gradient = Gradient::<f32>::new(x, y);
        if !gradient.is_sound(positive) {
            let [x, y] = each!(axis in 2 => {
                let first = look.tile[axis] as i32 * (TILE as i32 * GRID) + GRID / 2;
                each!(k in 3 => (v.grid[axis][numbers[k]] - first) as f32 * (1.0 / GRID as f32))
            });
            gradient = Gradient::<f32>::new(x, y);
        }
        let lead = &v.lead[usize::from(back && v.sides_lead)];
        let [a, b, c] = each!(k in 3 => &lead[numbers[k]]);
        let mut planes = Planes {
            lead: gradient.slopes(simd, [a, b, c]),
            range: [min_one(min_one(a[0], b[0]), c[0]), max_one(max_one(a[0], b[0]), c[0])],
            ..Planes::default()
        };
        if work.state.stage == Stage::Mixed {
            let second = &v.second[usize::from(back)];
            planes.second = gradient.slopes(simd, each!(k in 3 => &second[numbers[k]]));
        }
        self.faces.put(&mut planes, lane, back, work.state);
        draw(simd, &mut self.nearest, &edges, &planes, back, look, work);
    }

    /// Makes the tile's pixels of its colors.
    #[inline(always)]
    fn encode<S: Simd>(&mut self, simd: S, pass: &Pass, last_row: i32) {
        let count = (last_row as usize + 1) * TILE;
        for at in (0..count).step_by(lanes::<S>()) {
            let color = self.nearest.resolved(simd, at, pass.samples);
            put(simd, &mut self.bytes, &mut self.floats, at, color, pass.pixels);
        }
    }

    #[inline(always)]
    fn fill_with_clear<S: Simd>(&mut self, simd: S, pass: &Pass) {
        let color = cleared(simd, pass.clear, pass.pixels);
        for at in (0..PIXELS).step_by(lanes::<S>()) {
            put(simd, &mut self.bytes, &mut self.floats, at, color, pass.pixels);
        }
    }

    /// Makes room for a tile's pixels.
    pub(crate) fn prepare(&mut self, pixels: PixelFormat) {
        self.is_clear = false;
        match pixels {
            PixelFormat::Floats => self.floats.resize(4 * PIXELS, 1.0),
            _ => self.bytes.resize(PIXELS, 0),
        }
    }
}

#[inline(always)]
fn put<S: Simd>(simd: S, to_bytes: &mut [i32], to_floats: &mut [f32], at: usize, color: V3<S>, pixels: PixelFormat) {
    if pixels == PixelFormat::Floats {
        for lane in 0..lanes::<S>() {
            let place = 4 * (at + lane);
            to_floats[place..place + 4].copy_from_slice(&[color[0][lane], color[1][lane], color[2][lane], 1.0]);
        }
    } else {
        store_i::<S>(bytes(simd, color, pixels), to_bytes, at);
    }
}

#[inline(always)]
fn draw<S: Simd>(simd: S, nearest: &mut Nearest, edges: &Edges, planes: &Planes, back: bool, look: &Look, work: &Work) {
    let [left, right, ..] = edges.bounds;
    if right - left < FEW && !work.blend && look.pass.samples == SampleCount::One {
        nearest.cover_few(simd, edges, planes, shader_of(work.job.state, back), Kept::of(work.state));
    } else {
        draw_more(simd, nearest, edges, planes, back, look, work);
    }
}

/// Up to so many pixels side by side are drawn one by one.
const FEW: i32 = 4;

/// All but the frequent case: a function of its own in each width, so that its code is there once.
fn draw_more<S: Simd>(
    simd: S,
    nearest: &mut Nearest,
    edges: &Edges,
    planes: &Planes,
    back: bool,
    look: &Look,
    work: &Work,
) {
    let (shader, kept) = (shader_of(work.job.state, back), Kept::of(work.state));
    simd.vectorize(
        #[inline(always)]
        || match look.pass.samples {
            _ if work.blend => nearest.blend(simd, edges, planes, shader, look),
            SampleCount::One => nearest.cover_rows(simd, edges, planes, shader, kept),
            SampleCount::Four => nearest.cover_four(simd, edges, planes, shader, kept),
        },
    );
}

impl<'a> Work<'a> {
    fn of(scene: &Scene<'a>, number: u32, last: [i32; 2], blend: bool) -> Self {
        let Scene { pass, bins, .. } = *scene;
        let job = bins.jobs[number as usize];
        let draw = &pass.draws[job.draw as usize];
        let mesh = pass.meshes[draw.mesh as usize];
        Self {
            job,
            mesh,
            piece: &mesh.each[job.piece as usize],
            instance: &pass.instances[job.instance as usize],
            state: &bins.states[job.state as usize],
            covering: Covering { left_out: draw.left_out, clockwise: draw.clockwise, samples: pass.samples, last },
            blend,
        }
    }
}

impl Faces {
    /// The lanes' triangles' own normals, or their colors where the draw is flat.
    #[inline(always)]
    fn fill<S: Simd>(&mut self, simd: S, triangles: &[[u8; 3]], look: &Look, work: &Work, backs: bool) {
        let mut corners = [[[0.0; MOST_LANES]; 3]; 3];
        for (lane, triangle) in triangles.iter().enumerate() {
            for k in 0..3 {
                let vertex = work.piece.first_vertex as usize + usize::from(triangle[k]);
                for axis in 0..3 {
                    corners[k][axis][lane] = work.mesh.positions[axis][vertex];
                }
            }
        }
        let corners = each!(k in 3 => each!(axis in 3 => load(simd, &corners[k][axis], 0)));
        let n = safe_normalize(simd, turned(simd, &work.instance.normal, face_normal(simd, corners)));
        if work.state.stage != Stage::Flat {
            self.store::<S>(0, n);
            self.store::<S>(1, n);
            return;
        }
        let [a, b, c] = corners;
        let middle = scale::<S>(add::<S>(add::<S>(a, b), c), splat(simd, 1.0 / 3.0));
        let p = transformed(simd, &work.instance.eye_from_model, middle);
        for back in [false, true] {
            if back && !(backs && work.state.backs) {
                break;
            }
            let n = if back { neg::<S>(n) } else { n };
            let points = Points { p, n, v: to_viewer(simd, p, n, look.pass.local_viewer) };
            let terms = work.state.vertex_terms(simd, look.pass, &points, back);
            self.store::<S>(usize::from(back), reflected(simd, &terms, work.state.side(look.pass, back)));
        }
    }

    #[inline(always)]
    fn store<S: Simd>(&mut self, side: usize, v: V3<S>) {
        for axis in 0..3 {
            store::<S>(v[axis], &mut self.each[side][axis], 0);
        }
    }

    /// Into a lane's planes.
    #[inline(always)]
    fn put(&self, planes: &mut Planes, lane: usize, back: bool, state: &State) {
        let of_lane = each!(axis in 3 => self.each[usize::from(back)][axis][lane]);
        if state.stage == Stage::Flat {
            let [depth, dx, dy] = [planes.lead.base[0], planes.lead.dx[0], planes.lead.dy[0]];
            planes.lead = Slopes::constant(of_lane);
            (planes.lead.base[0], planes.lead.dx[0], planes.lead.dy[0]) = (depth, dx, dy);
        } else if state.opposite_normals {
            planes.face = of_lane;
        }
    }
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

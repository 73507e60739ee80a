//! Bins pieces: finds the visible ones and the tiles that they may cover.

use crate::error::RasterError;
use crate::input::pass::Pass;
use crate::lighting::state::State;
use crate::vertices::placed::{PlacedInstance, TILE, TileBox};
use std::ops::Range;

/// A piece in more tiles than this is in no tile's list; each tile asks for its box.
const MANY_TILES: u32 = 64;

/// A piece of an instance, to be drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Job {
    pub(crate) draw: u32,
    pub(crate) instance: u32,
    pub(crate) piece: u32,
    pub(crate) state: u32,
    /// First and last column, first and last row of tiles.
    tiles: [u16; 4],
    /// See [`TileBox::is_at_hand`].
    pub(crate) at_hand: bool,
}

/// The triangles to draw, tile by tile. Its memory is kept from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct Bins {
    pub(crate) states: Vec<State>,
    /// In the order of drawing.
    pub(crate) jobs: Vec<Job>,
    /// The first job that blends.
    pub(crate) first_blended: u32,
    /// Columns and rows of tiles.
    pub(crate) tiles: [u32; 2],
    /// The index of each tile's first job in `listed`.
    starts: Vec<u32>,
    listed: Vec<u32>,
    /// The jobs in many tiles.
    wide: Vec<u32>,
    spans: Vec<Span>,
    parts: Vec<BinsPart>,
}

/// Fewer pieces than this are binned by the calling thread, since waking another takes longer.
const WORTH_PARTING: u64 = 4_000;

/// The pieces of a draw's instances, one instance after the other.
#[derive(Clone, Debug)]
struct Span {
    draw: u32,
    pieces: Range<usize>,
    /// The number of pieces in the spans before it.
    start: u64,
}

/// The jobs that one thread finds.
#[derive(Debug, Default)]
pub(crate) struct BinsPart {
    /// The range of pieces that it processes, counted over all spans.
    of: Range<u64>,
    states: Vec<State>,
    jobs: Vec<Job>,
    /// The number of opaque jobs, which come first.
    opaque: u32,
    /// For each surface the last draw that used it, and its two states there: for pieces whose normals may vanish, and
    /// for others.
    known: Vec<(u32, [u32; 2])>,
    refused: Option<RasterError>,
}

impl Bins {
    /// Bins a pass's pieces into tiles. `each` calls a function with each part, on `threads` threads.
    pub(crate) fn fill<E>(&mut self, pass: &Pass, threads: usize, each: E) -> Result<(), RasterError>
    where
        E: FnOnce(&mut [BinsPart], &(dyn Fn(&mut BinsPart) + Sync)),
    {
        self.tiles = pass.size.map(|side| side.div_ceil(TILE as u32));
        let total = self.find_spans(pass)?;
        let count = if total < WORTH_PARTING { 1 } else { threads.max(1) };
        if self.parts.len() < count {
            self.parts.resize_with(count, BinsPart::default);
        }
        for (number, part) in self.parts[..count].iter_mut().enumerate() {
            let end = |number: usize| total * number as u64 / count as u64;
            part.of = end(number)..end(number + 1);
        }
        let spans = &self.spans;
        let work = |part: &mut BinsPart| part.refused = part.fill(pass, spans).err();
        match &mut self.parts[..count] {
            [part] => work(part),
            parts => each(parts, &work),
        }
        self.join(count)?;
        self.list()
    }

    /// Finds the spans of all draws, blended ones last, and returns their number of pieces.
    fn find_spans(&mut self, pass: &Pass) -> Result<u64, RasterError> {
        self.spans.clear();
        reserve(&mut self.spans, pass.draws.len())?;
        let mut total = 0;
        for blend in [false, true] {
            for (number, draw) in pass.draws.iter().enumerate().filter(|(_, draw)| draw.blend == blend) {
                let Range { start, end } = draw.indices;
                let pieces = pass.meshes[draw.mesh as usize].pieces_in(&draw.indices);
                let pieces = pieces.ok_or(RasterError::Cut { draw: number, start, end })?;
                let count = pieces.len() as u64 * draw.instances.len() as u64;
                self.spans.push(Span { draw: number as u32, pieces, start: total });
                total += count;
            }
        }
        Ok(total)
    }

    /// Concatenates the parts.
    fn join(&mut self, count: usize) -> Result<(), RasterError> {
        self.states.clear();
        self.jobs.clear();
        self.first_blended = 0;
        for part in &mut self.parts[..count] {
            if let Some(refused) = part.refused.take() {
                return Err(refused);
            }
            self.first_blended += part.opaque;
            if self.jobs.is_empty() {
                std::mem::swap(&mut self.states, &mut part.states);
                std::mem::swap(&mut self.jobs, &mut part.jobs);
                continue;
            }
            let before = self.states.len() as u32;
            reserve(&mut self.states, part.states.len())?;
            self.states.append(&mut part.states);
            reserve(&mut self.jobs, part.jobs.len())?;
            self.jobs.extend(part.jobs.iter().map(|job| Job { state: before + job.state, ..*job }));
        }
        Ok(())
    }

    /// The jobs of a tile, in the order of drawing.
    pub(crate) fn of_tile(&self, column: u32, row: u32) -> impl Iterator<Item = u32> + '_ {
        let tile = (row * self.tiles[0] + column) as usize;
        let listed = &self.listed[self.starts[tile] as usize..self.starts[tile + 1] as usize];
        let (column, row) = (column as u16, row as u16);
        let in_tile = move |&&job: &&u32| {
            let [left, right, top, bottom] = self.jobs[job as usize].tiles;
            left <= column && column <= right && top <= row && row <= bottom
        };
        let (mut listed, mut wide) = (listed.iter().peekable(), self.wide.iter().filter(in_tile).peekable());
        std::iter::from_fn(move || match (listed.peek(), wide.peek()) {
            (Some(a), Some(b)) if b < a => wide.next(),
            (Some(_), _) => listed.next(),
            _ => wide.next(),
        })
        .copied()
    }

    /// Makes the tiles' lists by counting.
    fn list(&mut self) -> Result<(), RasterError> {
        let tiles = (self.tiles[0] * self.tiles[1]) as usize;
        self.wide.clear();
        self.starts.clear();
        reserve(&mut self.starts, tiles + 2)?;
        self.starts.resize(tiles + 2, 0);
        let columns = self.tiles[0];
        for (number, job) in self.jobs.iter().enumerate() {
            if job.is_wide() {
                reserve(&mut self.wide, 1)?;
                self.wide.push(number as u32);
            } else {
                job.each_tile(columns, |tile| self.starts[tile + 2] += 1);
            }
        }
        let mut total: u64 = 0;
        for start in &mut self.starts {
            total += u64::from(*start);
            *start = u32::try_from(total).map_err(|_| refused(4 * total))?;
        }
        self.listed.clear();
        reserve(&mut self.listed, total as usize)?;
        self.listed.resize(total as usize, 0);
        for (number, job) in self.jobs.iter().enumerate().filter(|(_, job)| !job.is_wide()) {
            job.each_tile(columns, |tile| {
                let place = &mut self.starts[tile + 1];
                self.listed[*place as usize] = number as u32;
                *place += 1;
            });
        }
        Ok(())
    }
}

impl BinsPart {
    fn fill(&mut self, pass: &Pass, spans: &[Span]) -> Result<(), RasterError> {
        self.states.clear();
        self.jobs.clear();
        self.opaque = 0;
        self.known.clear();
        reserve(&mut self.known, pass.surfaces.len())?;
        self.known.resize(pass.surfaces.len(), (u32::MAX, [0; 2]));
        let Range { start, end } = self.of;
        let first = spans.partition_point(|span| span.start <= start).saturating_sub(1);
        for span in spans[first..].iter().take_while(|span| span.start < end) {
            let draw = &pass.draws[span.draw as usize];
            let (each, count) = (span.pieces.len() as u64, draw.instances.len() as u64);
            let last = (end - span.start).min(each * count);
            let mut next = start.saturating_sub(span.start);
            while next < last {
                let (instance, skipped) = (next / each, next % each);
                let taken = (each - skipped).min(last - next);
                let from = span.pieces.start + skipped as usize;
                self.add(pass, span.draw, draw.instances.start + instance as u32, from..from + taken as usize)?;
                next += taken;
            }
            if !draw.blend {
                self.opaque = self.jobs.len() as u32;
            }
        }
        Ok(())
    }

    /// Adds the pieces of an instance that may be visible.
    fn add(&mut self, pass: &Pass, number: u32, index: u32, pieces: Range<usize>) -> Result<(), RasterError> {
        let draw = &pass.draws[number as usize];
        let mesh = pass.meshes[draw.mesh as usize];
        let instance = &pass.instances[index as usize];
        let placed = PlacedInstance::new(pass, instance, draw);
        let mut all = None;
        if pieces.len() > 1 {
            let Some(tiles) = placed.tiles(&mesh.extent) else { return Ok(()) };
            all = Some(tiles).filter(TileBox::is_in_one);
        }
        let [vanishing, other] = self.states(pass, number, instance.surface)?;
        reserve(&mut self.jobs, pieces.len())?;
        for (piece, of) in pieces.clone().zip(&mesh.each[pieces]) {
            if placed.turns_away(of) {
                continue;
            }
            if let Some(of) = all.or_else(|| placed.tiles(&of.extent)) {
                let (tiles, at_hand) = (of.tiles, of.is_at_hand());
                let state = if mesh.each[piece].opposite_normals { vanishing } else { other };
                self.jobs.push(Job { draw: number, instance: index, piece: piece as u32, state, tiles, at_hand });
            }
        }
        Ok(())
    }

    /// The numbers of a surface's states in a draw: for pieces whose interpolated normals may vanish, if the draw
    /// handles that, and for others.
    fn states(&mut self, pass: &Pass, number: u32, surface: u32) -> Result<[u32; 2], RasterError> {
        let (of, states) = self.known[surface as usize];
        if of == number {
            return Ok(states);
        }
        let state = State::new(&pass.draws[number as usize], surface, &pass.surfaces[surface as usize]);
        let vanishing = self.number(state)?;
        let other = if state.opposite_normals { self.number(state.without_opposite_normals())? } else { vanishing };
        self.known[surface as usize] = (number, [vanishing, other]);
        Ok([vanishing, other])
    }

    /// The number of a state, which is reused if it is one of the last two.
    fn number(&mut self, state: State) -> Result<u32, RasterError> {
        let last = self.states.len().saturating_sub(2);
        if let Some(place) = self.states[last..].iter().position(|other| *other == state) {
            return Ok((last + place) as u32);
        }
        reserve(&mut self.states, 1)?;
        let number = self.states.len() as u32;
        self.states.push(state);
        Ok(number)
    }
}

fn reserve<T>(list: &mut Vec<T>, more: usize) -> Result<(), RasterError> {
    list.try_reserve(more).map_err(|_| refused(more as u64 * size_of::<T>() as u64))
}

fn refused(bytes: u64) -> RasterError {
    RasterError::Memory { what: "the lists of tiles", bytes }
}

impl Job {
    fn is_wide(&self) -> bool {
        let [left, right, top, bottom] = self.tiles.map(u32::from);
        (right - left + 1) * (bottom - top + 1) > MANY_TILES
    }

    fn each_tile(&self, columns: u32, mut with: impl FnMut(usize)) {
        let [left, right, top, bottom] = self.tiles.map(u32::from);
        for row in top..=bottom {
            for column in left..=right {
                with((row * columns + column) as usize);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::pass::{DrawCall, PixelFormat};
    use crate::{Pieces, TriangleOrder, VertexLists};
    use halfway_lighting::record::Cull;
    use halfway_lighting::record::{InstanceRecord, LightRange, MaterialRecord, SurfaceLights, SurfaceRecord};
    use halfway_lighting::{Frequency, Lens, Samples, Terms};

    /// A pass into bytes, without lights.
    fn plain<'a>(
        size: [u32; 2],
        (instances, surfaces): (&'a [InstanceRecord], &'a [SurfaceRecord]),
        meshes: &'a [&'a Pieces],
        draws: &'a [DrawCall],
    ) -> Pass<'a> {
        Pass {
            size,
            samples: Samples::One,
            pixels: PixelFormat::SrgbBytes,
            clear: [0.0; 3],
            lens: Lens::perspective([1.0, size[0] as f32 / size[1] as f32], 0.1),
            local_viewer: true,
            lights: &[],
            lists: &[],
            surfaces,
            instances,
            meshes,
            maps: &[],
            surroundings: None,
            draws,
        }
    }

    /// With any number of parts, jobs are in drawing order and have the same states as with one part.
    #[test]
    fn parallel_binning_matches_one_thread() {
        let strip: Vec<[f32; 3]> = (0..102).map(|k| [0.01 * k as f32, (k % 2) as f32, 0.0]).collect();
        let indices: Vec<u32> = (0..100).flat_map(|k| [k, k + 1, k + 2]).collect();
        let mesh = Pieces::new(&strip, VertexLists::default(), &indices, &[], TriangleOrder::Clustered).unwrap();
        assert!(mesh.each.len() > 1, "a span may end within an instance");
        let instances: Vec<InstanceRecord> = (0..3_001_u32)
            .map(|k| InstanceRecord {
                eye_from_model: [
                    [1.0, 0.0, 0.0, (k % 97) as f32 - 48.0],
                    [0.0, 1.0, 0.0, (k % 41) as f32 - 20.0],
                    [0.0, 0.0, 1.0, -30.0 - (k % 7) as f32],
                ],
                normal: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
                surface: k % 3,
            })
            .collect();
        let surfaces = [1.0, 2.0, 4.0].map(|shininess| {
            let side = MaterialRecord { shininess, ..MaterialRecord::default() };
            SurfaceRecord { front: side, back: side, ..SurfaceRecord::default() }
        });
        let draw = |blend, instances, cull| DrawCall {
            indices: 0..indices.len() as u32,
            instances,
            blend,
            cull,
            ..DrawCall::default()
        };
        let draws =
            [draw(true, 0..145, Cull::None), draw(false, 145..146, Cull::Back), draw(false, 146..3_001, Cull::None)];
        let meshes = [&mesh];
        let pass = plain([1280, 720], (&instances, &surfaces), &meshes, &draws);
        let filled = |threads| {
            let mut bins = Bins::default();
            // The second time in reused memory.
            for _ in 0..2 {
                bins.fill(&pass, threads, |parts, work| {
                    assert_eq!(parts.len(), threads);
                    parts.iter_mut().rev().for_each(work);
                })
                .unwrap();
            }
            let of_tiles = (0..bins.tiles[0] * bins.tiles[1])
                .map(|tile| bins.of_tile(tile % bins.tiles[0], tile / bins.tiles[0]).collect::<Vec<_>>());
            let jobs = bins.jobs.iter().map(|job| (job.draw, job.instance, job.piece, bins.states[job.state as usize]));
            (jobs.collect::<Vec<_>>(), of_tiles.collect::<Vec<_>>(), bins.first_blended, bins.states.len())
        };
        let one = filled(1);
        assert!(one.0.len() > 1_000 && one.2 > 0 && one.2 < one.0.len() as u32, "{} jobs", one.0.len());
        assert!(one.0.iter().all(|(_, instance, _, state)| state.surface == instance % 3));
        // Three surfaces in three draws; those of the second draw and of the first instance of the third, 1 and 2, are
        // the last two there are.
        assert_eq!(one.3, 3 + 2);
        for threads in [2, 3, 7] {
            let parts = filled(threads);
            assert!((&parts.0, &parts.1, parts.2) == (&one.0, &one.1, one.2), "{threads} parts");
        }
    }

    /// In a mesh with some triangles whose normals may cancel, only the pieces with such a triangle keep the triangles'
    /// own normals; and consecutive draws share the same two states.
    #[test]
    fn pieces_whose_normals_do_not_vanish_keep_no_others() {
        let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
        let positions = [corners, corners].concat();
        let normals = [[[0.0, 0.0, 1.0]; 3], [[0.0, 0.0, 1.0], [0.0, 0.6, -0.8], [0.0, 0.0, 1.0]]].concat();
        let indices = [0, 1, 2, 3, 4, 5];
        let mesh = Pieces::new(
            &positions,
            VertexLists { normals: &normals, ..VertexLists::default() },
            &indices,
            &[0..3, 3..6],
            TriangleOrder::Clustered,
        )
        .unwrap();
        let instances = [InstanceRecord {
            eye_from_model: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, -3.0]],
            normal: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            surface: 0,
        }];
        let lit = LightRange { start: 0, count: 1 };
        let surfaces = [SurfaceRecord {
            lights: SurfaceLights { both: lit, ..SurfaceLights::default() },
            ..SurfaceRecord::default()
        }];
        let draw = |opposite_normals, indices| DrawCall {
            indices,
            instances: 0..1,
            terms: Terms::both(Frequency::Fragment),
            opposite_normals,
            ..DrawCall::default()
        };
        let meshes = [&mesh];
        let states = |opposite_normals| {
            let draws = [draw(opposite_normals, 0..6), draw(opposite_normals, 0..3), draw(opposite_normals, 3..6)];
            let pass = plain([64, 64], (&instances, &surfaces), &meshes, &draws);
            let mut bins = Bins::default();
            bins.fill(&pass, 1, |parts, work| parts.iter_mut().for_each(work)).unwrap();
            let of = |job: &Job| (job.piece, bins.states[job.state as usize].opposite_normals);
            (bins.jobs.iter().map(of).collect::<Vec<_>>(), bins.states.len())
        };
        assert_eq!(states(true), (vec![(0, false), (1, true), (0, false), (1, true)], 2));
        assert_eq!(states(false), (vec![(0, false), (1, false), (0, false), (1, false)], 1));
    }
}

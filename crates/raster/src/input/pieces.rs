//! A mesh prepared for the rasterizer: cut into pieces with vertices of their own.

use crate::error::RasterError;
use rayon::prelude::*;
use std::ops::Range;

/// The most triangles of a piece.
pub(crate) const PIECE_TRIANGLES: usize = 64;
/// The most vertices of a piece; a multiple of every width.
pub(crate) const PIECE_VERTICES: usize = 96;
/// Vertices begin at multiples of this, the largest width.
const ALIGNED: usize = 16;
/// The attributes of so many vertices are gathered by one thread.
const GATHERED: usize = 1 << 13;
/// So many numbers are checked by one thread.
const CHECKED: usize = 1 << 16;
/// For errors.
const MEMORY: &str = "a mesh's pieces";

/// A mesh prepared for drawing: pieces (meshlets) of up to 64 triangles with vertices of their own, so that each is
/// transformed, culled and binned into tiles by itself. Made once for a mesh, and kept with it.
#[derive(Clone, Debug, Default)]
pub struct Pieces {
    pub(crate) each: Vec<Piece>,
    /// Coordinates of the pieces' vertices, one list an axis.
    pub(crate) positions: [Vec<f32>; 3],
    /// The same of the normals.
    pub(crate) normals: [Vec<f32>; 3],
    /// The same of red, green, blue and opacity; empty where there are none.
    pub(crate) colors: [Vec<f32>; 4],
    /// The same of texture coordinates of both sets.
    pub(crate) uvs: [Vec<f32>; 4],
    /// The same of tangents.
    pub(crate) tangents: [Vec<f32>; 4],
    /// Corners as numbers of the piece's vertices.
    pub(crate) triangles: Vec<[u8; 3]>,
    index_count: u32,
    /// Some triangles are in another order than in the list of indices.
    reordered: bool,
    /// Of all.
    pub(crate) extent: PieceExtent,
}

/// Bounds of points in model space: a sphere, and a box with the same center.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PieceExtent {
    pub(crate) center: [f32; 3],
    pub(crate) radius: f32,
    /// Half the box's sides.
    pub(crate) half: [f32; 3],
}

/// Up to 64 triangles that lie close together.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// The run of indices it was cut from; pieces of one run share it.
    cut: Range<u32>,
    pub(crate) first_vertex: u32,
    pub(crate) vertex_count: u32,
    pub(crate) triangles: Range<u32>,
    pub(crate) extent: PieceExtent,
    /// The cone of its face normals: the axis, and the sine and cosine of the largest angle to it; `None` if they
    /// spread too wide.
    pub(crate) cone: Option<FaceCone>,
    /// Interpolated normals may vanish in some of its triangles.
    pub(crate) opposite_normals: bool,
}

/// A cone around the normals of faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FaceCone {
    pub(crate) axis: [f32; 3],
    pub(crate) sin: f32,
    pub(crate) cos: f32,
}

/// The drawing order of a run's triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TriangleOrder {
    /// Neighbouring triangles are grouped, which is faster. Triangles with the same corners keep their order.
    #[default]
    Clustered,
    /// As in the list, for blended surfaces.
    Kept,
}

/// Attributes of a mesh's vertices beside their positions: lists of one entry a position, or empty ones.
#[derive(Clone, Copy, Debug, Default)]
pub struct VertexLists<'a> {
    /// Unit length; draws that are unlit or flat do without.
    pub normals: &'a [[f32; 3]],
    /// Linear red, green, blue and opacity, 0 to 1 each, for draws that are [`colored`](crate::DrawCall::colored).
    pub colors: &'a [[f32; 4]],
    /// Texture coordinates of both sets, for draws with [`maps`](crate::DrawCall::maps).
    pub uvs: &'a [[f32; 4]],
    /// Tangents, unit length, and 1 or −1 after them, for draws with a normal map.
    pub tangents: &'a [[f32; 4]],
}

impl Pieces {
    /// Cuts a mesh. `cuts` are the runs of indices that draws name, in ascending order and without gaps from 0 to the
    /// end of the list; an empty slice means that the whole list is one run.
    ///
    /// # Errors
    /// An index beyond the positions, a list with more or fewer entries, a number that is not finite or out of its
    /// range, a list of indices that is no multiple of three, cuts that leave gaps or part triangles, or memory that is
    /// refused.
    pub fn new(
        positions: &[[f32; 3]],
        lists: VertexLists,
        indices: &[u32],
        cuts: &[Range<u32>],
        order: TriangleOrder,
    ) -> Result<Self, RasterError> {
        check(positions, &lists, indices)?;
        let whole = 0..indices.len() as u32;
        let cuts = if cuts.is_empty() { std::slice::from_ref(&whole) } else { cuts };
        let mut end = 0;
        for (index, cut) in cuts.iter().enumerate() {
            if cut.start != end || cut.end < cut.start || cut.end % 3 != 0 || cut.end as usize > indices.len() {
                let (reaches, available) = (u64::from(cut.end), indices.len() as u64);
                return Err(RasterError::Reference { what: "cut", index, field: "indices", reaches, available });
            }
            end = cut.end;
        }
        if end as usize != indices.len() {
            let (index, reaches, available) = (cuts.len(), u64::from(end), indices.len() as u64);
            return Err(RasterError::Reference { what: "cut", index, field: "indices", reaches, available });
        }
        let source = PieceSource { positions, normals: lists.normals, indices };
        let order = source.order(cuts, order)?;
        let works = works(cuts);
        let part = |work: &Work| Part::new(source, order.as_deref(), &cuts[work.cuts.clone()], &work.triangles);
        // A small mesh does not wake the threads.
        let parts: Result<Vec<_>, _> =
            if works.len() == 1 { works.iter().map(part).collect() } else { works.par_iter().map(part).collect() };
        let mut pieces = Self { index_count: end, reordered: order.is_some(), ..Self::default() };
        let vertices = pieces.join(parts?)?;
        let VertexLists { normals, colors, uvs, tangents } = lists;
        let without_normals = [[0.0; 3]];
        let normals = if normals.is_empty() { &without_normals } else { normals };
        fill(&mut pieces.positions, positions, &vertices)?;
        fill(&mut pieces.normals, normals, &vertices)?;
        fill(&mut pieces.colors, colors, &vertices)?;
        fill(&mut pieces.uvs, uvs, &vertices)?;
        fill(&mut pieces.tangents, tangents, &vertices)?;
        pieces.extent = PieceExtent::around(positions.iter().copied());
        Ok(pieces)
    }

    /// Puts parts one after the other. Returns the number in the mesh of each vertex of the pieces.
    fn join(&mut self, parts: Vec<Part>) -> Result<Vec<u32>, RasterError> {
        let count = |of: fn(&Part) -> usize| parts.iter().map(of).sum();
        reserve(&mut self.each, count(|part| part.each.len()), MEMORY)?;
        reserve(&mut self.triangles, count(|part| part.triangles.len()), MEMORY)?;
        let mut vertices = Vec::new();
        reserve(&mut vertices, count(|part| part.vertices.len()), MEMORY)?;
        for part in parts {
            let (vertex, triangle) = (vertices.len() as u32, self.triangles.len() as u32);
            self.each.extend(part.each.into_iter().map(|piece| Piece {
                first_vertex: vertex + piece.first_vertex,
                triangles: triangle + piece.triangles.start..triangle + piece.triangles.end,
                ..piece
            }));
            self.triangles.extend(part.triangles);
            vertices.extend(part.vertices);
        }
        Ok(vertices)
    }

    /// Moves the vertices of a mesh whose triangles stay: `indices` is the list that these pieces were cut from. Sorts
    /// nothing, so that it takes a fraction of the time of [`new`](Self::new). Returns whether it could: not where
    /// triangles were [clustered](TriangleOrder::Clustered) within a run of more than 64, where the lists are others
    /// than before, or where [`new`](Self::new) would refuse them. The pieces are of use only if it could.
    pub fn move_to(&mut self, positions: &[[f32; 3]], lists: VertexLists, indices: &[u32]) -> bool {
        let has = |list: &[Vec<f32>], given: bool| list[0].is_empty() != given;
        let fits = !self.reordered
            && self.index_count as usize == indices.len()
            && has(&self.colors, !lists.colors.is_empty())
            && has(&self.uvs, !lists.uvs.is_empty())
            && has(&self.tangents, !lists.tangents.is_empty())
            && check(positions, &lists, indices).is_ok();
        let Some(vertices) = fits.then(|| self.vertices(indices)).flatten() else { return false };
        let VertexLists { normals, colors, uvs, tangents } = lists;
        let normals = if normals.is_empty() { &[[0.0; 3]][..] } else { normals };
        gather(&mut self.positions, positions, &vertices);
        gather(&mut self.normals, normals, &vertices);
        gather(&mut self.colors, colors, &vertices);
        gather(&mut self.uvs, uvs, &vertices);
        gather(&mut self.tangents, tangents, &vertices);
        self.extent = PieceExtent::around(positions.iter().copied());
        self.each.par_iter_mut().with_min_len(16).for_each(|piece| {
            let own = piece.first_vertex as usize..(piece.first_vertex + piece.vertex_count) as usize;
            let triangles = piece.triangles.start as usize..piece.triangles.end as usize;
            let corners = &indices.as_chunks::<3>().0[triangles];
            let points = |corners: &[u32; 3]| corners.map(|corner| positions[corner as usize]);
            piece.extent = PieceExtent::around(vertices[own].iter().map(|&vertex| positions[vertex as usize]));
            piece.cone = cone(corners.iter().map(points));
            piece.opposite_normals = corners.iter().any(|corners| has_opposite_normals(normals, *corners));
        });
        true
    }

    /// Of each vertex of the pieces its number in the mesh, where triangles are in the order of the indices.
    fn vertices(&self, indices: &[u32]) -> Option<Vec<u32>> {
        let mut vertices = Vec::new();
        reserve(&mut vertices, self.positions[0].len(), MEMORY).ok()?;
        vertices.resize(self.positions[0].len(), 0);
        for piece in &self.each {
            let (first, count) = (piece.first_vertex as usize, piece.vertex_count as usize);
            for triangle in piece.triangles.start as usize..piece.triangles.end as usize {
                for (corner, &number) in self.triangles[triangle].iter().enumerate() {
                    vertices[first + usize::from(number)] = indices[3 * triangle + corner];
                }
            }
            // The rest repeats the last vertex.
            let last = vertices[first + count - 1];
            vertices[first + count..first + count.next_multiple_of(ALIGNED)].fill(last);
        }
        Some(vertices)
    }

    /// The bytes of memory that its lists take.
    pub fn bytes(&self) -> u64 {
        let vectors = self.positions.iter().chain(&self.normals);
        let fours = self.colors.iter().chain(&self.uvs).chain(&self.tangents);
        let numbers: usize = vectors.chain(fours).map(Vec::len).sum();
        let [numbers, triangles, pieces] =
            [4 * numbers, 3 * self.triangles.len(), size_of::<Piece>() * self.each.len()];
        (numbers + triangles + pieces) as u64
    }

    pub(crate) fn has_colors(&self) -> bool {
        !self.colors[0].is_empty()
    }

    pub(crate) fn has_uvs(&self) -> bool {
        !self.uvs[0].is_empty()
    }

    pub(crate) fn has_tangents(&self) -> bool {
        !self.tangents[0].is_empty()
    }

    /// How many triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The pieces of a range of indices; `None` if it splits a run.
    pub(crate) fn pieces_in(&self, indices: &Range<u32>) -> Option<Range<usize>> {
        if indices.start > indices.end || indices.end > self.index_count {
            return None;
        }
        let first = self.each.partition_point(|piece| piece.cut.end <= indices.start);
        let end = self.each.partition_point(|piece| piece.cut.start < indices.end);
        let parted = self.each[first..end.max(first)]
            .iter()
            .any(|piece| piece.cut.start < indices.start || piece.cut.end > indices.end);
        (!parted).then_some(first..end.max(first))
    }
}

/// The same of lists that are empty, unless there is nothing to fill them with.
fn fill<const N: usize>(lists: &mut [Vec<f32>; N], of: &[[f32; N]], vertices: &[u32]) -> Result<(), RasterError> {
    if of.is_empty() {
        return Ok(());
    }
    for list in &mut *lists {
        reserve(list, vertices.len(), MEMORY)?;
        list.resize(vertices.len(), 0.0);
    }
    gather(lists, of, vertices);
    Ok(())
}

/// Fills lists of coordinates with those of the numbered vertices; leaves empty ones empty. Of a list of one entry all
/// vertices take that.
fn gather<const N: usize>(lists: &mut [Vec<f32>; N], of: &[[f32; N]], vertices: &[u32]) {
    if lists[0].is_empty() {
        return;
    }
    let mut parts = lists.each_mut().map(|list| list.chunks_mut(GATHERED));
    let parts: Vec<_> = vertices.chunks(GATHERED).map(|own| (own, parts.each_mut().map(Iterator::next))).collect();
    let gather = |(own, mut to): (&[u32], [Option<&mut [f32]>; N])| {
        for (k, &vertex) in own.iter().enumerate() {
            let entry = of[if of.len() == 1 { 0 } else { vertex as usize }];
            for (to, x) in to.iter_mut().flatten().zip(entry) {
                to[k] = x;
            }
        }
    };
    if parts.len() == 1 {
        parts.into_iter().for_each(gather);
    } else {
        parts.into_par_iter().for_each(gather);
    }
}

/// Whether a triangle's normals may cancel. While the products of all pairs are at least −0.49, the square of their
/// mean, by weights u, v and w whose sum is 1, is u² + v² + w² − 0.98·(u·v + v·w + w·u) ≥ 0.0066 at least.
fn has_opposite_normals(normals: &[[f32; 3]], corners: [u32; 3]) -> bool {
    let [a, b, c] = corners.map(|corner| normals.get(corner as usize).copied().unwrap_or_default());
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    dot(a, b).min(dot(b, c)).min(dot(c, a)) < -0.49
}

fn check(positions: &[[f32; 3]], lists: &VertexLists, indices: &[u32]) -> Result<(), RasterError> {
    let VertexLists { normals, colors, uvs, tangents } = lists;
    let finite = |x: f32| x.is_finite();
    let coordinate = ("a coordinate", "a finite number");
    check_numbers("position", coordinate, positions, finite)?;
    check_numbers("normal", coordinate, normals, finite)?;
    check_numbers("texture coordinate", coordinate, uvs, finite)?;
    check_numbers("tangent", coordinate, tangents, finite)?;
    check_numbers("color", ("a channel", "0 to 1"), colors, |x| (0.0..=1.0).contains(&x))?;
    let list_error = |field, reaches: usize, available: usize| {
        let (reaches, available) = (reaches as u64, available as u64);
        Err(RasterError::Reference { what: "mesh", index: 0, field, reaches, available })
    };
    let counts = [
        ("normals", normals.len()),
        ("colors", colors.len()),
        ("texture coordinates", uvs.len()),
        ("tangents", tangents.len()),
    ];
    if let Some((field, count)) = counts.into_iter().find(|&(_, count)| count != 0 && count != positions.len()) {
        return list_error(field, count, positions.len());
    }
    if !indices.len().is_multiple_of(3) || indices.len() > u32::MAX as usize {
        return list_error("the last triangle", indices.len().next_multiple_of(3), indices.len());
    }
    match indices.par_iter().with_min_len(CHECKED).find_first(|&&index| index as usize >= positions.len()) {
        Some(&index) => list_error("an index", index as usize + 1, positions.len()),
        None => Ok(()),
    }
}

fn check_numbers<const N: usize>(
    what: &'static str,
    (field, expected): (&'static str, &'static str),
    list: &[[f32; N]],
    is_sound: impl Fn(f32) -> bool + Sync,
) -> Result<(), RasterError> {
    match list.as_flattened().par_iter().with_min_len(CHECKED).position_first(|&x| !is_sound(x)) {
        Some(at) => {
            let value = f64::from(list[at / N][at % N]);
            Err(RasterError::Number { what, index: at / N, field, value, expected })
        }
        None => Ok(()),
    }
}

/// The mesh that pieces are made of.
#[derive(Clone, Copy)]
struct PieceSource<'a> {
    positions: &'a [[f32; 3]],
    normals: &'a [[f32; 3]],
    indices: &'a [u32],
}

fn reserve<T>(list: &mut Vec<T>, more: usize, what: &'static str) -> Result<(), RasterError> {
    let bytes = (more as u64).saturating_mul(size_of::<T>() as u64);
    list.try_reserve(more).map_err(|_| RasterError::Memory { what, bytes })
}

impl PieceSource<'_> {
    fn corners(&self, triangle: u32) -> [u32; 3] {
        let first = 3 * triangle as usize;
        [self.indices[first], self.indices[first + 1], self.indices[first + 2]]
    }

    fn points(&self, triangle: u32) -> [[f32; 3]; 3] {
        self.corners(triangle).map(|corner| self.positions[corner as usize])
    }

    /// The triangles in the order in which they are drawn; `None` where that is the mesh's.
    fn order(&self, cuts: &[Range<u32>], order: TriangleOrder) -> Result<Option<Vec<u32>>, RasterError> {
        let is_sorted = |cut: &Range<u32>| order == TriangleOrder::Clustered && cut.len() > 3 * PIECE_TRIANGLES;
        if !cuts.iter().any(is_sorted) {
            return Ok(None);
        }
        let mut sorted = Vec::new();
        reserve(&mut sorted, self.indices.len() / 3, MEMORY)?;
        let mut centers = Vec::new();
        for cut in cuts {
            let triangles = cut.start / 3..cut.end / 3;
            if is_sorted(cut) {
                centers.clear();
                reserve(&mut centers, triangles.len(), MEMORY)?;
                centers.extend(triangles.map(|triangle| (box_center(self.points(triangle)), triangle)));
                cluster(&mut centers);
                sorted.extend(centers.iter().map(|&(_, triangle)| triangle));
            } else {
                sorted.extend(triangles);
            }
        }
        Ok(Some(sorted))
    }
}

/// A share of the pieces, which one thread makes: some triangles of a cut, or several whole cuts.
struct Work {
    cuts: Range<usize>,
    triangles: Range<u32>,
}

/// So many triangles are worth a thread; a multiple of a piece's.
const WORTH_A_THREAD: u32 = 32 * PIECE_TRIANGLES as u32;

/// The shares of cuts that have been checked. Within a cut they begin where pieces do.
fn works(cuts: &[Range<u32>]) -> Vec<Work> {
    let mut works: Vec<Work> = Vec::new();
    for (number, cut) in cuts.iter().enumerate() {
        let triangles = cut.start / 3..cut.end / 3;
        match works.last_mut() {
            Some(last) if last.triangles.len() + triangles.len() <= WORTH_A_THREAD as usize => {
                (last.cuts.end, last.triangles.end) = (number + 1, triangles.end);
            }
            _ => {
                let shares = triangles.clone().step_by(WORTH_A_THREAD as usize);
                let end = |first: u32| triangles.end.min(first.saturating_add(WORTH_A_THREAD));
                works.extend(shares.map(|first| Work { cuts: number..number + 1, triangles: first..end(first) }));
            }
        }
    }
    works
}

/// Pieces that one thread has made.
#[derive(Default)]
struct Part {
    each: Vec<Piece>,
    triangles: Vec<[u8; 3]>,
    /// The number in the mesh of each vertex.
    vertices: Vec<u32>,
}

impl Part {
    /// The pieces of these triangles of some cuts. Pieces end where clusters end, also after a piece that was cut short by
    /// its vertices.
    fn new(
        source: PieceSource,
        order: Option<&[u32]>,
        cuts: &[Range<u32>],
        triangles: &Range<u32>,
    ) -> Result<Self, RasterError> {
        let mut part = Self::default();
        reserve(&mut part.triangles, triangles.len(), MEMORY)?;
        let mut own = OwnVertices::new();
        let mut drawn = Vec::with_capacity(PIECE_TRIANGLES);
        for cut in cuts {
            let first = (cut.start / 3).max(triangles.start);
            for at in first..(cut.end / 3).min(triangles.end) {
                let triangle = order.map_or(at, |order| order[at as usize]);
                let corners = source.corners(triangle);
                let is_next = (at - first).is_multiple_of(PIECE_TRIANGLES as u32) && at > first;
                if is_next || own.used.len() + own.count_new(corners) > PIECE_VERTICES {
                    part.finish(source, cut, &mut own, &mut drawn)?;
                }
                part.triangles.push(corners.map(|corner| own.number(corner)));
                drawn.push(triangle);
            }
            part.finish(source, cut, &mut own, &mut drawn)?;
        }
        Ok(part)
    }

    /// Ends a piece, unless it is empty.
    fn finish(
        &mut self,
        source: PieceSource,
        cut: &Range<u32>,
        own: &mut OwnVertices,
        drawn: &mut Vec<u32>,
    ) -> Result<(), RasterError> {
        let Some(&last) = own.used.last() else { return Ok(()) };
        let (first_vertex, end) = (self.vertices.len(), self.triangles.len() as u32);
        let padded = own.used.len().next_multiple_of(ALIGNED);
        reserve(&mut self.vertices, padded, MEMORY)?;
        reserve(&mut self.each, 1, MEMORY)?;
        self.vertices.extend_from_slice(&own.used);
        // The rest repeats the last vertex, so that all numbers are ordinary.
        self.vertices.resize(first_vertex + padded, last);
        let has_opposite = |&triangle: &u32| has_opposite_normals(source.normals, source.corners(triangle));
        self.each.push(Piece {
            cut: cut.clone(),
            first_vertex: first_vertex as u32,
            vertex_count: own.used.len() as u32,
            triangles: end - drawn.len() as u32..end,
            extent: PieceExtent::around(own.used.iter().map(|&vertex| source.positions[vertex as usize])),
            cone: cone(drawn.iter().map(|&triangle| source.points(triangle))),
            opposite_normals: drawn.iter().any(has_opposite),
        });
        own.clear();
        drawn.clear();
        Ok(())
    }
}

/// The vertices of a piece, with numbers of its own: a small hash table, since the mesh may have millions.
struct OwnVertices {
    used: Vec<u32>,
    /// For each place the vertex, its number, and the piece that has put it there.
    places: Vec<(u32, u8, u32)>,
    piece: u32,
}

/// The places of the table: five times as many as vertices.
const PLACES: usize = 512;

impl OwnVertices {
    fn new() -> Self {
        Self { used: Vec::with_capacity(PIECE_VERTICES), places: vec![(0, 0, 0); PLACES], piece: 1 }
    }

    fn clear(&mut self) {
        self.used.clear();
        self.piece += 1;
    }

    /// The place of a vertex, and whether it is there.
    fn place(&self, vertex: u32) -> (usize, bool) {
        // The golden ratio scatters them, whatever the stride of the mesh's rows.
        let mut place = (vertex.wrapping_mul(0x9e37_79b1) >> (32 - PLACES.ilog2())) as usize;
        loop {
            match self.places[place] {
                (there, _, piece) if piece == self.piece && there != vertex => place = (place + 1) % PLACES,
                (_, _, piece) => return (place, piece == self.piece),
            }
        }
    }

    /// The number of a triangle's vertices that the piece does not have yet, 0 to 3.
    fn count_new(&self, corners: [u32; 3]) -> usize {
        corners.into_iter().filter(|&corner| !self.place(corner).1).count()
    }

    /// The number of a vertex, which is added unless it is there.
    fn number(&mut self, vertex: u32) -> u8 {
        let (place, is_there) = self.place(vertex);
        if !is_there {
            self.places[place] = (vertex, self.used.len() as u8, self.piece);
            self.used.push(vertex);
        }
        self.places[place].1
    }
}

impl PieceExtent {
    /// The extent of some points. Lengths are rounded up.
    pub(crate) fn around(points: impl Iterator<Item = [f32; 3]> + Clone) -> Self {
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for point in points.clone() {
            for axis in 0..3 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        if low[0] > high[0] {
            return Self::default();
        }
        let center = [0, 1, 2].map(|axis| 0.5 * low[axis] + 0.5 * high[axis]);
        let from_center = |p: [f32; 3]| [0, 1, 2].map(|axis| f64::from(p[axis]) - f64::from(center[axis]));
        let rounded_up = |length: f64| (length * (1.0 + 1e-6)).min(f64::from(f32::MAX)) as f32;
        let distance2 = |p| from_center(p).map(|x| x * x).iter().sum::<f64>();
        let [below, above] = [low, high].map(from_center);
        Self {
            center,
            radius: rounded_up(points.map(distance2).fold(0.0, f64::max).sqrt()),
            half: [0, 1, 2].map(|axis| rounded_up(above[axis].max(-below[axis]))),
        }
    }
}

/// The cone of the normals of up to 64 triangles, without those that have none.
fn cone(triangles: impl Iterator<Item = [[f32; 3]; 3]>) -> Option<FaceCone> {
    let mut normals = [[0.0; 3]; PIECE_TRIANGLES];
    let mut count = 0;
    for [a, b, c] in triangles {
        let edge = |p: [f32; 3]| [0, 1, 2].map(|axis| f64::from(p[axis]) - f64::from(a[axis]));
        let (e, f) = (edge(b), edge(c));
        if let Some(n) = unit([e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]]) {
            normals[count] = n;
            count += 1;
        }
    }
    let normals = &normals[..count];
    let sum = normals.iter().fold([0.0; 3], |sum, n| [0, 1, 2].map(|axis| sum[axis] + n[axis]));
    let axis = unit(sum)?;
    let least = normals.iter().map(|n| n[0] * axis[0] + n[1] * axis[1] + n[2] * axis[2]).fold(1.0, f64::min);
    // LaneFaces turned by more than this beyond the cone bound nothing; half of it is room for rounding to the pixels'
    // grid.
    let angle = least.clamp(-1.0, 1.0).acos() + 0.03;
    (angle < 1.5).then(|| FaceCone { axis: axis.map(|x| x as f32), sin: angle.sin() as f32, cos: angle.cos() as f32 })
}

fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    (length > 0.0).then(|| v.map(|x| x / length))
}

/// The position of a triangle, the same for equal corners in any order.
fn box_center(points: [[f32; 3]; 3]) -> [f32; 3] {
    [0, 1, 2].map(|axis| {
        let [a, b, c] = points.map(|point| point[axis]);
        0.5 * a.min(b).min(c) + 0.5 * a.max(b).max(c)
    })
}

/// Sorts triangles so that neighbours are adjacent: halves them across the longest side of their box until a piece is
/// left, as a k-d tree does. Triangles at one position keep their order.
fn cluster(triangles: &mut [([f32; 3], u32)]) {
    if triangles.len() <= PIECE_TRIANGLES {
        triangles.sort_unstable_by_key(|&(_, triangle)| triangle);
        return;
    }
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for (center, _) in &*triangles {
        for axis in 0..3 {
            low[axis] = low[axis].min(center[axis]);
            high[axis] = high[axis].max(center[axis]);
        }
    }
    let extent = |axis: usize| high[axis] * 0.5 - low[axis] * 0.5;
    let axis = (1..3).fold(0, |longest, axis| if extent(axis) > extent(longest) { axis } else { longest });
    // Whole pieces on the first side, so that only the last one of a run is not full.
    let half = (triangles.len() / 2).next_multiple_of(PIECE_TRIANGLES).min(triangles.len() - 1);
    triangles.select_nth_unstable_by(half, |a, b| a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1)));
    let (first, second) = triangles.split_at_mut(half);
    cluster(first);
    cluster(second);
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use halfway_mesh::{Mesh, Plane, UvSphere};

    fn cut(mesh: &Mesh) -> Pieces {
        let positions: Vec<_> = mesh.positions().iter().map(|&p| p.into()).collect();
        Pieces::new(&positions, VertexLists::default(), mesh.indices(), &[], TriangleOrder::Clustered)
            .expect("a sound mesh")
    }

    #[test]
    fn pieces_hold_every_triangle_once() {
        let mesh = Mesh::from(UvSphere { radius: 2.0, segments: 96, rings: 48 });
        let pieces = cut(&mesh);
        let corner = |piece: &Piece, number: u8| {
            [0, 1, 2].map(|axis| pieces.positions[axis][piece.first_vertex as usize + usize::from(number)].to_bits())
        };
        let mut found: Vec<_> = pieces
            .each
            .iter()
            .flat_map(|piece| {
                let range = piece.triangles.start as usize..piece.triangles.end as usize;
                pieces.triangles[range].iter().map(move |triangle| triangle.map(|number| corner(piece, number)))
            })
            .collect();
        let mut expected: Vec<_> =
            mesh.triangles().map(|t| t.map(|i| mesh.positions()[i as usize].to_array().map(f32::to_bits))).collect();
        found.sort_unstable();
        expected.sort_unstable();
        assert!(found == expected, "triangles were lost, repeated or turned");
    }

    #[test]
    fn moved_pieces_are_those_of_the_moved_mesh() {
        let mut mesh = Mesh::from(UvSphere { radius: 2.0, segments: 96, rings: 48 });
        let mut triangles: Vec<_> = mesh.triangles().collect();
        let runs = mesh.cut_into_patches(&mut triangles, PIECE_TRIANGLES);
        let cuts: Vec<_> = runs.iter().map(|run| 3 * run.start as u32..3 * run.end as u32).collect();
        let indices = triangles.as_flattened();
        let made = |mesh: &Mesh, before: Option<Pieces>| {
            let positions: Vec<_> = mesh.positions().iter().map(|&p| p.into()).collect();
            let normals: Vec<_> = mesh.normals().iter().map(|&n| n.into()).collect();
            let lists = VertexLists { normals: &normals, ..VertexLists::default() };
            before.map_or_else(
                || Pieces::new(&positions, lists, indices, &cuts, TriangleOrder::Clustered).expect("a sound mesh"),
                |mut before| {
                    assert!(before.move_to(&positions, lists, indices));
                    before
                },
            )
        };
        let before = made(&mesh, None);
        let stretched = mesh.positions().iter().map(|p| Vec3::new(p.x, p.y + (3.0 * p.x).sin(), 2.0 * p.z));
        mesh.set_positions(stretched.collect()).expect("as many");
        mesh.set_normals(mesh.normals().iter().map(|n| -*n).collect()).expect("as many");
        let (moved, fresh) = (made(&mesh, Some(before.clone())), made(&mesh, None));
        assert_eq!(format!("{moved:?}"), format!("{fresh:?}"));
        assert_ne!(format!("{moved:?}"), format!("{before:?}"));
        // Triangles that were clustered here have lost their order.
        assert!(!cut(&mesh).move_to(&[[0.0; 3]; 3], VertexLists::default(), mesh.indices()));
    }

    #[test]
    fn pieces_are_small_and_full() {
        // 64 triangles are 32 cells of edge 1: at most 4 × 8 of them, with half a diagonal of 4.5, or 11 × 3.
        let pieces = cut(&Mesh::from(Plane { size: 64.0, divisions: 64 }));
        assert_eq!(pieces.each.len(), 2 * 64 * 64 / PIECE_TRIANGLES);
        let largest = pieces.each.iter().map(|piece| piece.extent.radius).fold(0.0, f32::max);
        assert!(largest < 6.0, "{largest}");
        let sphere = cut(&Mesh::from(UvSphere { radius: 1.0, segments: 512, rings: 256 }));
        let largest = sphere.each.iter().map(|piece| piece.extent.radius).fold(0.0, f32::max);
        assert!(sphere.each.len() < 4_200 && largest < 0.08, "{} pieces, {largest}", sphere.each.len());
    }
}

//! Surfaces as functions of two parameters, and their meshes.

use glam::{DVec3, Vec2, Vec3};

use super::{Disc, Parameter, Surface, SurfaceError, SurfaceField, SurfacePiece, SurfacePoint};
use crate::{Mesh, face_normal};

/// A surface p(u, v), u and v from 0 to 1, in f64.
///
/// u runs from row to row of its mesh, v along a row; the outward side is that of ∂p/∂v × ∂p/∂u. Seen from outside with
/// v running left, u runs down: a texture that covers the whole surface has the coordinates (1 − v, u).
///
/// ```
/// use glam::{DVec2, DVec3};
/// use halfway_mesh::{Parameter, ParametricSurface, SurfacePiece, SurfacePoint, Tessellation};
///
/// /// A helicoid: a line that turns as it rises.
/// struct Helicoid;
///
/// impl ParametricSurface for Helicoid {
///     fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
///         let (sin, cos) = (6.0 * v.value()).sin_cos();
///         let along = DVec3::new(cos, 0.0, sin);
///         let du = along;
///         let dv = u.value() * 6.0 * DVec3::new(-sin, 0.0, cos) + DVec3::Y;
///         SurfacePoint {
///             position: u.value() * along + v.value() * DVec3::Y,
///             du,
///             dv,
///             normal: dv.cross(du).normalize(),
///             uv: DVec2::new(v.complement(), u.value()),
///         }
///     }
///     fn pieces(&self) -> Option<Vec<SurfacePiece>> {
///         None
///     }
/// }
///
/// let stairs = Helicoid.mesh(Tessellation::Count { rows: 8, columns: 64 })?;
/// assert_eq!(stairs.triangle_count(), 2 * 8 * 64);
/// # Ok::<(), halfway_mesh::SurfaceError>(())
/// ```
pub trait ParametricSurface {
    /// Everything about the point p(u, v).
    ///
    /// Unspecified if [`validate`](Self::validate) refuses the surface.
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint;

    /// Checks that every field is in its range: all lengths from 1e-30 to 1e30, none more than 10⁵ times another, since
    /// `f32` could no longer tell their ends apart.
    ///
    /// # Errors
    /// Names the first field out of range.
    fn validate(&self) -> Result<(), SurfaceError> {
        Ok(())
    }

    /// The fewest rows and columns of cells that show its shape.
    fn least_counts(&self) -> [u32; 2] {
        [1, 1]
    }

    /// The discs that close its ends.
    fn caps(&self) -> Vec<Disc> {
        Vec::new()
    }

    /// The pieces of a [`Surface`](super::Surface) that are exactly p, without the caps; `None` if there are no such
    /// pieces.
    fn pieces(&self) -> Option<Vec<SurfacePiece>>;

    /// Its mesh, with its caps: a grid of cells of two triangles each, which at a pole have one.
    ///
    /// Vertices lie row by row; seams and poles are repeated at equal positions, because they have several texture
    /// coordinates. Triangles that are degenerate in `f32` are left out.
    ///
    /// # Errors
    /// A field of the surface or of the tessellation is out of its range.
    fn mesh(&self, tessellation: Tessellation) -> Result<Mesh, SurfaceError>
    where
        Self: Sized,
    {
        tessellate(&[self], tessellation)
    }
}

/// The fineness of the triangles of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tessellation {
    /// Into this many cells.
    Count {
        /// Along u, at most [`Tessellation::MAX_ROWS`].
        rows: u32,
        /// Along v, at most [`Tessellation::MAX_COLUMNS`].
        columns: u32,
    },
    /// As coarsely as keeps every point of the surface within this distance of the plane of its triangle, and its
    /// border within it of an edge; in the units of the surface, positive.
    ///
    /// Measured at the middle and along the edges of every triangle, with a margin of a twentieth for the points
    /// between. At the greatest counts it stops, with a warning in the log.
    ChordError(f64),
}

impl Tessellation {
    /// The most rows of cells.
    pub const MAX_ROWS: u32 = 2048;
    /// The most columns of cells; more would be more than eight million vertices.
    pub const MAX_COLUMNS: u32 = 4096;

    /// Checks the counts for a surface with these fewest counts.
    fn validate(self, [least_rows, least_columns]: [u32; 2]) -> Result<(), SurfaceError> {
        match self {
            Self::Count { rows, columns } => {
                let field = |name, value, range| SurfaceField::count("Tessellation", name, value, range);
                field("rows", rows, least_rows..=Self::MAX_ROWS).check()?;
                field("columns", columns, least_columns..=Self::MAX_COLUMNS).check()
            }
            Self::ChordError(length) if length > 0.0 && length.is_finite() => Ok(()),
            Self::ChordError(length) => Err(error("chord error", length, "a positive length is expected".to_owned())),
        }
    }
}

fn error(field: &'static str, value: f64, expected: String) -> SurfaceError {
    SurfaceError { surface: "Tessellation", field, value, expected }
}

/// The most cells of a mesh; each has six indices, which a draw call counts in 32 bits.
const MOST_CELLS: u64 = u32::MAX as u64 / 6;

/// One mesh of several surfaces and their caps. All have as many columns, so that common edges are closed.
///
/// It has a [`Surface`](super::Surface) if each of them does.
///
/// ```
/// use halfway_mesh::{Capsule, Tessellation, Torus, tessellate};
///
/// let planet = Capsule { radius: 1.0, length: 0.1 };
/// let ring = Torus { radius: 2.0, tube: 0.1 };
/// let mesh = tessellate(&[&planet, &ring], Tessellation::Count { rows: 24, columns: 48 })?;
/// assert_eq!(mesh.report().pieces, 2);
/// # Ok::<(), halfway_mesh::SurfaceError>(())
/// ```
///
/// # Errors
/// No surface, a field of a surface or of the tessellation that is out of its range, or more than 700 million cells.
pub fn tessellate(surfaces: &[&dyn ParametricSurface], tessellation: Tessellation) -> Result<Mesh, SurfaceError> {
    let caps: Vec<_> = surfaces.iter().flat_map(|surface| surface.caps()).collect();
    let caps = caps.iter().map(|cap| cap as &dyn ParametricSurface);
    let all: Vec<&dyn ParametricSurface> = surfaces.iter().copied().chain(caps).collect();
    let mut counts = Vec::with_capacity(all.len());
    for (i, part) in all.iter().enumerate() {
        part.validate()?;
        let least = part.least_counts();
        tessellation.validate(least)?;
        counts.push(match tessellation {
            // A cap is flat: one row is exact.
            Tessellation::Count { columns, .. } if i >= surfaces.len() => [1, columns],
            Tessellation::Count { rows, columns } => [rows, columns],
            Tessellation::ChordError(error) => {
                counts_for(*part, error, [Tessellation::MAX_ROWS, Tessellation::MAX_COLUMNS])
            }
        });
    }
    let columns = counts.iter().map(|count| count[1]).max().unwrap_or(0);
    let cells: u64 = counts.iter().map(|[rows, _]| u64::from(*rows) * u64::from(columns)).sum();
    if cells > MOST_CELLS {
        return Err(error("cells", cells as f64, format!("at most {MOST_CELLS} of all surfaces are expected")));
    }
    let mut grids = Grids::default();
    for (part, [rows, _]) in all.iter().zip(counts) {
        grids.add(rows, columns, |u, v| part.at(u, v).into());
    }
    let pieces: Option<Vec<Vec<SurfacePiece>>> = all.iter().map(|part| part.pieces()).collect();
    let mesh = grids.mesh()?;
    Ok(match pieces {
        Some(pieces) => mesh.with_surface(Surface::new(pieces.into_iter().flatten())),
        None => mesh,
    })
}

/// A vertex under construction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    pub(super) position: Vec3,
    pub(super) normal: Vec3,
    pub(super) uv: Vec2,
}

impl From<SurfacePoint> for Vertex {
    fn from(point: SurfacePoint) -> Self {
        Self { position: point.position.as_vec3(), normal: point.normal.as_vec3(), uv: point.uv.as_vec2() }
    }
}

/// Grids of cells that become one mesh.
#[derive(Default)]
pub(super) struct Grids {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    indices: Vec<u32>,
}

impl Grids {
    /// Adds a grid. Of a cell with the vertices a b in one row and c d in the next the triangles are (a, b, c) and
    /// (b, d, c), but for degenerate ones.
    pub(super) fn add(&mut self, rows: u32, columns: u32, vertex: impl Fn(Parameter, Parameter) -> Vertex) {
        let first = self.positions.len() as u32;
        for i in 0..=rows {
            for j in 0..=columns {
                let Vertex { position, normal, uv } =
                    vertex(Parameter::fraction(i, rows), Parameter::fraction(j, columns));
                self.positions.push(position);
                self.normals.push(normal);
                self.uvs.push(uv);
            }
        }
        for i in 0..rows {
            for j in 0..columns {
                let a = first + i * (columns + 1) + j;
                let (b, c, d) = (a + 1, a + columns + 1, a + columns + 2);
                self.add_triangle([a, b, c]);
                self.add_triangle([b, d, c]);
            }
        }
    }

    fn add_triangle(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|i| self.positions[i as usize]);
        if face_normal(a, b, c).is_some() {
            self.indices.extend(corners);
        }
    }

    pub(super) fn mesh(self) -> Result<Mesh, SurfaceError> {
        if self.indices.is_empty() {
            return Err(error("triangles", 0.0, "a surface with an area is expected".to_owned()));
        }
        Ok(Mesh::checked(self.positions, self.normals, Some(self.uvs), self.indices))
    }
}

/// The fraction of the chord error that is allowed at the samples.
const SPENT: f64 = 0.95;

/// From this number of rows or columns on, the samples are trusted. A surface that oscillates within larger cells may
/// pass through their samples, and is also measured in cells of half the size.
const CERTAIN: u32 = 16;

/// The fewest rows and columns, approximately, that keep the chord error, and at most `most`.
pub(super) fn counts_for(surface: &dyn ParametricSurface, error: f64, most: [u32; 2]) -> [u32; 2] {
    let allowed = SPENT * error;
    let mut counts = surface.least_counts();
    loop {
        let deviation = ChordDeviation::measure(surface, counts);
        if deviation.most <= allowed {
            let finer = counts.map(|count| 2 * count);
            if counts.into_iter().max() >= Some(CERTAIN) || ChordDeviation::measure(surface, finer).most <= allowed {
                return counts;
            }
            counts = finer;
            continue;
        }
        // Deviations fall with the square of the counts, and those along u and along v add up in the middle of a cell.
        // The cells are fewest where both are half of the allowance, or where one gets what the other does not need.
        let finer = |axis: usize, along: f64, across: f64| {
            let room = (allowed - across).max(0.5 * allowed);
            let wanted = (f64::from(counts[axis]) * (along / room).sqrt().min(16.0)).ceil() as u32;
            wanted.max(counts[axis]).min(most[axis])
        };
        let ChordDeviation { along_u, along_v, .. } = deviation;
        let mut next = [finer(0, along_u, along_v), finer(1, along_v, along_u)];
        if next == counts {
            // The remaining deviation comes from the twist of the cells.
            next = [0, 1].map(|axis| (counts[axis] + counts[axis] / 8 + 1).min(most[axis]));
        }
        if next == counts {
            let [rows, columns] = counts;
            log::warn!("a chord error of {error} takes more than {rows} × {columns} cells; {} is left", deviation.most);
            return counts;
        }
        counts = next;
    }
}

/// The distance of a surface from the triangles of a tessellation.
struct ChordDeviation {
    /// At the middles of the edges along u.
    along_u: f64,
    /// At the middles of the edges along v.
    along_v: f64,
    /// Anywhere.
    most: f64,
}

impl ChordDeviation {
    fn measure(surface: &dyn ParametricSurface, [rows, columns]: [u32; 2]) -> Self {
        // Vertices and edge middles are every other point of a grid that is twice as fine, the middles of triangles
        // every sixth.
        let at =
            |i: u32, j: u32| surface.at(Parameter::fraction(i, 6 * rows), Parameter::fraction(j, 6 * columns)).position;
        let mut deviation = Self { along_u: 0.0, along_v: 0.0, most: 0.0 };
        for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (6 * i, 6 * j))) {
            let (a, b, c, d) = (at(i, j), at(i, j + 6), at(i + 6, j), at(i + 6, j + 6));
            let upper = ChordTriangle::new([a, b, c]);
            let lower = ChordTriangle::new([b, d, c]);
            let (top, left) = (at(i, j + 3), at(i + 3, j));
            let (bottom, right) = (at(i + 6, j + 3), at(i + 3, j + 6));
            let mut along_u = upper.distance(left).max(lower.distance(right));
            let mut along_v = upper.distance(top).max(lower.distance(bottom));
            // The border has no neighbour that would cover the points beside an edge.
            for (on_border, middle, ends) in [(j == 0, left, [a, c]), (j + 6 == 6 * columns, right, [b, d])] {
                along_u = along_u.max(if on_border { from_edge(middle, ends) } else { 0.0 });
            }
            for (on_border, middle, ends) in [(i == 0, top, [a, b]), (i + 6 == 6 * rows, bottom, [c, d])] {
                along_v = along_v.max(if on_border { from_edge(middle, ends) } else { 0.0 });
            }
            let center = at(i + 3, j + 3);
            let inside = [upper.distance(center), upper.distance(at(i + 2, j + 2)), lower.distance(at(i + 4, j + 4))];
            deviation.along_u = deviation.along_u.max(along_u);
            deviation.along_v = deviation.along_v.max(along_v);
            deviation.most = inside.into_iter().fold(deviation.most.max(along_u).max(along_v), f64::max);
        }
        deviation
    }
}

/// The plane of a triangle.
struct ChordTriangle {
    corner: DVec3,
    /// 0 if the triangle is a line or a point: then its neighbours cover it.
    normal: DVec3,
}

impl ChordTriangle {
    fn new([a, b, c]: [DVec3; 3]) -> Self {
        Self { corner: a, normal: (b - a).cross(c - a).normalize_or_zero() }
    }

    fn distance(&self, p: DVec3) -> f64 {
        (p - self.corner).dot(self.normal).abs()
    }
}

fn from_edge(p: DVec3, [from, to]: [DVec3; 2]) -> f64 {
    (p - from).reject_from_normalized((to - from).normalize_or_zero()).length()
}

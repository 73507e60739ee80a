//! Heights over a rectangle.

use glam::{DVec2, DVec3};

use super::parameter::uv_at;
use super::{
    BezierPatch, Parameter, ParametricSurface, SurfaceError, SurfaceField, SurfacePiece, SurfacePoint, Tessellation,
    check_lengths,
};

/// Heights over a rectangle in the plane y = 0 that is centred on the origin; it faces +Y.
///
/// Samples lie row by row from −z to +z, in a row from −x to +x. Between them the surface follows Catmull–Rom splines
/// in both directions (E. Catmull and R. Rom, "A class of local interpolating splines", 1974): it passes through every
/// sample, and its normals are continuous. Beyond the border it continues linearly.
///
/// u runs from −z to +z, v from +x to −x.
///
/// ```
/// use halfway_mesh::{HeightField, ParametricSurface, Tessellation};
///
/// let heights = vec![0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
/// let hill = HeightField::new(10.0, 10.0, 3, heights)?;
/// let mesh = hill.mesh(Tessellation::Count { rows: 16, columns: 16 })?;
/// assert_eq!(mesh.bounds().max.y, 1.0);
/// # Ok::<(), halfway_mesh::SurfaceError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct HeightField {
    size: DVec2,
    columns: usize,
    heights: Vec<f32>,
}

/// A field of more cells is not made into a [`Surface`](super::Surface): each cell is a patch of 16 points.
const MOST_PIECES: usize = 1 << 16;

/// As many rows as a mesh may have.
const MOST_ROWS: usize = Tessellation::MAX_ROWS as usize + 1;

impl HeightField {
    /// The field of these samples, `columns` in a row, over a rectangle of lengths `x` and `z`.
    ///
    /// # Errors
    /// A length out of 1e-30 … 1e30 or more than 10⁵ times the other; fewer than two rows or columns, more than 2049
    /// rows or 4097 columns, or a row that is not full; a height that is not from −1e29 to 1e29.
    pub fn new(x: f32, z: f32, columns: u32, heights: Vec<f32>) -> Result<Self, SurfaceError> {
        check_lengths("HeightField", &[("x", x), ("z", z)])?;
        SurfaceField::count("HeightField", "columns", columns, 2..=Tessellation::MAX_COLUMNS + 1).check()?;
        let error =
            |value, expected: String| SurfaceError { surface: "HeightField", field: "heights", value, expected };
        let columns = columns as usize;
        if !heights.len().is_multiple_of(columns) || !(2..=MOST_ROWS).contains(&(heights.len() / columns)) {
            let expected = format!("2 to {MOST_ROWS} full rows of {columns} heights are expected");
            return Err(error(heights.len() as f64, expected));
        }
        if let Some(&bad) = heights.iter().find(|height| !(-1e29..=1e29).contains(*height)) {
            return Err(error(f64::from(bad), "heights from -1e29 to 1e29 are expected".to_owned()));
        }
        Ok(Self { size: DVec2::new(f64::from(x), f64::from(z)), columns, heights })
    }

    fn rows(&self) -> usize {
        self.heights.len() / self.columns
    }

    /// How many cells there are along u and along v.
    fn cells(&self) -> [usize; 2] {
        [self.rows() - 1, self.columns - 1]
    }

    /// The height in a row from −z and a column from +x; extrapolated linearly one step beyond the border.
    fn height(&self, row: isize, column: isize) -> f64 {
        let beyond = |at: isize, count: usize| match at {
            -1 => Some((0, 1)),
            at if at == count as isize => Some((at - 1, at - 2)),
            _ => None,
        };
        if let Some((last, before)) = beyond(row, self.rows()) {
            return 2.0 * self.height(last, column) - self.height(before, column);
        }
        if let Some((last, before)) = beyond(column, self.columns) {
            return 2.0 * self.height(row, last) - self.height(row, before);
        }
        f64::from(self.heights[row as usize * self.columns + (self.columns - 1 - column as usize)])
    }

    /// The bicubic patch over a cell.
    fn cell(&self, i: usize, j: usize) -> BezierPatch {
        // The control heights between p1 and p2 of a Catmull–Rom spline through p0 … p3.
        let controls = |[p0, p1, p2, p3]: [f64; 4]| [p1, p1 + (p2 - p0) / 6.0, p2 - (p3 - p1) / 6.0, p2];
        let at = |k: usize, l: usize| self.height((i + k) as isize - 1, (j + l) as isize - 1);
        let in_rows = [0, 1, 2, 3].map(|k| controls([0, 1, 2, 3].map(|l| at(k, l))));
        let in_columns = [0, 1, 2, 3].map(|l| controls([0, 1, 2, 3].map(|k| in_rows[k][l])));
        let [along_u, along_v] = self.cells().map(|count| (3 * count) as f64);
        let points = (0..4).flat_map(|k| (0..4).map(move |l| (k, l))).map(|(k, l)| {
            let (u, v) = ((3 * i + k) as f64 / along_u, (3 * j + l) as f64 / along_v);
            DVec3::new(self.size.x * (0.5 - v), in_columns[l][k], self.size.y * (u - 0.5))
        });
        // A spline is never ten times as high as its samples.
        BezierPatch::new(4, points.collect()).expect("four rows of four points in range")
    }
}

impl ParametricSurface for HeightField {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let counts = self.cells();
        let locate = |at: Parameter, count: usize| {
            let along = at.value() * count as f64;
            let cell = (along.floor().max(0.0) as usize).min(count - 1);
            (cell, Parameter::from(along - cell as f64))
        };
        let ((i, local_u), (j, local_v)) = (locate(u, counts[0]), locate(v, counts[1]));
        let point = self.cell(i, j).at(local_u, local_v);
        SurfacePoint { du: point.du * counts[0] as f64, dv: point.dv * counts[1] as f64, uv: uv_at(u, v), ..point }
    }

    /// One for each cell between samples.
    fn least_counts(&self) -> [u32; 2] {
        self.cells().map(|count| count as u32)
    }

    /// Also `None` for more than 65,536 cells.
    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        let [rows, columns] = self.cells();
        let all = (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j)));
        (rows * columns <= MOST_PIECES).then(|| all.map(|(i, j)| SurfacePiece::Patch(self.cell(i, j))).collect())
    }
}

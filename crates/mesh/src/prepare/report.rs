//! A report on a mesh.

use std::fmt;

use glam::Vec3;

use super::components::Components;
use crate::edges::Edges;
use crate::{Bounds, Mesh, Problems};

/// The figures and problems of a mesh. `Display` writes a line for each group of figures, without a final line break.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshReport {
    /// The number of triangles.
    pub triangles: usize,
    /// The number of vertices.
    pub vertices: usize,
    /// The number of different positions.
    pub positions: usize,
    /// The number of edges, told apart by the positions of their ends.
    pub edges: usize,
    /// The box around all vertices.
    pub bounds: Bounds,
    /// The shortest, mean and longest edge.
    pub edge_lengths: [f64; 3],
    /// The area of all triangles.
    pub area: f64,
    /// The volume inside the closed components, each added separately.
    pub volume: f64,
    /// The connected components: triangles joined by edges of exactly two triangles.
    pub pieces: usize,
    /// The components that are closed.
    pub closed: usize,
    /// The closed components that are inside out.
    pub inward: usize,
    /// Triangles that [`Mesh::repaired`] would flip.
    pub to_turn: usize,
    /// Edges whose two triangles cannot be oriented consistently, because their component is not orientable.
    pub conflicts: usize,
    /// Triangles whose front faces away from the mean of their vertex normals.
    pub against_normals: usize,
    /// The problems found.
    pub problems: Problems,
}

impl Mesh {
    /// Measures and checks the mesh. Takes time and memory in proportion to its size.
    ///
    /// ```
    /// use halfway_mesh::{Mesh, UvSphere};
    ///
    /// let report = Mesh::from(UvSphere::new(1.0, 32, 16)).report();
    /// assert_eq!((report.pieces, report.closed, report.inward), (1, 1, 0));
    /// assert!((report.area - 4.0 * std::f64::consts::PI).abs() < 0.2);
    /// println!("{report}");
    /// ```
    pub fn report(&self) -> MeshReport {
        let (groups, edges) = self.position_edges();
        let position = |point: u32| self.positions()[groups.firsts[point as usize] as usize];
        let components = Components::new(&edges, position);
        let (edge_count, edge_lengths) = measure_edges(&edges, position);
        let closed = || components.pieces.iter().filter(|piece| piece.closed);
        MeshReport {
            triangles: self.triangle_count(),
            vertices: self.positions().len(),
            positions: groups.count(),
            edges: edge_count,
            bounds: self.bounds(),
            edge_lengths,
            area: self.area(),
            volume: closed().fold(0.0, |sum, piece| sum + piece.volume),
            pieces: components.pieces.len(),
            closed: closed().count(),
            inward: closed().filter(|piece| piece.inward).count(),
            to_turn: components.turn.iter().filter(|&&turn| turn).count(),
            conflicts: components.conflicts,
            against_normals: self.against_normals(),
            problems: self.problems(&groups, &edges),
        }
    }

    /// The area of all triangles.
    fn area(&self) -> f64 {
        let area = |corners: [Vec3; 3]| {
            let [a, b, c] = corners.map(Vec3::as_dvec3);
            0.5 * (b - a).cross(c - a).length()
        };
        self.triangle_corners().map(area).sum()
    }
}

/// How many edges there are, and the shortest, mean and longest; all 0 where there are none.
fn measure_edges(edges: &Edges, position: impl Fn(u32) -> Vec3) -> (usize, [f64; 3]) {
    let (mut count, mut shortest, mut sum, mut longest) = (0, f64::INFINITY, 0.0, 0.0_f64);
    for edge in edges.iter() {
        let [a, b] = edge.ends.map(|point| position(point).as_dvec3());
        let length = a.distance(b);
        count += 1;
        shortest = shortest.min(length);
        sum += length;
        longest = longest.max(length);
    }
    if count == 0 { (0, [0.0; 3]) } else { (count, [shortest, sum / count as f64, longest]) }
}

impl fmt::Display for MeshReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { triangles, vertices, positions, edges, bounds, edge_lengths, .. } = self;
        let [shortest, mean, longest] = edge_lengths;
        writeln!(f, "shape      {triangles} triangles, {vertices} vertices at {positions} positions, {edges} edges")?;
        writeln!(f, "bounds     {} to {}, size {}", bounds.min, bounds.max, bounds.size())?;
        writeln!(f, "edges      {shortest:.4e} to {longest:.4e} long, mean {mean:.4e}")?;
        writeln!(f, "extent     area {:.6e}, volume {:.6e} in closed pieces", self.area, self.volume)?;
        writeln!(f, "pieces     {}, {} closed, {} of them inside out", self.pieces, self.closed, self.inward)?;
        write!(f, "winding    {} triangles to turn, ", self.to_turn)?;
        writeln!(f, "{} edges in conflict, {} against their normals", self.conflicts, self.against_normals)?;
        write!(f, "problems   {}", self.problems)
    }
}

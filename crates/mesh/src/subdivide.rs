//! Subdivision: each triangle becomes four.

use glam::{DVec3, Vec3};

use crate::edges::{Edge, Edges, next_corner};
use crate::normals::{Fans, face_normals};
use crate::numbering::Numbering;
use crate::{Mesh, MeshError, NormalWeighting};

/// The rule by which subdivision places vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Subdivision {
    /// New vertices in the middle of the edges: the shape stays, and so does its shading up to the rounding of the
    /// mean normals. The default.
    #[default]
    Midpoint,
    /// Loop 1987, "Smooth subdivision surfaces based on triangles": the shape becomes ever smoother, and has a
    /// continuous normal in the limit. Edges stay sharp at borders, where more than two triangles meet or two have
    /// opposite windings, and where the normals on both sides differ by more than a degree; sharp rows of edges become
    /// cubic B-splines, and vertices of three sharp edges or more stay in place (Hoppe et al. 1994, "Piecewise smooth
    /// surface reconstruction"). Normals are of the default weighting, separate on both sides of sharp edges.
    Loop,
}

impl Subdivision {
    /// The most triangles that subdivision may make.
    pub const MAX_TRIANGLES: u64 = 1 << 24;
}

/// An edge whose two normals differ by more than a degree is sharp.
const SHARP_COSINE: f32 = 0.999_847_7;

impl Mesh {
    /// The mesh with each triangle cut into four, `times` times over; the four of triangle i are 4i … 4i + 3.
    ///
    /// Texture coordinates and colours are interpolated linearly. Tangents are dropped.
    ///
    /// ```
    /// use halfway_mesh::{Icosphere, Mesh, Subdivision};
    ///
    /// let icosahedron = Mesh::from(Icosphere::new(1.0, 1));
    /// let smooth = icosahedron.subdivided(Subdivision::Loop, 3)?;
    /// assert_eq!(smooth.triangle_count(), 20 * 4_usize.pow(3));
    /// # Ok::<(), halfway_mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// More than [`Subdivision::MAX_TRIANGLES`] triangles.
    pub fn subdivided(&self, scheme: Subdivision, times: u32) -> Result<Self, MeshError> {
        let most = Subdivision::MAX_TRIANGLES;
        let count = (self.triangle_count() as u64).saturating_mul(4_u64.saturating_pow(times));
        if count > most {
            return Err(MeshError::TooFine { count, times, most });
        }
        let mut mesh = self.clone();
        for _ in 0..times {
            mesh = mesh.subdivided_once(scheme);
        }
        Ok(if scheme == Subdivision::Loop && times > 0 { mesh.with_sharp_normals() } else { mesh })
    }

    fn subdivided_once(&self, scheme: Subdivision) -> Self {
        let indices = self.indices();
        // One new vertex for each pair of vertices that a side joins; across a seam there are two.
        let middles = Numbering::new(indices.len(), |corner| {
            let (from, to) = (indices[corner], indices[next(corner)]);
            [from.min(to), from.max(to)]
        });
        let pairs = middles.firsts.iter().map(|&corner| corner as usize).map(|c| [indices[c], indices[next(c)]]);
        let extended = self.extended(pairs, quartered(indices, self.positions().len() as u32, &middles.numbers));
        match scheme {
            Subdivision::Midpoint => extended,
            Subdivision::Loop => {
                let positions = self.loop_positions(&middles);
                extended.with_given_positions(positions)
            }
        }
    }

    /// The positions of the old vertices and of the middles by Loop's rules.
    fn loop_positions(&self, middles: &Numbering) -> Vec<Vec3> {
        let (groups, edges) = self.position_edges();
        let p = |point: u32| self.positions()[groups.firsts[point as usize] as usize].as_dvec3();
        let mut rings = vec![Ring::default(); groups.count()];
        // By pass; a side between equal positions is not an edge, and its middle is there as well.
        let mut middle: Vec<DVec3> = (0..self.indices().len() as u32).map(|corner| p(edges.point(corner))).collect();
        for edge in edges.iter() {
            let [a, b] = edge.ends;
            let smooth = self.smooth_passes(&edges, &edge);
            let place = match smooth {
                Some(passes) => {
                    let [c, d] = passes.map(|pass| p(edges.opposite(pass)));
                    0.375 * (p(a) + p(b)) + 0.125 * (c + d)
                }
                None => 0.5 * (p(a) + p(b)),
            };
            edge.passes.iter().for_each(|&pass| middle[pass as usize] = place);
            rings[a as usize].add(p(b), smooth.is_none());
            rings[b as usize].add(p(a), smooth.is_none());
        }
        let old = groups.numbers.iter().map(|&group| rings[group as usize].moved(p(group)));
        let new = middles.firsts.iter().map(|&corner| middle[corner as usize]);
        old.chain(new).map(DVec3::as_vec3).collect()
    }

    /// The two passes of an edge that is not sharp.
    fn smooth_passes(&self, edges: &Edges, edge: &Edge) -> Option<[u32; 2]> {
        let passes = edges.regular(edge)?;
        let [a, b] = passes.map(|pass| edges.corners(pass));
        let n = |corner: u32| self.normals()[self.indices()[corner as usize] as usize];
        (0..2).all(|end| n(a[end]).dot(n(b[end])) >= SHARP_COSINE).then_some(passes)
    }

    /// Normals of the default weighting, separate on both sides of sharp edges.
    fn with_sharp_normals(&self) -> Self {
        let (_, edges) = self.position_edges();
        let mut fans = Fans::new(&edges);
        for [a, b] in edges.iter().filter_map(|edge| self.smooth_passes(&edges, &edge)) {
            fans.join(&edges, a, b);
        }
        let faces = face_normals(self.positions(), self.indices());
        fans.normals(self, edges, faces, NormalWeighting::default()).0
    }
}

fn next(corner: usize) -> usize {
    next_corner(corner as u32) as usize
}

/// Each triangle in four. `middles` has the number of the new vertex on the side that begins at each corner; new
/// vertices come after the old ones.
fn quartered(indices: &[u32], vertices: u32, middles: &[u32]) -> Vec<u32> {
    let corners = indices.as_chunks::<3>().0.iter().zip(middles.as_chunks::<3>().0);
    let four = |(&[a, b, c], sides): (&[u32; 3], &[u32; 3])| {
        let [ab, bc, ca] = sides.map(|side| vertices + side);
        [a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca]
    };
    corners.flat_map(four).collect()
}

/// The neighbours of a vertex.
#[derive(Clone, Copy, Default)]
struct Ring {
    sum: DVec3,
    count: f64,
    sharp_sum: DVec3,
    sharp: u32,
}

impl Ring {
    fn add(&mut self, neighbour: DVec3, sharp: bool) {
        self.sum += neighbour;
        self.count += 1.0;
        if sharp {
            self.sharp_sum += neighbour;
            self.sharp += 1;
        }
    }

    /// The vertex at `p` moved by Loop's rules. A single sharp edge, which ends there, counts as smooth.
    fn moved(&self, p: DVec3) -> DVec3 {
        match self.sharp {
            _ if self.count == 0.0 => p,
            0 | 1 => {
                let cosine = 0.375 + 0.25 * (std::f64::consts::TAU / self.count).cos();
                let share = 0.625 - cosine * cosine;
                (1.0 - share) * p + share / self.count * self.sum
            }
            2 => 0.75 * p + 0.125 * self.sharp_sum,
            _ => p,
        }
    }
}

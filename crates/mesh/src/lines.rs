//! Lines and points.

use std::sync::Arc;

use glam::{Vec3, Vec4};

use crate::mesh::{check_attribute, check_count};
use crate::{Bounds, MeshError};

/// Lines and points: vertices with a position and perhaps a unit normal and a colour, straight lines from one vertex to
/// another, and vertices that are shown as points.
///
/// It holds at least one line or point, and every vertex that it names is there; numbers are finite. Clones share their
/// data.
///
/// ```
/// use glam::{Vec3, Vec4};
/// use halfway_mesh::Lines;
///
/// // A triangle of wire with a blob at its first corner.
/// let wire = Lines::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1], [1, 2], [2, 0]], vec![0])?;
/// assert_eq!((wire.segments().len(), wire.points(), wire.bounds().max), (3, &[0][..], Vec3::new(1.0, 1.0, 0.0)));
/// // A cloud of points, coloured from black to white.
/// let cloud = Lines::cloud((0..10).map(|i| Vec3::X * i as f32).collect())?;
/// let cloud = cloud.with_colors((0..10).map(|i| (Vec3::ONE * i as f32 / 9.0).extend(1.0)).collect::<Vec<Vec4>>())?;
/// assert_eq!(cloud.points().len(), 10);
/// # Ok::<(), halfway_mesh::MeshError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Lines(Arc<LinesData>);

#[derive(Clone, Debug, PartialEq)]
struct LinesData {
    positions: Vec<Vec3>,
    normals: Option<Vec<Vec3>>,
    colors: Option<Vec<Vec4>>,
    segments: Vec<[u32; 2]>,
    points: Vec<u32>,
    bounds: Bounds,
}

impl Lines {
    /// Lines between these pairs of vertices, and these vertices as points, both counted from 0.
    ///
    /// # Errors
    /// Neither a line nor a point, one that names a vertex that is not there, a position that is not finite, or more of
    /// them than 32 bits count.
    pub fn new(positions: Vec<Vec3>, segments: Vec<[u32; 2]>, points: Vec<u32>) -> Result<Self, MeshError> {
        check_count("vertices", positions.len())?;
        check_count("lines", segments.len())?;
        check_count("points", points.len())?;
        check_attribute("position", positions.len(), positions.iter().map(Vec3::to_array))?;
        if segments.is_empty() && points.is_empty() {
            return Err(MeshError::NoLines);
        }
        let vertices = positions.len();
        let check = |element, number, index: u32| {
            if (index as usize) < vertices {
                Ok(())
            } else {
                Err(MeshError::NoSuchVertex { element, number, index, vertices })
            }
        };
        for (number, ends) in segments.iter().enumerate() {
            ends.iter().try_for_each(|&end| check("line", number, end))?;
        }
        for (number, &point) in points.iter().enumerate() {
            check("point", number, point)?;
        }
        let used = segments.iter().flatten().chain(&points).map(|&vertex| positions[vertex as usize]);
        let bounds = Bounds::from_points(used).ok_or(MeshError::NoLines)?;
        Ok(Self(Arc::new(LinesData { positions, normals: None, colors: None, segments, points, bounds })))
    }

    /// All of these as points.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn cloud(positions: Vec<Vec3>) -> Result<Self, MeshError> {
        check_count("vertices", positions.len())?;
        let points = (0..positions.len() as u32).collect();
        Self::new(positions, Vec::new(), points)
    }

    /// Lines from each of these to the next.
    ///
    /// # Errors
    /// As [`new`](Self::new): of fewer than two there is no line.
    pub fn path(positions: Vec<Vec3>) -> Result<Self, MeshError> {
        check_count("vertices", positions.len())?;
        let segments = (1..positions.len() as u32).map(|end| [end - 1, end]).collect();
        Self::new(positions, segments, Vec::new())
    }

    /// The same with a normal a vertex, by which lights are reflected; they are scaled to unit length, and those without a
    /// direction stay 0: such vertices face the viewer.
    ///
    /// # Errors
    /// Not one normal a vertex, or one that is not finite.
    pub fn with_normals(self, mut normals: Vec<Vec3>) -> Result<Self, MeshError> {
        check_attribute("normal", self.positions().len(), normals.iter().map(Vec3::to_array))?;
        for n in &mut normals {
            // In f64, where no finite f32 vector under- or overflows; unit vectors keep their bits.
            let length = n.as_dvec3().length();
            if (length - 1.0).abs() >= 1e-7 {
                *n = n.as_dvec3().normalize_or_zero().as_vec3();
            }
        }
        Ok(self.changed(|data| data.normals = Some(normals)))
    }

    /// The same with a colour a vertex: linear RGB and opacity.
    ///
    /// # Errors
    /// Not one colour a vertex, or one that is not finite.
    pub fn with_colors(self, colors: Vec<Vec4>) -> Result<Self, MeshError> {
        let vertices = self.positions().len();
        check_attribute("colour", vertices, colors.iter().map(|c| c.truncate().to_array()))?;
        check_attribute("opacity", vertices, colors.iter().map(|c| [c.w, 0.0, 0.0]))?;
        Ok(self.changed(|data| data.colors = Some(colors)))
    }

    fn changed(mut self, change: impl FnOnce(&mut LinesData)) -> Self {
        change(Arc::make_mut(&mut self.0));
        self
    }

    /// The positions of the vertices.
    pub fn positions(&self) -> &[Vec3] {
        &self.0.positions
    }

    /// The normals of the vertices, of unit length or 0; `None`: lights do not count.
    pub fn normals(&self) -> Option<&[Vec3]> {
        self.0.normals.as_deref()
    }

    /// The colours of the vertices: linear RGB and opacity.
    pub fn colors(&self) -> Option<&[Vec4]> {
        self.0.colors.as_deref()
    }

    /// The two vertices of each line.
    pub fn segments(&self) -> &[[u32; 2]] {
        &self.0.segments
    }

    /// The vertices that are shown as points.
    pub fn points(&self) -> &[u32] {
        &self.0.points
    }

    /// The box around all lines and points.
    pub fn bounds(&self) -> Bounds {
        self.0.bounds
    }

    /// Where the data is: equal for clones.
    #[cfg(feature = "formats")]
    pub(crate) fn address(&self) -> *const Vec3 {
        self.0.positions.as_ptr()
    }
}

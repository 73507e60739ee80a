//! Tangents, for normal maps.

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{DVec3, Vec2, Vec3, Vec4};

use crate::numbering::Numbering;
use crate::{Mesh, MeshError};

impl Mesh {
    /// The mesh with a tangent t a vertex by `MikkTSpace` (Mikkelsen 2008, "Simulation of wrinkled surfaces
    /// revisited"), the tangents of normal maps in glTF and most tools.
    ///
    /// x, y, z of a tangent are a unit vector toward which u grows, perpendicular to the normal n; w is 1 or −1, so
    /// that w·(n × t) points up in the image, where v decreases. Vertices are split where the triangles around them
    /// have different tangents, as on the seam of a mirrored texture, and unused ones are dropped. If the texture
    /// coordinates give no direction, an arbitrary vector perpendicular to n is used. Triangles keep their order; the
    /// result does not depend on the size of the mesh.
    ///
    /// ```
    /// use glam::Vec4;
    /// use halfway_mesh::{Mesh, Plane};
    ///
    /// let plane = Mesh::from(Plane::default()).with_tangents()?;
    /// assert_eq!(plane.tangents().expect("just made")[0], Vec4::new(1.0, 0.0, 0.0, 1.0));
    /// # Ok::<(), halfway_mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// The mesh has no texture coordinates.
    pub fn with_tangents(self) -> Result<Self, MeshError> {
        self.with_tangents_of(0)
    }

    /// [`with_tangents`](Self::with_tangents) for another [set](Self::uv_set) of texture coordinates.
    ///
    /// # Errors
    /// The mesh does not have it.
    pub fn with_tangents_of(self, set: usize) -> Result<Self, MeshError> {
        let uvs = self.uv_set(set).ok_or(MeshError::NoUvs)?;
        let tangents = Corners::tangents(&self, uvs);
        let vertices = Numbering::new(tangents.len(), |corner| {
            let [x, y, z, w] = tangents[corner].to_array().map(f32::to_bits);
            [self.indices()[corner], x, y, z, w]
        });
        let sources: Vec<u32> = vertices.firsts.iter().map(|&corner| self.indices()[corner as usize]).collect();
        let tangents = vertices.firsts.iter().map(|&corner| tangents[corner as usize]).collect();
        Ok(self.selected(&sources, vertices.numbers).with_given_tangents(tangents))
    }
}

/// The mesh as the algorithm sees it, and the tangents that it computes for each corner.
struct Corners<'a> {
    mesh: &'a Mesh,
    positions: Vec<[f32; 3]>,
    uvs: &'a [Vec2],
    tangents: Vec<Vec4>,
}

impl<'a> Corners<'a> {
    /// The tangent of each corner.
    fn tangents(mesh: &'a Mesh, uvs: &'a [Vec2]) -> Vec<Vec4> {
        let (positions, tangents) = (unit_positions(mesh), vec![Vec4::ZERO; mesh.indices().len()]);
        let mut corners = Self { mesh, positions, uvs, tangents };
        generate_tangents(&mut corners).expect("it has no errors to give");
        corners.tangents
    }

    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.indices()[3 * face + corner] as usize
    }
}

/// The positions moved and scaled into the cube from −1 to 1, where single precision neither under- nor overflows.
fn unit_positions(mesh: &Mesh) -> Vec<[f32; 3]> {
    let (min, max) = (mesh.bounds().min.as_dvec3(), mesh.bounds().max.as_dvec3());
    let center = 0.5 * (min + max);
    let unit = (0.5 * (max - min)).max_element();
    let unit = if unit > 0.0 { unit } else { 1.0 };
    let place = |p: &Vec3| ((p.as_dvec3() - center) / unit).clamp(DVec3::NEG_ONE, DVec3::ONE).as_vec3().to_array();
    mesh.positions().iter().map(place).collect()
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangle_count()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.positions[self.vertex(face, corner)]
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals()[self.vertex(face, corner)].to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.uvs[self.vertex(face, corner)].to_array()
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        let n = self.mesh.normals()[self.vertex(face, corner)];
        // The algorithm's w·(n × t) is the direction in which v grows.
        let (t, w) = space.map_or((Vec3::ZERO, 1.0), |space| {
            let [x, y, z, w] = space.tangent_encoded();
            (Vec3::new(x, y, z), -w)
        });
        let t = (t - n * n.dot(t)).try_normalize().unwrap_or_else(|| n.any_orthonormal_vector());
        self.tangents[3 * face + corner] = t.extend(w);
    }
}

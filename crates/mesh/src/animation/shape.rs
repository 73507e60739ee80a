//! Vertices that morph targets and skins move (glTF 2.0 §3.7.2.2 and §3.7.3.3).

use glam::{DMat3, DMat4, DVec3, Vec3, Vec4};

use crate::{Bounds, Mesh, NormalWeighting, Normals};

/// A mesh with what moves its vertices: morph targets, and the influences of joints.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shape {
    /// The mesh before anything moves it.
    pub(crate) mesh: Mesh,
    /// Whether the file has normals, which are moved; otherwise they are made anew.
    pub(crate) has_normals: bool,
    pub(crate) targets: Vec<MorphTarget>,
    pub(crate) influences: Option<Influences>,
}

/// Displacements of all vertices; lists that the file does not have are empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct MorphTarget {
    pub(crate) positions: Vec<Vec3>,
    pub(crate) normals: Vec<Vec3>,
    pub(crate) tangents: Vec<Vec3>,
}

/// The joints that move each vertex: as many for each, and weights that are not negative, of which one at least is
/// above 0. They count by their sum.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Influences {
    per_vertex: usize,
    joints: Vec<u16>,
    weights: Vec<f32>,
}

/// Four joints a vertex, and their weights.
pub(crate) type JointSet = (Vec<[u16; 4]>, Vec<[f32; 4]>);

/// Vertices that were moved.
pub(crate) struct Moved {
    pub(crate) positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    tangents: Vec<Vec4>,
}

impl Influences {
    /// The influences of sets of four joints and weights a vertex. A vertex without any weight follows its first joint.
    pub(crate) fn new(sets: &[JointSet]) -> Self {
        let vertices = sets.iter().map(|(joints, _)| joints.len()).min().unwrap_or(0);
        let mut all = Self { per_vertex: 4 * sets.len(), ..Self::default() };
        for vertex in 0..vertices {
            let first = all.weights.len();
            for (joints, weights) in sets {
                all.joints.extend(joints[vertex]);
                all.weights
                    .extend(weights[vertex].map(|weight| if weight.is_finite() { weight.max(0.0) } else { 0.0 }));
            }
            let weights = &mut all.weights[first..];
            if weights.iter().all(|weight| *weight == 0.0) {
                weights[0] = 1.0;
            }
        }
        all
    }

    /// The sets that it was made of.
    pub(crate) fn sets(&self) -> impl Iterator<Item = JointSet> {
        let (joints, weights) = (self.joints.as_chunks().0, self.weights.as_chunks().0);
        let sets = self.per_vertex / 4;
        (0..sets).map(move |set| {
            let joints = joints.iter().skip(set).step_by(sets).copied().collect();
            (joints, weights.iter().skip(set).step_by(sets).copied().collect())
        })
    }

    /// The greatest number of a joint that moves a vertex.
    pub(crate) fn greatest_joint(&self) -> u16 {
        let used = self.joints.iter().zip(&self.weights).filter(|(_, weight)| **weight > 0.0);
        used.map(|(joint, _)| *joint).max().unwrap_or(0)
    }

    /// The matrix that moves a vertex.
    fn matrix(&self, vertex: usize, joints: &[DMat4]) -> DMat4 {
        let range = vertex * self.per_vertex..(vertex + 1) * self.per_vertex;
        let weights = &self.weights[range.clone()];
        let sum: f64 = weights.iter().map(|weight| f64::from(*weight)).sum();
        // Scaled here, so that writers have the numbers of the file.
        let scaled = weights.iter().map(|weight| f64::from((f64::from(*weight) / sum) as f32));
        let used = self.joints[range].iter().zip(scaled).filter(|(_, weight)| *weight > 0.0);
        used.filter_map(|(joint, weight)| Some(*joints.get(usize::from(*joint))? * weight)).sum()
    }
}

impl Shape {
    /// The vertices under these weights of the targets, and moved by these matrices of the joints.
    pub(crate) fn moved(&self, weights: &[f32], joints: Option<&[DMat4]>) -> Moved {
        let used: Vec<(f64, &MorphTarget)> =
            weights.iter().map(|weight| f64::from(*weight)).zip(&self.targets).collect();
        let displaced = |vertex: usize, base: Vec3, list: fn(&MorphTarget) -> &[Vec3]| {
            let each = used.iter().filter(|(weight, _)| *weight != 0.0);
            let moves = each.filter_map(|(weight, target)| Some(list(target).get(vertex)?.as_dvec3() * *weight));
            base.as_dvec3() + moves.sum::<DVec3>()
        };
        let skin = self.influences.as_ref().zip(joints);
        let given_tangents = self.mesh.tangents().unwrap_or_default();
        let mut moved = Moved { positions: Vec::new(), normals: Vec::new(), tangents: Vec::new() };
        for (vertex, (&p, &n)) in self.mesh.positions().iter().zip(self.mesh.normals()).enumerate() {
            let matrix = skin.map(|(influences, joints)| influences.matrix(vertex, joints));
            let p = displaced(vertex, p, |target| &target.positions);
            moved.positions.push(matrix.map_or(p, |matrix| matrix.transform_point3(p)));
            let linear = matrix.map(DMat3::from_mat4);
            if self.has_normals {
                let n = displaced(vertex, n, |target| &target.normals);
                moved.normals.push(linear.map_or(n, |linear| turned(linear, n)));
            }
            if let Some(t) = given_tangents.get(vertex) {
                let direction = displaced(vertex, t.truncate(), |target| &target.tangents);
                let direction = linear.map_or(direction, |linear| linear * direction).normalize_or(DVec3::X);
                moved.tangents.push(direction.as_vec3().extend(t.w));
            }
        }
        moved
    }
}

/// A normal under a linear map: by the transpose of its inverse, times what is above 0.
fn turned(linear: DMat3, n: DVec3) -> DVec3 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = linear;
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    let turned = cofactors * n;
    if x.dot(y.cross(z)) < 0.0 { -turned } else { turned }
}

impl Moved {
    /// The box around the vertices that triangles use.
    pub(crate) fn bounds(&self, shape: &Shape) -> [DVec3; 2] {
        let used = shape.mesh.indices().iter().map(|index| self.positions[*index as usize]);
        used.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[min, max], p| [min.min(p), max.max(p)])
    }

    /// Takes a point from all positions.
    pub(crate) fn shift(&mut self, origin: DVec3) {
        self.positions.iter_mut().for_each(|p| *p -= origin);
    }

    /// The mesh with these vertices; `None` where they leave the range of f32.
    pub(crate) fn mesh(self, shape: &Shape) -> Option<Mesh> {
        let mut mesh = shape.mesh.clone();
        mesh.set_positions(self.positions.iter().map(|p| p.as_vec3()).collect()).ok()?;
        let normals = self.normals.iter().map(|n| n.normalize_or_zero().as_vec3()).collect();
        if !shape.has_normals || mesh.set_normals(normals).is_err() {
            let (mesh, _) = mesh.with_normals(Normals::Weighted(NormalWeighting::default()));
            return Some(mesh.with_normals_as_default());
        }
        Some(if self.tangents.is_empty() { mesh } else { mesh.with_given_tangents(self.tangents) })
    }
}

/// The corners of a box, placed in f64.
pub(crate) fn corners(bounds: &Bounds, place: &DMat4) -> [DVec3; 8] {
    std::array::from_fn(|i| {
        let pick = |axis: usize| if i & (1 << axis) == 0 { bounds.min[axis] } else { bounds.max[axis] };
        place.transform_point3(Vec3::new(pick(0), pick(1), pick(2)).as_dvec3())
    })
}

//! Patches: large meshes in pieces that lie close together and face alike, so that each can have light lists of its own
//! and be left out when it is not seen.

use crate::geometry::corners::{CountedCorners, ShadedCorners};
use crate::geometry::shape::{ANGLE_SLACK, PatchShape, sphere_around};
use crate::lights::gains::Extent;
use crate::view::camera::View;
use crate::view::matrices::ModelView;
use bevy_math::Vec3;
use halfway_lighting::Faces;
use halfway_lighting::equations::vector::length;
use halfway_mesh::{Bounds, Mesh, face_normal};
use std::ops::Range;

/// A run of triangles of a mesh and what is known of them, in model space.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MeshPatch {
    /// Its part of the index list.
    pub(crate) indices: Range<u32>,
    pub(crate) shape: PatchShape,
    facing: Facing,
    /// Its longest edge; of a patch of the mesh itself infinite, as nobody asks.
    pub(crate) longest_edge: f32,
    /// How far its points are from the nearest corners of their triangles, likewise.
    pub(crate) corner_reach: f32,
    /// The sum of the areas of its triangles, and how many vertices they have.
    area: f32,
    vertices: u32,
}

/// Which way triangles face: from where none of them shows its front, or none its back.
///
/// A triangle shows its front to the eye at e where n·(e − p) > 0, n its normal and p any of its points. With c the
/// centre of the patch and v = e − c, that is n·v + n·(c − p). The largest n·v of all triangles is a convex function of
/// v, twice as large for twice the v; so where v = Σ wᵢ dᵢ with no wᵢ below 0, it is at most Σ wᵢ times its value for
/// dᵢ. It is known for 18 directions d, the corners and the middles of edges of an octahedron, of which the three
/// around v serve. A cone around the normals is wider: it is as round as their farthest one is far.
#[derive(Clone, Debug, PartialEq)]
struct Facing {
    /// The largest n·d of all triangles for each of [`Facing::DIRECTIONS`].
    most: [f32; 18],
    /// The largest n·(c − p) of all, and the largest −n·(c − p).
    beyond: [f32; 2],
}

impl Facing {
    /// Numbered by the signs of their coordinates, 1 where they are negative: ±x, ±y, ±z; then ±x ± y, ±x ± z, ±y ± z.
    const DIRECTIONS: [Vec3; 18] = {
        const fn d(x: i32, y: i32, z: i32) -> Vec3 {
            Vec3::new(x as f32, y as f32, z as f32)
        }
        [
            d(1, 0, 0),
            d(-1, 0, 0),
            d(0, 1, 0),
            d(0, -1, 0),
            d(0, 0, 1),
            d(0, 0, -1),
            d(1, 1, 0),
            d(1, -1, 0),
            d(-1, 1, 0),
            d(-1, -1, 0),
            d(1, 0, 1),
            d(1, 0, -1),
            d(-1, 0, 1),
            d(-1, 0, -1),
            d(0, 1, 1),
            d(0, 1, -1),
            d(0, -1, 1),
            d(0, -1, -1),
        ]
    };

    /// Of triangles that may face anywhere.
    const UNKNOWN: Self = Self { most: [f32::INFINITY; 18], beyond: [f32::INFINITY; 2] };

    /// Of triangles with these normals, whose corners are so far from the centre of the patch.
    fn new(triangles: impl Iterator<Item = (Vec3, [Vec3; 3])>) -> Self {
        let mut facing = Self { most: [f32::NEG_INFINITY; 18], beyond: [f32::NEG_INFINITY; 2] };
        for (n, offsets) in triangles {
            for (most, d) in facing.most.iter_mut().zip(Self::DIRECTIONS) {
                *most = most.max(n.dot(d));
            }
            for height in offsets.map(|offset| n.dot(offset)) {
                facing.beyond = [facing.beyond[0].max(-height), facing.beyond[1].max(height)];
            }
        }
        facing
    }

    /// Of all of these, around centres that are so far from the centre of all.
    fn around<'a>(parts: impl Iterator<Item = (&'a Self, f32)>) -> Self {
        let mut facing = Self { most: [f32::NEG_INFINITY; 18], beyond: [f32::NEG_INFINITY; 2] };
        for (part, away) in parts {
            facing.most = std::array::from_fn(|i| facing.most[i].max(part.most[i]));
            facing.beyond = std::array::from_fn(|i| facing.beyond[i].max(part.beyond[i] + away));
        }
        facing
    }

    /// Whether no triangle turns its front, or its `back`, to an eye that is so far from the centre of the patch.
    fn hides(&self, eye: Vec3, back: bool) -> bool {
        let v = if back { -eye } else { eye };
        let [x, y, z] = v.to_array().map(|at| usize::from(at < 0.0));
        let Vec3 { x: a, y: b, z: c } = v.abs();
        let [of_x, of_y, of_z] = [x, 2 + y, 4 + z].map(|i| self.most[i]);
        let [of_xy, of_xz, of_yz] = [6 + 2 * x + y, 10 + 2 * x + z, 14 + 2 * y + z].map(|i| self.most[i]);
        let most = if a >= b + c {
            (a - b - c) * of_x + b * of_xy + c * of_xz
        } else if b >= a + c {
            (b - a - c) * of_y + a * of_xy + c * of_yz
        } else if c >= a + b {
            (c - a - b) * of_z + a * of_xz + b * of_yz
        } else {
            0.5 * ((a + b - c) * of_xy + (a + c - b) * of_xz + (b + c - a) * of_yz)
        };
        most + self.beyond[usize::from(back)] < -ANGLE_SLACK * (a + b + c)
    }
}

/// From where, and which sides of an object are seen: what tells whether a patch of it shows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight<'a> {
    model_view: &'a ModelView,
    view: &'a View,
    /// The eye in model space, and whether back faces are drawn rather than front faces; `None` where both are or the
    /// transform has no inverse.
    eye: Option<(Vec3, bool)>,
    /// None of it is beside the picture.
    is_inside: bool,
}

impl<'a> Sight<'a> {
    /// Of an object; `whole` is all of it.
    pub(crate) fn new(model_view: &'a ModelView, view: &'a View, faces: Faces, whole: &MeshPatch) -> Self {
        let side = match faces {
            Faces::Both => None,
            Faces::Front => Some(false),
            Faces::Back => Some(true),
        };
        // In single precision the determinant leaves the number range where a scale is 7·10¹² or 10⁻¹³.
        let eye = model_view.eye_from_model.as_daffine3().inverse().translation.as_vec3();
        let eye = side.filter(|_| eye.is_finite()).map(|back| (eye, back));
        let (center, radius) = whole.shape.sphere(model_view);
        Self { model_view, view, eye, is_inside: view.projection.holds(center, radius) }
    }

    /// An upper bound of how many pixels a way of a unit of the mesh takes, anywhere in the sphere around a patch where
    /// the picture shows it; no less for a patch whose sphere holds another's. A way of length e at (x, y, −z) in eye
    /// space moves its end by at most f·e/z·√(1 + (x² + y²)/z²), f pixels being the way of a point at depth 1 that
    /// moves by 1.
    pub(crate) fn pixels_per_unit(&self, patch: &MeshPatch) -> f32 {
        let View { projection, pixels_at_unit_depth, .. } = self.view;
        let (center, radius) = patch.shape.sphere(self.model_view);
        let [x, y] = projection.scale;
        let nearest = (-center.z - radius).max(projection.near);
        let aside2 = (center.truncate().length() + radius).powi(2) / (nearest * nearest);
        let slope2 = aside2.min(1.0 / (x * x) + 1.0 / (y * y));
        pixels_at_unit_depth * self.model_view.largest_scale() * (1.0 + slope2).sqrt() / nearest
    }
}

impl MeshPatch {
    /// What is known of some triangles, which begin at `first` in the index list.
    pub(crate) fn new(mesh: &Mesh, triangles: &[[u32; 3]], first: u32) -> Self {
        let vertices = || triangles.as_flattened().iter().map(|&i| i as usize);
        let points = || vertices().map(|i| mesh.positions()[i]);
        let center = Bounds::from_points(points()).map_or(Vec3::ZERO, |bounds| bounds.center());
        let faces = triangles.iter().filter_map(|corners| {
            let corners = corners.map(|i| mesh.positions()[i as usize]);
            let n = face_normal(corners[0], corners[1], corners[2])?;
            Some((n, corners.map(|p| p - center)))
        });
        let faces: Vec<(Vec3, [Vec3; 3])> = faces.collect();
        let facing = Facing::new(faces.iter().copied());
        let faces: Vec<Vec3> = faces.into_iter().map(|(n, _)| n).collect();
        let area = triangles.iter().map(|corners| {
            let [a, b, c] = corners.map(|i| mesh.positions()[i as usize]);
            0.5 * (b - a).cross(c - a).length()
        });
        let area = area.sum();
        Self {
            indices: first..first + 3 * triangles.len() as u32,
            shape: PatchShape::new(mesh, triangles, center, &faces),
            facing,
            longest_edge: f32::INFINITY,
            corner_reach: f32::INFINITY,
            area,
            vertices: count_of(vertices()),
        }
    }

    /// All of a mesh, of whose normals nothing is known.
    pub(crate) fn whole(mesh: &Mesh) -> Self {
        let center = mesh.bounds().center();
        let farthest = mesh.positions().iter().map(|p| length((*p - center).to_array())).fold(0.0, f32::max);
        let indices = 0..mesh.indices().len() as u32;
        Self {
            indices,
            shape: PatchShape::sphere_alone((center, farthest * (1.0 + 1e-5))),
            facing: Facing::UNKNOWN,
            longest_edge: f32::INFINITY,
            corner_reach: f32::INFINITY,
            area: 0.0,
            vertices: 0,
        }
    }

    /// What is known of all of these together, one or more, which follow each other; and its sphere is no smaller than
    /// to hold those of `others`.
    pub(crate) fn around<'a>(patches: &'a [Self], others: impl Iterator<Item = &'a Self> + Clone) -> Self {
        let (center, radius) = sphere_around(patches.iter().chain(others).map(|patch| &patch.shape));
        let ends = patches.first().zip(patches.last()).map_or(0..0, |(a, b)| a.indices.start..b.indices.end);
        Self {
            indices: ends,
            shape: PatchShape::sphere_alone((center, radius)),
            facing: Facing::around(
                patches.iter().map(|patch| (&patch.facing, length((patch.shape.center - center).to_array()))),
            ),
            longest_edge: f32::INFINITY,
            corner_reach: f32::INFINITY,
            area: 0.0,
            vertices: 0,
        }
    }

    /// Which corners it is shaded at, where it is coarser than the mesh and small enough on the picture.
    pub(crate) fn counted(&self, corners: ShadedCorners, sight: &Sight) -> Option<CountedCorners> {
        corners.counted([self.longest_edge, self.corner_reach], || sight.pixels_per_unit(self))
    }

    /// About how many pixels its triangles cover, where nothing hides them; and its vertices.
    pub(crate) fn extent(&self, sight: &Sight) -> Extent {
        let View { projection, pixels_at_unit_depth, .. } = sight.view;
        let (center, _) = self.shape.sphere(sight.model_view);
        let depth = (-center.z).max(projection.near);
        let pixels = sight.model_view.largest_scale() * pixels_at_unit_depth / depth;
        let facing = sight
            .eye
            .zip(self.shape.faces)
            .map_or(0.5, |((eye, _), cone)| (eye - self.shape.center).normalize_or_zero().dot(cone.axis).abs());
        Extent { pixels: self.area * facing * pixels * pixels, vertices: self.vertices as f32 }
    }

    /// Whether any of it may show: it reaches into the frustum, and not all its triangles turn the side away that is
    /// drawn. Never false for one that shows.
    pub(crate) fn is_seen(&self, sight: &Sight) -> bool {
        if !sight.is_inside {
            let (center, radius) = self.shape.sphere(sight.model_view);
            if !sight.view.projection.sees(center, radius) {
                return false;
            }
        }
        sight.eye.is_none_or(|(eye, back)| !self.facing.hides(eye - self.shape.center, back))
    }
}

fn count_of(vertices: impl Iterator<Item = usize>) -> u32 {
    let mut numbers: Vec<usize> = vertices.collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers.len() as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::detail::MeshTriangles;
    use halfway_mesh::{Plane, UvSphere};

    fn cut_whole(mesh: &Mesh) -> (Vec<[u32; 3]>, Vec<MeshPatch>) {
        let MeshTriangles { corners, detail, .. } = MeshTriangles::in_patches(mesh);
        (corners.to_vec(), detail.patches().to_vec())
    }

    #[test]
    fn small_meshes_are_whole_and_in_order() {
        let mesh = Mesh::from(UvSphere::new(1.0, 32, 16));
        let (triangles, patches) = cut_whole(&mesh);
        assert_eq!(triangles, mesh.triangles().collect::<Vec<_>>());
        assert_eq!(patches.len(), 1);
        assert_eq!(patches[0].indices, 0..mesh.indices().len() as u32);
    }

    #[test]
    fn patches_hold_every_triangle_once_and_all_that_is_said_of_them() {
        for mesh in [Mesh::from(UvSphere::new(2.0, 96, 48)), Mesh::from(Plane { size: 200.0, divisions: 64 })] {
            let (triangles, patches) = cut_whole(&mesh);
            let sorted = |mut triangles: Vec<[u32; 3]>| {
                triangles.sort_unstable();
                triangles
            };
            assert_eq!(sorted(triangles.clone()), sorted(mesh.triangles().collect()));
            let mut end = 0;
            for patch in &patches {
                assert_eq!(patch.indices.start, end);
                end = patch.indices.end;
                assert!(patch.shape.faces.is_some() && patch.shape.normals.is_some(), "they lie together");
                for corners in &triangles[patch.indices.start as usize / 3..end as usize / 3] {
                    let [a, b, c] = corners.map(|i| mesh.positions()[i as usize]);
                    let face = face_normal(a, b, c);
                    for i in corners.map(|i| i as usize) {
                        assert!(patch.shape.holds(mesh.positions()[i], mesh.normals()[i], face));
                    }
                }
            }
            assert_eq!(end as usize, 3 * triangles.len());
        }
    }

    #[test]
    fn patches_are_small() {
        let (_, patches) = cut_whole(&Mesh::from(Plane { size: 64.0, divisions: 64 }));
        // 64 triangles are 32 cells of edge 1: at most 4 × 8 of them, with half a diagonal of 4.5, or 11 × 3.
        assert!(patches.iter().all(|patch| patch.shape.radius < 6.0), "{patches:?}");
        assert!(patches.iter().all(|patch| patch.shape.normals.is_some_and(|cone| cone.half_thickness == 0.0)));
    }
}

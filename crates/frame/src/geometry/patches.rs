//! Patches: runs of neighbouring triangles of a mesh, each of which is culled by itself and has its own light lists.

use crate::geometry::outlines::{Facing, Outline, Sight};
use crate::geometry::shape::PatchShape;
use bevy_math::Vec3;
use halfway_mesh::{Bounds, LodGroup, LodHierarchy, Mesh, face_normal};
use rayon::prelude::*;
use std::any::Any;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A mesh's triangles in the order in which they are drawn: patch by patch. A clone shares them.
#[derive(Clone)]
pub struct MeshTriangles {
    /// Three vertices a triangle, patch by patch; empty where they are the mesh's own list
    /// ([`Patches::are_unsorted`]).
    pub corners: Arc<Vec<[u32; 3]>>,
    /// The patches.
    pub patches: Arc<Patches>,
    /// The same as the CPU draws them, where they have been made ready beside the frames.
    pub pieces: Option<Prepared>,
}

/// A mesh with levels of detail as a renderer takes it, made in the background; only that renderer knows its type.
pub type Prepared = Arc<dyn Any + Send + Sync>;

/// The patches of a mesh.
#[derive(Debug)]
pub struct Patches {
    shapes: Vec<PatchShape>,
    outlines: Vec<Outline>,
    /// The first index of each patch, and the end of the last.
    starts: Vec<u32>,
    /// Neighbouring patches, which are culled together before each is tested.
    groups: Vec<PatchGroup>,
    /// `None` where all patches are the mesh's own.
    levels: Option<Levels>,
    /// The outline of the whole mesh.
    pub(crate) whole: Outline,
    /// Whether the triangles are in the order of the mesh because sorting them would not pay.
    unsorted: bool,
    /// How large the patches are together, measured by the mesh, when the triangles were sorted into them.
    spread: f32,
}

#[derive(Debug)]
struct PatchGroup {
    outline: Outline,
    patches: Range<u32>,
}

/// Patches of which some stand for others: the clusters of a [`LodHierarchy`].
#[derive(Debug)]
struct Levels {
    /// For each patch the group that it is a simplified version of, or [`FINEST`].
    sources: Vec<u32>,
    groups: Vec<LodGroup>,
}

/// The demands that the level of detail of an object depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DetailDemand {
    /// The allowed displacement of points, in pixels; 0 for the mesh itself.
    pub(crate) pixels: f32,
    pub(crate) lit: bool,
    pub(crate) has_images: bool,
}

/// A simplified version of no group, but of the mesh itself.
const FINEST: u32 = u32::MAX;

/// Patches are made anew once they are so many times as large as they were, measured by the mesh.
const WIDER: f32 = 1.5;

/// So many patches are measured by one thread, at least.
const FEWEST: usize = 16;

/// So many neighbouring patches are a group.
const GROUP: usize = 8;

impl MeshTriangles {
    /// The mesh as a single patch, in the order of its triangles.
    pub(crate) fn in_order(mesh: &Mesh) -> Self {
        let corners: Vec<_> = mesh.triangles().collect();
        let patches = Patches::new(mesh, &corners, std::iter::once(0..corners.len()));
        Self::new(corners, patches)
    }

    /// The same, without a look at the triangles: they may face anywhere. No copy is made of their corners.
    pub(crate) fn unmeasured(mesh: &Mesh) -> Self {
        let whole = Outline::whole(mesh);
        let patches = Patches {
            shapes: vec![PatchShape::facing_anywhere(mesh.bounds().center(), whole.radius())],
            outlines: vec![whole],
            starts: vec![0, mesh.indices().len() as u32],
            groups: vec![PatchGroup { outline: whole, patches: 0..1 }],
            levels: None,
            whole,
            unsorted: true,
            spread: 1.0,
        };
        Self::new(Vec::new(), patches)
    }

    /// The mesh cut into patches.
    pub(crate) fn in_patches(mesh: &Mesh) -> Self {
        let mut corners: Vec<_> = mesh.triangles().collect();
        let runs = mesh.cut_into_patches(&mut corners, mesh.triangles_of_a_patch());
        let patches = Patches::new(mesh, &corners, runs.into_iter());
        Self::new(corners, patches)
    }

    /// The mesh with its levels of detail, or `None` where `stop` has become true.
    pub(crate) fn in_levels(mesh: &Mesh, stop: &AtomicBool) -> Option<Self> {
        let LodHierarchy { triangles, clusters, groups } = mesh.lod_hierarchy(stop)?;
        let runs = clusters.iter().map(|cluster| cluster.triangles.start as usize..cluster.triangles.end as usize);
        let mut patches = Patches::new(mesh, &triangles, runs);
        let sources = clusters.iter().map(|cluster| cluster.source.unwrap_or(FINEST)).collect();
        patches.levels = Some(Levels { sources, groups });
        Some(Self::new(triangles, patches))
    }

    fn new(corners: Vec<[u32; 3]>, patches: Patches) -> Self {
        Self { corners: Arc::new(corners), patches: Arc::new(patches), pieces: None }
    }
}

impl Patches {
    /// Patches of these runs of triangles, which follow each other.
    fn new(mesh: &Mesh, triangles: &[[u32; 3]], runs: impl Iterator<Item = Range<usize>>) -> Self {
        let starts = std::iter::once(0).chain(runs.map(|run| 3 * run.end as u32)).collect();
        let mut patches = Self::between(mesh, triangles, starts);
        patches.spread = patches.spread_now();
        patches
    }

    /// Patches whose indices begin at `starts`; all but the last, where those of the last patch end.
    fn between(mesh: &Mesh, triangles: &[[u32; 3]], starts: Vec<u32>) -> Self {
        let run = |ends: &[u32]| &triangles[ends[0] as usize / 3..ends[1] as usize / 3];
        let measured: Vec<_> =
            starts.par_windows(2).with_min_len(FEWEST).map(|ends| measure(mesh, run(ends))).collect();
        let (shapes, outlines): (Vec<_>, Vec<_>) = measured.into_iter().unzip();
        let groups = outlines.chunks(GROUP).zip((0..).step_by(GROUP)).map(|(outlines, first)| PatchGroup {
            outline: Outline::around(outlines),
            patches: first..first + outlines.len() as u32,
        });
        let groups = groups.collect();
        Self {
            shapes,
            outlines,
            starts,
            groups,
            levels: None,
            whole: Outline::whole(mesh),
            unsorted: false,
            spread: 0.0,
        }
    }

    /// The same patches of a mesh whose vertices have moved. `None` where they have come to lie so far apart that it
    /// pays to sort the triangles anew, and for levels of detail, which belong to the places that vertices had.
    pub(crate) fn moved_to(&self, mesh: &Mesh, triangles: &[[u32; 3]]) -> Option<Self> {
        if self.levels.is_some() || self.unsorted {
            return None;
        }
        let patches = Self::between(mesh, triangles, self.starts.clone());
        (patches.spread_now() <= WIDER * self.spread).then_some(Self { spread: self.spread, ..patches })
    }

    fn spread_now(&self) -> f32 {
        let radii: f32 = self.shapes.iter().map(PatchShape::radius).sum();
        radii / self.whole.radius().max(f32::MIN_POSITIVE)
    }

    /// The number of patches.
    pub fn len(&self) -> usize {
        self.shapes.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the triangles are in the order of the mesh because sorting them would not pay.
    pub fn are_unsorted(&self) -> bool {
        self.unsorted
    }

    /// The shape of a patch.
    pub(crate) fn shape(&self, patch: u32) -> &PatchShape {
        &self.shapes[patch as usize]
    }

    /// The range of a patch's indices among those of the mesh as it is drawn.
    pub fn indices(&self, patch: u32) -> Range<u32> {
        self.starts[patch as usize]..self.starts[patch as usize + 1]
    }

    /// Whether there are levels of detail, that is, several patches for one part of the surface.
    pub(crate) fn has_levels(&self) -> bool {
        self.levels.is_some()
    }

    /// Fills `seen` with the numbers of the patches that may show, in ascending order, as detailed as is demanded. A mesh
    /// that is a single patch is taken to be seen: it has been culled as an object. Returns how many patches there were
    /// to cull.
    pub(crate) fn see<'a>(
        &self,
        sight: impl FnOnce() -> Sight<'a>,
        demand: DetailDemand,
        seen: &mut Vec<u32>,
    ) -> usize {
        seen.clear();
        if self.len() == 1 {
            seen.push(0);
            return 0;
        }
        let sight = &sight();
        let shows = |patch: &u32| self.outlines[*patch as usize].is_seen(sight);
        let Some(levels) = &self.levels else {
            for group in self.groups.iter().filter(|group| group.outline.is_seen(sight)) {
                seen.extend(group.patches.clone().filter(shows));
            }
            return self.len();
        };
        let will_do = levels.which_will_do(sight, demand);
        let mut count = 0;
        for (group, _) in levels.groups.iter().zip(&will_do).filter(|(_, will_do)| !**will_do) {
            let drawn = group.clusters.clone().filter(|patch| {
                let source = levels.sources[*patch as usize];
                source == FINEST || will_do[source as usize]
            });
            seen.extend(drawn.inspect(|_| count += 1).filter(shows));
        }
        count
    }
}

impl Levels {
    /// Whether the simplified version of each group is detailed enough. If it is, so are those of all finer groups
    /// below.
    fn which_will_do(&self, sight: &Sight, DetailDemand { pixels, lit, has_images }: DetailDemand) -> Vec<bool> {
        let mut will_do = vec![false; self.groups.len()];
        if pixels <= 0.0 {
            return will_do;
        }
        for (number, group) in self.groups.iter().enumerate().rev() {
            let error = group.error(lit, has_images);
            if !will_do[number] && error.is_finite() {
                will_do[number] = error * sight.pixels_per_unit((group.center, group.radius)) <= pixels;
            }
            if will_do[number] {
                let clusters = group.clusters.start as usize..group.clusters.end as usize;
                for &source in self.sources[clusters].iter().filter(|source| **source != FINEST) {
                    will_do[source as usize] = true;
                }
            }
        }
        will_do
    }
}

/// The shape and the outline of some triangles.
fn measure(mesh: &Mesh, triangles: &[[u32; 3]]) -> (PatchShape, Outline) {
    let of_corners = |list: &[Vec3]| triangles.as_flattened().iter().map(|&i| list[i as usize]).collect::<Vec<_>>();
    let points = of_corners(mesh.positions());
    let center = Bounds::from_points(points.iter().copied()).map_or(Vec3::ZERO, |bounds| bounds.center());
    let offsets: Vec<Vec3> = points.iter().map(|p| *p - center).collect();
    let corners = points.as_chunks::<3>().0.iter().zip(offsets.as_chunks::<3>().0);
    let faces: Vec<(Vec3, [Vec3; 3])> =
        corners.filter_map(|(&[a, b, c], offsets)| Some((face_normal(a, b, c)?, *offsets))).collect();
    let facing = Facing::new(faces.iter().copied());
    let faces: Vec<Vec3> = faces.into_iter().map(|(n, _)| n).collect();
    let shape = PatchShape::new(center, &offsets, &of_corners(mesh.normals()), &faces);
    let outline = Outline::new(&shape, facing);
    (shape, outline)
}

#[cfg(test)]
mod tests {
    use super::*;
    use halfway_mesh::{Plane, UvSphere};

    #[test]
    fn small_meshes_are_whole_and_in_order() {
        let mesh = Mesh::from(UvSphere::new(1.0, 32, 16));
        let MeshTriangles { corners, patches, .. } = MeshTriangles::in_patches(&mesh);
        assert_eq!(*corners, mesh.triangles().collect::<Vec<_>>());
        assert_eq!(patches.len(), 1);
        assert_eq!(patches.indices(0), 0..mesh.indices().len() as u32);
    }

    #[test]
    fn unsorted_meshes_are_one_patch_of_their_own_list() {
        let mesh = Mesh::from(Plane { size: 20.0, divisions: 64 });
        let MeshTriangles { corners, patches, .. } = MeshTriangles::unmeasured(&mesh);
        assert!(corners.is_empty() && patches.are_unsorted());
        assert_eq!((patches.len(), patches.indices(0)), (1, 0..mesh.indices().len() as u32));
        let shape = patches.shape(0);
        assert!(mesh.positions().iter().all(|p| shape.holds(*p, Vec3::NEG_Y, Some(Vec3::X))));
        // Its list is not kept, so that it is laid out anew when vertices move.
        assert!(patches.moved_to(&mesh, &corners).is_none());
        assert!(!MeshTriangles::in_patches(&mesh).patches.are_unsorted());
    }

    #[test]
    fn patches_hold_every_triangle_once_with_true_bounds() {
        for mesh in [Mesh::from(UvSphere::new(2.0, 96, 48)), Mesh::from(Plane { size: 200.0, divisions: 64 })] {
            let MeshTriangles { corners: triangles, patches, .. } = MeshTriangles::in_patches(&mesh);
            let sorted = |mut triangles: Vec<[u32; 3]>| {
                triangles.sort_unstable();
                triangles
            };
            assert_eq!(sorted(triangles.to_vec()), sorted(mesh.triangles().collect()));
            let mut end = 0;
            for patch in 0..patches.len() as u32 {
                assert_eq!(patches.indices(patch).start, end);
                end = patches.indices(patch).end;
                let run = patches.indices(patch).start as usize / 3..end as usize / 3;
                let shape = patches.shape(patch);
                assert!(shape.faces.is_some() && shape.normals.is_some(), "they lie together");
                for corners in &triangles[run] {
                    let [a, b, c] = corners.map(|i| mesh.positions()[i as usize]);
                    let face = face_normal(a, b, c);
                    for i in corners.map(|i| i as usize) {
                        assert!(shape.holds(mesh.positions()[i], mesh.normals()[i], face));
                    }
                }
            }
            assert_eq!(end as usize, 3 * triangles.len());
        }
    }

    #[test]
    fn moved_patches_hold_their_triangles_until_they_are_torn_apart() {
        let mut mesh = Mesh::from(Plane { size: 20.0, divisions: 64 });
        let MeshTriangles { corners, patches, .. } = MeshTriangles::in_patches(&mesh);
        let wave = |p: &Vec3| p.with_y((0.8 * p.x).sin());
        mesh.set_positions(mesh.positions().iter().map(wave).collect()).expect("as many");
        let moved = patches.moved_to(&mesh, &corners).expect("they lie together still");
        assert_eq!(moved.len(), patches.len());
        for patch in 0..moved.len() as u32 {
            assert_eq!(moved.indices(patch), patches.indices(patch));
            let run = moved.indices(patch).start as usize / 3..moved.indices(patch).end as usize / 3;
            for triangle in &corners[run] {
                let [a, b, c] = triangle.map(|i| mesh.positions()[i as usize]);
                let holds = |p| moved.shape(patch).holds(p, Vec3::Y, face_normal(a, b, c));
                assert!([a, b, c].into_iter().all(holds), "patch {patch}");
            }
        }
        // Each vertex goes where another was.
        let mut torn = mesh.positions().to_vec();
        let count = torn.len();
        torn = (0..count).map(|i| torn[i * 1999 % count]).collect();
        mesh.set_positions(torn).expect("as many");
        assert!(patches.moved_to(&mesh, &corners).is_none());
    }

    #[test]
    fn patches_are_small() {
        let MeshTriangles { patches, .. } = MeshTriangles::in_patches(&Mesh::from(Plane { size: 64.0, divisions: 64 }));
        // 64 triangles are 32 cells of edge 1: at most 4 × 8 of them, with half a diagonal of 4.5, or 11 × 3.
        let shapes = || (0..patches.len() as u32).map(|patch| patches.shape(patch));
        assert!(shapes().all(|shape| shape.radius < 6.0), "{patches:?}");
        assert!(shapes().all(|shape| shape.normals.is_some_and(|cone| cone.half_thickness == 0.0)));
    }
}

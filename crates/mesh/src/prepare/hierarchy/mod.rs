//! A hierarchy of patches: neighbouring ones joined with fewer triangles, those joined again, and so on.

mod box_grid;
mod clip;
mod collapse;
mod corner_reach;
mod deviation;
mod edge_twins;
mod fine_surface;
mod four_vectors;
mod frame;
mod homes;
mod joined;
mod layers;
mod maker;
mod neighbours;
mod open_border;
mod overlay;
mod pieces;
mod quadric;
mod rooms;
mod roughness;
mod rounds;
mod stand_ins;
mod triangle_fans;
mod uncovered;
mod vicinity;
mod widest_angle;

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use maker::Maker;

use crate::Mesh;

/// Patches of a mesh, finer and coarser ones, of which some make up the mesh once, each part as fine as it has to be.
///
/// Groups of neighbouring patches are joined to fewer triangles, which are cut into patches again: the *parts* of a
/// group are coarser patches that cover what the patches that it *joins* cover. Their common border stays as it is, so
/// parts fit whatever stands beside them. A patch is part of one group, or finest, and each is joined by one. Where for
/// each group it is decided whether it *will do*, and all groups will do of whose parts it joins any, then those
/// patches cover the mesh once that are finest or parts of a group that will do, and that are joined by a group that
/// will not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatchHierarchy {
    /// The triangles of all patches, as numbers of the mesh's vertices.
    pub triangles: Vec<[u32; 3]>,
    /// The patches, those that one group joins together.
    pub patches: Vec<HierarchyPatch>,
    /// The groups, the finer first: the parts that a group joins are those of earlier ones. The last joins what nothing
    /// coarser stands for, and has no parts.
    pub groups: Vec<PatchGroup>,
}

/// A patch of a [`PatchHierarchy`].
#[derive(Clone, Debug, PartialEq)]
pub struct HierarchyPatch {
    /// Its triangles, of those of the hierarchy.
    pub triangles: Range<u32>,
    /// The group that it is a part of; `None` for the mesh's own triangles.
    pub part_of: Option<u32>,
}

/// Patches that are joined to coarser ones, and how far off those are. None of these numbers is smaller than that of a
/// group whose parts this one joins, but for the roughness, which is no larger.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchGroup {
    /// The patches that it joins.
    pub joins: Range<u32>,
    /// No point of its parts is further from the mesh than this, and no point of the mesh's triangles for which they
    /// stand is further from its parts, in the mesh's units. Infinite for the last group.
    pub error: f32,
    /// For each point of its parts the mesh has a point within `error` of it whose interpolated normal, made unit
    /// again, is turned by no more than this, in radians; π where nothing is known.
    pub normal_error: f32,
    /// The largest angle between a vertex normal of a triangle and the mean of all three, in radians: what shading at
    /// the vertices loses between them grows with its square.
    pub normal_spread: f32,
    /// The length of the longest edge of its parts, in the mesh's units; at most `f32::MAX`.
    pub longest_edge: f32,
    /// No point of its parts' triangles is farther from the nearest corner of its triangle, in the mesh's units; at
    /// most `f32::MAX`, and no more than the longest edge over √3.
    pub corner_reach: f32,
    /// How rough the mesh is there: a quarter of the vertices of what it joins, or of some group that is joined to
    /// that, differ in their normals from the mean of those beside them by no more than this, as unit vectors. Hardly
    /// anything where it is smooth. Of a group it is no more than of those whose parts it joins.
    pub roughness: f32,
}

/// A mesh of up to this many triangles is one patch: cutting it would cost more draws than it saves.
const WHOLE: usize = 4096;

/// How many triangles a patch of a larger mesh has at most.
const PATCH: usize = 64;

impl Mesh {
    /// How many triangles a patch of the mesh has at most: all, up to 4096, and else 64.
    pub fn triangles_of_a_patch(&self) -> usize {
        if self.triangle_count() <= WHOLE { WHOLE } else { PATCH }
    }

    /// The hierarchy of the mesh's patches, or `None` where `stop` has become true.
    ///
    /// A mesh of up to 4096 triangles is one patch, and is joined to ever fewer triangles as a whole. Patches of others
    /// have up to 64 triangles, and about eight are joined to half as many triangles.
    ///
    /// Vertices go one by one, the least loss first, each onto a neighbour: a loss of shape or of shading (see
    /// [`PatchGroup::normal_spread`]), so that triangles stay where the surface or its normals bend. Those at one place
    /// with the same attributes (to 10⁻⁴) become one; the others make a seam or a crease, which stays closed and goes
    /// only along itself. What is on an open border stays, for other meshes may share it. A faceted mesh is all
    /// creases:
    /// [weld](Self::welded) it first.
    ///
    /// It is made on rayon's threads, up to sixteen of them, and is the same on any number.
    ///
    /// Triangles that have corners in common, and those that have some in common with these, and so on, are one piece.
    /// Where another piece is closer than twice the [error](PatchGroup::error) of a group, that is not made: so neither
    /// comes to lie before the other. The same goes for another layer of one piece, as far as vertices tell: what lies
    /// over one of them along the mean normal around it, turned by no more than 45° from the surface there, and is no
    /// neighbour's triangle.
    pub fn patch_hierarchy(&self, stop: &AtomicBool) -> Option<PatchHierarchy> {
        let mut maker = Maker::new(self);
        let mut pool = maker.finest(stop);
        while !pool.is_empty() {
            let before = pool.len();
            let (next, joined) = maker.join(pool, stop)?;
            pool = next;
            if !joined || (before == 1 && pool.is_empty()) {
                break;
            }
        }
        Some(maker.finish(pool))
    }
}

impl PatchHierarchy {
    /// The number of triangles of the finest patches: those of the mesh.
    pub fn finest_count(&self) -> usize {
        let finest = self.patches.iter().filter(|patch| patch.part_of.is_none());
        finest.map(|patch| patch.triangles.len()).sum()
    }

    /// How many triangles there are where each group will do that is no further off than `error`, in the mesh's units.
    pub fn triangles_within(&self, error: f32) -> usize {
        let will_do = |group: u32| self.groups[group as usize].error <= error;
        let left = (0..).zip(&self.groups).filter(|(number, _)| !will_do(*number)).map(|(_, group)| group);
        let patches = left.flat_map(|group| &self.patches[group.joins.start as usize..group.joins.end as usize]);
        patches.filter(|patch| patch.part_of.is_none_or(will_do)).map(|patch| patch.triangles.len()).sum()
    }
}

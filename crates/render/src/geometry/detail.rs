//! Detail: the patches of a mesh, finer and coarser ones, and which may stand for which.

use crate::geometry::corners::{CountedCorners, ShadedCorners, reach_of_rough};
use crate::geometry::families::Families;
use crate::geometry::outlines::{Outline, Sight};
use crate::geometry::patches::MeshPatch;
use crate::geometry::turned::GroupErrors;
use halfway_mesh::{HierarchyPatch, Mesh, PatchGroup, PatchHierarchy};
use halfway_raster::Pieces;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A mesh's triangles in the order in which they are drawn: patch by patch. A clone shares them.
#[derive(Clone, Debug)]
pub(crate) struct MeshTriangles {
    pub(crate) corners: Arc<Vec<[u32; 3]>>,
    pub(crate) detail: Arc<Detail>,
    /// The same as the CPU draws them, where that was asked for.
    pub(crate) pieces: Option<Arc<Pieces>>,
}

/// The runs of a mesh's triangles as they are drawn, and which may stand for others.
#[derive(Debug)]
pub(crate) struct Detail {
    patches: Vec<MeshPatch>,
    /// Where the indices of each patch begin, and where those of the last end.
    starts: Vec<u32>,
    /// Of each patch.
    pub(super) outlines: Vec<Outline>,
    /// Which of them lie together.
    pub(crate) families: Families,
    /// Of each patch the group that it is a part of, or [`FINEST`].
    pub(super) part_of: Vec<u32>,
    /// Anything coarser stands for any patch.
    pub(crate) has_levels: bool,
    pub(super) groups: Vec<DetailGroup>,
    /// The groups of whose parts each group joins any.
    pub(super) finer: Vec<u32>,
    /// What is known of the whole.
    pub(crate) whole: Outline,
    /// Each patch is all that there is, in fewer triangles or more.
    pub(super) is_whole: bool,
    /// Of each error the least of all groups that have parts.
    pub(crate) least: GroupErrors,
}

/// See [`PatchGroup`].
#[derive(Clone, Debug)]
pub(crate) struct DetailGroup {
    /// What is known of the patches that it joins. Its sphere holds those of the finer groups.
    pub(super) joined: Outline,
    pub(super) joins: Range<u32>,
    pub(super) finer: Range<u32>,
    pub(super) errors: GroupErrors,
}

/// Part of no group.
const FINEST: u32 = u32::MAX;

/// So many patches are looked at together where nothing stands for them.
const LOOKED_AT: usize = 8;

/// Where patches have light lists of their own, coarser ones have no larger radius than the whole mesh's divided by
/// this, or than the finest have in the mean and a quarter more.
const PATCHES_ACROSS: f32 = 10.0;

impl MeshTriangles {
    /// The mesh as it is, in the order of its triangles.
    pub(crate) fn in_order(mesh: &Mesh) -> Self {
        let corners: Vec<_> = mesh.triangles().collect();
        let detail = Detail::finest(mesh, &corners, std::iter::once(0..corners.len()));
        Self::new(corners, detail)
    }

    /// The mesh as it is, in patches.
    pub(crate) fn in_patches(mesh: &Mesh) -> Self {
        let mut corners: Vec<_> = mesh.triangles().collect();
        let runs = mesh.cut_into_patches(&mut corners, mesh.triangles_of_a_patch());
        let detail = Detail::finest(mesh, &corners, runs.into_iter());
        Self::new(corners, detail)
    }

    /// With coarser patches; `None` where `stop` has become true.
    pub(crate) fn in_levels(mesh: &Mesh, stop: &AtomicBool) -> Option<Self> {
        let PatchHierarchy { triangles, patches, groups } = mesh.patch_hierarchy(stop)?;
        let detail = Detail::new(mesh, &triangles, &patches, &groups);
        Some(Self::new(triangles, detail))
    }

    fn new(corners: Vec<[u32; 3]>, detail: Detail) -> Self {
        Self { corners: Arc::new(corners), detail: Arc::new(detail), pieces: None }
    }
}

impl Detail {
    /// The mesh itself, in patches of these triangles, one behind the other.
    fn finest(mesh: &Mesh, triangles: &[[u32; 3]], runs: impl Iterator<Item = Range<usize>>) -> Self {
        let mut detail = Self::of_runs(mesh, triangles, runs);
        let count = detail.patches.len();
        detail.part_of = vec![FINEST; count];
        detail.is_whole = count == 1;
        detail.add_last(0..count as u32);
        detail
    }

    /// All patches, of these triangles, one behind the other; nothing stands for any yet.
    fn of_runs(mesh: &Mesh, triangles: &[[u32; 3]], runs: impl Iterator<Item = Range<usize>>) -> Self {
        let mut starts = vec![0];
        let (patches, outlines): (Vec<_>, Vec<_>) = runs
            .map(|run| {
                starts.push(3 * run.end as u32);
                MeshPatch::new(mesh, &triangles[run])
            })
            .unzip();
        Self {
            families: Families::new(&patches),
            patches,
            starts,
            outlines,
            part_of: Vec::new(),
            has_levels: false,
            groups: Vec::new(),
            finer: Vec::new(),
            whole: Outline::whole(mesh),
            is_whole: false,
            least: GroupErrors::LARGEST,
        }
    }

    fn new(mesh: &Mesh, triangles: &[[u32; 3]], patches: &[HierarchyPatch], groups: &[PatchGroup]) -> Self {
        let runs = patches.iter().map(|HierarchyPatch { triangles: run, .. }| run.start as usize..run.end as usize);
        let mut detail = Self::of_runs(mesh, triangles, runs);
        detail.part_of = patches.iter().map(|patch| patch.part_of.unwrap_or(FINEST)).collect();
        detail.has_levels = detail.part_of.iter().any(|&part_of| part_of != FINEST);
        detail.is_whole = patches.iter().filter(|patch| patch.part_of.is_none()).count() == 1;
        detail.groups.reserve(groups.len());
        let finest = || detail.patches.iter().zip(&detail.part_of).filter(|(_, part_of)| **part_of == FINEST);
        let mean = finest().map(|(patch, _)| patch.shape.radius()).sum::<f32>() / finest().count().max(1) as f32;
        let largest = (1.25 * mean).max(detail.whole.radius() / PATCHES_ACROSS);
        // Of each group the largest radius of its parts.
        let mut radii = vec![0.0_f32; groups.len()];
        for (patch, &part_of) in detail.patches.iter().zip(&detail.part_of) {
            if let Some(radius) = radii.get_mut(part_of as usize) {
                *radius = radius.max(patch.shape.radius());
            }
        }
        for (group, radius) in groups.iter().zip(radii) {
            detail.add_group(group, radius > largest);
        }
        let last = detail.groups.pop();
        detail.least = detail.groups.iter().map(|group| group.errors).fold(GroupErrors::LARGEST, GroupErrors::min);
        if let Some(DetailGroup { joins, .. }) = last {
            detail.add_last(joins);
        }
        detail
    }

    fn add_group(&mut self, group: &PatchGroup, spoils_lists: bool) {
        let joins = group.joins.start as usize..group.joins.end as usize;
        let first = self.finer.len();
        self.finer.extend(self.part_of[joins.clone()].iter().filter(|&&part_of| part_of != FINEST));
        self.finer[first..].sort_unstable();
        let mut finer = self.finer.split_off(first);
        finer.dedup();
        let spheres = finer.iter().map(|&group| &self.groups[group as usize].joined);
        let joined = Outline::around(&self.outlines[joins], spheres);
        let spoils_lists = spoils_lists || finer.iter().any(|&group| self.groups[group as usize].errors.spoils_lists);
        self.finer.extend(finer);
        let &PatchGroup { error, normal_error, normal_spread, longest_edge, corner_reach, roughness, .. } = group;
        let corner_reach = reach_of_rough(corner_reach, roughness, normal_spread);
        self.groups.push(DetailGroup {
            joined,
            joins: group.joins.clone(),
            finer: first as u32..self.finer.len() as u32,
            errors: GroupErrors { error, normal_error, normal_spread, longest_edge, corner_reach, spoils_lists },
        });
    }

    /// Patches for which nothing stands: they are looked at some at a time.
    fn add_last(&mut self, joins: Range<u32>) {
        for first in joins.clone().step_by(LOOKED_AT) {
            let joins = first..joins.end.min(first + LOOKED_AT as u32);
            let outlines = &self.outlines[joins.start as usize..joins.end as usize];
            let joined = Outline::around(outlines, std::iter::empty());
            self.groups.push(DetailGroup { joined, joins, finer: 0..0, errors: GroupErrors::LARGEST });
        }
    }

    /// All patches, in the order of their triangles.
    pub(crate) fn patches(&self) -> &[MeshPatch] {
        &self.patches
    }

    /// One of them.
    pub(crate) fn patch(&self, number: u32) -> &MeshPatch {
        &self.patches[number as usize]
    }

    /// Which indices of the mesh as it is drawn are a patch's.
    pub(crate) fn indices(&self, number: u32) -> Range<u32> {
        self.starts[number as usize]..self.starts[number as usize + 1]
    }

    /// Whether a patch is coarser than the mesh.
    pub(crate) fn is_coarser(&self, number: u32) -> bool {
        self.part_of[number as usize] != FINEST
    }

    /// How many pixels a unit of the mesh takes, where all of it is coarser or nothing.
    pub(crate) fn pixels_per_unit(&self, sight: &Sight) -> Option<f32> {
        self.is_whole.then(|| sight.pixels_per_unit(self.whole.sphere(sight.model_view)))
    }

    /// Which corners a patch is shaded at, where it is coarser than the mesh and small enough on the picture.
    pub(super) fn counted(&self, number: u32, corners: ShadedCorners, sight: &Sight) -> Option<CountedCorners> {
        let GroupErrors { longest_edge, corner_reach, .. } = self.group_of(number)?.errors;
        corners.counted([longest_edge, corner_reach], || {
            sight.pixels_per_unit(self.outlines[number as usize].sphere(sight.model_view))
        })
    }

    /// The group that a patch is a part of; `None` of one of the mesh itself.
    fn group_of(&self, number: u32) -> Option<&DetailGroup> {
        self.groups.get(self.part_of[number as usize] as usize)
    }
}

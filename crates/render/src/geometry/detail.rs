//! Detail: the patches of a mesh, finer and coarser ones, and which of them a frame draws.

use crate::geometry::allowed::Allowed;
use crate::geometry::corners::reach_of_rough;
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
    /// Of each patch.
    outlines: Vec<Outline>,
    /// Which of them lie together.
    pub(crate) families: Families,
    /// Of each patch the group that it is a part of, or [`FINEST`].
    part_of: Vec<u32>,
    groups: Vec<DetailGroup>,
    /// The groups of whose parts each group joins any.
    finer: Vec<u32>,
    /// What is known of the whole.
    pub(crate) whole: Outline,
    /// Each patch is all that there is, in fewer triangles or more.
    is_whole: bool,
    /// Of each error the least of all groups that have parts.
    pub(crate) least: GroupErrors,
}

/// See [`PatchGroup`].
#[derive(Clone, Debug)]
pub(crate) struct DetailGroup {
    /// What is known of the patches that it joins. Its sphere holds those of the finer groups.
    joined: Outline,
    joins: Range<u32>,
    finer: Range<u32>,
    errors: GroupErrors,
}

/// Part of no group.
const FINEST: u32 = u32::MAX;

/// So many patches are looked at together where nothing stands for them.
const LOOKED_AT: usize = 8;

/// Where patches have light lists of their own, coarser ones have no larger radius than the whole mesh's divided by
/// this, or than the finest have in the mean and a quarter more.
const PATCHES_ACROSS: f32 = 10.0;

/// Which groups will do, for one object after the other.
#[derive(Debug, Default)]
pub(crate) struct Choice {
    will_do: Vec<bool>,
}

impl MeshTriangles {
    /// The mesh as it is, in the order of its triangles.
    pub(crate) fn in_order(mesh: &Mesh) -> Self {
        let corners: Vec<_> = mesh.triangles().collect();
        let patches = vec![MeshPatch::new(mesh, &corners, 0)];
        Self::new(corners, Detail::finest(mesh, patches))
    }

    /// The mesh as it is, in patches.
    pub(crate) fn in_patches(mesh: &Mesh) -> Self {
        let mut corners: Vec<_> = mesh.triangles().collect();
        let runs = mesh.cut_into_patches(&mut corners, mesh.triangles_of_a_patch());
        let patch = |run: Range<usize>| MeshPatch::new(mesh, &corners[run.clone()], 3 * run.start as u32);
        let patches = runs.into_iter().map(patch).collect();
        let detail = Detail::finest(mesh, patches);
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
    /// The mesh itself, in these patches.
    fn finest(mesh: &Mesh, patches: Vec<(MeshPatch, Outline)>) -> Self {
        let (patches, outlines): (Vec<_>, Vec<_>) = patches.into_iter().unzip();
        let joins = (0..patches.len()).step_by(LOOKED_AT).map(|first| first..patches.len().min(first + LOOKED_AT));
        let groups = joins.map(|joins| DetailGroup::last(&outlines, joins)).collect();
        let part_of = vec![FINEST; patches.len()];
        let is_whole = patches.len() == 1;
        Self {
            groups,
            part_of,
            finer: Vec::new(),
            whole: Outline::whole(mesh),
            is_whole,
            families: Families::new(&patches),
            patches,
            outlines,
            least: GroupErrors::LARGEST,
        }
    }

    fn new(mesh: &Mesh, triangles: &[[u32; 3]], patches: &[HierarchyPatch], groups: &[PatchGroup]) -> Self {
        let patch = |of: &HierarchyPatch| {
            let Range { start, end } = of.triangles;
            MeshPatch::new(mesh, &triangles[start as usize..end as usize], 3 * start)
        };
        let (made, outlines): (Vec<MeshPatch>, Vec<Outline>) = patches.iter().map(patch).unzip();
        let mut detail = Self {
            families: Families::new(&made),
            part_of: patches.iter().map(|patch| patch.part_of.unwrap_or(FINEST)).collect(),
            patches: made,
            outlines,
            groups: Vec::with_capacity(groups.len()),
            finer: Vec::new(),
            whole: Outline::whole(mesh),
            is_whole: patches.iter().filter(|patch| patch.part_of.is_none()).count() == 1,
            least: GroupErrors::LARGEST,
        };
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
        for (patch, &part_of) in detail.patches.iter_mut().zip(&detail.part_of) {
            if let Some(group) = detail.groups.get(part_of as usize) {
                patch.longest_edge = group.errors.longest_edge;
                patch.corner_reach = group.errors.corner_reach;
            }
        }
        // What nothing stands for is looked at some patches at a time.
        let last = detail.groups.pop();
        detail.least = detail.groups.iter().map(|group| group.errors).fold(GroupErrors::LARGEST, GroupErrors::min);
        if let Some(DetailGroup { joins, .. }) = last {
            let ends = joins.clone().step_by(LOOKED_AT).map(|first| first..joins.end.min(first + LOOKED_AT as u32));
            for joins in ends {
                detail.add_last(joins);
            }
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

    /// Patches for which nothing stands.
    fn add_last(&mut self, joins: Range<u32>) {
        self.groups.push(DetailGroup::last(&self.outlines, joins.start as usize..joins.end as usize));
    }

    /// All patches, in the order of their triangles.
    pub(crate) fn patches(&self) -> &[MeshPatch] {
        &self.patches
    }

    /// Whether anything coarser stands for any patch.
    pub(crate) fn has_levels(&self) -> bool {
        self.part_of.iter().any(|&part_of| part_of != FINEST)
    }

    /// How many pixels a unit of the mesh takes, where all of it is coarser or nothing.
    pub(crate) fn pixels_per_unit(&self, sight: &Sight) -> Option<f32> {
        self.is_whole.then(|| sight.pixels_per_unit(self.whole.sphere(sight.model_view)))
    }

    /// Visits the patches that are drawn of an object and may show, in the order of their triangles, each with the
    /// its number and that of its stretch: between two patches of one stretch there are only triangles that do not
    /// show. `is_near`
    /// tells whether another object is too near to a patch whose points move by a length of the mesh's units. Returns
    /// how many patches were looked at or left out with others.
    pub(crate) fn each_seen<'a>(
        &'a self,
        allowed: &Allowed,
        sight: &Sight,
        Choice { will_do }: &mut Choice,
        is_near: impl FnMut(&Outline, f32) -> bool,
        mut each: impl FnMut(&'a MeshPatch, [u32; 2]),
    ) -> u32 {
        self.choose(allowed, sight, will_do, is_near);
        // Patches lie one behind the other; what lies between are triangles for which others stand.
        let (mut stretch, mut next) = (0, 0);
        let mut stretch_of = |at: usize| {
            stretch += u32::from(at != next);
            next = at + 1;
            stretch
        };
        // The object as a whole has been found to be seen.
        let mut looked_at = 0;
        for (group, _) in self.groups.iter().zip(&*will_do).filter(|(_, will_do)| !**will_do) {
            let joins = group.joins.start as usize..group.joins.end as usize;
            let drawn = |at: &usize| will_do.get(self.part_of[*at] as usize).is_none_or(|will_do| *will_do);
            if self.is_whole {
                joins.filter(drawn).for_each(|at| each(&self.patches[at], [at as u32, stretch_of(at)]));
                continue;
            }
            let is_seen = group.joined.is_seen(sight);
            for at in joins.filter(drawn) {
                looked_at += 1;
                let stretch = stretch_of(at);
                if is_seen && self.outlines[at].is_seen(sight) {
                    each(&self.patches[at], [at as u32, stretch]);
                }
            }
        }
        looked_at
    }

    /// Finds the groups that will do: a group's parts are drawn where it does, and all finer ones then do as well.
    fn choose(
        &self,
        allowed: &Allowed,
        sight: &Sight,
        will_do: &mut Vec<bool>,
        mut is_near: impl FnMut(&Outline, f32) -> bool,
    ) {
        will_do.clear();
        will_do.resize(self.groups.len(), false);
        if allowed.is_nothing() {
            return;
        }
        let of_whole = self.pixels_per_unit(sight).unwrap_or(0.0);
        for (number, group) in self.groups.iter().enumerate().rev() {
            if !will_do[number] {
                let pixels =
                    if self.is_whole { of_whole } else { sight.pixels_per_unit(group.joined.sphere(sight.model_view)) };
                let around = if self.is_whole { &self.whole } else { &group.joined };
                will_do[number] =
                    pixels <= allowed.pixels_per_unit(&group.errors) && !is_near(around, group.errors.error);
            }
            if will_do[number] {
                for &finer in &self.finer[group.finer.start as usize..group.finer.end as usize] {
                    will_do[finer as usize] = true;
                }
            }
        }
    }
}

impl DetailGroup {
    fn last(outlines: &[Outline], joins: Range<usize>) -> Self {
        Self {
            joined: Outline::around(&outlines[joins.clone()], std::iter::empty()),
            joins: joins.start as u32..joins.end as u32,
            finer: 0..0,
            errors: GroupErrors::LARGEST,
        }
    }
}

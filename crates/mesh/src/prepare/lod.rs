//! Levels of detail: a hierarchy of clusters of triangles.
//!
//! As in Nanite (Karis, Stubbe and Wihlidal 2021, "A deep dive into Nanite virtualized geometry"): the mesh is cut into
//! clusters; groups of neighbouring clusters are simplified to half of their triangles with their common border locked,
//! and cut into clusters again, which are grouped in another way in the next round.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::{Mat3, Quat, Vec3};
use rayon::prelude::*;

use super::patches::{Site, part};
use super::simplify::{Simplifier, Wedges};
use crate::{Bounds, Mesh};

/// Clusters of a mesh's triangles, fine and coarse, in groups.
///
/// The clusters of a group cover a part of the surface. Simplified together, they became coarser clusters, whose
/// [`source`](LodCluster::source) is the group, and which cover the same part inside the same border. So each part of
/// the surface can be drawn as coarsely as its error allows: see [`cut`](Self::cut).
///
/// ```
/// use std::sync::atomic::AtomicBool;
/// use halfway_mesh::{Mesh, UvSphere};
///
/// let sphere = Mesh::from(UvSphere::new(1.0, 96, 48));
/// let levels = sphere.lod_hierarchy(&AtomicBool::new(false)).expect("it was not stopped");
/// let triangles = |cut: &[u32]| cut.iter().map(|cluster| levels.triangles_of(*cluster).len()).sum::<usize>();
/// let all = levels.cut(|_| false);
/// let coarse = levels.cut(|group| group.position_error < 0.01);
/// assert_eq!(triangles(&all), sphere.triangle_count());
/// assert!(triangles(&coarse) < triangles(&all));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LodHierarchy {
    /// The triangles of all clusters, as numbers of the mesh's vertices.
    pub triangles: Vec<[u32; 3]>,
    /// The clusters, group by group, in the order of their triangles.
    pub clusters: Vec<LodCluster>,
    /// The groups, finer ones first: sources of a group's clusters come before it. The last holds the clusters without
    /// a simplified version: its errors are infinite.
    pub groups: Vec<LodGroup>,
}

/// A cluster of a [`LodHierarchy`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LodCluster {
    /// Its triangles, of those of the hierarchy.
    pub triangles: Range<u32>,
    /// The group from which it was simplified; `None` for triangles of the mesh itself.
    pub source: Option<u32>,
}

/// Clusters of a [`LodHierarchy`] that are simplified together, and the error of their simplified version.
///
/// The errors are estimates, not bounds: the largest deviation found in a collapse. They are no smaller than those of
/// the sources of the group's clusters.
#[derive(Clone, Debug, PartialEq)]
pub struct LodGroup {
    /// Its clusters.
    pub clusters: Range<u32>,
    /// The distance of the simplified surface from the mesh, in the mesh's units.
    pub position_error: f32,
    /// The coarseness of the simplified version's shading, as a length in the mesh's units: a half to three quarters of
    /// the mean edge, or less where the change of normals and colours is hardly visible. If it is less than a pixel,
    /// the picture of a rough mesh is about as good as with all triangles.
    pub shading_error: f32,
    /// How far texture coordinates slide over the simplified surface, in the mesh's units. Visible only with images; 0
    /// if the mesh has no coordinates.
    pub map_error: f32,
    /// The centre of a sphere around its clusters, and so around the simplified version.
    pub center: Vec3,
    /// The radius of that sphere.
    pub radius: f32,
}

impl LodGroup {
    /// The error of the simplified version's picture, as a length in the mesh's units: the largest of the errors that
    /// are visible on a surface that is `lit`, and has images, or not.
    pub fn error(&self, lit: bool, has_images: bool) -> f32 {
        let shading = if lit { self.shading_error } else { 0.0 };
        let map = if has_images { self.map_error } else { 0.0 };
        self.position_error.max(shading).max(map)
    }
}

/// The most clusters of a group.
const GROUP: usize = 16;

/// A group has a simplified version if at most this fraction of its triangles is left. The clusters of other groups are
/// grouped anew.
const LEAST_REDUCTION: f64 = 0.8;

/// The owner of a position that no group has, and of one that several have.
const NOBODY: u32 = u32::MAX;
const SEVERAL: u32 = u32::MAX - 1;

impl Mesh {
    /// The levels of detail of the mesh, or `None` if `stop` has become true.
    ///
    /// A mesh of up to 4096 triangles is one cluster. Vertices on open borders stay, since other meshes may share them.
    /// Seams and creases stay closed and in place; a faceted mesh, which is all creases, should be
    /// [welded](Self::welded) first. Runs on rayon's threads; the result does not depend on their number.
    pub fn lod_hierarchy(&self, stop: &AtomicBool) -> Option<LodHierarchy> {
        let mut builder = Builder::new(self);
        let mut hierarchy = LodHierarchy::default();
        // Each round halves the triangles.
        hierarchy.triangles.reserve_exact(2 * self.triangle_count() + self.triangle_count() / 16);
        // Turns about a skew axis keep two rounds from cutting along the same planes.
        let step = Mat3::from_quat(Quat::from_xyzw(1.0, 2.0, 4.0, 10.0) * (1.0 / 11.0));
        let mut turn = Mat3::IDENTITY;
        while builder.simplify_groups(&mut hierarchy, turn, stop)? {
            turn = step * turn;
        }
        let (center, radius) = sphere_around(self.positions().iter().copied());
        let [position_error, shading_error, map_error] = [f32::INFINITY; 3];
        let last = LodGroup { clusters: 0..0, position_error, shading_error, map_error, center, radius };
        hierarchy.add(last, &builder.clusters, &builder.triangles);
        hierarchy.triangles.shrink_to_fit();
        Some(hierarchy)
    }
}

impl LodHierarchy {
    /// The numbers of the clusters to draw, ascending: together they cover the mesh once, without cracks.
    ///
    /// They are as coarse as possible where `will_do` accepts the simplified version of a group. It is called only for
    /// groups whose clusters' sources were all accepted.
    pub fn cut(&self, mut will_do: impl FnMut(&LodGroup) -> bool) -> Vec<u32> {
        let (mut will, mut cut) = (vec![false; self.groups.len()], Vec::new());
        for (number, group) in self.groups.iter().enumerate() {
            let clusters = &self.clusters[group.clusters.start as usize..group.clusters.end as usize];
            let sources_will = clusters.iter().filter_map(|cluster| cluster.source).all(|source| will[source as usize]);
            // The last has no simplified version.
            will[number] = sources_will && number + 1 < self.groups.len() && will_do(group);
            if !will[number] {
                let is_drawn =
                    |cluster: &u32| self.clusters[*cluster as usize].source.is_none_or(|source| will[source as usize]);
                cut.extend(group.clusters.clone().filter(is_drawn));
            }
        }
        cut
    }

    /// The triangles of a cluster, by its number.
    pub fn triangles_of(&self, cluster: u32) -> &[[u32; 3]] {
        let Range { start, end } = self.clusters[cluster as usize].triangles;
        &self.triangles[start as usize..end as usize]
    }

    /// Adds a group with its clusters, whose triangles are ranges of `all`.
    fn add<'a>(&mut self, group: LodGroup, clusters: impl IntoIterator<Item = &'a LodCluster>, all: &[[u32; 3]]) {
        let first = self.clusters.len() as u32;
        for cluster in clusters {
            let start = self.triangles.len() as u32;
            self.triangles.extend_from_slice(&all[cluster.range()]);
            self.clusters.push(LodCluster { triangles: start..self.triangles.len() as u32, source: cluster.source });
        }
        self.groups.push(LodGroup { clusters: first..self.clusters.len() as u32, ..group });
    }
}

impl LodCluster {
    fn range(&self) -> Range<usize> {
        self.triangles.start as usize..self.triangles.end as usize
    }
}

/// Builds a hierarchy round by round.
struct Builder<'a> {
    mesh: &'a Mesh,
    wedges: Wedges,
    /// The most triangles of a cluster.
    most: usize,
    /// The clusters that are in no group yet, and their triangles.
    clusters: Vec<LodCluster>,
    triangles: Vec<[u32; 3]>,
}

/// The simplified version of a group.
struct GroupVersion {
    group: LodGroup,
    triangles: Vec<[u32; 3]>,
    clusters: Vec<Range<usize>>,
}

impl<'a> Builder<'a> {
    fn new(mesh: &'a Mesh) -> Self {
        let mut triangles: Vec<[u32; 3]> = mesh.triangles().collect();
        let most = mesh.triangles_of_a_patch();
        let runs = mesh.cut(&mut triangles, most, false);
        let cluster = |run: Range<usize>| LodCluster { triangles: run.start as u32..run.end as u32, source: None };
        let clusters = runs.into_iter().map(cluster).collect();
        Self { mesh, wedges: Wedges::new(mesh), most, triangles, clusters }
    }

    /// Does a round: groups all clusters and replaces those of each group by its simplified version, if it has one.
    /// Returns whether any has; `None` if `stop` is true.
    ///
    /// Groups do not depend on each other: they are simplified in parallel and added in order.
    fn simplify_groups(&mut self, hierarchy: &mut LodHierarchy, turn: Mat3, stop: &AtomicBool) -> Option<bool> {
        let groups = self.groups(turn);
        let owners = self.owners(&groups);
        let version = |(number, clusters): (u32, &Vec<&LodCluster>)| {
            let is_stopped = stop.load(Ordering::Relaxed);
            let is_locked = |place: u32| owners[place as usize] != number;
            if is_stopped { None } else { self.simplified(clusters, &hierarchy.groups, is_locked) }
        };
        let versions: Vec<Option<GroupVersion>> =
            (0..groups.len() as u32).into_par_iter().zip(&groups).map(version).collect();
        if stop.load(Ordering::Relaxed) {
            return None;
        }
        let any = versions.iter().any(Option::is_some);
        let (mut triangles, mut clusters) = (Vec::with_capacity(self.triangles.len() / 2), Vec::new());
        for (group, version) in groups.iter().zip(versions) {
            let mut add = |source: Option<u32>, run: &[[u32; 3]]| {
                let start = triangles.len() as u32;
                triangles.extend_from_slice(run);
                clusters.push(LodCluster { triangles: start..triangles.len() as u32, source });
            };
            if let Some(version) = version {
                let source = Some(hierarchy.groups.len() as u32);
                version.clusters.into_iter().for_each(|run| add(source, &version.triangles[run]));
                hierarchy.add(version.group, group.iter().copied(), &self.triangles);
            } else {
                for cluster in group {
                    add(cluster.source, &self.triangles[cluster.range()]);
                }
            }
        }
        (self.triangles, self.clusters) = (triangles, clusters);
        Some(any)
    }

    /// Groups neighbouring clusters. Each `turn` gives other groups.
    fn groups(&self, turn: Mat3) -> Vec<Vec<&LodCluster>> {
        let site = |(number, cluster): (u32, &LodCluster)| {
            let corners = self.triangles[cluster.range()].as_flattened();
            let share = 1.0 / corners.len() as f32;
            let mean: Vec3 = corners.iter().map(|&vertex| share * self.mesh.positions()[vertex as usize]).sum();
            Site { place: turn * mean, facing: Vec3::ZERO, number, key: 0 }
        };
        let mut sites: Vec<Site> = (0..).zip(&self.clusters).map(site).collect();
        let most = sites.len().div_ceil(sites.len().div_ceil(GROUP));
        part(&mut sites, most);
        let group = |sites: &[Site]| sites.iter().map(|site| &self.clusters[site.number as usize]).collect();
        sites.chunks(most).map(group).collect()
    }

    /// The group that owns each position, [`NOBODY`] or [`SEVERAL`].
    fn owners(&self, groups: &[Vec<&LodCluster>]) -> Vec<u32> {
        let mut owners = vec![NOBODY; self.wedges.places.len()];
        for (number, clusters) in (0..).zip(groups) {
            for &vertex in clusters.iter().flat_map(|cluster| self.triangles[cluster.range()].as_flattened()) {
                let owner = &mut owners[self.wedges.places[vertex as usize] as usize];
                *owner = if *owner == NOBODY || *owner == number { number } else { SEVERAL };
            }
        }
        owners
    }

    /// Simplifies a group; `None` if too few triangles vanish. `groups` are those of earlier rounds.
    fn simplified(
        &self,
        clusters: &[&LodCluster],
        groups: &[LodGroup],
        is_locked: impl Fn(u32) -> bool,
    ) -> Option<GroupVersion> {
        let runs: Vec<&[[u32; 3]]> = clusters.iter().map(|cluster| &self.triangles[cluster.range()]).collect();
        let all = runs.concat();
        let target = all.len() / 2;
        let simplifier = Simplifier::new(self.mesh, &self.wedges, &all, target, true, is_locked);
        let mut simplified = simplifier.reduce(target, f64::INFINITY);
        let triangles = &mut simplified.triangles;
        if triangles.is_empty() || triangles.len() as f64 > LEAST_REDUCTION * all.len() as f64 {
            return None;
        }
        let clusters_of_version = self.mesh.cut(triangles, self.most, false);
        let corners = all.as_flattened().iter().map(|&vertex| self.mesh.positions()[vertex as usize]);
        let (center, radius) = sphere_around(corners);
        let sources = || clusters.iter().filter_map(|cluster| cluster.source).map(|source| &groups[source as usize]);
        let largest = |error: fn(&LodGroup) -> f32| sources().map(error).fold(0.0, f32::max);
        let group = LodGroup {
            clusters: 0..0,
            // A surface may shrink in every round. Losses of shading are independent, so that their squares add up.
            position_error: simplified.position_error as f32 + largest(|group| group.position_error),
            shading_error: root_of_squares(simplified.shading_error as f32, largest(|group| group.shading_error)),
            map_error: simplified.map_error as f32 + largest(|group| group.map_error),
            center,
            radius,
        };
        Some(GroupVersion { group, triangles: simplified.triangles, clusters: clusters_of_version })
    }
}

/// A sphere around points, about the middle of the box around them.
fn sphere_around(points: impl Iterator<Item = Vec3> + Clone) -> (Vec3, f32) {
    let center = Bounds::from_points(points.clone()).map_or(Vec3::ZERO, |bounds| bounds.center());
    let radius = points.map(|p| p.as_dvec3().distance(center.as_dvec3())).fold(0.0, f64::max);
    // Rounded up.
    (center, (radius as f32).next_up())
}

/// The root of a² + b², no less than either.
fn root_of_squares(a: f32, b: f32) -> f32 {
    let [a, b] = [f64::from(a), f64::from(b)];
    (a * a + b * b).sqrt() as f32
}

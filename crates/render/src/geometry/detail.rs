//! Levels of detail: coarser versions of a mesh, and when one of them is fine enough.

use crate::geometry::patches::{self, MeshPatch};
use crate::lights::gather::Lights;
use crate::lights::terms::by_vertex_shader;
use crate::view::camera::View;
use crate::view::matrices::ModelView;
use bevy_ecs::prelude::{ReflectResource, Resource};
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use halfway_lighting::equations::Place;
use halfway_lighting::{Frequency, Terms};
use halfway_mesh::Mesh;
use std::ops::Range;
use std::sync::Arc;

/// Where patches have light lists of their own, those of a level have in the mean no larger radius than the whole mesh's
/// divided by this, or than the finest's and a quarter more.
const PATCHES_ACROSS: f32 = 10.0;

/// Slices of a sphere, an even number.
const SLICES: u8 = 8;

/// How coarse a mesh may be drawn. A coarser level takes its place where
///
/// - no point of its surface moves by more than `pixels` on the picture, and
/// - either no edge of the level is longer than a pixel, or no light's diffuse or specular term changes by more than
///   `shading` of the largest value that the term can have there.
///
/// What shading changes by is estimated. A term with exponent n (1 for diffuse) changes by
///
/// - √n·((n − 1)/n)^((n − 1)/2)·δ, its steepest slope, with δ how far the level's normals are off,
/// - and where it is shaded at the vertices by ½·n·ω² + 6·w² more, the second-order error of interpolation: ω = R + ½(w + u)
///   is how far n and h turn against each other within a triangle, R the spread of its normals, w = e/(√3·d) and u its size
///   as seen from the nearest light and from a local viewer (e the longest edge, within a circle of e/√3, Jung 1901); 6·w²
///   is for attenuation, up to the inverse square.
///
/// Phong's reflection vector turns twice as far. Flat shading shows the triangles themselves, so that only the length of
/// edges counts. Vertices lit by spots, whose rims are sharp, or by more than eight lights keep all triangles.
///
/// Levels are made in the background once a mesh has been seen in two frames; until then it is drawn as it is.
/// Blended objects, whose triangles are drawn in the order of their mesh, and objects that are scaled differently along
/// different axes keep all triangles.
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Resource, Clone, Debug, Default, PartialEq)]
pub struct LevelsOfDetail {
    /// How far a point may move, in pixels. Default 0.5; 0 draws every mesh as it is.
    pub pixels: f32,
    /// How much a term may change, as a part of its largest value. Default 0.1; of that no more than
    /// an eighth is measured under Gouraud shading and no more than a half under Phong's.
    pub shading: f32,
}

impl LevelsOfDetail {
    /// Every mesh as it is.
    pub const OFF: Self = Self { pixels: 0.0, shading: 0.0 };
}

impl Default for LevelsOfDetail {
    fn default() -> Self {
        Self { pixels: 0.5, shading: 0.1 }
    }
}

/// A mesh's triangles in the order in which they are drawn: level by level, the finest first, each in patches.
#[derive(Clone, Debug)]
pub(crate) struct MeshTriangles {
    pub(crate) corners: Vec<[u32; 3]>,
    /// Shared, as it is needed after the triangles have gone to the GPU.
    pub(crate) detail: Arc<Detail>,
}

/// The runs of a mesh's triangles as they are drawn.
#[derive(Debug)]
pub(crate) struct Detail {
    pub(crate) levels: Vec<MeshLevel>,
    pub(crate) patches: Vec<MeshPatch>,
    /// What is known of the whole.
    pub(crate) whole: MeshPatch,
}

/// One level, and how far it is from the finest.
#[derive(Clone, Debug)]
pub(crate) struct MeshLevel {
    patches: Range<usize>,
    /// Its patches are too large for short light lists.
    spoils_lists: bool,
    /// In the mesh's units.
    error: f32,
    /// In radians.
    normal_error: f32,
    /// In radians.
    normal_spread: f32,
    /// In the mesh's units.
    longest_edge: f32,
}

/// How an object's level is chosen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Demand<'a> {
    pub(crate) allowed: &'a LevelsOfDetail,
    /// Where its terms are shaded.
    pub(crate) terms: Terms,
    /// Its patches have light lists of their own.
    pub(crate) listed: bool,
    pub(crate) blinn_phong: bool,
    pub(crate) local_viewer: bool,
    /// The larger exponent of the material's sides.
    pub(crate) exponent: f32,
    pub(crate) lights: &'a Lights,
}

/// How near an object is to the picture, to what lights its vertices, and to the eye.
#[derive(Clone, Copy, Debug)]
struct Nearness {
    /// The pixels that a unit of the mesh takes at most.
    pixels: f32,
    /// 1/d of the nearest light with a place, in the mesh's units; infinite where vertices must not be spared.
    light: f32,
    /// 1/d of the eye; 0 for an infinite viewer.
    eye: f32,
}

impl MeshTriangles {
    /// The mesh as it is, in the order of its triangles.
    pub(crate) fn in_order(mesh: &Mesh) -> Self {
        let corners: Vec<_> = mesh.triangles().collect();
        let patches = vec![MeshPatch::new(mesh, &corners, 0)];
        Self { corners, detail: Arc::new(Detail::finest(mesh, patches)) }
    }

    /// The mesh as it is, in patches.
    pub(crate) fn in_patches(mesh: &Mesh) -> Self {
        let mut corners: Vec<_> = mesh.triangles().collect();
        let patches = patches::cut(mesh, &mut corners, 0);
        Self { corners, detail: Arc::new(Detail::finest(mesh, patches)) }
    }

    /// With the mesh's levels of detail.
    pub(crate) fn in_levels(mesh: &Mesh) -> Self {
        let mut corners: Vec<_> = mesh.triangles().collect();
        let mut detail = Detail::finest(mesh, patches::cut(mesh, &mut corners, 0));
        let allowed = (1.25 * patches::mean_radius(&detail.patches)).max(detail.whole.radius() / PATCHES_ACROSS);
        for level in mesh.levels() {
            let mut coarser = level.indices.as_chunks().0.to_vec();
            let start = detail.patches.len();
            detail.patches.extend(patches::cut(mesh, &mut coarser, 3 * corners.len() as u32));
            corners.extend(coarser);
            let spoils_lists = patches::mean_radius(&detail.patches[start..]) > allowed;
            let halfway_mesh::Level { error, normal_error, normal_spread, longest_edge, .. } = level;
            let patches = start..detail.patches.len();
            detail.levels.push(MeshLevel { patches, spoils_lists, error, normal_error, normal_spread, longest_edge });
        }
        Self { corners, detail: Arc::new(detail) }
    }
}

impl Detail {
    /// The mesh itself, in these patches.
    fn finest(mesh: &Mesh, patches: Vec<MeshPatch>) -> Self {
        Self { levels: vec![MeshLevel::finest(patches.len())], patches, whole: MeshPatch::whole(mesh) }
    }

    /// The patches of the coarsest level that will do.
    pub(crate) fn patches(&self, model_view: &ModelView, view: &View, demand: Demand) -> &[MeshPatch] {
        let level = if self.levels.len() > 1 && demand.allowed.pixels > 0.0 && model_view.keeps_angles() {
            let nearness = self.nearness(model_view, view, demand);
            let will_do = |level: &MeshLevel| !(demand.listed && level.spoils_lists) && level.will_do(nearness, demand);
            self.levels.iter().rposition(will_do).unwrap_or(0)
        } else {
            0
        };
        &self.patches[self.levels[level].patches.clone()]
    }

    fn nearness(&self, model_view: &ModelView, view: &View, demand: Demand) -> Nearness {
        let (center, radius) = self.whole.sphere(model_view);
        let scale = model_view.largest_scale();
        let inverse = |distance: f32| if distance > radius { scale / (distance - radius) } else { f32::INFINITY };
        let lights = demand.lights;
        let light = if !by_vertex_shader(demand.terms).contains(&true) {
            0.0
        } else if demand.listed || lights.counts[2] > 0 {
            f32::INFINITY
        } else {
            let distance = |place| match place {
                Place::Point(position) => center.as_dvec3().distance(Vec3::from(position).as_dvec3()) as f32,
                Place::Directional(_) => f32::INFINITY,
            };
            lights.sources.iter().map(|light| inverse(distance(light.place))).fold(0.0, f32::max)
        };
        let eye = if demand.local_viewer { inverse(center.as_dvec3().length() as f32) } else { 0.0 };
        Nearness { pixels: self.pixels_per_unit(model_view, view), light, eye }
    }

    /// An upper bound of how many pixels a short way in the mesh's units takes, anywhere on it. A way of length e at
    /// (x, y, −z) in eye space moves its end by at most f·e/z·√(1 + (x² + y²)/z²), f pixels being the way of a point at
    /// depth 1 that moves by 1. The sphere around the mesh is looked at slice by slice: what is near is not far aside.
    fn pixels_per_unit(&self, model_view: &ModelView, view: &View) -> f32 {
        let (center, radius) = self.whole.sphere(model_view);
        let aside = center.truncate().length();
        let [x, y] = view.projection.scale;
        let steepest = (1.0 / (x * x) + 1.0 / (y * y)).sqrt();
        let slice = |number: u8| {
            // Between −1 and 1, the nearer end being the larger.
            let [far, near] = [number, number + 1].map(|end| f32::from(end) / f32::from(SLICES / 2) - 1.0);
            let widest = (1.0 - far.abs().min(near.abs()).powi(2)).max(0.0).sqrt();
            let nearest = (-center.z - radius * near).max(view.projection.near);
            let slope = ((aside + radius * widest) / nearest).min(steepest);
            (1.0 + slope * slope).sqrt() / nearest
        };
        let most = (0..SLICES).map(slice).fold(0.0, f32::max);
        view.pixels_at_unit_depth * most * model_view.largest_scale()
    }
}

impl MeshLevel {
    /// The mesh itself, in this number of patches.
    fn finest(patches: usize) -> Self {
        Self {
            patches: 0..patches,
            spoils_lists: false,
            error: 0.0,
            normal_error: 0.0,
            normal_spread: 0.0,
            longest_edge: 0.0,
        }
    }

    fn will_do(&self, nearness: Nearness, demand: Demand) -> bool {
        let Demand { allowed, terms, blinn_phong, exponent, .. } = demand;
        if self.error * nearness.pixels > allowed.pixels {
            return false;
        }
        if terms == Terms::NONE || self.longest_edge * nearness.pixels <= 1.0 {
            return true;
        }
        if terms.has(Frequency::Triangle) {
            return false;
        }
        // A level is no farther from lights than the mesh, up to its error.
        let size = self.longest_edge / 3f32.sqrt();
        let (w, u) = (size * nearness.light, size * nearness.eye);
        let change = |specular: bool, at: Frequency| {
            let (n, turn) = match (specular, blinn_phong) {
                (false, _) => (1.0, 1.0),
                (true, true) => (exponent.max(1.0), 1.0),
                (true, false) => (exponent.max(1.0), 2.0),
            };
            let turned = turn * (self.normal_spread + 0.5 * (w + u));
            let interpolated = if at == Frequency::Vertex { 0.5 * n * turned * turned + 6.0 * w * w } else { 0.0 };
            steepest(n) * turn * self.normal_error + interpolated
        };
        let fits = |specular, at| at == Frequency::Never || change(specular, at) <= allowed.shading;
        fits(false, terms.diffuse) && fits(true, terms.specular)
    }
}

/// The steepest slope of cosⁿ f is √n·((n − 1)/n)^((n − 1)/2): √n times 1 at n = 1, and falling to √(n/e).
fn steepest(n: f32) -> f32 {
    n.sqrt() * ((n - 1.0) / n).powf(0.5 * (n - 1.0))
}

//! Meshes laid out for drawing.

use crate::geometry::patches::{MeshTriangles, Patches, Prepared};
use crate::geometry::workshop::Workshop;
use crate::lights::surroundings::Surroundings;
use crate::lights::terms::{by_vertex_shader, shown_shading};
use crate::report::FrameReport;
use crate::values::{DrawsOnce, WaitsForLevels};
use crate::view::camera::View;
use crate::view::select::Representatives;
use bevy_ecs::prelude::*;
use bevy_math::{Vec2, Vec4};
use bevy_platform::collections::HashMap;
use halfway_asset::{AssetId, Assets};
use halfway_lighting::{AlphaMode, Frequency, Shading, Terms, Tolerance, VertexColors};
use halfway_mesh::{Mesh, Mesh3d};
use halfway_texture::{MapKind, Maps, SolidTexture, SurfaceMap, UvSet};
use rayon::prelude::*;
use std::sync::Arc;

/// Meshes of so many triangles take longer to measure and to cut into patches than to draw.
const LARGE: usize = 1 << 16;

/// One mesh, laid out for one way of shading.
pub struct Geometry {
    /// Its patches.
    pub patches: Arc<Patches>,
    /// The mesh it was made of. While it is kept here, an asset that changes is no longer a clone of it.
    pub(crate) source: Mesh,
    /// The mesh that is drawn: the same, with tangents where they were asked for.
    pub drawn: Mesh,
    /// Some interpolated normal may vanish, so that Phong shading needs the geometric one at hand.
    pub(crate) opposite_normals: bool,
    /// The vertices of the triangles, in drawing order, unless that is the mesh's; `None` once the renderer has taken them, unless the mesh
    /// [moves](Self::moves).
    pub(crate) triangles: Option<Arc<Vec<[u32; 3]>>>,
    /// Whether vertices have moved since the mesh was first drawn, so that they may move again.
    pub(crate) moves: bool,
    /// The same for the CPU renderer, if a thread beside the frames has prepared them.
    pub pieces: Option<Prepared>,
}

/// The layout of a mesh for drawing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent choice")]
pub struct Form {
    /// For flat shading.
    pub flat: bool,
    /// In one piece, with the triangles in the order of the mesh. Else in patches, in the patches' order.
    pub ordered: bool,
    /// With the colors of the vertices.
    pub colored: bool,
    /// With their texture coordinates, and what else images or a mask take.
    pub mapped: bool,
    /// With tangents by this set of coordinates.
    pub tangents: Option<UvSet>,
}

impl Form {
    /// Blended triangles are drawn in the order of the mesh.
    pub(crate) fn new(terms: Terms, paint: &Paint) -> Self {
        let flat = terms.has(Frequency::Triangle);
        let tangents = paint.maps[MapKind::Normal as usize].filter(|_| !flat).map(|map| map.uv_set);
        Self { flat, ordered: paint.blend, colored: paint.colored, mapped: paint.is_mapped(), tangents }
    }

    /// Whether it may have levels of detail. Blended triangles are drawn in the order of the mesh, and tangents make
    /// vertices of their own.
    fn may_have_levels(self) -> bool {
        !self.ordered && self.tangents.is_none()
    }
}

/// The parts of an object's appearance beside its material: colors, images, mask or blending, and solid.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Paint<'a> {
    /// The colors of the vertices.
    pub colored: bool,
    /// Images, where the mesh has coordinates for them.
    pub maps: [Option<&'a SurfaceMap>; MapKind::COUNT],
    /// The opacity below which there is nothing.
    pub(crate) mask: Option<f32>,
    /// Whether it is blended.
    pub(crate) blend: bool,
    /// The solid that it is cut from.
    pub solid: Option<&'a SolidTexture>,
    /// An environment lights it.
    pub surrounded: bool,
}

/// The components that paint an object.
pub(crate) type PaintComponents =
    (Option<&'static VertexColors>, Option<&'static Maps>, Option<&'static AlphaMode>, Option<&'static SolidTexture>);

/// The same of one object.
pub(crate) type PaintOf<'a> =
    (Option<&'a VertexColors>, Option<&'a Maps>, Option<&'a AlphaMode>, Option<&'a SolidTexture>);

impl<'a> Paint<'a> {
    /// The images of an unlit object that make its base color or its opacity.
    pub(crate) fn new(
        mesh: &Mesh,
        (colors, maps, alpha, solid): PaintOf<'a>,
        shading: Shading,
        surrounded: bool,
    ) -> Self {
        let lit = shading != Shading::Unlit;
        let colored = mesh.colors().is_some() && colors != Some(&VertexColors::Ignore);
        let has_uvs = [0, 1].map(|set| mesh.uv_set(set).is_some());
        let mut maps = maps.map_or_else(Default::default, |maps| maps.shown(has_uvs));
        for kind in MapKind::ALL.into_iter().filter(|kind| !lit && !kind.is_of_base_color()) {
            maps[kind as usize] = None;
        }
        let alpha = alpha.copied().unwrap_or_default();
        // No opacity is below 0.
        let mask = alpha.cutoff().filter(|cutoff| *cutoff > 0.0);
        Self { colored, maps, mask, blend: alpha.blends(), solid, surrounded: surrounded && lit }
    }

    /// Whether there are images, a mask, a solid or an environment.
    pub(crate) fn is_mapped(&self) -> bool {
        self.surrounded || self.mask.is_some() || self.solid.is_some() || self.has_images()
    }

    pub(crate) fn has_images(&self) -> bool {
        self.maps.iter().any(Option::is_some)
    }

    /// Whether an image turns normals.
    pub(crate) fn has_relief(&self) -> bool {
        [MapKind::Normal, MapKind::Height].into_iter().any(|kind| self.maps[kind as usize].is_some())
    }
}

/// All meshes that have been drawn, until their assets change or go.
#[derive(Resource, Default)]
pub struct Geometries {
    meshes: HashMap<(AssetId<Mesh>, Form), Geometry>,
    /// The numbers of meshes and of assets at the last search for removed ones.
    looked: (usize, usize),
    /// The number of meshes dropped since the start.
    pub(crate) forgotten: u64,
    /// The number of meshes laid out since the start.
    pub(crate) laid_out: u64,
}

impl Geometries {
    /// The mesh of an asset, laid out in a form.
    pub fn get(&self, id: AssetId<Mesh>, form: Form) -> Option<&Geometry> {
        self.meshes.get(&(id, form))
    }

    pub(crate) fn get_mut(&mut self, id: AssetId<Mesh>, form: Form) -> Option<&mut Geometry> {
        self.meshes.get_mut(&(id, form))
    }

    /// The number of meshes that are laid out, each counted once a form.
    pub fn len(&self) -> usize {
        self.meshes.len()
    }

    /// Whether none is laid out.
    pub fn is_empty(&self) -> bool {
        self.meshes.is_empty()
    }

    /// Forgets all meshes, as if none had been drawn.
    pub fn forget_all(&mut self) {
        self.forgotten += self.meshes.len() as u64;
        self.meshes.clear();
    }

    /// Lays the mesh out unless it is, and with its levels of detail once they are there. A mesh whose vertices have moved
    /// keeps its patches, from the second time on.
    fn ensure(
        &mut self,
        (id, form): (AssetId<Mesh>, Form),
        mesh: &Mesh,
        levels: Option<&MeshTriangles>,
        once: DrawsOnce,
    ) {
        let there = self.meshes.get(&(id, form));
        let is_there = there.is_some_and(|there| {
            there.source.is_clone_of(mesh) && levels.is_none_or(|levels| Arc::ptr_eq(&levels.patches, &there.patches))
        });
        if is_there {
            return;
        }
        // Tangents split vertices, and nothing else changes.
        let dressed = form.tangents.filter(|_| mesh.tangents().is_none());
        let dressed = dressed.and_then(|set| mesh.clone().with_tangents_of(set as usize).ok());
        let drawn = dressed.unwrap_or_else(|| mesh.clone());
        let before = there.filter(|there| levels.is_none() && drawn.shares_triangles(&there.drawn));
        let moves = before.is_some();
        let moved = before.and_then(|before| before.moved_to(&drawn));
        let MeshTriangles { corners, patches, pieces } = match (moved, levels) {
            (Some(moved), _) => moved,
            (None, Some(levels)) => levels.clone(),
            (None, None) if once.0 && drawn.triangle_count() >= LARGE => MeshTriangles::unmeasured(&drawn),
            (None, None) if form.ordered => MeshTriangles::in_order(&drawn),
            (None, None) => MeshTriangles::in_patches(&drawn),
        };
        let listed = if patches.are_unsorted() { drawn.indices().as_chunks::<3>().0 } else { &corners[..] };
        let opposite_normals = !form.flat && has_opposite_normals(&drawn, listed);
        let triangles = Some(corners);
        let geometry = Geometry { patches, source: mesh.clone(), drawn, opposite_normals, triangles, moves, pieces };
        self.meshes.insert((id, form), geometry);
        self.laid_out += 1;
    }
}

impl Geometry {
    /// The patches of the same triangles between moved vertices; `None` where they are not kept, or lie so far apart by
    /// now that others are better.
    fn moved_to(&self, mesh: &Mesh) -> Option<MeshTriangles> {
        let corners = self.triangles.clone().filter(|_| self.moves)?;
        let patches = Arc::new(self.patches.moved_to(mesh, &corners)?);
        Some(MeshTriangles { corners, patches, pieces: None })
    }
}

/// The texture coordinates of both sets, zeros where there are none.
pub fn both_uvs(mesh: &Mesh) -> Vec<Vec4> {
    let of = |set: usize, vertex: usize| mesh.uv_set(set).map_or(Vec2::ZERO, |uvs| uvs[vertex]);
    let both = |vertex| {
        let ([u, v], [s, t]) = (of(0, vertex).to_array(), of(1, vertex).to_array());
        Vec4::new(u, v, s, t)
    };
    (0..mesh.positions().len()).map(both).collect()
}

/// Whether no term is shaded once a triangle or vertex: then a picture does not show how a surface is cut into triangles,
/// and levels of detail may stand for it.
pub(crate) fn shades_pixels_alone(terms: Terms) -> bool {
    !by_vertex_shader(terms).contains(&true)
}

/// The components that decide how an object's mesh is laid out.
type LaidOut = (&'static Mesh3d, Option<&'static Shading>, PaintComponents, Option<&'static Tolerance>);

/// Lays out the meshes of visible objects that are not yet, for the way they are shaded.
///
/// Pictures that are read back wait for levels of detail, so that they are the same in every process.
#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn lay_out(
    meshes: Res<Assets<Mesh>>,
    objects: Query<LaidOut>,
    representatives: Res<Representatives>,
    view: Res<View>,
    surroundings: Res<Surroundings>,
    (waits, once): (Res<WaitsForLevels>, Res<DrawsOnce>),
    mut workshop: ResMut<Workshop>,
    mut geometries: ResMut<Geometries>,
    mut report: ResMut<FrameReport>,
) {
    workshop.collect();
    let mut last = None;
    for (Mesh3d(handle), shading, paint, tolerance) in objects.iter_many(&representatives.0).flatten() {
        let Some(mesh) = meshes.get(handle) else { continue };
        let shading = shown_shading(shading, &view);
        let paint = Paint::new(mesh, paint, shading, surroundings.are_there());
        let terms = Terms::from(shading);
        let wanted = (handle.id(), Form::new(terms, &paint));
        let pixels = tolerance.unwrap_or(&view.tolerance).pixels;
        let has_levels = pixels > 0.0 && shades_pixels_alone(terms) && wanted.1.may_have_levels();
        if last.replace((wanted, has_levels)) != Some((wanted, has_levels)) {
            let levels = if has_levels { workshop.levels(wanted.0, mesh, waits.0) } else { None };
            geometries.ensure(wanted, mesh, levels, *once);
        }
    }
    report.levels_pending = workshop.pending();
    report.errors.append(&mut workshop.failures);
}

/// Forgets meshes whose assets are gone. It looks for them only when the number of assets or that of laid out meshes is
/// another than it was: without that nothing grows. (Messages would not do: they live for two updates of the App, and
/// the frames of an App may be fewer.) A mesh that changed is found when it is drawn next.
pub(crate) fn forget_removed(
    meshes: Res<Assets<Mesh>>,
    mut geometries: ResMut<Geometries>,
    mut workshop: ResMut<Workshop>,
) {
    let before = geometries.meshes.len();
    if geometries.looked == (before, meshes.len()) {
        return;
    }
    geometries.meshes.retain(|&(id, _), _| meshes.contains(id));
    workshop.retain(|id| meshes.contains(id));
    let after = geometries.meshes.len();
    geometries.forgotten += (before - after) as u64;
    geometries.looked = (after, meshes.len());
}

/// Whether any triangle's normals can cancel under interpolation. While all pairs of the three have
/// `n_i·n_j ≥ −0.49`, `|Σ b_i n_i|² ≥ Σ b_i² − 0.98 Σ b_i b_j ≥ 0.0066` everywhere on the triangle.
fn has_opposite_normals(mesh: &Mesh, triangles: &[[u32; 3]]) -> bool {
    let normals = mesh.normals();
    triangles.par_iter().with_min_len(1 << 12).any(|triangle| {
        let [a, b, c] = triangle.map(|index| normals[index as usize]);
        a.dot(b).min(b.dot(c)).min(c.dot(a)) < -0.49
    })
}

//! Meshes laid out for drawing: shared vertices for smooth shading, one vertex a triangle for flat.

use crate::frame::report::FrameReport;
use crate::geometry::detail::{Detail, LevelsOfDetail, MeshTriangles};
use crate::geometry::flat::FlatMesh;
use crate::geometry::workshop::{Workshop, is_same};
use crate::lights::terms::Chosen;
use crate::view::matrices::Visible;
use bevy_asset::{AssetEvent, AssetId, Assets};
use bevy_ecs::prelude::*;
use bevy_platform::collections::HashMap;
use halfway_lighting::{Blend, Frequency, Terms};
use halfway_mesh::{Mesh, Mesh3d};
use std::sync::Arc;

/// One mesh, laid out for one way of shading.
pub(crate) struct Geometry {
    /// The runs of its triangles.
    pub(crate) detail: Arc<Detail>,
    /// What it was made of; a mesh is immutable and shares its data, so the same data is the same mesh.
    pub(crate) source: Mesh,
    /// Some interpolated normal may vanish, so that Phong shading needs the geometric one at hand.
    pub(crate) opposite_normals: bool,
    /// Until what draws it has taken it.
    pub(crate) layout: Option<Layout>,
}

/// Vertices, and which of them make triangles, in the order in which they are drawn.
pub(crate) enum Layout {
    /// The vertices of the mesh, and their numbers.
    Smooth(Vec<u32>),
    /// Vertices and numbers of their own.
    Flat(FlatMesh),
}

/// How a mesh is laid out for drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Form {
    /// For flat shading.
    pub(crate) flat: bool,
    /// In one piece, with the triangles in the order of the mesh. Else in patches, in the patches' order.
    pub(crate) ordered: bool,
}

impl Form {
    pub(crate) const ALL: [Self; 4] = [
        Self { flat: false, ordered: false },
        Self { flat: false, ordered: true },
        Self { flat: true, ordered: false },
        Self { flat: true, ordered: true },
    ];

    /// Blended triangles are drawn in the order of the mesh.
    pub(crate) fn new(terms: Terms, blend: bool) -> Self {
        Self { flat: terms.has(Frequency::Triangle), ordered: blend }
    }
}

/// All meshes that have been drawn, until their assets change or go.
#[derive(Resource, Default)]
pub(crate) struct Geometries {
    meshes: HashMap<(AssetId<Mesh>, Form), Geometry>,
    /// How many meshes have been forgotten since the start.
    pub(crate) forgotten: u64,
}

impl Geometries {
    pub(crate) fn get(&self, id: AssetId<Mesh>, form: Form) -> Option<&Geometry> {
        self.meshes.get(&(id, form))
    }

    pub(crate) fn get_mut(&mut self, id: AssetId<Mesh>, form: Form) -> Option<&mut Geometry> {
        self.meshes.get_mut(&(id, form))
    }

    /// Lays the mesh out unless it is, and its levels of detail once they are there.
    fn ensure(&mut self, (id, form): (AssetId<Mesh>, Form), mesh: &Mesh, levels: Option<&MeshTriangles>) {
        let there = self.meshes.get(&(id, form)).filter(|geometry| is_same(&geometry.source, mesh));
        if there.is_some_and(|there| levels.is_none_or(|levels| Arc::ptr_eq(&levels.detail, &there.detail))) {
            return;
        }
        let opposite_normals =
            there.map_or_else(|| !form.flat && has_opposite_normals(mesh), |there| there.opposite_normals);
        let MeshTriangles { corners, detail } = match levels {
            Some(levels) => levels.clone(),
            None if form.ordered => MeshTriangles::in_order(mesh),
            None => MeshTriangles::in_patches(mesh),
        };
        let layout = if form.flat {
            Layout::Flat(FlatMesh::new(mesh.positions(), &corners))
        } else {
            Layout::Smooth(corners.into_flattened())
        };
        let geometry = Geometry { detail, source: mesh.clone(), opposite_normals, layout: Some(layout) };
        self.meshes.insert((id, form), geometry);
    }
}

/// Lays out the meshes of visible objects that are not yet, for the way they are shaded.
pub(crate) fn lay_out(
    meshes: Res<Assets<Mesh>>,
    objects: Query<(&Mesh3d, &Chosen, Has<Blend>)>,
    visible: Res<Visible>,
    allowed: Res<LevelsOfDetail>,
    mut workshop: ResMut<Workshop>,
    mut geometries: ResMut<Geometries>,
    mut report: ResMut<FrameReport>,
) {
    workshop.collect();
    let mut last = None;
    for (Mesh3d(handle), chosen, blend) in objects.iter_many(&visible.0).flatten() {
        let wanted = (handle.id(), Form::new(chosen.0, blend));
        if last.replace(wanted) == Some(wanted) {
            continue;
        }
        let Some(mesh) = meshes.get(handle) else { continue };
        let levels =
            if wanted.1.ordered || *allowed == LevelsOfDetail::OFF { None } else { workshop.levels(wanted.0, mesh) };
        geometries.ensure(wanted, mesh, levels);
    }
    report.levels_pending = workshop.pending();
}

/// Forgets meshes that are gone. A mesh that changed is found when it is drawn next, without an event.
pub(crate) fn forget_removed(
    mut events: MessageReader<AssetEvent<Mesh>>,
    mut geometries: ResMut<Geometries>,
    mut workshop: ResMut<Workshop>,
) {
    for event in events.read() {
        if let AssetEvent::Removed { id } | AssetEvent::Unused { id } = event {
            workshop.forget(*id);
            for form in Form::ALL {
                geometries.forgotten += u64::from(geometries.meshes.remove(&(*id, form)).is_some());
            }
        }
    }
}

/// Whether any triangle's normals can cancel under interpolation; those of coarser levels, which do so only where a
/// triangle is smaller than a pixel, are not looked at. While all pairs of the three have
/// `n_i·n_j ≥ −0.49`, `|Σ b_i n_i|² ≥ Σ b_i² − 0.98 Σ b_i b_j ≥ 0.0066` everywhere on the triangle.
fn has_opposite_normals(mesh: &Mesh) -> bool {
    let normals = mesh.normals();
    mesh.triangles().any(|triangle| {
        let [a, b, c] = triangle.map(|index| normals[index as usize]);
        a.dot(b).min(b.dot(c)).min(c.dot(a)) < -0.49
    })
}

//! Upload: meshes as the rasterizer takes them.

use crate::batch::batches::Batches;
use crate::batch::drawn_meshes::DrawnMeshes;
use crate::frame::report::FrameReport;
use crate::geometry::detail::{Detail, MeshTriangles};
use crate::geometry::meshes::{Form, Geometries};
use crate::geometry::uv_boxes::both_uvs;
use bevy_asset::AssetId;
use bevy_ecs::prelude::*;
use halfway_mesh::Mesh;
use halfway_raster::{Pieces, RasterError, TriangleOrder, VertexLists};
use std::sync::Arc;

/// The meshes that have been drawn, in pieces, until they change or go.
#[derive(Resource, Default)]
pub(crate) struct MeshPieces(DrawnMeshes<Arc<Pieces>>);

/// Cuts the meshes that are drawn and not there yet, unless that was done with their levels. What the memory is refused
/// for is not drawn, and its error is in the report, every frame anew.
pub(crate) fn make_ready(
    batches: Res<Batches>,
    mut geometries: ResMut<Geometries>,
    mut meshes: ResMut<MeshPieces>,
    mut report: ResMut<FrameReport>,
) {
    meshes.0.make_ready(&batches, &mut geometries, &mut report, |geometry, indices, form, _| {
        let pieces = match &geometry.pieces {
            Some(pieces) => Arc::clone(pieces),
            None => Arc::new(pieces(&geometry.drawn, &geometry.detail, indices, form)?),
        };
        let bytes = pieces.bytes();
        Ok((pieces, bytes))
    });
}

impl MeshPieces {
    pub(crate) fn get(&self, id: AssetId<Mesh>, form: Form) -> Option<&Pieces> {
        self.0.get(id, form).map(Arc::as_ref)
    }
}

/// The pieces of a mesh with levels, which has neither colors nor images; `None` where they cannot be made, which is
/// told once they are drawn.
pub(crate) fn of_levels(mesh: &Mesh, MeshTriangles { corners, detail, .. }: &MeshTriangles) -> Option<Pieces> {
    pieces(mesh, detail, corners.as_flattened(), Form::default()).ok()
}

/// Draws begin and end where patches do.
fn pieces(source: &Mesh, detail: &Detail, indices: &[u32], form: Form) -> Result<Pieces, RasterError> {
    let cuts: Vec<_> = (0..detail.patches().len() as u32).map(|number| detail.indices(number)).collect();
    let order = if form.ordered { TriangleOrder::Kept } else { TriangleOrder::Clustered };
    let [positions, normals] = [source.positions(), source.normals()].map(bytemuck::cast_slice);
    let colors = source.drawn_colors().filter(|_| form.colored).unwrap_or_default();
    let uvs = if form.mapped { both_uvs(source) } else { Vec::new() };
    let lists = VertexLists {
        normals,
        colors: bytemuck::cast_slice(&colors),
        uvs: bytemuck::cast_slice(&uvs),
        tangents: source.tangents().filter(|_| form.tangents.is_some()).map_or(&[], bytemuck::cast_slice),
    };
    Pieces::with_lists(positions, lists, indices, &cuts, order)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::choice::AdapterChoice;
    use crate::plugin::RenderPlugin;
    use crate::target::canvas::CanvasTarget;
    use crate::target::frame::Headless;
    use bevy_app::App;
    use bevy_asset::Assets;
    use bevy_math::UVec2;
    use bevy_transform::TransformPlugin;
    use bevy_transform::components::Transform;
    use halfway_lighting::{Camera, Material, Shading};
    use halfway_mesh::{Mesh3d, UvSphere};

    /// In a window as without one, for all forms together.
    #[test]
    fn levels_come_in_pieces() {
        let size = UVec2::splat(32);
        for in_window in [false, true] {
            let mut app = App::new();
            app.add_plugins((TransformPlugin, RenderPlugin::default()));
            app.insert_resource(AdapterChoice::cpu()).insert_resource(Headless { size, ..Headless::default() });
            if in_window {
                app.insert_resource(CanvasTarget { size });
            }
            app.world_mut().spawn((Camera::default(), Transform::from_xyz(0.0, 0.0, 3.0)));
            let mesh = Mesh::from(UvSphere::new(1.0, 96, 48));
            let handle = app.world_mut().resource_mut::<Assets<Mesh>>().add(mesh.clone());
            for shading in [Shading::Flat, Shading::Phong] {
                app.world_mut().spawn((Mesh3d(handle.clone()), Material::DEFAULT, shading, Transform::default()));
            }
            let forms = [true, false].map(|flat| Form { flat, ..Form::default() });
            let mut pending = 1;
            while pending > 0 {
                app.update();
                let report = app.world().resource::<FrameReport>();
                assert_eq!(report.errors, []);
                pending = report.levels_pending;
            }
            let world = app.world();
            let [flat, smooth] = forms.map(|form| {
                let made = world.resource::<Geometries>().get(handle.id(), form).and_then(|it| it.pieces.as_ref());
                let drawn = world.resource::<MeshPieces>().0.get(handle.id(), form).expect("drawn");
                assert!(made.is_some_and(|made| Arc::ptr_eq(made, drawn)), "window {in_window}: cut anew for {form:?}");
                drawn
            });
            assert!(Arc::ptr_eq(flat, smooth));
        }
    }
}

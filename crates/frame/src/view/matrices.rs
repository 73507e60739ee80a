//! Select and Matrices: what the frustum sees, and its model-view and normal matrices.

use crate::error::{RenderError, bad_transform, label};
use crate::report::FrameReport;
use crate::view::camera::View;
use bevy_ecs::prelude::*;
use bevy_math::{Affine3A, DAffine3, DMat3, DVec3, Mat3};
use bevy_transform::components::GlobalTransform;
use halfway_asset::Assets;
use halfway_lighting::{Camera, Edges, Shown};
use halfway_mesh::{Mesh, Mesh3d, SpawnOrder};

/// `eye_from_model` of an object, composed in f64 relative to the camera and rounded once.
/// Holds for visible objects after [`RenderSet::Matrices`](crate::sets::RenderSet::Matrices).
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct ModelView {
    /// Model to eye.
    pub eye_from_model: Affine3A,
    /// Whether the matrix mirrors: its determinant is negative, and windings turn over.
    pub mirrored: bool,
    largest_scale: f32,
    keeps_angles: bool,
    made_from: Option<(u64, Affine3A)>,
}

impl ModelView {
    pub(crate) fn new(eye_from_model: &DAffine3) -> Self {
        let DAffine3 { matrix3: m, translation } = eye_from_model;
        Self {
            eye_from_model: Affine3A::from_mat3_translation(m.as_mat3(), translation.as_vec3()),
            mirrored: is_mirror(m),
            largest_scale: largest_scale(m) as f32,
            keeps_angles: keeps_angles(m),
            made_from: None,
        }
    }

    /// An upper bound of how much the matrix stretches a length.
    pub(crate) fn largest_scale(&self) -> f32 {
        self.largest_scale
    }

    /// Whether the matrix scales all directions alike, so that angles between normals stay.
    pub(crate) fn keeps_angles(&self) -> bool {
        self.keeps_angles
    }
}

/// sign(det M) · cof(M) of the upper 3×3 of the model-view matrix, scaled to a largest element of 1:
/// turns model-space normals into eye-space directions, also where M is mirrored or of rank 2.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct NormalMatrix(pub Mat3);

/// The objects that are not [hidden](halfway_lighting::Visibility) and whose bounding sphere meets the frustum, in
/// spawn order.
/// Holds after [`RenderSet::Select`](crate::sets::RenderSet::Select).
#[derive(Resource, Clone, Debug, Default)]
pub struct Visible(pub Vec<Entity>);

type MeshQuery<'w, 's> = Query<
    'w,
    's,
    (
        Entity,
        &'static Mesh3d,
        &'static GlobalTransform,
        &'static SpawnOrder,
        Option<&'static Name>,
        Option<&'static Edges>,
    ),
>;

pub(crate) fn select(
    (objects, cameras): (MeshQuery, Query<&Edges, With<Camera>>),
    shown: Shown,
    meshes: Res<Assets<Mesh>>,
    mut view: ResMut<View>,
    mut visible: ResMut<Visible>,
    mut report: ResMut<FrameReport>,
    // Its memory is kept.
    mut seen: Local<Vec<(SpawnOrder, Entity)>>,
) {
    visible.0.clear();
    seen.clear();
    if view.camera.is_none() {
        return;
    }
    let is_shown = shown.by_entity();
    let of_camera = view.entity.and_then(|camera| cameras.get(camera).ok());
    let mut farthest = 0.0;
    let mut depths = [f64::INFINITY, f64::NEG_INFINITY];
    for (entity, mesh, transform, order, name, edges) in objects.iter().filter(|(entity, ..)| is_shown(*entity)) {
        report.objects += 1;
        // A wireframe has no surface.
        if edges.or(of_camera).is_some_and(|edges| !edges.surface) {
            continue;
        }
        let Some(mesh) = meshes.get(&mesh.0) else {
            report.errors.push(RenderError::MissingMesh { entity: label(entity, name) });
            continue;
        };
        if mesh.triangle_count() == 0 {
            continue;
        }
        if !transform.affine().is_finite() {
            report.errors.push(bad_transform(entity, name, transform));
            continue;
        }
        let eye_from_model = compose(&view.eye_from_world, transform);
        if is_flat_twice(&eye_from_model.matrix3) {
            continue;
        }
        let bounds = mesh.bounds();
        let center = eye_from_model.transform_point3(bounds.center().as_dvec3());
        let radius = f64::from(bounds.radius()) * largest_scale(&eye_from_model.matrix3);
        if view.lens.sees(center.as_vec3().to_array(), radius as f32) {
            farthest = f64::max(farthest, center.length() + radius);
            depths = [f64::min(depths[0], -center.z - radius), f64::max(depths[1], -center.z + radius)];
            seen.push((*order, entity));
        }
    }
    view.unit_exponent = unit_exponent(farthest);
    view.lens = view.lens.fitted(depths.map(|depth| depth as f32));
    seen.sort_unstable();
    visible.0.extend(seen.iter().map(|&(_, entity)| entity));
    report.visible = visible.0.len() as u32;
}

/// Whether a matrix maps everything to a line or a point, so that no triangle has an area. An area that only rounding
/// leaves is not visible.
fn is_flat_twice(m: &DMat3) -> bool {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = *m;
    [x.cross(y), y.cross(z), z.cross(x)].iter().all(|cofactors| *cofactors == DVec3::ZERO)
}

/// Of the unit in which the shaders measure a scene whose farthest visible point is at this distance: squares of
/// distances down to 10⁻¹⁷ of it, and of lights as far again beyond it, are normal numbers of f32. `SwiftShader` also
/// multiplies the depths of three corners: from 10¹² on interpolated values lose their perspective.
fn unit_exponent(farthest: f64) -> i32 {
    const MOST: i32 = 30;
    const LEAST: i32 = -40;
    let exponent = farthest.log2().ceil();
    match exponent as i32 {
        _ if !exponent.is_finite() => 0,
        large if large > MOST => MOST - large,
        small if small < LEAST => -small,
        _ => 0,
    }
}

pub(crate) fn compute(
    mut objects: Query<(&GlobalTransform, &mut ModelView, &mut NormalMatrix)>,
    visible: Res<Visible>,
    view: Res<View>,
    mut report: ResMut<FrameReport>,
) {
    for &entity in &visible.0 {
        let Ok((transform, mut model_view, mut normal_matrix)) = objects.get_mut(entity) else { continue };
        let source = (view.epoch, transform.affine());
        if model_view.made_from == Some(source) {
            continue;
        }
        let eye_from_model = compose(&view.eye_from_world, transform);
        *model_view = ModelView { made_from: Some(source), ..ModelView::new(&eye_from_model) };
        normal_matrix.0 = self::normal_matrix(&eye_from_model.matrix3);
        report.matrices += 1;
    }
}

/// `eye_from_model` in f64. Both transforms are world-sized, so only their difference is rounded.
fn compose(eye_from_world: &DAffine3, world_from_model: &GlobalTransform) -> DAffine3 {
    let affine = world_from_model.affine();
    let world_from_model = DAffine3 {
        matrix3: DMat3::from_cols_array(&affine.matrix3.to_cols_array().map(f64::from)),
        translation: DVec3::from_array(affine.translation.to_array().map(f64::from)),
    };
    *eye_from_world * world_from_model
}

/// An upper bound of how much the matrix stretches a length: the Frobenius norm, or the exact factor
/// where the columns are orthogonal, as they are without shear.
fn largest_scale(m: &DMat3) -> f64 {
    let lengths = [m.x_axis, m.y_axis, m.z_axis].map(DVec3::length);
    let [x, y, z] = lengths;
    let largest = x.max(y).max(z);
    let skew = m.x_axis.dot(m.y_axis).abs().max(m.y_axis.dot(m.z_axis).abs()).max(m.z_axis.dot(m.x_axis).abs());
    if skew <= 1e-6 * largest * largest { largest * (1.0 + 2e-6) } else { (x * x + y * y + z * z).sqrt() }
}

/// Whether the columns are equally long and at right angles, up to the rounding of transforms in f32.
fn keeps_angles(m: &DMat3) -> bool {
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
    let square = x.length_squared();
    let alike = |other: f64| (other - square).abs() <= 1e-5 * square;
    let right = |dot: f64| dot.abs() <= 1e-5 * square;
    alike(y.length_squared()) && alike(z.length_squared()) && right(x.dot(y)) && right(y.dot(z)) && right(z.dot(x))
}

/// Whether the matrix turns windings over: its determinant is negative. Transforms are kept in f32, so a determinant of
/// unit columns within 8 ε of 0 is a rounding error; such a matrix flattens, and counts as not mirroring.
fn is_mirror(m: &DMat3) -> bool {
    let unit =
        DMat3::from_cols(m.x_axis.normalize_or_zero(), m.y_axis.normalize_or_zero(), m.z_axis.normalize_or_zero());
    unit.determinant() < -8.0 * f64::from(f32::EPSILON)
}

/// sign(det M) · cof(M), divided by its largest element so that f32 neither under- nor overflows. The sign of a matrix
/// that flattens is +.
pub fn normal_matrix(m: &DMat3) -> Mat3 {
    let largest = |m: &DMat3| m.to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max);
    let size = largest(m);
    if size == 0.0 || !size.is_finite() {
        return Mat3::ZERO;
    }
    let sign = if is_mirror(m) { -1.0 } else { 1.0 };
    let m = *m * (1.0 / size);
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    let size = largest(&cofactors);
    if size == 0.0 { Mat3::ZERO } else { (cofactors * (sign / size)).as_mat3() }
}

//! Model-view and normal matrices.

use crate::view::camera::View;
use bevy_ecs::prelude::*;
use bevy_math::{Affine3A, DAffine3, DMat3, DVec3, Mat3};
use bevy_transform::components::GlobalTransform;

/// `eye_from_model` of an object, composed in f64 relative to the camera and rounded once.
/// Holds for visible objects after [`RenderSet::Select`](crate::sets::RenderSet::Select). Where several cameras share the
/// picture, it is of the one for which the matrices were made last: while nothing moves, none are made.
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
    /// Of an object with this transform, as the view with this epoch sees it; and its normal matrix.
    #[inline]
    pub(crate) fn of_object(
        eye_from_model: &DAffine3,
        lengths: Lengths,
        epoch: u64,
        transform: &GlobalTransform,
    ) -> (Self, NormalMatrix) {
        let made_from = Some((epoch, transform.affine()));
        let model_view = Self { made_from, ..Self::with_lengths(eye_from_model, lengths) };
        (model_view, NormalMatrix(signed_cofactors(&eye_from_model.matrix3, model_view.mirrored)))
    }

    /// Whether it is what [`of_object`](Self::of_object) makes of these.
    pub(crate) fn is_of(&self, epoch: u64, transform: &GlobalTransform) -> bool {
        self.made_from == Some((epoch, transform.affine()))
    }

    #[inline]
    fn with_lengths(eye_from_model: &DAffine3, lengths: Lengths) -> Self {
        let DAffine3 { matrix3: m, translation } = eye_from_model;
        Self {
            eye_from_model: Affine3A::from_mat3_translation(m.as_mat3(), translation.as_vec3()),
            mirrored: lengths.is_mirror(m),
            largest_scale: lengths.largest_scale(m) as f32,
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

/// Whether a matrix maps everything to a line or a point, so that no triangle has an area. An area that only rounding
/// leaves is not visible.
pub(super) fn is_flat_twice(m: &DMat3) -> bool {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = *m;
    [x.cross(y), y.cross(z), z.cross(x)].iter().all(|cofactors| *cofactors == DVec3::ZERO)
}

/// The [epoch](crate::view::camera::View::epoch) of the view that the matrices of the visible objects are of.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct MatricesOf(pub(crate) u64);

/// The matrices of an object, and what they are made of.
pub(crate) type Matrices = (&'static GlobalTransform, &'static mut ModelView, &'static mut NormalMatrix);

/// Makes the matrices of visible objects, where those that they have are another camera's.
#[cold]
pub(crate) fn make_anew(view: &View, visible: &[Entity], mut objects: Query<Matrices>) {
    for &object in visible {
        let Ok((transform, mut model_view, mut normal_matrix)) = objects.get_mut(object) else { continue };
        if !model_view.is_of(view.epoch, transform) {
            let eye_from_model = compose(&view.eye_from_world, transform);
            let lengths = Lengths::new(&eye_from_model.matrix3);
            (*model_view, *normal_matrix) = ModelView::of_object(&eye_from_model, lengths, view.epoch, transform);
        }
    }
}

/// `eye_from_model` in f64. Both transforms are world-sized, so only their difference is rounded.
#[inline]
pub(super) fn compose(eye_from_world: &DAffine3, world_from_model: &GlobalTransform) -> DAffine3 {
    let affine = world_from_model.affine();
    let world_from_model = DAffine3 {
        matrix3: DMat3::from_cols(
            affine.matrix3.x_axis.as_dvec3(),
            affine.matrix3.y_axis.as_dvec3(),
            affine.matrix3.z_axis.as_dvec3(),
        ),
        translation: affine.translation.as_dvec3(),
    };
    *eye_from_world * world_from_model
}

/// The lengths of the columns of a matrix.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lengths([f64; 3]);

impl Lengths {
    #[inline]
    pub(super) fn new(m: &DMat3) -> Self {
        Self([m.x_axis.length(), m.y_axis.length(), m.z_axis.length()])
    }

    /// An upper bound of how much the matrix stretches a length: the Frobenius norm, or the exact factor
    /// where the columns are orthogonal, as they are without shear.
    #[inline]
    pub(super) fn largest_scale(self, m: &DMat3) -> f64 {
        let Self([x, y, z]) = self;
        let largest = x.max(y).max(z);
        let skew = m.x_axis.dot(m.y_axis).abs().max(m.y_axis.dot(m.z_axis).abs()).max(m.z_axis.dot(m.x_axis).abs());
        if skew <= 1e-6 * largest * largest { largest * (1.0 + 2e-6) } else { (x * x + y * y + z * z).sqrt() }
    }

    /// Whether the matrix turns windings over: its determinant is negative. Transforms are kept in f32, so a determinant
    /// of unit columns within 8 ε of 0 is a rounding error; such a matrix flattens, and counts as not mirroring.
    #[inline]
    fn is_mirror(self, m: &DMat3) -> bool {
        let Self([x, y, z]) = self;
        // Numbers of f32, so that no product of three leaves f64.
        m.determinant() < -8.0 * f64::from(f32::EPSILON) * (x * y * z)
    }
}

/// Whether the columns are equally long and at right angles, up to the rounding of transforms in f32.
#[inline]
fn keeps_angles(m: &DMat3) -> bool {
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
    let square = x.length_squared();
    let alike = |other: f64| (other - square).abs() <= 1e-5 * square;
    let right = |dot: f64| dot.abs() <= 1e-5 * square;
    alike(y.length_squared()) && alike(z.length_squared()) && right(x.dot(y)) && right(y.dot(z)) && right(z.dot(x))
}

/// sign(det M) · cof(M), divided by its largest element so that f32 neither under- nor overflows. The sign of a matrix
/// that flattens is +.
pub fn normal_matrix(m: &DMat3) -> Mat3 {
    signed_cofactors(m, Lengths::new(m).is_mirror(m))
}

#[inline]
fn signed_cofactors(m: &DMat3, mirrored: bool) -> Mat3 {
    let largest = |m: &DMat3| {
        let DVec3 { x, y, z } = m.x_axis.abs().max(m.y_axis.abs()).max(m.z_axis.abs());
        x.max(y).max(z)
    };
    let size = largest(m);
    if size == 0.0 || !size.is_finite() {
        return Mat3::ZERO;
    }
    let sign = if mirrored { -1.0 } else { 1.0 };
    let m = *m * (1.0 / size);
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    let size = largest(&cofactors);
    if size == 0.0 { Mat3::ZERO } else { (cofactors * (sign / size)).as_mat3() }
}

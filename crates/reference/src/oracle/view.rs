//! The view: eye space, and the pixels of the picture in it.

use bevy_math::{DAffine3, DMat3, DVec2, DVec3, UVec2};
use bevy_transform::components::GlobalTransform;
use halfway_lighting::Camera;
use halfway_lighting::equations::Transcendental;

use super::grid::VertexGrid;

/// The position and direction of the camera, and the projection of eye space onto the picture.
///
/// Eye space is right-handed and has world units: the eye at the origin, looking along −Z. Depth is the distance along
/// the view, −z.
#[derive(Clone, Copy, Debug)]
pub(super) struct PictureView {
    eye_from_world: DMat3,
    position: DVec3,
    /// Half the picture's width and height at depth 1.
    half: DVec2,
    size: DVec2,
    pub(super) near: f64,
}

impl PictureView {
    /// The view of a camera; `None` where its transform gives it no place or direction.
    pub(super) fn new(camera: &Camera, transform: &GlobalTransform, size: UVec2) -> Option<Self> {
        let world_from_camera = affine(transform);
        if !world_from_camera.is_finite() || world_from_camera.matrix3.determinant() == 0.0 {
            return None;
        }
        let (_, rotation, position) = world_from_camera.to_scale_rotation_translation();
        let eye_from_world = DMat3::from_quat(rotation.normalize()).transpose();
        let size = size.as_dvec2();
        let half = (0.5 * f64::from(camera.fov_y)).tangent();
        eye_from_world.is_finite().then_some(Self {
            eye_from_world,
            position,
            half: DVec2::new(half * size.x / size.y, half),
            size,
            near: camera.near.into(),
        })
    }

    /// The composition of an object's transform with the view.
    pub(super) fn eye_from_model(&self, world_from_model: &DAffine3) -> DAffine3 {
        DAffine3 {
            matrix3: self.eye_from_world * world_from_model.matrix3,
            // Subtract first: both are world-sized, and visible objects are near the eye.
            translation: self.eye_from_world * (world_from_model.translation - self.position),
        }
    }

    pub(super) fn eye_from_point(&self, world: DVec3) -> DVec3 {
        self.eye_from_world * (world - self.position)
    }

    pub(super) fn eye_from_direction(&self, world: DVec3) -> DVec3 {
        self.eye_from_world * world
    }

    /// The axes of eye space in the world.
    pub(super) fn world_from_eye(&self) -> DMat3 {
        self.eye_from_world.transpose()
    }

    /// The height of the picture's middle pixel, seen from the eye, in radians.
    pub(super) fn pixel_angle(&self) -> f64 {
        2.0 * self.half.y / self.size.y
    }

    pub(super) fn world_from_point(&self, eye: DVec3) -> DVec3 {
        self.eye_from_world.transpose() * eye + self.position
    }

    /// The ray through a point of the picture, in pixels from its top left corner, as far as depth 1.
    pub(super) fn ray(&self, x: f64, y: f64) -> DVec3 {
        let DVec2 { x: width, y: height } = self.size;
        DVec3::new((2.0 * x / width - 1.0) * self.half.x, (1.0 - 2.0 * y / height) * self.half.y, -1.0)
    }

    /// Where a point before the eye lies on the picture, in pixels from its top left corner.
    pub(super) fn pixel(&self, p: DVec3) -> DVec2 {
        let at_depth_1 = p.truncate() / -p.z / self.half;
        0.5 * self.size * (1.0 + DVec2::new(at_depth_1.x, -at_depth_1.y))
    }

    /// The point of the same depth that lies on the picture where the grid has its place, and whether a drawer in
    /// single precision may put it on another one.
    pub(super) fn on_grid(&self, p: DVec3, grid: VertexGrid) -> (DVec3, bool) {
        let exact = self.pixel(p);
        let pixel = grid.place(exact);
        let at_depth_1 = 2.0 * pixel / self.size - 1.0;
        let on_grid = DVec2::new(at_depth_1.x, -at_depth_1.y) * self.half * -p.z;
        // A point in the plane of the eye has no projection.
        if on_grid.is_finite() { (on_grid.extend(p.z), grid.is_tie(exact, self.size)) } else { (p, false) }
    }

    /// [`pixel`](Self::pixel) less `origin`, times the depth: linear in space, and finite wherever the point lies.
    pub(super) fn pixel_by_depth(&self, p: DVec3, origin: DVec2) -> DVec2 {
        let at_depth_1 = DVec2::new(p.x, -p.y) / self.half;
        0.5 * self.size * at_depth_1 - p.z * (0.5 * self.size - origin)
    }

    pub(super) fn size(&self) -> DVec2 {
        self.size
    }
}

/// A `GlobalTransform` in f64.
pub(super) fn affine(transform: &GlobalTransform) -> DAffine3 {
    let affine = transform.affine();
    DAffine3 {
        matrix3: DMat3::from_cols_array(&affine.matrix3.to_cols_array().map(f64::from)),
        translation: DVec3::from_array(affine.translation.to_array().map(f64::from)),
    }
}

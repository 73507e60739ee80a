//! The view: eye space, and the pixels of the picture in it.

use bevy_math::{DAffine3, DMat3, DVec2, DVec3, UVec2};
use bevy_transform::components::GlobalTransform;
use halfway_lighting::{Camera, Lens, ViewRay};

use super::grid::VertexGrid;

/// The position and direction of the camera, and the projection of eye space onto the picture.
///
/// Eye space is right-handed and has world units: the camera at the origin, looking along −Z. Depth is the distance
/// along the view, −z.
///
/// Points are projected by homogeneous coordinates (x, y, −w), w being that of clip space: where the lines through them
/// and the origin meet the picture, the rays through the points themselves do. In a perspective they are the points.
#[derive(Clone, Copy, Debug)]
pub(super) struct PictureView {
    eye_from_world: DMat3,
    position: DVec3,
    /// Half the picture's width and height where w is 1, and its middle there.
    half: DVec2,
    middle: DVec2,
    size: DVec2,
    lens: Lens<f64>,
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
        let lens: Lens<f64> = camera.projection.lens(size.to_array());
        let half = camera.projection.half_extent(size.to_array());
        let size = size.as_dvec2();
        eye_from_world.is_finite().then_some(Self {
            eye_from_world,
            position,
            half: half.into(),
            middle: camera.projection.middle().into(),
            size,
            lens,
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

    /// The angle between the rays of neighbouring pixels where the axis of the view meets the picture, in radians.
    pub(super) fn pixel_angle(&self) -> f64 {
        self.lens.pixel_angle(self.size.to_array())
    }

    /// The depth of the near plane.
    pub(super) fn near(&self) -> f64 {
        self.lens.near
    }

    /// The depth of the far plane; infinite where there is none.
    pub(super) fn far(&self) -> f64 {
        self.lens.far
    }

    /// Whether a depth lies between the near and the far plane.
    pub(super) fn shows(&self, depth: f64) -> bool {
        self.lens.shows(depth)
    }

    /// w of clip space.
    pub(super) fn w(&self, p: DVec3) -> f64 {
        self.lens.w(-p.z)
    }

    /// A number that is greater the nearer a depth is.
    pub(super) fn nearness(&self, depth: f64) -> f64 {
        self.lens.unfitted_nearness(depth)
    }

    /// How far the nearness of a vertex is off where its depth is off by one part of the `terms` that it is the sum of,
    /// and a depth buffer that spans `depths` by one part of its values.
    pub(super) fn nearness_error(&self, depth: f64, terms: f64, depths: f64) -> f64 {
        self.lens.nearness_error(depth, terms, depths)
    }

    /// Whether a depth is that of the near plane or of the far one.
    pub(super) fn is_cut_at(&self, depth: f64) -> bool {
        let (near, far) = (self.near(), self.far());
        depth <= near + near.abs() * 1e-9 || depth >= far - far.abs() * 1e-9
    }

    /// The direction from the viewer to a point, of any length.
    pub(super) fn sight(&self, p: DVec3) -> DVec3 {
        self.lens.sight(p.to_array()).into()
    }

    /// A point by homogeneous coordinates.
    pub(super) fn homogeneous(&self, p: DVec3) -> DVec3 {
        p.with_z(-self.w(p))
    }

    pub(super) fn world_from_point(&self, eye: DVec3) -> DVec3 {
        self.eye_from_world.transpose() * eye + self.position
    }

    /// A point of the picture, in pixels from its top left corner, by homogeneous coordinates with w = 1.
    pub(super) fn at(&self, x: f64, y: f64) -> DVec3 {
        let DVec2 { x: width, y: height } = self.size;
        let at = DVec2::new((2.0 * x / width - 1.0) * self.half.x, (1.0 - 2.0 * y / height) * self.half.y);
        (at + self.middle).extend(-1.0)
    }

    /// The ray through a point of the picture, which is given by homogeneous coordinates with w = 1.
    pub(super) fn ray(&self, at: DVec3) -> OracleRay {
        let ViewRay { origin, direction } = self.lens.ray_at(at.truncate().to_array());
        OracleRay { origin: origin.into(), direction: direction.into() }
    }

    /// The direction of the ray through a point of the picture, in pixels from its top left corner.
    pub(super) fn direction(&self, x: f64, y: f64) -> DVec3 {
        self.ray(self.at(x, y)).direction
    }

    /// Where a point before the eye lies on the picture, in pixels from its top left corner.
    pub(super) fn pixel(&self, p: DVec3) -> DVec2 {
        let at_w_1 = (p.truncate() / self.w(p) - self.middle) / self.half;
        0.5 * self.size * (1.0 + DVec2::new(at_w_1.x, -at_w_1.y))
    }

    /// The point of the same depth that lies on the picture where the grid has its place, and whether a drawer in
    /// single precision may put it on another one.
    pub(super) fn on_grid(&self, p: DVec3, grid: VertexGrid) -> (DVec3, bool) {
        let exact = self.pixel(p);
        let pixel = grid.place(exact);
        let at_w_1 = 2.0 * pixel / self.size - 1.0;
        let on_grid = (DVec2::new(at_w_1.x, -at_w_1.y) * self.half + self.middle) * self.w(p);
        // The shift is rounded, too.
        let reach = self.size * (1.0 + (self.middle / self.half).abs());
        // A point in the plane of the eye has no projection.
        if on_grid.is_finite() { (on_grid.extend(p.z), grid.is_tie(exact, reach)) } else { (p, false) }
    }

    /// [`pixel`](Self::pixel) less `origin`, times w: linear in space, and finite wherever the point lies.
    pub(super) fn pixel_by_w(&self, p: DVec3, origin: DVec2) -> DVec2 {
        let from_middle = p.truncate() - self.w(p) * self.middle;
        let by_w = DVec2::new(from_middle.x, -from_middle.y) / self.half;
        0.5 * self.size * by_w + self.w(p) * (0.5 * self.size - origin)
    }

    pub(super) fn size(&self) -> DVec2 {
        self.size
    }
}

/// A ray in eye space. The point at depth d is `origin + d·direction`.
#[derive(Clone, Copy, Debug)]
pub(super) struct OracleRay {
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
}

impl OracleRay {
    /// The point at a depth.
    pub(super) fn at(&self, depth: f64) -> DVec3 {
        self.origin + self.direction * depth
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

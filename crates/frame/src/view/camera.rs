//! The view: the camera's matrices in f64, and its projection.

use crate::error::{RenderError, bad_transform, label};
use crate::report::FrameReport;
use bevy_ecs::prelude::*;
use bevy_math::{DAffine3, DMat3, DVec3, UVec2};
use bevy_transform::components::{GlobalTransform, Transform};
use halfway_lighting::{
    Camera, Cameras, Lens, Load, Propagation, Reflectance, Shading, Tolerance, ViewTolerance, Viewport, propagation,
};

/// The view of a frame. Holds after [`RenderSet::View`](crate::sets::RenderSet::View).
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct View {
    /// The camera, validated; `None` while there is none to draw with.
    pub camera: Option<Camera>,
    /// Its entity.
    pub entity: Option<Entity>,
    /// World to eye: the inverse of the camera's rotation and translation, in f64.
    pub eye_from_world: DAffine3,
    /// Eye to clip, in world units. Its depth buffer spans the visible objects after
    /// [`RenderSet::Select`](crate::sets::RenderSet::Select).
    pub lens: Lens,
    /// How many pixels a length of 1 across the view takes where w of clip space is 1.
    pub pixels_at_unit_w: f32,
    /// The angle between the rays of neighbouring pixels where the axis of the view meets the picture, in radians.
    pub pixel_angle: f32,
    /// The shading of objects that name none.
    pub shading: Shading,
    /// The reflectance of objects that name none.
    pub reflectance: Reflectance,
    /// Whether the camera's background and sky are drawn, or other cameras' pictures stay.
    pub load: Load,
    /// The tolerance of objects that have none.
    pub tolerance: Tolerance,
    /// Changes with `eye_from_world`; equal epochs mean equal matrices, also of several cameras.
    pub epoch: u64,
    /// log₂ of the length of a world unit in the eye space of the shaders; 0 but for scenes so large or so small that
    /// the squares of their distances leave f32.
    pub unit_exponent: i32,
}

impl View {
    /// The length of a world unit in the eye space of the shaders: a power of two, and 1 but for scenes so large or so
    /// small that the squares of their distances leave f32. Holds after
    /// [`RenderSet::Select`](crate::sets::RenderSet::Select).
    pub fn unit(&self) -> f64 {
        2f64.powi(self.unit_exponent)
    }

    /// The lens for the eye space of the shaders and the rasterizer, in which a world unit is [`unit`](Self::unit) long.
    pub fn lens_of_shaders(&self) -> Lens {
        self.lens.in_unit(self.unit() as f32)
    }
}

/// The size of the picture that is drawn next, in pixels.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PictureSize(pub UVec2);

type CameraQuery<'w, 's> = Query<
    'w,
    's,
    (
        Entity,
        &'static Camera,
        &'static GlobalTransform,
        Option<&'static Shading>,
        Option<&'static Reflectance>,
        Option<&'static Tolerance>,
        Option<&'static Viewport>,
        Option<&'static Name>,
    ),
>;

/// Counts the transforms of views.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub(crate) struct Epoch(u64);

pub(crate) fn update(
    which: Cameras,
    cameras: CameraQuery,
    size: Res<PictureSize>,
    of_view: Res<ViewTolerance>,
    mut epoch: ResMut<Epoch>,
    mut view: ResMut<View>,
    mut report: ResMut<FrameReport>,
) {
    report.begin();
    view.camera = None;
    let current = which
        .current()
        .map_err(|count| if count == 0 { RenderError::NoCamera } else { RenderError::ManyCameras(count) });
    let found = match current {
        Ok(camera) => cameras.get(camera),
        Err(error) => {
            report.errors.push(error);
            return;
        }
    };
    let Ok((entity, camera, transform, shading, reflectance, tolerance, viewport, name)) = found else {
        report.errors.push(RenderError::NoCamera);
        return;
    };
    if let Err(source) = camera.validate().and_then(|()| viewport.map_or(Ok(()), Viewport::validate)) {
        report.errors.push(RenderError::Invalid { entity: label(entity, name), source });
        return;
    }
    let size = size.0;
    if size.min_element() == 0 {
        report.errors.push(RenderError::EmptyPicture { width: size.x, height: size.y });
        return;
    }
    let eye_from_world = eye_from_world(transform);
    if !eye_from_world.is_finite() {
        report.errors.push(bad_transform(entity, name, transform));
        return;
    }
    if eye_from_world != view.eye_from_world {
        epoch.0 += 1;
        view.epoch = epoch.0;
    }
    let lens: Lens = camera.projection.lens(size.to_array());
    let pixels = size.as_vec2().to_array();
    *view = View {
        camera: Some(Camera { samples: camera.samples.of_a_frame(), ..*camera }),
        entity: Some(entity),
        eye_from_world,
        lens,
        pixels_at_unit_w: lens.pixels_at_unit_w(pixels),
        pixel_angle: lens.pixel_angle(pixels),
        shading: shading.copied().unwrap_or_default(),
        reflectance: reflectance.copied().unwrap_or_default(),
        load: viewport.map_or(Load::Clear, |viewport| viewport.load),
        tolerance: tolerance.copied().unwrap_or(of_view.0),
        epoch: view.epoch,
        unit_exponent: 0,
    };
}

/// Draws nothing where transforms are not propagated. Once they have been found to be, it does not look again.
pub(crate) fn require_propagation(
    roots: Query<(Entity, &Transform, &GlobalTransform), Without<ChildOf>>,
    names: Query<&Name>,
    mut works: Local<bool>,
    mut view: ResMut<View>,
    mut report: ResMut<FrameReport>,
) {
    if *works || view.camera.is_none() {
        return;
    }
    match propagation(roots) {
        Propagation::Works => *works = true,
        Propagation::Missing(entity) => {
            report.errors.push(RenderError::NotPropagated { entity: label(entity, names.get(entity).ok()) });
            view.camera = None;
        }
        Propagation::Unknown => {}
    }
}

/// The inverse of the rigid part of the camera's transform.
pub fn eye_from_world(transform: &GlobalTransform) -> DAffine3 {
    let (_, rotation, translation) = transform.to_scale_rotation_translation();
    let eye_from_world = DMat3::from_quat(rotation.as_dquat().normalize()).transpose();
    let position: DVec3 = translation.as_dvec3();
    DAffine3 { matrix3: eye_from_world, translation: -(eye_from_world * position) }
}

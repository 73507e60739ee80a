//! Points of the world on the window, and back.

use bevy_ecs::prelude::*;
use egui::{Pos2, Rect, Vec2 as Points, pos2};
use halfway::lighting::{Lens, Part, Viewport};
use halfway::prelude::*;

/// The camera's picture on the window.
pub(crate) struct Projected {
    eye_from_world: Mat4,
    lens: Lens<f64>,
    /// In points of the panels.
    pub(crate) window: Rect,
}

impl Projected {
    /// `None` without a camera or a window.
    pub(crate) fn new(camera: Entity, window: Rect, world: &World) -> Option<Self> {
        let at = world.get::<GlobalTransform>(camera)?.affine();
        let projection = world.get::<Camera>(camera)?.projection;
        let size = [window.width(), window.height()].map(|points| points.round() as u32);
        if size[0] == 0 || size[1] == 0 {
            return None;
        }
        Some(Self { eye_from_world: Mat4::from(at.inverse()), lens: projection.lens(size), window })
    }

    /// The place of a point of the world; `None` where it is not before the camera.
    pub(crate) fn place(&self, point: Vec3) -> Option<Pos2> {
        let eye = self.eye_from_world.transform_point3(point);
        let [x, y, _, w] = self.lens.clip_from_eye(eye.as_dvec3().to_array());
        let depth = -f64::from(eye.z);
        if !self.lens.shows(depth) || w <= 0.0 {
            return None;
        }
        let share = [(x / w + 1.0) * 0.5, (1.0 - y / w) * 0.5].map(|share| share as f32);
        let Rect { min, .. } = self.window;
        let at = pos2(min.x + share[0] * self.window.width(), min.y + share[1] * self.window.height());
        at.is_finite().then_some(at)
    }

    /// How far a point of the world has to be moved, parallel to the picture, to move on the window by so many points.
    pub(crate) fn moved(&self, point: Vec3, by: Points) -> Vec3 {
        let depth = -f64::from(self.eye_from_world.transform_point3(point).z);
        let size = [self.window.width(), self.window.height()].map(f64::from);
        let length = self.lens.pixel_size(depth, size) as f32;
        let world_from_eye = self.eye_from_world.inverse();
        world_from_eye.transform_vector3(Vec3::new(by.x, -by.y, 0.0) * length)
    }

    /// The length in the world of so many points at the depth of a point.
    pub(crate) fn length(&self, point: Vec3, points: f32) -> f32 {
        self.moved(point, Points::new(points, 0.0)).length()
    }
}

/// A part of the window in whole pixels.
pub(crate) fn pixels_of(area: Rect, scale: f32) -> Viewport {
    let pixel = |at: f32| (at * scale).round().max(0.0) as u32;
    let [left, top, right, bottom] = [area.left(), area.top(), area.right(), area.bottom()].map(pixel);
    Viewport::pixels([left, top, right.saturating_sub(left).max(1), bottom.saturating_sub(top).max(1)])
}

/// A part of a picture, where the picture is a part of the window.
pub(crate) fn within(part: Viewport, picture: Viewport) -> Viewport {
    let Part::Pixels([left, top, width, height]) = picture.part else { return part };
    let [x, y, width, height] = part.rectangle([width, height]).unwrap_or([0, 0, 1, 1]);
    Viewport { part: Part::Pixels([left + x, top + y, width, height]), ..part }
}

/// A part of the window in points.
pub(crate) fn points_of(part: Viewport, scale: f32) -> Rect {
    let Part::Pixels(pixels) = part.part else { return Rect::ZERO };
    let [left, top, width, height] = pixels.map(|pixels| pixels as f32 / scale);
    Rect::from_min_size(pos2(left, top), Points::new(width, height))
}

//! The camera and the lights of a scene that names none.

use bevy_color::LinearRgba;
use bevy_math::{DVec3, Vec3};
use halfway_lighting::{LightComponent, LightRig, TightFit};

use crate::light::{AttachEntry, LightEntry, LightKind};
use crate::view::CameraEntry;

/// The side that a framing camera looks from: 30° to the right of the front, 20° above the ground.
const AZIMUTH: f64 = std::f64::consts::PI / 6.0;
const ELEVATION: f64 = std::f64::consts::PI / 9.0;

/// The factor by which a framing camera is farther away than necessary, so that nothing touches the picture's edge.
const MARGIN: f64 = 1.12;

/// A camera that sees all of `points` (the vertices of the objects, or corners of boxes around them), from the front, a
/// little from the right and from above, as large as it can. `aspect` is the picture's width over its height.
///
/// Without points it is [`CameraEntry::default`]. Points that coincide are seen as if they were a unit apart.
pub fn framing_camera(points: impl IntoIterator<Item = Vec3>, aspect: f32) -> CameraEntry {
    let points: Vec<DVec3> = points.into_iter().map(Vec3::as_dvec3).collect();
    if points.is_empty() {
        return CameraEntry::default();
    }
    let back = DVec3::new(AZIMUTH.sin() * ELEVATION.cos(), ELEVATION.sin(), AZIMUTH.cos() * ELEVATION.cos());
    let right = DVec3::Y.cross(back).normalize();
    let up = back.cross(right);

    let default = CameraEntry::default();
    let tan_y = (f64::from(default.fov_y_deg).to_radians() * 0.5).tan();
    let tan_x = tan_y * f64::from(aspect.clamp(1e-4, 1e4));
    let fit = TightFit::new(&points, [right, up, back], [tan_x, tan_y]);
    let TightFit { center, target, distance: tight, nearest } = fit;
    // Far from the origin the camera must not be rounded onto its target.
    let least = center.abs().max_element() * 1e-5;
    let distance = if tight > 0.0 { (tight * MARGIN).max(least) } else { least.max(1.0) * 3.0 };
    CameraEntry {
        position: in_f32(target + back * distance),
        target: in_f32(target),
        near: near_plane(distance, nearest),
        ..default
    }
}

/// Well in front of everything, yet so near that one can go closer.
fn near_plane(distance: f64, nearest: f64) -> f32 {
    let near = (distance * 0.01).min((distance - nearest) * 0.5);
    near.clamp(f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)) as f32
}

/// A point as a `Transform` holds it.
fn in_f32(v: DVec3) -> [f64; 3] {
    v.to_array().map(|c| f64::from(c.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32))
}

/// The lights of a scene that has none of its own: a key light from the upper left, a weaker fill light from the right,
/// both fixed in the world as seen by the camera of [`framing_camera`], and a faint headlight that moves with the
/// camera, so that no side is black. All are directional, so they suit a scene of any size.
pub fn default_lights() -> Vec<LightEntry> {
    let light = |direction, [red, green, blue]: [f32; 3], shine: f32, attach| {
        let mut entry = LightEntry { attach, ..LightEntry::white(LightKind::Directional) };
        entry.cone.direction = direction;
        entry.light.diffuse = LinearRgba::rgb(red, green, blue);
        entry.light.specular = LinearRgba::rgb(red * shine, green * shine, blue * shine);
        entry
    };
    vec![
        light([0.4, -1.0, -1.0], [0.62, 0.6, 0.57], 1.0, AttachEntry::World),
        light([-1.0, -0.3, -0.3], [0.14, 0.16, 0.19], 0.5, AttachEntry::World),
        light([0.0, 0.0, -1.0], [0.1; 3], 1.0, AttachEntry::Camera),
    ]
}

/// The lights of a rig, attached to the camera.
///
/// ```
/// use halfway_lighting::LightRig;
/// use halfway_scene::{AttachEntry, SceneFile, rig_lights};
///
/// let scene = SceneFile { lights: Some(LightRig::ThreePoint.into()), ..SceneFile::for_model("part.stl") };
/// assert!(rig_lights(LightRig::ThreePoint).iter().all(|light| light.attach == AttachEntry::Camera));
/// ```
pub fn rig_lights(rig: LightRig) -> Vec<LightEntry> {
    let entry = |(light, direction): (LightComponent, Vec3)| {
        let mut entry = match light {
            LightComponent::Hemisphere(light) => {
                LightEntry { hemisphere: light, ..LightEntry::white(LightKind::Hemisphere) }
            }
            LightComponent::Directional(light) => {
                let mut entry = LightEntry::white(LightKind::Directional);
                (entry.light.ambient, entry.light.diffuse) = (light.ambient, light.diffuse);
                entry.light.specular = light.specular;
                entry
            }
            // Rigs have no lights with a place.
            LightComponent::Point(light) => LightEntry { light, ..LightEntry::white(LightKind::Point) },
            LightComponent::Spot(light) => LightEntry { light: light.light, ..LightEntry::white(LightKind::Spot) },
        };
        entry.cone.direction = direction.to_array();
        LightEntry { attach: AttachEntry::Camera, ..entry }
    };
    rig.lights().into_iter().map(entry).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_cmp, reason = "marks and exact values are compared")]

    use super::*;
    use crate::check::Limits;
    use crate::entry::Entry;

    /// The position of a point in the picture, ±1 at its edges.
    fn in_picture(camera: &CameraEntry, aspect: f32, p: Vec3) -> (f64, f64) {
        let [right, up, back] = camera.axes().unwrap();
        let p = p.as_dvec3() - DVec3::from(camera.position);
        let depth = -p.dot(back);
        assert!(depth > f64::from(camera.near), "{depth} is before the near plane {}", camera.near);
        let tan = (f64::from(camera.fov_y_deg).to_radians() * 0.5).tan();
        (p.dot(right) / (depth * tan * f64::from(aspect)), p.dot(up) / (depth * tan))
    }

    #[test]
    fn everything_is_in_the_picture_and_fills_it() {
        let boxes = [
            (Vec3::splat(-1.0), Vec3::splat(1.0)),
            (Vec3::new(-5.0, 0.0, -5.0), Vec3::new(5.0, 0.0, 5.0)),
            (Vec3::new(0.0, -40.0, 0.0), Vec3::new(0.0, 2.0, 0.0)),
            (Vec3::splat(1e-18), Vec3::splat(3e-18)),
            (Vec3::splat(-1e18), Vec3::splat(2e18)),
            (Vec3::new(100.0, 7.0, -3.0), Vec3::new(101.0, 9.0, -2.0)),
        ];
        for (min, max) in boxes {
            for aspect in [0.3, 1.0, 16.0 / 9.0] {
                let corners: Vec<Vec3> = (0..8)
                    .map(|i| {
                        let pick = |bit: u32, axis: usize| if i & bit == 0 { min[axis] } else { max[axis] };
                        Vec3::new(pick(1, 0), pick(2, 1), pick(4, 2))
                    })
                    .collect();
                let camera = framing_camera(corners.iter().copied(), aspect);
                camera.check(&Limits::Any).unwrap();
                let largest = corners
                    .iter()
                    .map(|&p| in_picture(&camera, aspect, p))
                    .fold(0.0, |m: f64, (x, y)| m.max(x.abs()).max(y.abs()));
                // The margin is 12 % of the distance from the middle; the nearest points, half as far away at the most,
                // lose up to twice that at the edge that decides.
                assert!((0.76..1.0).contains(&largest), "{min} {max} {aspect}: {largest}");
            }
        }
    }

    #[test]
    fn a_camera_for_nothing_and_for_one_point() {
        assert_eq!(framing_camera([], 1.0), CameraEntry::default());
        for point in [Vec3::ZERO, Vec3::splat(1e9), Vec3::splat(f32::MAX)] {
            for aspect in [1.0, 0.0, f32::INFINITY] {
                let camera = framing_camera([point], aspect);
                assert!(camera.check(&Limits::Any).is_ok() || point.x == f32::MAX, "{point} {camera:?}");
                assert!(camera.position.iter().all(|c| c.is_finite()));
            }
        }
    }
}

//! Cameras of glTF.

use bevy_math::{Mat4, Vec3};
use bevy_transform::components::Transform;
use halfway_lighting::{Film, InvalidValue, Projection};
use halfway_mesh::{SourceCamera, SourceProjection};

/// The projection of a camera that a model file describes, and its place in the model.
///
/// A perspective has the file's vertical field of view in a picture of any proportions, as viewers of glTF have it; it
/// has no far plane. An orthographic camera shows all of its `xmag` × `ymag` in a picture of any proportions, and more at
/// the sides of one that is wider, or above and below in one that is narrower; nothing is stretched. The frame of a camera
/// may scale, which has no meaning for one: position and directions are taken from it.
///
/// # Errors
/// [`InvalidValue`] for a number out of its range.
pub fn model_camera(source: &SourceCamera) -> Result<(Projection, Transform), InvalidValue> {
    let projection = match source.projection {
        SourceProjection::Perspective { yfov, near, .. } => Projection::perspective(yfov).with_near(near),
        SourceProjection::Orthographic { half_width, half_height, near, far } => {
            let [half_width, half_height] = [half_width, half_height].map(f32::abs);
            let film = Film { aspect: Some(half_width / half_height), ..Film::DEFAULT };
            Projection::Orthographic { height: 2.0 * half_height, near, far: Some(far), film }
        }
    };
    projection.validate()?;
    Ok((projection, camera_place(&source.world_from_camera)))
}

/// The place and the direction of a camera with this frame, without its scale.
pub(crate) fn camera_place(frame: &Mat4) -> Transform {
    let place = Transform::from_translation(frame.w_axis.truncate());
    place.looking_to(frame.transform_vector3(Vec3::NEG_Z), frame.transform_vector3(Vec3::Y))
}

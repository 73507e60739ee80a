//! A warning where a picture shows nothing.

use halfway::prelude::*;
use halfway::render::{EmptyReason, why_empty};

/// Prints why the picture that the App has just drawn shows nothing but its background, with the option that helps.
pub(crate) fn warn_if_empty(app: &mut App, picture: &Picture) {
    let world = app.world_mut();
    let Some(camera) = world.query::<&Camera>().iter(world).next().copied() else { return };
    if shows_only(picture, camera) {
        eprintln!("warning: the picture shows nothing: {}", reason(why_empty(app.world_mut())));
    }
}

/// Whether all pixels are the background's.
fn shows_only(picture: &Picture, camera: Camera) -> bool {
    let (_, height) = picture.dimensions();
    let behind = (0..height).map(|row| {
        let LinearRgba { red, green, blue, .. } = camera.background_at((f64::from(row) + 0.5) / f64::from(height));
        [red, green, blue]
    });
    match picture {
        Picture::Byte(image) => {
            let byte = |channel: f32| (camera.encoding.encode(f64::from(channel.clamp(0.0, 1.0))) * 255.0).round();
            image.rows().zip(behind).all(|(mut row, behind)| {
                let expected = behind.map(byte);
                row.all(|pixel| {
                    let same = |(byte, expected): (&u8, f64)| (f64::from(*byte) - expected).abs() <= 1.0;
                    pixel.0[3] == 0 || pixel.0[..3].iter().zip(expected).all(same)
                })
            })
        }
        Picture::Float(image) => image.rows().zip(behind).all(|(mut row, behind)| {
            row.all(|pixel| pixel.0[3] == 0.0 || pixel.0[..3].iter().zip(behind).all(|(a, b)| (a - b).abs() <= 1e-6))
        }),
    }
}

fn reason(reason: Option<EmptyReason>) -> String {
    match reason {
        Some(EmptyReason::NoObject) => "the scene has no objects".to_owned(),
        Some(EmptyReason::AllHidden(count)) => format!("{} hidden", are(count)),
        Some(EmptyReason::NoSize(count)) => {
            format!(
                "{} without any size; the scale of its transform may be 0, or all its vertices in one place",
                are(count)
            )
        }
        Some(EmptyReason::AllBehind(count)) => {
            format!("{} behind the camera; --view front, say, turns the camera round", are(count))
        }
        Some(EmptyReason::AllOutside(count)) => {
            format!("{} outside of the camera's view; --fit 0.9 takes it to where all can be seen", are(count))
        }
        Some(EmptyReason::NoLight(_)) => "nothing lights what is in view; --lights studio does".to_owned(),
        Some(EmptyReason::CameraInside { entity }) => format!(
            "the camera is inside of {entity}, whose back faces are not drawn; --fit 0.9 takes it out, and --faces \
             both shows the inside"
        ),
        Some(EmptyReason::FacesAway(_)) => "all that is in view turns only faces to the camera that are not drawn; \
                                             --faces both draws them"
            .to_owned(),
        Some(other) => other.to_string(),
        None => "no triangle covers the middle of a pixel, or all is as dark as the background; --fit 0.9 frames the \
                 objects, and --lights studio lights them"
            .to_owned(),
    }
}

/// "the only object is", or how many are.
fn are(count: usize) -> String {
    if count == 1 { "the only object is".to_owned() } else { format!("all {count} objects are") }
}

//! Several views of a scene, for one sheet.

use bevy_math::{UVec2, Vec3};
use bevy_transform::components::Transform;
use halfway_lighting::{Camera, Choices, Framing, Projection, View};

use super::SceneOptions;

/// The views of a sheet with their captions.
#[derive(Clone, Debug, PartialEq)]
pub struct Views(Vec<(String, View)>);

/// The most views of a sheet.
const MOST: usize = 64;

/// Views between commas, by name or by two angles: `front,right,30,20`.
///
/// # Errors
/// A sentence that says which is not a view, and what was expected.
pub fn views(text: &str) -> Result<Views, String> {
    let mut words = text.split(',').map(str::trim).peekable();
    let mut views = Vec::new();
    while let Some(word) = words.next() {
        let is_number = |word: &str| word.parse::<f32>().is_ok();
        let word = match words.next_if(|next| is_number(word) && is_number(next)) {
            Some(elevation) => format!("{word},{elevation}"),
            None => word.to_owned(),
        };
        let view = word.parse().map_err(|expected| format!("{word:?}: {expected}"))?;
        views.push((word, view));
    }
    if views.len() > MOST {
        return Err(format!("{} views; expected at most {MOST}", views.len()));
    }
    Ok(Views(views))
}

impl Views {
    /// How many of them stand beside each other.
    pub fn columns(&self) -> u32 {
        let count = self.0.len() as u32;
        if count <= 3 { count } else { f64::from(count).sqrt().ceil() as u32 }
    }

    /// The caption and the camera of each view, as pictures of `size` pixels frame these points; `base` is the scene's
    /// camera. All orthographic views have one scale.
    pub fn cameras(
        &self,
        options: &SceneOptions,
        base: Camera,
        points: &[Vec3],
        size: UVec2,
    ) -> Vec<(String, Camera, Transform)> {
        let aspect = size.x as f32 / size.y as f32;
        let projection = match base.projection {
            _ if options.ortho == Some(true) => Projection::orthographic(1.0),
            Projection::Orthographic { .. } => Projection::default(),
            perspective @ Projection::Perspective { .. } => perspective,
        };
        let base = Camera { projection, ..base };
        let framed = |(name, view): &(String, View)| {
            let framing: Framing = options.seen_from(*view);
            let (camera, place) = framing.camera(base, points.iter().copied(), aspect);
            (caption(name), camera, place)
        };
        let mut cameras: Vec<_> = self.0.iter().map(framed).collect();
        share_scale(&mut cameras);
        cameras
    }
}

/// Gives all orthographic cameras the greatest height of one.
fn share_scale(cameras: &mut [(String, Camera, Transform)]) {
    let height = |camera: &Camera| match camera.projection {
        Projection::Orthographic { height, .. } => Some(height),
        Projection::Perspective { .. } => None,
    };
    let most = cameras.iter().filter_map(|(_, camera, _)| height(camera)).fold(0.0, f32::max);
    for (_, camera, _) in cameras {
        if let Projection::Orthographic { height, .. } = &mut camera.projection {
            *height = most;
        }
    }
}

/// A named view as it is, angles with their degrees.
fn caption(name: &str) -> String {
    if View::from_key(name).is_some() { name.to_owned() } else { format!("{name} deg") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_hold_names_and_pairs_of_angles() {
        let names =
            |text: &str| views(text).map(|Views(views)| views.into_iter().map(|(name, _)| name).collect::<Vec<_>>());
        assert_eq!(names("front, right,iso"), Ok(vec!["front".into(), "right".into(), "iso".into()]));
        assert_eq!(names("30,20,top,-45,10"), Ok(vec!["30,20".into(), "top".into(), "-45,10".into()]));
        for bad in ["", "front,", "30", "front,30", "rigth", &["iso"; 65].join(",")] {
            assert!(names(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn orthographic_views_share_their_scale() {
        let seen = |camera| (String::new(), camera, Transform::IDENTITY);
        let mut cameras =
            vec![seen(Camera::orthographic(2.0)), seen(Camera::orthographic(3.0)), seen(Camera::default())];
        share_scale(&mut cameras);
        assert_eq!(cameras[0].1, Camera::orthographic(3.0));
        assert_eq!(cameras[2].1, Camera::default());
    }
}

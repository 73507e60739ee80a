//! `--views`: several views of a scene on one sheet.

use halfway::lighting::{Choices, Framing, View};
use halfway::output::ContactSheet;
use halfway::prelude::*;
use halfway::scene::outline;

use crate::failure::Failure;
use crate::framing::FramingArgs;

/// The views of a sheet with their captions.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Views(Vec<(String, View)>);

/// The most views of a sheet.
const MOST: usize = 64;

/// Views between commas, by name or by two angles.
pub(crate) fn parse_views(text: &str) -> Result<Views, String> {
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
    fn columns(&self) -> u32 {
        let count = self.0.len() as u32;
        if count <= 3 { count } else { f64::from(count).sqrt().ceil() as u32 }
    }

    /// Draws each view with `draw`, which is given its number, and puts them onto a sheet. All orthographic views have
    /// one scale.
    pub(crate) fn draw(
        &self,
        (args, perspective): (&FramingArgs, Projection),
        (app, camera): (&mut App, Entity),
        size: UVec2,
        mut draw: impl FnMut(&mut App, u32) -> Result<Picture, Failure>,
    ) -> Result<(Picture, Encoding), Failure> {
        let points = outline(app.world_mut());
        let aspect = size.x as f32 / size.y as f32;
        let base = app.world().get::<Camera>(camera).copied().unwrap_or_default();
        let projection = if args.ortho { Projection::orthographic(1.0) } else { perspective };
        let base = Camera { projection, ..base };
        let framed = |&(_, view): &(String, View)| -> (Camera, Transform) {
            let framing: Framing = args.seen_from(view);
            framing.camera(base, points.iter().copied(), aspect)
        };
        let mut cameras: Vec<(Camera, Transform)> = self.0.iter().map(framed).collect();
        share_scale(&mut cameras);
        let mut sheet = ContactSheet::new(self.columns(), size.x, base.encoding);
        for (number, ((name, _), camera_there)) in (0..).zip(self.0.iter().zip(cameras)) {
            app.world_mut().entity_mut(camera).insert(camera_there);
            sheet.push_with_caption(&draw(app, number)?, &caption(name));
        }
        Ok((sheet.picture(), base.encoding))
    }
}

/// Gives all orthographic cameras the greatest height of one.
fn share_scale(cameras: &mut [(Camera, Transform)]) {
    let height = |camera: &Camera| match camera.projection {
        Projection::Orthographic { height, .. } => Some(height),
        Projection::Perspective { .. } => None,
    };
    let most = cameras.iter().filter_map(|(camera, _)| height(camera)).fold(0.0, f32::max);
    for (camera, _) in cameras {
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
        let names = |text: &str| {
            parse_views(text).map(|Views(views)| views.into_iter().map(|(name, _)| name).collect::<Vec<_>>())
        };
        assert_eq!(names("front, right,iso"), Ok(vec!["front".into(), "right".into(), "iso".into()]));
        assert_eq!(names("30,20,top,-45,10"), Ok(vec!["30,20".into(), "top".into(), "-45,10".into()]));
        for bad in ["", "front,", "30", "front,30", "rigth", &["iso"; 65].join(",")] {
            assert!(names(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn orthographic_views_share_their_scale() {
        let mut cameras = [2.0, 3.0].map(|height| (Camera::orthographic(height), Transform::IDENTITY)).to_vec();
        cameras.push((Camera::default(), Transform::IDENTITY));
        share_scale(&mut cameras);
        assert_eq!(cameras[0].0, Camera::orthographic(3.0));
        assert_eq!(cameras[2].0, Camera::default());
    }
}

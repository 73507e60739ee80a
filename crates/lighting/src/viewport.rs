//! Several cameras in one picture: the part that each of them draws, and when.

use crate::invalid::{Fields, InvalidValue};
use crate::range::Range;

/// The part of the picture that a camera draws, and its turn among the cameras. Where a world has several cameras, each
/// needs one; an only camera without one draws the whole picture.
///
/// The part is filled as if it were a picture of its own: with the camera's projection, background, samples, encoding and
/// intensity policy, and with the [`Shading`](crate::Shading), [`Reflectance`](crate::Reflectance),
/// [`Tolerance`](crate::Tolerance), [`Edges`](crate::Edges) and [`Layers`](crate::Layers) on the camera's entity.
/// Where no camera draws, the picture is black.
///
/// ```
/// use bevy_ecs::world::World;
/// use halfway_lighting::{Camera, Shading, Viewport};
///
/// // Gouraud on the left and Phong on the right.
/// let mut world = World::new();
/// world.spawn((Camera::default(), Viewport::fractions([0.0, 0.0, 0.5, 1.0]), Shading::Gouraud));
/// world.spawn((Camera::default(), Viewport::fractions([0.5, 0.0, 0.5, 1.0]), Shading::Phong));
///
/// let [left, right] = [0.0, 0.5].map(|left| Viewport::fractions([left, 0.0, 0.5, 1.0]).rectangle([641, 480]));
/// // They share the edge at column 321, half of 641 rounded.
/// assert_eq!((left, right), (Some([0, 0, 321, 480]), Some([321, 0, 320, 480])));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component))]
pub struct Viewport {
    /// The part of the picture. Default: all of it.
    pub part: Part,
    /// Cameras are drawn by ascending order, those of the same order by their entities. Default 0.
    pub order: i32,
    /// Whether the part begins with the camera's background or with what cameras before it have drawn there. Depth begins
    /// anew in both cases. Default [`Load::Clear`].
    pub load: Load,
}

/// A part of a picture: the left edge, the upper edge, the width and the height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    /// In shares of the picture's width and height, each from 0 to 1 and within the picture. Edges fall between pixels, so
    /// that parts that touch share no pixel and leave none out.
    Fractions([f32; 4]),
    /// In pixels from the top left. Of a part that reaches beyond the picture, the rest is drawn as a picture of its own.
    Pixels([u32; 4]),
}

/// How a frame begins: in the part of a [`Viewport`], or in an engine's texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Load {
    /// With the camera's background. In a texture that is the whole of it, beside a viewport too, and the depth is
    /// infinitely far.
    #[default]
    Clear,
    /// With what is there: the camera's background and sky are not drawn. In a texture, the depth that is given hides
    /// what lies behind it.
    Keep,
}

impl Default for Part {
    fn default() -> Self {
        Self::Fractions([0.0, 0.0, 1.0, 1.0])
    }
}

impl Viewport {
    /// The part with this left edge, upper edge, width and height, in shares of the picture's width and height.
    pub const fn fractions(part: [f32; 4]) -> Self {
        Self { part: Part::Fractions(part), order: 0, load: Load::Clear }
    }

    /// The part with this left edge, upper edge, width and height, in pixels.
    pub const fn pixels(part: [u32; 4]) -> Self {
        Self { part: Part::Pixels(part), order: 0, load: Load::Clear }
    }

    /// The same viewport with another order.
    #[must_use]
    pub const fn with_order(self, order: i32) -> Self {
        Self { order, ..self }
    }

    /// The left edge, upper edge, width and height in pixels of a picture of this width and height; `None` where no pixel
    /// is left.
    pub fn rectangle(&self, size: [u32; 2]) -> Option<[u32; 4]> {
        let [from, to] = match self.part {
            Part::Fractions([left, top, width, height]) => {
                let at = |share: f32, side: u32| (f64::from(share) * f64::from(side)).round() as u32;
                [[left, top], [left + width, top + height]].map(|[x, y]| [at(x, size[0]), at(y, size[1])])
            }
            Part::Pixels([left, top, width, height]) => {
                [[left, top], [left.saturating_add(width), top.saturating_add(height)]]
            }
        };
        let to = [0, 1].map(|axis| to[axis].min(size[axis]));
        let rectangle = [from[0], from[1], to[0].saturating_sub(from[0]), to[1].saturating_sub(from[1])];
        (rectangle[2] > 0 && rectangle[3] > 0).then_some(rectangle)
    }

    /// Checks the part.
    ///
    /// # Errors
    /// [`InvalidValue`] for a share that is not finite or outside 0 to 1, or a part that reaches beyond the picture.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let Part::Fractions(part) = self.part else { return Ok(()) };
        let fields = Fields::for_owner("Viewport");
        for (name, share) in ["left", "top", "width", "height"].into_iter().zip(part) {
            fields.within(&format!("part.{name}"), share, Range::UNIT)?;
        }
        let [left, top, width, height] = part;
        for (name, end) in [("left + width", left + width), ("top + height", top + height)] {
            // Shares such as 0.7 + 0.3 end a rounding beyond.
            let end = if end <= 1.0 + f32::EPSILON { end.min(1.0) } else { end };
            fields.within(&format!("part.{name}"), end, Range::UNIT)?;
        }
        Ok(())
    }
}

#[cfg(feature = "ecs")]
pub use turns::{CameraTurn, Cameras, SharedPart, SharingCameras, current_camera};

#[cfg(feature = "ecs")]
mod turns {
    use super::{Load, Viewport};
    use crate::Camera;
    use bevy_ecs::prelude::*;
    use bevy_ecs::system::{SystemParam, SystemState};

    /// The camera whose turn it is where a world has several: drawers and the oracle draw this one. Whoever draws one
    /// camera after the other sets it; `None` otherwise.
    #[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct CameraTurn(pub Option<Entity>);

    /// The part that a camera draws of a picture that cameras share.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct SharedPart {
        /// The camera's entity.
        pub camera: Entity,
        /// The column and the row of its upper left pixel.
        pub corner: [u32; 2],
        /// Its width and height in pixels; 0 where the [`Viewport`] leaves none.
        pub size: [u32; 2],
        /// Whether it begins with what other cameras have drawn.
        pub load: Load,
    }

    /// The cameras of a world, as a parameter of a system.
    #[derive(SystemParam)]
    pub struct Cameras<'w, 's> {
        cameras: Query<'w, 's, Entity, With<Camera>>,
        turn: Option<Res<'w, CameraTurn>>,
    }

    /// The cameras that share the picture, as a parameter of a system.
    #[derive(SystemParam)]
    pub struct SharingCameras<'w, 's>(Query<'w, 's, (Entity, Option<&'static Viewport>), With<Camera>>);

    impl SharingCameras<'_, '_> {
        /// The cameras that share a picture of this width and height, in the order in which they are drawn. None where a
        /// camera has the picture for itself, and where one of several lacks a [`Viewport`].
        pub fn parts(&self, size: [u32; 2]) -> Vec<SharedPart> {
            let all = self.0.iter().map(|(camera, viewport)| Some((camera, *viewport?)));
            let Some(mut all) = all.collect::<Option<Vec<_>>>() else { return Vec::new() };
            all.sort_unstable_by_key(|&(camera, viewport)| (viewport.order, camera));
            let part = |(camera, viewport): (Entity, Viewport)| {
                let [left, top, width, height] = viewport.rectangle(size).unwrap_or_default();
                SharedPart { camera, corner: [left, top], size: [width, height], load: viewport.load }
            };
            match all[..] {
                [only] if part(only).size == size => Vec::new(),
                _ => all.into_iter().map(part).collect(),
            }
        }
    }

    /// The camera to draw, as [`Cameras::current`] has it.
    ///
    /// # Errors
    /// The number of cameras, where it is not 1.
    pub fn current_camera(world: &mut World) -> Result<Entity, usize> {
        SystemState::<Cameras>::new(world).get(world).map_err(|_| 0_usize)?.current()
    }

    impl Cameras<'_, '_> {
        /// The camera to draw: the one whose [turn](CameraTurn) it is, else the only one.
        ///
        /// # Errors
        /// The number of cameras, where it is not 1.
        pub fn current(&self) -> Result<Entity, usize> {
            let turn = self.turn.as_ref().and_then(|turn| turn.0).filter(|&camera| self.cameras.contains(camera));
            if let Some(camera) = turn {
                return Ok(camera);
            }
            let mut all = self.cameras.iter();
            match (all.next(), all.count()) {
                (Some(camera), 0) => Ok(camera),
                (None, _) => Err(0),
                (Some(_), more) => Err(more + 1),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_that_touch_cover_each_pixel_once() {
        for size in [[7, 5], [640, 480], [1, 1], [1001, 3]] {
            for cuts in [[0.0, 0.1, 0.5, 1.0], [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0]] {
                let part = |pair: &[f32]| Viewport::fractions([pair[0], 0.0, pair[1] - pair[0], 1.0]);
                let widths = cuts.windows(2).map(|pair| part(pair).rectangle(size).map_or(0, |[_, _, width, _]| width));
                assert_eq!(widths.sum::<u32>(), size[0], "{size:?}, {cuts:?}");
            }
        }
    }

    #[test]
    fn a_part_ends_with_the_picture() {
        let size = [10, 8];
        assert_eq!(Viewport::default().rectangle(size), Some([0, 0, 10, 8]));
        assert_eq!(Viewport::pixels([4, 2, 100, u32::MAX]).rectangle(size), Some([4, 2, 6, 6]));
        assert_eq!(Viewport::pixels([10, 0, 5, 5]).rectangle(size), None);
        assert_eq!(Viewport::fractions([0.5, 0.5, 0.01, 0.5]).rectangle(size), None);
    }

    #[test]
    fn a_part_outside_of_the_picture_is_invalid() {
        assert!(Viewport::fractions([0.7, 0.0, 0.3, 1.0]).validate().is_ok());
        for (part, field) in [
            ([-0.1, 0.0, 0.5, 1.0], "part.left"),
            ([0.0, f32::NAN, 0.5, 1.0], "part.top"),
            ([0.75, 0.0, 0.5, 1.0], "part.left + width"),
            ([0.0, 0.5, 0.5, 0.75], "part.top + height"),
        ] {
            let invalid = Viewport::fractions(part).validate().expect_err("a part outside");
            assert_eq!((invalid.owner, invalid.field.as_str()), ("Viewport", field));
        }
    }
}

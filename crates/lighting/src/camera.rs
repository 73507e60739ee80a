//! The camera: what a view looks through and how its picture is written.

use crate::LinearRgba;
use crate::equations::vector::Real;
use crate::equations::{Eye, Transcendental, srgb_encoded};
use crate::invalid::{Fields, InvalidValue, Problem};
use crate::range::Range;
use crate::{Intensity, Projection, Viewer};

/// A camera at its entity's transform, looking along its local −Z with +Y up.
///
/// Only the transform's translation and rotation count: eye space has world units whatever the
/// camera is attached to. A [`Shading`](crate::Shading) or [`Reflectance`](crate::Reflectance) component on the camera
/// is the view's default; an object's own wins for that object.
///
/// ```
/// use glam::Vec3;
/// use halfway_lighting::{Camera, Projection, Samples};
///
/// // From above right, a ball of radius 2 about the origin fills the picture: a bundle to spawn.
/// let (camera, transform) = Camera::default().framing((Vec3::ZERO, 2.0), Vec3::new(-1.0, -1.0, -1.0));
/// assert!(transform.translation.length() > 2.0);
///
/// // The same as a plan, with smooth edges.
/// let plan = Camera { samples: Samples::Four, ..Camera::orthographic(4.0) };
/// let (plan, _) = plan.framing((Vec3::ZERO, 2.0), Vec3::NEG_Y);
/// assert!(matches!(plan.projection, Projection::Orthographic { height: 4.0, .. }));
/// # assert_eq!(camera, Camera::default());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component), require(bevy_transform::components::Transform))]
pub struct Camera {
    /// How eye space falls onto the picture. Default: a perspective of 45° with its near plane at 0.1.
    pub projection: Projection,
    /// Colour where nothing is drawn, linear RGB, each channel 0 to 10¹²; alpha is ignored. Default black.
    pub background: LinearRgba,
    /// The colour of the background at the lower edge of a picture, where it is another than at the upper edge; between
    /// them it changes evenly, in linear light. In pictures that are taken: windows have the upper one everywhere.
    /// Default none.
    pub background_below: Option<LinearRgba>,
    /// The opacity of the background, 0 to 1, in pictures that are taken: 0 makes it transparent. Windows are opaque.
    /// Default 1.
    pub background_opacity: f32,
    /// Whether `v` points toward the eye or is constant. Default [`Viewer::Local`].
    pub viewer: Viewer,
    /// Coverage samples a pixel. Default one.
    pub samples: Samples,
    /// The encoding of an 8-bit picture. Default [`Encoding::Srgb`].
    pub encoding: Encoding,
    /// The policy for intensities above 1. Default [`Intensity::Clamp`].
    pub intensity: Intensity,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            projection: Projection::default(),
            background: LinearRgba::BLACK,
            background_below: None,
            background_opacity: 1.0,
            viewer: Viewer::default(),
            samples: Samples::default(),
            encoding: Encoding::default(),
            intensity: Intensity::default(),
        }
    }
}

/// Samples a pixel.
///
/// A frame has one or four. Pictures that are taken (`take_picture`, `render_picture`, files) may have 16 or 64: they are
/// the mean of as many frames of one sample each, moved by parts of a pixel, in linear light, and each sample is shaded.
/// In windows and textures such a camera has four.
///
/// ```
/// use halfway_lighting::{Camera, Samples};
///
/// let camera = Camera { samples: Samples::Sixteen, ..Camera::default() };
/// assert_eq!((camera.samples.count(), camera.samples.of_a_frame()), (16, Samples::Four));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Samples {
    /// The pixel's centre decides.
    #[default]
    One,
    /// Four samples of coverage, averaged (multisample anti-aliasing); shading is evaluated once a pixel and triangle.
    Four,
    /// Four rows of four samples, each shaded.
    Sixteen,
    /// Eight rows of eight samples, each shaded.
    SixtyFour,
}

impl Samples {
    /// All of them, the fewest first.
    pub const ALL: [Self; 4] = [Self::One, Self::Four, Self::Sixteen, Self::SixtyFour];

    /// 1, 4, 16 or 64.
    pub const fn count(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Four => 4,
            Self::Sixteen => 16,
            Self::SixtyFour => 64,
        }
    }

    /// The samples of this number.
    pub fn from_count(count: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|samples| samples.count() == count)
    }

    /// Those of one frame: one or four.
    #[must_use]
    pub fn of_a_frame(self) -> Self {
        if self == Self::One { Self::One } else { Self::Four }
    }

    /// How many samples lie along each side of a pixel, where they are of several frames: 4 or 8.
    pub fn side(self) -> Option<u32> {
        match self {
            Self::One | Self::Four => None,
            Self::Sixteen => Some(4),
            Self::SixtyFour => Some(8),
        }
    }
}

/// The encoding of the channels of an 8-bit picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Encoding {
    /// I encoded with the sRGB curve (IEC 61966-2-1), as displays expect.
    #[default]
    Srgb,
    /// I as it is, the textbook's way: 0.5 is written as 128.
    Raw,
}

impl Encoding {
    /// The code of the linear intensity I in [0, 1], itself in [0, 1].
    ///
    /// The sRGB curve is 12.92·I up to 0.0031308, then 1.055·I^(1/2.4) − 0.055; 1 is reached exactly.
    pub fn encode(self, linear: f64) -> f64 {
        match self {
            Self::Raw => linear,
            Self::Srgb => srgb_encoded(linear),
        }
    }

    /// The inverse of [`Encoding::encode`].
    pub fn decode(self, encoded: f64) -> f64 {
        match self {
            Self::Raw => encoded,
            Self::Srgb if encoded <= 0.040_45 => encoded / 12.92,
            Self::Srgb => ((encoded + 0.055) / 1.055).pow(2.4),
        }
    }
}

impl Camera {
    /// A camera with [this perspective](Projection::perspective), which is otherwise the default one; `fov_y` is in
    /// radians.
    pub fn perspective(fov_y: f32) -> Self {
        Self { projection: Projection::perspective(fov_y), ..Self::default() }
    }

    /// A camera with [this orthographic projection](Projection::orthographic), which is otherwise the default one;
    /// `height` is in world units.
    pub fn orthographic(height: f32) -> Self {
        Self { projection: Projection::orthographic(height), ..Self::default() }
    }

    /// The same camera with its near plane at this depth.
    #[must_use]
    pub fn with_near(self, near: f32) -> Self {
        Self { projection: self.projection.with_near(near), ..self }
    }

    /// The camera and its place where it looks along `direction` and shows a sphere, given by its centre and radius, as
    /// large as it can be seen wholly in a picture that is at least as wide as it is high.
    ///
    /// A perspective keeps its field of view and stands as near as it may; its near plane comes closer where the sphere
    /// would be cut. An orthographic projection takes the height of the sphere. A shifted picture has the sphere in its
    /// middle, too. +Y is up in the picture, or −Z if the
    /// camera looks straight down, +Z if straight up. A `direction` of length 0 counts as −Z, a radius of 0 as 1.
    #[cfg(feature = "ecs")]
    pub fn framing(
        self,
        (center, radius): (glam::Vec3, f32),
        direction: glam::Vec3,
    ) -> (Self, bevy_transform::components::Transform) {
        use bevy_transform::components::Transform;
        use glam::Vec3;

        let radius = if radius > 0.0 { radius } else { 1.0 };
        let direction = direction.normalize_or(Vec3::NEG_Z);
        let ([x, y, z], projection) = self.projection.framing(radius);
        let upright = direction.cross(Vec3::Y).length_squared() > 1e-9;
        let up = if upright { Vec3::Y } else { Vec3::Z * direction.y };
        let mut place = Transform::from_translation(center + z * direction).looking_to(direction, up);
        // In the middle there is nothing to round.
        if x.abs() + y.abs() > 0.0 {
            place.translation -= place.rotation * Vec3::new(x, y, 0.0);
        }
        (Self { projection, ..self }, place)
    }

    /// Where the viewer is in eye space, for the vector v to the viewer: at the origin, or infinitely far along +Z where
    /// [`viewer`](Self::viewer) or the projection says so.
    pub fn eye<T: Real>(&self) -> Eye<T> {
        self.projection.eye(self.viewer)
    }

    /// Whether the background is one opaque colour.
    pub fn background_is_plain(&self) -> bool {
        self.background_opacity >= 1.0 && self.background_below.is_none()
    }

    /// The background at a height of the picture, from 0 at its upper edge to 1 at its lower one; alpha is its opacity.
    pub fn background_at(&self, height: f64) -> LinearRgba {
        let (above, below) = (self.background, self.background_below.unwrap_or(self.background));
        let mix = |above: f32, below: f32| (f64::from(above) * (1.0 - height) + f64::from(below) * height) as f32;
        LinearRgba {
            red: mix(above.red, below.red),
            green: mix(above.green, below.green),
            blue: mix(above.blue, below.blue),
            alpha: self.background_opacity,
        }
    }

    /// Checks every field against its range.
    ///
    /// # Errors
    /// An [`InvalidValue`] that names the field.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let fields = Fields::for_owner("Camera");
        self.projection.validate_in(fields.inside("projection."))?;
        fields.color("background", self.background)?;
        if let Some(below) = self.background_below {
            fields.color("background_below", below)?;
        }
        fields.within("background_opacity", self.background_opacity, Range::UNIT)?;
        self.intensity.validate()?;
        if self.samples.side().is_some() && self.intensity.acts_on_pictures() {
            let expected = "1 or 4 beside this intensity policy, which acts on a whole frame";
            return Err(fields.error("samples", Problem::Number { value: self.samples.count() as f32, expected }));
        }
        Ok(())
    }
}

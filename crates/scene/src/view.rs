//! The keys of a scene file that say how its picture is seen and written.

use std::ops::Bound::{Excluded, Included, Unbounded};

use bevy_math::{DMat3, DQuat, DVec3, Quat, Vec3};
use halfway_lighting::{
    Choices, Encoding, Faces, Framing, Projection, Range, Reflectance, Shading, Tolerance, VertexColors, View, Viewer,
};

use crate::check::{Check, KeyProblem, Limits, direction};
use crate::described;
use crate::keys::{Fill, Key, Keys, Object, Presence, Visit, Words, keys, named_words, words};

words! {
    /// `output`: the encoding of the channels of an 8- or 16-bit picture.
    Encoding {
        /// Intensities encoded with the sRGB curve, as displays expect.
        srgb = Self::Srgb,
        /// Intensities as they are, the textbook's way.
        raw = Self::Raw,
    }

    /// `viewer`: where the viewer is for the highlights.
    Viewer {
        /// The direction to the viewer is taken at every point.
        local = Self::Local,
        /// The direction to the viewer is the camera's axis everywhere: cheaper, right only from afar.
        infinite = Self::Infinite,
    }

    /// `faces`: which sides of a surface are shown. Front faces wind counter-clockwise, also under a mirroring
    /// transform.
    Faces {
        /// The front.
        front = Self::Front,
        /// The back, lit with the flipped normal and the back material, if any.
        back = Self::Back,
        /// Both.
        both = Self::Both,
    }

    /// `vertex_colors`: the use of the colors at a mesh's vertices.
    VertexColors {
        /// They multiply the ambient and diffuse reflectance, and the opacity where the object is blended, on both
        /// sides.
        multiply = Self::Multiply,
        /// Nothing.
        ignore = Self::Ignore,
    }
}

impl Keys for Shading {
    const NAME: &'static str = "Shading";
    const MEANING: &'static str = "`shading`: how often a surface is shaded.";
    const WORDS: Words<Self> = &named_words::<Self, { Self::CHOICES.len() }>();

    fn from_word(word: &str) -> Option<Self> {
        if word == AUTO { Some(Self::Phong) } else { Self::from_key(word) }
    }

    fn blank() -> Self {
        Self::default()
    }

    fn fill<F: Fill>(&mut self, from: &mut F) -> Result<(), F::Error> {
        let key = Key { name: AUTO, presence: Presence::Retired, limits: Limits::Any, meaning: "", whose: None };
        from.key(&key, |AutoShading { .. }| *self = Self::Phong)
    }
}

impl Object for Shading {
    const ONE_KEY: bool = true;
}

/// A shading of older files, as a word or as `{"auto": {"tolerance": 1.0}}`; it is read as Phong shading.
pub(crate) const AUTO: &str = "auto";

keys! {
    /// The value of `{"auto": …}`.
    #[derive(Clone, Copy, PartialEq)]
    struct AutoShading {
        [optional]
        /// The `steps` of a tolerance; ignored.
        tolerance: f32 = 0.0,
    }
}

impl Object for AutoShading {
    const EXPECTED: &'static str = "an object such as {\"tolerance\": 1.0}";
}

impl Keys for Reflectance {
    const NAME: &'static str = "Reflectance";
    const MEANING: &'static str = "`reflectance`: the specular term.";
    const WORDS: Words<Self> = &named_words::<Self, { Self::CHOICES.len() }>();

    fn blank() -> Self {
        Self::default()
    }
}

impl Object for Reflectance {}

impl Keys for Tolerance {
    const NAME: &'static str = "Tolerance";
    const MEANING: &'static str =
        "`tolerance`: how far a picture may differ from the exact one, which has every light and every triangle.";

    fn blank() -> Self {
        Self::EXACT
    }

    fn visit<V: Visit>(&self, visitor: &mut V) -> Result<(), V::Error> {
        described::visit(self, visitor)
    }

    fn fill<F: Fill>(&mut self, from: &mut F) -> Result<(), F::Error> {
        described::fill(self, from)
    }
}

const AZIMUTH: Key = Key {
    limits: Limits::Numbers(Range::FINITE),
    ..Key::required(
        "azimuth_deg",
        "The angle about the upright axis, from the front toward the right side, in degrees.",
    )
};
const ELEVATION: Key = Key {
    limits: Limits::Numbers(Range::new(Included(-90.0), Included(90.0), "degrees from -90 to 90")),
    ..Key::required("elevation_deg", "The angle above the ground, in degrees from -90 to 90.")
};

impl Keys for View {
    const NAME: &'static str = "View";
    const MEANING: &'static str = "`view`: the direction from which all objects are seen, in place of `position` and \
        `target`.";
    const WORDS: Words<Self> = &named_words::<Self, { Self::CHOICES.len() }>();

    fn blank() -> Self {
        Self { azimuth: 0.0, elevation: 0.0 }
    }

    fn visit<V: Visit>(&self, visitor: &mut V) -> Result<(), V::Error> {
        visitor.key(&AZIMUTH, Some(&self.azimuth.to_degrees()))?;
        visitor.key(&ELEVATION, Some(&self.elevation.to_degrees()))
    }

    fn fill<F: Fill>(&mut self, from: &mut F) -> Result<(), F::Error> {
        from.key(&AZIMUTH, |azimuth: f32| self.azimuth = azimuth.to_radians())?;
        from.key(&ELEVATION, |elevation: f32| self.elevation = elevation.to_radians())
    }
}

impl Object for View {
    const EXAMPLES: &'static [&'static str] = &["{\"azimuth_deg\": 30, \"elevation_deg\": 20}"];
}

impl Object for Tolerance {
    const EXPECTED: &'static str = "an object such as {\"steps\": 1.0, \"pixels\": 0.5}";
}

keys! {
    /// `camera`: where the scene is seen from. Right-handed, Y up; the camera looks from `position` to `target`.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct CameraEntry {
        [optional]
        /// Where the camera stands.
        position: [f32; 3] = [0.0, 0.0, 3.0],
        /// The point in the middle of the picture; not `position`.
        target: [f32; 3] = [0.0; 3],
        /// The direction that is up in the picture; not along the line of sight. Any length above 0.
        up: [f32; 3] = [0.0, 1.0, 0.0],
        /// Vertical field of view, in degrees above 0 and below 180.
        fov_y_deg: f32 = 45.0
            => Limits::Numbers(Range::new(Excluded(0.0), Excluded(180.0), "degrees above 0 and below 180")),
        /// Distance of the near plane, above 0. There is no far plane.
        near: f32 = Projection::default().near() => Limits::Numbers(Range::POSITIVE),
        /// The direction from which all objects are seen, in place of `position`, `target` and `near`; `up` is then the
        /// direction that is upright in the model, such as [0, 0, 1]. null: none.
        view: Option<View> = None,
        /// The share of the picture that the objects fill, above 0 and at most 1: the camera keeps its direction and
        /// takes the distance. null: 0.9 where there is a `view`, else the distance is that of `position`.
        fit: Option<f32> = None
            => Limits::Numbers(Range::new(Excluded(0.0), Included(1.0), "a share above 0, at most 1")),
        /// The magnification about the middle of the picture, above 0.
        zoom: f32 = 1.0 => Limits::Numbers(Range::new(Excluded(0.0), Unbounded, "a finite number above 0")),
        [not in the file]
        /// Whether rays are parallel: an orthographic projection as high as what the perspective shows at `target`, or
        /// as the objects need.
        ortho: bool,
    }
}

impl Object for CameraEntry {
    const EXPECTED: &'static str = "an object with the keys of a camera";

    fn check_whole(&self) -> Check {
        direction("up", &self.up)?;
        if self.view.is_some() {
            return Ok(());
        }
        if Vec3::from(self.position) == Vec3::from(self.target) {
            return Err(KeyProblem::new("target", "is where the camera stands; expected another point"));
        }
        if self.axes().is_none() {
            return Err(KeyProblem::new("up", "is along the line of sight; expected another direction"));
        }
        Ok(())
    }
}

impl CameraEntry {
    /// How all objects are framed; `None` where the entry says where the camera stands.
    pub(crate) fn framing(&self) -> Option<Framing> {
        let up = Vec3::from(self.up);
        let rotation = match self.view {
            Some(view) => view.rotation(up),
            None if self.fit.is_some() => self.rotation(),
            None => return None,
        };
        Some(Framing { rotation, fit: self.fit.unwrap_or(Framing::FIT), zoom: self.zoom })
    }

    /// The projection of a camera that is not placed by a framing.
    pub(crate) fn projection(&self) -> Projection {
        let perspective = Projection::Perspective { fov_y: self.fov_y_deg.to_radians(), near: self.near };
        let distance = Vec3::from(self.position).distance(Vec3::from(self.target));
        if self.ortho {
            return Projection::orthographic(perspective.height_at(distance) / self.zoom);
        }
        perspective.zoomed(self.zoom)
    }

    /// The camera's rotation where `position` and `target` give it.
    pub(crate) fn rotation(&self) -> Quat {
        let rotation = self
            .axes()
            .map_or(DQuat::IDENTITY, |[right, up, back]| DQuat::from_mat3(&DMat3::from_cols(right, up, back)));
        rotation.normalize().as_quat()
    }

    /// The camera's right, up and back in world space, of unit length and perpendicular; `None` where `position` and
    /// `target` or `up` do not say which they are.
    pub(crate) fn axes(&self) -> Option<[DVec3; 3]> {
        let [position, target, up] = [self.position, self.target, self.up].map(|v| Vec3::from(v).as_dvec3());
        let back = (position - target).try_normalize()?;
        let right = up.try_normalize()?.cross(back);
        // The sine of the angle between `up` and the line of sight; below this, rounding alone picks the roll.
        if right.length() < 1e-6 {
            return None;
        }
        let right = right.normalize();
        Some([right, back.cross(right), back])
    }
}

//! The keys of a scene file that say how its picture is seen and written.

use std::ops::Bound::Excluded;

use bevy_math::{DVec3, Vec3};
use halfway_lighting::{
    Choices, Encoding, Faces, Projection, Range, Reflectance, Shading, Tolerance, VertexColors, Viewer,
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
    }
}

impl Object for CameraEntry {
    const EXPECTED: &'static str = "an object with the keys of a camera";

    fn check_whole(&self) -> Check {
        direction("up", &self.up)?;
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

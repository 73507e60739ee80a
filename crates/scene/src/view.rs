//! The keys of a scene file that say how its picture is seen and written.

use std::ops::Bound::{Excluded, Included, Unbounded};

use bevy_math::{DMat3, DQuat, DVec3, Quat, Vec3};
use bevy_transform::components::Transform;
use halfway_lighting::{
    Choices, Encoding, Faces, Film, Framing, Frequency, Projection, Range, Reflectance, Shading, Term, Terms,
    Tolerance, VertexColors, View, Viewer,
};

use halfway_mesh::origin_of_box;

use crate::check::{Check, KeyProblem, Limits, direction, in_range};
use crate::described;
use crate::keys::{Fill, Key, Keys, Object, Presence, Visit, Words, keys, named_words, words};
use crate::track::{Animate, AnimatedKey, FIELD_OF_VIEW, TrackEntry, single_precision, three};
use crate::viewport::{LAYERS, ViewportEntry};

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

    /// How often a term of the lights is evaluated.
    Frequency {
        /// Once a pixel, with the interpolated normal.
        fragment = Self::Fragment,
        /// At every vertex, interpolated.
        vertex = Self::Vertex,
        /// Once a triangle, with its own normal; both terms are, or neither.
        triangle = Self::Triangle,
        /// Not at all.
        never = Self::Never,
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

    fn visit<V: Visit>(&self, visitor: &mut V) -> Result<(), V::Error> {
        match self {
            Self::Terms(terms) => visitor.key(&TERMS, Some(terms)),
            _ => Ok(()),
        }
    }

    fn fill<F: Fill>(&mut self, from: &mut F) -> Result<(), F::Error> {
        from.key(&TERMS, |terms| *self = Self::Terms(terms))?;
        let key = Key { name: AUTO, presence: Presence::Retired, limits: Limits::Any, meaning: "", whose: None };
        from.key(&key, |AutoShading { .. }| *self = Self::Phong)
    }
}

impl Object for Shading {
    const ONE_KEY: bool = true;
    const EXAMPLES: &'static [&'static str] = &["{\"terms\": {\"diffuse\": \"vertex\", \"specular\": \"fragment\"}}"];

    fn check_whole(&self) -> Check {
        self.validate().map_err(|error| KeyProblem::new("terms", error.problem.to_string()))
    }
}

const TERMS: Key = Key::required("terms", "Each term of the lights at a frequency of its own.");

/// Two terms that are shaded alike.
const PHONG: Terms = Terms::both(Frequency::Fragment);

keys! {
    /// The value of `{"terms": …}`.
    impl Terms {
        [optional]
        /// The frequency of the diffuse term.
        diffuse: Frequency = PHONG.diffuse,
        /// The frequency of the specular term.
        specular: Frequency = PHONG.specular,
    }
}

impl Object for Terms {
    const EXPECTED: &'static str = "an object such as {\"diffuse\": \"vertex\", \"specular\": \"fragment\"}";
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

impl Keys for Term {
    const NAME: &'static str = "Term";
    const MEANING: &'static str = "A term of the equation. The four add up to the picture.";
    const WORDS: Words<Self> = &named_words::<Self, { Self::CHOICES.len() }>();

    fn blank() -> Self {
        Self::Ambient
    }
}

impl Object for Term {}

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
    /// A camera: where the scene is seen from. Right-handed, Y up; the camera looks from `position` to `target`. It is a
    /// perspective one unless it has a `height`.
    #[derive(Clone, Debug, PartialEq)]
    pub struct CameraEntry {
        [optional]
        /// Its name; no other camera, light or object has the same. null: none.
        name: Option<String> = None,
        /// Where the camera stands.
        position: [f64; 3] = [0.0, 0.0, 3.0],
        /// The point that the camera looks at, in the middle of the picture unless that is shifted; not `position`.
        target: [f64; 3] = [0.0; 3],
        /// The direction that is up in the picture; not along the line of sight. Any length above 0.
        up: [f32; 3] = [0.0, 1.0, 0.0],
        /// Vertical field of view, in degrees above 0 and below 180.
        fov_y_deg: f32 = 45.0 => Limits::Numbers(FIELD_OF_VIEW),
        /// Distance of the near plane, above 0. Of an orthographic camera any number: below 0 it shows what is behind
        /// itself, too; left out, it is 0 then.
        near: f32 = Projection::default().near(),
        /// How far the middle of the picture is to the right of the axis of the view and above it, in heights of what
        /// `fov_y_deg` or `height` shows: a shift lens. Each from −100 to 100.
        shift: [f32; 2] = Film::DEFAULT.shift => Limits::Numbers(Film::SHIFT),
        /// Width over height of what is always seen; in a picture of other proportions more is seen, and nothing is
        /// stretched. 0.0001 to 10000; null: a narrow picture shows less of the sides.
        aspect: Option<f32> = Film::DEFAULT.aspect => Limits::Numbers(Film::ASPECT),
        /// Width over height of what a pixel shows, 0.0001 to 10000.
        pixel_aspect: f32 = Film::DEFAULT.pixel_aspect => Limits::Numbers(Film::ASPECT),
        /// The direction from which all objects are seen, in place of `position`, `target` and `near`; `up` is then the
        /// direction that is upright in the model, such as [0, 0, 1]. null: none.
        view: Option<View> = None,
        /// The share of the picture that the objects fill, above 0 and at most 1: the camera keeps its direction and
        /// takes the distance. null: 0.9 where there is a `view`, else the distance is that of `position`.
        fit: Option<f32> = None
            => Limits::Numbers(Range::new(Excluded(0.0), Included(1.0), "a share above 0, at most 1")),
        /// The magnification about the middle of the picture, above 0.
        zoom: f32 = 1.0 => Limits::Numbers(Range::new(Excluded(0.0), Unbounded, "a finite number above 0")),
        /// The shading of objects that name none; null: the scene's.
        shading: Option<Shading> = None,
        /// The tolerance of objects that name none; null: the scene's.
        tolerance: Option<Tolerance> = None,
        /// The reflectance of objects that name none; null: the scene's.
        reflectance: Option<Reflectance> = None,
        /// Samples a pixel: 1, 4, 16 or 64; null: the scene's.
        samples: Option<u32> = None => Limits::OneOf(&[1, 4, 16, 64], "expected 1, 4, 16 or 64"),
        /// The title of a legend for the colours of `scalars`, at the right edge of the picture; null: no legend.
        legend: Option<String> = None,
        /// The part of the picture that it draws, where several cameras share the picture; null: all of it.
        viewport: Option<ViewportEntry> = None,
        /// The numbers of the layers that it belongs to, each 0 to 31: a camera sees the objects and lights that share a
        /// layer with it. null: 0.
        layers: Option<Vec<u32>> = None => LAYERS,
        /// How its keys change in time: position, target, up, and `fov_y_deg` or `height`.
        animation: Vec<TrackEntry> = Vec::new(),
        [left out]
        /// Makes the camera orthographic: how many world units the picture shows from its lower to its upper edge, above
        /// 0. Left out: a perspective.
        height: f32 => Limits::Numbers(Range::POSITIVE),
        /// Depth of the far plane of an orthographic camera, above `near`. Left out: nothing is too far away.
        far: f32,
        /// The perspective of a calibrated camera, in place of `fov_y_deg`, `shift`, `aspect` and `pixel_aspect`.
        intrinsics: IntrinsicsEntry,
        [not in the file]
        /// Whether rays are parallel where there is no `height`: an orthographic projection as high as what the
        /// perspective shows at `target`, or as the objects need.
        ortho: bool,
    }
}

keys! {
    /// `intrinsics`: the perspective of a calibrated camera, in pixels from the upper left corner of its picture, x to the
    /// right and y down; the middle of the first pixel is at (0.5, 0.5). A program that puts it at (0, 0), as `OpenCV` does,
    /// has centers that are less by 0.5.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct IntrinsicsEntry {
        [required]
        /// The focal lengths fx and fy, in pixels; each above 0.
        focal: [f32; 2] => Limits::Numbers(Range::POSITIVE),
        /// The principal point cx, cy, in pixels.
        center: [f32; 2],
        /// Width and height of the calibrated picture in pixels, each 1 to 1000000. The picture that is drawn may have
        /// another size.
        size: [u32; 2] => Limits::Counts(1, 1_000_000),
    }
}

impl Object for IntrinsicsEntry {
    const EXPECTED: &'static str =
        "an object such as {\"focal\": [500, 500], \"center\": [320, 240], \"size\": [640, 480]}";
}

impl Object for CameraEntry {
    const EXPECTED: &'static str = "an object with the keys of a camera";

    fn with_given(self, given: &[&str]) -> Result<Self, String> {
        let near = if self.height.is_some() && !given.contains(&"near") { 0.0 } else { self.near };
        Ok(Self { near, ..self })
    }

    fn check_whole(&self) -> Check {
        self.check_projection()?;
        self.check_tracks(&self.animation)?;
        direction("up", &self.up)?;
        if self.view.is_some() {
            return Ok(());
        }
        if DVec3::from(self.position) == DVec3::from(self.target) {
            return Err(KeyProblem::new("target", "is where the camera stands; expected another point"));
        }
        if self.axes().is_none() {
            return Err(KeyProblem::new("up", "is along the line of sight; expected another direction"));
        }
        Ok(())
    }
}

impl CameraEntry {
    /// Checks that its keys are those of one kind of projection.
    fn check_projection(&self) -> Check {
        let default = Self::default();
        #[allow(clippy::float_cmp, reason = "a default was not given, or might as well not have been")]
        let own = [
            ("fov_y_deg", self.fov_y_deg != default.fov_y_deg),
            ("height", self.height.is_some()),
            ("shift", self.shift != default.shift),
            ("aspect", self.aspect != default.aspect),
            ("pixel_aspect", self.pixel_aspect != default.pixel_aspect),
        ];
        if self.intrinsics.is_some()
            && let Some((key, _)) = own.iter().find(|(_, is_given)| *is_given)
        {
            return Err(KeyProblem::new(*key, "cannot stand beside `intrinsics`, which say it all"));
        }
        if self.height.is_some() && own[0].1 {
            return Err(KeyProblem::new(
                "fov_y_deg",
                "cannot stand beside `height`, which makes the camera orthographic",
            ));
        }
        match (self.height, self.far) {
            (None, Some(_)) => {
                Err(KeyProblem::new("far", "is of an orthographic camera; expected a `height` beside it, or no `far`"))
            }
            (None, None) => in_range("near", self.near, Range::POSITIVE),
            (Some(_), Some(far)) if far <= self.near => {
                Err(KeyProblem::new("far", format!("is {far}; expected more than `near`, which is {}", self.near)))
            }
            (Some(_), _) => Ok(()),
        }?;
        // Focal lengths and sizes that are far apart may come to what cannot be drawn.
        let validated = self.projection().validate();
        if self.intrinsics.is_some() {
            return validated.map_err(|error| KeyProblem::new("intrinsics", format!("come to nothing: {error}")));
        }
        Ok(())
    }

    /// Its projection, before a framing changes it.
    pub(crate) fn projection(&self) -> Projection {
        let Self { near, shift, aspect, pixel_aspect, .. } = *self;
        let film = Film { shift, aspect, pixel_aspect };
        let projection = match (self.intrinsics, self.height) {
            (Some(IntrinsicsEntry { focal, center, size }), _) => {
                Projection::intrinsics(focal, center, size).with_near(near)
            }
            (None, Some(height)) => Projection::Orthographic { height, near, far: self.far, film },
            (None, None) => Projection::Perspective { fov_y: self.fov_y_deg.to_radians(), near, film },
        };
        if self.ortho && self.height.is_none() {
            let distance = DVec3::from(self.position).distance(DVec3::from(self.target)) as f32;
            return Projection::orthographic(projection.height_at(distance) / self.zoom);
        }
        projection.zoomed(self.zoom)
    }

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

    /// The point from which its position and its target are counted, so that `f32` keeps them; see [`origin_of_box`].
    pub(crate) fn origin(&self) -> DVec3 {
        let [position, target] = [self.position, self.target].map(DVec3::from);
        origin_of_box(position.min(target), position.max(target))
    }

    /// Where it stands, counted from an origin, and looks.
    pub(crate) fn transform(&self, origin: DVec3) -> Transform {
        let translation = (DVec3::from(self.position) - origin).as_vec3();
        Transform::from_translation(translation).with_rotation(self.rotation())
    }

    /// The camera's rotation where `position` and `target` give it.
    fn rotation(&self) -> Quat {
        let rotation = self
            .axes()
            .map_or(DQuat::IDENTITY, |[right, up, back]| DQuat::from_mat3(&DMat3::from_cols(right, up, back)));
        rotation.normalize().as_quat()
    }

    /// The camera's right, up and back in world space, of unit length and perpendicular; `None` where `position` and
    /// `target` or `up` do not say which they are.
    pub(crate) fn axes(&self) -> Option<[DVec3; 3]> {
        let origin = self.origin();
        let counted = |point: [f64; 3]| (DVec3::from(point) - origin).as_vec3().as_dvec3();
        let [position, target] = [self.position, self.target].map(counted);
        let up = Vec3::from(self.up).as_dvec3();
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

impl Animate for CameraEntry {
    fn count(&self, key: AnimatedKey) -> Result<usize, String> {
        let zoom = if self.height.is_some() { AnimatedKey::Height } else { AnimatedKey::FovYDeg };
        match key {
            AnimatedKey::Position | AnimatedKey::Target | AnimatedKey::Up => Ok(key.count()),
            _ if key == zoom && self.intrinsics.is_none() => Ok(key.count()),
            _ => Err(format!("expected a key of this camera: position, target, up or {}", zoom.name())),
        }
    }

    fn set(&mut self, key: AnimatedKey, value: [f64; 4]) {
        match key {
            AnimatedKey::Position => self.position = three(value),
            AnimatedKey::Target => self.target = three(value),
            AnimatedKey::Up => self.up = single_precision(three(value)),
            AnimatedKey::FovYDeg => self.fov_y_deg = value[0] as f32,
            AnimatedKey::Height => self.height = Some(value[0] as f32),
            _ => {}
        }
    }
}

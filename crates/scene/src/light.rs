//! The lights of a scene file.

use std::ops::Bound::Included;

use bevy_color::LinearRgba;
use halfway_lighting::{Attenuation, HemisphereLight, PointLight, Range};
use serde::de::{Deserializer, Error};
use serde::ser::Serializer;
use serde_json::{Map, Value, json};

use crate::check::{Check, KeyProblem, Limits, Within, direction, test};
use crate::described;
use crate::entry::Entry;
use crate::keys::{CheckKeys, Fill, Key, Keys, Object, Presence, Visit, Words, keys, keys_schema, words};
use crate::named::NameOrIndex;
use crate::track::{Animate, AnimatedKey, TrackEntry, single_precision, three};
use crate::viewport::LAYERS;

/// A light. In JSON, the keys of `cone` and `light` stand beside the others, as far as the kind of light has them
/// ([`LightKind`]): other keys are refused in a file, and other fields here are ignored.
#[derive(Clone, Debug, PartialEq)]
pub struct LightEntry {
    /// The kind of light.
    pub kind: LightKind,
    /// Where the light is: (x, y, z, w), not all 0, with w = 1 in a point or spot light, whose file has three numbers.
    pub position: [f64; 4],
    /// The direction and the cone; a directional light has the direction alone.
    pub cone: ConeEntry,
    /// Its colors and their attenuation, unless it is a hemisphere.
    pub light: PointLight,
    /// The colors of a hemisphere.
    pub hemisphere: HemisphereLight,
    /// The frame of position and direction, with which the light moves.
    pub attach: AttachEntry,
    /// Its name; no other camera, light or object has the same.
    pub name: Option<String>,
    /// The numbers of the layers that it belongs to, each 0 to 31; `None`: those of what it is attached to, else 0.
    pub layers: Option<Vec<u32>>,
    /// How its position, direction and colors change in time.
    pub animation: Vec<TrackEntry>,
}

/// The kinds of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightKind {
    /// From a point, in all directions.
    Point,
    /// From a point, into a cone.
    Spot,
    /// Parallel rays.
    Directional,
    /// A homogeneous position (x, y, z, w), as in OpenGL: w = 0 is a direction toward the light, any other w a point
    /// at xyz/w.
    Homogeneous,
    /// From all around: one color from the sky, another from the ground.
    Hemisphere,
}

keys! {
    /// The cone of a light, in degrees.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct ConeEntry {
        [optional]
        /// The way the light travels, along the axis of its cone. Any length above 0.
        direction: [f32; 3] = [0.0, -1.0, 0.0],
        /// The angle from the axis to the edge. Expected: degrees from 0 to 90, or 180 for no cone.
        cutoff_deg: f32 = 30.0 => Limits::Numbers(CUTOFF),
        /// The angle from the axis to where the light begins to fade; null: a hard edge. Expected: degrees from 0 to
        /// `cutoff_deg`, or null.
        inner_deg: Option<f32> = None => Limits::Numbers(
            Range::new(Included(0.0), Included(180.0), "degrees from 0 to cutoff_deg")
        ),
        /// e of cos^e φ, φ the angle from the axis. Expected: a finite number, 0 or more.
        exponent: f32 = 0.0 => Limits::Numbers(Range::NON_NEGATIVE),
    }
}

const CUTOFF: Range = Range {
    also: Some(180.0),
    ..Range::new(Included(0.0), Included(90.0), "degrees from 0 to 90, or 180 for no cone")
};

impl Object for ConeEntry {
    fn check_whole(&self) -> Check {
        direction("direction", &self.direction)?;
        let Some(inner) = self.inner_deg else { return Ok(()) };
        let expected = format!("degrees from 0 to cutoff_deg, which is {}", self.cutoff_deg);
        test("inner_deg", inner, inner <= self.cutoff_deg, &expected)
    }
}

impl ConeEntry {
    /// No cone: the light shines in all directions.
    pub const NONE: Self = Self { direction: [0.0, -1.0, 0.0], cutoff_deg: 180.0, inner_deg: None, exponent: 0.0 };

    /// Whether there is no cone, that is, `cutoff_deg` is 180.
    #[allow(clippy::float_cmp, reason = "180 is a mark, not a measurement")]
    pub fn is_none(&self) -> bool {
        self.cutoff_deg == 180.0
    }
}

/// `attach`: the frame that a light is in.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum AttachEntry {
    /// The world's.
    #[default]
    World,
    /// The camera's: it looks along −Z, with +Y up.
    Camera,
    /// That of the object of this name, or at this place in the list of objects.
    Object(NameOrIndex),
}

const OBJECT: Key =
    Key::required("object", "That of the object of this name, or at this place in the list, counted from 0.");

impl Keys for AttachEntry {
    const NAME: &'static str = "AttachEntry";
    const MEANING: &'static str = "`attach`: the frame that a light is in.";
    const WORDS: Words<Self> = &[
        ("world", Self::World, "The world's."),
        ("camera", Self::Camera, "The camera's: it looks along −Z, with +Y up."),
    ];

    fn blank() -> Self {
        Self::World
    }

    fn visit<V: Visit>(&self, visitor: &mut V) -> Result<(), V::Error> {
        match self {
            Self::Object(name) => visitor.key(&OBJECT, Some(name)),
            Self::World | Self::Camera => Ok(()),
        }
    }

    fn fill<F: Fill>(&mut self, from: &mut F) -> Result<(), F::Error> {
        from.key(&OBJECT, |name| *self = Self::Object(name))
    }
}

impl Object for AttachEntry {
    const ONE_KEY: bool = true;
    const EXAMPLES: &'static [&'static str] = &["{\"object\": \"name\"}"];
}

words! {
    /// The kind of a light.
    LightKind {
        /// From a point, in all directions.
        point = Self::Point,
        /// From a point, into a cone.
        spot = Self::Spot,
        /// Parallel rays.
        directional = Self::Directional,
        /// A homogeneous position (x, y, z, w), as in OpenGL: w = 0 is a direction toward the light, any other w a
        /// point at xyz/w.
        homogeneous = Self::Homogeneous,
        /// From all around: one color from the sky, another from the ground; the direction is toward the sky.
        hemisphere = Self::Hemisphere,
    }
}

/// The keys of every light.
const SHARED: [&str; 8] = ["kind", "ambient", "diffuse", "specular", "attach", "name", "layers", "animation"];

impl LightKind {
    fn name(self) -> &'static str {
        Self::WORDS[self as usize].0
    }

    /// The keys of this kind beside those of every light.
    fn keys(self) -> &'static [&'static str] {
        const ALL: [&str; 8] = [
            "position",
            "attenuation",
            "range",
            "attenuate_ambient",
            "direction",
            "cutoff_deg",
            "inner_deg",
            "exponent",
        ];
        match self {
            Self::Point => &ALL.as_slice()[..4],
            Self::Directional => &ALL.as_slice()[4..5],
            Self::Spot | Self::Homogeneous => &ALL,
            Self::Hemisphere => &["direction", "sky", "ground"],
        }
    }

    /// The keys that it has beside those of its kind alone.
    fn shared_keys(self) -> &'static [&'static str] {
        if self == Self::Hemisphere { &["kind", "attach", "name", "layers", "animation"] } else { &SHARED }
    }

    fn has(self, key: &str) -> bool {
        self.keys().contains(&key) || self.shared_keys().contains(&key)
    }
}

impl LightEntry {
    /// A white light of this kind in its default place, that adds no ambient light, in the world's frame.
    pub fn white(kind: LightKind) -> Self {
        let (position, cone) = match kind {
            LightKind::Point => ([2.0, 0.0, 2.0, 1.0], ConeEntry::NONE),
            LightKind::Spot => ([2.0, 0.0, 2.0, 1.0], ConeEntry::default()),
            LightKind::Directional => {
                ([0.0, 1.0, 1.0, 0.0], ConeEntry { direction: [0.0, -1.0, -1.0], ..ConeEntry::NONE })
            }
            // OpenGL's: from the viewer's side, along −Z.
            LightKind::Homogeneous => ([0.0, 0.0, 1.0, 0.0], ConeEntry::NONE),
            LightKind::Hemisphere => {
                ([0.0, 1.0, 0.0, 0.0], ConeEntry { direction: [0.0, 1.0, 0.0], ..ConeEntry::NONE })
            }
        };
        let (light, hemisphere) = (PointLight::white(), HemisphereLight::white());
        let (attach, name, layers, animation) = (AttachEntry::World, None, None, Vec::new());
        Self { kind, position, cone, light, hemisphere, attach, name, layers, animation }
    }
}

fn homogeneous(key: &str, p: &[f64; 4]) -> Check {
    if p.iter().all(|&c| c == 0.0) {
        return Err(KeyProblem::new(key, "is [0, 0, 0, 0]; expected a point (w not 0) or a direction (w = 0)"));
    }
    if p[3] != 0.0 && p[..3].iter().any(|c| !((c / p[3]) as f32).is_finite()) {
        return Err(KeyProblem::new(key, format!("is {p:?}; expected xyz/w to be finite, or w = 0")));
    }
    Ok(())
}

/// Skips the keys that a kind of light does not have.
struct KeysOfKind<'a, V> {
    kind: LightKind,
    visitor: &'a mut V,
}

impl<V: Visit> Visit for KeysOfKind<'_, V> {
    type Error = V::Error;

    fn key<T: Entry>(&mut self, key: &Key, value: Option<&T>) -> Result<(), V::Error> {
        if self.kind.has(key.name) { self.visitor.key(key, value) } else { Ok(()) }
    }
}

/// The position in a file: three numbers, or four of a homogeneous light. Of three, w is NaN, which no file can say.
struct Position([f64; 4]);

impl Entry for Position {
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match Vec::read(deserializer)?[..] {
            [x, y, z] => Ok(Self([x, y, z, f64::NAN])),
            [x, y, z, w] => Ok(Self([x, y, z, w])),
            ref others => {
                let count = others.len();
                Err(D::Error::custom(format_args!("has {count} numbers; expected 3, or 4 of a homogeneous light")))
            }
        }
    }

    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let count = if self.0[3].is_nan() { 3 } else { 4 };
        serializer.collect_seq(&self.0[..count])
    }

    fn schema(definitions: &mut Map<String, Value>, limits: &Limits) -> Value {
        <[f32; 4]>::schema(definitions, limits)
    }
}

const KIND: Key = Key::required("kind", "The kind of light.");
const POSITION: Key = key("position", "Where the light is.");
const POSITION_AND_W: Key = key("position", "(x, y, z, w), not all 0.");
const NAME: Key = key("name", "Its name; no other camera, light or object has the same. null: none.");
const ANIMATION: Key = key("animation", "How its position, direction and colors change in time.");
const LAYERS_KEY: Key = Key {
    limits: LAYERS,
    ..key(
        "layers",
        "The numbers of the layers that it belongs to, each 0 to 31; null: those of what it is attached to, else 0.",
    )
};
const ATTACH: Key = key("attach", "Whose frame position and direction are in, and with what the light moves.");

const fn key(name: &'static str, meaning: &'static str) -> Key {
    Key { presence: Presence::Optional, ..Key::required(name, meaning) }
}

/// The keys of the cone and of the colors are on the same level as the others. A visitor gets those of the kind; when a
/// file is read all are accepted at first, since the kind may come last.
impl Keys for LightEntry {
    const NAME: &'static str = "LightEntry";
    const MEANING: &'static str = "A light.";

    fn blank() -> Self {
        Self::white(LightKind::Spot)
    }

    fn visit<V: Visit>(&self, visitor: &mut V) -> Result<(), V::Error> {
        let Self { kind, position, cone, light, hemisphere, attach, name, layers, animation } = self;
        let [x, y, z, _] = *position;
        let own = &mut KeysOfKind { kind: *kind, visitor };
        own.key(&KIND, Some(kind))?;
        own.key(&NAME, Some(name))?;
        match kind {
            LightKind::Homogeneous => own.key(&POSITION_AND_W, Some(position)),
            _ => own.key(&POSITION, Some(&[x, y, z])),
        }?;
        cone.visit(own)?;
        described::visit(light, own)?;
        described::visit(hemisphere, own)?;
        own.key(&ATTACH, Some(attach))?;
        own.key(&LAYERS_KEY, Some(layers))?;
        own.key(&ANIMATION, Some(animation))
    }

    fn fill<F: Fill>(&mut self, from: &mut F) -> Result<(), F::Error> {
        from.key(&KIND, |kind| self.kind = kind)?;
        from.key(&POSITION, |Position(position)| self.position = position)?;
        self.cone.fill(from)?;
        described::fill(&mut self.light, from)?;
        described::fill(&mut self.hemisphere, from)?;
        from.key(&ATTACH, |attach| self.attach = attach)?;
        from.key(&NAME, |name| self.name = name)?;
        from.key(&LAYERS_KEY, |layers| self.layers = layers)?;
        from.key(&ANIMATION, |animation| self.animation = animation)
    }
}

impl Object for LightEntry {
    const EXPECTED: &'static str = "an object with the keys of a light";

    fn with_given(self, given: &[&str]) -> Result<Self, String> {
        let kind = self.kind;
        if let Some(key) = given.iter().find(|key| !kind.has(key)) {
            let shared = kind
                .shared_keys()
                .iter()
                .filter(|key| !["kind", "attach", "name", "layers", "animation"].contains(key));
            let keys: Vec<_> = kind.keys().iter().chain(shared).copied().collect();
            let (name, keys) = (kind.name(), keys.join(", "));
            return Err(format!(
                "`{key}` does not belong to a {name} light, whose keys are {keys}, attach, name, layers and animation"
            ));
        }
        // The defaults of position and cone depend on the kind.
        let default = Self::white(kind);
        let has = |key: &str| given.contains(&key);
        let mut position = if has("position") { self.position } else { default.position };
        match (kind, position[3].is_nan()) {
            (LightKind::Homogeneous, true) => return Err("`position` has 3 numbers; a homogeneous light has 4".into()),
            (LightKind::Homogeneous, false) => {}
            (_, false) if has("position") => {
                return Err(format!("`position` has 4 numbers; a {} light has 3", kind.name()));
            }
            _ => position[3] = default.position[3],
        }
        let ConeEntry { direction, cutoff_deg, inner_deg, exponent } = self.cone;
        let cone = ConeEntry {
            direction: if has("direction") { direction } else { default.cone.direction },
            cutoff_deg: if has("cutoff_deg") { cutoff_deg } else { default.cone.cutoff_deg },
            inner_deg,
            exponent,
        };
        Ok(Self { position, cone, ..self })
    }

    /// Every kind with all of its keys and no others, and with their defaults.
    fn definition(definitions: &mut Map<String, Value>) -> Value {
        let kinds = LightKind::WORDS.iter().map(|&(name, kind, meaning)| {
            let mut schema = keys_schema(&Self::white(kind), meaning, definitions);
            schema["properties"]["kind"]["const"] = name.into();
            schema
        });
        let kinds: Vec<Value> = kinds.collect();
        json!({ "description": Self::MEANING, "oneOf": kinds })
    }

    /// Also the keys that the kind does not have.
    fn check_whole(&self) -> Check {
        Entry::check(&self.position, &Limits::Any).within("position")?;
        homogeneous("position", &self.position)?;
        self.cone.check(&Limits::Any)?;
        described::visit(&self.light, &mut CheckKeys)?;
        described::visit(&self.hemisphere, &mut CheckKeys)?;
        self.check_tracks(&self.animation)?;
        if self.light.attenuation == Attenuation::new(0.0, 0.0, 0.0) {
            return Err(KeyProblem::new("attenuation", "is [0, 0, 0]; expected at least one number above 0"));
        }
        Ok(())
    }
}

impl Animate for LightEntry {
    fn count(&self, key: AnimatedKey) -> Result<usize, String> {
        let of_lights = [
            AnimatedKey::Position,
            AnimatedKey::Direction,
            AnimatedKey::Ambient,
            AnimatedKey::Diffuse,
            AnimatedKey::Specular,
            AnimatedKey::Sky,
            AnimatedKey::Ground,
        ];
        if of_lights.contains(&key) && self.kind.has(key.name()) {
            let has_w = key == AnimatedKey::Position && self.kind == LightKind::Homogeneous;
            return Ok(key.count() + usize::from(has_w));
        }
        let own: Vec<&str> = of_lights.map(AnimatedKey::name).into_iter().filter(|name| self.kind.has(name)).collect();
        Err(format!("expected a key of this light: {}", own.join(", ")))
    }

    fn set(&mut self, key: AnimatedKey, value: [f64; 4]) {
        let [red, green, blue, _] = single_precision(value);
        let color = LinearRgba::rgb(red, green, blue);
        match key {
            AnimatedKey::Position if self.kind == LightKind::Homogeneous => self.position = value,
            AnimatedKey::Position => self.position[..3].copy_from_slice(&three(value)),
            AnimatedKey::Direction => self.cone.direction = single_precision(three(value)),
            AnimatedKey::Ambient => self.light.ambient = color,
            AnimatedKey::Diffuse => self.light.diffuse = color,
            AnimatedKey::Specular => self.light.specular = color,
            AnimatedKey::Sky => self.hemisphere.sky = color,
            AnimatedKey::Ground => self.hemisphere.ground = color,
            _ => {}
        }
    }
}

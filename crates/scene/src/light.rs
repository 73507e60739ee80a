//! The lights of a scene file.

use std::borrow::Cow;
use std::fmt;
use std::ops::Bound::Included;

use halfway_lighting::{Attenuation, Described, Field, FieldPlace, PointLight, Range};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};
use serde::ser::{SerializeMap, Serializer};
use serde_json::{Map, Value, json};

use crate::check::{Check, KeyProblem, direction, finite, test};
use crate::fields;
use crate::read::{JsonObject, Spoken, Word};

/// A light. In JSON, the keys of `cone` and `light` stand beside the others, as far as the kind of light has them
/// ([`LightKind`]); what it does not have is ignored here and refused there.
#[derive(Clone, Debug, PartialEq)]
pub struct LightEntry {
    /// The kind of light.
    pub kind: LightKind,
    /// Where the light is: (x, y, z, w), not all 0, with w = 1 in a point or spot light, whose file has three numbers.
    pub position: [f32; 4],
    /// Which way it shines; of a directional light only the direction counts.
    pub cone: ConeEntry,
    /// Its colors and how they weaken.
    pub light: PointLight,
    /// Whose frame position and direction are in, and with what the light moves.
    pub attach: AttachEntry,
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
}

/// What each field of [`ConeEntry`] means, for its documentation and for the schema.
macro_rules! meaning {
    (direction) => {
        "The way the light travels, along the axis of its cone. Any length above 0."
    };
    (cutoff_deg) => {
        "The angle from the axis to the edge."
    };
    (inner_deg) => {
        "The angle from the axis to where the light begins to fade; null: a hard edge."
    };
    (exponent) => {
        "e of cos^e φ, φ the angle from the axis."
    };
}

/// The cone of a light, in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConeEntry {
    #[doc = meaning!(direction)]
    pub direction: [f32; 3],
    #[doc = meaning!(cutoff_deg)]
    /// 0 to 90, or 180 for no cone.
    pub cutoff_deg: f32,
    #[doc = meaning!(inner_deg)]
    /// 0 to `cutoff_deg`; null is `None`.
    pub inner_deg: Option<f32>,
    #[doc = meaning!(exponent)]
    /// 0 or more.
    pub exponent: f32,
}

impl Default for ConeEntry {
    fn default() -> Self {
        Self { direction: [0.0, -1.0, 0.0], cutoff_deg: 30.0, inner_deg: None, exponent: 0.0 }
    }
}

impl Described for ConeEntry {
    const FIELDS: &'static [Field<Self>] = &[
        Field::new(
            "direction",
            Range::FINITE,
            meaning!(direction),
            FieldPlace::Three(|it| it.direction.each_mut(), fields::XYZ),
        ),
        Field::number(
            "cutoff_deg",
            Range {
                also: Some(180.0),
                ..Range::new(Included(0.0), Included(90.0), "degrees from 0 to 90, or 180 for no cone")
            },
            meaning!(cutoff_deg),
            |it| &mut it.cutoff_deg,
        ),
        Field::new(
            "inner_deg",
            Range::new(Included(0.0), Included(180.0), "degrees from 0 to cutoff_deg"),
            meaning!(inner_deg),
            FieldPlace::Optional(|it| &mut it.inner_deg),
        ),
        Field::number("exponent", Range::NON_NEGATIVE, meaning!(exponent), |it| &mut it.exponent),
    ];
}

impl ConeEntry {
    /// No cone: the light shines in all directions.
    pub const NONE: Self = Self { direction: [0.0, -1.0, 0.0], cutoff_deg: 180.0, inner_deg: None, exponent: 0.0 };

    /// Whether there is no cone, that is, `cutoff_deg` is 180.
    #[allow(clippy::float_cmp, reason = "180 is a mark, not a measurement")]
    pub fn is_none(&self) -> bool {
        self.cutoff_deg == 180.0
    }

    fn check(&self) -> Check {
        fields::check(self)?;
        direction("direction", &self.direction)?;
        let Some(inner) = self.inner_deg else { return Ok(()) };
        let expected = format!("degrees from 0 to cutoff_deg, which is {}", self.cutoff_deg);
        test("inner_deg", inner, inner <= self.cutoff_deg, &expected)
    }
}

/// `attach`: the frame that a light is in.
#[derive(serde::Serialize, JsonSchema, Clone, Debug, Default, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum AttachEntry {
    /// The world's.
    #[default]
    World,
    /// The camera's: it looks along −Z, with +Y up.
    Camera,
    /// That of the object of this name.
    Object(String),
}

impl Word for AttachEntry {
    const WORDS: &'static [(&'static str, Self)] = &[("world", Self::World), ("camera", Self::Camera)];
    const OBJECTS: &'static [(&'static str, &'static str)] = &[("object", "{\"object\": \"name\"}")];

    fn from_member<'de, A: MapAccess<'de>>(_key: &str, map: &mut A) -> Result<Self, A::Error> {
        map.next_value().map(Self::Object)
    }
}

impl Word for LightKind {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("point", Self::Point),
        ("spot", Self::Spot),
        ("directional", Self::Directional),
        ("homogeneous", Self::Homogeneous),
    ];
}

/// The keys of every light.
const SHARED: [&str; 4] = ["ambient", "diffuse", "specular", "attach"];

impl LightKind {
    fn name(self) -> &'static str {
        Self::WORDS[self as usize].0
    }

    /// What the schema says of a kind.
    fn meaning(self) -> &'static str {
        match self {
            Self::Point => "From a point, in all directions.",
            Self::Spot => "From a point, into a cone.",
            Self::Directional => "Parallel rays.",
            Self::Homogeneous => {
                "A homogeneous position (x, y, z, w), as in OpenGL: w = 0 is a direction toward the light, any other w a \
                 point at xyz/w."
            }
        }
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
        }
    }

    fn has(self, key: &str) -> bool {
        self.keys().contains(&key) || SHARED.contains(&key)
    }

    /// How many numbers the position has in a file.
    fn coordinates(self) -> usize {
        if self == Self::Homogeneous { 4 } else { 3 }
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
        };
        Self { kind, position, cone, light: PointLight::white(), attach: AttachEntry::World }
    }

    pub(crate) fn check(&self) -> Check {
        homogeneous("position", &self.position)?;
        self.cone.check()?;
        fields::check(&self.light)?;
        if self.light.attenuation == Attenuation::new(0.0, 0.0, 0.0) {
            return Err(KeyProblem::new("attenuation", "is [0, 0, 0]; expected at least one number above 0"));
        }
        Ok(())
    }

    /// What the file says in three or four numbers.
    fn set_position(&mut self, numbers: &[f32]) -> Result<(), String> {
        let (found, expected) = (numbers.len(), self.kind.coordinates());
        if found != expected {
            return Err(format!("`position` has {found} numbers; a {} light has {expected}", self.kind.name()));
        }
        self.position[..expected].copy_from_slice(numbers);
        Ok(())
    }
}

fn homogeneous(key: &str, p: &[f32; 4]) -> Check {
    finite(key, p)?;
    if p.iter().all(|&c| c == 0.0) {
        return Err(KeyProblem::new(key, "is [0, 0, 0, 0]; expected a point (w not 0) or a direction (w = 0)"));
    }
    if p[3] != 0.0 && p[..3].iter().any(|c| !(c / p[3]).is_finite()) {
        return Err(KeyProblem::new(key, format!("is {p:?}; expected xyz/w to be finite, or w = 0")));
    }
    Ok(())
}

impl JsonObject for LightEntry {
    const EXPECTED: &'static str = "an object with the keys of a light";
}

impl<'de> Deserialize<'de> for LightEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(AnyLight)
    }
}

/// Reads a light: every key that some light has, and then those that this kind of light has.
///
/// `serde`'s tagged enums take a value into a buffer until they know its tag, and errors inside it then come without a
/// line. Here all keys are read where they stand, and a key that the kind does not have is refused by its name.
struct AnyLight;

impl<'de> Visitor<'de> for AnyLight {
    type Value = LightEntry;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(LightEntry::EXPECTED)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<LightEntry, A::Error> {
        let known: Vec<_> = ["kind", "position"]
            .into_iter()
            .chain(fields::names::<ConeEntry>())
            .chain(fields::names::<PointLight>())
            .chain(["attach"])
            .collect();
        let (mut given, mut kind, mut position) = (Vec::new(), None, None::<Vec<f32>>);
        let mut attach = AttachEntry::World;
        let (mut cone, mut light) = (ConeEntry::default(), PointLight::white());
        while let Some(key) = fields::next_key(&mut map, &known, &mut given)? {
            match key {
                "kind" => kind = Some(map.next_value::<Spoken<LightKind>>()?.0),
                "position" => position = Some(map.next_value()?),
                "attach" => attach = map.next_value::<Spoken<AttachEntry>>()?.0,
                key if fields::read_field(&mut cone, key, &mut map)? => {}
                key => fields::read_field(&mut light, key, &mut map).map(drop)?,
            }
        }
        let kind = kind.ok_or_else(|| A::Error::missing_field("kind"))?;
        if let Some(key) = given.iter().find(|key| **key != "kind" && !kind.has(key)) {
            let (name, keys) = (kind.name(), kind.keys().join(", "));
            return Err(A::Error::custom(format_args!(
                "`{key}` does not belong to a {name} light, whose keys are {keys}, ambient, diffuse, specular and attach"
            )));
        }
        let mut entry = LightEntry { light, attach, ..LightEntry::white(kind) };
        // The defaults of the cone depend on the kind.
        for field in ConeEntry::FIELDS.iter().filter(|field| given.contains(&field.name)) {
            field.set(&mut entry.cone, field.value(&cone));
        }
        position.map_or(Ok(()), |numbers| entry.set_position(&numbers)).map_err(A::Error::custom)?;
        Ok(entry)
    }
}

impl serde::Serialize for LightEntry {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let has = |key: &str| self.kind.has(key);
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("kind", &Spoken(&self.kind))?;
        if has("position") {
            map.serialize_entry("position", &self.position[..self.kind.coordinates()])?;
        }
        fields::write_fields(&self.cone, has, &mut map)?;
        fields::write_fields(&self.light, has, &mut map)?;
        map.serialize_entry("attach", &self.attach)?;
        map.end()
    }
}

impl JsonSchema for LightEntry {
    fn schema_name() -> Cow<'static, str> {
        "LightEntry".into()
    }

    /// Every kind with all of its keys and no others, and with their defaults.
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut attach = generator.subschema_for::<AttachEntry>();
        attach.insert(
            "description".into(),
            "Whose frame position and direction are in, and with what the light moves.".into(),
        );
        attach.insert("default".into(), "world".into());
        let kinds: Vec<Value> =
            LightKind::WORDS.iter().map(|&(_, kind)| kind_schema(kind, attach.as_value())).collect();
        json_schema!({ "description": "A light.", "oneOf": kinds })
    }
}

fn kind_schema(kind: LightKind, attach: &Value) -> Value {
    let default = LightEntry::white(kind);
    let mut position = fields::list(fields::number(&Range::FINITE), kind.coordinates());
    let meaning = if kind == LightKind::Homogeneous { "(x, y, z, w), not all 0." } else { "Where the light is." };
    position["description"] = meaning.into();
    position["default"] = json!(default.position[..kind.coordinates()]);
    let mut properties: Map<String, Value> = [("position".to_owned(), position), ("attach".to_owned(), attach.clone())]
        .into_iter()
        .chain(fields::properties(&default.cone))
        .chain(fields::properties(&default.light))
        .filter(|(key, _)| kind.has(key))
        .collect();
    properties.insert("kind".to_owned(), json!({ "type": "string", "const": kind.name() }));
    let mut schema = fields::object(properties);
    schema["description"] = kind.meaning().into();
    schema["required"] = json!(["kind"]);
    schema
}

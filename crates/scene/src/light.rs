//! The lights of a scene file.

use bevy_color::{ColorToComponents, LinearRgba};
use halfway_lighting::{Attenuation, CHANNEL_MAX, PointLight, Range};
use schemars::{JsonSchema, Schema};
use serde::de::MapAccess;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::check::{Check, KeyProblem, Within, color, direction, finite, in_range, test};
use crate::read::{JsonObject, Word};

/// A light. In JSON, the keys of `source` (with its `kind`) stand beside the others.
#[derive(Serialize, JsonSchema, Clone, Debug, PartialEq)]
#[schemars(description = "A light.", transform = each_light_with_its_keys)]
pub struct LightEntry {
    /// The kind of light, with the keys that belong to it.
    #[serde(flatten)]
    pub source: LightSource,
    /// La, linear RGB: added wherever the surface faces. 0 to 1e12.
    #[schemars(inner(range(min = 0, max = CHANNEL_MAX)))]
    pub ambient: [f32; 3],
    /// Ld, linear RGB: received by the diffuse term. 0 to 1e12.
    #[schemars(inner(range(min = 0, max = CHANNEL_MAX)))]
    pub diffuse: [f32; 3],
    /// Ls, linear RGB: received by the specular term. 0 to 1e12.
    #[schemars(inner(range(min = 0, max = CHANNEL_MAX)))]
    pub specular: [f32; 3],
    /// Whose frame position and direction are in, and with what the light moves.
    pub attach: AttachEntry,
}

/// The kinds of light, each with its keys.
#[derive(Serialize, JsonSchema, Clone, Debug, PartialEq)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum LightSource {
    /// From a point, in all directions.
    Point {
        /// Where the light is.
        position: [f32; 3],
        /// How it weakens with distance.
        #[serde(flatten)]
        falloff: FalloffEntry,
    },
    /// From a point, into a cone.
    Spot {
        /// Where the light is.
        position: [f32; 3],
        /// How it weakens with distance.
        #[serde(flatten)]
        falloff: FalloffEntry,
        /// Where it shines.
        #[serde(flatten)]
        cone: ConeEntry,
    },
    /// Parallel rays.
    Directional {
        /// The way the light travels. Any length above 0.
        direction: [f32; 3],
    },
    /// A homogeneous position (x, y, z, w), as in OpenGL: w = 0 is a direction toward the light, any other w a point
    /// at xyz/w.
    Homogeneous {
        /// (x, y, z, w), not all 0.
        position: [f32; 4],
        /// How it weakens with distance; nothing where w = 0.
        #[serde(flatten)]
        falloff: FalloffEntry,
        /// Where it shines.
        #[serde(flatten)]
        cone: ConeEntry,
    },
}

/// How a light weakens with the distance d, in world units.
#[derive(Serialize, JsonSchema, Clone, Copy, Debug, PartialEq)]
pub struct FalloffEntry {
    /// [a, b, c] of 1/(a + b·d + c·d²). Each 0 or more, one of them above 0.
    #[schemars(inner(range(min = 0)))]
    pub attenuation: [f32; 3],
    /// Where the light ends: multiplies by clamp(1 − (d/range)⁴, 0, 1)². Above 0; null: it does not end.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub range: Option<f32>,
    /// Whether distance and cone weaken the ambient colour too, as in OpenGL.
    pub attenuate_ambient: bool,
}

impl Default for FalloffEntry {
    fn default() -> Self {
        let PointLight { attenuation, range, attenuate_ambient, .. } = PointLight::default();
        let Attenuation { constant, linear, quadratic } = attenuation;
        Self { attenuation: [constant, linear, quadratic], range, attenuate_ambient }
    }
}

/// The cone of a spot light.
#[derive(Serialize, JsonSchema, Clone, Copy, Debug, PartialEq)]
pub struct ConeEntry {
    /// The way the light travels along the axis. Any length above 0.
    pub direction: [f32; 3],
    /// Degrees from the axis to the edge: 0 to 90, or 180 for no cone.
    #[schemars(extend("anyOf" = [{"minimum": 0, "maximum": 90}, {"const": 180}]))]
    pub cutoff_deg: f32,
    /// Degrees from the axis to where the light begins to fade, 0 to `cutoff_deg`; null: a hard edge.
    #[schemars(range(min = 0, max = 180))]
    pub inner_deg: Option<f32>,
    /// e of cos^e φ, φ the angle from the axis. 0 or more.
    #[schemars(range(min = 0))]
    pub exponent: f32,
}

impl Default for ConeEntry {
    fn default() -> Self {
        Self { direction: [0.0, -1.0, 0.0], cutoff_deg: 30.0, inner_deg: None, exponent: 0.0 }
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
#[derive(Serialize, Deserialize, JsonSchema, Clone, Debug, Default, PartialEq, Eq)]
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
    const EXPECTED: &'static str = "\"world\", \"camera\" or {\"object\": \"name\"}";
    const KEY: Option<&'static str> = Some("object");

    fn from_member<'de, A: MapAccess<'de>>(map: &mut A) -> Result<Self, A::Error> {
        map.next_value().map(Self::Object)
    }
}

impl JsonObject for LightEntry {
    const EXPECTED: &'static str = "an object with the keys of a light";
}

impl LightSource {
    /// The default position of point and spot lights.
    pub(crate) const POSITION: [f32; 3] = [2.0, 0.0, 2.0];
    /// The default direction of directional lights.
    pub(crate) const DIRECTION: [f32; 3] = [0.0, -1.0, -1.0];
    /// The default homogeneous position, which is OpenGL's: from the viewer's side, along −Z.
    pub(crate) const HOMOGENEOUS: [f32; 4] = [0.0, 0.0, 1.0, 0.0];

    /// A point light at its default place.
    pub fn point() -> Self {
        Self::Point { position: Self::POSITION, falloff: FalloffEntry::default() }
    }

    /// A spot light at its default place.
    pub fn spot() -> Self {
        Self::Spot { position: Self::POSITION, falloff: FalloffEntry::default(), cone: ConeEntry::default() }
    }

    /// A directional light in its default direction.
    pub fn directional() -> Self {
        Self::Directional { direction: Self::DIRECTION }
    }

    /// A light at the default homogeneous position, without a cone.
    pub fn homogeneous() -> Self {
        Self::Homogeneous { position: Self::HOMOGENEOUS, falloff: FalloffEntry::default(), cone: ConeEntry::NONE }
    }

    fn check(&self) -> Check {
        match self {
            Self::Point { position, falloff } => {
                finite("position", position)?;
                falloff.check()
            }
            Self::Spot { position, falloff, cone } => {
                finite("position", position)?;
                falloff.check()?;
                cone.check()
            }
            Self::Directional { direction: d } => direction("direction", d),
            Self::Homogeneous { position, falloff, cone } => {
                homogeneous("position", position)?;
                falloff.check()?;
                cone.check()
            }
        }
    }
}

impl LightEntry {
    /// A white light that adds no ambient light, in the world's frame.
    pub fn white(source: LightSource) -> Self {
        let PointLight { ambient, diffuse, specular, .. } = PointLight::white();
        let [ambient, diffuse, specular] = [ambient, diffuse, specular].map(LinearRgba::to_f32_array_no_alpha);
        Self { source, ambient, diffuse, specular, attach: AttachEntry::World }
    }

    pub(crate) fn check(&self) -> Check {
        self.source.check()?;
        color("ambient", &self.ambient)?;
        color("diffuse", &self.diffuse)?;
        color("specular", &self.specular)
    }
}

impl FalloffEntry {
    fn check(&self) -> Check {
        for (i, &constant) in self.attenuation.iter().enumerate() {
            in_range("", constant, Range::NonNegative).within_item("attenuation", i)?;
        }
        if self.attenuation.iter().all(|&constant| constant == 0.0) {
            return Err(KeyProblem::new("attenuation", "is [0, 0, 0]; expected at least one number above 0"));
        }
        self.range.map_or(Ok(()), |range| in_range("range", range, Range::Positive))
    }
}

impl ConeEntry {
    fn check(&self) -> Check {
        let cutoff = self.cutoff_deg;
        direction("direction", &self.direction)?;
        let holds = self.is_none() || (0.0..=90.0).contains(&cutoff);
        test("cutoff_deg", cutoff, holds, "degrees from 0 to 90, or 180 for no cone")?;
        if let Some(inner) = self.inner_deg {
            let expected = format!("degrees from 0 to cutoff_deg, which is {cutoff}");
            test("inner_deg", inner, (0.0..=cutoff).contains(&inner), &expected)?;
        }
        in_range("exponent", self.exponent, Range::NonNegative)
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

/// The schema of lights, made from the shared keys and those of each kind: every kind with all of its keys and no
/// others, and with their defaults.
fn each_light_with_its_keys(schema: &mut Schema) {
    let Some(Value::Object(shared)) = schema.remove("properties") else { return };
    schema.remove("required");
    schema.remove("type");
    let Some(Value::Array(kinds)) = schema.get_mut("oneOf") else { return };
    let defaults = [LightSource::point(), LightSource::spot(), LightSource::directional(), LightSource::homogeneous()];
    for (kind, source) in kinds.iter_mut().zip(defaults) {
        let defaults = serde_json::to_value(LightEntry::white(source)).unwrap_or_default();
        let Some(Value::Object(keys)) = kind.get_mut("properties") else { continue };
        debug_assert_eq!(keys["kind"]["const"], defaults["kind"], "the kinds in the order of the enum");
        keys.extend(shared.clone());
        for (key, described) in keys.iter_mut().filter(|(key, _)| *key != "kind") {
            described["default"] = defaults[key].clone();
        }
        kind["required"] = Value::from(vec!["kind"]);
        kind["additionalProperties"] = Value::from(false);
    }
}

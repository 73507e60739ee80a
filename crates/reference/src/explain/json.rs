//! An explanation as JSON.

use halfway_lighting::equations::Coefficients;
use halfway_lighting::{Choices, Encoding, Frequency};
use serde_json::{Value, json};

use super::{
    ExplainedLayer, ExplainedLight, ExplainedPoint, ExplainedSample, Explanation, ImageFactors, LightWay, TermColors,
};

impl Explanation {
    /// All of it as JSON, with the names of the fields; entities are left out.
    pub fn to_json(&self) -> Value {
        json!({
            "pixel": self.pixel,
            "size": self.size,
            "global_ambient": self.global_ambient,
            "samples": self.samples.iter().map(ExplainedSample::to_json).collect::<Vec<_>>(),
            "clamps_surfaces": self.clamps_surfaces,
            "mean": self.mean,
            "policy": self.policy.name(),
            "divisor": self.divisor,
            "color": self.color,
            "encoding": match self.encoding {
                Encoding::Srgb => "srgb",
                Encoding::Raw => "raw",
            },
            "encoded": self.encoded,
            "bytes": self.bytes,
        })
    }
}

impl ExplainedSample {
    fn to_json(&self) -> Value {
        json!({
            "at": self.at,
            "background": self.background,
            "layers": self.layers.iter().map(ExplainedLayer::to_json).collect::<Vec<_>>(),
            "color": self.color,
        })
    }
}

impl ExplainedLayer {
    fn to_json(&self) -> Value {
        let triangle = self.triangle.map(
            |triangle| json!({ "number": triangle.number, "vertices": triangle.vertices, "weights": triangle.weights }),
        );
        json!({
            "name": self.name,
            "triangle": triangle,
            "front": self.front,
            "depth": self.depth,
            "position": self.position,
            "normal": self.normal,
            "lit": self.lit,
            "terms": { "diffuse": frequency(self.terms.diffuse), "specular": frequency(self.terms.specular) },
            "reflectance": self.reflectance.choice().map(|choice| choice.key),
            "material": coefficients(&self.material),
            "points": self.points.iter().map(ExplainedPoint::to_json).collect::<Vec<_>>(),
            "steady_ambient": self.steady_ambient,
            "lights": self.lights.to_json(),
            "environment": self.environment.to_json(),
            "factors": self.factors.to_json(),
            "sums": self.sums.to_json(),
            "emission": self.emission,
            "intensity": self.intensity,
            "opacity": self.opacity,
            "behind": self.behind,
            "blended": self.blended,
        })
    }
}

impl ExplainedPoint {
    fn to_json(&self) -> Value {
        json!({
            "at": frequency(self.at),
            "vertex": self.corner.map(|(vertex, _)| vertex),
            "weight": self.corner.map(|(_, weight)| weight),
            "position": self.position,
            "normal": self.normal,
            "view": self.view,
            "material": coefficients(&self.material),
            "lights": self.lights.iter().map(ExplainedLight::to_json).collect::<Vec<_>>(),
            "sums": self.sums.to_json(),
        })
    }
}

impl ExplainedLight {
    fn to_json(&self) -> Value {
        let colors =
            self.colors.map(|colors| json!({ "ambient": colors.la, "diffuse": colors.ld, "specular": colors.ls }));
        json!({
            "name": self.name,
            "kind": self.kind.name(),
            "colors": colors,
            "way": self.way.map(LightWay::to_json),
            "is_steady": self.is_steady,
            "terms": self.terms.to_json(),
            "counted": self.counted.to_json(),
        })
    }
}

impl LightWay {
    fn to_json(self) -> Value {
        json!({
            "l": self.l,
            "distance": self.distance,
            "constants": self.constants,
            "attenuation": self.attenuation,
            "window": self.window,
            "cos_phi": self.cos_phi,
            "spot": self.spot,
            "n_dot_l": self.n_dot_l,
            "is_behind": self.is_behind,
            "direction": self.direction,
            "cosine": self.cosine,
            "exponent": self.exponent,
            "power": self.power,
        })
    }
}

impl TermColors {
    fn to_json(self) -> Value {
        json!({ "ambient": self.ambient, "diffuse": self.diffuse, "specular": self.specular })
    }
}

impl ImageFactors {
    fn to_json(self) -> Value {
        json!({
            "color": self.color,
            "solid": self.solid,
            "occlusion": self.occlusion,
            "specular": self.specular,
            "emission": self.emission,
        })
    }
}

fn coefficients(it: &Coefficients<f64>) -> Value {
    json!({
        "ambient": it.ka,
        "diffuse": it.kd,
        "specular": it.ks,
        "emission": it.ke,
        "shininess": it.shininess,
        "opacity": it.opacity,
    })
}

fn frequency(frequency: Frequency) -> &'static str {
    match frequency {
        Frequency::Never => "never",
        Frequency::Triangle => "triangle",
        Frequency::Vertex => "vertex",
        Frequency::Fragment => "fragment",
    }
}

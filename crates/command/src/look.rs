//! `--color`, `--faces`, `--normals` and `--lights`: the looks of a model, or of all objects of a scene.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use halfway::lighting::LightRig;
use halfway::mesh::{NormalWeighting, Normals};
use halfway::prelude::*;
use halfway::scene::{MaterialEntry, SceneFile};

use crate::choices::{choice, values};

/// The options hold for all objects.
#[derive(Args, Clone, Debug)]
pub(crate) struct LookArgs {
    /// The colour of all objects: #rrggbb, a CSS name such as teal, or a preset's name such as brass or red-plastic
    #[arg(long, value_name = "COLOR|PRESET", value_parser = parse_color)]
    color: Option<Material>,
    /// The sides of surfaces that are shown [default: the scene's; both for open surfaces without a material]
    #[arg(long, value_parser = faces())]
    faces: Option<Faces>,
    /// The normals: the file's own, smooth, flat, or creased where faces differ by more degrees; auto keeps the file's,
    /// and without any creases made parts [default: the scene's; auto for a model]
    #[arg(long, value_name = "auto|keep|smooth|flat|creased=DEG", value_parser = parse_normals)]
    normals: Option<Normals>,
    /// The background: transparent, #rrggbb (#rrggbbaa with an opacity), a CSS name, or two from above to below, as
    /// white..lightsteelblue [default: the scene's; charcoal for a model]
    #[arg(long, value_name = "COLOR[..COLOR]|transparent", value_parser = parse_background)]
    background: Option<Background>,
    /// The lights, which follow the camera [default: the scene's or the model's own; studio for a model without]
    #[arg(long, value_parser = rigs())]
    lights: Option<LightRig>,
}

impl LookArgs {
    /// Changes the objects and lights of the scene.
    pub(crate) fn apply(&self, scene: &mut SceneFile) {
        for object in &mut scene.objects {
            if let Some(material) = self.color {
                object.material = Some(MaterialEntry::Values(material));
                (object.back_material, object.maps, object.solid) = (None, None, None);
                object.vertex_colors = VertexColors::Ignore;
            }
            object.faces = self.faces.or(object.faces);
            object.normals = self.normals.unwrap_or(object.normals);
        }
        if let Some(Background { above, below, opacity }) = self.background {
            (scene.background, scene.background_below, scene.background_opacity) = (above, below, opacity);
        }
        if let Some(rig) = self.lights {
            scene.lights = Some(rig.into());
        }
    }
}

/// The colours of a background at the upper and at the lower edge, linear RGB, and its opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Background {
    above: [f32; 3],
    below: Option<[f32; 3]>,
    opacity: f32,
}

fn parse_background(text: &str) -> Result<Background, String> {
    let expected = || "expected transparent, a colour such as #102030 or white, or two as white..skyblue".to_owned();
    let color = |text: &str| -> Result<([f32; 3], f32), String> {
        let color = csscolorparser::parse(text.trim()).map_err(|_| expected())?;
        Ok((LinearRgba::from(Srgba::rgb(color.r, color.g, color.b)).to_f32_array_no_alpha(), color.a))
    };
    let (above, below) = text.split_once("..").map_or((text, None), |(above, below)| (above, Some(below)));
    let (above, opacity) = color(above)?;
    let Some(below) = below else { return Ok(Background { above, below: None, opacity }) };
    let (below, other) = color(below)?;
    if opacity.to_bits() != other.to_bits() {
        return Err("the two colours differ in their opacity; expected the same".to_owned());
    }
    Ok(Background { above, below: Some(below), opacity })
}

/// The material of a surface of which no colour is known, or only its colour.
pub(crate) fn finish(color: LinearRgba) -> Material {
    Material { specular: LinearRgba::rgb(0.12, 0.12, 0.12), shininess: 40.0, ..Material::matte(color) }
}

/// A preset, or a colour in the finish of models without a material.
fn parse_color(text: &str) -> Result<Material, String> {
    if let Some(preset) = Material::named(text) {
        return Ok(preset);
    }
    match csscolorparser::parse(text) {
        Ok(color) if color.a >= 1.0 => Ok(finish(Srgba::rgb(color.r, color.g, color.b).into())),
        Ok(_) => Err("is not opaque; expected a colour such as #c04020".to_owned()),
        Err(_) => {
            let presets: Vec<_> = Material::PRESETS.iter().map(|(name, _)| name.replace('_', "-")).collect();
            Err(format!("expected #rrggbb, a CSS name such as teal, or one of {}", presets.join(", ")))
        }
    }
}

fn faces() -> impl TypedValueParser<Value = Faces> {
    PossibleValuesParser::new(["front", "back", "both"]).map(|text| match text.as_str() {
        "front" => Faces::Front,
        "back" => Faces::Back,
        _ => Faces::Both,
    })
}

fn rigs() -> impl TypedValueParser<Value = LightRig> {
    PossibleValuesParser::new(values::<LightRig>()).try_map(|text| choice(&text).ok_or("not one of the values"))
}

pub(crate) fn parse_normals(text: &str) -> Result<Normals, String> {
    let weighting = NormalWeighting::default();
    Ok(match text {
        "auto" => Normals::Auto,
        "keep" => Normals::Keep,
        "smooth" => Normals::Weighted(weighting),
        "flat" | "face" => Normals::Face,
        "uniform" => Normals::Weighted(NormalWeighting::Uniform),
        "area" => Normals::Weighted(NormalWeighting::Area),
        "angle" => Normals::Weighted(NormalWeighting::Angle),
        "max" => Normals::Weighted(NormalWeighting::Max),
        _ => {
            let degrees = text.strip_prefix("creased=").and_then(|degrees| degrees.parse().ok());
            let degrees: f32 = degrees.filter(|degrees| (0.0..=180.0).contains(degrees)).ok_or(
                "expected auto, keep, smooth, flat, face, uniform, area, angle, max or creased=DEGREES with an angle \
                 from 0 to 180",
            )?;
            Normals::Creased { angle: degrees.to_radians(), weighting }
        }
    })
}

/// The material of parts without one.
pub(crate) fn unknown_material() -> Material {
    finish(LinearRgba::rgb(0.75, 0.75, 0.75))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_by_number_name_and_preset() {
        assert_eq!(parse_color("red-plastic"), Ok(Material::RED_PLASTIC));
        // Presets come first: gold is a material and a CSS name.
        assert_eq!(parse_color("Gold"), Ok(Material::GOLD));
        assert_eq!(parse_color("#ff0000").map(|material| material.diffuse), Ok(LinearRgba::RED));
        assert_eq!(parse_color("teal"), parse_color("#008080"));
        for bad in ["", "#12", "bras", "#ff000080", "transparent"] {
            assert!(parse_color(bad).is_err(), "{bad}");
        }
        assert!(parse_color("bras").is_err_and(|error| error.contains("brass") && error.contains("red-plastic")));
    }

    #[test]
    fn backgrounds_of_one_colour_of_two_and_of_none() {
        let white = [1.0; 3];
        assert_eq!(parse_background("white"), Ok(Background { above: white, below: None, opacity: 1.0 }));
        assert_eq!(parse_background("transparent"), Ok(Background { above: [0.0; 3], below: None, opacity: 0.0 }));
        let two = Background { above: white, below: Some([1.0, 0.0, 0.0]), opacity: 1.0 };
        assert_eq!(parse_background("#fff..red"), Ok(two));
        assert!(parse_background("#ffffff80").is_ok_and(|half| (half.opacity - 0.5).abs() < 0.01));
        for bad in ["", "..", "white..", "nocolour", "white..#ff000080"] {
            assert!(parse_background(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn normals_by_word_and_angle() {
        assert_eq!(parse_normals("auto"), Ok(Normals::Auto));
        assert_eq!(parse_normals("smooth"), parse_normals("max"));
        assert!(matches!(parse_normals("creased=30"), Ok(Normals::Creased { .. })));
        for bad in ["", "creased", "creased=200", "Smooth"] {
            assert!(parse_normals(bad).is_err(), "{bad}");
        }
    }
}

//! The values of options as text.

use bevy_color::{ColorToComponents, LinearRgba, Srgba};
use bevy_math::Vec3;
use halfway_lighting::{
    Choices, Edges, Faces, Intensity, LightRig, Material, Reflectance, Shading, Show, Term, Tolerance, View,
    WhichEdges, Width,
};
use halfway_mesh::{NormalWeighting, Normals};

use super::finish;
use crate::scalars::ColorMap;

/// The colours of a background at the upper and at the lower edge, linear RGB, and its opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Background {
    /// The colour at the upper edge.
    pub above: [f32; 3],
    /// The colour at the lower edge, where it is another.
    pub below: Option<[f32; 3]>,
    /// 0 to 1.
    pub opacity: f32,
}

/// The value of this name, with `-` or `_` between words.
///
/// # Errors
/// The names that there are, as a sentence.
pub fn choice<T: Choices>(text: &str) -> Result<T, String> {
    T::from_key(&text.replace('-', "_")).ok_or_else(|| {
        let names: Vec<String> = T::CHOICES.iter().map(|choice| choice.key.replace('_', "-")).collect();
        format!("expected {}", one_of(&names))
    })
}

fn one_of(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [all @ .., last] => format!("{} or {last}", all.join(", ")),
    }
}

/// A colour as CSS has them, `#rrggbb`, `#rrggbbaa`, `white`: linear red, green and blue, and the opacity.
///
/// # Errors
/// A sentence that says what was expected.
pub fn css(text: &str) -> Result<[f32; 4], String> {
    let color = csscolorparser::parse(text.trim());
    let color = color.map_err(|_| format!("{text:?}: expected a colour such as #102030 or white"))?;
    let [red, green, blue] = LinearRgba::from(Srgba::rgb(color.r, color.g, color.b)).to_f32_array_no_alpha();
    Ok([red, green, blue, color.a])
}

/// `transparent`, a colour as CSS has them (`#rrggbb`, `#rrggbbaa`, `white`), or two, `white..skyblue`.
///
/// # Errors
/// A sentence that says what was expected.
pub fn background(text: &str) -> Result<Background, String> {
    let expected = || "expected transparent, a colour such as #102030 or white, or two as white..skyblue".to_owned();
    let color = |text: &str| -> Result<([f32; 3], f32), String> {
        let [red, green, blue, opacity] = css(text).map_err(|_| expected())?;
        Ok(([red, green, blue], opacity))
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

/// A preset of [`Material::PRESETS`], or a colour as CSS has them, in the finish of models without a material.
///
/// # Errors
/// A sentence that says what was expected.
pub fn color(text: &str) -> Result<Material, String> {
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

/// `front`, `back` or `both`.
///
/// # Errors
/// A sentence that says what was expected.
pub fn faces(text: &str) -> Result<Faces, String> {
    match text {
        "front" => Ok(Faces::Front),
        "back" => Ok(Faces::Back),
        "both" => Ok(Faces::Both),
        _ => Err("expected front, back or both".to_owned()),
    }
}

/// `auto`, `keep`, `smooth`, `flat`, the name of a weighting, or `creased=DEGREES`.
///
/// # Errors
/// A sentence that says what was expected.
pub fn normals(text: &str) -> Result<Normals, String> {
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

/// An axis of the model: `x`, `y`, `z`, `-x`, `-y` or `-z`.
///
/// # Errors
/// A sentence that says what was expected.
pub fn up(text: &str) -> Result<Vec3, String> {
    let (sign, axis) =
        text.strip_prefix('-').map_or((1.0, text.strip_prefix('+').unwrap_or(text)), |axis| (-1.0, axis));
    let axis = match axis {
        "x" | "X" => Vec3::X,
        "y" | "Y" => Vec3::Y,
        "z" | "Z" => Vec3::Z,
        _ => return Err("expected x, y, z, -x, -y or -z".to_owned()),
    };
    Ok(axis * sign)
}

/// The share of the picture that the model fills, above 0 and at most 1.
///
/// # Errors
/// A sentence that says what was expected.
pub fn fit(text: &str) -> Result<f32, String> {
    let share = text.parse().ok().filter(|share| *share > 0.0 && *share <= 1.0);
    share.ok_or_else(|| "expected a share above 0 and at most 1, such as 0.9".to_owned())
}

/// A magnification, 0.001 to 1,000,000.
///
/// # Errors
/// A sentence that says what was expected.
pub fn zoom(text: &str) -> Result<f32, String> {
    let zoom = text.parse().ok().filter(|zoom: &f32| (1e-3..=1e6).contains(zoom));
    zoom.ok_or_else(|| "expected a factor from 0.001 to 1000000, such as 2".to_owned())
}

/// `all`, `feature`, `feature=DEGREES`, `boundary` or `silhouette`.
///
/// # Errors
/// A sentence that says what was expected.
pub fn edges(text: &str) -> Result<WhichEdges, String> {
    let expected =
        || "expected all, feature, boundary or silhouette; feature also with degrees, as feature=20".to_owned();
    let which = match text.split_once('=') {
        Some(("feature", angle)) => WhichEdges::Feature(angle.parse::<f32>().map_err(|_| expected())?.to_radians()),
        Some(_) => return Err(expected()),
        None => WhichEdges::from_key(text).ok_or_else(expected)?,
    };
    Edges::new(which).validate().map(|()| which).map_err(|_| "expected degrees from 0 to 180".to_owned())
}

/// A width in pixels, or in world units as `0.01w`.
///
/// # Errors
/// A sentence that says what was expected.
pub fn width(text: &str) -> Result<Width, String> {
    text.parse().map_err(str::to_owned)
}

/// Two numbers, the lower first: `-1..2.5`.
///
/// # Errors
/// A sentence that says what was expected.
pub fn range(text: &str) -> Result<[f32; 2], String> {
    let ends =
        text.split_once("..").and_then(|(low, high)| Some([low.trim().parse().ok()?, high.trim().parse().ok()?]));
    ends.filter(|[low, high]: &[f32; 2]| low.is_finite() && high.is_finite() && low < high)
        .ok_or_else(|| "expected A..B, two numbers, the lower first, such as -1..2.5".to_owned())
}

/// The name of lines that explain a scene, one of [`Show::NAMES`].
///
/// # Errors
/// A sentence that says what was expected.
pub fn shown(text: &str) -> Result<&'static str, String> {
    let name = text.replace('-', "_");
    Show::NAMES.into_iter().find(|known| *known == name).ok_or_else(|| {
        let known: Vec<String> = Show::NAMES.iter().map(|name| name.replace('_', "-")).collect();
        format!("expected {}, or several of them with commas", known.join(", "))
    })
}

/// `clamp`, `renormalise`, `renormalise=SHARE`, `reinhard`, `reinhard=WHITE` or `aces`.
///
/// # Errors
/// A sentence that says what was expected.
pub fn intensity(text: &str) -> Result<Intensity, String> {
    let expected = || {
        "expected clamp, renormalise, reinhard or aces, the second and third also with a number, as reinhard=4"
            .to_owned()
    };
    let (word, number) = match text.split_once('=') {
        Some((word, number)) => (word, Some(number.parse::<f32>().map_err(|_| expected())?)),
        None => (text, None),
    };
    let intensity = match (choice(word), number) {
        (Ok(named), None) => named,
        (Ok(Intensity::Renormalize { .. }), Some(smoothing)) => Intensity::Renormalize { smoothing },
        (Ok(Intensity::Reinhard { .. }), Some(white)) => Intensity::Reinhard { white },
        _ => return Err(expected()),
    };
    intensity.validate().map(|()| intensity).map_err(|error| error.problem.to_string())
}

/// `exact`, or steps of 1/255 and pixels, `1` or `2,0.5`.
///
/// # Errors
/// A sentence that says what was expected.
pub fn tolerance(text: &str) -> Result<Tolerance, String> {
    if text == "exact" {
        return Ok(Tolerance::EXACT);
    }
    let (steps, pixels) = text.split_once(',').unwrap_or((text, "0"));
    let number = |text: &str| text.parse::<f32>().ok();
    let tolerance = number(steps).zip(number(pixels)).map(|(steps, pixels)| Tolerance { steps, pixels });
    tolerance
        .filter(|tolerance| tolerance.validate().is_ok())
        .ok_or_else(|| "expected exact, or steps and pixels, 0 or more, such as 1 or 2,0.5".to_owned())
}

/// 1, 4, 16 or 64.
///
/// # Errors
/// A sentence that says what was expected.
pub fn samples(text: &str) -> Result<u32, String> {
    let samples = text.parse().ok().filter(|samples| [1, 4, 16, 64].contains(samples));
    samples.ok_or_else(|| "expected 1, 4, 16 or 64".to_owned())
}

/// The number of isolines, 1 to 100.
///
/// # Errors
/// A sentence that says what was expected.
pub fn isolines(text: &str) -> Result<u32, String> {
    let lines = text.parse().ok().filter(|lines| (1..=100).contains(lines));
    lines.ok_or_else(|| "expected 1 to 100 lines".to_owned())
}

pub(super) fn switch(text: &str) -> Result<bool, String> {
    text.parse().map_err(|_| "expected true or false".to_owned())
}

pub(super) fn view(text: &str) -> Result<View, String> {
    text.parse()
}

pub(super) fn shading(text: &str) -> Result<Shading, String> {
    choice(text)
}

pub(super) fn only(text: &str) -> Result<Term, String> {
    choice(text)
}

pub(super) fn reflectance(text: &str) -> Result<Reflectance, String> {
    choice(text)
}

pub(super) fn lights(text: &str) -> Result<LightRig, String> {
    choice(text)
}

pub(super) fn map(text: &str) -> Result<ColorMap, String> {
    choice(text)
}

/// Any words but none.
pub(super) fn words(text: &str) -> Result<String, String> {
    if text.is_empty() { Err("expected a name or a title".to_owned()) } else { Ok(text.to_owned()) }
}

pub(super) fn show(text: &str) -> Result<Show, String> {
    let mut show = Show::default();
    for name in text.split(',') {
        let name = shown(name.trim())?;
        show.named(name).into_iter().for_each(|shown| *shown = true);
    }
    Ok(show)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_by_number_name_and_preset() {
        assert_eq!(color("red-plastic"), Ok(Material::RED_PLASTIC));
        // Presets come first: gold is a material and a CSS name.
        assert_eq!(color("Gold"), Ok(Material::GOLD));
        assert_eq!(color("#ff0000").map(|material| material.diffuse), Ok(LinearRgba::RED));
        assert_eq!(color("teal"), color("#008080"));
        for bad in ["", "#12", "bras", "#ff000080", "transparent"] {
            assert!(color(bad).is_err(), "{bad}");
        }
        assert!(color("bras").is_err_and(|error| error.contains("brass") && error.contains("red-plastic")));
    }

    #[test]
    fn backgrounds_of_one_colour_of_two_and_of_none() {
        let white = [1.0; 3];
        assert_eq!(background("white"), Ok(Background { above: white, below: None, opacity: 1.0 }));
        assert_eq!(background("transparent"), Ok(Background { above: [0.0; 3], below: None, opacity: 0.0 }));
        let two = Background { above: white, below: Some([1.0, 0.0, 0.0]), opacity: 1.0 };
        assert_eq!(background("#fff..red"), Ok(two));
        assert!(background("#ffffff80").is_ok_and(|half| (half.opacity - 0.5).abs() < 0.01));
        for bad in ["", "..", "white..", "nocolour", "white..#ff000080"] {
            assert!(background(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn normals_by_word_and_angle() {
        assert_eq!(normals("auto"), Ok(Normals::Auto));
        assert_eq!(normals("smooth"), normals("max"));
        assert!(matches!(normals("creased=30"), Ok(Normals::Creased { .. })));
        for bad in ["", "creased", "creased=200", "Smooth"] {
            assert!(normals(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn axes_shares_and_factors() {
        assert_eq!(up("z"), Ok(Vec3::Z));
        assert_eq!(up("-Y"), Ok(Vec3::NEG_Y));
        assert!(["", "w", "--z", "zz"].iter().all(|text| up(text).is_err()));
        assert_eq!(fit("0.5"), Ok(0.5));
        assert!(["", "0", "1.1", "-1", "nan"].iter().all(|text| fit(text).is_err()));
        assert_eq!(zoom("2"), Ok(2.0));
        assert!(["", "0", "inf", "-2"].iter().all(|text| zoom(text).is_err()));
    }

    #[test]
    fn edges_by_their_names() {
        assert_eq!(edges("all"), Ok(WhichEdges::All));
        assert_eq!(edges("feature"), Ok(WhichEdges::SHARP));
        assert_eq!(edges("feature=20"), Ok(WhichEdges::Feature(20_f32.to_radians())));
        for bad in ["", "All", "sharp", "feature=", "feature=-1", "feature=181", "all=3", "feature=NaN"] {
            assert!(edges(bad).is_err(), "{bad}");
        }
        assert!(["0", "-1", "wide", "inf"].into_iter().all(|bad| width(bad).is_err()));
    }

    #[test]
    fn ranges() {
        assert_eq!(range("-1..2.5"), Ok([-1.0, 2.5]));
        assert_eq!(range("1e-3 .. 1e3"), Ok([1e-3, 1e3]));
        for bad in ["", "1", "1..1", "2..1", "a..b", "0..inf", "nan..1", "0..1..2"] {
            assert!(range(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn names_of_lines_that_explain() {
        assert_eq!(shown("face-normals"), Ok("face_normals"));
        for bad in ["", "Axes", "axes,grid", "edges"] {
            assert!(shown(bad).is_err_and(|error| error.contains("face-normals")), "{bad}");
        }
        assert_eq!(show("axes, grid"), Ok(Show { axes: true, grid: true, ..Show::default() }));
    }

    #[test]
    fn policies_with_and_without_their_numbers() {
        for (text, expected) in [
            ("clamp", Intensity::Clamp),
            ("renormalise", Intensity::Renormalize { smoothing: 0.0 }),
            ("renormalise=0.9", Intensity::Renormalize { smoothing: 0.9 }),
            ("reinhard", Intensity::Reinhard { white: 4.0 }),
            ("reinhard=2.5", Intensity::Reinhard { white: 2.5 }),
            ("aces", Intensity::Aces),
        ] {
            assert_eq!(intensity(text), Ok(expected), "{text}");
        }
        for bad in ["", "tone", "aces=1", "clamp=1", "reinhard=", "reinhard=x", "Clamp"] {
            assert!(intensity(bad).is_err_and(|error| error.contains("as reinhard=4")), "{bad}");
        }
        assert!(intensity("reinhard=0.5").is_err_and(|error| error.contains("1 or more")));
        assert!(intensity("renormalise=1").is_err_and(|error| error.contains("0 to below 1")));
    }

    #[test]
    fn tolerances_by_steps_and_pixels() {
        assert_eq!(tolerance("exact"), Ok(Tolerance::EXACT));
        assert_eq!(tolerance("0,0"), Ok(Tolerance::EXACT));
        assert_eq!(tolerance("1"), Ok(Tolerance::steps(1.0)));
        assert_eq!(tolerance("1,0.5"), Ok(Tolerance { steps: 1.0, pixels: 0.5 }));
        assert_eq!(tolerance("2.5,0"), Ok(Tolerance::steps(2.5)));
        for bad in ["", "on", "-1", "1,-1", "inf", "NaN,1", "1px", "1,", ",1", "1,2,3", "Exact "] {
            assert!(tolerance(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn names_are_listed_where_one_is_wrong() {
        assert_eq!(choice("blinn-phong"), Ok(Reflectance::BlinnPhong));
        let error = choice::<Shading>("smooth").expect_err("no shading");
        assert_eq!(error, "expected flat, gouraud, phong or unlit");
    }
}

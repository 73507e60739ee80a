//! Wavefront MTL.

use bevy_color::LinearRgba;
use halfway_lighting::{Fields, InvalidValue, Material};
use halfway_mesh::{AlphaMode, GltfMaps, MetallicRoughness, MtlMaterial, SourceMap};

use super::metallic_roughness::from_metallic_roughness;
use super::warning::Warning;

/// `d` and `1 − Tr` may differ by this much before they disagree: both are commonly printed with two decimals, and
/// 1/8 and 7/8 become 0.13 and 0.88.
const OPACITY_SLACK: f32 = 0.015;

/// The material that an MTL file describes, with a warning for each change.
///
/// The format is Wavefront's (Alias|Wavefront, *File Formats*, version 4.2, 1995: Material Library File). Its highlight
/// is `Ks·(H·Hj)^Ns` with the halfway vector, so it is exact under
/// [`Reflectance::BlinnPhong`](halfway_lighting::Reflectance::BlinnPhong). Colors are taken as linear RGB.
///
/// | key | becomes | missing | refused |
/// |---|---|---|---|
/// | `Ka` | ambient | 0.2 grey | negative, NaN, above 10¹² |
/// | `Kd` | diffuse | 0.8 grey | same |
/// | `Ks` | specular | black: no highlight; white with a `map_Ks` | same |
/// | `Ke` | emission | black; white with a `map_Ke` | same |
/// | `Ns` | shininess | 32, with a warning where there is a highlight | negative, not finite |
/// | `d` | opacity; above 1 taken as 1 with a warning | 1 − `Tr` | negative, not finite |
/// | `Tr` | 1 − opacity; above 1 taken as 1 with a warning | 0 | negative, not finite |
///
/// Values above 1 in a colour are kept: the format allows them. Where `d` and `Tr` are both there and differ by more
/// than 0.015 from d = 1 − Tr, `d` wins with a warning; there are programs that write `Tr` the other way round, and `d`
/// is the key of the original format. An opacity of 0 is kept, with a warning: some programs write it for opaque
/// surfaces. Opacity acts only on entities with [`AlphaMode::Blend`](halfway_lighting::AlphaMode::Blend).
///
/// | `illum` | effect |
/// |---|---|
/// | 0 | constant colour: emission is Kd + Ke, all reflectances are black |
/// | 1 | ambient and diffuse; specular is black whatever `Ks` says |
/// | 2, missing | ambient, diffuse and specular |
/// | 3 to 10 | as 2 with a warning: reflection and refraction are left out |
/// | above 10 | as 2 with a warning |
///
/// A material with `Pr` or `Pm`, of the extension for physically based materials, becomes what
/// [`from_metallic_roughness`] makes of its `Kd`, `Pr` (roughness; missing: that of `Ns`, else 1), `Pm` (metallic;
/// missing: 0) and `Ke`, with a warning; `Ka`, `Ks` and `Ns` do not count then.
///
/// # Errors
/// The first key whose value is refused, as `MTL.Kd.green: …`.
pub fn from_mtl(mtl: &MtlMaterial) -> Result<(Material, Vec<Warning>), InvalidValue> {
    check(mtl)?;
    let mut warnings = Vec::new();
    if mtl.pr.is_some() || mtl.pm.is_some() {
        return physically_based(mtl, warnings);
    }
    let color = |key: Option<[f32; 3]>, missing| key.map_or(missing, |[r, g, b]| LinearRgba::rgb(r, g, b));
    // An image without a factor is to be seen.
    let mapped = |map: &Option<SourceMap>, missing| if map.is_some() { LinearRgba::WHITE } else { missing };
    let mut material = Material {
        ambient: color(mtl.ka, Material::DEFAULT.ambient),
        specular: color(mtl.ks, mapped(&mtl.maps.ks, Material::DEFAULT.specular)),
        emission: color(mtl.ke, mapped(&mtl.maps.ke, Material::DEFAULT.emission)),
        shininess: mtl.ns.unwrap_or(Material::DEFAULT.shininess),
        opacity: opacity(mtl, &mut warnings),
        ..Material::matte(color(mtl.kd, Material::DEFAULT.diffuse))
    };
    apply_illum(mtl.illum.unwrap_or(2), &mut material, &mut warnings);
    if mtl.ns.is_none() && material.specular != LinearRgba::BLACK {
        warnings.push(Warning::NoShininess { shininess: material.shininess });
    }
    // The sum of illum 0 is the one value that can pass a limit which its parts keep.
    material.validate()?;
    Ok((material, warnings))
}

/// The material of one with `Pr` or `Pm`.
fn physically_based(mtl: &MtlMaterial, mut warnings: Vec<Warning>) -> Result<(Material, Vec<Warning>), InvalidValue> {
    warnings.push(Warning::PhysicallyBased);
    let [r, g, b] = mtl.kd.unwrap_or([Material::DEFAULT.diffuse.red; 3]).map(|channel| channel.min(1.0));
    let mut material = from_metallic_roughness(&MetallicRoughness {
        name: mtl.name.clone(),
        base_color: [r, g, b, 1.0],
        metallic: mtl.pm.unwrap_or(0.0),
        roughness: mtl.pr.or(mtl.ns.map(roughness_from_shininess)).unwrap_or(1.0),
        emissive: mtl.ke.unwrap_or(if mtl.maps.ke.is_some() { [1.0; 3] } else { [0.0; 3] }),
        double_sided: false,
        unlit: false,
        specular_glossiness: None,
        alpha: AlphaMode::Opaque,
        maps: GltfMaps::default(),
    })?;
    material.opacity = opacity(mtl, &mut warnings);
    apply_illum(mtl.illum.unwrap_or(2), &mut material, &mut warnings);
    material.validate()?;
    Ok((material, warnings))
}

/// The roughness whose highlight has this exponent: the inverse of
/// [`shininess_from_roughness`](super::shininess_from_roughness).
fn roughness_from_shininess(n: f32) -> f32 {
    (2.0 / (n + 2.0)).powf(0.25)
}

fn check(mtl: &MtlMaterial) -> Result<(), InvalidValue> {
    let fields = Fields::for_owner("MTL");
    for (key, value) in [("Ka", mtl.ka), ("Kd", mtl.kd), ("Ks", mtl.ks), ("Ke", mtl.ke)] {
        value.map_or(Ok(()), |rgb| fields.channels(key, rgb))?;
    }
    for (key, value) in [("Ns", mtl.ns), ("d", mtl.d), ("Tr", mtl.tr)] {
        value.map_or(Ok(()), |number| fields.non_negative(key, number))?;
    }
    for (key, value) in [("Pr", mtl.pr), ("Pm", mtl.pm)] {
        value.map_or(Ok(()), |number| fields.unit_interval(key, number))?;
    }
    Ok(())
}

fn opacity(mtl: &MtlMaterial, warnings: &mut Vec<Warning>) -> f32 {
    let mut at_most_one = |key, value: f32| {
        if value > 1.0 {
            warnings.push(Warning::OpacityClamped { key, value });
        }
        value.min(1.0)
    };
    let d = mtl.d.map(|d| at_most_one("d", d));
    let from_tr = mtl.tr.map(|tr| 1.0 - at_most_one("Tr", tr));
    if let (Some(given), Some(tr), Some(d), Some(from_tr)) = (mtl.d, mtl.tr, d, from_tr)
        && (d - from_tr).abs() > OPACITY_SLACK
    {
        warnings.push(Warning::OpacityDisagrees { d: given, tr });
    }
    let opacity = d.or(from_tr).unwrap_or(1.0);
    if opacity == 0.0 {
        let (key, value) = mtl.d.map_or(("Tr", mtl.tr.unwrap_or(1.0)), |d| ("d", d));
        warnings.push(Warning::FullyTransparent { key, value });
    }
    opacity
}

fn apply_illum(illum: u8, material: &mut Material, warnings: &mut Vec<Warning>) {
    match illum {
        0 => {
            // Alpha is ignored everywhere, but a sum of two would not compare equal to a colour built by `rgb`.
            let constant = LinearRgba { alpha: 1.0, ..material.diffuse + material.emission };
            let (shininess, opacity) = (material.shininess, material.opacity);
            *material = Material { shininess, opacity, ..Material::emissive(constant) };
        }
        1 => material.specular = LinearRgba::BLACK,
        2 => {}
        3..=10 => warnings.push(Warning::IllumNeedsRays { illum }),
        _ => warnings.push(Warning::IllumUnknown { illum }),
    }
}

//! glTF 2.0 metallic-roughness materials, and those of `KHR_materials_pbrSpecularGlossiness`.

use bevy_color::LinearRgba;
use halfway_lighting::{Fields, InvalidValue, Material};
use halfway_mesh::{AlphaMode, MetallicRoughness, SpecularGlossiness};

/// The reflectance of a dielectric at normal incidence that glTF assumes (index of refraction 1.5).
pub const DIELECTRIC_REFLECTANCE: f32 = 0.04;

/// The largest shininess that a roughness becomes: a mirror has no highlight of finite size.
pub const SHININESS_MAX: f32 = 10_000.0;

/// A classic material that looks about like a metallic-roughness one.
///
/// From the glTF 2.0 specification, with c the base color (at most 1), m the metallic and ρ the roughness factor:
///
/// | field | value | from |
/// |---|---|---|
/// | diffuse | c·(1 − m) | appendix B, `c_diff` |
/// | specular | f₀·min((n + 8)/8, 1/max f₀), f₀ = lerp(0.04, c, m) | appendix B, `f0`; peak of normalised Blinn–Phong |
/// | shininess n | 2/ρ⁴ − 2, clamped to 1…10⁴ | [`shininess_from_roughness`] |
/// | ambient | c | see below |
/// | emission | the emissive color | |
/// | opacity | alpha where blended or masked ([`AlphaMode`](halfway_lighting::AlphaMode)); else 1 | section 3.9.4 |
///
/// The shininess is β, for [`Reflectance::BlinnPhong`](halfway_lighting::Reflectance::BlinnPhong). (n + 8)/8 is the
/// factor that keeps the reflected energy the same however small the highlight is (Akenine-Möller, Haines,
/// Hoffman, *Real-Time Rendering*, 3rd ed. 2008, chapter 7), written for a diffuse term without 1/π, as this project's
/// is; it is held back so that no channel passes 1 and the hue is kept. Ambient light comes from everywhere, so a
/// surface gives back of it about what it gives back in all: a dielectric its diffuse color, a metal its reflectance,
/// both of which are c.
///
/// Of an unlit one (`KHR_materials_unlit`), which shows its base color as it is, the diffuse color is c.
///
/// `KHR_materials_pbrSpecularGlossiness` names the reflectance itself: f₀ is its specular color, ρ is 1 less its
/// glossiness, the diffuse color is c·(1 − max f₀), as the extension has it, and the ambient one the larger of the diffuse
/// color and f₀, channel by channel.
///
/// Left out: the Fresnel rise toward grazing angles, the masking term, and reflections of the surroundings. A metal
/// therefore is darker than in a path tracer: it shows only highlights and ambient light.
///
/// # Errors
/// A factor is outside its range or not a number, as `MetallicRoughness.roughness: …`.
pub fn from_metallic_roughness(source: &MetallicRoughness) -> Result<Material, InvalidValue> {
    check(source)?;
    let [red, green, blue, alpha] = source.base_color;
    let base = [red, green, blue];
    let metallic = if source.unlit { 0.0 } else { source.metallic };
    let shininess = shininess_from_roughness(source.roughness);
    let given = source.specular_glossiness.as_ref().filter(|_| !source.unlit);
    let (diffuse, f0, ambient) = if let Some(SpecularGlossiness { specular: f0, .. }) = given {
        let left = 1.0 - f0[0].max(f0[1]).max(f0[2]);
        let diffuse = base.map(|c| c * left);
        (diffuse, *f0, std::array::from_fn(|i| diffuse[i].max(f0[i])))
    } else {
        let f0 = base.map(|c| DIELECTRIC_REFLECTANCE + (c - DIELECTRIC_REFLECTANCE) * metallic);
        (base.map(|c| c * (1.0 - metallic)), f0, base)
    };
    let largest = f0[0].max(f0[1]).max(f0[2]);
    // A black metal reflects nothing: its peak is 0 whatever the factor.
    let peak = if largest > 0.0 { ((shininess + 8.0) / 8.0).min(largest.recip()).max(1.0) } else { 1.0 };
    let material = Material {
        ambient: color(ambient),
        specular: color(f0.map(|f| f * peak)),
        emission: color(source.emissive),
        shininess,
        opacity: match source.alpha {
            AlphaMode::Opaque => 1.0,
            AlphaMode::Mask { .. } | AlphaMode::Blend => alpha,
        },
        ..Material::matte(color(diffuse))
    };
    material.validate().map(|()| material)
}

/// The Blinn–Phong exponent n = 2/α² − 2 with α = roughness², clamped to 1…[`SHININESS_MAX`].
///
/// The relation between a Phong distribution and a microfacet one of the same width: Walter, Marschner, Li and
/// Torrance, *Microfacet Models for Refraction through Rough Surfaces*, EGSR 2007. A roughness of 1 would give n = 0, a
/// highlight as wide as the lit side with a hard edge; hence the lower bound. Roughnesses below 0.1189 all give the
/// upper bound.
pub fn shininess_from_roughness(roughness: f32) -> f32 {
    let alpha = roughness * roughness;
    // A roughness of 0 divides to infinity, which the clamp takes.
    (2.0 / (alpha * alpha) - 2.0).clamp(1.0, SHININESS_MAX)
}

fn check(source: &MetallicRoughness) -> Result<(), InvalidValue> {
    let fields = Fields::for_owner("MetallicRoughness");
    let [red, green, blue, alpha] = source.base_color;
    fields.channels("base_color", [red, green, blue])?;
    fields.unit_interval("base_color.alpha", alpha)?;
    fields.unit_interval("metallic", source.metallic)?;
    fields.unit_interval("roughness", source.roughness)?;
    fields.channels("emissive", source.emissive)?;
    if let Some(SpecularGlossiness { specular, glossiness, .. }) = &source.specular_glossiness {
        for channel in *specular {
            fields.unit_interval("specular_glossiness.specular", channel)?;
        }
        fields.unit_interval("specular_glossiness.glossiness", *glossiness)?;
    }
    match source.alpha {
        AlphaMode::Mask { cutoff } => fields.non_negative("alpha.cutoff", cutoff),
        AlphaMode::Opaque | AlphaMode::Blend => Ok(()),
    }
}

fn color([red, green, blue]: [f32; 3]) -> LinearRgba {
    LinearRgba::rgb(red, green, blue)
}

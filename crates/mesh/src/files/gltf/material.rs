//! Metallic-roughness and specular-glossiness materials.

use gltf::Document;
use gltf::material::{AlphaMode as GltfAlphaMode, PbrSpecularGlossiness};
use gltf::texture::Info;

use super::fault::{Fault, check_finite};
use super::images::{Images, Lookup, TRANSFORM, TexturePlace};
use crate::{AlphaMode, GltfMaps, MetallicRoughness, SourceMap, SourceMaterial, SpecularGlossiness};

/// All materials of the document, in its order.
pub(super) fn materials(document: &Document, images: &mut Images) -> Result<Vec<SourceMaterial>, Fault> {
    document
        .materials()
        .enumerate()
        .map(|(index, material)| {
            let pbr = material.pbr_metallic_roughness();
            let specular = material.pbr_specular_glossiness();
            let (base_color, metallic, roughness) = match &specular {
                Some(specular) => (specular.diffuse_factor(), 0.0, 1.0 - specular.glossiness_factor()),
                None => (pbr.base_color_factor(), pbr.metallic_factor(), pbr.roughness_factor()),
            };
            let found = MetallicRoughness {
                name: material.name().unwrap_or_default().to_owned(),
                base_color,
                metallic,
                roughness,
                emissive: material.emissive_factor(),
                double_sided: material.double_sided(),
                unlit: material.unlit(),
                alpha: match material.alpha_mode() {
                    GltfAlphaMode::Opaque => AlphaMode::Opaque,
                    GltfAlphaMode::Mask => AlphaMode::Mask { cutoff: material.alpha_cutoff().unwrap_or(0.5) },
                    GltfAlphaMode::Blend => AlphaMode::Blend,
                },
                specular_glossiness: specular.map(|specular| specular_glossiness(index, &specular, images)),
                maps: maps(index, &material, images),
            };
            check(index, &found)?;
            Ok(SourceMaterial::MetallicRoughness(found))
        })
        .collect()
}

/// The use of a texture by its color.
fn plain(info: &Info) -> Lookup {
    Lookup { set: info.tex_coord(), transform: TexturePlace::of_info(info), amount: 1.0 }
}

fn specular_glossiness(index: usize, found: &PbrSpecularGlossiness, images: &mut Images) -> SpecularGlossiness {
    let map = found.specular_glossiness_texture().and_then(|info| {
        images.warnings.push(format!(
            "materials[{index}]: of the specular-glossiness texture only the color counts; the glossiness is the factor's"
        ));
        images.map((index, "specular-glossiness"), &info.texture(), &plain(&info))
    });
    SpecularGlossiness { specular: found.specular_factor(), glossiness: found.glossiness_factor(), map }
}

fn maps(index: usize, material: &gltf::Material, images: &mut Images) -> GltfMaps {
    let (specular, emission) = (material.pbr_specular_glossiness(), material.emissive_texture());
    let pbr = material.pbr_metallic_roughness();
    if let Some(info) = pbr.metallic_roughness_texture().filter(|_| specular.is_none()) {
        images.skip((index, "metallic-roughness"), &info.texture(), "the factors alone count");
    }
    let base = specular.map_or_else(|| pbr.base_color_texture(), |specular| specular.diffuse_texture());
    let mut map = |field, texture: gltf::Texture, lookup: Lookup| images.map((index, field), &texture, &lookup);
    let mut found = GltfMaps::default();
    if let Some(info) = base {
        found.base_color = map("base color", info.texture(), plain(&info));
    }
    if let Some(info) = emission {
        found.emissive = map("emissive", info.texture(), plain(&info));
    }
    if let Some(info) = material.occlusion_texture() {
        let transform = info.extension_value(TRANSFORM).and_then(TexturePlace::of_value);
        let lookup = Lookup { set: info.tex_coord(), transform, amount: info.strength() };
        found.occlusion = map("occlusion", info.texture(), lookup);
    }
    if let Some(info) = material.normal_texture() {
        let transform = info.extension_value(TRANSFORM).and_then(TexturePlace::of_value);
        let lookup = Lookup { set: info.tex_coord(), transform, amount: info.scale() };
        found.normal = map("normal", info.texture(), lookup);
    }
    found
}

fn check(index: usize, material: &MetallicRoughness) -> Result<(), Fault> {
    let cutoff = match material.alpha {
        AlphaMode::Mask { cutoff } => cutoff,
        _ => 0.0,
    };
    let amount = |map: &Option<SourceMap>| map.as_ref().map_or(1.0, |map| map.amount);
    let specular = material.specular_glossiness.as_ref();
    let fields: [(&str, &[f32]); 9] = [
        ("extensions.KHR_materials_pbrSpecularGlossiness.specularFactor", &specular.map_or([0.0; 3], |s| s.specular)),
        ("extensions.KHR_materials_pbrSpecularGlossiness.glossinessFactor", &[specular.map_or(0.0, |s| s.glossiness)]),
        ("baseColorFactor", &material.base_color),
        ("metallicFactor", &[material.metallic]),
        ("roughnessFactor", &[material.roughness]),
        ("emissiveFactor", &material.emissive),
        ("alphaCutoff", &[cutoff]),
        ("occlusionTexture.strength", &[amount(&material.maps.occlusion)]),
        ("normalTexture.scale", &[amount(&material.maps.normal)]),
    ];
    fields.iter().try_for_each(|(field, numbers)| check_finite(&|| format!("materials[{index}].{field}"), numbers))
}

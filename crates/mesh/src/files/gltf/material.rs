//! Metallic-roughness materials.

use gltf::Document;
use gltf::material::AlphaMode as GltfAlphaMode;
use gltf::texture::Info;

use super::fault::{Fault, check_finite};
use super::images::{Images, Lookup, TRANSFORM, TexturePlace};
use crate::{AlphaMode, GltfMaps, MetallicRoughness, SourceMap, SourceMaterial};

/// All materials of the document, in its order.
pub(super) fn materials(document: &Document, images: &mut Images) -> Result<Vec<SourceMaterial>, Fault> {
    document
        .materials()
        .enumerate()
        .map(|(index, material)| {
            let pbr = material.pbr_metallic_roughness();
            let found = MetallicRoughness {
                name: material.name().unwrap_or_default().to_owned(),
                base_color: pbr.base_color_factor(),
                metallic: pbr.metallic_factor(),
                roughness: pbr.roughness_factor(),
                emissive: material.emissive_factor(),
                double_sided: material.double_sided(),
                unlit: material.unlit(),
                alpha: match material.alpha_mode() {
                    GltfAlphaMode::Opaque => AlphaMode::Opaque,
                    GltfAlphaMode::Mask => AlphaMode::Mask { cutoff: material.alpha_cutoff().unwrap_or(0.5) },
                    GltfAlphaMode::Blend => AlphaMode::Blend,
                },
                maps: maps(index, &material, images),
            };
            check(index, &found)?;
            Ok(SourceMaterial::MetallicRoughness(found))
        })
        .collect()
}

fn maps(index: usize, material: &gltf::Material, images: &mut Images) -> GltfMaps {
    let plain = |info: &Info| Lookup { set: info.tex_coord(), transform: TexturePlace::of_info(info), amount: 1.0 };
    let (base, emission) = (material.pbr_metallic_roughness().base_color_texture(), material.emissive_texture());
    if let Some(info) = material.pbr_metallic_roughness().metallic_roughness_texture() {
        images.skip((index, "metallic-roughness"), &info.texture(), "the factors alone count");
    }
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
    let fields: [(&str, &[f32]); 7] = [
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

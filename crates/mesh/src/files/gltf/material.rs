//! Metallic-roughness materials.

use gltf::Document;
use gltf::material::AlphaMode as GltfAlphaMode;

use super::fault::{Fault, check_finite};
use super::images::Images;
use crate::{AlphaMode, MetallicRoughness, SourceMaterial};

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
                alpha: match material.alpha_mode() {
                    GltfAlphaMode::Opaque => AlphaMode::Opaque,
                    GltfAlphaMode::Mask => AlphaMode::Mask { cutoff: material.alpha_cutoff().unwrap_or(0.5) },
                    GltfAlphaMode::Blend => AlphaMode::Blend,
                },
                color_map: pbr.base_color_texture().and_then(|info| images.map(index, &info)),
            };
            check(index, &found)?;
            Ok(SourceMaterial::MetallicRoughness(found))
        })
        .collect()
}

fn check(index: usize, material: &MetallicRoughness) -> Result<(), Fault> {
    let cutoff = match material.alpha {
        AlphaMode::Mask { cutoff } => cutoff,
        _ => 0.0,
    };
    let fields: [(&str, &[f32]); 5] = [
        ("baseColorFactor", &material.base_color),
        ("metallicFactor", &[material.metallic]),
        ("roughnessFactor", &[material.roughness]),
        ("emissiveFactor", &material.emissive),
        ("alphaCutoff", &[cutoff]),
    ];
    fields.iter().try_for_each(|(field, numbers)| check_finite(&|| format!("materials[{index}].{field}"), numbers))
}

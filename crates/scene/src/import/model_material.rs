//! The material of a model, whichever format it came in.

use halfway_lighting::{Faces, InvalidValue, Mask, Material};
use halfway_mesh::{AlphaMode, MetallicRoughness, MtlMaterial, SourceMaterial};

use super::metallic_roughness::from_metallic_roughness;
use super::mtl::from_mtl;

/// A material that came with a model, and how it wants to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelMaterial {
    /// The material, as [`from_mtl`] and [`from_metallic_roughness`] make it.
    pub material: Material,
    /// Both where the file says double-sided, else the front.
    pub faces: Faces,
    /// Whether the file asks for blending. An MTL file cannot; whoever shows it has to.
    pub blend: bool,
    /// The opacity below which the surface is not there, where the file says so: glTF's `alphaCutoff`; of an MTL
    /// material with a `map_d` 0.5, since such images mostly cut something out.
    pub mask: Option<f32>,
}

impl ModelMaterial {
    /// The material that a model file describes, with a sentence for everything that was mended or left out.
    ///
    /// # Errors
    /// [`InvalidValue`] for a number that is not finite or out of its range.
    pub fn from_source(source: &SourceMaterial) -> Result<(Self, Vec<String>), InvalidValue> {
        match source {
            SourceMaterial::Mtl(mtl) => Self::from_mtl_file(mtl),
            SourceMaterial::MetallicRoughness(gltf) => Ok((Self::from_gltf(gltf)?, Vec::new())),
        }
    }

    fn from_mtl_file(mtl: &MtlMaterial) -> Result<(Self, Vec<String>), InvalidValue> {
        let (material, warnings) = from_mtl(mtl)?;
        let warnings = warnings.iter().map(ToString::to_string).collect();
        let mask = mtl.maps.d.as_ref().map(|_| Mask::default().0);
        Ok((Self { material, faces: Faces::Front, blend: false, mask }, warnings))
    }

    fn from_gltf(gltf: &MetallicRoughness) -> Result<Self, InvalidValue> {
        let material = from_metallic_roughness(gltf)?;
        Ok(Self {
            material,
            faces: if gltf.double_sided { Faces::Both } else { Faces::Front },
            blend: gltf.alpha == AlphaMode::Blend,
            mask: match gltf.alpha {
                AlphaMode::Mask { cutoff } => Some(cutoff),
                AlphaMode::Opaque | AlphaMode::Blend => None,
            },
        })
    }
}

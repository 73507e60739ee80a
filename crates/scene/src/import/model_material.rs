//! The material of a model, whichever format it came in.

use halfway_lighting::{AlphaMode, Faces, InvalidValue, Material, Shading};
use halfway_mesh::{AlphaMode as SourceAlpha, MetallicRoughness, MtlMaterial, SourceMaterial};

use super::metallic_roughness::from_metallic_roughness;
use super::mtl::from_mtl;

/// A material that came with a model, and how it wants to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelMaterial {
    /// The material, as [`from_mtl`] and [`from_metallic_roughness`] make it.
    pub material: Material,
    /// Both where the file says double-sided, else the front.
    pub faces: Faces,
    /// [`Shading::Unlit`] where the file says `KHR_materials_unlit`; else none of its own.
    pub shading: Option<Shading>,
    /// The effect of its opacity: glTF's `alphaMode` and `alphaCutoff`. An MTL file cannot ask for blending, so the
    /// caller has to; with a `map_d` the surface is cut out at 0.5, since such images mostly cut something out, else it
    /// is opaque.
    pub alpha: AlphaMode,
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
        let cutoff = mtl.maps.d.as_ref().map(|_| AlphaMode::CUTOFF);
        Ok((Self { material, faces: Faces::Front, shading: None, alpha: AlphaMode::new(cutoff, false) }, warnings))
    }

    fn from_gltf(gltf: &MetallicRoughness) -> Result<Self, InvalidValue> {
        let material = from_metallic_roughness(gltf)?;
        Ok(Self {
            material,
            faces: if gltf.double_sided { Faces::Both } else { Faces::Front },
            shading: gltf.unlit.then_some(Shading::Unlit),
            alpha: match gltf.alpha {
                SourceAlpha::Opaque => AlphaMode::Opaque,
                SourceAlpha::Mask { cutoff } => AlphaMode::Mask(cutoff),
                SourceAlpha::Blend => AlphaMode::Blend,
            },
        })
    }
}

//! What a model file says of materials and lights, in the terms of the lighting.
//!
//! `halfway_mesh` reads files and `halfway_lighting` knows the equations; this is where the two meet.
//!
//! ```no_run
//! use halfway::model::ModelMaterial;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let model = halfway::mesh::load("assets/teapot.obj".as_ref())?;
//! for source in &model.materials {
//!     let (material, warnings) = ModelMaterial::of(source)?;
//!     println!("{}: {:?} {warnings:?}", source.name(), material.material);
//! }
//! # Ok(())
//! # }
//! ```

use bevy_math::Vec3;
use bevy_transform::components::Transform;
use halfway_lighting::conversion::{
    self, MetallicRoughnessNumbers, MtlNumbers, PunctualKind, PunctualLight, PunctualNumbers, RADIANCE_SCALE,
    from_metallic_roughness, from_mtl, from_punctual,
};
use halfway_lighting::{Faces, InvalidValue, Material, rotation_along};
use halfway_mesh::{AlphaMode, MetallicRoughness, MtlMaterial, SourceLight, SourceLightKind, SourceMaterial};

/// A material that came with a model, and how it wants to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelMaterial {
    /// The material, translated by [`halfway_lighting::conversion`].
    pub material: Material,
    /// Both where the file says double-sided, else the front.
    pub faces: Faces,
    /// Whether the file asks for blending. An MTL file cannot; whoever shows it has to.
    pub blend: bool,
}

impl ModelMaterial {
    /// The material that a model file describes, with a sentence for everything that was mended or left out.
    ///
    /// # Errors
    /// [`InvalidValue`] for a number that is not finite or out of its range.
    pub fn of(source: &SourceMaterial) -> Result<(Self, Vec<String>), InvalidValue> {
        match source {
            SourceMaterial::Mtl(mtl) => Self::of_mtl(mtl),
            SourceMaterial::MetallicRoughness(gltf) => Ok((Self::of_gltf(gltf)?, Vec::new())),
        }
    }

    fn of_mtl(mtl: &MtlMaterial) -> Result<(Self, Vec<String>), InvalidValue> {
        let &MtlMaterial { ka, kd, ks, ke, ns, d, tr, illum, .. } = mtl;
        let (material, warnings) = from_mtl(&MtlNumbers { ka, kd, ks, ke, ns, d, tr, illum })?;
        let warnings = warnings.iter().map(ToString::to_string).collect();
        Ok((Self { material, faces: Faces::Front, blend: false }, warnings))
    }

    fn of_gltf(gltf: &MetallicRoughness) -> Result<Self, InvalidValue> {
        let &MetallicRoughness { base_color, metallic, roughness, emissive, double_sided, alpha, .. } = gltf;
        let numbers_alpha = match alpha {
            AlphaMode::Opaque => conversion::AlphaMode::Opaque,
            AlphaMode::Mask { cutoff } => conversion::AlphaMode::Mask { cutoff },
            AlphaMode::Blend => conversion::AlphaMode::Blend,
        };
        let numbers = MetallicRoughnessNumbers { base_color, metallic, roughness, emissive, alpha: numbers_alpha };
        let material = from_metallic_roughness(&numbers)?;
        Ok(Self {
            material,
            faces: if double_sided { Faces::Both } else { Faces::Front },
            // What a mask cuts away has opacity 0, which shows only where it is blended.
            blend: alpha == AlphaMode::Blend || material.opacity == 0.0,
        })
    }
}

/// The light that a model file describes, and where it stands in the model. The frame of a light may scale, which has no
/// meaning for one: position and direction are taken from it.
///
/// # Errors
/// [`InvalidValue`] for a number out of its range, and for a frame that leaves no direction.
pub fn model_light(light: &SourceLight) -> Result<(PunctualLight, Transform), InvalidValue> {
    let numbers = PunctualNumbers {
        kind: match light.kind {
            SourceLightKind::Directional => PunctualKind::Directional,
            SourceLightKind::Point => PunctualKind::Point,
            SourceLightKind::Spot { inner, outer } => PunctualKind::Spot { inner, outer },
        },
        color: light.color,
        intensity: light.intensity,
        range: light.range,
    };
    let component = from_punctual(&numbers, RADIANCE_SCALE)?;
    let mut place = Transform::from_translation(light.world_from_light.w_axis.truncate());
    // A point light has no direction that could be wrong.
    if light.kind != SourceLightKind::Point {
        place.rotation = rotation_along(light.world_from_light.transform_vector3(Vec3::NEG_Z))?;
    }
    Ok((component, place))
}

//! One mesh at many places: `EXT_mesh_gpu_instancing`.

use glam::{DMat4, DQuat, DVec3, DVec4, Vec3};
use gltf::{Document, Node};

use super::accessor::{Accessors, Attribute, LENGTHS, TURN};
use super::extensions::INSTANCING;
use super::fault::Fault;
use crate::Part;
use crate::animation::Placed;

/// The places of a node's mesh in the node: one, unless the extension says more. `name` is that of the parts.
pub(super) fn instances<'a>(
    document: &'a Document,
    node: &Node<'a>,
    accessors: &mut Accessors<'a>,
    name: &str,
) -> Result<Vec<DMat4>, Fault> {
    let Some(extension) = node.extension_value(INSTANCING) else { return Ok(vec![DMat4::IDENTITY]) };
    let element = |field: &str| format!("nodes[{}].extensions.{INSTANCING}.attributes{field}", node.index());
    let accessor = |field: &str| {
        let Some(value) = extension.get("attributes").and_then(|attributes| attributes.get(field)) else {
            return Ok(None);
        };
        let index = value.as_u64().and_then(|index| usize::try_from(index).ok());
        let found = index.and_then(|index| document.accessors().nth(index));
        let expected = || format!("one of the {} accessors, from 0, is", document.accessors().len());
        found.map(Some).ok_or_else(|| Fault::element(element(&format!(".{field}")), value.to_string(), expected()))
    };
    let [translation, rotation, scale] = [accessor("TRANSLATION")?, accessor("ROTATION")?, accessor("SCALE")?];
    let counts: Vec<usize> =
        [&translation, &rotation, &scale].into_iter().flatten().map(gltf::Accessor::count).collect();
    let Some(&count) = counts.first() else { return Ok(vec![DMat4::IDENTITY]) };
    if counts.iter().any(|other| *other != count) {
        return Err(Fault::element(element(""), format!("{counts:?} values"), "as many of each are"));
    }
    let mut list = |accessor: Option<gltf::Accessor<'a>>, kind: &Attribute| {
        accessor.map(|accessor| accessors.floats::<3>(&accessor, kind)).transpose()
    };
    let (translations, scales) = (list(translation, &LENGTHS)?, list(scale, &LENGTHS)?);
    let rotations = rotation.map(|accessor| accessors.floats::<4>(&accessor, &TURN)).transpose()?;
    let each = size_of::<Part>() + size_of::<Placed>() + size_of::<DMat4>() + name.len();
    accessors.spend(&|| element(""), count.saturating_mul(each))?;
    let vector = |list: &Option<Vec<[f32; 3]>>, i: usize, default| {
        list.as_ref().map_or(default, |list| Vec3::from_array(list[i]).as_dvec3())
    };
    let place = |i: usize| {
        let rotation = rotations.as_ref().map_or(DVec4::W, |list| DVec4::from_array(list[i].map(f64::from)));
        let rotation = DQuat::from_vec4(rotation.normalize_or(DVec4::W));
        let (translation, scale) = (vector(&translations, i, DVec3::ZERO), vector(&scales, i, DVec3::ONE));
        DMat4::from_scale_rotation_translation(scale, rotation, translation)
    };
    Ok((0..count).map(place).collect())
}

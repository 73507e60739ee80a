//! The JSON of a glTF file, checked.
//!
//! The `gltf` crate's own validation refuses several things that are legal, and what readers can do without; its
//! complaints about those are not heeded. All others are errors, so that every index refers to an element.

use std::collections::BTreeMap;

use gltf::Document;
use gltf::json::Root;
use gltf::json::camera::Type as CameraType;
use gltf::json::mesh::Semantic;
use gltf::json::validation::{Checked, Error, Validate};
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;

use super::extensions;
use super::fault::Fault;

/// A document with what the `gltf` crate's types do not hold of it.
pub(super) struct Opened {
    pub(super) document: Document,
    pub(super) beside: Beside,
    /// How many channels of animations were left out, since they have no node.
    pub(super) dropped_channels: usize,
}

/// The parts of a document that the `gltf` crate rounds to `f32`, or leaves out.
#[derive(Default, Deserialize)]
pub(super) struct Beside {
    #[serde(default)]
    pub(super) nodes: Vec<NodeTransform>,
    #[serde(default)]
    meshes: Vec<MeshTargets>,
}

/// The transform of a node, in the digits of the file.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
pub(super) struct NodeTransform {
    pub(super) matrix: Option<[f64; 16]>,
    pub(super) translation: Option<[f64; 3]>,
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
}

#[derive(Deserialize)]
struct MeshTargets {
    #[serde(default)]
    primitives: Vec<PrimitiveTargets>,
}

#[derive(Deserialize)]
struct PrimitiveTargets {
    #[serde(default)]
    #[expect(clippy::zero_sized_map_values, reason = "the values are there, and of no account")]
    targets: Vec<BTreeMap<String, IgnoredAny>>,
}

impl Beside {
    /// How many primitives have morph targets of more than positions, normals and tangents.
    pub(super) fn with_more_targets(&self) -> usize {
        let is_more = |name: &String| !matches!(name.as_str(), "POSITION" | "NORMAL" | "TANGENT");
        let primitives = self.meshes.iter().flat_map(|mesh| &mesh.primitives);
        primitives.filter(|primitive| primitive.targets.iter().any(|target| target.keys().any(is_more))).count()
    }
}

/// The document, of which every index refers to an element.
pub(super) fn open(json: &[u8]) -> Result<Opened, Fault> {
    // A binary file in the place of text, which the `gltf` crate would open without checking its header.
    if json.starts_with(b"glTF") {
        return Err(Fault::element("JSON chunk", "binary glTF", "JSON is"));
    }
    let (mut root, dropped_channels) = root(json)?;
    if !root.asset.version.starts_with("2.") {
        let found = format!("version {:?}", root.asset.version);
        return Err(Fault::element("asset.version", found, "version \"2.0\" is"));
    }
    extensions::check_required(&root.extensions_required)?;
    // Validation allows only extensions that the crate itself reads.
    let required = std::mem::take(&mut root.extensions_required);
    check_positions(&root)?;
    check_cameras(&root)?;
    // Attributes of an application's own, as `_ID`, are allowed; the `gltf` crate reports them as mistakes.
    for primitive in root.meshes.iter_mut().flat_map(|mesh| &mut mesh.primitives) {
        primitive.attributes.remove(&Checked::Invalid);
    }
    check_indices(&root)?;
    root.extensions_required = required;
    let beside = serde_json::from_slice(json).map_err(|error| unreadable(&error))?;
    Ok(Opened { document: Document::from_json_without_validation(root), beside, dropped_channels })
}

/// The JSON as the `gltf` crate's types. They take every channel of an animation to have a node; those that have none are
/// left out and counted. They take every number to fit into `f32`; those that do not become infinite, which is checked
/// where they are used.
fn root(json: &[u8]) -> Result<(Root, usize), Fault> {
    let error = match serde_json::from_slice(json) {
        Ok(root) => return Ok((root, 0)),
        Err(error) => unreadable(&error),
    };
    let Ok(mut value) = serde_json::from_slice::<Value>(json) else { return Err(error) };
    let mut dropped = 0;
    let animations = value.get_mut("animations").and_then(Value::as_array_mut);
    for animation in animations.into_iter().flatten() {
        let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) else { continue };
        let before = channels.len();
        channels.retain(|channel| channel.get("target").is_none_or(|target| target.get("node").is_some()));
        dropped += before - channels.len();
    }
    let found = serde_json::from_value(value).map(|root| (root, dropped));
    // The first error has a line.
    found.map_err(|second| if dropped == 0 { error } else { unreadable(&second) })
}

/// Checks that the accessors of positions exist: the `gltf` crate's validation looks them up before checking.
fn check_positions(json: &Root) -> Result<(), Fault> {
    for (m, mesh) in json.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let position = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
            let Some(position) = position.filter(|index| index.value() >= json.accessors.len()) else {
                continue;
            };
            return Err(Fault::element(
                format!("meshes[{m}].primitives[{p}].attributes.POSITION"),
                format!("accessor {}", position.value()),
                format!("one of the {} accessors, from 0, is", json.accessors.len()),
            ));
        }
    }
    Ok(())
}

/// Checks that cameras have the projection that they name, which the `gltf` crate takes for granted.
fn check_cameras(json: &Root) -> Result<(), Fault> {
    for (index, camera) in json.cameras.iter().enumerate() {
        let is_there = match camera.type_ {
            Checked::Valid(CameraType::Perspective) => camera.perspective.is_some(),
            Checked::Valid(CameraType::Orthographic) => camera.orthographic.is_some(),
            // Validation finds this.
            Checked::Invalid => true,
        };
        if !is_there {
            return Err(Fault::element(format!("cameras[{index}]"), "no projection of its type", "one is"));
        }
    }
    Ok(())
}

/// The `gltf` crate's validation, without its complaints about what is legal.
fn check_indices(json: &Root) -> Result<(), Fault> {
    let (mut first, mut more) = (None, 0_usize);
    json.validate(json, gltf::json::Path::new, &mut |path, error| {
        let path = path();
        if is_no_fault(path.as_str(), error) {
            return;
        }
        match first {
            None => first = Some((path, error)),
            Some(_) => more += 1,
        }
    });
    let Some((path, error)) = first else { return Ok(()) };
    let more = if more == 0 { String::new() } else { format!(" (and {more} more)") };
    let found = format!("{}{more}", error.to_string().to_lowercase());
    Err(Fault::element(path.to_string(), found, "valid glTF 2.0 is"))
}

/// Whether the `gltf` crate complains about a thing that files may have: an accessor without a `bufferView`, which is all
/// zeros, and a primitive without positions. Nor are the least and greatest positions needed.
fn is_no_fault(path: &str, error: Error) -> bool {
    const POSITION: &str = ".attributes[\"POSITION\"]";
    let is_missing = error == Error::Missing;
    path.ends_with(&[POSITION, ".min"].concat())
        || path.ends_with(&[POSITION, ".max"].concat())
        || is_missing && path.ends_with(POSITION)
        || is_missing && path.starts_with("accessors[") && path.ends_with("].bufferView")
}

pub(super) fn unreadable(error: &serde_json::Error) -> Fault {
    Fault::element("JSON", error.to_string(), "a glTF 2.0 document is")
}

//! The node tree: the world transforms of meshes and lights.

use glam::{DMat4, DQuat, DVec3, Mat4, Vec4};
use gltf::camera::{Camera, Projection};
use gltf::khr_lights_punctual::{Kind, Light};
use gltf::scene::Transform;
use gltf::{Document, Node};

use super::fault::{Fault, check_finite};
use super::primitive::{PrimitiveShape, Primitives};
use crate::{LinePart, Part, SourceCamera, SourceLight, SourceLightKind, SourceProjection};

/// The most parts made of one file: nodes and primitives multiply.
const MOST_PARTS: usize = 1 << 18;

/// How far the last row of a matrix may be from (0, 0, 0, 1): a few roundings of `f32`, as a product or an inverse of
/// matrices leaves them.
const ROUNDED: f32 = 1e-5;

/// The meshes, lights and cameras of the scene, in world space.
#[derive(Default)]
pub(super) struct Contents {
    pub(super) parts: Vec<Part>,
    pub(super) lines: Vec<LinePart>,
    pub(super) lights: Vec<SourceLight>,
    pub(super) cameras: Vec<SourceCamera>,
    /// How many matrices had a last row that was corrected, and the first of them.
    pub(super) mended: Option<(usize, String)>,
}

/// The contents of the default scene; of the first where none is the default; of all nodes without a parent
/// where there is no scene.
pub(super) fn read<'a>(document: &'a Document, primitives: &mut Primitives<'a>) -> Result<Contents, Fault> {
    let mut reader =
        SceneReader { primitives, seen: vec![false; document.nodes().len()], contents: Contents::default() };
    // Children are put on the stack last to first, so that nodes come in the order of the file.
    let mut stack: Vec<(Node, DMat4)> = roots(document).into_iter().rev().map(|node| (node, DMat4::IDENTITY)).collect();
    while let Some((node, world_from_parent)) = stack.pop() {
        let world_from_node = reader.visit(&node, world_from_parent)?;
        let children: Vec<Node> = node.children().collect();
        stack.extend(children.into_iter().rev().map(|child| (child, world_from_node)));
    }
    Ok(reader.contents)
}

fn roots(document: &Document) -> Vec<Node<'_>> {
    if let Some(scene) = document.default_scene().or_else(|| document.scenes().next()) {
        return scene.nodes().collect();
    }
    let mut is_child = vec![false; document.nodes().len()];
    for child in document.nodes().flat_map(|node| node.children()) {
        is_child[child.index()] = true;
    }
    document.nodes().filter(|node| !is_child[node.index()]).collect()
}

struct SceneReader<'r, 'a> {
    primitives: &'r mut Primitives<'a>,
    seen: Vec<bool>,
    contents: Contents,
}

impl<'a> SceneReader<'_, 'a> {
    /// Reads the contents of a node; returns its transform.
    fn visit(&mut self, node: &Node<'a>, world_from_parent: DMat4) -> Result<DMat4, Fault> {
        let element = || format!("nodes[{}]", node.index());
        if std::mem::replace(&mut self.seen[node.index()], true) {
            let expected = "a tree, in which every node has one parent at most, is";
            return Err(Fault::element(element(), "reached twice", expected));
        }
        let world_from_node = world_from_parent * parent_from_node(node, &mut self.contents.mended)?;
        let world = world_from_node.as_mat4();
        if !world.is_finite() {
            let found = "a transform that leaves the range of f32";
            return Err(Fault::element(element(), found, "a smaller one is"));
        }
        if let Some(light) = node.light() {
            self.contents.lights.push(source_light(node, &light, world)?);
        }
        if let Some(camera) = node.camera() {
            self.contents.cameras.push(source_camera(node, &camera, world)?);
        }
        if let Some(mesh) = node.mesh() {
            for primitive in mesh.primitives() {
                let shape = self.primitives.shape(mesh.index(), &primitive)?;
                if self.contents.parts.len() + self.contents.lines.len() == MOST_PARTS {
                    let found = format!("more than {MOST_PARTS} primitives shown");
                    return Err(Fault::element(element(), found, "fewer are"));
                }
                let name = node.name().or(mesh.name()).unwrap_or_default().to_owned();
                let (material, world_from_part) = (primitive.material().index(), world);
                match shape {
                    PrimitiveShape::Mesh(mesh) => {
                        self.contents.parts.push(Part { name, mesh, material, world_from_part });
                    }
                    PrimitiveShape::Lines(lines) => {
                        self.contents.lines.push(LinePart { name, lines, material, world_from_part });
                    }
                }
            }
        }
        Ok(world_from_node)
    }
}

/// The transform of a node. A matrix whose last row is off by rounding is corrected and counted.
fn parent_from_node(node: &Node, mended: &mut Option<(usize, String)>) -> Result<DMat4, Fault> {
    let field = |name: &str| format!("nodes[{}].{name}", node.index());
    match node.transform() {
        Transform::Matrix { matrix } => {
            check_finite(&|| field("matrix"), matrix.as_flattened())?;
            let mut matrix = Mat4::from_cols_array_2d(&matrix);
            let last_row = matrix.row(3);
            if last_row != Vec4::W {
                let found = format!("last row {:?}", last_row.to_array());
                if (last_row - Vec4::W).abs().max_element() > ROUNDED {
                    return Err(Fault::element(field("matrix"), found, "0, 0, 0, 1 is"));
                }
                mended.get_or_insert_with(|| (0, format!("{}: {found}", field("matrix")))).0 += 1;
                for (axis, last) in [0.0, 0.0, 0.0, 1.0].into_iter().enumerate() {
                    matrix.col_mut(axis).w = last;
                }
            }
            Ok(matrix.as_dmat4())
        }
        Transform::Decomposed { translation, rotation, scale } => {
            check_finite(&|| field("translation"), &translation)?;
            check_finite(&|| field("rotation"), &rotation)?;
            check_finite(&|| field("scale"), &scale)?;
            let quaternion = DQuat::from_array(rotation.map(f64::from));
            if quaternion.length() == 0.0 {
                let found = format!("{rotation:?}");
                return Err(Fault::element(field("rotation"), found, "a unit quaternion is"));
            }
            Ok(DMat4::from_scale_rotation_translation(
                DVec3::from_array(scale.map(f64::from)),
                quaternion.normalize(),
                DVec3::from_array(translation.map(f64::from)),
            ))
        }
    }
}

fn source_light(node: &Node, light: &Light, world_from_light: Mat4) -> Result<SourceLight, Fault> {
    let field = |name: &str| format!("lights[{}].{name}", light.index());
    let kind = match light.kind() {
        Kind::Directional => SourceLightKind::Directional,
        Kind::Point => SourceLightKind::Point,
        Kind::Spot { inner_cone_angle, outer_cone_angle } => {
            let angles = [inner_cone_angle, outer_cone_angle];
            check_finite(&|| field("spot"), &angles)?;
            SourceLightKind::Spot { inner: inner_cone_angle, outer: outer_cone_angle }
        }
    };
    check_finite(&|| field("color"), &light.color())?;
    check_finite(&|| field("intensity"), &[light.intensity()])?;
    check_finite(&|| field("range"), &[light.range().unwrap_or(0.0)])?;
    Ok(SourceLight {
        name: light.name().or(node.name()).unwrap_or_default().to_owned(),
        kind,
        color: light.color(),
        intensity: light.intensity(),
        range: light.range(),
        world_from_light,
    })
}

fn source_camera(node: &Node, camera: &Camera, world_from_camera: Mat4) -> Result<SourceCamera, Fault> {
    let field = |name: &str| format!("cameras[{}].{name}", camera.index());
    let projection = match camera.projection() {
        Projection::Perspective(found) => {
            let (near, far) = (found.znear(), found.zfar());
            let numbers = [found.yfov(), found.aspect_ratio().unwrap_or(1.0), near, far.unwrap_or(f32::MAX)];
            check_finite(&|| field("perspective"), &numbers)?;
            if numbers.iter().any(|x| *x <= 0.0) || far.is_some_and(|far| far <= near) {
                let expected = "an angle and an aspect ratio above 0, and 0 < znear < zfar, are";
                return Err(Fault::element(field("perspective"), format!("{numbers:?}"), expected));
            }
            SourceProjection::Perspective { yfov: found.yfov(), aspect: found.aspect_ratio(), near, far }
        }
        Projection::Orthographic(found) => {
            let (half_width, half_height) = (found.xmag(), found.ymag());
            let numbers = [half_width, half_height, found.znear(), found.zfar()];
            check_finite(&|| field("orthographic"), &numbers)?;
            let [_, _, near, far] = numbers;
            if half_width == 0.0 || half_height == 0.0 || near < 0.0 || far <= near {
                return Err(Fault::element(
                    field("orthographic"),
                    format!("{numbers:?}"),
                    "magnifications that are not 0, and 0 ≤ znear < zfar, are",
                ));
            }
            SourceProjection::Orthographic { half_width, half_height, near, far }
        }
    };
    let name = camera.name().or(node.name()).unwrap_or_default().to_owned();
    Ok(SourceCamera { name, projection, world_from_camera })
}

//! The node tree: the world transforms of meshes, lights and cameras.

use std::sync::Arc;

use glam::{DMat4, Mat4};
use gltf::camera::{Camera, Projection};
use gltf::khr_lights_punctual::{Kind, Light};
use gltf::{Document, Node};

use super::fault::{Fault, check_finite};
use super::instances::instances;
use super::nodes::Nodes;
use super::primitive::{PrimitiveShape, Primitives};
use super::skins::Skins;
use crate::animation::{Placed, Shape};
use crate::{LinePart, Part, SourceCamera, SourceLight, SourceLightKind, SourceProjection};

/// The most parts made of one file: nodes and primitives multiply.
const MOST_PARTS: usize = 1 << 18;

/// The meshes, lights and cameras of the scene, each with its place; their own matrices are still to be set.
#[derive(Default)]
pub(super) struct Contents {
    pub(super) parts: Vec<(Part, Placed)>,
    pub(super) lines: Vec<(LinePart, Placed)>,
    pub(super) lights: Vec<(SourceLight, Placed)>,
    pub(super) cameras: Vec<(SourceCamera, Placed)>,
    /// How many meshes of nodes with a skin have no joints.
    pub(super) without_joints: usize,
}

/// The contents of the default scene; of the first where none is the default; of all nodes without a parent
/// where there is no scene.
pub(super) fn read<'a>(
    document: &'a Document,
    nodes: &mut Nodes<'a>,
    primitives: &mut Primitives<'a>,
) -> Result<Contents, Fault> {
    // The nodes are entered before skins are read, whose joints would come before their turn.
    let shown = enter(document, nodes)?;
    let skins = Skins::new(document);
    let mut reader = SceneReader { document, nodes, primitives, skins, contents: Contents::default() };
    for (node, place) in &shown {
        reader.visit(node, *place)?;
    }
    Ok(reader.contents)
}

/// Enters the nodes of the scene; returns them with their places. Each comes before what is below it, children in the
/// order of the file, so that writers can give the parts back in their order.
fn enter<'a>(document: &'a Document, nodes: &mut Nodes<'a>) -> Result<Vec<(Node<'a>, usize)>, Fault> {
    let mut seen = vec![false; document.nodes().len()];
    let mut shown = Vec::new();
    // Children are put on the stack last to first.
    let mut stack: Vec<(Node, Option<usize>)> = roots(document).into_iter().rev().map(|node| (node, None)).collect();
    while let Some((node, parent)) = stack.pop() {
        if std::mem::replace(&mut seen[node.index()], true) {
            let expected = "a tree, in which every node has one parent at most, is";
            return Err(Fault::element(format!("nodes[{}]", node.index()), "reached twice", expected));
        }
        let place = nodes.enter(node.index(), parent)?;
        let children: Vec<Node> = node.children().collect();
        stack.extend(children.into_iter().rev().map(|child| (child, Some(node.index()))));
        shown.push((node, place));
    }
    Ok(shown)
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
    document: &'a Document,
    nodes: &'r mut Nodes<'a>,
    primitives: &'r mut Primitives<'a>,
    skins: Skins<'a>,
    contents: Contents,
}

impl<'a> SceneReader<'_, 'a> {
    /// Reads the contents of a node, by its place.
    fn visit(&mut self, node: &Node<'a>, place: usize) -> Result<(), Fault> {
        let at = || Placed { node: place, node_from_part: DMat4::IDENTITY, shape: None, skin: None };
        if let Some(light) = node.light() {
            self.contents.lights.push((source_light(node, &light)?, at()));
        }
        if let Some(camera) = node.camera() {
            self.contents.cameras.push((source_camera(node, &camera)?, at()));
        }
        let Some(mesh) = node.mesh() else { return Ok(()) };
        self.nodes.set_weights(place, node.weights().or(mesh.weights()));
        let name = node.name().or(mesh.name()).unwrap_or_default();
        let places = instances(self.document, node, &mut self.primitives.accessors, name)?;
        for primitive in mesh.primitives() {
            let shape = self.primitives.shape(mesh.index(), &primitive)?;
            for node_from_part in &places {
                if self.contents.parts.len() + self.contents.lines.len() == MOST_PARTS {
                    let found = format!("more than {MOST_PARTS} primitives shown");
                    let element = format!("nodes[{}]", node.index());
                    return Err(Fault::element(element, found, "fewer are"));
                }
                let placed = Placed { node_from_part: *node_from_part, ..at() };
                let (name, material) = (name.to_owned(), primitive.material().index());
                match &shape {
                    PrimitiveShape::Mesh(mesh, shape) => {
                        let placed = self.dressed(node, placed, shape.as_ref())?;
                        let part = Part { name, mesh: mesh.clone(), material, world_from_part: Mat4::IDENTITY };
                        self.contents.parts.push((part, placed));
                    }
                    PrimitiveShape::Lines(lines) => {
                        let lines = LinePart { name, lines: lines.clone(), material, world_from_part: Mat4::IDENTITY };
                        self.contents.lines.push((lines, placed));
                    }
                    PrimitiveShape::Nothing => {}
                }
            }
        }
        Ok(())
    }

    /// The place of a mesh with what moves its vertices.
    fn dressed(&mut self, node: &Node<'a>, placed: Placed, shape: Option<&Arc<Shape>>) -> Result<Placed, Fault> {
        let Some(skin) = node.skin() else { return Ok(Placed { shape: shape.cloned(), ..placed }) };
        let Some(influences) = shape.and_then(|shape| shape.influences.as_ref()) else {
            self.contents.without_joints += 1;
            return Ok(Placed { shape: shape.cloned(), ..placed });
        };
        let skin_of_file = skin.index();
        let skin = self.skins.skin(&skin, self.nodes, &mut self.primitives.accessors)?;
        let (greatest, joints) = (usize::from(influences.greatest_joint()), skin.joints.len());
        if greatest >= joints {
            let element = format!("nodes[{}].mesh", node.index());
            let expected = format!("one of the {joints} joints of skins[{skin_of_file}], from 0, is");
            return Err(Fault::element(element, format!("joint {greatest}"), expected));
        }
        Ok(Placed { shape: shape.cloned(), skin: Some(skin), ..placed })
    }
}

fn source_light(node: &Node, light: &Light) -> Result<SourceLight, Fault> {
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
        world_from_light: Mat4::IDENTITY,
    })
}

fn source_camera(node: &Node, camera: &Camera) -> Result<SourceCamera, Fault> {
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
    Ok(SourceCamera { name, projection, world_from_camera: Mat4::IDENTITY })
}

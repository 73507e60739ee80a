//! Where things stand: moved by skins and morph targets, and counted from an origin near them.

use std::collections::HashMap;

use glam::{DMat4, DVec3, Mat4, Vec3};

use super::fault::Fault;
use super::nodes::Nodes;
use super::primitive::Primitives;
use super::scene::Contents;
use crate::animation::{Animations, Moved, Placed, corners, less};
use crate::{Lines, Mesh, Model, origin_of_box};

/// The model of these contents: its vertices moved by skins and morph targets, and all places counted from an origin that
/// suits them. Gives also what its animations need.
pub(super) fn model(
    mut contents: Contents,
    nodes: Nodes,
    primitives: &mut Primitives,
) -> Result<(Model, Animations), Fault> {
    let world = |placed: &Placed| nodes.world(placed.node) * placed.node_from_part;
    let joints = |placed: &Placed, origin: DVec3| {
        placed.skin.as_ref().map(|skin| skin.matrices(|node| nodes.world(node), origin))
    };
    let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let mut include = |points: &[DVec3]| {
        bounds = points.iter().fold(bounds, |[min, max], p| [min.min(*p), max.max(*p)]);
    };
    let mut moved: Vec<Option<Moved>> = Vec::with_capacity(contents.parts.len());
    for (part, placed) in &contents.parts {
        let weights = &nodes.entered[placed.node].weights;
        let is_still = placed.skin.is_none() && weights.iter().all(|weight| *weight == 0.0);
        let Some(shape) = placed.shape.as_ref().filter(|_| !is_still) else {
            include(&corners(&part.mesh.bounds(), &world(placed)));
            moved.push(None);
            continue;
        };
        let joints = joints(placed, DVec3::ZERO);
        let vertices = primitives.moved(&part.name, shape, (weights, joints.as_deref()))?;
        let [min, max] = vertices.bounds(shape);
        if placed.skin.is_some() {
            include(&[min, max]);
        } else {
            let bounds = crate::Bounds { min: min.as_vec3(), max: max.as_vec3() };
            include(&corners(&bounds, &world(placed)));
        }
        moved.push(Some(vertices));
    }
    for (lines, placed) in &contents.lines {
        include(&corners(&lines.lines.bounds(), &world(placed)));
    }
    let origin = if bounds[0].x <= bounds[1].x { origin_of_box(bounds[0], bounds[1]) } else { DVec3::ZERO };

    let mut near = Near { is_far: origin != DVec3::ZERO, meshes: HashMap::new(), lines: HashMap::new() };
    for ((part, placed), vertices) in contents.parts.iter_mut().zip(moved) {
        match (&placed.shape, vertices) {
            (Some(shape), Some(mut vertices)) => {
                if placed.skin.is_some() {
                    vertices.shift(origin);
                }
                part.mesh = vertices.mesh(shape).ok_or_else(|| {
                    let found = "vertices that its skin or morph targets move out of the range of f32";
                    Fault::element(format!("the mesh of {:?}", part.name), found, "nearer ones are")
                })?;
            }
            (Some(_), None) => {}
            (None, _) => near.mesh(&mut part.mesh, &mut placed.node_from_part),
        }
        let is_skinned = placed.skin.is_some();
        part.world_from_part =
            if is_skinned { Mat4::IDENTITY } else { finite(less(world(placed), origin), &part.name)? };
    }
    for (lines, placed) in &mut contents.lines {
        near.lines(&mut lines.lines, &mut placed.node_from_part);
        lines.world_from_part = finite(less(world(placed), origin), &lines.name)?;
    }
    for (light, placed) in &mut contents.lights {
        light.world_from_light = finite(less(world(placed), origin), &light.name)?;
    }
    for (camera, placed) in &mut contents.cameras {
        camera.world_from_camera = finite(less(world(placed), origin), &camera.name)?;
    }
    let (parts, placed_parts) = contents.parts.into_iter().unzip();
    let (lines, placed_lines) = contents.lines.into_iter().unzip();
    let (lights, placed_lights) = contents.lights.into_iter().unzip();
    let (cameras, placed_cameras) = contents.cameras.into_iter().unzip();
    let animations = Animations {
        clips: Vec::new(),
        nodes: nodes.entered,
        parts: placed_parts,
        lines: placed_lines,
        lights: placed_lights,
        cameras: placed_cameras,
        origin,
    };
    Ok((Model { origin, parts, lines, lights, cameras, ..Model::default() }, animations))
}

fn finite(world: DMat4, name: &str) -> Result<Mat4, Fault> {
    let world = world.as_mat4();
    if world.is_finite() {
        return Ok(world);
    }
    Err(Fault::element(
        format!("the place of {name:?}"),
        "a transform that leaves the range of f32",
        "a smaller one is",
    ))
}

/// Meshes and lines counted from a point near them, where the model has an origin: their transforms are rounded to f32,
/// and would not take far positions back exactly.
struct Near {
    is_far: bool,
    /// By where the positions of the file are.
    meshes: HashMap<*const Vec3, (Mesh, DVec3)>,
    lines: HashMap<*const Vec3, (Lines, DVec3)>,
}

impl Near {
    fn mesh(&mut self, mesh: &mut Mesh, node_from_part: &mut DMat4) {
        if !self.is_far {
            return;
        }
        let (near, middle) = self.meshes.entry(mesh.positions().as_ptr()).or_insert_with(|| {
            let bounds = mesh.bounds();
            let middle = origin_of_box(bounds.min.as_dvec3(), bounds.max.as_dvec3());
            let mut near = mesh.clone();
            let moved = near.set_positions(shifted(mesh.positions(), middle));
            if moved.is_ok() { (near, middle) } else { (mesh.clone(), DVec3::ZERO) }
        });
        if *middle != DVec3::ZERO {
            *mesh = near.clone();
            *node_from_part *= DMat4::from_translation(*middle);
        }
    }

    fn lines(&mut self, lines: &mut Lines, node_from_part: &mut DMat4) {
        if !self.is_far {
            return;
        }
        let (near, middle) = self.lines.entry(lines.positions().as_ptr()).or_insert_with(|| {
            let bounds = lines.bounds();
            let middle = origin_of_box(bounds.min.as_dvec3(), bounds.max.as_dvec3());
            let moved =
                Lines::new(shifted(lines.positions(), middle), lines.segments().to_vec(), lines.points().to_vec());
            let with_normals = |moved: Lines| match lines.normals() {
                Some(normals) => moved.with_normals(normals.to_vec()),
                None => Ok(moved),
            };
            let with_colors = |moved: Lines| match lines.colors() {
                Some(colors) => moved.with_colors(colors.to_vec()),
                None => Ok(moved),
            };
            match moved.and_then(with_normals).and_then(with_colors) {
                Ok(near) => (near, middle),
                Err(_) => (lines.clone(), DVec3::ZERO),
            }
        });
        if *middle != DVec3::ZERO {
            *lines = near.clone();
            *node_from_part *= DMat4::from_translation(*middle);
        }
    }
}

fn shifted(positions: &[Vec3], middle: DVec3) -> Vec<Vec3> {
    positions.iter().map(|p| (p.as_dvec3() - middle).as_vec3()).collect()
}

//! Lines that explain a scene: axes, normals, lights and the ground.

use crate::lines::drawing::Drawing;
use crate::lines::marks::{Hidden, Mark};
use crate::quantities::no_camera;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemState;
use bevy_math::{DAffine3, DVec3, Vec3};
use bevy_transform::components::GlobalTransform;
use halfway_asset::Assets;
use halfway_frame::error::{RenderError, label};
use halfway_frame::view::matrices::normal_matrix;
use halfway_lighting::equations::Transcendental as _;
use halfway_lighting::lights::LightQueries;
use halfway_lighting::{
    LightComponent, LinearRgba, Show, Shown, Upright, current_camera, light_direction, light_position, light_up,
};
use halfway_mesh::{Lines, Lines3d, Mesh, Mesh3d, face_normal};
use std::f64::consts::TAU;

/// The marks of [`Show`], in the order in which they are laid over the picture.
#[derive(Default)]
pub(super) struct Explained {
    /// Below other lines that are equally near.
    pub(super) on_ground: Vec<Mark>,
    pub(super) among: Vec<Mark>,
    /// Over everything.
    pub(super) over: Vec<Mark>,
}

/// In pixels.
const AXIS: f64 = 2.0;
const LIGHT: f64 = 2.0;
const NORMAL: f64 = 1.0;
const GRID: f64 = 1.0;

const GROUND: Vec3 = Vec3::splat(0.25);
const NORMALS: Vec3 = Vec3::new(0.1, 0.55, 1.0);
const FACE_NORMALS: Vec3 = Vec3::new(1.0, 0.35, 0.02);

type Data<'w, 's> = (
    Query<'w, 's, (Entity, &'static Mesh3d, &'static GlobalTransform)>,
    Query<'w, 's, (Entity, &'static Lines3d, &'static GlobalTransform)>,
    LightQueries<'w, 's>,
    Shown<'w, 's>,
    Option<Res<'w, Assets<Mesh>>>,
    Option<Res<'w, Assets<Lines>>>,
);

/// The marks of all that is shown.
///
/// # Errors
/// [`RenderError::Invalid`] for an invalid [`Upright`] or light; [`RenderError::NoCamera`].
pub(super) fn marks(world: &mut World, drawing: &Drawing, show: Show) -> Result<Explained, RenderError> {
    let mut explained = Explained::default();
    if !show.any() {
        return Ok(explained);
    }
    let camera = current_camera(world).map_err(no_camera)?;
    let upright = world.get::<Upright>(camera).copied().unwrap_or_default();
    upright.validate().map_err(|source| {
        let entity = label(camera, world.get::<Name>(camera));
        RenderError::Invalid { entity, source }
    })?;
    let mut state = SystemState::<Data>::new(world);
    let (objects, strokes, lights, shown, meshes, lines) = state.get(world).map_err(|_| RenderError::NoPicture)?;
    let is_shown = shown.by_entity();
    let shown_meshes: Vec<(&Mesh, DAffine3)> = objects
        .iter()
        .filter(|(entity, _, transform)| is_shown(*entity) && transform.affine().is_finite())
        .filter_map(|(_, mesh, at)| Some((meshes.as_ref()?.get(&mesh.0)?, crate::quantities::world_from_model(at))))
        .collect();
    let mut extent = Extent::EMPTY;
    for (mesh, world_from_mesh) in &shown_meshes {
        extent.add(mesh.bounds().min, mesh.bounds().max, world_from_mesh);
    }
    for (_, lines3d, at) in strokes.iter().filter(|(entity, _, at)| is_shown(*entity) && at.affine().is_finite()) {
        if let Some(lines) = lines.as_ref().and_then(|lines| lines.get(&lines3d.0)) {
            extent.add(lines.bounds().min, lines.bounds().max, &crate::quantities::world_from_model(at));
        }
    }
    let scene = extent.or_unit();
    if show.grid {
        grid(&scene, upright.0, &mut Sketch::new(drawing, &mut explained.on_ground, GRID, Hidden::Omit));
    }
    if show.axes {
        axes(&scene, &mut Sketch::new(drawing, &mut explained.among, AXIS, Hidden::Dash));
    }
    let mut normals = Sketch::new(drawing, &mut explained.among, NORMAL, Hidden::Omit);
    for (mesh, world_from_mesh) in &shown_meshes {
        if show.normals || show.face_normals {
            add_normals(mesh, world_from_mesh, show, scene.diagonal(), &mut normals);
        }
    }
    if show.lights {
        let mut sketch = Sketch::new(drawing, &mut explained.over, LIGHT, Hidden::Show);
        let mut refused = None;
        lights.visit(|entity, name, light, at| {
            if let Err(source) = add_light(&light, at, &scene, &mut sketch) {
                refused.get_or_insert_with(|| RenderError::Invalid { entity: label(entity, name), source });
            }
        });
        if let Some(error) = refused {
            return Err(error);
        }
    }
    Ok(explained)
}

/// The box around all that is shown, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Extent {
    min: DVec3,
    max: DVec3,
}

impl Extent {
    const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    fn add(&mut self, min: Vec3, max: Vec3, world_from_box: &DAffine3) {
        for corner in 0..8 {
            let pick = |axis: usize| f64::from(if corner & (1 << axis) == 0 { min[axis] } else { max[axis] });
            let corner = world_from_box.transform_point3(DVec3::new(pick(0), pick(1), pick(2)));
            (self.min, self.max) = (self.min.min(corner), self.max.max(corner));
        }
    }

    /// A box of 2 × 2 × 2 about the origin in the place of nothing, and of a point.
    fn or_unit(self) -> Self {
        let middle = if self.min.is_finite() && self.max.is_finite() { self.middle() } else { DVec3::ZERO };
        if self.diagonal() > 0.0 && self.diagonal().is_finite() {
            self
        } else {
            Self { min: middle - 1.0, max: middle + 1.0 }
        }
    }

    fn middle(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    fn diagonal(&self) -> f64 {
        (self.max - self.min).length()
    }
}

/// Draws lines of one width.
struct Sketch<'a, 'd> {
    drawing: &'a Drawing<'d>,
    marks: &'a mut Vec<Mark>,
    width: f64,
    hidden: Hidden,
}

impl<'a, 'd> Sketch<'a, 'd> {
    fn new(drawing: &'a Drawing<'d>, marks: &'a mut Vec<Mark>, width: f64, hidden: Hidden) -> Self {
        Self { drawing, marks, width, hidden }
    }

    /// A line from one point of the world to another.
    fn line(&mut self, from: DVec3, to: DVec3, color: Vec3) {
        let eye = [from, to].map(|end| self.drawing.eye_from_world().transform_point3(end));
        if let Some(placed) = self.drawing.placed(eye) {
            self.marks.push(Mark::line(&placed, [self.width; 2], [color.extend(1.0); 2], self.hidden));
        }
    }

    /// A line with a head of four barbs at its end, each a share `head` of its length.
    fn arrow(&mut self, from: DVec3, to: DVec3, head: f64, color: Vec3) {
        self.line(from, to, color);
        let length = (to - from).length();
        let (u, v) = (to - from).normalize_or(DVec3::Y).any_orthonormal_pair();
        for side in [u, -u, v, -v] {
            self.line(to, to + head * ((from - to) + 0.4 * length * side), color);
        }
    }

    /// Three lines that cross.
    fn star(&mut self, middle: DVec3, size: f64, color: Vec3) {
        for axis in DVec3::AXES {
            self.line(middle - 0.5 * size * axis, middle + 0.5 * size * axis, color);
        }
    }
}

fn axes(scene: &Extent, sketch: &mut Sketch) {
    let diagonal = scene.diagonal();
    let away = (scene.min.max(DVec3::ZERO) + scene.max.min(DVec3::ZERO)).length();
    let origin = if away > diagonal { scene.min } else { DVec3::ZERO };
    let length = (scene.max - origin).max_element().max(0.15 * diagonal) + 0.1 * diagonal;
    let colors = [Vec3::new(0.9, 0.03, 0.02), Vec3::new(0.05, 0.6, 0.05), Vec3::new(0.05, 0.15, 1.0)];
    for (axis, color) in DVec3::AXES.into_iter().zip(colors) {
        sketch.arrow(origin, origin + length * axis, 0.06, color);
    }
}

/// 1, 2 or 5 times a power of ten: the least that makes `most` steps or fewer of a length.
fn spacing(length: f64, most: f64) -> f64 {
    let least = length / most;
    let power = 10_f64.powi(least.log10().floor() as i32);
    let steps = [1.0, 2.0, 5.0, 10.0];
    // A rounding below 1 is 1.
    power * steps.into_iter().find(|step| step * power >= least * (1.0 - 1e-9)).unwrap_or(10.0)
}

fn grid(scene: &Extent, up: Vec3, sketch: &mut Sketch) {
    let up = up.as_dvec3();
    let vertical = (0..3).max_by(|a, b| up[*a].abs().total_cmp(&up[*b].abs())).unwrap_or(1);
    let ground = if up[vertical] < 0.0 { scene.max[vertical] } else { scene.min[vertical] };
    let sides = [(vertical + 1) % 3, (vertical + 2) % 3];
    let longest = sides.into_iter().map(|side| scene.max[side] - scene.min[side]).fold(0.0, f64::max);
    let step = spacing(if longest > 0.0 { longest } else { scene.diagonal() }, 20.0);
    // A square more on each side, on multiples of the spacing.
    let span = sides.map(|side| [(scene.min[side] / step).floor() - 1.0, (scene.max[side] / step).ceil() + 1.0]);
    for (along, across) in [(0, 1), (1, 0)] {
        let mut number = span[along][0];
        while number <= span[along][1] {
            let ends = span[across].map(|end| {
                let mut point = DVec3::splat(ground);
                point[sides[along]] = number * step;
                point[sides[across]] = end * step;
                point
            });
            sketch.line(ends[0], ends[1], GROUND);
            number += 1.0;
        }
    }
}

fn add_normals(mesh: &Mesh, world_from_mesh: &DAffine3, show: Show, diagonal: f64, sketch: &mut Sketch) {
    let positions: Vec<DVec3> =
        mesh.positions().iter().map(|p| world_from_mesh.transform_point3(p.as_dvec3())).collect();
    let corners = |triangle: [u32; 3]| triangle.map(|vertex| positions[vertex as usize]);
    let around = |[a, b, c]: [DVec3; 3]| a.distance(b) + b.distance(c) + c.distance(a);
    let edges: f64 = mesh.triangles().map(|triangle| around(corners(triangle))).sum();
    let mean = edges / (3 * mesh.triangle_count()) as f64;
    let length = mean.clamp(diagonal / 200.0, diagonal / 20.0);
    let turn = normal_matrix(&world_from_mesh.matrix3).as_dmat3();
    if show.normals {
        for (p, n) in positions.iter().zip(mesh.normals()) {
            sketch.line(*p, *p + length * (turn * n.as_dvec3()).normalize_or_zero(), NORMALS);
        }
    }
    if show.face_normals {
        for triangle in mesh.triangles() {
            let [a, b, c] = triangle.map(|vertex| mesh.positions()[vertex as usize]);
            let Some(n) = face_normal(a, b, c) else { continue };
            let middle = corners(triangle).into_iter().sum::<DVec3>() / 3.0;
            sketch.line(middle, middle + length * (turn * n.as_dvec3()).normalize_or_zero(), FACE_NORMALS);
        }
    }
}

/// A light's colour, as bright as can be; grey for one without.
fn bright(color: LinearRgba) -> Vec3 {
    let color = Vec3::new(color.red, color.green, color.blue);
    let most = color.max_element();
    if most > 0.0 && most.is_finite() { color / most } else { Vec3::splat(0.3) }
}

fn add_light(
    light: &LightComponent,
    at: &GlobalTransform,
    scene: &Extent,
    sketch: &mut Sketch,
) -> Result<(), halfway_lighting::InvalidValue> {
    let (middle, diagonal) = (scene.middle(), scene.diagonal());
    match light {
        LightComponent::Point(light) => {
            sketch.star(light_position(at)?.as_dvec3(), diagonal / 25.0, bright(light.diffuse));
        }
        LightComponent::Spot(spot) => {
            let color = bright(spot.light.diffuse);
            let (position, direction) = (light_position(at)?.as_dvec3(), light_direction(at)?.as_dvec3());
            sketch.star(position, diagonal / 25.0, color);
            sketch.arrow(position, position + 0.25 * diagonal * direction, 0.1, color);
            let cutoff = f64::from(spot.cone.cutoff);
            if cutoff < std::f64::consts::FRAC_PI_2 {
                cone(position, direction, cutoff, 0.25 * diagonal, color, sketch);
            }
        }
        LightComponent::Directional(light) => {
            let direction = light_direction(at)?.as_dvec3();
            let [from, to] = [0.5, 0.25].map(|away| middle - away * diagonal * direction);
            sketch.arrow(from, to, 0.15, bright(light.diffuse));
        }
        LightComponent::Hemisphere(light) => {
            let up = light_up(at)?.as_dvec3();
            for (side, color) in [(1.0, light.sky), (-1.0, light.ground)] {
                let [from, to] = [0.5, 0.4].map(|away| middle + side * away * diagonal * up);
                sketch.arrow(from, to, 0.3, bright(color));
            }
        }
    }
    Ok(())
}

/// The rim of a cone and four lines along it, as long as its axis.
fn cone(tip: DVec3, direction: DVec3, cutoff: f64, length: f64, color: Vec3, sketch: &mut Sketch) {
    const SIDES: u32 = 48;
    let (u, v) = direction.any_orthonormal_pair();
    let rim = |side: u32| {
        let angle = TAU * f64::from(side) / f64::from(SIDES);
        let across = u * angle.cosine() + v * angle.sine();
        tip + length * (direction * cutoff.cosine() + across * cutoff.sine())
    };
    for side in 0..SIDES {
        sketch.line(rim(side), rim(side + 1), color);
        if side.is_multiple_of(SIDES / 4) {
            sketch.line(tip, rim(side), color);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spacings_are_round() {
        for (length, expected) in
            [(1.0, 0.05), (20.0, 1.0), (21.0, 2.0), (40.1, 5.0), (100.0, 5.0), (101.0, 10.0), (3e-7, 2e-8), (7e5, 5e4)]
        {
            let found = spacing(length, 20.0);
            assert!((found / expected - 1.0).abs() < 1e-9, "{length}: {found}");
        }
    }
}

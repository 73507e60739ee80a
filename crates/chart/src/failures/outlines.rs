//! Interpolated normals that face away from the viewer.

use halfway::prelude::*;
use halfway::reference::{Image, Mode};

use super::plots::{figure, log, names, panel, series, shown};
use super::stage::{drawn, show, sun};
use super::{FailurePage, only};
use crate::measure::{MeasureError, SHADINGS};

/// Bands of the spheres.
const LEVELS: [u32; 4] = [4, 8, 16, 32];
/// Where the viewer is: far away, and against the meridians, so that along the outline cells lie in every way.
const DISTANCE: f32 = 5000.0;

fn toward() -> Vec3 {
    (Quat::from_rotation_y(0.37) * Quat::from_rotation_x(-0.61)) * Vec3::Z
}

/// A sphere with its light exactly behind it: no point that is seen is lit.
fn picture(level: u32, shading: Shading, mode: Mode) -> Result<Image, MeasureError> {
    drawn(mode, |world| {
        let camera = Camera { fov_y: 2.0 * (1.08_f32 / DISTANCE).atan(), ..Camera::default() };
        world.spawn((camera, Transform::from_translation(DISTANCE * toward()).looking_at(Vec3::ZERO, Vec3::Y)));
        sun(world, -toward());
        show(world, UvSphere::new(1.0, 2 * level, level), Material::matte(LinearRgba::WHITE), shading);
    })
}

/// What is seen of a light behind a sphere of `level` bands and twice as many meridians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BackLight {
    /// The brightest pixel, linear; full light on the surface is 1.
    pub brightest: f64,
    /// The share of the sphere's pixels that are lit.
    pub lit: f64,
}

/// Measures it on the mesh; without a shading, on the true sphere.
///
/// # Errors
/// What the oracle cannot draw.
pub fn back_light(level: u32, shading: Option<Shading>) -> Result<BackLight, MeasureError> {
    let mode = if shading.is_some() { Mode::Mesh } else { Mode::Surface };
    let picture = picture(level, shading.unwrap_or(Shading::Phong), mode)?;
    let covered = picture.covered().map_or(0, |covered| covered.iter().filter(|here| **here).count());
    let lit = picture.pixels().iter().filter(|pixel| pixel[0] > 0.0).count();
    Ok(BackLight { brightest: picture.largest(), lit: lit as f64 / covered.max(1) as f64 })
}

/// The brightest corner of all triangles that face the viewer: what pixels near it approach under interpolated normals.
pub fn brightest_corner(level: u32) -> f64 {
    let mesh = Mesh::from(UvSphere::new(1.0, 2 * level, level));
    let (toward, eye) = (toward().as_dvec3(), (DISTANCE * toward()).as_dvec3());
    let corners = mesh.triangles().filter_map(|triangle| {
        let [a, b, c] = triangle.map(|vertex| mesh.positions()[vertex as usize].as_dvec3());
        let faces = (b - a).cross(c - a).dot(eye - a) > 0.0;
        faces.then(|| triangle.map(|vertex| -mesh.normals()[vertex as usize].as_dvec3().dot(toward)))
    });
    corners.flatten().fold(0.0, f64::max)
}

/// The most that can be seen of it: the sine of how far a corner's normal may be turned from that of a triangle, the
/// circumradius of a cell on the equator.
pub fn most(level: u32) -> f64 {
    let half_cell = 0.5 * std::f64::consts::PI / f64::from(level);
    // Of a square on a sphere with sides of two half cells the corners are that far from the middle.
    (half_cell.cos() * half_cell.cos()).acos().sin()
}

pub(super) fn page() -> Result<FailurePage, MeasureError> {
    let mut lines = Vec::new();
    for (kind, shading) in SHADINGS.into_iter().enumerate() {
        let points = LEVELS
            .into_iter()
            .map(|level| Ok((f64::from(2 * level), back_light(level, Some(shading))?.brightest)))
            .collect::<Result<Vec<_>, MeasureError>>()?;
        lines.push(series(names()[kind], kind, &points, true));
    }
    let corners = LEVELS.map(|level| (f64::from(2 * level), brightest_corner(level)));
    lines.push(series("brightest corner", 3, &corners, true));
    let bound = LEVELS.map(|level| (f64::from(2 * level), most(level)));
    lines.push(series("sine of half a cell’s diagonal", 4, &bound, false));
    let [flat, gouraud, phong] = SHADINGS.map(|shading| picture(8, shading, Mode::Mesh));
    Ok(FailurePage {
        id: "outlines",
        title: "Light from behind shines round outlines",
        cause: "A triangle at the outline still faces the viewer while normals at its corners already face away. The side \
                is that of the triangle, and n·l asks for no viewer: interpolated normals catch light from behind that no \
                point that is seen of the true surface can catch.",
        remedy: "More triangles: the rim darkens as the cells shrink, and narrows by the square. Flat shading has none.",
        test: "light_from_behind_shrinks_with_the_cells",
        figures: only(figure(
            "outlines",
            "The brightest pixel of a sphere that is lit from behind (true: 0)",
            [log("meridians"), log("brightest pixel (linear)")],
            panel("256 × 256 pixels; flat shading shows none, and 0 has no place on this axis", lines),
        )),
        pictures: shown([("flat, lit from behind", &flat?), ("Gouraud", &gouraud?), ("Phong", &phong?)]),
    })
}

//! Which normal shades a triangle under flat shading.

use halfway::prelude::*;
use halfway::reference::{Image, Mode};

use super::plots::{figure, log, panel, series, shown};
use super::stage::{camera, drawn, made, rms, show, sun};
use super::{FailurePage, only};
use crate::measure::MeasureError;

/// Whose normal shades a triangle that has one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlatNormal {
    /// That of the plane through its corners, as this project shades it.
    Face,
    /// The mean of its corners' normals: about the surface's at the centroid.
    Centroid,
    /// That of one corner, from 0, as where the provoking vertex gives the colour (OpenGL 2.1 §2.14.7).
    Corner(usize),
}

/// Bands of the spheres.
const LEVELS: [u32; 4] = [4, 8, 16, 32];

/// The normals that are compared, by their names.
const NORMALS: [(&str, FlatNormal); 4] = [
    ("of the face", FlatNormal::Face),
    ("mean of the corners", FlatNormal::Centroid),
    ("of the first corner", FlatNormal::Corner(0)),
    ("of the second corner", FlatNormal::Corner(1)),
];

/// A unit sphere in triangles with vertices of their own, which all have the one normal.
fn sphere(level: u32, normal: FlatNormal) -> (Mesh, Shading) {
    let sphere = Mesh::from(UvSphere::new(1.0, 2 * level, level));
    let pick = |triangle: [u32; 3]| {
        let of = triangle.map(|vertex| sphere.normals()[vertex as usize]);
        match normal {
            FlatNormal::Corner(corner) => of[corner % 3],
            FlatNormal::Face | FlatNormal::Centroid => of[0] + of[1] + of[2],
        }
    };
    if normal == FlatNormal::Face {
        return (sphere, Shading::Flat);
    }
    let positions = sphere.triangles().flatten().map(|vertex| sphere.positions()[vertex as usize]).collect();
    let normals = sphere.triangles().flat_map(|triangle| [pick(triangle); 3]).collect();
    let indices = (0..3 * sphere.triangle_count() as u32).collect();
    // With one normal a triangle, shading at pixels is flat under a light from afar.
    (made(positions, Some(normals), indices), Shading::Phong)
}

fn scene(world: &mut World, (mesh, shading): (Mesh, Shading), from: Vec3) {
    camera(world, Vec3::new(0.0, 0.0, 2.9), Vec3::Y);
    sun(world, from);
    show(world, mesh, Material::matte(LinearRgba::gray(0.9)), shading);
}

fn picture(level: u32, normal: FlatNormal, from: Vec3) -> Result<Image, MeasureError> {
    drawn(Mode::Mesh, |world| scene(world, sphere(level, normal), from))
}

fn truth(from: Vec3) -> Result<Image, MeasureError> {
    let finest = Mesh::from(UvSphere::new(1.0, 64, 32));
    drawn(Mode::Surface, |world| scene(world, (finest, Shading::Phong), from))
}

/// The RMS error, in linear intensity, of a diffuse sphere of `level` bands and twice as many meridians, lit from the
/// viewer's side, with each of these normals.
///
/// # Errors
/// What the oracle cannot draw.
pub fn errors<const N: usize>(level: u32, normals: [FlatNormal; N]) -> Result<[f64; N], MeasureError> {
    let truth = truth(Vec3::Z)?;
    let mut errors = [0.0; N];
    for (error, normal) in errors.iter_mut().zip(normals) {
        *error = rms(&picture(level, normal, Vec3::Z)?, &truth)?;
    }
    Ok(errors)
}

pub(super) fn page() -> Result<FailurePage, MeasureError> {
    let mut found = Vec::new();
    for level in LEVELS {
        found.push((f64::from(2 * level), errors(level, NORMALS.map(|(_, normal)| normal))?));
    }
    let lines = NORMALS.iter().enumerate().map(|(kind, (name, _))| {
        let points: Vec<_> = found.iter().map(|(meridians, errors)| (*meridians, errors[kind])).collect();
        series(name, kind, &points, true)
    });
    let aslant = Vec3::new(0.5, 0.5, 1.0);
    let [face, first, second] =
        [FlatNormal::Face, FlatNormal::Corner(0), FlatNormal::Corner(1)].map(|normal| picture(8, normal, aslant));
    Ok(FailurePage {
        id: "provoking-vertex",
        title: "Flat shading by one corner leans to one side",
        cause: "A triangle that takes the colour of its first corner is right there and wrong everywhere else: the picture \
                leans toward the first corners, and changes when the same triangles are listed from another. In the mean over \
                the corners its error is √(10/3) times that by faces.",
        remedy: "Shade each triangle by its own normal at its centroid, as this project does.",
        test: "one_corner_is_worse_than_the_face_by_what_triangles_say",
        figures: only(figure(
            "provoking-vertex",
            "RMS error of a diffuse sphere under flat shading",
            [log("meridians"), log("RMS error (linear)")],
            panel("normal", lines.collect()),
        )),
        pictures: shown([
            ("by the face", &face?),
            ("by the first corner", &first?),
            ("by the second corner", &second?),
            ("true surface", &truth(aslant)?),
        ]),
    })
}

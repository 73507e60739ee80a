//! Normals under transforms that stretch, mirror and flatten.

use halfway::lighting::equations::vector::{cross, dot, length};
use halfway::lighting::equations::{normal_matrix, transform_normal};
use halfway::prelude::*;
use halfway::reference::{Image, Mode};

use super::FailurePage;
use super::plots::{figure, linear, log, panel, series, shown};
use super::stage::{camera, drawn, made, show, sun};
use crate::measure::MeasureError;

/// The stretch of the pictures.
const STRETCH: f32 = 2.5;

/// Between two directions of any length, in degrees.
fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    length(cross(a, b)).atan2(dot(a, b)).to_degrees()
}

/// By how many degrees a normal that goes through the matrix of the points is wrong at most, where the y axis is
/// stretched by this factor, above 0.
pub fn by_the_points(stretch: f64) -> f64 {
    let matrix = normal_matrix([[1.0, 0.0, 0.0], [0.0, stretch, 0.0], [0.0, 0.0, 1.0]]);
    let error = |i: u32| {
        let (y, x) = (f64::from(i) / 3600.0 * std::f64::consts::FRAC_PI_2).sin_cos();
        let right = transform_normal(matrix, [x, y, 0.0]);
        right.map_or(0.0, |right| angle(right, [x, stretch * y, 0.0]))
    };
    (1..3600).map(error).fold(0.0, f64::max)
}

/// The same by formula: tan t becomes s·tan t instead of tan t/s, which is worst at t = 45°: 2·atan s − 90°.
pub fn by_the_points_formula(stretch: f64) -> f64 {
    2.0 * stretch.max(stretch.recip()).atan().to_degrees() - 90.0
}

/// How a normal matrix is computed in f32.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NormalBy {
    /// As the inverse, transposed.
    Inverse,
    /// From cofactors of unit columns, with the sign of the determinant, as this project does.
    Cofactors,
}

/// By how many degrees the normal of a turned object that is scaled alike in all directions is wrong in f32; 90 where
/// there is none.
pub fn when_scaled(scale: f32, by: NormalBy) -> f64 {
    let turn = Quat::from_euler(EulerRot::XYZ, 0.5, 0.6, 0.7);
    let n = Vec3::new(0.36, 0.48, 0.8);
    let right = turn * n;
    let matrix = Mat3::from_quat(turn) * Mat3::from_diagonal(Vec3::splat(scale));
    let found = match by {
        NormalBy::Inverse => {
            let inverse = matrix.inverse();
            (inverse.transpose() * n).try_normalize().filter(|n| n.is_finite()).map(|n| n.to_array())
        }
        NormalBy::Cofactors => transform_normal(normal_matrix(matrix.to_cols_array_2d()), n.to_array()),
    };
    let error = found.map(|found| angle(found.map(f64::from), right.to_array().map(f64::from)));
    error.filter(|error| error.is_finite()).unwrap_or(90.0)
}

fn scene(world: &mut World) {
    camera(world, Vec3::new(0.0, 0.0, 4.0), Vec3::Y);
    sun(world, Vec3::new(1.0, 0.8, 0.7));
}

fn material() -> Material {
    Material::matte(LinearRgba::gray(0.9))
}

/// A unit sphere scaled so, drawn from its own mesh.
fn scaled(scale: Vec3) -> Result<Image, MeasureError> {
    drawn(Mode::Mesh, |world| {
        scene(world);
        let object = show(world, UvSphere::new(1.0, 64, 32), material(), Shading::Phong);
        world.entity_mut(object).insert(Transform::from_scale(scale));
    })
}

/// The same with its points scaled beforehand and normals as they come out of `normal`.
fn with_normals(scale: Vec3, normal: impl Fn(Vec3) -> Vec3) -> Result<Image, MeasureError> {
    let sphere = Mesh::from(UvSphere::new(1.0, 64, 32));
    let positions = sphere.positions().iter().map(|p| *p * scale).collect();
    let normals = sphere.normals().iter().map(|n| normal(*n)).collect();
    let mirrors = scale.x * scale.y * scale.z < 0.0;
    let turned = |[a, b, c]: [u32; 3]| if mirrors { [a, c, b] } else { [a, b, c] };
    let mesh = made(positions, Some(normals), sphere.triangles().flat_map(turned).collect());
    drawn(Mode::Mesh, |world| {
        scene(world);
        show(world, mesh, material(), Shading::Phong);
    })
}

const STRETCHED: Vec3 = Vec3::new(1.0, 1.0 / STRETCH, 1.0);
const MIRRORED: Vec3 = Vec3::new(-1.0, 1.0, 1.0);

/// A mirrored sphere with the normals of this project, and with those of the cofactors alone, which leave out the sign
/// of the determinant.
///
/// # Errors
/// What the oracle cannot draw.
pub fn mirrored() -> Result<[Image; 2], MeasureError> {
    // The cofactors of diag(−1, 1, 1) are those of diag(1, −1, −1).
    Ok([scaled(MIRRORED)?, with_normals(MIRRORED, |n| n * Vec3::new(1.0, -1.0, -1.0))?])
}

pub(super) fn page() -> Result<FailurePage, MeasureError> {
    let stretches: Vec<f64> = (0..=24).map(|i| 10f64.powf(f64::from(i) / 12.0)).collect();
    let turned: Vec<_> = stretches.iter().map(|stretch| (*stretch, by_the_points(*stretch))).collect();
    let scales: Vec<f32> = (-30..=30).map(|i| 10f32.powi(i)).collect();
    let ways = [("inverse, transposed", 0, NormalBy::Inverse), ("cofactors and sign", 2, NormalBy::Cofactors)];
    let ways = ways.map(|(name, kind, by)| {
        let points: Vec<_> = scales.iter().map(|scale| (f64::from(*scale), when_scaled(*scale, by))).collect();
        series(name, kind, &points, true)
    });
    let [own, unsigned] = &mirrored()?;
    Ok(FailurePage {
        id: "transforms",
        title: "Normals are not transformed as points are",
        cause: "Stretched like points, normals lean the wrong way, by up to 2·atan s − 90° for a stretch of s. The inverse \
                transposed is right, but there is none where an object is flattened, in f32 none where its determinant leaves \
                the number range, and the cofactors alone turn normals inside out where the determinant is below 0.",
        remedy: "The cofactor matrix with the sign of the determinant (equations::normal_matrix), then normalise: defined for \
                 everything that still has an area.",
        test: "normals_go_by_cofactors_with_the_sign",
        figures: vec![
            (
                "stretched",
                figure(
                    "transforms-stretched",
                    "Largest error of normals that are transformed like points",
                    [log("stretch along one axis"), linear("error (degrees)")],
                    panel("2·atan s − 90°", vec![series("matrix of the points", 0, &turned, false)]),
                ),
            ),
            (
                "tiny and huge",
                figure(
                    "transforms-scaled",
                    "Error of a normal in f32 where an object is scaled alike in all directions (90: none is left)",
                    [log("scale"), linear("error (degrees)")],
                    panel("f32", ways.into()),
                ),
            ),
        ],
        pictures: shown([
            ("y scaled by 0.4", &scaled(STRETCHED)?),
            ("normals as points", &with_normals(STRETCHED, |n| n * STRETCHED)?),
            ("mirrored", own),
            ("without the sign", unsigned),
            ("flattened: determinant 0", &scaled(Vec3::new(1.0, 1.0, 0.0))?),
        ]),
    })
}

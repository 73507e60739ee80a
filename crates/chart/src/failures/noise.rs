//! Normals of faces and of vertices on a mesh with noise.

use super::prelude::*;
use crate::front::scenes::random;

/// The deviation of vertices from the plane, in edge lengths.
const SIGMAS: [f64; 5] = [0.002, 0.005, 0.01, 0.02, 0.05];
/// Reflectance.
const KD: f64 = 0.8;
/// Cells along a side.
const CELLS: i32 = 72;

/// The `i`th of a row of normally distributed numbers (Box, Muller 1958).
fn normal(i: u32) -> f64 {
    let [u, v] = [0, 1].map(|k| 1.0 - f64::from(random(i, k)));
    (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

/// Equilateral triangles of edge 1 about the origin, their vertices off the plane z = 0 by numbers of this deviation.
/// Vertex normals are means of the faces'.
fn sheet(sigma: f64) -> Mesh {
    let side = CELLS + 1;
    let vertex = |k: i32| {
        let (i, j) = (k % side - CELLS / 2, k / side - CELLS / 2);
        // Every other row is shifted by half an edge.
        let x = f64::from(i) + 0.5 * f64::from(j.rem_euclid(2));
        Vec3::new(x as f32, (0.75f64.sqrt() * f64::from(j)) as f32, (sigma * normal(k as u32)) as f32)
    };
    let cells = (0..CELLS).flat_map(|j| (0..CELLS).map(move |i| (j, j * side + i)));
    let triangles = cells.flat_map(|(j, a)| {
        let (b, c, d) = (a + 1, a + side, a + side + 1);
        let shifted = (j - CELLS / 2).rem_euclid(2) == 1;
        if shifted { [a, b, d, a, d, c] } else { [a, b, c, b, d, c] }
    });
    let indices = triangles.map(|vertex| vertex as u32).collect();
    made((0..side * side).map(vertex).collect(), None, indices)
}

fn picture(sigma: f64, shading: Shading, half: f32, size: UVec2) -> Result<Image, ChartError> {
    drawn_at(size, Mode::Mesh, |world| {
        camera_above(world, 500.0, half);
        sun(world, Vec3::new(1.0, 0.0, 1.0));
        show(world, sheet(sigma), Material::matte(LinearRgba::gray(KD as f32)), shading);
    })
}

/// The RMS change of intensity, linear, that noise makes of a plane lit at 45°, of reflectance 0.8; `sigma` is the
/// standard deviation of the vertices from the plane, in edge lengths.
fn roughness(sigma: f64, shading: Shading) -> Result<f64, ChartError> {
    let picture = picture(sigma, shading, 30.0, UVec2::splat(192))?;
    let plane = KD * 0.5f64.sqrt();
    let squares: f64 = picture.pixels().iter().map(|pixel| (pixel[0] - plane).powi(2)).sum();
    Ok((squares / picture.pixels().len() as f64).sqrt())
}

pub(super) fn page() -> Result<FailurePage, ChartError> {
    let mut lines = Vec::new();
    for (kind, shading) in SHADINGS.into_iter().enumerate() {
        let sigmas = SIGMAS.map(|sigma| (sigma, sigma));
        lines.push(measured(NAMES[kind], kind, sigmas, |sigma| roughness(sigma, shading))?);
    }
    let [flat, gouraud, phong] = SHADINGS.map(|shading| picture(0.02, shading, 8.0, UVec2::splat(256)));
    Ok(FailurePage {
        id: "noise",
        title: "Flat shading shows a mesh’s noise",
        cause: "Noise turns a face by twice its size over the edge length; the mean at a vertex is turned less, because its six \
                faces share their errors. On equilateral triangles flat shading is √(36/3.5) = 3.2 times as rough as shading \
                with interpolated normals.",
        remedy: "Shade noisy scans with mean normals (Normals::Weighted), at vertices or at pixels, or smooth the mesh first.",
        test: "flat_shading_is_rougher_than_mean_normals",
        figures: vec![figure(
            "noise",
            "RMS change of the intensity of a plane lit at 45°, reflectance 0.8",
            [Axis::log("noise of the vertices (edge lengths)"), Axis::log("RMS change (linear)")],
            Panel::new("equilateral triangles; Gouraud and Phong are alike", lines),
        )],
        pictures: shown([("flat, noise of 0.02 edges", &flat?), ("Gouraud", &gouraud?), ("Phong", &phong?)]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failures::testing::is_near;

    /// The formula of [`roughness`] for little noise.
    ///
    /// The heights z of a triangle's corners tilt it by Σ z·∇λ, λ the barycentric coordinates, |∇λ| = 2/√3 for edge 1: by
    /// √4·σ in all (RMS). The mean over the six triangles around a vertex is Σ z·d/3 over its neighbours, d the
    /// direction to each: √(6/9)·σ; interpolated between vertices, two of which share 1/9 by their common neighbours,
    /// √(3.5/9)·σ over a triangle. Half of the square goes along the light, whose part in the plane is √½.
    fn expected(sigma: f64, shading: Shading) -> f64 {
        let tilt = if shading == Shading::Flat { 4.0f64 } else { 3.5 / 9.0 };
        KD * sigma * (0.5 * 0.5 * tilt).sqrt()
    }

    #[test]
    fn flat_shading_is_rougher_than_mean_normals() {
        for sigma in [0.002, 0.01] {
            for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
                let found = roughness(sigma, shading).expect("a sheet can be drawn");
                // Some four thousand vertices, of which neighbours count together: 3 % at twice the standard deviation.
                is_near(&format!("{sigma}, {shading:?}"), found, expected(sigma, shading), 0.06);
            }
        }
    }
}

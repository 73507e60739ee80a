//! Long thin triangles.

use halfway::mesh::{Cylinder, ParametricSurface, Tessellation};

use super::prelude::*;

/// The numbers of rows of the 1024 cells of a square, and the ratio of length to width of the cells.
const ROWS: [(u32, f64); 5] = [(32, 1.0), (16, 4.0), (8, 16.0), (4, 64.0), (2, 256.0)];
/// Bands of the lanterns.
const BANDS: [u32; 7] = [2, 4, 8, 16, 32, 64, 128];
/// Sides of the lanterns.
const SIDES: u32 = 16;
/// The lanterns' height; their radius is 1.
const HEIGHT: f64 = 2.0;

fn cells(rows: u32, shading: Shading) -> Result<Image, ChartError> {
    drawn(Mode::Mesh, |world| {
        camera_above(world, 10.0, 0.99);
        lamp(world, Vec3::new(0.3, 0.2, 1.0));
        show(world, square(1024 / rows, rows), Material::matte(LinearRgba::gray(0.9)), shading);
    })
}

/// The RMS error, linear, of Gouraud shading over a square of 1024 cells in N rows under a lamp.
fn stretched(rows: u32) -> Result<f64, ChartError> {
    rms(&cells(rows, Shading::Gouraud)?, &cells(rows, Shading::Phong)?)
}

/// Schwarz's lantern: a cylinder of radius 1 and height 2 about the y axis in `bands` rings of triangles, each ring
/// turned by half a side against the next. Its vertices lie on the cylinder and have its normals.
fn lantern(bands: u32) -> Mesh {
    let vertex = |ring: u32, side: u32| {
        let angle = std::f64::consts::TAU * (f64::from(side) + 0.5 * f64::from(ring % 2)) / f64::from(SIDES);
        let (x, z) = angle.sin_cos();
        Vec3::new(x as f32, (HEIGHT * (f64::from(ring) / f64::from(bands) - 0.5)) as f32, z as f32)
    };
    let positions: Vec<Vec3> = (0..=bands).flat_map(|ring| (0..SIDES).map(move |side| vertex(ring, side))).collect();
    let normals = positions.iter().map(|p| Vec3::new(p.x, 0.0, p.z)).collect();
    let triangles = (0..bands).flat_map(|ring| {
        (0..SIDES).flat_map(move |side| {
            let at = |ring: u32, side: u32| ring * SIDES + side % SIDES;
            let (a, b) = (at(ring, side), at(ring, side + 1));
            let (c, d) = (at(ring + 1, side), at(ring + 1, side + 1));
            // The vertex above lies before or after this one.
            if ring % 2 == 0 { [a, b, c, b, d, c] } else { [a, d, c, a, b, d] }
        })
    });
    made(positions, Some(normals), triangles.collect())
}

fn column(world: &mut World, mesh: Mesh, shading: Shading) {
    camera(world, Vec3::new(0.0, 0.0, 3.4), Vec3::Y);
    sun(world, Vec3::new(0.3, 0.4, 1.0));
    show(world, mesh, Material::matte(LinearRgba::gray(0.9)), shading);
}

fn lantern_picture(bands: u32, shading: Shading) -> Result<Image, ChartError> {
    drawn(Mode::Mesh, |world| column(world, lantern(bands), shading))
}

fn cylinder() -> Result<Image, ChartError> {
    let cylinder = Cylinder { radius: 1.0, height: HEIGHT as f32, capped: false };
    let mesh = sound(cylinder.mesh(Tessellation::Count { rows: 1, columns: 64 }));
    drawn(Mode::Surface, |world| column(world, mesh, Shading::Phong))
}

/// The 95th percentile of the error, linear, over the pixels of a lantern relative to the true cylinder.
fn lantern_error(bands: u32, shading: Shading) -> Result<f64, ChartError> {
    const P95: usize = 1;
    Ok(compared(&lantern_picture(bands, shading)?, &cylinder()?)?.linear.all.percentiles[P95])
}

pub(super) fn page() -> Result<FailurePage, ChartError> {
    let stretches = measured("Gouraud", 1, ROWS.map(|(rows, aspect)| (aspect, rows)), stretched)?;
    let mut lanterns = Vec::new();
    for (name, kind, shading) in [("flat", 0, Shading::Flat), ("Phong, the cylinder’s normals", 2, Shading::Phong)] {
        let bands = BANDS.map(|bands| (f64::from(bands), bands));
        lanterns.push(measured(name, kind, bands, |bands| lantern_error(bands, shading))?);
    }
    let [even, thin] = [32, 2].map(|rows| cells(rows, Shading::Gouraud));
    let [flat, phong] = [Shading::Flat, Shading::Phong].map(|shading| lantern_picture(64, shading));
    Ok(FailurePage {
        id: "slivers",
        title: "Long thin triangles are worse than their number says",
        cause: "What is interpolated errs by the square of the longest edge: cells twice as long as wide for the same number err \
                twice as much. And where thin triangles have wide angles their planes turn away from the surface: on a lantern \
                (H. A. Schwarz, 1880) flat shading gets worse the finer it is cut.",
        remedy: "Cells about as long as wide, with no angle near 180°; normals of the surface, not of the faces; shade at \
                 pixels.",
        test: "thin_triangles_err_by_length_and_lanterns_by_angle",
        figures: vec![
            figure(
                "slivers-stretched",
                "RMS error of Gouraud shading over a square of 1024 cells",
                [Axis::log("length of the cells (widths)"), Axis::log("RMS error (linear)")],
                Panel::new("under a lamp; Phong shading is exact there", vec![stretches]),
            )
            .named("stretched cells"),
            figure(
                "slivers-lantern",
                "Error that 95 % of the pixels of a lantern of 16 sides keep to",
                [Axis::log("bands"), Axis::log("error (linear)")],
                Panel::new("against the true cylinder", lanterns),
            )
            .named("Schwarz’s lantern"),
        ],
        pictures: shown([
            ("Gouraud, 32 × 32 cells", &even?),
            ("Gouraud, 512 × 2 cells", &thin?),
            ("lantern of 64 bands, flat", &flat?),
            ("the same, Phong", &phong?),
        ]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failures::testing::{is_near, slope};

    /// The angle in degrees between the faces of a lantern of N bands and the cylinder's normal at their middle.
    fn turned(bands: u32) -> f64 {
        let mesh = lantern(bands);
        let [a, b, c] = match mesh.triangles().next() {
            Some(triangle) => triangle.map(|vertex| mesh.positions()[vertex as usize].as_dvec3()),
            None => return 0.0,
        };
        let n = (b - a).cross(c - a);
        n.y.abs().atan2(n.x.hypot(n.z)).to_degrees()
    }

    /// The angle by formula: a face is as high as a band, and its base lies behind its tip by the sagitta 1 −
    /// cos(π/16).
    fn turned_by(bands: u32) -> f64 {
        let sagitta = 1.0 - (std::f64::consts::PI / f64::from(SIDES)).cos();
        (sagitta * f64::from(bands) / HEIGHT).atan().to_degrees()
    }

    #[test]
    fn thin_triangles_err_by_length_and_lanterns_by_angle() {
        let found =
            [16, 8, 4].map(|rows: u32| (1.0 / f64::from(rows), stretched(rows).expect("a square can be drawn")));
        let slope = slope(&found);
        assert!((slope - 2.0).abs() < 0.2, "by the square of the length: {slope}, {found:?}");
        for bands in [2, 16, 128] {
            is_near("the faces of a lantern", turned(bands), turned_by(bands), 1e-3);
        }
        let error = |bands, shading| lantern_error(bands, shading).expect("a lantern can be drawn");
        let [few, many] = [8, 128].map(|bands| error(bands, Shading::Flat));
        assert!(many > 2.0 * few, "finer and worse: {few}, {many}");
        let [few, many] = [8, 128].map(|bands| error(bands, Shading::Phong));
        assert!(many < 0.1 && many < 1.5 * few, "normals of the cylinder: {few}, {many}");
    }
}

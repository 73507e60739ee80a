//! Interpolated normals that face away from the viewer.

use super::prelude::*;

/// Bands of the spheres.
const LEVELS: [u32; 4] = [4, 8, 16, 32];
/// The viewer's distance: far away, and not along the meridians, so that cells along the outline lie in every
/// direction.
const DISTANCE: f32 = 5000.0;

fn toward() -> Vec3 {
    (Quat::from_rotation_y(0.37) * Quat::from_rotation_x(-0.61)) * Vec3::Z
}

/// A sphere with its light exactly behind it: no visible point is lit.
fn picture(level: u32, shading: Shading, mode: Mode) -> Result<Image, ChartError> {
    drawn(mode, |world| {
        let camera = Camera::perspective(2.0 * (1.08_f32 / DISTANCE).atan());
        world.spawn((camera, Transform::from_translation(DISTANCE * toward()).looking_at(Vec3::ZERO, Vec3::Y)));
        sun(world, -toward());
        show(world, UvSphere::new(1.0, 2 * level, level), Material::matte(LinearRgba::WHITE), shading);
    })
}

/// The brightest corner of all triangles that face the viewer, which nearby pixels approach under interpolated normals.
fn brightest_corner(level: u32) -> f64 {
    let mesh = Mesh::from(UvSphere::new(1.0, 2 * level, level));
    let (toward, eye) = (toward().as_dvec3(), (DISTANCE * toward()).as_dvec3());
    let corners = mesh.triangles().filter_map(|triangle| {
        let [a, b, c] = triangle.map(|vertex| mesh.positions()[vertex as usize].as_dvec3());
        let faces = (b - a).cross(c - a).dot(eye - a) > 0.0;
        faces.then(|| triangle.map(|vertex| -mesh.normals()[vertex as usize].as_dvec3().dot(toward)))
    });
    corners.flatten().fold(0.0, f64::max)
}

/// The bound of the visible light: the sine of the largest angle between a corner's normal and a triangle's, the
/// circumradius of a cell on the equator.
fn most(level: u32) -> f64 {
    let half_cell = 0.5 * std::f64::consts::PI / f64::from(level);
    // Of a square on a sphere with sides of two half cells the corners are that far from the middle.
    (half_cell.cos() * half_cell.cos()).acos().sin()
}

pub(super) fn page() -> Result<FailurePage, ChartError> {
    let mut lines = Vec::new();
    for (kind, shading) in SHADINGS.into_iter().enumerate() {
        let brightest = |level| Ok(picture(level, shading, Mode::Mesh)?.largest());
        lines.push(measured(NAMES[kind], kind, LEVELS.map(|level| (f64::from(2 * level), level)), brightest)?);
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
        figures: vec![figure(
            "outlines",
            "The brightest pixel of a sphere that is lit from behind (true: 0)",
            [Axis::log("meridians"), Axis::log("brightest pixel (linear)")],
            Panel::new("256 × 256 pixels; flat shading shows none, and 0 has no place on this axis", lines),
        )],
        pictures: shown([("flat, lit from behind", &flat?), ("Gouraud", &gouraud?), ("Phong", &phong?)]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failures::testing::slope;

    #[test]
    fn light_from_behind_shrinks_with_the_cells() {
        let corners = [8, 16, 32, 64, 128].map(|level| (1.0 / f64::from(level), brightest_corner(level)));
        for (edge, corner) in corners {
            let most = most((1.0 / edge).round() as u32);
            // Some triangle of each outline lies nearly as badly as one may, and none worse.
            assert!(corner > 0.6 * most && corner < most, "{edge}: {corner} of {most}");
        }
        let slope_of_corners = slope(&corners);
        assert!((slope_of_corners - 1.0).abs() < 0.15, "of the first order: {slope_of_corners}");
        let seen = |level, shading, mode| picture(level, shading, mode).expect("a sphere can be drawn");
        for shading in [Shading::Gouraud, Shading::Phong] {
            for level in [4, 8] {
                let found = seen(level, shading, Mode::Mesh).largest();
                assert!(found > 0.5 * brightest_corner(level) && found < brightest_corner(level), "{level}: {found}");
            }
        }
        let lit = [4, 8, 16].map(|level| {
            let picture = seen(level, Shading::Gouraud, Mode::Mesh);
            let covered = picture.covered().expect("the oracle knows").iter().filter(|here| **here).count();
            let lit = picture.pixels().iter().filter(|pixel| pixel[0] > 0.0).count();
            (1.0 / f64::from(level), lit as f64 / covered as f64)
        });
        assert!((slope(&lit) - 2.0).abs() < 0.4, "the rim narrows by the square: {lit:?}");
        for (shading, mode) in [(Shading::Flat, Mode::Mesh), (Shading::Phong, Mode::Surface)] {
            let brightest = seen(8, shading, mode).largest();
            assert!(brightest <= 0.0, "{shading:?}, {mode:?}: {brightest}");
        }
    }
}

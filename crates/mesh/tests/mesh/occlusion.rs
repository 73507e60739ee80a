//! Ambient occlusion against closed forms: an open plane, a floor beside a wall, a floor under a ball.
#![expect(clippy::float_cmp, reason = "what is open is exactly 1")]

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU32, Ordering};

use glam::{DVec2, Vec2, Vec3};
use halfway_mesh::{Mesh, OcclusionBake, OcclusionError, OcclusionImage, Plane, UvSphere};

fn baked(mesh: &Mesh, occluders: &[&Mesh], bake: OcclusionBake) -> OcclusionImage {
    mesh.baked_occlusion(occluders, &bake, &|_, _| ControlFlow::Continue(())).expect("something to bake")
}

fn of_size(width: u32, height: u32, rays: u32) -> OcclusionBake {
    OcclusionBake { size: [width, height], rays, ..OcclusionBake::default() }
}

/// A parallelogram with the whole image on it, u along the first side, v along the second.
fn sheet(corner: Vec3, u: Vec3, v: Vec3) -> Mesh {
    let positions = vec![corner, corner + u, corner + u + v, corner + v];
    let uvs = vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    Mesh::from_parts(positions, None, Some(uvs), vec![0, 2, 1, 0, 3, 2]).expect("two triangles")
}

/// The middles of texels from 0 to 1.
fn middles(size: u32) -> impl Iterator<Item = f64> + Clone {
    (0..size).map(move |at| (f64::from(at) + 0.5) / f64::from(size))
}

/// How far an image of 1024 rays may be from a closed form: as if 6 rays were on the wrong side. The points of the
/// spiral are so even that the borders of what is seen decide, each as long as a few dozen rays, of which half are on
/// either side.
const OFF: f64 = 6.0 / 1024.0;

#[test]
fn a_plane_alone_is_open() {
    let image = baked(&Mesh::from(Plane { size: 2.0, divisions: 3 }), &[], of_size(9, 7, 64));
    assert_eq!((image.size(), image.baked()), ([9, 7], 63));
    assert!(image.shares().iter().all(|share| *share == 1.0), "{:?}", image.shares());
}

#[test]
fn a_floor_beside_a_wall_loses_what_the_wall_covers() {
    // A wall without end to either side, of height 1: as a strip seen from 90° to the angle θ of its upper edge it has
    // the form factor ½(1 − sin θ), sin θ = x/√(x² + 1).
    let floor = sheet(Vec3::new(0.0, 0.0, -0.5), 2.0 * Vec3::X, Vec3::Z);
    assert!(floor.normals().iter().all(|n| *n == Vec3::Y));
    let far = 2000.0 * Vec3::Z;
    let walls = [sheet(-0.5 * far, far, Vec3::Y), sheet(-0.5 * far, Vec3::Y, far)];
    let images = walls.map(|wall| baked(&floor, &[&wall], of_size(32, 8, 1024)));
    // Either side of a triangle occludes.
    assert_eq!(images[0], images[1]);
    let places = middles(8).flat_map(|_| middles(32));
    let (mut mean, mut evenly) = (0.0, 0);
    for (u, share) in places.zip(images[0].shares()) {
        let x = 2.0 * u;
        let expected = 1.0 - 0.5 * (1.0 - x / (x * x + 1.0).sqrt());
        let off = (f64::from(*share) - expected).abs();
        assert!(off < OFF, "{x}: {share}, not {expected}");
        mean += off / 256.0;
        // A planted fault: rays that are as many in every direction miss as much of a half circle as the wall is high.
        let by_angle = 1.0 - (1.0 / x).atan() / std::f64::consts::PI;
        evenly += usize::from((by_angle - expected).abs() > OFF);
    }
    assert!(mean < 0.3 * OFF, "{mean}");
    // Beside the wall and far from it all rays, or none, see it.
    assert!(evenly >= 240, "rays without the cosine would be found at {evenly} of 256 texels");
}

#[test]
fn a_floor_under_a_ball_loses_what_the_ball_covers() {
    // A ball above the horizon covers R²/d²·cos θ = R²·h/d³, d being the distance of its centre and h its height.
    let (radius, height) = (0.5, 0.8);
    let floor = Mesh::from(Plane { size: 4.0, divisions: 1 });
    let ball = Mesh::from(UvSphere::new(radius as f32, 64, 32));
    let positions = ball.positions().iter().map(|p| *p + height as f32 * Vec3::Y).collect();
    let ball = Mesh::from_parts(positions, None, None, ball.indices().to_vec()).expect("a ball");
    let image = baked(&floor, &[&ball], of_size(33, 33, 1024));
    let places = middles(33).flat_map(|v| middles(33).map(move |u| DVec2::new(4.0 * u - 2.0, 4.0 * v - 2.0)));
    let mut doubled = 0;
    for (at, share) in places.clone().zip(image.shares()) {
        let covered = radius * radius * height / (at.length_squared() + height * height).powf(1.5);
        assert!((f64::from(*share) - (1.0 - covered)).abs() < OFF, "{at}: {share}, not {}", 1.0 - covered);
        // A planted fault: a ball of a tenth more.
        doubled += usize::from(0.21 * covered > 2.0 * OFF);
    }
    assert!(doubled > 300, "a larger ball would be found at {doubled} texels");
    // Occluders beyond the reach do not count.
    let near = OcclusionBake { reach: 0.29, ..of_size(33, 33, 64) };
    assert!(baked(&floor, &[&ball], near).shares().iter().all(|share| *share == 1.0));
    let near = OcclusionBake { reach: 0.32, ..of_size(33, 33, 1024) };
    assert!(baked(&floor, &[&ball], near).shares()[33 * 16 + 16] < 1.0);
}

#[test]
fn a_coarse_ball_does_not_occlude_itself() {
    let ball = Mesh::from(UvSphere::new(1.0, 16, 8));
    let image = baked(&ball, &[], of_size(64, 32, 256));
    let least = image.shares().iter().copied().fold(1.0, f32::min);
    assert!(least > 0.99, "{least}");
    // And without its smooth normals every facet is open, exactly.
    let (faceted, _) = ball.with_normals(halfway_mesh::Normals::Face);
    assert!(baked(&faceted, &[], of_size(64, 32, 64)).shares().iter().all(|share| *share == 1.0));
}

#[test]
fn texels_beside_the_mesh_are_dilated() {
    // The floor lies on the left quarter of the image, the wall occludes it most at its left.
    let floor = sheet(Vec3::new(0.0, 0.0, -0.5), 2.0 * Vec3::X, Vec3::Z);
    let uvs = floor.uvs().expect("a sheet has them").iter().map(|uv| Vec2::new(0.25 * uv.x, uv.y)).collect();
    let floor =
        Mesh::from_parts(floor.positions().to_vec(), None, Some(uvs), floor.indices().to_vec()).expect("a sheet");
    let wall = sheet(-500.0 * Vec3::Z, 1000.0 * Vec3::Z, Vec3::Y);
    let image = baked(&floor, &[&wall], of_size(32, 4, 256));
    assert_eq!(image.baked(), 32);
    for row in image.shares().chunks(32) {
        let (of_mesh, beside) = row.split_at(8);
        let (least, most) = (of_mesh[0], of_mesh[7]);
        assert!(least < 0.7 && most > 0.9);
        assert!(beside.iter().all(|share| (share - most).abs() < 0.02), "{row:?}");
    }
}

#[test]
fn it_is_the_same_every_time_and_can_be_stopped() {
    let ball = Mesh::from(UvSphere::new(1.0, 16, 8));
    let floor = Mesh::from(Plane { size: 4.0, divisions: 1 });
    let bake = of_size(16, 16, 32);
    let told = AtomicU32::new(0);
    let image = floor.baked_occlusion(&[&ball], &bake, &|done, of| {
        assert!(done <= of && of == 16);
        told.fetch_add(1, Ordering::Relaxed);
        ControlFlow::Continue(())
    });
    assert_eq!((image, told.into_inner()), (Ok(baked(&floor, &[&ball], bake)), 16));
    let stopped = floor.baked_occlusion(&[&ball], &bake, &|_, _| ControlFlow::Break(()));
    assert_eq!(stopped, Err(OcclusionError::Stopped));
}

#[test]
fn invalid_bakes_are_refused() {
    let plane = Mesh::from(Plane::default());
    let bake = OcclusionBake::default();
    let error = |mesh: &Mesh, bake: OcclusionBake| {
        mesh.baked_occlusion(&[], &bake, &|_, _| ControlFlow::Continue(())).expect_err("a wrong number")
    };
    assert_eq!(error(&plane, of_size(0, 4, 1)), OcclusionError::Size { width: 0, height: 4 });
    assert_eq!(error(&plane, of_size(4, 8193, 1)), OcclusionError::Size { width: 4, height: 8193 });
    assert_eq!(
        error(&plane, of_size(u32::MAX, u32::MAX, 1)),
        OcclusionError::Size { width: u32::MAX, height: u32::MAX }
    );
    assert_eq!(error(&plane, of_size(4, 4, 0)), OcclusionError::Rays { found: 0 });
    assert_eq!(error(&plane, of_size(4, 4, 65537)), OcclusionError::Rays { found: 65537 });
    assert_eq!(error(&plane, OcclusionBake { reach: 0.0, ..bake }), OcclusionError::Reach { found: 0.0 });
    assert!(matches!(error(&plane, OcclusionBake { reach: f32::NAN, ..bake }), OcclusionError::Reach { .. }));
    assert_eq!(error(&plane, OcclusionBake { uv_set: 1, ..bake }), OcclusionError::NoUvs { set: 1 });
    let bare = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![0, 1, 2]).expect("a triangle");
    assert_eq!(error(&bare, bake), OcclusionError::NoUvs { set: 0 });
    let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let outside = vec![Vec2::splat(1e30), Vec2::new(3e30, 1e30), Vec2::new(1e30, 2e30)];
    let beyond = Mesh::from_parts(corners, None, Some(outside), vec![0, 1, 2]).expect("a triangle");
    assert_eq!(error(&beyond, of_size(4, 4, 4)), OcclusionError::NothingOnImage);
    let message = error(&plane, of_size(0, 4, 1)).to_string();
    assert_eq!(message, "an image of 0 × 4 texels; 1 to 8192 along each side are expected");
}

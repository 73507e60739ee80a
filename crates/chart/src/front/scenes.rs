//! The scenes of the project's own charts; the command adds those that are its own, and the user's.

use halfway::mesh::MeshError;
use halfway::prelude::*;

use super::ChartedScene;

/// All of them.
pub fn all() -> Vec<ChartedScene> {
    vec![sphere(), teapot(), teapot_by_phong(), scan()]
}

/// A unit sphere.
pub fn sphere() -> ChartedScene {
    let about = "a sphere of a radius of 1 under one directional light, shininess 32";
    ChartedScene::from_surfaces("sphere", about, [8, 16, 32, 64, 128], |world, bands| {
        let camera = Transform::from_xyz(0.0, 0.0, 2.9);
        shiny_object(world, UvSphere::new(1.0, 2 * bands, bands).into(), camera);
    })
}

/// The Utah teapot.
pub fn teapot() -> ChartedScene {
    let about = "the Utah teapot, Bézier patches of n × n cells each, under one directional light, shininess 32";
    ChartedScene::from_surfaces("teapot", about, [2, 4, 8, 16, 32], |world, cells| {
        // The spout is farther from the axis than the handle.
        let middle = Vec3::new(0.16, -0.05, 0.0);
        let camera = Transform::from_translation(middle + Vec3::new(0.0, 3.2, 6.0)).looking_at(middle, Vec3::Y);
        shiny_object(world, Teapot::new(cells).into(), camera);
    })
}

/// The teapot by Phong's formula, which Blinn's may replace.
pub fn teapot_by_phong() -> ChartedScene {
    ChartedScene {
        name: "teapot-by-phong".to_owned(),
        about: "the teapot with Phong’s (v·r)³², for which Blinn–Phong may stand".to_owned(),
        reflectance: Some(Reflectance::Phong),
        ..teapot()
    }
}

/// Warm grey, whose channels differ, so that they do not err alike, with a highlight; the brightest sum stays below 1.
/// The light comes from over the viewer's right shoulder.
fn shiny_object(world: &mut World, mesh: Mesh, camera: Transform) {
    world.insert_resource(GlobalAmbient(LinearRgba::rgb(0.15, 0.15, 0.15)));
    world.spawn((Camera::default(), camera));
    let from_above = Transform::default().looking_to(-Vec3::new(0.5, 0.7, 1.0), Vec3::Y);
    world.spawn((DirectionalLight::white(), from_above));
    let grey = Material { shininess: 32.0, ..Material::matte(LinearRgba::rgb(0.55, 0.42, 0.30)) };
    let grey = Material { specular: LinearRgba::rgb(0.35, 0.35, 0.35), ..grey };
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    world.spawn((Mesh3d(mesh), grey));
}

/// A stone of 146,688 triangles with the noise of a scanner.
pub fn scan() -> ChartedScene {
    let about = "a stone of 146,688 triangles with the noise of a scanner, under a directional and a point light";
    ChartedScene::from_meshes(
        "scan",
        about,
        Box::new(|app, _| build(app.world_mut()).map_err(|error| error.to_string())),
    )
}

fn build(world: &mut World) -> Result<(), MeshError> {
    world.insert_resource(GlobalAmbient(LinearRgba::rgb(0.12, 0.12, 0.12)));
    world.spawn((Camera::default(), Transform::from_xyz(0.0, 0.4, 3.1).looking_at(Vec3::ZERO, Vec3::Y)));
    world.spawn((DirectionalLight::white(), Transform::default().looking_to(Vec3::new(0.6, -0.7, -1.0), Vec3::Y)));
    let lamp = PointLight::new(LinearRgba::rgb(0.3, 0.25, 0.2));
    world.spawn((lamp, Transform::from_xyz(-1.5, 0.5, 1.5)));
    let mesh = world.resource_mut::<Assets<Mesh>>().add(stone_mesh(384, 192)?);
    let stone = Material { shininess: 16.0, ..Material::matte(LinearRgba::rgb(0.5, 0.45, 0.38)) };
    let stone = Material { specular: LinearRgba::rgb(0.2, 0.2, 0.2), ..stone };
    world.spawn((Mesh3d(mesh), stone));
    Ok(())
}

/// A stone of a radius of about 1 with the noise of a scanner: a [`UvSphere`] of N segments and rings whose vertices
/// lie off by hills of up to 0.1 and by noise of up to 0.001, with normals of the default weighting.
///
/// # Errors
/// None for counts that [`UvSphere`] takes.
pub fn stone_mesh(segments: u32, rings: u32) -> Result<Mesh, MeshError> {
    let smooth = Mesh::from(UvSphere::new(1.0, segments, rings));
    let (mesh, _) = smooth.displaced(|i| {
        let p = smooth.positions()[i];
        let hills = (3.0 * p.x + 1.0).sin() * (4.0 * p.y).sin() + 0.4 * (9.0 * p.z + 5.0 * p.x).sin();
        // A scanner's noise is about a thousandth of the object, and the same at vertices of one position.
        0.07 * hills + 0.002 * (random(place(p), 0) - 0.5)
    })?;
    Ok(mesh)
}

/// Unwraps a mesh of our own: it has triangles, and finite numbers.
///
/// # Panics
/// It is invalid.
pub fn sound<T, E: std::fmt::Display>(made: Result<T, E>) -> T {
    match made {
        Ok(made) => made,
        Err(error) => unreachable!("{error}"),
    }
}

/// A hash of the position's bits.
fn place(p: Vec3) -> u32 {
    p.to_array().iter().fold(0, |all, x| (all ^ (x + 2.0).to_bits()).wrapping_mul(0x9E37_79B1).rotate_left(13))
}

/// The k-th random number of element i, in [0, 1): the PCG hash of O'Neill 2014, so that every run draws the same.
pub fn random(i: u32, k: u32) -> f32 {
    let state = (i.wrapping_mul(8).wrapping_add(k)).wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (((word >> 22) ^ word) >> 8) as f32 / (1 << 24) as f32
}

#[cfg(test)]
mod tests {
    use halfway::prelude::*;

    use super::*;
    use crate::front::Still;

    #[test]
    fn scenes_have_names_of_their_own_and_details() {
        let mut names: Vec<String> = all().iter().map(|scene| scene.name.clone()).collect();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), all().len());
        assert!(all().iter().all(|scene| !scene.details.is_empty() && scene.size.min_element() > 0));
    }

    #[test]
    fn random_numbers_fill_their_range() {
        let mean = (0..4096).map(|i| f64::from(random(i, 3))).sum::<f64>() / 4096.0;
        // The mean of 4096 uniform numbers is 0.5 within 0.0045 by one standard deviation.
        assert!((mean - 0.5).abs() < 0.02, "{mean}");
        assert!((0..4096).all(|i| (0.0..1.0).contains(&random(i, 0))));
        // By hand from the definition: hash(0) = 129708002.
        assert_eq!((random(0, 0) * (1 << 24) as f32) as u32, 129_708_002 >> 8);
    }

    #[test]
    fn finer_details_have_more_triangles_and_a_scan_has_many() {
        for scene in all() {
            let triangles = |detail| {
                let mut app = App::new();
                app.add_plugins(HalfwayPlugins::reference()).insert_resource(Still);
                (scene.build)(&mut app, detail).unwrap();
                app.finish();
                app.update();
                let world = app.world();
                let meshes = world.resource::<Assets<Mesh>>();
                let mut objects = world.try_query::<&Mesh3d>().unwrap();
                objects.iter(world).map(|mesh| meshes.get(&mesh.0).unwrap().triangle_count()).sum::<usize>()
            };
            let all: Vec<usize> = scene.details.iter().map(|detail| triangles(*detail)).collect();
            assert!(all[0] > 0 && all.is_sorted(), "{}: {all:?}", scene.name);
            if scene.name == "scan" {
                assert!(all[0] >= 100_000);
            } else {
                assert!(all.windows(2).all(|pair| pair[0] < pair[1]), "{all:?}");
            }
        }
    }
}

//! A mesh like those that come from scanners.

use halfway::mesh::MeshError;
use halfway::prelude::*;

use super::super::ChartedScene;
use super::random;

/// A stone of 146,688 triangles with the noise of a scanner.
pub fn scan() -> ChartedScene {
    let about = "a stone of 146,688 triangles with the noise of a scanner, under a directional and a point light";
    ChartedScene::of_meshes("scan", about, Box::new(|app, _| build(app.world_mut()).map_err(|error| error.to_string())))
}

fn build(world: &mut World) -> Result<(), MeshError> {
    world.insert_resource(GlobalAmbient(LinearRgba::rgb(0.12, 0.12, 0.12)));
    world.spawn((Camera::default(), Transform::from_xyz(0.0, 0.4, 3.1).looking_at(Vec3::ZERO, Vec3::Y)));
    world.spawn((DirectionalLight::white(), Transform::default().looking_to(Vec3::new(0.6, -0.7, -1.0), Vec3::Y)));
    let lamp = PointLight::from_color(LinearRgba::rgb(0.3, 0.25, 0.2));
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
        // A scanner's noise is about a thousandth of what it sees, and the same at the vertices of one place.
        0.07 * hills + 0.002 * (random(place(p), 0) - 0.5)
    })?;
    Ok(mesh)
}

/// A number of the place: the bits of its coordinates, mixed.
fn place(p: Vec3) -> u32 {
    p.to_array().iter().fold(0, |all, x| (all ^ (x + 2.0).to_bits()).wrapping_mul(0x9E37_79B1).rotate_left(13))
}

//! Lights that move.

use std::f32::consts::TAU;

use halfway::prelude::*;

use super::super::{ChartedScene, SceneDetail, Still};

/// Five teapots on a floor among lights that circle them, one of them below each: what the example `moving_lights`
/// shows.
pub fn moving_lights() -> ChartedScene {
    let about = "five teapots on a floor, three point lights and two spots that move with every frame";
    let levels = [2, 4, 8, 16, 32];
    let scene = ChartedScene::of_surfaces("moving-lights", about, levels, |_, _| ());
    ChartedScene {
        build: Box::new(|app, detail| {
            app.add_systems(Update, turn.run_if(not(resource_exists::<Still>)));
            if let SceneDetail::Cells(cells) = detail {
                spawn(app.world_mut(), cells);
            }
            Ok(())
        }),
        ..scene
    }
}

/// So many turns about +Y in 120 frames.
#[derive(Component)]
struct Revolving(f32);

fn turn(mut turning: Query<(&Revolving, &mut Transform)>) {
    for (turns, mut transform) in &mut turning {
        transform.rotate_y(turns.0 * TAU / 120.0);
    }
}

fn spawn(world: &mut World, cells: u32) {
    world.insert_resource(GlobalAmbient(LinearRgba::rgb(0.03, 0.03, 0.04)));
    let eye = Transform::from_xyz(0.0, 8.5, 12.0).looking_at(Vec3::new(0.0, 0.0, -0.4), Vec3::Y);
    world.spawn((Camera { fov_y: 0.7, ..Camera::default() }, eye));
    let mut meshes = world.resource_mut::<Assets<Mesh>>();
    let teapot = Mesh3d(meshes.add(Teapot::new(cells)));
    // Lights between the vertices of a floor of few cells are lost by Gouraud shading.
    let floor = Mesh3d(meshes.add(Plane { size: 16.0, divisions: 4 * cells }));
    world.spawn((floor, Material::matte(LinearRgba::rgb(0.3, 0.3, 0.32)), Transform::from_xyz(0.0, -0.9, 0.0)));
    let places = [(-3.2, 2.0), (3.2, 2.0), (-3.2, -2.6), (3.2, -2.6), (0.0, -0.4)];
    let colors = [(1.0, 0.5, 0.1), (0.1, 0.4, 1.0), (0.2, 1.0, 0.35), (1.0, 0.1, 0.3), (0.8, 0.8, 0.8)];
    for (i, ((x, z), (red, green, blue))) in places.into_iter().zip(colors).enumerate() {
        let turns = if i % 2 == 0 { 1.0 } else { -1.0 };
        let place = Transform::from_xyz(x, 0.0, z).with_rotation(Quat::from_rotation_y(i as f32));
        let scale = Transform::from_scale(Vec3::splat(0.6));
        world.spawn((place, Revolving(turns), children![(teapot.clone(), Material::BRASS, scale)]));
        let light = PointLight {
            attenuation: Attenuation::new(0.3, 0.0, 0.13),
            ..PointLight::from_color(LinearRgba::rgb(red, green, blue))
        };
        let at = Transform::from_xyz(1.9, 1.6, 0.0);
        if i < 3 {
            world.spawn((place, Revolving(-2.0 * turns), children![(light, at)]));
        } else {
            let spot = SpotLight { light, cone: Cone { inner: Some(0.3), ..Cone::new(0.5) } };
            let spot = (spot, at.with_translation(Vec3::new(1.0, 3.4, 0.0)).looking_at(Vec3::ZERO, Vec3::X));
            world.spawn((place, Revolving(-2.0 * turns), children![spot]));
        }
    }
}

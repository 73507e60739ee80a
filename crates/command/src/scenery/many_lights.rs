//! A large floor under few lights that touch all of it, and many that touch nothing.

use std::f32::consts::TAU;

use halfway::prelude::*;

/// The scene as a plugin: a floor of 512 × 512 cells, which is 8,192 patches, all in view of a camera that moves.
/// Levels of detail are off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ManyLights {
    /// Lights above the floor, without a range.
    pub(crate) touching: u32,
    /// Lights beside the floor, out of their range.
    pub(crate) apart: u32,
}

/// The size of its picture in pixels: small, so that work before the pixels dominates.
pub(crate) const SIZE: UVec2 = UVec2::splat(32);

/// Along each side of the floor.
const CELLS: u32 = 512;

/// The edge of the floor.
const EDGE: f32 = 64.0;

#[derive(Component)]
struct Moving;

impl Plugin for ManyLights {
    fn build(&self, app: &mut App) {
        let scene = *self;
        app.insert_resource(GlobalAmbient(LinearRgba::rgb(0.1, 0.1, 0.1)))
            .add_systems(Startup, move |mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>| {
                let floor = meshes.add(Plane { size: EDGE, divisions: CELLS });
                commands.spawn((Mesh3d(floor), Material::BRASS, Shading::Phong, Reflectance::BlinnPhong));
                let above = Transform::from_xyz(0.0, 1.2 * EDGE, 0.1).looking_at(Vec3::ZERO, Vec3::Y);
                commands.spawn((Camera::perspective(1.0), above, Moving));
                scene.spawn_lights(&mut commands);
            })
            .add_systems(Update, |mut cameras: Query<&mut Transform, With<Moving>>| {
                for mut at in &mut cameras {
                    // Back and forth, so that no two frames are the same.
                    at.translation.x = if at.translation.x > 0.0 { -0.01 } else { 0.01 };
                }
            });
    }
}

impl ManyLights {
    fn spawn_lights(self, commands: &mut Commands) {
        let dim = PointLight::new(LinearRgba::gray(0.05));
        for i in 0..self.touching {
            let (sin, cos) = (TAU * i as f32 / self.touching as f32).sin_cos();
            let at = Transform::from_xyz(0.4 * EDGE * cos, 0.3 * EDGE, 0.4 * EDGE * sin);
            commands.spawn((PointLight { attenuation: Attenuation::NONE, ..dim }, at));
        }
        // The golden angle's spiral fills the ring evenly.
        let share = |i: u32| (i as f32 + 0.5) / self.apart as f32;
        for i in 0..self.apart {
            let (sin, cos) = ((i as f32 * 0.618_034).fract() * TAU).sin_cos();
            let from_middle = EDGE * (1.0 + 15.0 * share(i).sqrt());
            let at = Transform::from_xyz(from_middle * cos, 2.0, from_middle * sin);
            commands.spawn((PointLight { range: Some(10.0), ..dim }, at));
        }
    }
}

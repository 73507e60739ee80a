//! The errors of scenes that cannot be drawn, and their messages.

use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use bevy_math::{Affine3A, Mat3, UVec2, Vec3};
use bevy_transform::components::GlobalTransform;
use halfway_asset::{Assets, Handle};
use halfway_lighting::{
    BackMaterial, Camera, DirectionalLight, GlobalAmbient, Material, PointLight, Projection, SpotLight,
};
use halfway_mesh::{Mesh, Mesh3d};
use halfway_reference::{Oracle, OracleError};

use crate::scene::{Stage, wall};

/// The error's text for a stage that `spoil` has spoiled.
fn refused(spoil: impl FnOnce(&mut Stage)) -> String {
    let mut stage = Stage::new();
    stage.add(wall(1.0, 2.0), Name::new("wall"));
    spoil(&mut stage);
    Oracle::new(&mut stage.world, UVec2::splat(8)).expect_err("a scene that cannot be drawn").to_string()
}

impl Stage {
    fn spawn(&mut self, extra: impl Bundle) {
        self.world.spawn((Name::new("extra"), extra));
    }

    fn move_camera(&mut self, to: GlobalTransform) {
        self.world.entity_mut(self.camera).insert(to);
    }

    fn spoil_wall(&mut self, by: impl Bundle) {
        let wall = self.world.query_filtered::<Entity, With<Mesh3d>>().single(&self.world).expect("one wall");
        self.world.entity_mut(wall).insert(by);
    }
}

fn nowhere() -> GlobalTransform {
    GlobalTransform::from_xyz(f32::NAN, 0.0, 0.0)
}

/// A transform without a local Z axis.
fn aimless() -> GlobalTransform {
    Affine3A::from_mat3(Mat3::from_diagonal(Vec3::new(1.0, 1.0, 0.0))).into()
}

#[test]
fn each_error_names_the_entity_and_the_field() {
    type Spoil = fn(&mut Stage);
    let rows: [(&str, Spoil, &str); 15] = [
        ("no camera", |s| assert!(s.world.despawn(s.camera)), "the scene has no camera"),
        ("two cameras", |s| s.spawn(Camera::default()), "has 2 cameras"),
        (
            "field of view",
            |s| s.camera().projection = Projection::perspective(4.0),
            "Camera.projection.fov_y: the value is 4.0",
        ),
        ("camera nowhere", |s| s.move_camera(nowhere()), "its GlobalTransform is [1.0,"),
        ("camera aimless", |s| s.move_camera(aimless()), "a scale that is not 0"),
        ("wall nowhere", |s| s.spoil_wall(nowhere()), "\"wall\": its GlobalTransform is [1.0,"),
        ("no mesh", |s| s.spoil_wall(Mesh3d(Handle::default())), "\"wall\": its mesh is not in `Assets<Mesh>`"),
        (
            "no meshes",
            |s| assert!(s.world.remove_resource::<Assets<Mesh>>().is_some()),
            "\"wall\": its mesh is not in `Assets<Mesh>`",
        ),
        (
            "material",
            |s| s.spoil_wall(Material { shininess: -1.0, ..Material::DEFAULT }),
            "\"wall\": Material.shininess: the value is -1.0",
        ),
        (
            "back material",
            |s| s.spoil_wall(BackMaterial(Material { opacity: 2.0, ..Material::DEFAULT })),
            "\"wall\": BackMaterial.opacity: the value is 2.0",
        ),
        (
            "light",
            |s| s.spawn(PointLight { range: Some(0.0), ..PointLight::white() }),
            "\"extra\": PointLight.range: the value is 0.0",
        ),
        (
            "light nowhere",
            |s| s.spawn((PointLight::white(), nowhere())),
            "\"extra\": GlobalTransform.translation: the position is [NaN",
        ),
        (
            "sun aimless",
            |s| s.spawn((DirectionalLight::white(), aimless())),
            "\"extra\": GlobalTransform.local −Z axis: the direction is",
        ),
        (
            "spot aimless",
            |s| s.spawn((SpotLight::white(0.5), aimless())),
            "\"extra\": GlobalTransform.local −Z axis: the direction is",
        ),
        (
            "ambient",
            |s| s.world.insert_resource(GlobalAmbient(LinearRgba::rgb(f32::NAN, 0.0, 0.0))),
            "GlobalAmbient.0.red: the value is NaN",
        ),
    ];
    for (row, spoil, expected) in rows {
        let found = refused(spoil);
        assert!(found.contains(expected), "{row}: {found:?} does not say {expected:?}");
    }
}

#[test]
fn pictures_need_pixels_and_not_too_many() {
    let mut stage = Stage::new();
    let mut error = |width, height| Oracle::new(&mut stage.world, UVec2::new(width, height)).err();
    assert_eq!(error(0, 4), Some(OracleError::EmptyPicture { width: 0, height: 4 }));
    assert_eq!(error(4, 0), Some(OracleError::EmptyPicture { width: 4, height: 0 }));
    let limit = Oracle::MAX_PIXELS;
    assert_eq!(error(8192, 8193), Some(OracleError::TooLarge { width: 8192, height: 8193, limit }));
    assert_eq!(error(u32::MAX, u32::MAX), Some(OracleError::TooLarge { width: u32::MAX, height: u32::MAX, limit }));
    assert_eq!(error(8192, 8192), None);
}

#[test]
fn a_spot_without_a_cone_needs_no_direction() {
    let mut stage = Stage::new();
    stage.world.spawn((SpotLight { cone: halfway_lighting::Cone::NONE, ..SpotLight::default() }, aimless()));
    assert!(Oracle::new(&mut stage.world, UVec2::splat(4)).is_ok());
}

#[test]
fn an_empty_world_with_a_camera_is_a_background() {
    let mut world = World::new();
    world.spawn((Camera::default(), GlobalTransform::IDENTITY));
    let image = Oracle::new(&mut world, UVec2::splat(4)).expect("nothing is wrong").draw();
    assert!(image.pixels().iter().flatten().all(|i| *i == 0.0));
}

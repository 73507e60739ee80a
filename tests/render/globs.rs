//! `halfway::prelude::*` beside the preludes of bevy: each name means one thing. That this file compiles is the test: a
//! name that two globs bring in with different meanings is an error where it is used.

use halfway::prelude as facade;

/// Uses every name of the prelude that this project defines, and the names of bevy that a scene uses. If a name means
/// another type than `facade::Name`, that is a compile error.
macro_rules! names {
    ($($name:ident)*) => {
        $(const _: fn(facade::$name) -> $name = |same| same;)*
    };
}

macro_rules! beside {
    ($module:ident: $($prelude:path),*) => {
        mod $module {
            #![allow(unused_imports, reason = "where two preludes bring the same item in, one of them counts as unused")]
            use super::facade;
            $(use $prelude::*;)*
            use halfway::prelude::*;

            names! {
                AlphaMode Attenuation BackMaterial Camera Cone DirectionalLight Encoding Faces Frequency GlobalAmbient
                Intensity LightingPlugin Material PointLight Reflectance Samples Shading SpotLight Terms Tolerance ViewTolerance Viewer Visibility
                Cuboid Mesh Mesh3d MeshPlugin Plane Teapot UvSphere
                Compile FrameReport Headless Picture Pixels RenderPlugin RenderSet HalfwayPlugins
                App AppExit Startup Update PostUpdate Entity ChildOf World Name Color LinearRgba Srgba
                EulerRot Mat3 Mat4 Quat UVec2 Vec2 Vec3 Vec4 GlobalTransform Transform TransformPlugin Fixed Real Virtual
            }

            const _: fn(facade::Assets<Mesh>, facade::Handle<Mesh>, facade::Time) -> (Assets<Mesh>, Handle<Mesh>, Time) =
                |assets, handle, time| (assets, handle, time);

            /// A scene as the README writes it.
            pub(super) fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
                let sphere = meshes.add(UvSphere::default());
                commands.spawn((Mesh3d(sphere), Material::BRASS, Transform::from_translation(Vec3::X)));
            }

            pub(super) fn count(objects: Query<&Transform, (With<Mesh3d>, Without<Camera>)>) -> usize {
                objects.iter().filter(|transform| transform.translation == Vec3::X).count()
            }
        }
    };
}

beside!(with_ecs: bevy_ecs::prelude);
beside!(with_app: bevy_app::prelude);
beside!(with_math: bevy_math::prelude);
beside!(with_transform: bevy_transform::prelude);
beside!(with_color_and_time: bevy_color::prelude, bevy_time::prelude);
beside!(with_all: bevy_ecs::prelude, bevy_app::prelude, bevy_math::prelude, bevy_transform::prelude, bevy_color::prelude,
    bevy_time::prelude);

#[test]
fn a_scene_is_the_same_under_every_pair_of_preludes() {
    use bevy_ecs::system::RunSystemOnce;
    use facade::*;

    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::reference());
    let world = app.world_mut();
    let mut objects = 0;
    macro_rules! run {
        ($($module:ident)*) => {
            $(
                world.run_system_once($module::scene).expect("meshes are assets");
                objects += 1;
                assert_eq!(world.run_system_once($module::count).expect("it asks for entities"), objects);
            )*
        };
    }
    run! { with_ecs with_app with_math with_transform with_color_and_time with_all }
}

//! The renderer in Apps of other shapes than the facade's.

use crate::render::compare::assert_identical;
use crate::render::scene::{Lamp, Scene, Thing, point_light};
use crate::render::stage::Stage;
use bevy_ecs::schedule::ScheduleLabel;
use bevy_transform::TransformSystems;
use bevy_transform::systems::{
    StaticTransformOptimizations, mark_dirty_trees, propagate_parent_transforms, sync_simple_transforms,
};
use halfway::prelude::*;
use image::Rgba32FImage;

const SIZE: UVec2 = UVec2::new(24, 24);

fn ball() -> Scene {
    Scene::seen_from(Vec3::new(1.0, 1.0, 3.0), Vec3::ZERO)
        .with(Thing::new(UvSphere::new(1.0, 12, 6)).named("ball"))
        .lit(Lamp::point(point_light(), Vec3::new(2.0, 2.0, 2.0)))
}

fn expected() -> Rgba32FImage {
    Stage::new(SIZE.x, SIZE.y).draw(&ball())
}

/// Spawns [`ball`] by hand, as an App without the facade would.
fn spawn(world: &mut World) {
    let scene = ball();
    let mesh = world.resource_mut::<Assets<Mesh>>().add(scene.things[0].mesh.clone());
    world.insert_resource(Headless { size: SIZE, pixels: Pixels::Float });
    world.insert_resource(GlobalAmbient(scene.ambient));
    world.spawn((scene.camera, scene.eye));
    world.spawn((Mesh3d(mesh), scene.things[0].material));
    world.spawn((point_light(), scene.lamps[0].at));
}

fn float(app: &mut App) -> Rgba32FImage {
    match render_picture(app) {
        Ok(Picture::Float(image)) => image,
        Ok(Picture::Byte(_)) => panic!("bytes"),
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn the_render_plugin_works_with_transforms_alone() {
    let mut app = App::new();
    app.add_plugins((TransformPlugin, RenderPlugin::default()));
    spawn(app.world_mut());
    assert_identical("TransformPlugin and RenderPlugin", &expected(), &float(&mut app));
}

#[test]
fn plugins_may_come_in_any_order() {
    let mut app = App::new();
    app.add_plugins(RenderPlugin::default());
    app.add_plugins((LightingPlugin, MeshPlugin, TransformPlugin));
    spawn(app.world_mut());
    assert_identical("RenderPlugin first", &expected(), &float(&mut app));
}

#[test]
fn a_finished_app_draws_the_same() {
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::headless(SIZE));
    app.finish();
    app.cleanup();
    spawn(app.world_mut());
    assert_identical("finished", &expected(), &float(&mut app));
}

/// A schedule that the App knows nothing of.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
struct Paint;

/// An App that draws when its own `Update` asks for it.
fn in_own_schedule() -> App {
    let mut app = App::new();
    app.add_plugins(RenderPlugin { schedule: Paint.intern() });
    app.init_resource::<StaticTransformOptimizations>();
    let propagate = (mark_dirty_trees, propagate_parent_transforms, sync_simple_transforms);
    app.add_systems(Paint, propagate.chain().in_set(TransformSystems::Propagate));
    app
}

#[test]
fn the_renderer_may_run_in_a_schedule_of_the_apps_own() {
    let mut app = in_own_schedule();
    spawn(app.world_mut());
    app.update();
    assert_eq!(app.world().resource::<FrameReport>().objects, 0, "drawn without being asked");
    app.add_systems(Update, |world: &mut World| world.run_schedule(Paint));
    assert_identical("in a schedule of its own", &expected(), &float(&mut app));
}

#[test]
fn a_replaced_mesh_shows_at_once_in_every_app() {
    // The renderer learns of it by messages, whose order to the frame must not depend on the App.
    let cuboid = Mesh::from(Cuboid::new(1.9, 1.0, 1.0));
    let mut of_cuboid = ball();
    of_cuboid.things[0].mesh = cuboid.clone();
    let expected = Stage::new(SIZE.x, SIZE.y).draw(&of_cuboid);
    let apps: [(&str, fn() -> App); 4] = [
        ("the facade", || {
            let mut app = App::new();
            app.add_plugins(HalfwayPlugins::headless(SIZE));
            app
        }),
        ("RenderPlugin first", || {
            let mut app = App::new();
            app.add_plugins((RenderPlugin::default(), LightingPlugin, MeshPlugin, TransformPlugin));
            app
        }),
        ("RenderPlugin last", || {
            let mut app = App::new();
            app.add_plugins((TransformPlugin, LightingPlugin, MeshPlugin, RenderPlugin::default()));
            app
        }),
        ("a schedule of its own", || {
            let mut app = in_own_schedule();
            app.add_systems(Update, |world: &mut World| world.run_schedule(Paint));
            app
        }),
    ];
    let mut late = Vec::new();
    for (row, app) in apps {
        let mut app = app();
        spawn(app.world_mut());
        float(&mut app);
        let world = app.world_mut();
        let handle = world.query::<&Mesh3d>().single(world).expect("one object").0.clone();
        *world.resource_mut::<Assets<Mesh>>().get_mut(&handle).expect("it is there") = cuboid.clone();
        if float(&mut app) != expected {
            late.push(row);
        }
    }
    assert!(late.is_empty(), "the old mesh is drawn once more with {late:?}");
}

#[test]
fn two_apps_draw_side_by_side() {
    let (mut a, mut b) = (Stage::new(SIZE.x, SIZE.y), Stage::new(SIZE.x, SIZE.y));
    a.set(&ball());
    b.set(&Scene { things: vec![], ..ball() });
    for _ in 0..2 {
        let (full, empty) = (a.float(), b.float());
        assert_identical("the first App", &expected(), &full);
        assert!(empty.pixels().all(|pixel| pixel.0[0] == 0.0));
    }
}

#[test]
fn a_scene_may_be_spawned_by_a_startup_system() {
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::headless(SIZE));
    app.add_systems(Startup, spawn);
    assert_identical("a Startup system", &expected(), &float(&mut app));
}

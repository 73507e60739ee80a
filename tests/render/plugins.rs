//! The renderer in Apps built differently from the facade's.

use crate::render::compare::assert_identical;
use crate::render::scene::{Lamp, Scene, Thing, point_light};
use crate::render::stage::Stage;
use bevy_ecs::schedule::ScheduleLabel;
use bevy_transform::TransformSystems;
use bevy_transform::systems::{
    StaticTransformOptimizations, mark_dirty_trees, propagate_parent_transforms, sync_simple_transforms,
};
use halfway::prelude::*;
use halfway::reference::{Oracle, OracleError};
use halfway::render::{Adapter, RenderError};
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

/// All orders of N things.
fn orders(count: usize) -> Vec<Vec<usize>> {
    if count == 0 {
        return vec![vec![]];
    }
    let insert_last = |order: Vec<usize>| {
        (0..count).map(move |at| [&order[..at], &[count - 1], &order[at..]].concat()).collect::<Vec<_>>()
    };
    orders(count - 1).into_iter().flat_map(insert_last).collect()
}

/// The plugins that draw, by name.
const PLUGINS: &[(&str, fn(&mut App) -> &mut App)] = &[
    ("RenderPlugin", |app| app.add_plugins(RenderPlugin::default())),
    ("LightingPlugin", |app| app.add_plugins(LightingPlugin)),
    ("MeshPlugin", |app| app.add_plugins(MeshPlugin)),
    ("TransformPlugin", |app| app.add_plugins(TransformPlugin)),
    #[cfg(feature = "window")]
    ("WindowPlugin", |app| app.add_plugins(WindowPlugin::default())),
];

/// An App with the plugins in this order and the scene at a place among them, and what was added, in words.
fn app_in(order: &[usize], scene_at: usize) -> (App, String) {
    let mut app = App::new();
    let mut row = Vec::new();
    for at in 0..=order.len() {
        if at == scene_at {
            app.world_mut().init_resource::<Assets<Mesh>>();
            spawn(app.world_mut());
            row.push("the scene");
        }
        if let Some(&plugin) = order.get(at) {
            let (name, add) = PLUGINS[plugin];
            add(&mut app);
            row.push(name);
        }
    }
    (app, row.join(", "))
}

#[test]
fn plugins_may_come_in_any_order_before_and_after_the_scene() {
    let expected = expected();
    let cuboid = Mesh::from(Cuboid::new(1.9, 1.0, 1.0));
    let mut of_cuboid = ball();
    of_cuboid.things[0].mesh = cuboid.clone();
    let expected_cuboid = Stage::new(SIZE.x, SIZE.y).draw(&of_cuboid);
    // One adapter for all, as opening it takes longest.
    let mut adapter: Option<Adapter> = None;
    for (number, order) in orders(PLUGINS.len()).into_iter().enumerate() {
        let (mut app, row) = app_in(&order, number % (PLUGINS.len() + 1));
        if let Some(adapter) = &adapter {
            adapter.clone().insert_into(app.world_mut());
        }
        app.finish();
        app.cleanup();
        assert_identical(&row, &expected, &float(&mut app));
        adapter = adapter.or_else(|| Adapter::from_world(app.world()));

        // The assets that the systems hold are those that the renderer watches.
        let world = app.world_mut();
        let handle = world.query::<&Mesh3d>().single(world).expect("one object").0.clone();
        *world.resource_mut::<Assets<Mesh>>().get_mut(&handle).expect("it is there") = cuboid.clone();
        assert_identical(&format!("{row}, another mesh"), &expected_cuboid, &float(&mut app));
    }
}

#[test]
fn plugins_that_are_there_already_may_come_again() {
    let mut app = App::new();
    app.add_plugins((MeshPlugin, LightingPlugin, HalfwayPlugins::headless(SIZE)));
    spawn(app.world_mut());
    app.add_plugins((LightingPlugin, MeshPlugin));
    assert_identical("before a frame", &expected(), &float(&mut app));
    app.add_plugins((LightingPlugin, MeshPlugin));
    assert_identical("after a frame", &expected(), &float(&mut app));
}

#[test]
fn the_group_keeps_what_is_there() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, bevy_time::TimePlugin));
    app.add_plugins(HalfwayPlugins::headless(SIZE));
    spawn(app.world_mut());
    assert_identical("after the plugins of bevy", &expected(), &float(&mut app));
}

#[test]
fn objects_from_before_the_renderer_get_what_they_lack() {
    let mut app = App::new();
    app.add_plugins((TransformPlugin, MeshPlugin));
    let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(UvSphere::new(1.0, 12, 6));
    let early = app.world_mut().spawn(Mesh3d(mesh.clone())).id();
    app.add_plugins(RenderPlugin::default());
    app.insert_resource(Headless { size: SIZE, pixels: Pixels::Float });
    app.world_mut().spawn((Camera::default(), Transform::from_xyz(0.0, 0.0, 4.0)));
    let late = app.world_mut().spawn((Mesh3d(mesh), Material::BRASS)).id();
    for _ in 0..2 {
        float(&mut app);
        // Two materials, which are looked up.
        assert_eq!(app.world().resource::<FrameReport>().draws, 1);
    }
    assert_eq!(app.world().get::<Material>(early), Some(&Material::DEFAULT));
    assert_eq!(app.world().get::<Material>(late), Some(&Material::BRASS), "its own stays");
}

fn frame_errors(app: &mut App) -> Vec<RenderError> {
    app.update();
    app.world().resource::<FrameReport>().errors.clone()
}

fn not_propagated(errors: &[RenderError]) -> bool {
    matches!(errors, [RenderError::NotPropagated { .. }])
}

#[test]
fn transforms_that_nothing_propagates_are_an_error() {
    let mut app = App::new();
    app.add_plugins(RenderPlugin::default());
    spawn(app.world_mut());
    for _ in 0..2 {
        let errors = frame_errors(&mut app);
        assert!(not_propagated(&errors), "{errors:?}");
        assert!(errors[0].to_string().contains("TransformPlugin"), "{}", errors[0]);
        assert_eq!(app.world().resource::<FrameReport>().draws, 0, "nothing is drawn at the origin");
    }
    let refused = Oracle::new(app.world_mut(), SIZE).expect_err("the oracle says so, too");
    assert!(matches!(refused, OracleError::NotPropagated { .. }), "{refused}");
    app.add_plugins(TransformPlugin);
    assert_identical("propagated now", &expected(), &float(&mut app));
    assert!(Oracle::new(app.world_mut(), SIZE).is_ok());
}

#[test]
fn transforms_may_be_the_identity_or_written_by_hand() {
    let mut app = App::new();
    app.add_plugins(RenderPlugin::default());
    app.world_mut().spawn(Camera::default());
    assert_eq!(frame_errors(&mut app), [], "everything is at the origin, and is meant to be");

    let mut app = App::new();
    app.add_plugins(RenderPlugin::default());
    spawn(app.world_mut());
    let world = app.world_mut();
    for (transform, mut global) in world.query::<(&Transform, &mut GlobalTransform)>().iter_mut(world) {
        *global = (*transform).into();
    }
    assert_identical("by hand", &expected(), &float(&mut app));
}

#[test]
fn one_object_that_comes_after_propagation_is_no_error() {
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::headless(SIZE));
    spawn(app.world_mut());
    let late = |mut commands: Commands| {
        commands.spawn((Transform::from_xyz(1.0, 0.0, 0.0), point_light()));
    };
    app.add_systems(PostUpdate, late.after(TransformSystems::Propagate).before(RenderSet::View));
    for _ in 0..3 {
        assert_eq!(frame_errors(&mut app), []);
    }
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

/// A schedule that the App does not run by itself.
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

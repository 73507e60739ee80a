//! What windows show beside what the drawer draws: lines, legends, and what lies behind surfaces.

use crate::render::scene::{Lamp, Scene, Thing, directional_light, material, rotated};
use crate::render::stage::Stage;
use halfway::lighting::{Edges, Legend, Load, Show, Viewport, WhichEdges};
use halfway::prelude::*;
use halfway::render::{Canvas, CanvasTarget, WindowPicture, take_picture};
use image::RgbaImage;

/// With room for a legend.
const SIZE: UVec2 = UVec2::new(180, 130);

fn scene() -> Scene {
    Scene::seen_from(Vec3::new(0.4, 1.4, 3.2), Vec3::ZERO)
        .ambient(0.15)
        .with(Thing::new(Cuboid::default()).at(rotated(0.4, 0.6, 0.2)).with_material(material()))
        .lit(Lamp::directional(directional_light(), Vec3::new(0.7, -1.0, -0.2)))
}

/// The scene on the CPU with one addition, and its camera.
fn stage(add: fn(&mut World, Entity)) -> Stage {
    let mut stage = Stage::on_the_cpu(SIZE.x, SIZE.y);
    stage.set(&scene());
    let world = stage.world();
    let camera = world.query_filtered::<Entity, With<Camera>>().single(world).expect("a camera");
    add(world, camera);
    stage.pixels(Pixels::Byte);
    stage
}

fn taken(add: fn(&mut World, Entity)) -> RgbaImage {
    match take_picture(stage(add).world()).unwrap_or_else(|error| panic!("{error}")) {
        Picture::Byte(picture) => picture,
        Picture::Float(_) => panic!("not bytes"),
    }
}

/// What a window shows, with a name.
type Addition = (&'static str, fn(&mut World, Entity));

const ADDITIONS: [Addition; 5] = [
    ("edges", |world, camera| {
        world.entity_mut(camera).insert(Edges::new(WhichEdges::SHARP));
    }),
    ("show", |world, camera| {
        world.entity_mut(camera).insert(Show { axes: true, grid: true, ..Show::default() });
    }),
    ("gradient", |world, camera| {
        world.get_mut::<Camera>(camera).expect("a camera").background_below = Some(LinearRgba::rgb(0.8, 0.1, 0.0));
    }),
    ("legend", |world, _| {
        let colors = (0..=255).map(|level| [level; 3]).collect();
        world.insert_resource(Legend { title: "height".into(), range: [-1.0, 3.0], colors });
    }),
    ("keeps", |world, camera| {
        let bundle = (*world.get::<Camera>(camera).expect("a camera"), Transform::from_xyz(1.0, 2.0, 4.0));
        let kept = Viewport { load: Load::Keep, ..Viewport::fractions([0.0, 0.0, 1.0, 1.0]).with_order(1) };
        world.entity_mut(camera).insert(Viewport::fractions([0.0, 0.0, 1.0, 1.0]));
        let above = bundle.1.looking_at(Vec3::ZERO, Vec3::Y);
        world.spawn((bundle.0, above, kept));
    }),
];

#[test]
fn a_window_shows_what_pictures_have() {
    let plain = taken(|_, _| ());
    for (name, add) in ADDITIONS {
        let expected = taken(add);
        assert!(expected != plain, "{name} changes nothing");
        let mut stage = stage(add);
        stage.world().insert_resource(CanvasTarget { size: SIZE });
        stage.world().init_resource::<WindowPicture>();
        for _ in 0..2 {
            assert_eq!(stage.frame().errors, [], "{name}");
            let (size, bytes) = stage.app.world().resource::<Canvas>().bytes().expect("a frame");
            assert!(size == SIZE && bytes == &expected.as_raw()[..], "{name}");
            let kept = &stage.app.world().resource::<WindowPicture>().0;
            assert!(kept.as_ref() == Some(&expected), "{name}: what is kept");
        }
    }
}

#[test]
fn a_window_is_opaque() {
    let mut stage = stage(|world, camera| {
        let mut camera = world.get_mut::<Camera>(camera).expect("a camera");
        camera.background = LinearRgba::rgb(0.2, 0.9, 0.4);
        camera.background_opacity = 0.0;
    });
    stage.world().insert_resource(CanvasTarget { size: SIZE });
    stage.world().init_resource::<WindowPicture>();
    stage.frame();
    let kept = stage.app.world().resource::<WindowPicture>().0.clone().expect("a picture");
    assert_eq!(kept.get_pixel(0, 0).0[3], 255);
    assert_eq!(kept.get_pixel(0, 0).0[1], 243, "the background's own green");
}

#[test]
fn what_cannot_be_drawn_is_an_error_and_the_rest_is_shown() {
    let invalid = Edges { opacity: 2.0, ..Edges::new(WhichEdges::All) };
    let mut stage = stage(|_, _| ());
    let world = stage.world();
    let camera = world.query_filtered::<Entity, With<Camera>>().single(world).expect("a camera");
    world.entity_mut(camera).insert(invalid);
    world.insert_resource(CanvasTarget { size: SIZE });
    let errors = stage.frame().errors.clone();
    assert!(errors.len() == 1 && errors[0].to_string().contains("Edges.opacity"), "{errors:?}");
    let (_, bytes) = stage.app.world().resource::<Canvas>().bytes().expect("a frame");
    assert!(bytes == &taken(|_, _| ()).as_raw()[..]);
}

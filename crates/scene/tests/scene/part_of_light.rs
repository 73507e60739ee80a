//! A part of a scene's light as components.

use std::path::Path;

use bevy_color::LinearRgba;
use bevy_time::TimePlugin;
use halfway_lighting::{Camera, GlobalAmbient, HemisphereLight, Material, PointLight, Term, Visibility};
use halfway_scene::{AnimationPlugin, LightSource, PartOfLight, SceneError, SceneFile, SceneTime, spawn};

use crate::spawned::app;

const SCENE: &str = r#"{
  "background": [0.1, 0.2, 0.3], "ambient": [0.4, 0.5, 0.6],
  "lights": [
    {"kind": "point", "name": "lamp", "ambient": [0.1, 0, 0],
     "animation": [{"of": "diffuse", "keys": [[0, [1, 0, 0]], [2, [0, 1, 0]]]}]},
    {"kind": "hemisphere"}
  ],
  "objects": [
    {"mesh": {"box": {}}, "material": "brass"},
    {"mesh": {"box": {}}, "material": "brass", "shading": "unlit"}
  ]
}"#;

fn scene(more: &str) -> SceneFile {
    SceneFile::from_json(&SCENE.replacen('{', &format!("{{{more}"), 1), "test").unwrap()
}

#[test]
fn components_are_those_of_the_part_and_come_back() {
    let mut app = app();
    app.add_plugins((TimePlugin, AnimationPlugin));
    let spawned = spawn(&scene(""), Path::new(""), app.world_mut()).unwrap();
    let [lit, unlit] = spawned.objects[..] else { panic!("two objects") };
    let [lamp, sky] = spawned.lights[..] else { panic!("two lights") };
    let black = LinearRgba::BLACK;
    let (brass, dark) = (Material::BRASS, Material { diffuse: black, ..Material::BRASS });
    let none = Material { ambient: black, diffuse: black, specular: black, emission: black, ..brass };
    for (term, source, materials, background, ambient) in [
        (None, LightSource::Anywhere, [brass, brass], true, true),
        (Some(Term::Ambient), LightSource::Anywhere, [Material { specular: black, ..brass }, brass], false, true),
        (Some(Term::Diffuse), LightSource::Anywhere, [Material { diffuse: brass.diffuse, ..none }, dark], false, true),
        (
            Some(Term::Specular),
            LightSource::NoLight,
            [Material { specular: brass.specular, ..none }, dark],
            false,
            true,
        ),
        (Some(Term::Emission), LightSource::NoLight, [none, dark], true, true),
        (None, LightSource::Light(1), [brass, dark], false, false),
        (None, LightSource::Anywhere, [brass, brass], true, true),
    ] {
        spawned.show_light(PartOfLight { term, source }, app.world_mut());
        app.insert_resource(SceneTime::At(1.0));
        app.update();
        let world = app.world();
        assert_eq!(
            [lit, unlit].map(|object| *world.get::<Material>(object).unwrap()),
            materials,
            "{term:?} {source:?}"
        );
        let seen = world.get::<Camera>(spawned.camera).unwrap().background;
        assert_eq!(seen, if background { LinearRgba::rgb(0.1, 0.2, 0.3) } else { black }, "{term:?} {source:?}");
        assert_eq!(world.resource::<GlobalAmbient>().0 != black, ambient, "{term:?} {source:?}");
        // The animation goes on in every part that it belongs to.
        let halfway = if term == Some(Term::Ambient) { black } else { LinearRgba::rgb(0.5, 0.5, 0.0) };
        let light = world.get::<PointLight>(lamp).unwrap();
        assert_eq!((light.ambient, light.diffuse), (LinearRgba::rgb(0.1, 0.0, 0.0), halfway), "{term:?} {source:?}");
        assert_eq!(world.get::<HemisphereLight>(sky).unwrap().sky == black, term == Some(Term::Ambient));
        let hidden = [lamp, sky].map(|light| world.get::<Visibility>(light) == Some(&Visibility::Hidden));
        let expected = match source {
            LightSource::Anywhere => [false, false],
            LightSource::Light(place) => [place != 0, place != 1],
            LightSource::NoLight => [true, true],
        };
        assert_eq!(hidden, expected, "{term:?} {source:?}");
    }
}

#[test]
fn the_keys_of_a_file_show_a_part_and_another_scene_is_whole() {
    let mut app = app();
    let text = r#""only": "diffuse", "light": "lights[1]","#;
    let first = spawn(&scene(text), Path::new(""), app.world_mut()).unwrap();
    let of = |app: &bevy_app::App, entity| *app.world().get::<Material>(entity).unwrap();
    assert_eq!(of(&app, first.objects[0]).specular, LinearRgba::BLACK);
    assert_eq!(app.world().get::<Visibility>(first.lights[0]), Some(&Visibility::Hidden));
    let second = spawn(&scene(r#""only": "specular","#), Path::new(""), app.world_mut()).unwrap();
    assert_eq!(of(&app, second.objects[0]).specular, Material::BRASS.specular);
    second.show_light(PartOfLight::default(), app.world_mut());
    assert_eq!(of(&app, second.objects[0]), Material::BRASS);
    assert_eq!(SceneFile::from_json(&scene(text).to_json().unwrap(), "test").unwrap(), scene(text));
}

#[test]
fn lights_that_there_are_not_are_refused() {
    for (wanted, expected) in [
        (r#""light": "lmap","#, "no light is called \"lmap\"; there are 0 \"lamp\", 1"),
        (r#""light": 2,"#, "no light is called \"2\"; there are 0 \"lamp\", 1"),
    ] {
        let mut app = app();
        let error = spawn(&scene(wanted), Path::new(""), app.world_mut()).unwrap_err();
        assert!(matches!(error, SceneError::NoLight { .. }) && error.to_string() == expected, "{error}");
        assert_eq!(app.world_mut().query::<&Camera>().iter(app.world()).count(), 0, "nothing is spawned");
    }
    let text = SCENE.replacen('{', r#"{"only": "emission", "light": 0,"#, 1);
    let error = SceneFile::from_json(&text, "test").unwrap_err().to_string();
    assert!(error.contains("only") && error.contains("belongs to no light"), "{error}");
}

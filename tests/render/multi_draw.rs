//! Draws that share their state as one command: the same picture by fewer commands.

use crate::render::compare::{assert_identical, difference};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, material, other_material, point_light, rotated};
use crate::render::stage::Stage;
use halfway::prelude::*;
use halfway::render::{Gpu, wgpu};

/// What one draw takes in the buffer that a command reads.
const DRAW_BYTES: u64 = 20;

/// Has draws that share their state be one command, or one each; returns whether they are.
fn set_multi_draw(stage: &mut Stage, wanted: bool) -> bool {
    set_multi_draw_from(stage, wanted.then_some(2))
}

fn set_multi_draw_from(stage: &mut Stage, from: Option<u32>) -> bool {
    let mut gpu = stage.world().resource_mut::<Gpu>();
    gpu.set_multi_draw(from);
    let flags = gpu.adapter.get_downlevel_capabilities().flags;
    let can = gpu.device.features().contains(wgpu::Features::INDIRECT_FIRST_INSTANCE)
        && flags.contains(wgpu::DownlevelFlags::INDIRECT_EXECUTION);
    assert_eq!(gpu.multi_draw(), from.filter(|_| can));
    gpu.multi_draw().is_some()
}

fn lit(scene: Scene) -> Scene {
    scene
        .ambient(0.1)
        .lit(Lamp::point(point_light(), Vec3::new(1.0, 3.0, 4.0)))
        .lit(Lamp::directional(directional_light(), Vec3::new(-0.4, -0.5, -1.0)))
}

/// Of 12,096 triangles, in hundreds of patches.
fn large() -> Mesh {
    UvSphere::new(1.0, 96, 64).into()
}

/// From so near that a part of the scene is outside.
fn near() -> Scene {
    lit(Scene::seen_from(Vec3::new(0.3, 0.4, 3.0), Vec3::ZERO))
}

/// Two large meshes of three materials that reach out of the picture, small things among them, and some to look
/// through.
fn many_kinds(shading: Shading) -> Scene {
    let mut scene = near();
    scene.view_shading = Some(shading);
    for i in 0..4u8 {
        let at = Vec3::new(f32::from(i) - 1.6, 0.4 * f32::from(i % 2), -0.9 * f32::from(i));
        let thing = Thing::new(large()).at(rotated(0.3, 0.2, f32::from(i)).with_translation(at));
        let thing = thing.of([material(), other_material(), Material::BRASS, material()][usize::from(i)]);
        scene = scene.with(thing.faces([Faces::Front, Faces::Both][usize::from(i / 3)]).back(other_material()));
    }
    let wall = Thing::new(Plane { size: 9.0, divisions: 64 }).at(Transform::from_xyz(0.0, -1.2, 0.0));
    scene = scene.with(wall.of(other_material()));
    for i in 0..6u8 {
        let at = Vec3::new(0.5 * f32::from(i) - 1.4, -0.4, 1.2 - 0.3 * f32::from(i));
        let mesh = if i % 2 == 0 { large() } else { UvSphere::new(1.0, 12, 8).into() };
        let thing = Thing::new(mesh).at(Transform::from_translation(at).with_scale(Vec3::splat(0.4)));
        scene = scene.with(thing.blended(0.6).faces(if i % 3 == 0 { Faces::Both } else { Faces::Front }));
    }
    scene
}

/// With more lights than are compiled in, so that patches have lists of their own.
fn many_lights(mut scene: Scene) -> Scene {
    for i in 0..20u8 {
        let at = Vec3::new(0.4 * f32::from(i % 5) - 0.8, 1.3, 0.5 * f32::from(i / 5) - 0.5);
        let light = PointLight { range: Some(1.0), ..PointLight::from_color(LinearRgba::rgb(0.1, 0.2, 0.15)) };
        scene = scene.lit(Lamp::point(light, at));
    }
    scene
}

#[test]
fn multi_draw_changes_no_pixel() {
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        for (lights, scene) in [("two", many_kinds(shading)), ("many", many_lights(many_kinds(shading)))] {
            let row = format!("{shading:?}, {lights} lights");
            // Of its own, so that no pipelines of other rows keep this one's from being specialised.
            let mut stage = Stage::new(64, 48);
            stage.draw(&scene);
            set_multi_draw(&mut stage, false);
            let (direct_bytes, direct, draws) = (stage.bytes(), stage.float(), stage.report().draws);
            let can = set_multi_draw(&mut stage, true);
            let (multi_bytes, multi) = (stage.bytes(), stage.float());
            let report = stage.report();
            println!("{row}: {draws} draws, {} by multi-draw", report.draws);
            assert!(report.patches_culled > 300, "{row}: {report:?}");
            // Where each patch is a draw with lights bound for it, few share their state.
            let most = if lights == "many" && stage.costs().lights_at_fixed_places { draws } else { draws * 3 / 4 };
            assert!(if can { report.draws < most } else { report.draws == draws }, "{row}: {draws}, {report:?}");
            if stage.costs().records_of_one_command > 3 {
                assert_identical(&row, &direct, &multi);
                assert_eq!(direct_bytes, multi_bytes, "{row}");
            } else {
                // There draws of one command look their materials up, and a driver may round the other shader
                // otherwise.
                assert!(difference(&direct, &multi) < 1e-5, "{row}: {}", difference(&direct, &multi));
            }
            set_multi_draw(&mut stage, false);
            assert_identical(&format!("{row}, draw by draw again"), &direct, &stage.float());
            assert_eq!(stage.report().draws, draws, "{row}");
        }
    }
}

/// Spheres nearby and much farther, so that `levels` of them are drawn.
fn in_levels(levels: u8, change: impl Fn(u8, Thing) -> Thing) -> Scene {
    let mut scene = lit(Scene::seen_from(Vec3::ZERO, Vec3::NEG_Z));
    scene.view_shading = Some(Shading::Gouraud);
    for i in 0..3 * levels {
        let distance = 3.0 * 6f32.powi((i / 3).into());
        let at = Vec3::new(0.2 * f32::from(i % 3) - 0.2, 0.0, -1.0) * distance;
        scene = scene.with(change(i, Thing::new(UvSphere::new(1.0, 64, 32)).at(Transform::from_translation(at))));
    }
    scene
}

#[test]
fn a_draw_is_a_command() {
    let mut stage = Stage::new(64, 48);
    stage.draw(&near());
    let plain = |_, thing| thing;
    let painted = |i: u8, mut thing: Thing| {
        thing.material.emission.red = 0.1 * f32::from(i % 2);
        thing
    };
    let on_software = stage.costs().records_of_one_command > 2;
    // Without multi-draw, and with it. A software adapter looks few materials up, so that both levels come by turns
    // with one and the other.
    let of = |software, hardware| if on_software { software } else { hardware };
    let rows: [(&str, Scene, u32, u32); 5] = [
        ("one level", in_levels(1, plain), 1, 1),
        ("two levels", in_levels(2, plain), 2, 1),
        ("three levels", in_levels(3, plain), 3, 1),
        ("two levels and another mesh", in_levels(2, plain).with(Thing::new(Cuboid::default())), 3, 2),
        ("two levels of two materials", in_levels(2, painted), of(4, 2), of(4, 1)),
    ];
    for (row, scene, direct, multi) in rows {
        stage.set(&scene);
        stage.levels(Tolerance::DEFAULT);
        for (wanted, draws) in [(false, direct), (true, multi), (false, direct)] {
            let expected = if set_multi_draw(&mut stage, wanted) { draws } else { direct };
            let report = stage.frame();
            assert_eq!((report.draws, report.errors.len()), (expected, 0), "{row}, multi-draw {wanted}: {report:?}");
        }
    }
}

#[test]
fn few_draws_are_a_command_each() {
    let mut stage = Stage::new(64, 48);
    stage.set(&in_levels(3, |_, thing| thing));
    stage.levels(Tolerance::DEFAULT);
    // Three draws; and a single one may be read as well.
    for (from, draws) in [(0, 1), (1, 1), (2, 1), (3, 1), (4, 3), (u32::MAX, 3)] {
        let expected = if set_multi_draw_from(&mut stage, Some(from)) { draws } else { 3 };
        let report = stage.frame();
        assert_eq!((report.draws, report.errors.len()), (expected, 0), "from {from} on: {report:?}");
    }
    set_multi_draw_from(&mut stage, None);
    let scene = in_levels(1, |_, thing| thing);
    let direct = stage.draw(&scene);
    for from in 0..2 {
        set_multi_draw_from(&mut stage, Some(from));
        assert_identical("a single draw", &direct, &stage.float());
        assert_eq!(stage.report().draws, 1);
    }
}

#[test]
fn a_command_is_sent_once_what_it_draws() {
    let mut stage = Stage::new(64, 48);
    let scene = near().with(Thing::new(large()).of(material()));
    stage.draw(&scene);
    set_multi_draw(&mut stage, false);
    let draws = u64::from(stage.frame().draws);
    let can = set_multi_draw(&mut stage, true);
    let first = stage.frame().bytes_uploaded;
    assert!(draws > 4, "{draws} draws");
    assert_eq!(first, if can { draws * DRAW_BYTES } else { 0 }, "{draws} draws");
    for frame in 0..3 {
        assert_eq!(stage.frame().bytes_uploaded, 0, "frame {frame}");
    }
    // What is read is kept while nothing reads it.
    for wanted in [false, true] {
        set_multi_draw(&mut stage, wanted);
        assert_eq!(stage.frame().bytes_uploaded, 0, "multi-draw {wanted}");
    }
}

#[test]
fn only_hardware_has_it_unasked() {
    let mut stage = Stage::new(8, 8);
    stage.draw(&near());
    let gpu = stage.world().resource::<Gpu>();
    let native = wgpu::Features::INDIRECT_FIRST_INSTANCE | wgpu::Features::MULTI_DRAW_INDIRECT_COUNT;
    let has = gpu.adapter.features().contains(native) && !gpu.costs().shaders_encode;
    assert_eq!(gpu.multi_draw(), has.then_some(128));
}

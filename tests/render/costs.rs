//! Either way of drawing, that of software adapters and that of hardware, on whichever adapter there is.

use crate::render::compare::{FLOAT, Failures, SRGB};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, material, other_material, point_light};
use crate::render::stage::Stage;
use halfway::prelude::*;
use halfway::render::{Costs, Gpu};

/// Balls of two materials on a floor in patches; `many` lights are more than all patches need.
fn scene(shading: Shading, many: bool) -> Scene {
    let mut scene = Scene::seen_from(Vec3::new(0.0, 3.0, 6.0), Vec3::ZERO).ambient(0.1);
    scene.view_shading = Some(shading);
    scene = scene.with(Thing::new(Plane { size: 9.0, divisions: 64 }).of(other_material()));
    for i in 0..4u8 {
        let at = Vec3::new(1.5 * f32::from(i) - 2.2, 0.5, 0.3 * f32::from(i));
        let thing = Thing::new(UvSphere::new(0.5, 16, 8)).at(Transform::from_translation(at));
        scene = scene.with(thing.of([material(), Material::BRASS][usize::from(i % 2)]));
    }
    for i in 0..20u8 {
        let at = Vec3::new(2.0 * f32::from(i % 5) - 4.0, 1.0, 2.0 * f32::from(i / 5) - 4.0);
        let light = PointLight { range: Some(2.0), ..PointLight::from_color(LinearRgba::rgb(0.3, 0.2, 0.25)) };
        scene = if many { scene.lit(Lamp::point(light, at)) } else { scene };
    }
    scene
        .lit(Lamp::point(point_light(), Vec3::new(1.0, 3.0, 4.0)))
        .lit(Lamp::directional(directional_light(), Vec3::new(-0.4, -0.5, -1.0)))
}

#[test]
fn either_way_draws_what_the_oracle_says() {
    let mut failures = Failures::default();
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        for many in [false, true] {
            let mut counts = Vec::new();
            for costs in [Costs::SOFTWARE, Costs::HARDWARE] {
                let mut stage = Stage::new(60, 40);
                // The first frame opens the adapter.
                stage.draw(&scene(shading, many));
                stage.world().resource_mut::<Gpu>().set_costs(costs);
                let row = format!("{shading:?}, many: {many}, {costs:?}");
                failures.draw(&row, &mut stage, &scene(shading, many), FLOAT);
                stage.encode(Encoding::Srgb);
                let picture = stage.bytes();
                // What is left out of the lists may be half a step, and the curve of either way has a share of one.
                failures.compare_bytes(&row, &mut stage, &picture, SRGB);
                counts.push(stage.report().draws);
            }
            failures.unless(counts[0] != counts[1], || format!("{shading:?}, many: {many}: both ways are one"));
        }
    }
    failures.finish();
}

//! Images on objects: what they do is what the oracle says, and what does not have them pays nothing for them.

use crate::render::compare::FLOAT;
use crate::render::conformance::maps::map;
use crate::render::scene::{Lamp, Map, Scene, Thing, material, point_light};
use crate::render::stage::Stage;
use halfway::prelude::*;
use halfway::reference::Image;
use halfway::reference::metrics::judge;
use halfway::texture::{LevelFilter, Pyramid, TexelImage, UvTransform};

const SHADINGS: [Shading; 3] = [Shading::Flat, Shading::Gouraud, Shading::Phong];

fn scene(shading: Shading, map: Option<Map>) -> Scene {
    let thing = Thing { map, ..Thing::new(UvSphere::new(1.0, 24, 12)) };
    let mut scene = Scene::seen_from(Vec3::new(0.4, 1.0, 3.0), Vec3::ZERO)
        .ambient(0.2)
        .with(thing)
        .lit(Lamp::point(point_light(), Vec3::new(1.2, 1.6, 1.8)));
    scene.view_shading = Some(shading);
    scene
}

#[test]
fn a_map_on_a_mesh_without_coordinates_changes_no_bit_and_costs_no_byte() {
    for shading in SHADINGS {
        let drawn = [None, Some(map(Sampling::default(), UvTransform::default()))].map(|map| {
            let mut stage = Stage::new(64, 48);
            let mut scene = scene(shading, map);
            let mesh = &scene.things[0].mesh;
            let (positions, normals) = (mesh.positions().to_vec(), Some(mesh.normals().to_vec()));
            scene.things[0].mesh = Mesh::from_parts(positions, normals, None, mesh.indices().to_vec()).expect("a mesh");
            stage.set(&scene);
            let uploaded = stage.frame().bytes_uploaded;
            (stage.float(), uploaded, stage.report().pipelines)
        });
        assert!(drawn[0] == drawn[1], "{shading:?}: {:?} and {:?}", drawn[0].1, drawn[1].1);
    }
}

#[test]
fn an_image_of_one_color_is_another_material() {
    let even = TexelImage::from_fn(5, 3, |_, _| [0.25, 0.5, 1.0, 1.0]).expect("a small image");
    let times = |color: LinearRgba| LinearRgba::rgb(0.25 * color.red, 0.5 * color.green, color.blue);
    let own = Material { ambient: times(material().ambient), diffuse: times(material().diffuse), ..material() };
    let mut stage = Stage::new(64, 48);
    for shading in SHADINGS {
        let map = Map { image: even.clone(), sampling: Sampling::default(), transform: UvTransform::default() };
        let mapped = stage.draw(&scene(shading, Some(map)));
        let mut plain = scene(shading, None);
        plain.things[0].material = own;
        let plain = stage.draw(&plain);
        let most = mapped.iter().zip(plain.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(most < 2e-6, "{shading:?}: {most:e}");
    }
}

#[test]
fn a_picture_of_another_filter_place_or_image_is_found_out() {
    let mut stage = Stage::new(64, 48);
    let right = map(Sampling::default(), UvTransform { scale: [3.0, 3.0], ..UvTransform::default() });
    let moved = UvTransform { offset: [0.05, 0.0], ..right.transform };
    let wrongs = [
        Some(Map { sampling: Sampling::NEAREST, ..right.clone() }),
        Some(Map { transform: moved, ..right.clone() }),
        None,
    ];
    for (number, wrong) in wrongs.into_iter().enumerate() {
        let picture = stage.draw(&scene(Shading::Phong, wrong));
        stage.set(&scene(Shading::Phong, Some(right.clone())));
        stage.frame();
        let truth = stage.oracle();
        let verdict = judge(&truth, &truth.draw(), &Image::from_float(&picture), FLOAT).expect("one size");
        assert!(!verdict.is_within(), "{number}: {verdict}");
    }
}

#[test]
fn an_image_that_is_not_there_is_drawn_as_a_checker() {
    let mut stage = Stage::new(64, 48);
    let things = stage.set(&scene(Shading::Phong, None));
    stage.world().entity_mut(things[0]).insert(ColorMap::from(Handle::<Texture>::default()));
    let missing = stage.float();
    let texture = stage.world().resource_mut::<Assets<Texture>>().add(Texture(Pyramid::missing()));
    stage.world().entity_mut(things[0]).insert(ColorMap::from(texture));
    assert_eq!(missing, stage.float());
}

#[test]
fn coordinates_that_are_no_numbers_are_refused_by_name() {
    let mut stage = Stage::new(64, 48);
    let transform = UvTransform { rotation: f32::NAN, ..UvTransform::default() };
    stage.set(&scene(Shading::Phong, Some(map(Sampling::default(), transform))));
    let errors: Vec<String> = stage.frame().errors.iter().map(ToString::to_string).collect();
    assert!(errors.len() == 1 && errors[0].contains("ColorMap.transform.rotation: the value is NaN"), "{errors:?}");
}

#[test]
fn filters_by_the_footprints_shape_are_drawn_as_trilinear() {
    let mut stage = Stage::new(64, 48);
    let drawn = |stage: &mut Stage, levels| {
        let sampling = Sampling { levels, ..Sampling::default() };
        let transform = UvTransform { scale: [6.0, 2.0], ..UvTransform::default() };
        let picture = stage.draw(&scene(Shading::Phong, Some(map(sampling, transform))));
        (picture, stage.oracle().draw())
    };
    let (trilinear, judged) = drawn(&mut stage, LevelFilter::Linear);
    for levels in [LevelFilter::Ripmap, LevelFilter::SummedArea, LevelFilter::Anisotropic8, LevelFilter::Elliptical] {
        let (picture, truth) = drawn(&mut stage, levels);
        assert_eq!(picture, trilinear, "{levels:?}");
        // The oracle takes them as they are.
        assert_ne!(truth.pixels(), judged.pixels(), "{levels:?}");
    }
}

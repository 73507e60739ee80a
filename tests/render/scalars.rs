//! Numbers on meshes, shown by a colour map: against the map itself.

use crate::render::scene::{Scene, Thing};
use crate::render::stage::Stage;
use bevy_color::Srgba;
use halfway::prelude::*;
use halfway::scene::{ColorMap, Scalars};

/// A square from −2 to 2 that fills 40 pixels of a picture of 50, shown unlit.
fn shown(stage: &mut Stage, scalars: &Scalars) -> image::Rgba32FImage {
    let square =
        Thing::square(Vec3::new(0.0, 0.0, -5.0), Vec3::Z, 4.0).with_material(Material::matte(LinearRgba::WHITE));
    let (mesh, colors) = scalars.on(&square.mesh).unwrap_or_else(|error| panic!("{error}"));
    let scene = Scene { camera: Camera::orthographic(5.0), ..Scene::in_eye_space() };
    let thing = stage.set(&scene.with(Thing { mesh, ..square }))[0];
    let colors = stage.world().resource_mut::<Assets<Texture>>().add(colors);
    stage.world().entity_mut(thing).insert((Scalars::maps(MapKind::Color, colors), Shading::Unlit));
    stage.float()
}

fn linear([red, green, blue]: [u8; 3]) -> [f32; 3] {
    LinearRgba::from(Srgba::rgb_u8(red, green, blue)).to_f32_array_no_alpha()
}

#[test]
fn a_pixel_has_the_colour_of_its_number() {
    let mut stage = Stage::new(50, 50);
    let square = Mesh::from(Plane { size: 4.0, divisions: 1 });
    // x from −2 to 2, of which the map shows −1 to 1.
    let numbers: Vec<f32> = square.positions().iter().map(|p| p.x).collect();
    for map in [ColorMap::Viridis, ColorMap::BlueRed] {
        let scalars = Scalars { range: Some([-1.0, 1.0]), map, ..Scalars::at_vertices(numbers.clone()) };
        let picture = shown(&mut stage, &scalars);
        for x in 5..45 {
            let number = (f64::from(x) + 0.5 - 25.0) / 10.0;
            let expected = linear(map.at(0.5 * number + 0.5));
            let found = picture.get_pixel(x, 20).0;
            // A byte of the map's, and the step to the next of its 1000 texels.
            let same = (0..3).all(|c| (found[c] - expected[c]).abs() < 0.012);
            assert!(same, "{map:?}, {x}: {found:?} instead of {expected:?}");
        }
        assert_eq!(picture.get_pixel(2, 20).0, [0.0, 0.0, 0.0, 1.0]);
    }
}

#[test]
fn missing_numbers_and_lines_have_colours_of_their_own() {
    let mut stage = Stage::new(50, 50);
    let square = Mesh::from(Plane { size: 4.0, divisions: 1 });
    let missing = LinearRgba::rgb(0.25, 0.5, 0.75);
    let none = Scalars { missing, ..Scalars::at_vertices(vec![f32::NAN; 4]) };
    assert_eq!(shown(&mut stage, &none).get_pixel(25, 25).0, [0.25, 0.5, 0.75, 1.0]);
    // Three lines between −2 and 2: at −1, 0 and 1.
    let numbers = square.positions().iter().map(|p| p.x).collect();
    let plain = Scalars::at_vertices(numbers);
    let lined = Scalars { isolines: 3, ..plain.clone() };
    let [plain, lined] = [plain, lined].map(|scalars| shown(&mut stage, &scalars));
    let dark = (0..50).filter(|&x| lined.get_pixel(x, 20).0[1] < 0.9 * plain.get_pixel(x, 20).0[1]).collect::<Vec<_>>();
    // Pixels are wider than the lines: those at whole tens show one or not.
    assert!(dark.iter().all(|x| [14, 15, 24, 25, 34, 35].contains(x)), "{dark:?}");
    let mut stage = Stage::new(500, 500);
    let lined = Scalars { isolines: 3, ..Scalars::at_vertices(square.positions().iter().map(|p| p.x).collect()) };
    let lined = shown(&mut stage, &lined);
    for x in [150, 250, 350] {
        assert!(lined.get_pixel(x, 200).0[1] < 0.4 * lined.get_pixel(x + 20, 200).0[1], "{x}");
    }
}

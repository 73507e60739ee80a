//! `Shading::Auto`: whatever is moved to the vertices or left out, no pixel is off by more than the tolerance from what
//! the oracle shows of Phong shading under all lights.

use crate::render::compare::{FLOAT, Failures, SRGB, assert_identical, difference};
use crate::render::random::Random;
use crate::render::scene::{Lamp, Scene, Thing, directional_light, glowing, material, other_material, rotated, scaled};
use crate::render::stage::Stage;
use halfway::lighting::Frequency;
use halfway::mesh::{Tessellation, Torus, tessellate};
use halfway::prelude::*;
use halfway::render::{Costs, VertexPrices};

/// Steps of tolerance that are tried.
const STEPS: [f32; 5] = [0.5, 1.0, 2.0, 4.0, 8.0];

/// Where everything goes to the vertices that may, whatever it costs.
fn stage(width: u32, height: u32) -> Stage {
    let mut stage = Stage::new(width, height);
    stage.world().insert_resource(VertexPrices::FREE);
    stage
}

fn ball() -> Mesh {
    UvSphere::new(1.0, 192, 96).into()
}

fn ring() -> Mesh {
    let torus = Torus { radius: 0.75, tube: 0.25 };
    tessellate(&[&torus], Tessellation::Count { rows: 64, columns: 160 }).expect("a torus")
}

/// A thing at the origin, shaded automatically.
fn scene(thing: Thing) -> Scene {
    let mut scene = Scene::seen_from(Vec3::new(0.5, 0.8, 2.2), Vec3::ZERO).ambient(0.1).with(thing);
    scene.view_shading = Some(Shading::Auto);
    scene
}

fn white(brightness: f32) -> PointLight {
    PointLight::from_color(LinearRgba::rgb(brightness, brightness, brightness))
}

fn sun() -> Lamp {
    Lamp::directional(directional_light(), Vec3::new(-0.6, -0.7, -1.0))
}

fn spot(cutoff: f32, inner: Option<f32>, exponent: f32) -> Lamp {
    let light = SpotLight { light: white(0.9), cone: Cone { cutoff, inner, exponent } };
    Lamp::spot(light, Vec3::new(1.5, 2.0, 2.5), Vec3::new(-0.55, -0.65, -0.9))
}

/// All kinds of lights, and what they shine on: each moves some terms to the vertices, within some tolerance here.
fn scenes() -> Vec<(&'static str, Scene)> {
    let thing = || Thing::new(ball()).of(material());
    let attenuated = PointLight { attenuate_ambient: true, ambient: LinearRgba::rgb(0.2, 0.3, 0.1), ..white(0.8) };
    let inverse_square = PointLight { attenuation: Attenuation::INVERSE_SQUARE, ..white(3.0) };
    let ranged = PointLight { range: Some(4.0), attenuation: Attenuation::new(1.0, 0.1, 0.2), ..white(1.0) };
    let at = Vec3::new(1.6, 1.4, 2.0);
    let mut many = scene(thing());
    let mut random = Random(5);
    for _ in 0..20 {
        let at = Vec3::new(random.between(-4.0, 4.0), random.between(-4.0, 4.0), random.between(1.5, 4.0));
        many.lamps.push(Lamp::point(white(0.15), at));
    }
    let mut infinite = scene(thing()).lit(sun());
    infinite.camera.viewer = Viewer::Infinite;
    let inside = Thing::new(ring()).of(material()).back(other_material()).faces(Faces::Both);
    // In bytes most of it is white whatever else happens, in floating point it is not.
    let bright = Thing::new(ball()).of(Material { emission: LinearRgba::rgb(0.9, 0.8, 0.7), ..material() });
    // The far side covers fewer pixels.
    let far = Thing::new(Mesh::from(UvSphere::new(1.0, 80, 40))).of(material());
    vec![
        ("a directional light", scene(thing()).lit(sun())),
        ("an infinite viewer", infinite),
        ("Phong's highlight", scene(thing().reflecting(Reflectance::Phong)).lit(sun())),
        ("a matched exponent", scene(thing().reflecting(Reflectance::BlinnPhongMatched)).lit(sun())),
        ("a point light", scene(thing()).lit(Lamp::point(white(0.9), at))),
        ("an attenuated ambient", scene(thing()).lit(Lamp::point(attenuated, at))),
        ("the inverse square", scene(thing()).lit(Lamp::point(inverse_square, at))),
        ("a range", scene(thing()).lit(Lamp::point(ranged, at))),
        ("a wide spot", scene(thing()).lit(spot(1.2, None, 8.0))),
        ("a narrow spot", scene(thing()).lit(spot(0.3, None, 0.0)).lit(sun())),
        ("an inner cone", scene(thing()).lit(spot(0.5, Some(0.2), 2.0)).lit(sun())),
        ("both sides", scene(inside).lit(sun()).lit(Lamp::point(white(0.5), -at))),
        ("the back", scene(far.back(other_material()).faces(Faces::Back)).lit(sun())),
        ("a mirrored ring", scene(Thing::new(ring()).of(material()).at(scaled(-1.0, 1.0, 1.0))).lit(sun())),
        ("a turned ring", scene(Thing::new(ring()).of(material()).at(rotated(0.4, 0.5, 0.6))).lit(sun())),
        ("many lights", many),
        ("brighter than white", scene(bright).lit(sun())),
    ]
}

#[test]
fn auto_is_phong_within_the_tolerance() {
    let (mut stage, mut failures) = (stage(112, 96), Failures::default());
    for (name, scene) in scenes() {
        let (mut at_vertices, mut at_fragments) = (0, u64::MAX);
        for steps in STEPS {
            stage.world().insert_resource(ViewTolerance(Tolerance::steps(steps)));
            let row = format!("{name}, {steps} steps");
            let verdict = failures.draw(&row, &mut stage, &scene, FLOAT.within(steps.into()));
            let bytes = stage.bytes();
            let report = stage.report().clone();
            let of_bytes = failures.compare_bytes(&row, &mut stage, &bytes, SRGB.within(steps.into()));
            let spent = report.steps_spent;
            failures.unless(report.errors.is_empty(), || format!("{row}: {:?}", report.errors));
            failures.unless(spent <= f64::from(steps), || format!("{row}: {spent} steps spent"));
            at_vertices = at_vertices.max(report.terms_at_vertices);
            at_fragments = at_fragments.min(report.terms_at_fragments);
            println!(
                "{row}: {verdict}; {of_bytes}; {} at vertices, {} at fragments, {spent:.2} spent",
                report.terms_at_vertices, report.terms_at_fragments
            );
        }
        failures.unless(at_vertices > 0, || format!("{name}: nothing moved to the vertices"));
    }
    failures.finish();
}

/// What judges the rows above finds a picture that is off by a little more: Gouraud shading of the same.
#[test]
fn gouraud_is_not_phong_within_the_tolerance() {
    let mut stage = stage(112, 96);
    let coarse = || Thing::new(Mesh::from(UvSphere::new(1.0, 48, 24))).of(material());
    let mut gouraud = scene(coarse()).lit(sun());
    gouraud.view_shading = Some(Shading::Gouraud);
    let picture = stage.draw(&gouraud);
    let mut auto = scene(coarse()).lit(sun());
    auto.view_shading = Some(Shading::Auto);
    stage.set(&auto);
    stage.frame();
    let oracle = stage.oracle();
    let verdict = halfway::reference::metrics::judge(
        &oracle,
        &oracle.draw(),
        &halfway::reference::Image::from_float(&picture),
        FLOAT.within(1.0),
    );
    assert!(!verdict.expect("pictures of one size").is_within());
}

#[test]
fn an_exact_tolerance_draws_phong() {
    let mut stage = stage(96, 80);
    stage.world().insert_resource(ViewTolerance(Tolerance::EXACT));
    for (name, auto) in scenes() {
        let mut phong = auto.clone();
        phong.view_shading = Some(Shading::Phong);
        let expected = stage.draw(&phong);
        let picture = stage.draw(&auto);
        assert_eq!(stage.report().terms_at_vertices, 0, "{name}");
        // Lists sum in another order than what is compiled in.
        let off = difference(&expected, &picture);
        assert!(off <= 2e-6, "{name}: off by {off:e}");
    }
}

#[test]
fn what_is_blended_or_stretched_is_shaded_at_fragments() {
    let mut stage = stage(64, 64);
    stage.world().insert_resource(ViewTolerance(Tolerance::steps(8.0)));
    for (name, thing) in [
        ("blended", Thing::new(ball()).of(material()).blended(0.5)),
        ("stretched", Thing::new(ball()).of(material()).at(scaled(1.0, 1.5, 1.0))),
    ] {
        stage.draw(&scene(thing).lit(sun()));
        let report = stage.report();
        assert_eq!((report.terms_at_vertices, report.errors.len()), (0, 0), "{name}");
    }
}

#[test]
fn an_object_s_tolerance_wins_over_the_view_s() {
    let mut stage = stage(96, 80);
    stage.world().insert_resource(ViewTolerance(Tolerance::EXACT));
    let auto = scene(Thing::new(ball()).of(material())).lit(sun());
    let exact = stage.draw(&auto);
    let world = stage.world();
    let object = world.query_filtered::<Entity, With<Mesh3d>>().single(world).expect("one object");
    world.entity_mut(object).insert(Tolerance::steps(4.0));
    let within = stage.float();
    assert!(stage.report().terms_at_vertices > 0);
    assert!(difference(&exact, &within) > 1e-4);
    stage.world().entity_mut(object).insert(Tolerance::steps(-1.0));
    stage.frame();
    let errors: Vec<String> = stage.report().errors.iter().map(ToString::to_string).collect();
    assert!(errors.len() == 1 && errors[0].contains("Tolerance.steps"), "{errors:?}");
    stage.world().entity_mut(object).remove::<Tolerance>();
    assert_identical("as before", &exact, &stage.float());
}

#[test]
fn one_term_may_be_placed_and_the_other_said() {
    let (mut stage, mut failures) = (stage(112, 96), Failures::default());
    stage.world().insert_resource(ViewTolerance(Tolerance::steps(2.0)));
    for (diffuse, specular) in [(Frequency::Auto, Frequency::Fragment), (Frequency::Fragment, Frequency::Auto)] {
        let thing = Thing::new(ball()).of(material()).terms(diffuse, specular);
        let bars = FLOAT.within(2.0);
        failures.draw(&format!("{diffuse:?}, {specular:?}"), &mut stage, &scene(thing).lit(sun()), bars);
        assert!(stage.report().terms_at_vertices > 0);
    }
    failures.finish();
}

#[test]
fn false_colors_show_where_terms_are_shaded() {
    let mut stage = stage(96, 80);
    stage.world().insert_resource(ViewTolerance(Tolerance::steps(1.0)));
    stage.world().insert_resource(halfway::render::FalseColors(true));
    let auto = scene(Thing::new(ball()).of(material())).lit(sun());
    let picture = stage.draw(&auto);
    let shown = |test: fn(&[f32; 4]) -> bool| picture.pixels().filter(|pixel| test(&pixel.0)).count();
    assert!(shown(|pixel| pixel[1] == 1.0 && pixel[0] == 0.0) > 100, "patches shaded at the vertices");
    assert!(shown(|pixel| pixel[0] > 0.0 && pixel[2] > 0.0) > 100, "patches shaded at fragments");
    for (shading, color) in [(Shading::Gouraud, [0.0, 1.0]), (Shading::Phong, [1.0, 0.0])] {
        let mut other = auto.clone();
        other.view_shading = Some(shading);
        let picture = stage.draw(&other);
        let colored = picture.pixels().filter(|pixel| pixel.0[..2] == color).count();
        assert!(colored > 1000, "{shading:?}: {colored} pixels");
    }
    // What has no lights has no terms.
    stage.draw(&scene(Thing::new(ball()).of(glowing(0.1, 0.2, 0.3))));
    assert_eq!(stage.report().errors, []);
}

/// Of what cannot move no patch has a list, and none that came before it counts.
#[test]
fn false_colors_show_what_has_no_lists() {
    let mut stage = stage(96, 80);
    stage.world().insert_resource(halfway::render::FalseColors(true));
    stage.world().insert_resource(VertexPrices::NEVER);
    let picture = stage.draw(&scene(Thing::new(ball()).of(material())).lit(sun()));
    let colored = picture.pixels().filter(|pixel| pixel.0[..2] == [1.0, 0.0]).count();
    assert!(colored > 1000, "{colored} pixels");
}

/// Lights and camera move on: what was chosen in one frame does not stay for the next.
#[test]
fn moving_lights_stay_within_the_tolerance() {
    let (mut stage, mut failures) = (stage(96, 80), Failures::default());
    stage.world().insert_resource(ViewTolerance(Tolerance::steps(1.0)));
    for frame in 0..24_u8 {
        let turn = f32::from(frame) * 0.27;
        let at = Vec3::new(2.5 * turn.sin(), 1.0, 2.5 * turn.cos());
        let mut moved = scene(Thing::new(ball()).of(material())).lit(Lamp::point(white(0.9), at)).lit(sun());
        moved.eye = Transform::from_xyz(0.6 * turn.cos(), 0.8, 2.4).looking_at(Vec3::ZERO, Vec3::Y);
        failures.draw(&format!("frame {frame}"), &mut stage, &moved, FLOAT.within(1.0));
    }
    failures.finish();
}

/// What a patch covers decides: the same ball is looked at light by light in a large picture, and only a few of its
/// patches in a small one; and nowhere what costs more whatever it covers.
#[test]
fn what_costs_more_than_it_saves_stays_at_the_fragments() {
    let mut auto = scene(Thing::new(ball()).of(material())).lit(sun());
    for place in [Vec3::new(1.6, 1.4, 2.0), Vec3::new(-1.0, 2.4, 1.0), Vec3::new(0.3, -1.0, 3.0)] {
        auto.lamps.push(Lamp::point(white(0.3), place));
    }
    let mut phong = auto.clone();
    phong.view_shading = Some(Shading::Phong);
    let look = |size: u32, prices: VertexPrices| {
        let mut stage = Stage::new(size, size);
        stage.world().insert_resource(prices);
        let expected = stage.draw(&phong);
        let picture = stage.draw(&auto);
        let FrameReport { patches, patches_culled, light_pairs, terms_at_vertices, .. } = *stage.report();
        let seen = u64::from(patches - patches_culled);
        (terms_at_vertices, light_pairs, seen, difference(&expected, &picture))
    };
    let software = Costs::SOFTWARE.vertices;
    let (at_vertices, pairs, seen, _) = look(1024, software);
    // But for some at the rim, which cover few pixels.
    assert!(
        at_vertices > 0 && 10 * pairs >= 9 * 4 * seen,
        "{at_vertices} at vertices, {pairs} pairs of {seen} patches"
    );
    let (at_vertices, ..) = look(1024, Costs::CPU.vertices);
    assert!(at_vertices > 0, "nothing is at the vertices by what it costs on the CPU");
    for prices in [software, Costs::CPU.vertices] {
        let (at_vertices, pairs, seen, off) = look(96, prices);
        assert!(pairs <= seen / 2, "{pairs} pairs of {seen} patches");
        assert_eq!((at_vertices, off), (0, 0.0));
    }
    assert_eq!(Costs::HARDWARE.vertices, VertexPrices::NEVER);
    let (at_vertices, pairs, _, off) = look(1024, VertexPrices::NEVER);
    assert_eq!((at_vertices, pairs, off), (0, 0, 0.0));
}

/// A whole ball has normals all around: of it no term moves, and automatic shading leaves out what Phong shading does.
/// Nor does any where no step may be off.
#[test]
fn what_cannot_move_is_drawn_as_under_phong_shading() {
    let pictures = |mesh: Mesh, steps: f32| {
        let mut auto = scene(Thing::new(mesh).of(material()));
        let mut random = Random(5);
        for light in 0..40 {
            let at = Vec3::new(random.between(-4.0, 4.0), random.between(-4.0, 4.0), random.between(1.5, 4.0));
            auto.lamps.push(Lamp::point(white(if light % 2 == 0 { 0.02 } else { 0.0002 }), at));
        }
        let mut phong = auto.clone();
        phong.view_shading = Some(Shading::Phong);
        let mut stage = Stage::new(256, 256);
        stage.world().insert_resource(Costs::SOFTWARE.vertices);
        stage.world().insert_resource(ViewTolerance(Tolerance { steps, pixels: 0.0 }));
        let [expected, found] = [phong, auto].map(|scene| {
            stage.set(&scene);
            let bytes = stage.bytes();
            (bytes, stage.report().left_out, stage.report().terms_at_vertices)
        });
        (expected.1, expected.0 == found.0 && expected.1 == found.1, found.2)
    };
    let (left_out, same, at_vertices) = pictures(UvSphere::new(1.0, 32, 16).into(), 1.0);
    assert!(left_out > 0.0 && same, "{left_out} left out, or not the same, {at_vertices} at vertices");
    assert_eq!(at_vertices, 0);
    assert_eq!(pictures(ball(), 0.0), (0.0, true, 0));
    let (_, same, at_vertices) = pictures(ball(), 1.0);
    assert!(!same && at_vertices > 0, "what can move does not: {at_vertices} at vertices");
}

#[test]
fn prices_that_are_none_are_told_and_not_taken() {
    for (wrong, message) in [
        (
            VertexPrices { light: -1.0, ..VertexPrices::FREE },
            "VertexPrices.light: the value is -1.0; expected 0 or more",
        ),
        (
            VertexPrices { draw: f32::NAN, ..VertexPrices::FREE },
            "VertexPrices.draw: the value is NaN; expected 0 or more",
        ),
    ] {
        let mut stage = Stage::new(64, 64);
        let ball = scene(Thing::new(ball()).of(material())).lit(sun());
        let expected = stage.draw(&ball);
        stage.world().insert_resource(wrong);
        let errors: Vec<_> = stage.frame().errors.iter().map(ToString::to_string).collect();
        assert!(errors.len() == 1 && errors[0].contains(message), "{errors:?}");
        stage.world().insert_resource(VertexPrices::NEVER);
        assert_eq!(difference(&expected, &stage.draw(&ball)), 0.0);
        assert_eq!(stage.report().errors, []);
    }
}

/// A run of patches goes on over those between that do not show, and not over triangles for which coarser or finer ones
/// stand: these would be drawn too, under the lights of their neighbours.
#[test]
fn coarser_patches_take_no_triangles_of_others_along() {
    let mut stage = stage(244, 220);
    let matte = Material { ambient: LinearRgba::BLACK, ..Material::matte(LinearRgba::rgb(0.1, 0.8, 0.75)) };
    let turned = Quat::from_xyzw(-0.901_526, -0.370_284, 0.155_512, 0.161_112).normalize();
    let at = Transform::from_xyz(0.4133, 0.1513, 2.201).with_rotation(turned).with_scale(Vec3::splat(1.374));
    let ball = Mesh::from(UvSphere::new(0.9491, 128, 64));
    let mut auto = scene(Thing::new(ball).of(matte).faces(Faces::Back).at(at));
    let mut lamp = |at: [f32; 3], color: [f32; 3], [constant, linear, quadratic]: [f32; 3]| {
        let [r, g, b] = color;
        let light = PointLight {
            attenuation: Attenuation::new(constant, linear, quadratic),
            ..PointLight::from_color(LinearRgba::rgb(r, g, b))
        };
        auto.lamps.push(Lamp::point(light, at.into()));
    };
    lamp([-1.326, 2.664, 3.913], [0.2841; 3], [0.2766, 0.139, 0.06707]);
    lamp([-3.371, -1.57, -2.153], [0.0, 0.2473, 0.0], [0.0, 0.0, 0.07057]);
    lamp([1.684, 1.187, 1.192], [0.3588, 0.2444, 0.04505], [1.0, 0.0, 0.0]);
    let (target, up) = (Vec3::new(0.07936, -0.3024, 0.076_84), Vec3::new(0.4675, 0.2478, -0.8486));
    auto.eye = Transform::from_xyz(-3.047, -5.34, 1.129).looking_at(target, up);
    stage.set(&auto);
    for (steps, pixels) in [(1.0, 0.1), (1.0, 0.5), (2.0, 0.5), (4.0, 1.0)] {
        let tolerance = Tolerance { steps, pixels };
        stage.levels(tolerance);
        let FrameReport { triangles, patches, patches_culled, .. } = *stage.report();
        assert!(patches_culled > 0, "some are hidden");
        println!("{steps} steps, {pixels} pixels: {triangles} triangles of {patches} patches, {patches_culled} hidden");
        let picture = stage.float();
        stage.world().insert_resource(ViewTolerance(Tolerance::EXACT));
        let exact = stage.float();
        for (x, y, pixel) in picture.enumerate_pixels() {
            let near = |k: usize| {
                let around =
                    (-2..=2).flat_map(|dy: i64| (-2..=2).map(move |dx: i64| (i64::from(x) + dx, i64::from(y) + dy)));
                let inside = around.filter(|&(x, y)| (0..244).contains(&x) && (0..220).contains(&y));
                let values = inside.map(|(x, y)| exact.get_pixel(x as u32, y as u32).0[k]);
                values.fold([f32::MAX, f32::MIN], |[low, high], value| [low.min(value), high.max(value)])
            };
            for k in 0..3 {
                let [low, high] = near(k);
                let off = (low - pixel.0[k]).max(pixel.0[k] - high);
                // Beside black, grids of pixels differ in what they cover.
                assert!(
                    low == 0.0 || off <= tolerance.steps / 255.0,
                    "({x}, {y}) {k}: {} of {low} to {high}",
                    pixel.0[k]
                );
            }
        }
    }
}

//! Random numbers over sixteen decades in scenes of one shape: never NaN, infinite or negative, and equal to the oracle
//! up to rounding. Numbers alone build no pipelines, so many scenes need few.

use std::cell::RefCell;
use std::f32::consts::{FRAC_PI_2, PI};

use crate::render::compare::{FLOAT, judge};
use crate::render::scene::{Kind, Lamp, Scene, Thing};
use crate::render::sides::hemisphere;
use crate::render::stage::Stage;
use halfway::prelude::*;
use halfway::reference::Image;
use halfway::reference::metrics::Bars;
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};

/// The numbers of a scene: an open hemisphere under a light of each kind, seen from four times its size.
#[derive(Clone, Debug)]
struct Numbers {
    /// Of the scene as a whole, in world units.
    size: f32,
    /// Of the object, in shares of that.
    scale: [f32; 3],
    turn: [f32; 3],
    front: Material,
    back: Material,
    lamps: Vec<Lamp>,
    shading: Shading,
    reflectance: Reflectance,
    viewer: Viewer,
}

/// 10^x with x uniform in −8 … 8.
fn magnitude() -> impl Strategy<Value = f32> {
    (-8f32..=8.0).prop_map(|x| 10f32.powf(x))
}

/// A colour of any brightness whose channels are of one magnitude, so that none is lost beside the others.
fn colour(brightness: impl Strategy<Value = f32>) -> impl Strategy<Value = LinearRgba> {
    (brightness, prop::array::uniform3(0.1f32..=1.0)).prop_map(|(i, [r, g, b])| LinearRgba::rgb(i * r, i * g, i * b))
}

fn brightness() -> impl Strategy<Value = f32> {
    prop_oneof![1 => Just(0.0), 9 => magnitude()]
}

fn material() -> impl Strategy<Value = Material> {
    let colour = || colour(brightness());
    let shininess = prop_oneof![1 => Just(0.0), 4 => 0f32..=30.0, 4 => (-8f32..=5.0).prop_map(|x| 10f32.powf(x))];
    (colour(), colour(), colour(), colour(), shininess).prop_map(|(ambient, diffuse, specular, emission, shininess)| {
        Material { ambient, diffuse, specular, emission, shininess, ..Material::DEFAULT }
    })
}

fn direction() -> impl Strategy<Value = Vec3> {
    (-1f32..=1.0, 0f32..2.0 * PI).prop_map(|(z, angle)| {
        let r = (1.0 - z * z).sqrt();
        Vec3::new(r * angle.cos(), r * angle.sin(), z)
    })
}

/// The parameters of a lamp: three colours, the constants of its attenuation, a range, where it is and what it shines at,
/// and a cone.
type Parts = ([LinearRgba; 3], [f32; 3], f32, [Vec3; 2], Cone);

/// A light of each kind, at `places` times the scene's size. Few: a software adapter compiles longer for more.
fn lamps(cone: BoxedStrategy<Cone>, places: BoxedStrategy<f32>, most: f32) -> impl Strategy<Value = Vec<Lamp>> {
    let bright = colour(prop_oneof![1 => Just(0.0), 1 => Just(most), 8 => magnitude()]);
    let falloff = prop::array::uniform3(prop_oneof![1 => Just(0.0), 4 => magnitude()]);
    let place = (direction(), places, direction()).prop_map(|(at, far, aim)| [at * far, aim]);
    let parts = (prop::array::uniform3(bright), falloff, magnitude(), place, cone);
    prop::collection::vec(parts, 3)
        .prop_map(|all| all.into_iter().enumerate().map(|(i, parts)| lamp(i, parts)).collect())
}

/// The kinds in turn: the point light has a range, the spot attenuates its ambient.
fn lamp(i: usize, (colours, [a, b, c], range, [at, aim], cone): Parts) -> Lamp {
    let [ambient, diffuse, specular] = colours;
    let light = PointLight {
        ambient,
        diffuse,
        specular,
        attenuation: Attenuation::new(a, b, if a + b + c > 0.0 { c } else { 1.0 }),
        range: (i == 0).then_some(range),
        attenuate_ambient: i == 1,
    };
    match i {
        0 => Lamp::point(light, at),
        1 => Lamp::spot(SpotLight { light, cone }, at, aim * 0.3 - at),
        _ => Lamp::directional(DirectionalLight { ambient, diffuse, specular }, aim),
    }
}

/// Scales whose magnitude is ordinary, and any scale: 0, thin, mirrored.
fn axes() -> [BoxedStrategy<f32>; 2] {
    let ordinary = prop_oneof![3 => 0.2f32..=1.2, 1 => -1.2f32..=-0.2].boxed();
    let thin = (-8f32..=0.0).prop_map(|x| 10f32.powf(x));
    [ordinary.clone(), prop_oneof![2 => ordinary, 1 => Just(0.0), 1 => thin].boxed()]
}

fn numbers(
    [x, y, z]: [BoxedStrategy<f32>; 3],
    cone: BoxedStrategy<Cone>,
    places: BoxedStrategy<f32>,
    most: f32,
) -> impl Strategy<Value = Numbers> {
    let transform = (magnitude(), (x, y, z).prop_map(|(x, y, z)| [x, y, z]), prop::array::uniform3(-PI..PI));
    let looks = (
        prop::sample::select(&[Shading::Flat, Shading::Gouraud, Shading::Phong]),
        prop::sample::select(&[Reflectance::Phong, Reflectance::BlinnPhong, Reflectance::BlinnPhongMatched]),
        prop::sample::select(&[Viewer::Local, Viewer::Infinite]),
    );
    (transform, material(), material(), lamps(cone, places, most), looks).prop_map(
        |((size, scale, turn), front, back, lamps, (shading, reflectance, viewer))| Numbers {
            size,
            scale,
            turn,
            front,
            back,
            lamps,
            shading,
            reflectance,
            viewer,
        },
    )
}

impl Numbers {
    fn scene(&self) -> Scene {
        let [x, y, z] = self.turn;
        let object = Transform::from_scale(Vec3::from_array(self.scale) * self.size).with_rotation(Quat::from_euler(
            EulerRot::XYZ,
            x,
            y,
            z,
        ));
        let thing =
            Thing::new(hemisphere(10, 6)).with_material(self.front).back(self.back).faces(Faces::Both).at(object);
        let mut scene = Scene::seen_from(Vec3::new(1.0, 2.0, 3.0) * self.size, Vec3::ZERO).ambient(0.1);
        scene.camera.projection = scene.camera.projection.with_near(0.1 * self.size);
        scene.camera.viewer = self.viewer;
        scene.things.push(thing.shaded(self.shading).reflecting(self.reflectance));
        scene.lamps = self.lamps.iter().map(|lamp| self.placed(lamp)).collect();
        scene
    }

    fn placed(&self, lamp: &Lamp) -> Lamp {
        let at = lamp.at.translation * self.size;
        Lamp { at: Transform { translation: if at.is_finite() { at } else { Vec3::MAX }, ..lamp.at }, ..lamp.clone() }
    }

    /// How far rounding may take a pixel, in shares of the brightest: a cosine is known to 10⁻⁶ after it has been
    /// interpolated, an exponent multiplies that, and the fade between two cones divides by its width.
    fn rounding(&self) -> f64 {
        let matched = if self.reflectance == Reflectance::BlinnPhongMatched { 4.0 } else { 1.0 };
        let shininess = self.front.shininess.max(self.back.shininess);
        let cones = self.lamps.iter().filter_map(|lamp| match &lamp.kind {
            Kind::Spot(spot) => Some(spot.cone),
            _ => None,
        });
        let cone = cones.map(|Cone { cutoff, inner, exponent }| {
            exponent + inner.map_or(0.0, |inner| 2.0 / (inner.cos() - cutoff.cos()))
        });
        1e-6 * f64::from(matched * shininess + cone.fold(0.0, f32::max))
    }
}

/// The same cases in every run.
fn run(
    cases: u32,
    strategy: impl Strategy<Value = Numbers>,
    test: impl Fn(&mut Stage, Numbers) -> Result<(), TestCaseError>,
) {
    let config = ProptestConfig {
        cases,
        failure_persistence: None,
        max_shrink_iters: 400,
        rng_seed: RngSeed::Fixed(1977),
        ..ProptestConfig::default()
    };
    let stage = RefCell::new(Stage::new(24, 24));
    let outcome = TestRunner::new(config).run(&strategy, |numbers| test(&mut stage.borrow_mut(), numbers));
    println!("{} pipelines", stage.borrow().report().pipelines);
    outcome.unwrap_or_else(|failure| panic!("{failure}"));
}

#[test]
fn scenes_of_any_numbers_match_the_oracle() {
    // Cones whose edges are not steeper than a picture shows, lights outside the object.
    let cone = (0.1f32..FRAC_PI_2, prop::option::of(0f32..0.9), 0f32..100.0)
        .prop_map(|(cutoff, share, exponent)| Cone { cutoff, inner: share.map(|share| share * cutoff), exponent })
        .boxed();
    let places = (0.5f32..=8.0).prop_map(|x| 10f32.powf(x)).boxed();
    // Flattened along its axis the hemisphere is a disc; along another it would lie on itself, and either side win.
    let [ordinary, any] = axes();
    run(400, numbers([ordinary.clone(), any, ordinary], cone, places, 1.0), |stage, numbers| {
        let picture = Image::from_float(&stage.draw(&numbers.scene()));
        let rounding = numbers.rounding();
        let bars = Bars { most: FLOAT.most + rounding, worst: FLOAT.worst + rounding, ..FLOAT };
        let (verdict, _) = judge(stage, &picture, bars);
        prop_assert!(verdict.is_within(), "{verdict}; within {bars:?}");
        Ok(())
    });
}

#[test]
fn scenes_of_any_numbers_hold_numbers() {
    let cutoff = prop::sample::select(&[0.0, 1e-4, 0.1, 0.7, FRAC_PI_2, PI]);
    let share = prop::option::of(prop::sample::select(&[0.0, 0.5, 1.0]));
    let cone = (cutoff, share, magnitude())
        .prop_map(|(cutoff, share, exponent)| Cone { cutoff, inner: share.map(|share| share * cutoff), exponent })
        .boxed();
    // Anywhere: in the middle, on the surface, at the eye.
    let places = prop_oneof![Just(0.0), Just(1.0), Just(14f32.sqrt()), magnitude()].boxed();
    let [_, any] = axes();
    run(400, numbers([any.clone(), any.clone(), any], cone, places, 1e12), |stage, numbers| {
        let picture = stage.draw(&numbers.scene());
        for (x, y, pixel) in picture.enumerate_pixels() {
            prop_assert!(pixel.0.iter().all(|v| v.is_finite() && *v >= 0.0), "pixel ({x}, {y}) is {:?}", pixel.0);
        }
        Ok(())
    });
}

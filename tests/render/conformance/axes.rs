//! The axes of the conformance suite, and the rows of all pairs of their values.

use super::Row;
use super::colors::off_ties;
use crate::render::scene::{
    Lamp, Scene, Thing, directional_light, glowing, material, other_material, point_light, rotated, scaled,
};
use crate::render::sides::hemisphere;
use halfway::lighting::Frequency;
use halfway::prelude::*;

/// A scene by the values of the axes.
struct Setup {
    object: Thing,
    kind: Kind,
    light: PointLight,
    cone: Cone,
    viewer: Viewer,
    projection: Projection,
    /// A pane with the same material before the object.
    pane: bool,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Point,
    Spot,
    Directional,
    /// A light with only an ambient colour, which it attenuates.
    Ambient,
}

/// The axes of a row.
struct Value {
    name: &'static str,
    set: fn(&mut Setup),
    /// The kinds of light that it needs to mean anything, the usual one first.
    kinds: &'static [Kind],
}

const ANY: &[Kind] = &[Kind::Point, Kind::Spot, Kind::Directional, Kind::Ambient];
const FINITE: &[Kind] = &[Kind::Point, Kind::Spot, Kind::Ambient];

const fn value(name: &'static str, set: fn(&mut Setup)) -> Value {
    Value { name, set, kinds: ANY }
}

const fn light(name: &'static str, kinds: &'static [Kind]) -> Value {
    Value { name, set: |_| (), kinds }
}

const fn attenuation(name: &'static str, set: fn(&mut Setup)) -> Value {
    Value { name, set, kinds: FINITE }
}

const fn cone(name: &'static str, set: fn(&mut Setup)) -> Value {
    Value { name, set, kinds: &[Kind::Spot] }
}

/// The first value of each axis is the default of all rows.
const AXES: [&[Value]; 10] = [
    &[
        value("phong shading", |setup| setup.object.shading = Some(Shading::Phong)),
        value("gouraud", |setup| setup.object.shading = Some(Shading::Gouraud)),
        value("flat", |setup| setup.object.shading = Some(Shading::Flat)),
        value("unlit", |setup| {
            setup.object.shading = Some(Shading::Unlit);
            off_ties(&mut setup.object.material);
        }),
        value("diffuse at vertices, specular at fragments", |setup| {
            let terms = Terms { diffuse: Frequency::Vertex, specular: Frequency::Fragment };
            setup.object.shading = Some(Shading::Terms(terms));
        }),
    ],
    &[
        value("blinn-phong", |setup| setup.object.reflectance = Some(Reflectance::BlinnPhong)),
        value("phong reflectance", |setup| setup.object.reflectance = Some(Reflectance::Phong)),
        value("matched", |setup| setup.object.reflectance = Some(Reflectance::BlinnPhongMatched)),
    ],
    &[
        light("point", &[Kind::Point]),
        light("spot", &[Kind::Spot]),
        light("directional", &[Kind::Directional]),
        light("ambient only", &[Kind::Ambient]),
    ],
    &[
        attenuation("no attenuation", |setup| setup.light.attenuation = Attenuation::NONE),
        attenuation("default attenuation", |setup| setup.light.attenuation = Attenuation::default()),
        attenuation("inverse square", |setup| setup.light.attenuation = Attenuation::INVERSE_SQUARE),
        attenuation("range", |setup| setup.light.range = Some(2.9)),
    ],
    &[
        cone("hard cone", |setup| setup.cone = Cone { cutoff: 0.33, inner: None, exponent: 0.0 }),
        cone("inner cone", |setup| setup.cone = Cone { cutoff: 0.36, inner: Some(0.17), exponent: 0.0 }),
        cone("exponent", |setup| setup.cone = Cone { cutoff: 0.36, inner: None, exponent: 12.0 }),
    ],
    &[
        value("front", |setup| setup.object.faces = Some(Faces::Front)),
        value("back", |setup| setup.object.faces = Some(Faces::Back)),
        value("both", |setup| setup.object.faces = Some(Faces::Both)),
        value("both with a back material", |setup| {
            setup.object.faces = Some(Faces::Both);
            setup.object.back = Some(Material { opacity: 0.35, ..other_material() });
        }),
    ],
    &[
        value("local viewer", |setup| setup.viewer = Viewer::Local),
        value("infinite viewer", |setup| setup.viewer = Viewer::Infinite),
    ],
    &[
        value("perspective", |setup| setup.projection = Projection::default()),
        value("orthographic", |setup| setup.projection = Projection::orthographic(2.6)),
        // The camera stands amid the objects then.
        value("orthographic, from behind the camera", |setup| {
            setup.projection = Projection::orthographic(2.6).with_near(-9.0);
        }),
        value("orthographic, between two planes", |setup| {
            setup.projection = Projection::Orthographic { height: 2.6, near: 2.5, far: Some(3.4), film: Film::DEFAULT };
        }),
        value("off centre", |setup| setup.projection = Projection::default().with_film(OFF_CENTRE)),
        value("orthographic, off centre", |setup| {
            setup.projection = Projection::orthographic(2.6).with_film(OFF_CENTRE);
        }),
    ],
    &[
        value("uniform", |setup| setup.object.frames = vec![turn().with_scale(Vec3::splat(0.9))]),
        value("non-uniform", |setup| setup.object.frames = vec![turn().with_scale(Vec3::new(1.05, 0.6, 0.8))]),
        value("sheared", |setup| setup.object.frames = vec![scaled(1.0, 0.7, 0.9), rotated(0.2, 0.3, 0.25)]),
        value("mirrored", |setup| setup.object.frames = vec![turn().with_scale(Vec3::new(-0.9, 0.9, 0.9))]),
        value("singular", |setup| setup.object.frames = vec![turn().with_scale(Vec3::new(0.9, 0.0, 0.9))]),
    ],
    &[
        value("opaque", |_| ()),
        value("blended", blend),
        value("blended and overlapping", |setup| {
            blend(setup);
            setup.pane = true;
        }),
    ],
];

/// Shifted, with pixels that are not square.
const OFF_CENTRE: Film = Film { shift: [0.12, -0.08], aspect: None, pixel_aspect: 1.25 };

fn blend(setup: &mut Setup) {
    setup.object.blend = true;
    setup.object.material.opacity = 0.6;
}

fn turn() -> Transform {
    rotated(0.1, 0.25, 0.05)
}

/// A dome that shows its outside, and beside it a bowl that shows its inside; flattened, a disc of each side.
fn dome_and_bowl() -> Mesh {
    let half = hemisphere(14, 8);
    let places = [
        Transform::from_xyz(-0.78, 0.0, 0.0).with_scale(Vec3::splat(0.7)),
        Transform::from_xyz(0.78, 0.1, 0.0).with_scale(Vec3::splat(0.7)).with_rotation(Quat::from_rotation_x(3.0)),
    ];
    let all = |of: &dyn Fn(&Transform) -> Vec<Vec3>| places.iter().flat_map(of).collect::<Vec<_>>();
    let positions = all(&|place| half.positions().iter().map(|p| place.transform_point(*p)).collect());
    let normals = all(&|place| half.normals().iter().map(|n| place.rotation * *n).collect());
    let count = half.positions().len() as u32;
    let indices = [0, count].iter().flat_map(|first| half.indices().iter().map(move |i| first + i)).collect();
    Mesh::from_parts(positions, Some(normals), None, indices).expect("two halves of a sphere")
}

impl Setup {
    fn new() -> Self {
        Self {
            object: Thing::new(dome_and_bowl()).with_material(material()).at(turn().with_scale(Vec3::splat(0.9))),
            kind: Kind::Point,
            light: point_light(),
            cone: Cone { cutoff: 0.36, inner: None, exponent: 1.0 },
            viewer: Viewer::Local,
            projection: Projection::default(),
            pane: false,
        }
    }

    fn scene(&self) -> Scene {
        let mut scene = Scene::seen_from(Vec3::new(0.1, 1.7, 2.5), Vec3::new(0.0, 0.05, 0.0)).ambient(0.1);
        scene.camera.viewer = self.viewer;
        scene.camera.projection = self.projection;
        if self.projection.near() < 0.0 {
            scene.eye.translation += 3.0 * scene.eye.forward();
        }
        scene.camera.background = LinearRgba::rgb(0.02, 0.05, 0.09);
        scene.things.push(self.object.clone());
        if self.object.blend {
            // Something to be seen through the object, and something to be hidden by it.
            scene
                .things
                .push(Thing::square(Vec3::new(-0.5, -0.9, -0.6), Vec3::Y, 1.5).with_material(glowing(0.4, 0.1, 0.3)));
        }
        if self.pane {
            let at = Transform::from_xyz(0.2, 0.8, 1.2).with_rotation(Quat::from_rotation_x(0.9));
            let pane = Thing { mesh: Plane { size: 0.7, divisions: 3 }.into(), ..self.object.clone() };
            // From the side that the object shows.
            let over = Quat::from_rotation_x(if self.object.faces == Some(Faces::Back) { 3.0 } else { 0.0 });
            scene.things.push(pane.at(at.with_rotation(at.rotation * over)));
        }
        scene.lit(self.lamp())
    }

    fn lamp(&self) -> Lamp {
        let at = Vec3::new(0.35, 1.9, 1.3);
        let toward = Vec3::new(0.1, 0.1, 0.05) - at;
        match self.kind {
            Kind::Point => Lamp::point(self.light, at),
            Kind::Spot => Lamp::spot(SpotLight { light: self.light, cone: self.cone }, at, toward),
            Kind::Directional => Lamp::directional(directional_light(), toward),
            Kind::Ambient => {
                let black = LinearRgba::BLACK;
                let ambient = LinearRgba::rgb(0.9, 0.5, 0.7);
                Lamp::point(
                    PointLight { ambient, diffuse: black, specular: black, attenuate_ambient: true, ..self.light },
                    at,
                )
            }
        }
    }
}

/// The row of some values; none where no light has them all, as no directional light has a range.
fn row(values: &[&Value]) -> Option<Row> {
    let kind = ANY.iter().find(|kind| values.iter().all(|value| value.kinds.contains(kind)))?;
    let mut setup = Setup { kind: *kind, ..Setup::new() };
    for value in values {
        (value.set)(&mut setup);
    }
    let name = values.iter().map(|value| value.name).collect::<Vec<_>>().join(" × ");
    Some(Row::new(name, setup.scene()))
}

/// A row for each value, then one for each pair of values of two axes.
pub(super) fn rows() -> Vec<Row> {
    let each = AXES.iter().flat_map(|axis| axis.iter()).filter_map(|value| row(&[value]));
    let axes = || AXES.iter().enumerate();
    let pairs = axes().flat_map(|(i, first)| {
        AXES[i + 1..].iter().flat_map(move |second| first.iter().flat_map(move |a| second.iter().map(move |b| [a, b])))
    });
    each.chain(pairs.filter_map(|pair| row(&pair))).collect()
}

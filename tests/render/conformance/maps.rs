//! The rows of objects with an image.

use super::Row;
use super::colors::{Change, SHADINGS, colored};
use super::environment::around;
use super::features::{lights, point, still_life};
use super::solids::solid;
use crate::render::compare::BLENDED;
use crate::render::scene::{Map, Scene, Thing, other_material, point_light};
use halfway::prelude::*;
use halfway::texture::{Channel, FarNormals, LevelFilter, Sampling, TexelFilter, TexelImage, UvSet, UvTransform, Wrap};

/// An image of an odd size that changes smoothly, in which no two channels are alike.
fn image() -> TexelImage {
    let wave = |x: f32| 0.5 + 0.45 * (std::f32::consts::TAU * x).sin();
    TexelImage::from_fn(21, 14, |x, y| {
        let (u, v) = (x as f32 / 21.0, y as f32 / 14.0);
        [wave(u), wave(v + 0.2), wave(u + v), 0.75 + 0.2 * wave(2.0 * v)]
    })
    .expect("a small image")
}

pub(crate) fn map(sampling: Sampling, transform: UvTransform) -> Map {
    Map { sampling, transform, ..Map::new(image()) }
}

fn mapped(sampling: Sampling, scale: f32) -> Scene {
    let transform = UvTransform { offset: [0.13, -0.21], rotation: 0.4, scale: [scale, 0.8 * scale] };
    let mut scene = still_life().lit(point(Vec3::new(1.2, 1.6, 1.8)));
    for thing in &mut scene.things {
        thing.maps = vec![(MapKind::Color, map(sampling, transform))];
    }
    scene
}

const CHANGES: [Change; 9] = [
    ("one light", |_| ()),
    ("no lights", |scene| scene.lamps.clear()),
    ("20 lights", |scene| scene.lamps = lights(20).lamps),
    ("colours, ambient that attenuates", |scene| {
        let light = PointLight { attenuate_ambient: true, ..point_light() };
        scene.lamps = vec![crate::render::scene::Lamp::point(light, Vec3::new(1.2, 1.6, 1.8))];
        scene.things.iter_mut().for_each(|thing| thing.mesh = colored(thing.mesh.clone()));
    }),
    ("both sides, blended", |scene| {
        for thing in &mut scene.things {
            *thing = thing.clone().faces(Faces::Both).back(other_material()).blended(0.8);
        }
    }),
    ("through the near plane", |scene| scene.camera.projection = scene.camera.projection.with_near(2.6)),
    ("orthographic", |scene| scene.camera.projection = Projection::orthographic(2.7)),
    ("off centre", |scene| {
        let film = Film { shift: [-0.2, 0.15], aspect: None, pixel_aspect: 0.8 };
        scene.camera.projection = scene.camera.projection.with_film(film);
    }),
    ("beside what has none, instanced", |scene| {
        for x in [-1.2, 1.2] {
            let at = Transform::from_xyz(x, 0.3, 0.0).with_scale(Vec3::splat(0.4));
            scene.things.push(Thing { frames: vec![at], ..scene.things[0].clone() });
        }
        scene.things.push(Thing::new(UvSphere::new(0.3, 12, 6)).at(Transform::from_xyz(0.0, 0.9, 0.2)));
    }),
];

/// Every filter that is continuous, reducing and enlarging, and every way to wrap.
fn filters() -> Vec<(String, Sampling, f32)> {
    let mut rows = Vec::new();
    for filter in [TexelFilter::Bilinear, TexelFilter::BSpline, TexelFilter::CatmullRom] {
        for (levels, scale) in [(LevelFilter::None, 0.3), (LevelFilter::None, 1.0), (LevelFilter::Linear, 4.0)] {
            let sampling = Sampling { magnify: filter, minify: filter, levels, ..Sampling::default() };
            rows.push((format!("{filter:?}, {levels:?} levels, {scale} times"), sampling, scale));
        }
    }
    for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
        for filter in [TexelFilter::Bilinear, TexelFilter::CatmullRom] {
            let sampling = Sampling { wrap: [wrap, Wrap::Mirror], magnify: filter, ..Sampling::default() };
            rows.push((format!("{filter:?}, {wrap:?}"), sampling, 1.7));
        }
    }
    rows
}

pub(super) fn rows() -> Vec<Row> {
    let pairs = SHADINGS.iter().flat_map(|shading| CHANGES.iter().map(move |change| (shading, change)));
    let shaded = pairs.map(|((shading, shade), (what, change))| {
        let mut scene = mapped(Sampling::default(), 1.3);
        change(&mut scene);
        shade(&mut scene);
        Row::new(format!("image, {shading}, {what}"), scene)
    });
    let filtered = filters()
        .into_iter()
        .map(|(name, sampling, scale)| Row::new(format!("image, {name}"), mapped(sampling, scale)));
    shaded.chain(filtered).collect()
}

/// Every filter that goes by the footprint's shape.
pub(crate) const SHAPED: [LevelFilter; 7] = [
    LevelFilter::Ripmap,
    LevelFilter::SummedArea,
    LevelFilter::Anisotropic2,
    LevelFilter::Anisotropic4,
    LevelFilter::Anisotropic8,
    LevelFilter::Anisotropic16,
    LevelFilter::Elliptical,
];

/// A filter whose number of probes alone is another's.
fn is_like_another(levels: LevelFilter) -> bool {
    matches!(levels, LevelFilter::Anisotropic2 | LevelFilter::Anisotropic4 | LevelFilter::Anisotropic16)
}

fn shaped(levels: LevelFilter, scale: [f32; 2], wrap: [Wrap; 2], minify: TexelFilter) -> Map {
    let transform = UvTransform { offset: [0.13, -0.21], rotation: 0.4, scale };
    map(Sampling { wrap, levels, minify, ..Sampling::default() }, transform)
}

fn long_along_u(levels: LevelFilter) -> Map {
    shaped(levels, [12.0, 2.5], [Wrap::Repeat; 2], TexelFilter::Bilinear)
}

fn with_each(maps: &[(MapKind, Map)]) -> Scene {
    let mut scene = still_life().lit(point(Vec3::new(1.2, 1.6, 1.8)));
    for thing in &mut scene.things {
        thing.mesh = with_second_uvs(&thing.mesh);
        thing.maps = maps.to_vec();
        thing.material.emission = LinearRgba::rgb(0.1, 0.2, 0.15);
    }
    scene
}

/// Footprints that are long along either axis, all ways to wrap, on each kind of image that is treated otherwise, and
/// beside filters by level.
pub(super) fn rows_by_shape() -> Vec<Row> {
    let mut rows = Vec::new();
    for levels in SHAPED {
        let mut row = |what: &str, scene: Scene| rows.push(Row::new(format!("image, {levels:?}, {what}"), scene));
        let wide = long_along_u(levels);
        let high = shaped(levels, [2.5, 14.0], [Wrap::Mirror; 2], TexelFilter::CatmullRom);
        let relief = Map { amount: 0.6, ..wide.clone() };
        let of_second = Map { uv_set: UvSet::Second, channel: Channel::Green, amount: 0.7, ..high.clone() };
        row("long along u", with_each(&[(MapKind::Color, wide.clone())]));
        row("normals, opacity", {
            let mut scene = with_each(&[(MapKind::Normal, relief), (MapKind::Opacity, of_second.clone())]);
            scene.things.iter_mut().for_each(|thing| thing.mask = Some(0.5));
            scene
        });
        if is_like_another(levels) {
            continue;
        }
        let small = shaped(levels, [90.0, 50.0], [Wrap::Repeat, Wrap::Mirror], TexelFilter::Bilinear);
        let edge = shaped(levels, [3.0, 6.0], [Wrap::Clamp; 2], TexelFilter::BSpline);
        let bump = Map { amount: 0.04, ..shaped(levels, [4.0, 2.0], [Wrap::Repeat; 2], TexelFilter::Bilinear) };
        let by_level = Map { sampling: Sampling::default(), ..wide.clone() };
        row("long along v, mirrored", with_each(&[(MapKind::Color, high.clone())]));
        row("much smaller than pixels", with_each(&[(MapKind::Color, small)]));
        row("clamped", with_each(&[(MapKind::Color, edge)]));
        row("heights by level", with_each(&[(MapKind::Color, wide.clone()), (MapKind::Height, bump)]));
        row("flat, beside a filter by level", {
            let maps = [(MapKind::Color, by_level), (MapKind::Emission, high), (MapKind::Occlusion, of_second)];
            Scene { view_shading: Some(Shading::Flat), ..with_each(&maps) }
        });
        row("a solid", {
            let mut scene = with_each(&[(MapKind::Color, wide)]);
            scene.things.iter_mut().for_each(|thing| thing.solid = Some(solid(SolidKind::Marble)));
            scene
        });
    }
    rows
}

/// The same in an environment, with a solid and without.
pub(super) fn rows_by_shape_in_environments() -> Vec<Row> {
    let mut rows = Vec::new();
    for levels in SHAPED.into_iter().filter(|&levels| !is_like_another(levels)) {
        for solid in [None, Some(solid(SolidKind::Marble))] {
            let mut scene = with_each(&[(MapKind::Color, long_along_u(levels))]);
            scene.things.iter_mut().for_each(|thing| thing.solid = solid);
            scene.environment = Some(around(0.8));
            let what = if solid.is_some() { "a solid in an environment" } else { "an environment" };
            rows.push(Row::new(format!("image, {levels:?}, {what}"), scene));
        }
    }
    rows
}

/// A mesh with a second set of coordinates beside the first, turned and moved.
fn with_second_uvs(mesh: &Mesh) -> Mesh {
    let uvs = mesh.uvs().expect("a surface has coordinates");
    let second = uvs.iter().map(|uv| Vec2::new(0.8 * uv.y + 0.1, 0.7 * uv.x - 0.3)).collect();
    mesh.clone().with_second_uvs(second).expect("one a vertex")
}

/// A scene whose things have these images, the first set of coordinates under one, the second under the next.
fn with_maps(kinds: &[(MapKind, f32)]) -> Scene {
    let mut scene = still_life().lit(point(Vec3::new(1.2, 1.6, 1.8)));
    for thing in &mut scene.things {
        thing.mesh = with_second_uvs(&thing.mesh);
        for (number, (kind, amount)) in kinds.iter().enumerate() {
            let k = number as f32;
            let transform = UvTransform {
                offset: [0.13 + 0.2 * k, -0.21],
                rotation: 0.4 - 0.3 * k,
                scale: [1.3 + 0.2 * k, 0.9 - 0.1 * k],
            };
            let channel = [Channel::Red, Channel::Green, Channel::Blue, Channel::Alpha][number % 4];
            let uv_set = if number % 2 == 0 { UvSet::First } else { UvSet::Second };
            let map = Map { uv_set, channel, amount: *amount, ..map(Sampling::default(), transform) };
            thing.maps.push((*kind, map));
        }
        // Emission, so that none is black.
        thing.material.emission = LinearRgba::rgb(0.1, 0.2, 0.15);
    }
    scene
}

/// Every kind but heights, which are not beside normals.
const ALL: [(MapKind, f32); 7] = [
    (MapKind::Color, 0.9),
    (MapKind::Specular, 1.0),
    (MapKind::Emission, 1.0),
    (MapKind::Opacity, 0.8),
    (MapKind::Shininess, 0.9),
    (MapKind::Occlusion, 0.7),
    (MapKind::Normal, 0.6),
];
const HEIGHTS: (MapKind, f32) = (MapKind::Height, 0.04);

const CIRCUMSTANCES: [Change; 10] = [
    ("one light", |_| ()),
    ("20 lights", |scene| scene.lamps = lights(20).lamps),
    ("colours, ambient that attenuates", CHANGES[3].1),
    ("both sides, blended", CHANGES[4].1),
    ("backs, mirrored and stretched", |scene| {
        scene.ambient = LinearRgba::rgb(0.5, 0.5, 0.5);
        for thing in &mut scene.things {
            thing.faces = Some(Faces::Back);
            thing.frames.push(Transform::from_scale(Vec3::new(-0.9, 1.2, 0.7)));
        }
    }),
    ("mirrored and stretched", |scene| {
        scene.things.iter_mut().for_each(|thing| thing.frames.push(Transform::from_scale(Vec3::new(0.8, -1.1, 1.3))));
    }),
    ("through the near plane", |scene| scene.camera.projection = scene.camera.projection.with_near(2.6)),
    ("orthographic", |scene| scene.camera.projection = Projection::orthographic(2.7)),
    ("off centre", |scene| {
        let film = Film { shift: [-0.2, 0.15], aspect: None, pixel_aspect: 0.8 };
        scene.camera.projection = scene.camera.projection.with_film(film);
    }),
    ("masked, matched", |scene| {
        scene.view_reflectance = Some(Reflectance::BlinnPhongMatched);
        for thing in &mut scene.things {
            thing.material.opacity = 0.9;
            thing.mask = Some(0.6);
        }
    }),
];

/// Every kind of image by itself under every way to shade.
pub(super) fn rows_of_kinds() -> Vec<Row> {
    rows_of(ALL.into_iter().chain([HEIGHTS]).map(|one| (one.0.name(), vec![one])))
}

/// Normal maps whose highlights use the length of the mean or the moments: wherever some term is shaded at the
/// fragments, under every reflectance, magnified and minified, and beside a shininess image; for moments by filters of
/// each form.
pub(super) fn rows_of_far_normals(far_normals: FarNormals) -> Vec<Row> {
    let far = |scale: f32, amount: f32| {
        let mut scene = still_life().lit(point(Vec3::new(1.2, 1.6, 1.8)));
        let transform = UvTransform { offset: [0.13, -0.21], rotation: 0.4, scale: [scale, 0.8 * scale] };
        for thing in &mut scene.things {
            let normals = Map { amount, far_normals, ..map(Sampling::default(), transform) };
            thing.maps = vec![(MapKind::Normal, normals)];
            // Highlights that are wide enough to be seen under normals that lean far.
            thing.material.shininess = 12.0;
        }
        scene
    };
    let mut rows: Vec<Row> = SHADINGS
        .into_iter()
        // Elsewhere normals of images do nothing.
        .filter(|(shading, _)| !["flat", "gouraud", "unlit"].contains(shading))
        .map(|(shading, shade)| {
            let mut scene = far(4.0, 0.5);
            shade(&mut scene);
            Row::new(format!("far normals, {shading}"), scene)
        })
        .collect();
    for reflectance in [Reflectance::Phong, Reflectance::BlinnPhong, Reflectance::BlinnPhongMatched] {
        for (scale, amount) in [(0.4, 0.3), (4.0, -0.6)] {
            let mut scene = far(scale, amount);
            scene.view_reflectance = Some(reflectance);
            let row = Row::new(format!("far normals, {reflectance:?}, {scale} times"), scene.clone());
            let mut shiny = scene.clone();
            let shininess = map(Sampling::default(), UvTransform::default());
            shiny.things.iter_mut().for_each(|thing| thing.maps.push((MapKind::Shininess, shininess.clone())));
            let shiny = Row::new(format!("far normals and shininess, {reflectance:?}, {scale} times"), shiny);
            rows.extend([row, shiny]);
        }
    }
    for (what, change) in CIRCUMSTANCES {
        let mut scene = far(3.0, 0.4);
        change(&mut scene);
        rows.push(Row::new(format!("far normals, {what}"), scene));
    }
    for levels in SHAPED.into_iter().filter(|&levels| far_normals == FarNormals::Lean && !is_like_another(levels)) {
        let mut scene = far(4.0, 0.5);
        scene.things.iter_mut().for_each(|thing| thing.maps[0].1.sampling.levels = levels);
        rows.push(Row::new(format!("far normals, {levels:?}"), scene));
    }
    rows
}

/// All kinds together.
pub(super) fn rows_of_all_kinds() -> Vec<Row> {
    rows_of([("all", ALL.to_vec()), ("all with heights", [&ALL[..6], &[HEIGHTS]].concat())].into_iter())
}

/// Masks with four samples a pixel: a fragment is cut as a whole, also where the mask's edge runs through the
/// triangle's. By the alpha of a color, by an opacity beside other images, and in layers.
pub(super) fn rows_of_masks_with_four_samples() -> Vec<Row> {
    let kinds: [(&str, &[(MapKind, f32)]); 3] = [
        ("color", &[(MapKind::Color, 0.9)]),
        ("opacity", &[(MapKind::Opacity, 0.8)]),
        ("opacity and color", &[(MapKind::Color, 0.9), (MapKind::Opacity, 1.0)]),
    ];
    let changes: [Change; 3] = [
        ("one side", |_| ()),
        ("both sides", |scene| {
            for thing in &mut scene.things {
                *thing = thing.clone().faces(Faces::Both).back(other_material());
            }
        }),
        ("blended", |scene| {
            for thing in &mut scene.things {
                *thing = thing.clone().blended(0.9);
            }
        }),
    ];
    let mut rows = Vec::new();
    for (kind, maps) in kinds {
        for (what, change) in changes {
            for (shading, shade) in SHADINGS.into_iter().take(3) {
                let mut scene = with_maps(maps);
                for thing in &mut scene.things {
                    thing.material.opacity = 0.9;
                    thing.mask = Some(if kind == "color" { 0.77 } else { 0.5 });
                }
                change(&mut scene);
                shade(&mut scene);
                scene.camera.samples = Samples::Four;
                // The number of equal bytes depends on the positions of the samples.
                let row = Row::new(format!("mask, four samples, {kind}, {shading}, {what}"), scene);
                rows.push(Row { raw: BLENDED, ..row });
            }
        }
    }
    rows
}

fn rows_of(each: impl Iterator<Item = (&'static str, Vec<(MapKind, f32)>)>) -> Vec<Row> {
    let mut rows = Vec::new();
    for (name, kinds) in each {
        for (number, (what, change)) in CIRCUMSTANCES.iter().enumerate() {
            for (shading, shade) in SHADINGS {
                // Each alone in one case, and in all others where it makes a difference.
                let turns = kinds.iter().any(|(kind, _)| kind.perturbs_normals() || *kind == MapKind::Shininess);
                if number > 0 && !(turns && shading == "phong") {
                    continue;
                }
                let mut scene = with_maps(&kinds);
                change(&mut scene);
                shade(&mut scene);
                rows.push(Row::new(format!("{name}, {shading}, {what}"), scene));
            }
        }
    }
    rows
}

//! The same bits on every width and thread count, and on every machine.

use crate::common::{Scene, Shading, at, draw, pieces, sphere};
use halfway_lighting::lights::Kind;
use halfway_lighting::record::{Cull, InstanceRecord, LightRecord};
use halfway_lighting::{Frequency, Lens, Reflectance, Samples, Terms};
use halfway_mesh::{Mesh, Plane};
use halfway_raster::{
    ClearTiles, DrawCall, Output, Pieces, PixelFormat, RasterOptions, Rasterizer, TriangleOrder, VectorWidth,
    VertexLists,
};

/// FNV-1a of 64 bits.
fn hash(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

fn hash_of_picture(scene: &Scene, rasterizer: &mut Rasterizer) -> u64 {
    let count = 4 * scene.size[0] as usize * scene.size[1] as usize;
    if scene.pixels == PixelFormat::Floats {
        let mut floats = vec![0.0; count];
        scene
            .with_pass(|pass| rasterizer.draw(pass, Output::Floats(&mut floats), &mut ClearTiles::default()))
            .expect("a sound pass");
        assert!(floats.iter().all(|x: &f32| x.is_finite() && *x >= 0.0));
        hash(floats.iter().flat_map(|x| x.to_bits().to_le_bytes()))
    } else {
        let mut bytes = vec![0; count];
        scene
            .with_pass(|pass| rasterizer.draw(pass, Output::Bytes(&mut bytes), &mut ClearTiles::default()))
            .expect("a sound pass");
        hash(bytes)
    }
}

/// A unit sphere of 12·n² triangles: a cube's grid brought to unit length, without a function whose last bits a library
/// decides.
fn ball(n: u32, order: TriangleOrder) -> Pieces {
    let (mut points, mut indices) = (Vec::new(), Vec::new());
    for face in 0..6_usize {
        let first = points.len() as u32;
        for j in 0..=n {
            for i in 0..=n {
                let [u, v] = [i, j].map(|k| 2.0 * f64::from(k) / f64::from(n) - 1.0);
                let outward = if face % 2 == 0 { 1.0 } else { -1.0 };
                let mut p = [0.0; 3];
                (p[face / 2], p[(face / 2 + 1) % 3], p[(face / 2 + 2) % 3]) = (outward, u * outward, v);
                let length = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
                points.push(p.map(|x| (x / length) as f32));
                if i < n && j < n {
                    let a = first + j * (n + 1) + i;
                    indices.extend([a, a + 1, a + n + 2, a, a + n + 2, a + n + 1]);
                }
            }
        }
    }
    Pieces::new(&points, VertexLists { normals: &points, ..VertexLists::default() }, &indices, &[], order)
        .expect("a sound mesh")
}

/// A ball under one light.
fn small(shading: Shading) -> Scene {
    let mut scene = sphere(true, shading).expect("a sound mesh");
    let mesh = ball(18, TriangleOrder::Clustered);
    scene.lens = Lens::perspective([2.4, 2.4], 0.1);
    scene.draws = vec![draw(&mesh, 1, shading)];
    scene.meshes = vec![mesh];
    scene
}

/// A floor that reaches from behind the eye to afar, and a half-transparent sphere that is seen from both sides.
fn floor_and_glass(samples: Samples, pixels: PixelFormat) -> Scene {
    let mut scene = small(Shading::Phong);
    scene.size = [333, 217];
    scene.lens = Lens::perspective([1.125, 1.75], 0.1);
    (scene.samples, scene.pixels) = (samples, pixels);
    let floor = pieces(&Mesh::from(Plane { size: 200.0, divisions: 3 }), TriangleOrder::Clustered).expect("sound");
    let glass = ball(7, TriangleOrder::Kept);
    let mut surface = scene.surfaces[0];
    (surface.front.opacity, surface.back.opacity) = (0.4, 0.4);
    surface.back.base = [0.2, 0.5, 0.9];
    surface.front.specular = [0.9, 0.8, 0.7];
    surface.front.shininess = 13.7;
    scene.surfaces.push(surface);
    scene.lights.push(LightRecord {
        kind: Kind::Spot as u32,
        position: [0.5, 1.5, -2.0],
        constant: 0.5,
        linear: 0.1,
        quadratic: 0.05,
        inverse_range: 0.125,
        direction: [0.0, -0.8, -0.6],
        cos_cutoff: 0.6,
        exponent: 2.0,
        inner_scale: 5.0,
        inner_offset: -3.0,
        ambient: [0.1; 3],
        diffuse: [0.3, 0.5, 0.4],
        specular: [0.5; 3],
    });
    scene.lists = vec![0, 1];
    for surface in &mut scene.surfaces {
        surface.lights.both.count = 2;
    }
    let turned = InstanceRecord {
        surface: 1,
        eye_from_model: [[0.8, 0.1, 0.0, 0.3], [0.0, 0.9, 0.2, 0.0], [0.1, 0.0, -0.7, -2.2]],
        ..at([0.0; 3], 1)
    };
    scene.instances = vec![at([0.0, -1.1, -2.0], 0), turned, at([-0.9, 0.0, -2.6], 1)];
    let call = |mesh: u32, pieces, instances, blend| DrawCall {
        mesh,
        instances,
        blend,
        cull: if blend { Cull::None } else { Cull::Back },
        ..draw(pieces, 0, Shading::Phong)
    };
    let mixed = DrawCall {
        clockwise: true,
        terms: Terms { diffuse: Frequency::Vertex, specular: Frequency::Fragment },
        reflectance: Reflectance::Phong,
        ..call(1, &glass, 1..2, true)
    };
    scene.draws = vec![call(0, &floor, 0..1, false), mixed, call(1, &glass, 2..3, true)];
    scene.meshes = vec![floor, glass];
    scene
}

fn scenes() -> Vec<(String, Scene)> {
    let mut scenes = Vec::new();
    for shading in Shading::ALL {
        scenes.push((format!("ball {shading:?}"), small(shading)));
    }
    for shading in [Shading::Flat, Shading::Gouraud] {
        let mut scene = small(shading);
        (scene.samples, scene.pixels) = (Samples::Four, PixelFormat::RawBytes);
        scenes.push((format!("ball {shading:?} with four samples, raw"), scene));
    }
    for samples in [Samples::One, Samples::Four] {
        for pixels in [PixelFormat::SrgbBytes, PixelFormat::Floats] {
            scenes.push((format!("floor and glass, {samples:?}, {pixels:?}"), floor_and_glass(samples, pixels)));
        }
    }
    scenes
}

/// The hashes of the ten pictures, the same on every machine. After a visible change the test prints new ones.
const HASHES: [u64; 10] = [
    0xc943_811b_9387_2d2d,
    0x07d0_5f52_2d48_715a,
    0x1225_8e91_e8b8_1f69,
    0x24b7_6c37_0b6c_1f94,
    0x78b8_ffb5_4a67_0c06,
    0xf6f5_606d_9594_d0df,
    0xff48_1d21_deb8_0ee6,
    0x36f9_073c_35ef_96b5,
    0x74f3_f8fb_9b59_2d5c,
    0x841e_22fb_3a42_b195,
];

/// Ensures that the pictures below are drawn with NEON on ARM.
#[test]
fn the_narrowest_width_is_what_every_cpu_of_the_target_has() {
    let always = if cfg!(target_arch = "aarch64") { VectorWidth::Neon } else { VectorWidth::Plain };
    assert_eq!(VectorWidth::available().last(), Some(always));
}

#[test]
fn ten_pictures_have_the_same_bits_on_every_simd_level() {
    let scenes = scenes();
    let mut found = Vec::new();
    for width in VectorWidth::available() {
        for threads in [1, 2, 3] {
            let options = RasterOptions { width: Some(width), threads: Some(threads) };
            let mut rasterizer = Rasterizer::new(options).expect("a width of this CPU");
            let hashes: Vec<_> = scenes.iter().map(|(_, scene)| hash_of_picture(scene, &mut rasterizer)).collect();
            // Drawn again, in memory that has been used.
            let again: Vec<_> = scenes.iter().map(|(_, scene)| hash_of_picture(scene, &mut rasterizer)).collect();
            assert_eq!(hashes, again, "{width} with {threads} threads draws differently the second time");
            found.push((width, threads, hashes));
        }
    }
    assert!(found.len() >= 3);
    for (width, threads, hashes) in &found {
        for (((name, _), hash), expected) in scenes.iter().zip(hashes).zip(&found[0].2) {
            assert_eq!(hash, expected, "{name} on {width} with {threads} threads");
        }
    }
    assert_eq!(found[0].2, HASHES, "all widths agree, but not with what they were: {:#018x?}", found[0].2);
}

/// A ball that the near plane cuts open, seen from both sides.
fn cut_open(shading: Shading, samples: Samples) -> Scene {
    let mut scene = small(shading);
    (scene.samples, scene.pixels) = (samples, PixelFormat::Floats);
    // Through triangles, and not along a row of vertices.
    scene.lens.near = 3.1;
    scene.draws[0].cull = Cull::None;
    scene
}

#[test]
fn no_picture_depends_on_those_before_it() {
    let cut = Shading::ALL.map(|shading| [Samples::One, Samples::Four].map(|samples| cut_open(shading, samples)));
    let scenes: Vec<_> = scenes().into_iter().map(|(_, scene)| scene).chain(cut.into_iter().flatten()).collect();
    let new = || Rasterizer::new(RasterOptions { threads: Some(1), ..RasterOptions::default() }).expect("threads");
    let alone: Vec<_> = scenes.iter().map(|scene| hash_of_picture(scene, &mut new())).collect();
    for (before, first) in scenes.iter().enumerate() {
        let mut rasterizer = new();
        for (after, second) in scenes.iter().enumerate() {
            hash_of_picture(first, &mut rasterizer);
            let found = hash_of_picture(second, &mut rasterizer);
            assert_eq!(found, alone[after], "picture {after} is another after picture {before}");
        }
    }
}

#[test]
fn pictures_differ_where_scenes_do() {
    let mut rasterizer = Rasterizer::new(RasterOptions::default()).expect("threads");
    let mut hashes: Vec<_> = scenes().iter().map(|(_, scene)| hash_of_picture(scene, &mut rasterizer)).collect();
    hashes.sort_unstable();
    hashes.dedup();
    assert_eq!(hashes.len(), 10);
}

/// Hidden surfaces are not lit; drawn far to near nothing is hidden, and the picture is the same to the bit. The balls
/// do not touch, so that no two surfaces have equal depths.
#[test]
fn order_changes_no_bit_of_what_is_opaque() {
    for shading in Shading::ALL {
        let mut scene = small(shading);
        let ball = ball(12, TriangleOrder::Clustered);
        scene.size = [150, 140];
        scene.lens = crate::common::lens(scene.size, 45.0);
        scene.instances = (0..256_u16)
            .map(|k| {
                let [x, y, z] = [k % 8, k / 8 % 4, k / 32].map(f32::from);
                at([2.3 * x - 8.17 + 0.13 * z, 2.2 * y - 3.41 - 0.11 * z, -14.0 - 2.6 * z - 0.01 * x], 0)
            })
            .collect();
        scene.draws = vec![draw(&ball, 256, shading)];
        scene.meshes = vec![ball];
        let mut rasterizer = Rasterizer::new(RasterOptions { threads: Some(1), ..RasterOptions::default() }).unwrap();
        let near_to_far = hash_of_picture(&scene, &mut rasterizer);
        scene.instances.reverse();
        assert_eq!(hash_of_picture(&scene, &mut rasterizer), near_to_far, "{shading:?}");
        // The farther half alone.
        scene.draws[0].instances.end = 128;
        assert_ne!(hash_of_picture(&scene, &mut rasterizer), near_to_far, "{shading:?}: half of the balls");
    }
}

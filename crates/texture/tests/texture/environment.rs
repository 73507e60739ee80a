//! Environments: directions, conversions, seams, lobes and matt surfaces.

use halfway_asset::Handle;
use halfway_texture::environment::{
    Environment, EnvironmentLight, EnvironmentMap, EnvironmentShape, Harmonics, from_cube, from_equirectangular,
    from_mirror_ball, on_cube, on_equirectangular, on_mirror_ball,
};
use halfway_texture::{TexelImage, TexelMeaning, TextureError, decode};
use image::{DynamicImage, ImageFormat, Rgb32FImage};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use std::io::Cursor;

const SHAPES: [EnvironmentShape; 3] =
    [EnvironmentShape::Equirectangular, EnvironmentShape::MirrorBall, EnvironmentShape::Cube];

fn unit(d: [f64; 3]) -> [f64; 3] {
    let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
    d.map(|x| x / length)
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [a, b] = [unit(a), unit(b)];
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

/// A direction, evenly over the sphere.
fn any_direction() -> impl Strategy<Value = [f64; 3]> {
    (-1.0..1.0_f64, 0.0..TAU).prop_map(|(z, angle)| {
        let ring = (1.0 - z * z).sqrt();
        [ring * angle.cos(), ring * angle.sin(), z]
    })
}

/// Light that changes slowly: a polynomial of the direction.
fn smooth([x, y, z]: [f64; 3]) -> [f32; 4] {
    [0.5 + 0.4 * x, 0.5 + 0.3 * y * z, 0.6 - 0.3 * z * z + 0.1 * y, 1.0].map(|number| number as f32)
}

#[test]
fn axes_lie_where_the_conventions_have_them() {
    let axes =
        [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    for (number, axis) in axes.into_iter().enumerate() {
        assert_eq!(on_cube(axis), (number, [0.5, 0.5]));
        assert_eq!(from_cube(number, [0.5, 0.5]), axis);
    }
    // Ahead is in the middle, right on the right, up at the top.
    assert_eq!(on_equirectangular([0.0, 0.0, -1.0]), [0.5, 0.5]);
    assert_eq!(on_equirectangular([1.0, 0.0, 0.0]), [0.75, 0.5]);
    assert_eq!(on_equirectangular([0.0, 1.0, 0.0_f64])[1], 0.0);
    // The middle of the ball shows the direction behind its viewer.
    assert_eq!(on_mirror_ball([0.0, 0.0, 1.0]), [0.5, 0.5]);
    let right = on_mirror_ball([1.0, 0.0, 0.0_f64]);
    assert!((right[0] - (0.5 + 0.5 * 0.5_f64.sqrt())).abs() < 1e-15 && right[1] == 0.5, "{right:?}");
    // The upper left corner of face +X points to (1, 1, 1).
    assert_eq!(from_cube(0, [0.0, 0.0]), [1.0, 1.0, 1.0]);
    for bad in [[0.0; 3], [f64::NAN; 3], [f64::INFINITY, 0.0, 0.0]] {
        let (face, uv) = on_cube(bad);
        assert!(face < 6 && uv.iter().all(|x| (0.0..=1.0).contains(x)), "{bad:?}: {face} {uv:?}");
        assert!(on_mirror_ball(bad).iter().all(|x| x.is_finite()));
    }
}

proptest! {
    /// Each direction meets one face, inside of it, and comes back; also in f32.
    #[test]
    fn each_direction_meets_its_face_and_comes_back(d in any_direction(), length in 1e-3..1e3_f64) {
        let (face, uv) = on_cube(d.map(|x| x * length));
        let axis = face / 2;
        prop_assert!((0..3).all(|k| d[axis].abs() >= d[k].abs()) && (d[axis] >= 0.0) == (face % 2 == 0));
        prop_assert!(uv.iter().all(|x| (0.0..=1.0).contains(x)));
        prop_assert!(apart(from_cube(face, uv), d) < 1e-15);
        prop_assert!(apart(from_equirectangular(on_equirectangular(d)), d) < 1e-14);
        // Toward −Z the last bit of a position is an ever larger angle: √ε.
        prop_assert!(apart(from_mirror_ball(on_mirror_ball(d)), d) < 4e-8);
        prop_assert!(d[2] < -0.99 || apart(from_mirror_ball(on_mirror_ball(d)), d) < 1e-13);
        let single = d.map(|x| x as f32);
        let (face, uv) = on_cube(single);
        prop_assert!(apart(from_cube(face, uv).map(f64::from), single.map(f64::from)) < 3e-7);
        prop_assert!(apart(from_equirectangular(on_equirectangular(single)).map(f64::from), d) < 2e-6);
        prop_assert!(d[2] < -0.9 || apart(from_mirror_ball(on_mirror_ball(single)).map(f64::from), d) < 1e-5);
    }

    /// Smooth light stays smooth across every seam.
    #[test]
    fn no_seam_is_seen(d in any_direction(), e in any_direction()) {
        let near: [f64; 3] = std::array::from_fn(|k| d[k] + 1e-4 * e[k]);
        for environment in environments() {
            for level in [0.0, 1.5, 3.0] {
                let [a, b] = [d, near].map(|d| environment.at(d, level));
                let shape = environment.shape();
                // All of the ball's rim is one direction, which lies in texels of both sides.
                let rim = shape == EnvironmentShape::MirrorBall && d[2] < -0.8;
                // The slope is below 1; near the poles texels of the height 1/32 crowd into one point.
                let steepest = if shape == EnvironmentShape::Equirectangular && d[1].abs() > 0.8 { 20.0 } else { 2.5 };
                prop_assert!(rim || (0..4).all(|k| (a[k] - b[k]).abs() < 1e-4 * steepest), "{shape:?} {level}: {a:?} {b:?}");
            }
        }
    }
}

/// One of each shape, 64 texels high or 32 of a cube.
fn environments() -> &'static [Environment] {
    static MADE: std::sync::OnceLock<Vec<Environment>> = std::sync::OnceLock::new();
    MADE.get_or_init(|| {
        let size = |shape| if shape == EnvironmentShape::Cube { 32 } else { 64 };
        SHAPES.map(|shape| Environment::from_fn(shape, size(shape), smooth).expect("a small environment")).into()
    })
}

/// Evenly over the sphere: the spiral of golden angles.
fn directions(count: u32) -> impl Iterator<Item = [f64; 3]> {
    (0..count).map(move |k| {
        let z = 1.0 - 2.0 * (f64::from(k) + 0.5) / f64::from(count);
        let (ring, angle) = ((1.0 - z * z).sqrt(), f64::from(k) * PI * (3.0 - 5.0_f64.sqrt()));
        [ring * angle.cos(), ring * angle.sin(), z]
    })
}

fn farthest(
    a: impl Fn([f64; 3]) -> [f64; 4],
    b: impl Fn([f64; 3]) -> [f64; 4],
    keep: impl Fn([f64; 3]) -> bool,
) -> f64 {
    let off = |d| (0..4).map(|k| (a(d)[k] - b(d)[k]).abs()).fold(0.0, f64::max);
    directions(4000).filter(|d| keep(*d)).map(off).fold(0.0, f64::max)
}

/// From each shape to each, and back, at these sizes: within 0.4 % of the range; of a ball up to 26° before −Z,
/// where its texels are long and thin.
#[test]
fn conversions_come_back() {
    let truth = |d| smooth(d).map(f64::from);
    let mut worst = 0.0_f64;
    for shape in SHAPES {
        let size = if shape == EnvironmentShape::MirrorBall { 256 } else { 96 };
        let first = Environment::from_fn(shape, size, smooth).expect("an environment");
        for other in SHAPES {
            let there =
                first.to_shape(other, if other == EnvironmentShape::MirrorBall { 256 } else { 96 }).expect("another");
            let back = there.to_shape(shape, size).expect("and back");
            let ball = [shape, other].contains(&EnvironmentShape::MirrorBall);
            let keep = |d: [f64; 3]| !ball || d[2] > -0.9;
            for found in [&there, &back] {
                let off = farthest(|d| found.at(d, 0.0), truth, keep);
                worst = worst.max(off);
                assert!(off < 4e-3, "{shape:?} to {other:?}, {:?}: {off}", found.shape());
            }
        }
    }
    println!("largest error of a conversion or a round trip: {worst:.2e}");
}

/// The size and the aspect of texels match the documentation of the shapes, by differences.
#[test]
fn texels_are_distorted_as_the_shapes_say() {
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let length = |d: [f64; 3]| d.iter().map(|x| x * x).sum::<f64>().sqrt();
    // The solid angle per area of the image, and the ratio of the sides of a square texel's image on the sphere.
    let measured = |shape, [u, v]: [f64; 2]| {
        let at = |u, v| {
            unit(match shape {
                EnvironmentShape::Equirectangular => from_equirectangular([u, v]),
                EnvironmentShape::MirrorBall => from_mirror_ball([u, v]),
                EnvironmentShape::Cube => from_cube(4, [u, v]),
            })
        };
        let step = 1e-6;
        let change = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| (a[k] - b[k]) / (2.0 * step)) };
        let [du, dv] = [change(at(u + step, v), at(u - step, v)), change(at(u, v + step), at(u, v - step))];
        (length(cross(du, dv)), length(du) / length(dv))
    };
    // Latitude 80°: a texel of an image twice as wide as high is cos 80° as wide as high.
    let (_, sides) = measured(EnvironmentShape::Equirectangular, [0.3, 10.0 / 180.0]);
    assert!((sides / 2.0 - 80_f64.to_radians().cos()).abs() < 1e-6);
    // The ball: 4 per unit of the disc's area, which is 16 per unit of u·v; at 0.9 of the radius sides differ as 1 to 1
    // − 0.81.
    for place in [[0.5, 0.5], [0.7, 0.2], [0.95, 0.5]] {
        let (solid_angle, _) = measured(EnvironmentShape::MirrorBall, place);
        assert!((solid_angle - 16.0).abs() < 1e-5, "{place:?}: {solid_angle}");
    }
    let (_, sides) = measured(EnvironmentShape::MirrorBall, [0.95, 0.5]);
    assert!((sides - 1.0 / 0.19).abs() < 1e-4, "{sides}");
    // The cube: a texel in a corner has 1/(3√3) of the solid angle of one in the middle.
    let [(middle, _), (corner, _)] = [[0.5, 0.5], [1.0, 1.0]].map(|place| measured(EnvironmentShape::Cube, place));
    assert!((middle / corner - 3.0 * 3.0_f64.sqrt()).abs() < 1e-4);
}

/// A matt surface under light that is a polynomial of order 1, whose convolution is known: L₀ + ⅔·L₁.
#[test]
fn matt_surfaces_receive_the_convolved_light() {
    let light = |[x, y, z]: [f64; 3]| [0.5 + 0.3 * x, 0.5 - 0.2 * y, 0.4 + 0.1 * z, 1.0].map(|number| number as f32);
    let expected = |[x, y, z]: [f64; 3]| [0.5 + 0.2 * x, 0.5 - 0.4 / 3.0 * y, 0.4 + 0.2 / 3.0 * z, 1.0];
    for shape in SHAPES {
        let harmonics = Environment::from_fn(shape, 64, light).expect("an environment").harmonics();
        let off = farthest(|d| harmonics.mean_light(d), expected, |_| true);
        // Texels on the ball's rim count whole or not at all.
        let bar = if shape == EnvironmentShape::MirrorBall { 2e-2 } else { 2e-3 };
        assert!(off < bar, "{shape:?}: {off}");
    }
}

/// For every shape, the weights add up to 1.
#[test]
fn convolution_keeps_uniform_light() {
    let light = [0.25, 3.0, 1e-3, 1.0];
    for shape in SHAPES {
        let harmonics = Environment::from_fn(shape, 32, |_| light).expect("an environment").harmonics();
        let constant = harmonics.polynomial()[0];
        let off = (0..3).map(|k| (constant[k] / f64::from(light[k]) - 1.0).abs()).fold(0.0, f64::max);
        assert!(off < 1e-6, "{shape:?}: {off}");
    }
}

/// Nine coefficients against the exact convolution: one far light is the worst case, with 3/32 of its peak; a sky is
/// better.
#[test]
fn second_order_harmonics_keep_their_error_bound() {
    let toward = unit([0.3, 0.8, -0.5]);
    let mut one = Harmonics::default();
    one.add_far_light(toward, [1.0; 4]);
    let exact = |d: [f64; 3]| [(0..3).map(|k| d[k] * toward[k]).sum::<f64>().max(0.0); 4];
    let off = farthest(|d| one.mean_light(d), exact, |_| true);
    assert!((off - 3.0 / 32.0).abs() < 1e-3, "{off}");
    let squares: f64 = directions(4000).map(|d| (one.mean_light(d)[0] - exact(d)[0]).powi(2)).sum();
    println!(
        "one far light: RMS {:.4}, largest {off:.4} of what a surface facing it receives",
        (squares / 4000.0).sqrt()
    );
    // A sky with a sun of 10°, against the sum over many directions.
    let sky = |d: [f64; 3]| {
        let sun = if exact(d)[0] > 5_f64.to_radians().cos() { 50.0 } else { 0.0 };
        [(0.4 + 0.6 * d[1].max(0.0) + sun) as f32; 4]
    };
    let environment = Environment::from_fn(EnvironmentShape::Cube, 64, sky).expect("an environment");
    let harmonics = environment.harmonics();
    let arriving: Vec<([f64; 3], f64)> = directions(20_000).map(|d| (d, f64::from(sky(d)[0]))).collect();
    let convolved = |n: [f64; 3]| {
        let cosine = |d: &[f64; 3]| (0..3).map(|k| n[k] * d[k]).sum::<f64>().max(0.0);
        4.0 * arriving.iter().map(|(d, light)| light * cosine(d)).sum::<f64>() / arriving.len() as f64
    };
    let (brightest, off) = directions(400).fold((0.0_f64, 0.0_f64), |(brightest, off), n| {
        let exact = convolved(n);
        (brightest.max(exact), off.max((harmonics.mean_light(n)[0] - exact).abs()))
    });
    println!("a sky with a sun: largest {:.4} of the brightest", off / brightest);
    assert!(off < 0.09 * brightest, "{off} of {brightest}");
}

/// A lookup by a level against the lobe (r·l)^α, integrated, in light with detail of every size.
#[test]
fn a_level_has_the_width_of_the_lobe() {
    let light = |[x, y, z]: [f64; 3]| {
        let waves =
            (3.0 * x).sin() * (4.0 * y).cos() + 0.7 * (9.0 * z + 4.0 * x).sin() + 0.5 * (17.0 * y - 8.0 * z).sin();
        [(1.0 + 0.4 * waves) as f32; 4]
    };
    let environment = Environment::from_fn(EnvironmentShape::Cube, 128, light).expect("an environment");
    for shininess in [3.0, 10.0, 50.0, 250.0] {
        let mut squares = [0.0; 3];
        let mut count = 0.0;
        for reflected in directions(60) {
            let (mut sum, mut weights) = (0.0, 0.0);
            for d in directions(20_000) {
                let cos: f64 = (0..3).map(|k| d[k] * reflected[k]).sum();
                if cos > 0.0 {
                    let weight = cos.powf(shininess);
                    weights += weight;
                    sum += weight * f64::from(light(d)[0]);
                }
            }
            let exact = sum / weights;
            // As wide as the lobe, and half and twice as wide, which must be worse.
            let exponents = [shininess, 4.0 * shininess + 9.0, 0.25 * (shininess + 3.0) - 3.0];
            let [matched, narrow, wide] = exponents.map(|alpha: f64| {
                let s = 2.0 / (alpha + 3.0).sqrt();
                environment.at(reflected, (s / environment.angle()).log2())[0]
            });
            for (square, found) in squares.iter_mut().zip([matched, narrow, wide]) {
                *square += (found - exact).powi(2);
            }
            count += 1.0;
        }
        let [matched, narrow, wide] = squares.map(|square| (square / count).sqrt());
        println!("α = {shininess}: RMS {matched:.4}; a level finer {narrow:.4}, a level coarser {wide:.4}");
        assert!(matched < narrow && matched < wide, "α = {shininess}: {matched}, {narrow}, {wide}");
    }
}

#[test]
fn images_that_make_no_environment_are_refused() {
    let image = |width, height| TexelImage::from_fn(width, height, |_, _| [1.0; 4]).expect("a small image");
    for (shape, images) in [
        (EnvironmentShape::Cube, vec![image(4, 4); 5]),
        (EnvironmentShape::Cube, vec![image(4, 3); 6]),
        (EnvironmentShape::Cube, [vec![image(4, 4); 5], vec![image(2, 2)]].concat()),
        (EnvironmentShape::MirrorBall, vec![image(4, 2)]),
        (EnvironmentShape::Equirectangular, Vec::new()),
    ] {
        let error = Environment::new(shape, images).expect_err("it is none");
        assert!(matches!(error, TextureError::Environment { .. }) && error.to_string().contains("expected"), "{error}");
    }
    assert!(matches!(Environment::from_fn(EnvironmentShape::Cube, 9000, smooth), Err(TextureError::TooLarge { .. })));
}

#[test]
fn there_is_no_light_below_zero() {
    let image = TexelImage::from_fn(8, 4, |x, y| [-0.1 * x as f32, y as f32, -1.0, 1.0]).expect("a small image");
    let environment = Environment::new(EnvironmentShape::Equirectangular, vec![image]).expect("any size");
    let map = EnvironmentMap::new(&environment).expect("a small one");
    let all = environment.images()[0].levels().len();
    let texels = (0..all).flat_map(|level| environment.images()[0].level(level)).chain(map.texels());
    assert!(texels.flatten().all(|number| *number >= 0.0));
    assert!(environment.images()[0].level(0).iter().any(|texel| texel[1] > 2.0), "what is above stays");
}

#[test]
fn hdr_files_are_read_and_nan_is_refused() {
    let image = Rgb32FImage::from_fn(4, 2, |x, y| image::Rgb([x as f32 * 3.0, y as f32 + 0.25, 1000.0]));
    let file = |image: &Rgb32FImage, format| {
        let mut bytes = Cursor::new(Vec::new());
        DynamicImage::from(image.clone()).write_to(&mut bytes, format).expect("room for an image");
        bytes.into_inner()
    };
    for (format, near) in [(ImageFormat::OpenExr, 0.0), (ImageFormat::Hdr, 0.01)] {
        let bytes = file(&image, format);
        let found = decode(&bytes, "sky", TexelMeaning::Color).expect("an image of floats");
        assert_eq!(found.size(), [4, 2]);
        let [r, g, b, a] = found.texels()[7];
        // The three numbers of a texel of HDR share an exponent, which is that of 1000.
        assert!(
            (r - 9.0).abs() <= near * 1000.0 && (g - 1.25).abs() <= near * 1000.0 && b == 1000.0 && a == 1.0,
            "{found:?}"
        );
        assert!(decode(&bytes[..bytes.len() / 2], "half", TexelMeaning::Color).is_err());
    }
    for wrong in [f32::NAN, f32::INFINITY] {
        let mut broken = image.clone();
        broken.put_pixel(2, 1, image::Rgb([0.0, wrong, 0.0]));
        let error =
            decode(&file(&broken, ImageFormat::OpenExr), "sky.exr", TexelMeaning::Color).expect_err("it is refused");
        assert!(error.to_string().starts_with("sky.exr: texel (2, 1) holds"), "{error}");
    }
}

/// A cube map of N texels a side, in which all directions differ.
fn waves(size: u32) -> Environment {
    let color =
        |[x, y, z]: [f64; 3]| [(3.0 * x).sin(), y - z, (2.0 * y).cos() + x * z, 1.0].map(|number| number as f32);
    Environment::from_fn(EnvironmentShape::Cube, size, color).unwrap()
}

/// Directions over the sphere, along axes, through seams and through corners.
fn all_directions() -> Vec<[f64; 3]> {
    let steps = (-4..=4).map(|step| f64::from(step) / 4.0);
    let grid =
        steps.clone().flat_map(|x| steps.clone().flat_map(move |y| [-1.0, -0.999, -0.3, 0.5, 1.0].map(|z| [x, y, z])));
    grid.flat_map(|[x, y, z]| [[x, y, z], [y, z, x], [z, x, y]]).collect()
}

#[test]
fn bordered_faces_agree_with_cube_maps() {
    for size in [1, 2, 5, 16] {
        let cube = waves(size);
        let map = EnvironmentMap::new(&cube).unwrap();
        assert_eq!(map.angle(), cube.angle());
        for direction in all_directions() {
            for level in [-1.0, 0.0, 0.4, 1.0, 2.7, 9.0] {
                let (expected, found) = (cube.at(direction, level), map.at(direction, level));
                for k in 0..3 {
                    let off = (expected[k] - found[k]).abs();
                    assert!(off < 1e-12, "{size}, {direction:?}, level {level}: {found:?} for {expected:?}");
                }
            }
        }
    }
}

/// Both sides of a seam agree: a step of 10⁻⁹ across it changes no more than that many texels do.
#[test]
fn no_seam_of_a_cube_is_seen_on_any_level() {
    let map = EnvironmentMap::new(&waves(8)).unwrap();
    for level in [0.0, 0.5, 1.0, 2.0, 3.0] {
        for t in [-1.0, -0.9, -0.37, 0.0, 0.5, 1.0] {
            for [a, b] in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
                let of = |d: [f64; 3]| map.at(d, level);
                for turn in 0..3 {
                    let turned = |[x, y, z]: [f64; 3]| [[x, y, z], [z, x, y], [y, z, x]][turn];
                    let [one, other] = [of(turned([a * (1.0 + 1e-9), b, t])), of(turned([a, b * (1.0 + 1e-9), t]))];
                    (0..3).for_each(|k| assert!((one[k] - other[k]).abs() < 1e-6, "{one:?} beside {other:?} at {t}"));
                }
            }
        }
    }
}

#[test]
fn the_polynomial_is_that_of_the_harmonics() {
    let harmonics = waves(16).harmonics();
    let c = harmonics.polynomial();
    for [x, y, z] in all_directions() {
        let length = (x * x + y * y + z * z).sqrt();
        let [x, y, z] = [x, y, z].map(|number| number / length);
        let terms = [1.0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y];
        let expected = harmonics.mean_light([x, y, z]);
        for k in 0..3 {
            let found: f64 = (0..9).map(|i| c[i][k] * terms[i]).sum();
            assert!((found - expected[k]).abs() < 1e-12, "{found} for {}", expected[k]);
        }
    }
}

#[test]
fn other_shapes_become_cubes_of_equal_resolution() {
    for (shape, size, side) in [
        (EnvironmentShape::Equirectangular, 64, 32),
        (EnvironmentShape::MirrorBall, 64, 23),
        (EnvironmentShape::Cube, 64, 64),
        (EnvironmentShape::Equirectangular, 1, 1),
    ] {
        let of = |[x, y, _]: [f64; 3]| [x as f32, y as f32, 0.5, 1.0];
        let map = EnvironmentMap::new(&Environment::from_fn(shape, size, of).unwrap()).unwrap();
        assert_eq!(map.levels()[0].side, side, "{shape:?}");
        assert!(map.levels().iter().all(|level| level.side > 0));
    }
    let light = EnvironmentLight::from(Handle::default());
    assert_eq!(light.wrong(), None);
    for strength in [f32::NAN, -1.0, f32::INFINITY] {
        let wrong = EnvironmentLight { strength, ..light.clone() }.wrong();
        assert_eq!(wrong.map(|wrong| wrong.field), Some("strength"));
    }
    let wrong = EnvironmentLight { rotation: f32::NAN, ..light }.wrong();
    assert_eq!(wrong.map(|wrong| wrong.field), Some("rotation"));
}

/// A quarter turn moves light from +X to −Z.
#[test]
fn rotation_is_counter_clockwise_from_above() {
    let light = EnvironmentLight { rotation: std::f32::consts::FRAC_PI_2, ..EnvironmentLight::from(Handle::default()) };
    let rows = light.environment_from_world();
    let found = rows.map(|[x, y, z]| x * 0.0 + y * 0.0 - z);
    assert!((found[0] - 1.0).abs() < 1e-6 && found[1].abs() < 1e-6 && found[2].abs() < 1e-6, "{found:?}");
}

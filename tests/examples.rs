//! Every example runs without a window, and its picture shows its subject.

use std::collections::HashSet;
use std::env::consts::EXE_SUFFIX;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use image::{RgbImage, imageops};

const SIZE: (u32, u32) = (160, 90);

/// The binary of an example, which Cargo builds beside this test.
fn binary(name: &str) -> PathBuf {
    let test = std::env::current_exe().expect("a running test has a path");
    let profile = test.ancestors().nth(2).expect("tests lie in target/PROFILE/deps");
    let binary = profile.join("examples").join(format!("{name}{EXE_SUFFIX}"));
    assert!(
        binary.is_file(),
        "{} is missing: `cargo test` builds the examples, but `cargo test --test` does not; run `cargo build --examples` \
         with the same profile first",
        binary.display()
    );
    binary
}

/// An empty folder of a test's own.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("examples").join(test);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).expect("the folder of an earlier run can be removed");
    }
    std::fs::create_dir_all(&folder).expect("a folder for pictures");
    folder
}

fn run(name: &str, file: &Path, more: &[&str]) -> Output {
    let size = format!("{}x{}", SIZE.0, SIZE.1);
    let mut command = Command::new(binary(name));
    command.arg("--headless").arg(file).args(["--size", &size]).args(more);
    // Only adapters count uploaded bytes.
    if std::env::var_os("HALFWAY_ADAPTER").is_none() {
        command.env("HALFWAY_ADAPTER", "gpu");
    }
    command.output().expect("the example can be started")
}

/// Runs an example that must succeed; gives what it printed.
fn draw(name: &str, file: &Path, more: &[&str]) -> String {
    let output = run(name, file, more);
    let (printed, said) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.status.code(), Some(0), "{name}: {printed}\n{said}");
    printed.into_owned()
}

/// The picture, which has the size that was asked for and is not of one colour.
fn picture(file: &Path) -> RgbImage {
    let picture = image::open(file).unwrap_or_else(|error| panic!("{}: {error}", file.display())).into_rgb8();
    assert_eq!(picture.dimensions(), SIZE, "{}", file.display());
    assert!(colors(&picture) > 1, "{} is of one colour", file.display());
    picture
}

fn colors(picture: &RgbImage) -> usize {
    picture.pixels().collect::<HashSet<_>>().len()
}

#[test]
fn textures() {
    let file = folder("textures").join("textures.png");
    draw("textures", &file, &[]);
    let picture = image::open(&file).expect("a picture").to_rgb8();
    let (width, height) = picture.dimensions();
    // Without mipmaps the far end of a floor is a moiré pattern, with them one color.
    let spread = |from: f32| {
        let row = (from * height as f32) as u32;
        let reds: Vec<u8> = (0..width / 12).map(|x| picture.get_pixel(width * 5 / 12 + x / 2, row).0[2]).collect();
        reds.iter().max().zip(reds.iter().min()).map_or(0, |(most, least)| most - least)
    };
    assert!(spread(0.28) > 60 && spread(0.785) < 20, "{} and {}", spread(0.28), spread(0.785));
}

#[test]
fn environment() {
    let file = folder("environment").join("environment.png");
    draw("environment", &file, &[]);
    let picture = picture(&file);
    // The middle of the upper ball of each column: its reflection shows more contrast the higher the exponent is.
    let spread = |column: u32| {
        let x = SIZE.0 * (2 * column + 1) / 10 - 6;
        let middle = imageops::crop_imm(&picture, x, SIZE.1 * 2 / 5 - 6, 12, 12).to_image();
        let greens = || middle.pixels().map(|pixel| pixel.0[1]);
        greens().max().zip(greens().min()).map_or(0, |(most, least)| most - least)
    };
    assert!(spread(0) < 40 && spread(4) > 60, "{} and {}", spread(0), spread(4));
}

#[test]
fn solid_noise() {
    let file = folder("solid_noise").join("solid_noise.png");
    draw("solid_noise", &file, &[]);
    let picture = picture(&file);
    // The floor: near by two colors, toward the horizon one.
    let spread = |row: u32| {
        let greens = || (0..SIZE.0).map(|x| picture.get_pixel(x, row).0[1]);
        greens().max().zip(greens().min()).map_or(0, |(most, least)| most - least)
    };
    let (near, far) = (spread(SIZE.1 - 3), spread(FAR_ROW));
    assert!(near > 80 && far < 25, "{near} and {far}");
}

/// A row of that picture above all objects and below the horizon.
const FAR_ROW: u32 = 14;

#[test]
fn bumps() {
    let file = folder("bumps").join("bumps.png");
    let printed = draw("bumps", &file, &[]);
    let of = |name: &str| {
        let line = printed.lines().find(|line| line.starts_with(name)).unwrap_or_else(|| panic!("{name}: {printed}"));
        line.split_whitespace().last().and_then(|number| number.parse::<f64>().ok()).expect("a number")
    };
    let [none, bumps, normals] = ["no image", "bump map", "normal map"].map(of);
    assert!(bumps < 0.6 * none && (normals / bumps - 1.0).abs() < 0.15, "{printed}");
    picture(&file);
}

#[test]
fn baked_occlusion() {
    let file = folder("baked_occlusion").join("baked_occlusion.png");
    let printed = draw("baked_occlusion", &file, &[]);
    assert!(printed.contains("stone: 256 × 128 texels of 128 rays") && printed.contains("floor: 96 × 96"), "{printed}");
    let picture = picture(&file);
    // The right half is darker than the left one, and nowhere brighter by more than parallax explains.
    let light = |left: u32| {
        let half = imageops::crop_imm(&picture, left, SIZE.1 / 4, SIZE.0 / 2, SIZE.1 / 2).to_image();
        half.pixels().map(|pixel| u64::from(pixel.0[1])).sum::<u64>() / u64::from(SIZE.0 / 2 * SIZE.1 / 2)
    };
    let [without, with] = [light(0), light(SIZE.0 / 2)];
    assert!(with + 10 < without, "{with}, {without} without");
}

#[test]
fn scalars() {
    let file = folder("scalars").join("scalars.png");
    draw("scalars", &file, &[]);
    let picture = picture(&file);
    // The map's ends are both there: violet valleys and yellow hills, and blue and red faces of the ball.
    let count = |is: fn([i32; 3]) -> bool| picture.pixels().filter(|pixel| is(pixel.0.map(i32::from))).count();
    assert!(count(|[r, g, b]| r > b + 80 && g > b + 80) > 200, "yellow");
    assert!(count(|[r, g, b]| r > g + 30 && b > g + 40) > 200, "violet");
    assert!(count(|[r, g, b]| r > g + 100 && r > b + 60) > 30, "red");
    assert!(count(|[r, g, b]| b > r + 80 && b > g + 20) > 30, "blue");
}

#[test]
fn isometric() {
    let file = folder("isometric").join("isometric.png");
    draw("isometric", &file, &[]);
    let picture = picture(&file);
    // Down the middle lie the farthest block, the teapot and the nearest block: the blocks are equally high.
    let is_brown =
        |&y: &u32| picture.get_pixel(SIZE.0 / 2 - 4, y).0[0] > picture.get_pixel(SIZE.0 / 2 - 4, y).0[2] + 25;
    let far = (0..SIZE.1).skip_while(|y| !is_brown(y)).take_while(is_brown).count();
    let near = (0..SIZE.1).rev().skip_while(|y| !is_brown(y)).take_while(is_brown).count();
    assert!(far > 10 && far.abs_diff(near) <= 1, "{far} and {near} pixels");
}

#[test]
fn teapots() {
    let file = folder("teapots").join("teapots.png");
    let printed = draw("teapots", &file, &[]);
    assert!(printed.contains("24 teapots of 24 materials"), "{printed}");
    picture(&file);
}

#[test]
fn shading_frequencies() {
    let file = folder("shading_frequencies").join("shading_frequencies.png");
    draw("shading_frequencies", &file, &[]);
    let picture = picture(&file);
    // The coarse teapot: one colour a triangle on the left, where Phong shading on the right has highlights.
    let cell =
        |column| colors(&imageops::crop_imm(&picture, column * SIZE.0 / 3, 0, SIZE.0 / 3, SIZE.1 / 2).to_image());
    let [flat, gouraud, phong] = [0, 1, 2].map(cell);
    assert!(flat < gouraud && flat < phong, "{flat} {gouraud} {phong}");
}

#[test]
fn moving_lights() {
    let folder = folder("moving_lights");
    draw("moving_lights", &folder.join("{}.png"), &["--frames", "2"]);
    let [first, second] = ["0000.png", "0001.png"].map(|name| picture(&folder.join(name)));
    assert!(first != second, "nothing moves");

    let cube = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/cube.smf");
    draw("moving_lights", &folder.join("cube.png"), &["--model", cube]);
    assert!(picture(&folder.join("cube.png")) != first, "--model makes no difference");

    let output = run("moving_lights", &folder.join("none.png"), &["--model", "no/such.obj"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("no/such.obj"), "{said}");
}

#[test]
fn normal_weightings() {
    let file = folder("normal_weightings").join("normal_weightings.png");
    draw("normal_weightings", &file, &[]);
    let picture = picture(&file);
    let cells: HashSet<_> = (0..4)
        .map(|column| imageops::crop_imm(&picture, column * SIZE.0 / 4, 0, SIZE.0 / 4, SIZE.1).to_image().into_raw())
        .collect();
    assert_eq!(cells.len(), 4, "the weightings differ");
}

#[test]
fn crease_angles() {
    let file = folder("crease_angles").join("crease_angles.png");
    draw("crease_angles", &file, &[]);
    let picture = picture(&file);
    // One colour a face on the left.
    let cell = |column| colors(&imageops::crop_imm(&picture, column * SIZE.0 / 3, 0, SIZE.0 / 3, SIZE.1).to_image());
    let [faceted, creased, smooth] = [0, 1, 2].map(cell);
    assert!(faceted < creased && creased < smooth, "{faceted} {creased} {smooth}");
}

#[test]
fn homework() {
    // I = ((1 − t)·n1·l + t·n2·l) / d by Gouraud with d = 1, by Phong with d = |(1 − t)·n1 + t·n2|, t = 0, 1/9 … 1.
    let table = [
        ["0.5615", "0.5615"],
        ["0.5901", "0.5969"],
        ["0.6188", "0.6314"],
        ["0.6474", "0.6646"],
        ["0.6761", "0.6961"],
        ["0.7047", "0.7256"],
        ["0.7334", "0.7528"],
        ["0.7620", "0.7776"],
        ["0.7907", "0.7998"],
        ["0.8193", "0.8193"],
    ];
    let file = folder("homework").join("homework.png");
    let printed = draw("homework", &file, &[]);
    let picture = picture(&file);
    for (i, [gouraud, phong]) in table.into_iter().enumerate() {
        let number = (i + 1).to_string();
        let row = [number.as_str(), gouraud, "0.0000", "0.0000", phong, "0.0000", "0.0000"];
        assert!(printed.lines().any(|line| line.split_whitespace().eq(row)), "{row:?} is not in\n{printed}");
        for (y, red) in [(SIZE.1 / 5, gouraud), (SIZE.1 / 2, phong)] {
            let at = (SIZE.0 / 20 + i as u32 * SIZE.0 / 10, y);
            let [r, g, b] = picture.get_pixel(at.0, at.1).0;
            let expected = 255.0 * red.parse::<f64>().expect("a number");
            // Half a step of 1/255, and what the four digits of the table leave out.
            assert!((f64::from(r) - expected).abs() < 0.52, "{at:?}: {r}, expected {expected}");
            assert_eq!([g, b], [0, 0], "{at:?}");
        }
    }
}

#[test]
fn engine_module() {
    let file = folder("engine_module").join("engine_module.png");
    let printed = draw("engine_module", &file, &["--frames", "4"]);
    picture(&file);
    let rows: Vec<Vec<u64>> = printed
        .lines()
        .skip(1)
        .take(4)
        .map(|line| line.split_whitespace().map(|number| number.parse().expect("a count")).collect())
        .collect();
    // Matrices and bytes by frame: everything, what turned, nothing.
    let [matrices, bytes] = [4, 5].map(|column| rows.iter().map(|row| row[column]).collect::<Vec<_>>());
    assert_eq!(matrices, [10, 9, 0, 0], "{printed}");
    // The CPU reads in place the data that is uploaded to wgpu for turning objects.
    let on_the_cpu = std::env::var("HALFWAY_ADAPTER").is_ok_and(|name| name.starts_with("cpu"));
    assert!(bytes[0] > bytes[1] && (bytes[1] > 0) != on_the_cpu && bytes[2..] == [0, 0], "{printed}");
}

#[test]
fn lines_pass() {
    let file = folder("lines_pass").join("lines_pass.png");
    draw("lines_pass", &file, &[]);
    let picture = picture(&file);
    // One channel is far above both others, as it is nowhere in brass.
    let is_of = |axis: usize, pixel: [u8; 3]| {
        (0..3).all(|other| other == axis || u32::from(pixel[axis]) > 60 + 2 * u32::from(pixel[other]))
    };
    let along = |axis: usize| picture.pixels().filter(|pixel| is_of(axis, pixel.0)).count();
    let on_the_cpu = std::env::var("HALFWAY_ADAPTER").is_ok_and(|name| name.starts_with("cpu"));
    let counts = [0, 1, 2].map(along);
    assert!(counts.iter().all(|&count| if on_the_cpu { count == 0 } else { count > 20 }), "{counts:?}");
    // The teapot hides the origin, which lies in the middle of the picture.
    let middle = imageops::crop_imm(&picture, SIZE.0 / 2 - 4, SIZE.1 / 2 - 3, 8, 6).to_image();
    assert!(middle.pixels().all(|pixel| (0..3).all(|axis| !is_of(axis, pixel.0))), "a line is before the teapot");
}

#[test]
fn engine_scene() {
    // The engine has a device, so that there is none on the CPU.
    if std::env::var("HALFWAY_ADAPTER").is_ok_and(|name| name.starts_with("cpu")) {
        return;
    }
    let file = folder("engine_scene").join("engine_scene.png");
    draw("engine_scene", &file, &[]);
    let picture = picture(&file);
    let is_blue = |pixel: &image::Rgb<u8>| pixel.0[2] > pixel.0[0] && pixel.0[2] > 110;
    let is_brass = |pixel: &image::Rgb<u8>| u32::from(pixel.0[0]) > 40 + u32::from(pixel.0[2]);
    let count = |is: &dyn Fn(&image::Rgb<u8>) -> bool| picture.pixels().filter(|pixel| is(pixel)).count();
    assert!(count(&is_blue) > 300 && count(&is_brass) > 500, "{} {}", count(&is_blue), count(&is_brass));
    // In the middle column the teapot hides the pillar behind it, and the one before it hides the teapot.
    let column: Vec<_> = (0..SIZE.1).map(|y| *picture.get_pixel(SIZE.0 / 2, y)).collect();
    let last_brass = column.iter().rposition(is_brass).expect("the teapot shows");
    assert!(column[last_brass..].iter().filter(|pixel| is_blue(pixel)).count() > 3, "no pillar is before the teapot");
}

#[test]
fn waves() {
    let file = folder("waves").join("waves.png");
    draw("waves", &file, &["--frames", "3"]);
    picture(&file);
}

#[test]
fn soak() {
    let run = |more: &[&str]| {
        let mut command = Command::new(binary("soak"));
        let output = command.args(["--frames", "3000"]).args(more).output().expect("the example can be started");
        (output.status.code(), format!("{output:?}"))
    };
    let (code, said) = run(&[]);
    assert_eq!(code, Some(0), "{said}");
    let (code, said) = run(&["--leak"]);
    assert!(code == Some(1) && said.contains("memory grows"), "a leak is not found: {said}");
}

#[test]
fn arguments_that_are_not_understood_are_refused() {
    let file = folder("arguments").join("teapots.png");
    let output = run("teapots", &file, &["--colour", "red"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("--colour") && !file.exists(), "{said}");
}

//! `halfway demo`.

use std::ffi::OsString;
use std::path::Path;

use clap::{Args, Parser};
use tempfile::TempDir;

use crate::failure::Failure;
use crate::render::{self, RenderArgs};
#[cfg(feature = "window")]
use crate::view::{self, ViewArgs};

#[derive(Args, Debug)]
pub(crate) struct DemoArgs {
    /// The example; without a name all of them are listed
    name: Option<String>,
    /// Options of `halfway view`, or, with -o FILE, those of `halfway render`
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    options: Vec<OsString>,
}

/// An example that is a scene or a model with a camera.
struct Demo {
    name: &'static str,
    /// By its path in the repository.
    file: &'static str,
    about: &'static str,
}

const fn scene(name: &'static str, file: &'static str, about: &'static str) -> Demo {
    Demo { name, file, about }
}

const DEMOS: [Demo; 14] = [
    scene("brass_teapot", "examples/scenes/brass_teapot.json", "A brass teapot under the sun and a bluish lamp"),
    scene("drawing", "examples/scenes/drawing.json", "Solids as a technical drawing, with their sharp edges as lines"),
    scene("fish", "assets/fish.glb", "A fish that swims: skins and morph targets of a glTF model"),
    scene("four_views", "examples/scenes/four_views.json", "Four cameras share one picture"),
    scene("key_frames", "examples/scenes/key_frames.json", "Objects, lights and a camera that move by key frames"),
    scene("lantern", "examples/scenes/lantern.json", "A glTF model that brings its own lights"),
    scene("light_kinds", "examples/scenes/light_kinds.json", "Point, spot and directional lights beside each other"),
    scene("lines_and_points", "examples/scenes/lines_and_points.json", "Lit lines, points, axes and a grid"),
    scene("material_spheres", "examples/scenes/material_spheres.json", "Spheres of textbook materials"),
    scene("moonlit_table", "examples/scenes/moonlit_table.json", "A teapot on a table, under the moon and two lamps"),
    scene(
        "shading_frequencies",
        "examples/scenes/shading_frequencies.json",
        "Flat, Gouraud and Phong shading, coarse and fine",
    ),
    scene("surfaces", "examples/scenes/surfaces.json", "Every surface that is known by a formula"),
    scene("textured_models", "examples/scenes/textured_models.json", "Images on models: colours, bumps and normals"),
    scene("transforms", "examples/scenes/transforms.json", "Objects turned, stretched, sheared and mirrored"),
];

/// Examples that are Rust programs.
const PROGRAMS: [(&str, &str); 19] = [
    ("baked_occlusion", "Ambient occlusion, baked by rays into an image"),
    ("bumps", "One height image as a bump map, as a normal map and as displacement"),
    ("crease_angles", "Normals that are split where faces meet at an angle"),
    ("engine_module", "Lighting and rendering as modules of another engine"),
    ("engine_scene", "A teapot in a scene that another engine draws"),
    ("environment", "Balls lit by a sky alone, dull to shining"),
    ("first_picture", "The first program of the README"),
    ("homework", "An exercise, computed and drawn: Gouraud and Phong along a line"),
    ("isometric", "A town of blocks before an orthographic camera"),
    ("lines_pass", "A rendering pass of your own"),
    ("moving_lights", "Five teapots at night, under lights that move with their parents"),
    ("normal_weightings", "Four ways of averaging the normals around a vertex"),
    ("scalars", "Numbers on meshes, as colours"),
    ("shading_frequencies", "Flat, Gouraud and Phong shading; 1, 2 and 3 choose one for all"),
    ("solid_noise", "Wood, marble and noise that fill space"),
    ("teapots", "Twenty-four teapots that differ only in their material"),
    ("textures", "One checker by twelve texture filters"),
    ("three_shadings", "The first picture of the README"),
    ("waves", "A sheet in the wind: new positions and normals in each frame"),
];

/// A file by its path in the repository, and its content.
type Embedded = (&'static str, &'static [u8]);

macro_rules! embedded {
    ($($path:literal),* $(,)?) => {
        [$(($path, include_bytes!(concat!("../../../", $path)).as_slice())),*]
    };
}

/// The scenes and the files that they refer to.
const FILES: [Embedded; 24] = embedded![
    "examples/scenes/brass_teapot.json",
    "examples/scenes/drawing.json",
    "examples/scenes/four_views.json",
    "examples/scenes/key_frames.json",
    "examples/scenes/lantern.json",
    "examples/scenes/light_kinds.json",
    "examples/scenes/lines_and_points.json",
    "examples/scenes/material_spheres.json",
    "examples/scenes/moonlit_table.json",
    "examples/scenes/shading_frequencies.json",
    "examples/scenes/surfaces.json",
    "examples/scenes/textured_models.json",
    "examples/scenes/transforms.json",
    "assets/ball.glb",
    "assets/crate.mtl",
    "assets/crate.obj",
    "assets/crate.png",
    "assets/crate_height.png",
    "assets/cube.smf",
    "assets/fish.glb",
    "assets/helix.obj",
    "assets/lantern.glb",
    "assets/teapot.mtl",
    "assets/teapot.obj",
];

#[derive(Debug, Parser)]
#[command(name = "halfway demo", override_usage = "halfway demo NAME -o FILE [OPTIONS]")]
struct RenderLine {
    #[command(flatten)]
    args: RenderArgs,
}

#[cfg(feature = "window")]
#[derive(Debug, Parser)]
#[command(name = "halfway demo", override_usage = "halfway demo NAME [OPTIONS]")]
struct ViewLine {
    #[command(flatten)]
    args: ViewArgs,
}

impl DemoArgs {
    /// Whether a window is opened.
    pub(crate) fn has_window(&self) -> bool {
        cfg!(feature = "window") && self.name.is_some() && !self.writes_a_picture()
    }

    fn writes_a_picture(&self) -> bool {
        let names_output = |option: &str| {
            let is_short = option.starts_with("-o") && !option.starts_with("--");
            is_short || option == "--output" || option.starts_with("--output=")
        };
        self.options.iter().filter_map(|option| option.to_str()).any(names_output)
    }

    /// The command line of `render` or `view` for this file.
    fn line(&self, file: &Path) -> Vec<OsString> {
        let start = ["halfway demo".into(), file.into()];
        start.into_iter().chain(self.options.iter().cloned()).collect()
    }
}

pub(crate) fn run(args: &DemoArgs) -> Result<(), Failure> {
    let Some(name) = &args.name else {
        print!("{}", listed());
        return Ok(());
    };
    let demo = find(name)?;
    let folder = unpack().map_err(|error| format!("the files of the example: {error}"))?;
    let line = args.line(&folder.path().join(demo.file));
    #[cfg(feature = "window")]
    if args.has_window() {
        return view::run(&ViewLine::parse_from(line).args);
    }
    render::run(&RenderLine::parse_from(line).args)
}

fn find(name: &str) -> Result<&'static Demo, String> {
    DEMOS.iter().find(|demo| demo.name == name).ok_or_else(|| {
        if PROGRAMS.iter().any(|(program, _)| *program == name) {
            let command = format!("cargo run --release --example {name}");
            return format!("{name} is a Rust program; run it in a checkout of the repository by `{command}`");
        }
        let names: Vec<&str> = DEMOS.iter().map(|demo| demo.name).collect();
        format!("no example is called {name}; expected {}", names.join(", "))
    })
}

/// Writes the files into a folder that is removed when the value is dropped, in the folders that they have in the
/// repository, since scenes refer to models by relative paths.
fn unpack() -> std::io::Result<TempDir> {
    let folder = tempfile::Builder::new().prefix("halfway-demo-").tempdir()?;
    for (path, content) in FILES {
        let file = folder.path().join(path);
        file.parent().map_or(Ok(()), std::fs::create_dir_all)?;
        std::fs::write(file, content)?;
    }
    Ok(folder)
}

/// The list of all examples.
fn listed() -> String {
    let row = |(start, about): (String, &str)| format!("  {start:51}{about}\n");
    let demos = DEMOS.iter().map(|demo| (format!("halfway demo {}", demo.name), demo.about));
    let programs = PROGRAMS.iter().map(|(name, about)| (format!("cargo run --release --example {name}"), *about));
    format!(
        "Scenes, shown in a window, or drawn into a picture with -o FILE:\n\n{}\nRust programs, run in a checkout of the \
         repository:\n\n{}",
        demos.map(row).collect::<String>(),
        programs.map(row).collect::<String>()
    )
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// The names of the files with this ending in a folder of the repository.
    fn files(folder: &str, ending: &str) -> BTreeSet<String> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(folder);
        let files = std::fs::read_dir(folder).expect("a folder of the repository");
        let paths = files.map(|file| file.expect("a file").path());
        let chosen = paths.filter(|path| path.extension().is_some_and(|found| found == ending));
        chosen.map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn every_example_is_listed() {
        let scenes =
            DEMOS.iter().filter(|demo| demo.file.starts_with("examples/scenes/")).map(|demo| demo.name.to_owned());
        assert_eq!(scenes.collect::<BTreeSet<_>>(), files("examples/scenes", "json"));
        assert_eq!(BTreeSet::from(PROGRAMS.map(|(name, _)| name.to_owned())), files("examples", "rs"));
        let list = listed();
        for line in list.lines() {
            assert!(line.chars().count() <= 120, "{line}");
        }
        assert!(DEMOS.iter().all(|demo| list.contains(&format!("halfway demo {} ", demo.name))), "{list}");
    }

    #[test]
    fn the_files_are_small() {
        let bytes: usize = FILES.iter().map(|(_, content)| content.len()).sum();
        assert!(bytes <= 2_000_000, "{bytes} bytes");
    }

    #[test]
    fn a_picture_is_written_where_a_file_is_named() {
        let rows = [
            ("", false),
            ("--shading flat", false),
            ("--ortho", false),
            ("--outside", false),
            ("-o a.png", true),
            ("-oa.png", true),
            ("--size 8x8 --output a.png", true),
            ("--output=a.png", true),
        ];
        for (options, expected) in rows {
            let options = options.split_whitespace().map(OsString::from).collect();
            assert_eq!(DemoArgs { name: None, options }.writes_a_picture(), expected);
        }
    }
}

//! The conformance suite: named scenes, each drawn by the renderer and by the oracle, in floating point and in bytes of
//! both encodings.
//!
//! There is a row for every value of every axis, one for every pair of values that a scene can have together
//! (`conformance/axes.rs`), and one for every feature beside the axes (`conformance/features.rs`).

mod axes;
pub(crate) mod colors;
pub(crate) mod environment;
mod features;
pub(crate) mod maps;
mod on_the_cpu;
pub(crate) mod policies;
pub(crate) mod solids;

use crate::render::compare::{BLENDED, FLOAT, Failures, SELECTED, SRGB, judge};
use crate::render::scene::{Scene, Thing};
use crate::render::stage::Stage;
use halfway::prelude::*;
use halfway::reference::Image;
use halfway::reference::metrics::{Bars, Verdict};
use halfway::render::RenderError;
use halfway::texture::FarNormals;

/// Small, and no multiple of anything: rows of pixels are padded on their way back.
const SIZE: UVec2 = UVec2::new(76, 60);

/// A scene with a name, and the bars of its pictures.
struct Row {
    name: String,
    scene: Scene,
    float: Bars,
    raw: Bars,
    srgb: Bars,
}

impl Row {
    fn new(name: impl Into<String>, scene: Scene) -> Self {
        let raw = if scene.things.iter().any(|thing| thing.blend) {
            BLENDED
        } else if scene.lamps.len() > 8 {
            SELECTED
        } else {
            Bars::bytes(Encoding::Raw)
        };
        Self { name: name.into(), scene, float: FLOAT, raw, srgb: SRGB }
    }
}

/// The CPU's curve is within a 600th of a step. But it is steeper than bare values in the dark, and a facet of flat
/// shading, which is a hundredth of some pictures, turns over as a whole.
const CPU_SRGB: Bars = Bars { equal: 0.98, ..Bars::bytes(Encoding::Srgb) };

impl Scene {
    /// Whether it has colours of vertices, images, solids or an environment.
    fn compiles_slowly(&self) -> bool {
        let has_texture = |thing: &Thing| !thing.maps.is_empty() || thing.mask.is_some() || thing.solid.is_some();
        let has_colors = |thing: &Thing| thing.mesh.colors().is_some();
        self.environment.is_some() || self.things.iter().any(|thing| has_colors(thing) || has_texture(thing))
    }

    /// Whether the CPU's bytes in sRGB are as exact as bare ones.
    fn is_encoded_once(&self) -> bool {
        if self.camera.intensity.acts_on_pictures() {
            return true;
        }
        let is_blended = self.things.iter().any(|thing| thing.blend);
        !is_blended && self.camera.samples == Samples::One && self.lamps.len() <= 8
    }
}

/// The worst figures of a table, and the rows that have them.
#[derive(Default)]
struct Worst {
    most: (f64, String),
    all: (f64, String),
    steps: (f64, String),
    unequal: (f64, String),
    unequal_srgb: (f64, String),
    edges: (f64, String),
}

impl Worst {
    /// Notes those of a row, of the pictures that were drawn of it.
    fn note(&mut self, name: &str, float: Option<Verdict>, [raw, srgb]: [Option<Verdict>; 2]) {
        let of = |verdict: &Option<Verdict>, figure: fn(&Verdict) -> f64| verdict.as_ref().map_or(0.0, figure);
        let of_all = |figure: fn(&Verdict) -> f64| [&float, &raw, &srgb].map(|it| of(it, figure)).into_iter();
        for (worst, figure) in [
            (&mut self.most, of(&float, |float| float.most)),
            (&mut self.all, of(&float, |float| float.worst)),
            (&mut self.steps, of(&raw, |raw| raw.worst).max(of(&srgb, |srgb| srgb.worst))),
            // Where the bar is lower, its constant says why.
            (&mut self.unequal, of(&raw, |raw| if raw.bars.equal > 0.5 { 1.0 - raw.equal } else { 0.0 })),
            (&mut self.unequal_srgb, of(&srgb, |srgb| 1.0 - srgb.equal)),
            (&mut self.edges, of_all(|verdict| verdict.edges).fold(0.0, f64::max)),
        ] {
            if figure > worst.0 {
                *worst = (figure, name.into());
            }
        }
    }

    fn print(&self, title: &str, rows: usize, drawn_by: &str) {
        println!("drawn by {drawn_by}");
        println!("{title}: {rows} rows; off edges, the worst of each figure:");
        println!("  float, 99.9 % of the channels: {:.1e} of the range ({})", self.most.0, self.most.1);
        println!("  float, all: {:.1e} of the range ({})", self.all.0, self.all.1);
        println!("  bytes, all: {} steps ({})", self.steps.0, self.steps.1);
        println!("  raw bytes of opaque rows, pixels not equal: {:.2} % ({})", self.unequal.0 * 100.0, self.unequal.1);
        println!("  sRGB bytes, pixels not equal: {:.2} % ({})", self.unequal_srgb.0 * 100.0, self.unequal_srgb.1);
        println!("  pixels on edges: {:.2} % ({})", self.edges.0 * 100.0, self.edges.1);
    }
}

/// The share of rows that is drawn, of those that drivers compile slowly (vertex colours, images, solids,
/// environments): one of each `of` consecutive rows, by its number. `HALFWAY_SHARE=1/3` selects the first of three; the
/// default is all. Each row of a share is drawn in floating point and in one encoding, raw and sRGB by turns.
struct Share {
    number: usize,
    of: usize,
}

impl Share {
    fn of_environment() -> Self {
        let said = std::env::var("HALFWAY_SHARE").ok();
        said.map_or(Self { number: 1, of: 1 }, |said| Self::read(&said).unwrap_or_else(|wrong| panic!("{wrong}")))
    }

    fn read(said: &str) -> Result<Self, String> {
        let read = said.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        let (number, of) = read.ok_or_else(|| format!("HALFWAY_SHARE is {said}; expected two numbers, as in 1/3"))?;
        if (1..=of).contains(&number) {
            return Ok(Self { number, of });
        }
        Err(format!("HALFWAY_SHARE is {said}; expected a number from 1 to {of} first"))
    }

    fn has(&self, place: usize, row: &Row) -> bool {
        !row.scene.compiles_slowly() || place % self.of == self.number - 1
    }

    /// The encodings in which a row of it is drawn.
    fn encodings(&self, place: usize, row: &Row) -> &'static [Encoding] {
        let both = &[Encoding::Raw, Encoding::Srgb];
        if self.of == 1 || !row.scene.compiles_slowly() {
            return both;
        }
        let turn = place / self.of % 2;
        &both[turn..=turn]
    }
}

#[test]
fn shares_that_are_none_are_refused() {
    assert_eq!(Share::read("2/3").map(|share| (share.number, share.of)), Ok((2, 3)));
    for (said, told) in [
        ("", "two numbers"),
        ("a third", "two numbers"),
        ("1", "two numbers"),
        ("-1/3", "two numbers"),
        ("0/3", "from 1 to 3"),
        ("4/3", "from 1 to 3"),
        ("1/0", "from 1 to 0"),
    ] {
        let wrong = Share::read(said).map(|share| share.number);
        assert!(wrong.as_ref().is_err_and(|wrong| wrong.contains(told)), "{said:?}: {wrong:?}");
    }
}

#[test]
fn shares_are_all_rows_together() {
    let colors = ("colours of vertices", colors::rows());
    for (title, rows) in
        [("solids", solids::rows()), ("kinds of images", maps::rows_of_kinds()), colors, ("axes", axes::rows())]
    {
        let is_slow = rows.iter().any(|row| row.scene.compiles_slowly());
        assert_eq!(is_slow, title != "axes", "{title}");
        for (place, row) in rows.iter().enumerate() {
            let times = (1..=3).filter(|&number| Share { number, of: 3 }.has(place, row)).count();
            assert_eq!(times, if row.scene.compiles_slowly() { 1 } else { 3 }, "{title}: {}", row.name);
            let all = Share { number: 1, of: 1 };
            assert!(all.has(place, row) && all.encodings(place, row).len() == 2, "{title}: {}", row.name);
        }
        for number in 1..=3 {
            let share = Share { number, of: 3 };
            let of_share = rows.iter().enumerate().filter(|(place, row)| share.has(*place, row));
            let drawn = of_share.map(|(place, row)| (row.scene.compiles_slowly(), share.encodings(place, row)));
            let drawn: Vec<_> = drawn.collect();
            assert!(drawn.iter().all(|(is_slow, encodings)| encodings.len() == if *is_slow { 1 } else { 2 }));
            for encoding in [Encoding::Raw, Encoding::Srgb] {
                assert!(drawn.iter().any(|(_, encodings)| encodings.contains(&encoding)), "{title}: {encoding:?}");
            }
        }
    }
}

/// Draws every row on one stage, and compares its three pictures with the oracle's.
fn conform(title: &str, rows: &[Row]) {
    conform_on(Stage::new(SIZE.x, SIZE.y), title, rows);
}

fn conform_on(mut stage: Stage, title: &str, rows: &[Row]) {
    let mut failures = Failures::default();
    let mut worst = Worst::default();
    let mut without_floats = 0;
    stage.frame();
    let share = Share::of_environment();
    let rows: Vec<(usize, &Row)> = rows.iter().enumerate().filter(|(place, row)| share.has(*place, row)).collect();
    for (place, row @ Row { name, scene, float, raw, srgb }) in &rows {
        stage.set(scene);
        // An adapter may be unable to blend 32-bit floats, as WebGPU allows.
        let of_floats = if stage.blends_floats() || !scene.things.iter().any(|thing| thing.blend) {
            let picture = stage.float();
            let verdict = failures.compare(name, &mut stage, &picture, *float);
            failures.unless(verdict.counted + verdict.edges > 0.02, || format!("{name} shows next to nothing"));
            Some(verdict)
        } else {
            without_floats += 1;
            None
        };
        let is_exact = stage.is_on_cpu() && scene.is_encoded_once() && scene.camera.samples == Samples::One;
        let srgb = if is_exact { CPU_SRGB } else { *srgb };
        let encodings = share.encodings(*place, row);
        let [raw, srgb] = [(Encoding::Raw, raw), (Encoding::Srgb, &srgb)].map(|(encoding, bars)| {
            encodings.contains(&encoding).then(|| {
                stage.encode(encoding);
                let picture = stage.bytes();
                failures.compare_bytes(&format!("{name}, {encoding:?} bytes"), &mut stage, &picture, *bars)
            })
        });
        worst.note(name, of_floats, [raw, srgb]);
    }
    worst.print(title, rows.len(), &stage.adapter().describe());
    println!(
        "  {} pipelines; {without_floats} rows of blended objects not in floating point",
        stage.report().pipelines
    );
    failures.finish();
}

#[test]
fn every_value_and_every_pair_of_values_conforms() {
    conform("axes", &axes::rows());
}

#[test]
fn every_feature_conforms() {
    conform("features", &features::rows());
}

#[test]
fn every_policy_of_intensity_conforms() {
    conform("policies of intensity", &policies::rows(Samples::One));
}

#[test]
fn every_policy_of_intensity_conforms_after_averaging() {
    conform_on_fine_grids("policies of intensity, four samples", &policies::rows(Samples::Four));
}

/// On a grid of 1/16 pixel the covered samples of a triangle are uncertain, and a pixel has more possible colors than
/// the oracle distinguishes; so only adapters with finer grids draw these.
fn conform_on_fine_grids(title: &str, rows: &[Row]) {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.frame();
    if stage.grid_bits() >= 8 {
        conform(title, rows);
    }
}

#[test]
fn every_way_to_shade_colors_of_vertices_conforms() {
    conform("colours of vertices", &colors::rows());
}

#[test]
fn every_way_to_shade_and_to_filter_images_conforms() {
    conform("images", &maps::rows());
}

#[test]
fn every_filter_by_the_footprints_shape_conforms() {
    conform("filters by shape", &maps::rows_by_shape());
}

#[test]
fn every_kind_of_image_conforms() {
    conform("kinds of images", &maps::rows_of_kinds());
}

#[test]
fn highlights_of_far_normals_conform() {
    conform("far normals", &maps::rows_of_far_normals(FarNormals::Toksvig));
}

#[test]
fn highlights_of_moments_conform() {
    conform("moments", &maps::rows_of_far_normals(FarNormals::Lean));
}

#[test]
fn highlights_of_other_far_normals_are_found() {
    use FarNormals::{Lean, Mean, Toksvig};
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    let pairs = [(Toksvig, Mean), (Lean, Mean), (Lean, Toksvig)];
    let faults = pairs.into_iter().flat_map(|(right, wrong)| {
        let mut rows = maps::rows_of_far_normals(right);
        rows.retain(|row| row.name.ends_with("Phong, 4 times"));
        assert_eq!(rows.len(), 4, "with shininess and without");
        rows.into_iter().map(move |row| (row, right, wrong))
    });
    let share = Share::of_environment();
    for (_, (Row { name, scene, .. }, right, wrong)) in (0..).zip(faults).filter(|(place, of)| share.has(*place, &of.0))
    {
        let mut other = scene.clone();
        let normals = other.things.iter_mut().flat_map(|thing| &mut thing.maps);
        normals.for_each(|(_, map)| map.far_normals = wrong);
        let picture = stage.draw(&other);
        stage.set(&scene);
        stage.frame();
        let (verdict, _) = judge(&mut stage, &Image::from_float(&picture), FLOAT.until_wrong());
        assert!(!verdict.is_within(), "{name}, {wrong:?} for {right:?}: {verdict}");
    }
}

/// All kinds on one object, where they multiply.
#[test]
fn all_kinds_of_images_at_once_conform() {
    conform("all kinds of images", &maps::rows_of_all_kinds());
}

#[test]
fn every_way_to_be_lit_by_an_environment_conforms() {
    conform("environment", &environment::rows());
}

#[test]
fn environments_conform_on_objects_with_images() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    let rows: Vec<Row> = environment::rows_of_maps().into_iter().chain(maps::rows_by_shape_in_environments()).collect();
    stage.set(&rows[0].scene);
    stage.frame();
    if !stage.adapter().lights_images_by_environments() {
        let told = |error: &RenderError| matches!(error, RenderError::ImagesInEnvironment(count) if *count > 0);
        assert!(stage.report().errors.iter().any(told), "{:?}", stage.report().errors);
        return;
    }
    conform("environment and images", &rows);
}

#[test]
fn every_solid_conforms() {
    conform("solids", &solids::rows());
}

#[test]
fn solids_conform_in_environments() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    let rows = solids::rows_in_environments();
    stage.set(&rows[0].scene);
    stage.frame();
    if stage.adapter().lights_images_by_environments() {
        return conform("environment and solids", &rows);
    }
    let told = |error: &RenderError| matches!(error, RenderError::ImagesInEnvironment(count) if *count > 0);
    assert!(stage.report().errors.iter().any(told), "{:?}", stage.report().errors);
}

/// A planted fault: an environment brighter by a twentieth is found in every row of one shading.
#[test]
fn an_environment_that_is_a_twentieth_brighter_is_found() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    for Row { name, scene, float, .. } in environment::rows().iter().filter(|row| row.name.contains(", phong,")) {
        let mut brighter = scene.clone();
        brighter.environment.as_mut().expect("one").strength *= 1.05;
        if scene.things.iter().any(|thing| thing.blend) {
            continue;
        }
        let picture = stage.draw(&brighter);
        stage.set(scene);
        stage.frame();
        let (verdict, _) = judge(&mut stage, &Image::from_float(&picture), float.until_wrong());
        assert!(!verdict.is_within(), "{name}: not found");
    }
}

//! `cargo xtask adapters`.

use std::path::PathBuf;
use std::process::Command;

use clap::Args;

use crate::cargo::{cargo, not_started, root, step, written};
use crate::failure::{Failure, Result};
use crate::setup::{LAVAPIPE, Need, OPENGL, SWIFTSHADER, Setup, swiftshader};
use crate::tally::counted;

/// Run the picture tests and verify the example scenes on every adapter that a bare Debian can have
///
/// These are lavapipe (Vulkan), llvmpipe through OpenGL, `SwiftShader`, the software Vulkan driver of chromium, and the
/// CPU without a driver. On each: the conformance suite, all three shadings with few and many lights, transforms and
/// scales of the world, surfaces at one place, outlines and slivers, the random scenes that failed once, and
/// `halfway verify` over examples/scenes; on the CPU all picture tests that are not about wgpu.
/// Each suite prints the worst figures; docs/lab has those of dated runs.
/// Missing drivers are installed first, as for `cargo xtask test --all`, of which this is a part.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    #[command(flatten)]
    setup: Setup,
}

/// Sets up, and tries each adapter.
pub(crate) fn run(options: &Options) -> Result {
    if !cfg!(target_os = "linux") {
        return Err(Failure::new("the adapters are those of Linux: here the tests run on the system's own"));
    }
    options.setup.meet(&NEEDS)?;
    step("build", &mut cargo(["test", "--release", "--workspace", "--test", "render", "--test", "wild", "--no-run"]))?;
    try_each(all()?)
}

/// The drivers.
pub(crate) const NEEDS: [Need; 3] = [LAVAPIPE, OPENGL, SWIFTSHADER];

/// Tests that need a graphics driver, by file: those whose names begin so, or all of the file.
const ABOUT_DRIVERS: [(&str, &[&str]); 17] = [
    ("crates/render/src/gpu/timer.rs", &["frames_that_are_refused_have_no_time"]),
    ("crates/render/src/gpu/passes/encode.rs", &["nothing_is_left_out_without_an_error"]),
    ("crates/render/src/gpu/pipelines/cache/tests.rs", &[]),
    ("crates/viewer/src/paint/gpu.rs", &["another_device_paints"]),
    ("crates/render/src/gpu/pipelines/compile.rs", &["a_failed_pipeline_returns", "the_thread_ends_with"]),
    (
        "crates/command/tests/command/adapters.rs",
        &[
            "the_list_has_vulkan_opengl",
            "wgpu_s_own_variable_chooses",
            "a_name_outranks_drivers",
            "opengl_is_tried_before_giving_up",
            "a_machine_without_a_session",
        ],
    ),
    ("crates/command/tests/command/bench.rs", &["a_benchmark_prints_a_row", "any_scene_or_model_is_timed"]),
    ("tests/allocations.rs", &["frames_allocate_no_more"]),
    ("tests/render/compile.rs", &[]),
    ("tests/render/devices.rs", &[]),
    ("tests/render/engine.rs", &[]),
    ("tests/render/passes.rs", &["an_app_s_pass", "a_policy_acts"]),
    ("tests/render/pipelines.rs", &[]),
    (
        "tests/render/counters.rs",
        &[
            "pipelines_do_not_grow",
            "shaders_hold_only",
            // The CPU reads in place the data that is uploaded to wgpu.
            "a_change_uploads",
        ],
    ),
    ("tests/render/cpu.rs", &["the_adapter_may_change", "a_device_s_texture"]),
    ("tests/render/floats.rs", &["a_device_that_cannot"]),
    ("tests/render/timing.rs", &["the_gpu_is_timed", "frames_that_nobody_waits_for"]),
];

/// Arguments of a test program that leave out the tests of drivers.
pub(crate) fn without_drivers() -> Vec<String> {
    skipped(names_about_drivers(|_| true))
}

/// Unit tests of drivers, by parts of their names.
pub(crate) fn units_about_drivers() -> impl Iterator<Item = String> {
    names_about_drivers(|file| file.contains("/src/"))
}

fn names_about_drivers(is_chosen: fn(&str) -> bool) -> impl Iterator<Item = String> {
    ABOUT_DRIVERS.iter().filter(move |(file, _)| is_chosen(file)).flat_map(|(file, tests)| match tests {
        [] => vec![module(file)],
        tests => tests.iter().map(|test| (*test).to_owned()).collect(),
    })
}

fn skipped(names: impl IntoIterator<Item = String>) -> Vec<String> {
    names.into_iter().flat_map(|name| ["--skip".to_owned(), name]).collect()
}

/// The module of a file, as tests in it are named: `render::compile::` of `tests/render/compile.rs`.
fn module(file: &str) -> String {
    let within = ["src/", "tests/"].iter().find_map(|folder| Some(file.split_once(folder)?.1)).unwrap_or(file);
    format!("{}::", within.trim_end_matches(".rs").replace('/', "::"))
}

/// The tests of the program `render` that each driver runs, by parts of their names. All tests run on lavapipe in
/// `cargo xtask test --all`.
const TESTS: [&str; 7] = [
    "render::adapter::",
    "render::conformance::",
    "render::light_counts::",
    "render::order::",
    "render::samples::",
    "render::slivers::",
    "render::transforms::",
];

/// The tests of the program `wild` that each driver runs, and the one of scenes known to fail by the driver.
const WILD: [&str; 1] = ["scenes_that_failed_once_are_right"];
const KNOWN_WILD: &str = "known_failures_fail";

/// The tests of the program `render` that the CPU draws under every adapter: in a file of their own.
pub(crate) const ON_THE_CPU: &str = "render::conformance::on_the_cpu::";

/// The share of the conformance suite's rows with textures to draw: drivers take minutes to compile all of them.
pub(crate) const SHARE: &str = "HALFWAY_SHARE";
/// The adapter that tests must draw with, by parts of its own name: they fail on any other.
const TESTED: &str = "HALFWAY_TESTED_ADAPTER";
/// The variable that chooses the adapter.
pub(crate) const CHOICE: &str = "HALFWAY_ADAPTER";

/// Every variable that chooses an adapter or changes how it works.
const CHOICES: [&str; 9] = [
    TESTED,
    SHARE,
    CHOICE,
    "HALFWAY_SIMD",
    "VK_DRIVER_FILES",
    "VK_ICD_FILENAMES",
    "WGPU_ADAPTER_NAME",
    "WGPU_BACKEND",
    "EGL_PLATFORM",
];

/// An adapter, and the environment that makes a program draw with it.
pub(crate) struct TriedAdapter {
    name: &'static str,
    tests: Tests,
    /// Whether random scenes are known to fail there that are right elsewhere.
    has_known: bool,
    variables: Vec<(&'static str, String)>,
    /// Parts of its line in the output of `halfway adapters`.
    says: [&'static str; 2],
}

/// The tests of the program `render` that an adapter runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Tests {
    /// None, as they have run.
    None,
    /// Those of [`TESTS`].
    Few,
    /// All but those of [`ABOUT_DRIVERS`].
    Most,
}

impl Tests {
    fn arguments(self) -> Vec<String> {
        match self {
            Self::None => vec![],
            Self::Few => TESTS.map(String::from).into_iter().chain(skipped([ON_THE_CPU.to_owned()])).collect(),
            Self::Most => without_drivers(),
        }
    }
}

fn all() -> Result<Vec<TriedAdapter>> {
    let set = |name, value: &str| (name, value.to_owned());
    let swiftshader = swiftshader().ok_or_else(|| Failure::new("SwiftShader is missing"))?;
    Ok(vec![
        TriedAdapter {
            name: "lavapipe",
            tests: Tests::Few,
            has_known: false,
            variables: vec![set(CHOICE, "vulkan:llvmpipe")],
            says: ["llvmpipe", "(vulkan"],
        },
        TriedAdapter {
            name: "llvmpipe through OpenGL",
            tests: Tests::Few,
            has_known: true,
            variables: vec![
                set("WGPU_BACKEND", "gl"),
                set("EGL_PLATFORM", "surfaceless"),
                set("LIBGL_ALWAYS_SOFTWARE", "true"),
                // Targets of 32-bit floats, which the tests need, are a part of OpenGL since 3.0, but wgpu looks for
                // the name that they had as an extension.
                set("MESA_EXTENSION_OVERRIDE", "+GL_ARB_color_buffer_float"),
            ],
            says: ["llvmpipe", "(gl"],
        },
        TriedAdapter {
            name: "SwiftShader",
            tests: Tests::Few,
            has_known: true,
            variables: vec![set("VK_DRIVER_FILES", swiftshader)],
            says: ["SwiftShader", "(vulkan"],
        },
        TriedAdapter {
            name: "the CPU without a driver",
            tests: Tests::Most,
            has_known: false,
            variables: vec![set(CHOICE, "cpu")],
            says: ["", "(cpu"],
        },
    ])
}

/// The adapters that remain to be tested after all tests have run on the CPU and on the adapter that `choice` opens;
/// and the share of rows with textures that those tests draw. The remaining drivers share these rows, with the tests
/// themselves if `with_tests` is set.
///
/// # Errors
/// An adapter is not there.
pub(crate) fn others(choice: &str, with_tests: bool) -> Result<(Option<String>, Vec<TriedAdapter>)> {
    let mut adapters = all()?;
    let line = opened(halfway(&["adapters"]).env(CHOICE, choice))?;
    let share = share(&mut adapters, &line, with_tests);
    Ok((share, adapters))
}

/// Leaves out the tests of the CPU and of the adapter in a line of `halfway adapters`, divides the rows among the
/// others, and returns the tests' share: together they draw each row once.
fn share(adapters: &mut [TriedAdapter], line: &str, with_tests: bool) -> Option<String> {
    for adapter in adapters.iter_mut() {
        if adapter.tests == Tests::Most || adapter.is_chosen_alone() && adapter.is(line) {
            adapter.tests = Tests::None;
        }
    }
    let first = usize::from(with_tests);
    let count = first + adapters.iter().filter(|adapter| adapter.tests == Tests::Few).count();
    for (number, adapter) in (first + 1..).zip(adapters.iter_mut().filter(|adapter| adapter.tests == Tests::Few)) {
        adapter.variables.push((SHARE, format!("{number}/{count}")));
    }
    with_tests.then(|| format!("1/{count}"))
}

/// Tests each adapter, and lists the failures at the end.
///
/// # Errors
/// An adapter is not there, a test fails, or a scene is not as the oracle draws it.
pub(crate) fn try_each(adapters: Vec<TriedAdapter>) -> Result {
    let mut failed = Vec::new();
    for adapter in adapters {
        let found = adapter.is_there().and_then(|()| {
            let outcomes = [adapter.test(), adapter.verify()];
            outcomes.into_iter().collect::<Result>()
        });
        failed.extend(found.err().map(|failure| format!("{}: {failure}", adapter.name)));
    }
    if failed.is_empty() { Ok(()) } else { Err(Failure::new(failed.join("\n"))) }
}

impl TriedAdapter {
    fn lend<'a>(&self, command: &'a mut Command) -> &'a mut Command {
        for choice in CHOICES {
            command.env_remove(choice);
        }
        command.env(TESTED, self.says.join(" "));
        command.envs(self.variables.iter().map(|(name, value)| (name, value)))
    }

    /// Whether only its name distinguishes it from others.
    fn is_chosen_alone(&self) -> bool {
        self.variables.iter().all(|(name, _)| *name == CHOICE)
    }

    /// Whether a line of `halfway adapters` is about it.
    fn is(&self, line: &str) -> bool {
        self.says.iter().all(|part| line.contains(part))
    }

    /// Whether the programs draw with it.
    fn is_there(&self) -> Result {
        let mut command = halfway(&["adapters"]);
        let first = opened(self.lend(&mut command))?;
        if self.is(&first) {
            return Ok(());
        }
        Err(Failure::new(format!("it is not what draws, but {first} ({})", written(&command))))
    }

    fn test(&self) -> Result {
        if self.tests == Tests::None {
            return Ok(());
        }
        self.run("render", &self.tests.arguments())?;
        if self.tests != Tests::Few {
            return Ok(());
        }
        let known = self.has_known.then_some(KNOWN_WILD);
        self.run("wild", &WILD.into_iter().chain(known).map(String::from).collect::<Vec<_>>())
    }

    /// Runs tests of a program, chosen by these arguments.
    fn run(&self, program: &str, arguments: &[String]) -> Result {
        let mut command = cargo(["test", "--release", "--workspace", "--test", program, "--", "--show-output"]);
        let (tally, outcome) = counted(&format!("{program} on {}", self.name), self.lend(command.args(arguments)))?;
        eprintln!("{tally}");
        outcome?;
        if tally.passed == 0 { Err(Failure::new(format!("no test of {program} ran"))) } else { Ok(()) }
    }

    fn verify(&self) -> Result {
        let mut failed = Vec::new();
        for scene in scenes()? {
            let title = format!("{} by {}", scene.display(), self.name);
            let outcome = step(&title, self.lend(&mut halfway(&["verify", &scene.to_string_lossy()])));
            failed.extend(outcome.err().map(|failure| failure.to_string()));
        }
        if failed.is_empty() { Ok(()) } else { Err(Failure::new(failed.join("\n"))) }
    }
}

fn halfway(arguments: &[&str]) -> Command {
    let words = ["run", "--release", "--quiet", "--bin", "halfway", "--"];
    cargo(words.into_iter().chain(arguments.iter().copied()))
}

/// The first line that `halfway adapters` prints: the adapter that is opened.
fn opened(adapters: &mut Command) -> Result<String> {
    let output = adapters.output().map_err(|error| not_started(adapters, &error))?;
    let said = String::from_utf8_lossy(&output.stdout);
    Ok(said.lines().next().unwrap_or("no adapter").to_owned())
}

/// The example scenes, by name.
fn scenes() -> Result<Vec<PathBuf>> {
    let folder = root().join("examples/scenes");
    let entries = std::fs::read_dir(&folder).map_err(|error| Failure::new(format!("{}: {error}", folder.display())))?;
    let paths = entries.flatten().map(|entry| entry.path());
    let mut scenes: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|end| end == "json")).collect();
    scenes.sort();
    if scenes.is_empty() { Err(Failure::new("there is no example scene")) } else { Ok(scenes) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scenes_are_the_examples() {
        let scenes = scenes().unwrap();
        assert!(scenes.iter().any(|scene| scene.ends_with("moonlit_table.json")), "{scenes:?}");
    }

    #[test]
    fn tests_about_drivers_are_there() {
        for (file, tests) in ABOUT_DRIVERS {
            let text = std::fs::read_to_string(root().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
            assert!(text.contains("#[test]"), "{file} has no tests any more");
            for test in tests {
                assert!(text.contains(&format!("fn {test}")), "{file}: {test} is no test any more");
            }
        }
    }

    #[test]
    fn tests_are_named_by_their_files() {
        assert_eq!(module("tests/render/compile.rs"), "render::compile::");
        assert_eq!(module("crates/render/src/gpu/pipelines/cache/tests.rs"), "gpu::pipelines::cache::tests::");
        assert_eq!(module("crates/command/tests/command/bench.rs"), "command::bench::");
    }

    #[test]
    fn drivers_share_what_all_tests_have_run() {
        let adapter = |name, tests, variable, says| TriedAdapter {
            name,
            tests,
            has_known: false,
            variables: vec![(variable, "x".into())],
            says,
        };
        let adapters = || {
            [
                adapter("a", Tests::Few, CHOICE, ["a", "(vulkan"]),
                adapter("a by a variable", Tests::Few, "WGPU_BACKEND", ["a", "(vulkan"]),
                adapter("b", Tests::Few, CHOICE, ["b", "(vulkan"]),
                adapter("c", Tests::Most, CHOICE, ["", "(cpu"]),
            ]
        };
        let shares = |adapters: &[TriedAdapter]| -> Vec<_> {
            let variables = adapters.iter().flat_map(|adapter| &adapter.variables);
            variables.filter(|(name, _)| *name == SHARE).map(|(_, share)| share.clone()).collect()
        };
        let mut alone = adapters();
        assert_eq!(share(&mut alone, "a 1.0 (vulkan, software)", false), None);
        assert_eq!(alone.each_ref().map(|it| it.tests), [Tests::None, Tests::Few, Tests::Few, Tests::None]);
        assert_eq!(shares(&alone), ["1/2", "2/2"]);
        let mut with_tests = adapters();
        assert_eq!(share(&mut with_tests, "a 1.0 (vulkan, software)", true), Some("1/3".into()));
        assert_eq!(shares(&with_tests), ["2/3", "3/3"]);
    }

    #[test]
    fn cpu_tests_exist() {
        let path = root().join("tests").join(ON_THE_CPU.trim_end_matches("::").replace("::", "/")).with_extension("rs");
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        assert!(text.contains("#[test]") && text.contains("Stage::on_the_cpu("), "{ON_THE_CPU}");
        assert!(!text.contains("Stage::new("), "{ON_THE_CPU}");
    }

    #[test]
    fn an_adapter_is_chosen_by_its_own_variables_alone() {
        let adapter = TriedAdapter {
            name: "a",
            tests: Tests::Few,
            has_known: false,
            variables: vec![("WGPU_BACKEND", "gl".into())],
            says: ["a", "(gl"],
        };
        let mut command = Command::new("program");
        adapter.lend(&mut command);
        let set: Vec<_> =
            command.get_envs().filter_map(|(name, value)| Some((name.to_str()?, value?.to_str()?))).collect();
        assert_eq!(set, [(TESTED, "a (gl"), ("WGPU_BACKEND", "gl")]);
        assert!(command.get_envs().any(|(name, value)| name == "HALFWAY_ADAPTER" && value.is_none()));
    }
}

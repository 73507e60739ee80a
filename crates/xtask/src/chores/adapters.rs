//! `cargo xtask adapters`.

use std::path::PathBuf;
use std::process::Command;

use clap::Args;

use crate::cargo::{cargo, not_started, root, step, written};
use crate::failure::{Failure, Result};
use crate::setup::{OPENGL, SWIFTSHADER, Setup, VULKAN, swiftshader};
use crate::tally::counted;

/// Run the picture tests and verify the example scenes on every adapter that a bare Debian can have
///
/// These are lavapipe (Vulkan), lavapipe in the ways of hardware, llvmpipe through OpenGL, `SwiftShader`, the
/// software Vulkan driver of chromium, and the CPU without a driver. On each: the conformance suite, all three
/// shadings with few and many lights, transforms and scales of the world, what lies at one place, outlines and
/// slivers, the random scenes that failed once, and `halfway verify` over examples/scenes; on the CPU all picture
/// tests that are not about wgpu.
/// Each suite prints the worst figures; docs/lab has those of dated runs.
/// What is missing is installed first, as for `cargo xtask test`, of which this is a part; but there the drivers share
/// the suite's rows with colours of vertices, images, solids and environments among them, since they take minutes to
/// compile their shaders. Here each draws all.
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

/// What the adapters need beyond the driver.
pub(crate) const NEEDS: [crate::setup::Need; 3] = [VULKAN, OPENGL, SWIFTSHADER];

/// The adapters to try where all tests run on the one that this choice opens: they do not run again there, and the
/// drivers that are left share the rows with textures among them; with the tests, where those take a share.
///
/// # Errors
/// An adapter is not there, or the tests' share is not what leaves one for each.
pub(crate) fn others(choice: &str) -> Result<Vec<TriedAdapter>> {
    let mut adapters = all()?;
    let line = opened(halfway(&["adapters"]).env(CHOICE, choice))?;
    leave_out_what_runs(&mut adapters, &line, std::env::var(SHARE).ok().as_deref())?;
    Ok(adapters)
}

/// Tries each adapter, and says in the end what failed on which.
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

/// Leaves out the tests of the adapter that a line of `halfway adapters` is about and those that the CPU has drawn with
/// them, and gives each other driver its share: all of them together draw each row once, or what the `tests` leave them
/// of it.
fn leave_out_what_runs(adapters: &mut [TriedAdapter], line: &str, tests: Option<&str>) -> Result {
    for adapter in adapters.iter_mut().filter(|adapter| adapter.is_chosen_alone() && adapter.is(line)) {
        adapter.tests = Tests::None;
    }
    for adapter in adapters.iter_mut().filter(|adapter| adapter.tests == Tests::Most) {
        adapter.tests = Tests::Rest;
    }
    let is_driver = |adapter: &TriedAdapter| adapter.tests == Tests::Few;
    let of_tests = usize::from(tests.is_some());
    let count = of_tests + adapters.iter().filter(|adapter| is_driver(adapter)).count();
    if let Some(said) = tests.filter(|said| *said != format!("1/{count}")) {
        let expected = format!("expected 1/{count}, a share for the tests and one for each other driver");
        return Err(Failure::new(format!("{SHARE} is {said}; {expected}")));
    }
    for (number, adapter) in (1 + of_tests..).zip(adapters.iter_mut().filter(|adapter| is_driver(adapter))) {
        adapter.variables.push((SHARE, format!("{number}/{count}")));
    }
    Ok(())
}

/// The tests of the program `render` that each driver runs, by parts of their names. Lavapipe runs all tests in
/// `cargo xtask test`.
const TESTS: [&str; 9] = [
    "render::adapter::",
    "render::auto::",
    "render::conformance::",
    "render::costs::",
    "render::light_counts::",
    "render::order::",
    "render::samples::",
    "render::slivers::",
    "render::transforms::",
];

/// The tests of the program `wild` that each driver runs, and the one of what is known to fail by the driver.
const WILD: [&str; 1] = ["scenes_that_failed_once_are_right"];
const KNOWN_WILD: &str = "known_failures_fail";

/// The tests of the program `render` that the CPU draws, whatever the adapter: in files of their own.
const ON_THE_CPU: [&str; 2] = ["render::conformance::on_the_cpu::", "render::rough::"];

/// Which of the conformance suite's rows with textures are drawn: drivers take minutes to compile all of them.
const SHARE: &str = "HALFWAY_SHARE";

/// The tests that the CPU leaves out, and why.
const LEFT_OUT: [(&str, &str); 14] = [
    ("render::compile::", "pipelines are wgpu's"),
    ("render::pipelines::", "pipelines are wgpu's"),
    ("render::counters::pipelines_do_not_grow", "pipelines are wgpu's"),
    ("render::counters::what_a_draw_does_not_use", "pipelines are wgpu's"),
    ("render::counters::a_change_uploads", "the CPU reads where it is what wgpu sends"),
    ("render::costs::", "the CPU has one way"),
    ("render::multi_draw::", "the CPU starts no commands"),
    ("render::devices::", "a device is wgpu's"),
    ("render::cpu::what_draws_may_change", "it takes a device to change to"),
    ("render::cpu::a_device_s_texture", "a device is wgpu's"),
    ("render::engine::", "an engine's texture is a device's"),
    ("render::floats::a_device_that_cannot", "a device is wgpu's"),
    ("render::timing::the_gpu_is_timed", "there is no GPU to time"),
    ("render::timing::frames_that_nobody_waits_for", "there is no GPU to time"),
];

/// An adapter, and how a program is made to draw with it.
pub(crate) struct TriedAdapter {
    name: &'static str,
    tests: Tests,
    variables: Vec<(&'static str, String)>,
    /// Parts of the line that `halfway adapters` prints of it.
    says: [&'static str; 2],
}

/// The tests of the program `render` that an adapter runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Tests {
    /// None, as they have run.
    None,
    /// Those of [`TESTS`].
    Few,
    /// All but those of [`LEFT_OUT`].
    Most,
    /// Those of `Most` that have not run where all tests have: all but those of [`ON_THE_CPU`].
    Rest,
}

impl Tests {
    fn arguments(self) -> Vec<&'static str> {
        match self {
            Self::None => vec![],
            Self::Few => TESTS.into_iter().chain(skipped(&ON_THE_CPU)).collect(),
            Self::Most => skipped(&LEFT_OUT.map(|(name, _)| name)).collect(),
            Self::Rest => Self::Most.arguments().into_iter().chain(skipped(&ON_THE_CPU)).collect(),
        }
    }
}

fn skipped(names: &[&'static str]) -> impl Iterator<Item = &'static str> {
    names.iter().flat_map(|name| ["--skip", name])
}

/// Those of which random scenes are known to fail that are right elsewhere.
const WITH_KNOWN: [&str; 2] = [SWIFTSHADER_NAME, OPENGL_NAME];
const OPENGL_NAME: &str = "llvmpipe through OpenGL";
const SWIFTSHADER_NAME: &str = "SwiftShader";

/// What the tests are to draw with, as parts of what it says of itself: they fail where it is something else.
const TESTED: &str = "HALFWAY_TESTED_ADAPTER";

/// What the adapter is chosen by.
const CHOICE: &str = "HALFWAY_ADAPTER";

/// Every variable that chooses an adapter or its ways.
const CHOICES: [&str; 10] = [
    TESTED,
    SHARE,
    CHOICE,
    "HALFWAY_COSTS",
    "HALFWAY_SIMD",
    "VK_DRIVER_FILES",
    "VK_ICD_FILENAMES",
    "WGPU_ADAPTER_NAME",
    "WGPU_BACKEND",
    "EGL_PLATFORM",
];

fn all() -> Result<Vec<TriedAdapter>> {
    let set = |name, value: &str| (name, value.to_owned());
    let swiftshader = swiftshader().ok_or_else(|| Failure::new("SwiftShader is missing"))?;
    let lavapipe = || set(CHOICE, "vulkan:llvmpipe");
    Ok(vec![
        TriedAdapter {
            name: "lavapipe",
            tests: Tests::Few,
            variables: vec![lavapipe()],
            says: ["llvmpipe", "(vulkan"],
        },
        TriedAdapter {
            name: "lavapipe in the ways of hardware",
            tests: Tests::Few,
            variables: vec![lavapipe(), set("HALFWAY_COSTS", "hardware")],
            says: ["llvmpipe", "(vulkan"],
        },
        TriedAdapter {
            name: OPENGL_NAME,
            tests: Tests::Few,
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
            name: SWIFTSHADER_NAME,
            tests: Tests::Few,
            variables: vec![set("VK_DRIVER_FILES", &swiftshader.to_string_lossy())],
            says: ["SwiftShader", "(vulkan"],
        },
        TriedAdapter {
            name: "the CPU without a driver",
            tests: Tests::Most,
            variables: vec![set(CHOICE, "cpu")],
            says: ["", "(cpu"],
        },
    ])
}

impl TriedAdapter {
    fn lend<'a>(&self, command: &'a mut Command) -> &'a mut Command {
        for choice in CHOICES {
            command.env_remove(choice);
        }
        command.env(TESTED, self.says.join(" "));
        command.envs(self.variables.iter().map(|(name, value)| (name, value)))
    }

    fn halfway(&self, arguments: &[&str]) -> Command {
        let mut command = halfway(arguments);
        self.lend(&mut command);
        command
    }

    /// Whether nothing but its name tells it from others.
    fn is_chosen_alone(&self) -> bool {
        self.variables.iter().all(|(name, _)| *name == CHOICE)
    }

    /// Whether a line of `halfway adapters` is about it.
    fn is(&self, line: &str) -> bool {
        self.says.iter().all(|part| line.contains(part))
    }

    /// Whether the programs draw with it.
    fn is_there(&self) -> Result {
        let mut command = self.halfway(&["adapters"]);
        let first = opened(&mut command)?;
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
        match self.tests {
            Tests::None | Tests::Most | Tests::Rest => Ok(()),
            Tests::Few if WITH_KNOWN.contains(&self.name) => {
                self.run("wild", &[WILD.as_slice(), &[KNOWN_WILD]].concat())
            }
            Tests::Few => self.run("wild", &WILD),
        }
    }

    /// Runs tests of a program, chosen by these arguments.
    fn run(&self, program: &str, arguments: &[&str]) -> Result {
        let words = ["test", "--release", "--workspace", "--test", program, "--", "--show-output"];
        let mut command = cargo(words.into_iter().chain(arguments.iter().copied()));
        let (tally, outcome) = counted(&format!("{program} on {}", self.name), self.lend(&mut command))?;
        eprintln!("{tally}");
        outcome?;
        if tally.passed == 0 { Err(Failure::new(format!("no test of {program} ran"))) } else { Ok(()) }
    }

    fn verify(&self) -> Result {
        let mut failed = Vec::new();
        let scenes = scenes()?;
        for scene in &scenes {
            let title = format!("{} by {}", scene.display(), self.name);
            let path = scene.to_string_lossy();
            let outcome = step(&title, &mut self.halfway(&["verify", &path]));
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
    fn what_is_left_out_is_there() {
        for (name, why) in LEFT_OUT {
            let mut parts = name.split("::").skip(1);
            let (file, test) = (parts.next().unwrap(), parts.next().unwrap());
            let path = root().join("tests/render").join(file).with_extension("rs");
            let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            assert!(text.contains(&format!("#[test]\nfn {test}")) && !why.is_empty(), "{name} is no test any more");
        }
    }

    #[test]
    fn drivers_share_what_all_tests_have_run() {
        let adapter =
            |name, tests, variable, says| TriedAdapter { name, tests, variables: vec![(variable, "x".into())], says };
        let mut adapters = [
            adapter("a", Tests::Few, CHOICE, ["a", "(vulkan"]),
            adapter("a in other ways", Tests::Few, "HALFWAY_COSTS", ["a", "(vulkan"]),
            adapter("b", Tests::Few, CHOICE, ["b", "(vulkan"]),
            adapter("c", Tests::Most, CHOICE, ["", "(cpu"]),
        ];
        leave_out_what_runs(&mut adapters, "a 1.0 (vulkan, software)", None).unwrap();
        assert_eq!(adapters.each_ref().map(|it| it.tests), [Tests::None, Tests::Few, Tests::Few, Tests::Rest]);
        let share = |adapter: &TriedAdapter| {
            adapter.variables.iter().find(|(name, _)| *name == SHARE).map(|(_, it)| it.clone())
        };
        assert_eq!(adapters.each_ref().map(share), [None, Some("1/2".into()), Some("2/2".into()), None]);

        for adapter in &mut adapters {
            adapter.variables.truncate(1);
        }
        leave_out_what_runs(&mut adapters, "a 1.0 (vulkan, software)", Some("1/3")).unwrap();
        assert_eq!(adapters.each_ref().map(share), [None, Some("2/3".into()), Some("3/3".into()), None]);
        for wrong in ["2/3", "1/2", "1/4", "a third"] {
            let refused = leave_out_what_runs(&mut adapters, "a 1.0 (vulkan, software)", Some(wrong)).unwrap_err();
            assert!(refused.to_string().contains("expected 1/3"), "{refused}");
        }
    }

    #[test]
    fn what_the_cpu_draws_has_tests() {
        for name in ON_THE_CPU {
            let path = root().join("tests").join(name.trim_end_matches("::").replace("::", "/")).with_extension("rs");
            let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            assert!(text.contains("#[test]") && text.contains("Stage::on_the_cpu("), "{name}");
            assert!(!text.contains("Stage::new("), "{name}");
        }
    }

    #[test]
    fn an_adapter_is_chosen_by_its_own_variables_alone() {
        let adapter = TriedAdapter {
            name: "a",
            tests: Tests::Few,
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

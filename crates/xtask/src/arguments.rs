//! The command line.

use std::ffi::OsString;
use std::path::PathBuf;

use crate::setup::Setup;

/// What is to be done.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Chore {
    /// Print a page of help.
    Help(&'static str),
    Demo(DemoOptions),
    Test {
        setup: Setup,
    },
    Check,
    Docs {
        setup: Setup,
    },
    Chart {
        setup: Setup,
        /// Less of everything, in less than two minutes.
        quick: bool,
        /// Only how the time of a frame grows.
        scaling: bool,
    },
    Fuzz(FuzzOptions),
}

/// What is fuzzed, and how long.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct FuzzOptions {
    pub(crate) setup: Setup,
    /// For each target, at least 1.
    pub(crate) seconds: u32,
    /// By name; all where none is named.
    pub(crate) targets: Vec<String>,
}

/// How the demo is shown.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct DemoOptions {
    pub(crate) setup: Setup,
    /// Record even where a display is.
    pub(crate) headless: bool,
    /// The model that the lights shine on, relative to where the command was typed.
    pub(crate) model: Option<PathBuf>,
}

const HELP: &str = "\
The chores of this project.

Usage: cargo xtask <CHORE> [OPTIONS]

Chores:
  demo   Show moving lights around a model in a window, or record them where there is no display
  test   Run every test, those that need a graphics adapter or a window included
  check  Check the formatting, lints, documentation and smallest build, all of which must be clean
  docs   Make the pictures and the schema in docs/ again, by the commands that docs/examples.md shows
  chart  Measure what shading costs and what it loses, and write a page of charts to out/chart/
  fuzz   Feed the readers of model files what a fuzzer makes up, and see that they bear it

cargo xtask <CHORE> --help tells more about one.";

const DEMO_HELP: &str = "\
Show moving lights around a model: in a window where a display is, else as an animated PNG and a contact sheet in out/.
What drawing needs and the machine lacks (a Vulkan driver; with a display, the libraries of windows) is installed first,
by apt-get where it may be used.

Usage: cargo xtask demo [OPTIONS]

Options:
      --model FILE   What the lights shine on: an .smf, .obj, .gltf or .glb file; assets/teapot.obj unless given
      --headless     Record, even where a display is
      --no-install   Install nothing; say what is missing and how to get it
  -h, --help         Print this";

const TEST_HELP: &str = "\
Run every test, documentation examples included, in the release profile, and end with a summary. No test is skipped for
want of an adapter or a screen: what they need and the machine lacks (a Vulkan driver, the virtual screen Xvfb) is
installed first, by apt-get where it may be used; otherwise nothing is built, and the remedy is printed.

Usage: cargo xtask test [OPTIONS]

Options:
      --no-install   Install nothing; say what is missing and how to get it
  -h, --help         Print this";

const CHECK_HELP: &str = "\
Check what must be clean before a change goes in: formatting, lints, documentation, and the build of the library without
window and command. All of them run, whichever fails.

Usage: cargo xtask check

Options:
  -h, --help   Print this";

const DOCS_HELP: &str = "\
Make everything in docs/ that comes from code again: the pictures, by the commands that docs/examples.md shows, and the
schema of scene files.

Usage: cargo xtask docs [OPTIONS]

Options:
      --no-install   Install nothing; say what is missing and how to get it
  -h, --help         Print this";

const CHART_HELP: &str = "\
Measure what flat, Gouraud and Phong shading cost and lose: error against time, rates of convergence, how steady a
moving highlight is, and how the time of a frame grows with triangles, objects, lights and pixels. Writes a page that
opens offline, out/chart/index.html, with every table as CSV and every chart as SVG beside it, and makes
docs/pictures/chart.svg again. docs/charts.md tells what is measured and how.

Usage: cargo xtask chart [OPTIONS]

Options:
      --quick        Fewer tessellations, rounds, frames and pixels, in less than two minutes; docs/ stays as it is
      --scaling      Only how the time of a frame grows, on out/chart/scaling.html; docs/ stays as it is
      --no-install   Install nothing; say what is missing and how to get it
  -h, --help         Print this";

const FUZZ_HELP: &str = "\
Feed the readers of model files what a fuzzer makes up: nothing may panic, overflow, hang, or take memory out of
proportion, and what is read must be sound. A target for each format, one for material libraries (mtl) and one for the
parts of binary glTF (glb_chunks). Prints how often each was run; a failing input is kept, and how to try it again and
where to put it as a test is printed. cargo-fuzz and a C++ compiler are installed first where they are missing.

Usage: cargo xtask fuzz [OPTIONS] [TARGET]...

Options:
      --seconds N    How long each target is run; 10 unless given
      --no-install   Install nothing; say what is missing and how to get it
  -h, --help         Print this";

/// The options that a chore may have; each chore refuses those that are not its own.
#[derive(Default)]
struct Options {
    /// Those without a value.
    flags: Vec<String>,
    model: Option<PathBuf>,
    seconds: Option<u32>,
    /// The words that are no options, of a chore that knows `NAMES`.
    names: Vec<String>,
}

/// Stands among the options of a chore that takes names.
const NAMES: &str = "NAMES";

impl Options {
    fn parse(chore: &str, known: &[&str], mut arguments: impl Iterator<Item = OsString>) -> Result<Self, String> {
        let mut options = Self::default();
        while let Some(argument) = arguments.next() {
            let name = argument.to_string_lossy();
            match name.as_ref() {
                "-h" => options.flags.push("--help".into()),
                name if !name.starts_with('-') && known.contains(&NAMES) => options.names.push(name.into()),
                name if name != "--help" && !known.contains(&name) => {
                    return Err(format!("{chore} has no option {name}"));
                }
                "--model" => {
                    let value = arguments.next().ok_or_else(|| format!("{name} needs a value: a file"))?;
                    options.model = Some(value.into());
                }
                "--seconds" => {
                    let value = arguments.next().and_then(|value| value.to_str()?.parse().ok());
                    let value = value.filter(|&seconds| seconds > 0);
                    options.seconds = Some(value.ok_or_else(|| format!("{name} needs a value: a number from 1"))?);
                }
                name => options.flags.push(name.into()),
            }
        }
        Ok(options)
    }

    fn has(&self, flag: &str) -> bool {
        self.flags.iter().any(|given| given == flag)
    }

    fn setup(&self) -> Setup {
        if self.has("--no-install") { Setup::Check } else { Setup::Install }
    }
}

/// Reads the words after `cargo xtask`.
///
/// # Errors
/// What makes no sense, and what was expected.
pub(crate) fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Chore, String> {
    let mut arguments = arguments.into_iter();
    let Some(chore) = arguments.next() else {
        return Err("no chore given; expected demo, test, check, docs, chart or fuzz".into());
    };
    let chore = chore.to_string_lossy().into_owned();
    let (known, page): (&[&str], _) = match chore.as_str() {
        "-h" | "--help" | "help" => return Ok(Chore::Help(HELP)),
        "demo" => (&["--no-install", "--headless", "--model"], DEMO_HELP),
        "test" => (&["--no-install"], TEST_HELP),
        "check" => (&[], CHECK_HELP),
        "docs" => (&["--no-install"], DOCS_HELP),
        "chart" => (&["--no-install", "--quick", "--scaling"], CHART_HELP),
        "fuzz" => (&["--no-install", "--seconds", NAMES], FUZZ_HELP),
        _ => return Err(format!("no chore is called {chore}; expected demo, test, check, docs, chart or fuzz")),
    };
    let options = Options::parse(&chore, known, arguments)?;
    if options.has("--help") {
        return Ok(Chore::Help(page));
    }
    let setup = options.setup();
    Ok(match chore.as_str() {
        "demo" => Chore::Demo(DemoOptions { setup, headless: options.has("--headless"), model: options.model }),
        "test" => Chore::Test { setup },
        "check" => Chore::Check,
        "fuzz" => Chore::Fuzz(FuzzOptions { setup, seconds: options.seconds.unwrap_or(10), targets: options.names }),
        "chart" => Chore::Chart { setup, quick: options.has("--quick"), scaling: options.has("--scaling") },
        _ => Chore::Docs { setup },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> Result<Chore, String> {
        parse(line.split_whitespace().map(OsString::from))
    }

    fn demo(setup: Setup, headless: bool, model: Option<&str>) -> Chore {
        Chore::Demo(DemoOptions { setup, headless, model: model.map(PathBuf::from) })
    }

    fn fuzz(setup: Setup, seconds: u32, targets: &[&str]) -> Chore {
        Chore::Fuzz(FuzzOptions { setup, seconds, targets: targets.iter().copied().map(String::from).collect() })
    }

    #[test]
    fn lines_that_mean_something() {
        let rows = [
            ("--help", Chore::Help(HELP)),
            ("help", Chore::Help(HELP)),
            ("demo -h", Chore::Help(DEMO_HELP)),
            ("test --no-install --help", Chore::Help(TEST_HELP)),
            ("check --help", Chore::Help(CHECK_HELP)),
            ("docs --help", Chore::Help(DOCS_HELP)),
            ("demo", demo(Setup::Install, false, None)),
            ("demo --no-install", demo(Setup::Check, false, None)),
            ("demo --headless --model a.obj", demo(Setup::Install, true, Some("a.obj"))),
            ("demo --model --headless", demo(Setup::Install, false, Some("--headless"))),
            ("test", Chore::Test { setup: Setup::Install }),
            ("test --no-install", Chore::Test { setup: Setup::Check }),
            ("check", Chore::Check),
            ("docs", Chore::Docs { setup: Setup::Install }),
            ("chart", Chore::Chart { setup: Setup::Install, quick: false, scaling: false }),
            ("chart --quick --no-install", Chore::Chart { setup: Setup::Check, quick: true, scaling: false }),
            ("chart --scaling", Chore::Chart { setup: Setup::Install, quick: false, scaling: true }),
            ("fuzz", fuzz(Setup::Install, 10, &[])),
            ("fuzz smf --seconds 60 obj --no-install", fuzz(Setup::Check, 60, &["smf", "obj"])),
            ("fuzz smf --help", Chore::Help(FUZZ_HELP)),
        ];
        for (line, expected) in rows {
            assert_eq!(parsed(line), Ok(expected), "{line}");
        }
    }

    #[test]
    fn other_lines_are_refused_by_name() {
        let rows = [
            ("", "no chore given"),
            ("demmo", "no chore is called demmo"),
            ("demo --modle a.obj", "demo has no option --modle"),
            ("demo --model", "--model needs a value"),
            ("demo a.obj", "demo has no option a.obj"),
            ("test --model a.obj", "test has no option --model"),
            ("check --no-install", "check has no option --no-install"),
            ("docs --headless", "docs has no option --headless"),
            ("fuzz --second 1", "fuzz has no option --second"),
            ("fuzz --seconds", "--seconds needs a value: a number from 1"),
            ("fuzz --seconds 0", "--seconds needs a value: a number from 1"),
            ("fuzz --seconds smf", "--seconds needs a value: a number from 1"),
            ("test --quick", "test has no option --quick"),
        ];
        for (line, expected) in rows {
            let problem = parsed(line).unwrap_err();
            assert!(problem.contains(expected), "{line}: {problem}");
        }
    }

    #[test]
    fn help_fits_the_screen_and_names_every_chore() {
        for page in [HELP, DEMO_HELP, TEST_HELP, CHECK_HELP, DOCS_HELP, CHART_HELP, FUZZ_HELP] {
            for line in page.lines() {
                assert!(line.len() <= 120, "{line}");
            }
        }
        for chore in ["demo", "test", "check", "docs", "chart", "fuzz"] {
            assert!(HELP.contains(&format!("\n  {chore} ")), "{chore}");
        }
    }
}

//! The command line of demo programs.

use std::ffi::OsString;
use std::ops::Range;
use std::path::PathBuf;

use bevy_app::{App, AppExit, Plugin};
use halfway_record::{Recording, parse_size};

/// The target of a demo.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Demo {
    Window,
    Record(Recording),
    Stop(Stop),
}

/// Gives the App a runner that draws nothing: it prints the usage and ends, with exit code 2 if there is a problem.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stop {
    problem: Option<String>,
}

impl Plugin for Stop {
    fn build(&self, app: &mut App) {
        let problem = self.problem.clone();
        app.set_runner(move |_| match problem {
            None => {
                println!("{USAGE}");
                AppExit::Success
            }
            Some(problem) => {
                eprintln!("error: {problem}\n\n{USAGE}");
                AppExit::from_code(2)
            }
        });
    }
}

const USAGE: &str = "\
Usage: [--headless FILE [--frames N] [--size WxH] [--contact-sheet FILE]]

  --headless FILE  draw without a window; write FILE (.png, .exr)
  --frames N       draw N frames, 30 a second, into an animated PNG
  --size WxH       pixels of the picture; 1280x720 unless given
  --contact-sheet FILE
                   write up to 16 of the frames, small, on one PNG
  --model FILE     the model, in a demo that shows one
  --help           print this";

impl Demo {
    pub(crate) fn from_args() -> Self {
        match Self::parse(std::env::args_os().skip(1)) {
            Ok(Some(demo)) => demo,
            Ok(None) => Self::Stop(Stop { problem: None }),
            Err(problem) => Self::Stop(Stop { problem: Some(problem) }),
        }
    }

    /// `None` asks for help.
    fn parse(arguments: impl Iterator<Item = OsString>) -> Result<Option<Self>, String> {
        let mut arguments = arguments;
        let (mut path, mut frames, mut size, mut contact_sheet) = (None, None, None, None);
        while let Some(argument) = arguments.next() {
            let name = argument.to_string_lossy().into_owned();
            let mut value = || arguments.next().ok_or_else(|| format!("{name} needs a value"));
            match name.as_str() {
                "--help" | "-h" => return Ok(None),
                "--headless" => path = Some(PathBuf::from(value()?)),
                "--frames" => frames = Some(frame_count(&value()?.to_string_lossy())?),
                "--size" => size = Some(parse_size(&value()?.to_string_lossy())?),
                "--contact-sheet" => contact_sheet = Some(PathBuf::from(value()?)),
                // A demo's own argument, which it reads itself.
                "--model" => drop(value()?),
                _ => return Err(format!("unknown argument {name}")),
            }
        }
        match path {
            Some(path) => {
                let (frames, size) = (frames.unwrap_or(0..1), size.unwrap_or(Recording::SIZE));
                Ok(Some(Self::Record(Recording { frames, size, contact_sheet, ..Recording::new(path) })))
            }
            None if contact_sheet.is_some() => Err("--contact-sheet needs --headless FILE".into()),
            None if frames.is_some() => Err("--frames needs --headless FILE to write to".into()),
            None if size.is_some() => Err("--size needs --headless FILE; drag the window's corner instead".into()),
            None => Ok(Some(Self::Window)),
        }
    }
}

fn frame_count(text: &str) -> Result<Range<u32>, String> {
    text.parse()
        .ok()
        .filter(|frames| (1..=100_000).contains(frames))
        .map(|frames| 0..frames)
        .ok_or_else(|| format!("--frames {text}: expected a number from 1 to 100000"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_math::UVec2;

    fn parse(line: &str) -> Result<Option<Demo>, String> {
        Demo::parse(line.split_whitespace().map(OsString::from))
    }

    #[test]
    fn arguments_choose_the_target() {
        let recording = Recording::new("a.png".into());
        let cases = [
            ("", Some(Demo::Window)),
            ("--help", None),
            ("--headless a.png", Some(Demo::Record(recording.clone()))),
            ("--frames 9 --headless a.png", Some(Demo::Record(Recording { frames: 0..9, ..recording.clone() }))),
            ("--headless a.png --size 64x32", Some(Demo::Record(Recording { size: UVec2::new(64, 32), ..recording }))),
        ];
        for (line, expected) in cases {
            assert_eq!(parse(line), Ok(expected), "{line}");
        }
    }

    #[test]
    fn contradictory_arguments_are_refused_by_name() {
        let cases = [
            ("--headles a.png", "unknown argument --headles"),
            ("--headless", "--headless needs a value"),
            ("--headless a.png --frames 0", "--frames 0"),
            ("--headless a.png --frames 4000000000", "--frames 4000000000"),
            ("--headless a.png --size 0x4", "size 0x4"),
            ("--headless a.png --size 4", "size 4"),
            ("--frames 3", "needs --headless"),
            ("--size 3x3", "needs --headless"),
        ];
        for (line, expected) in cases {
            let problem = parse(line).unwrap_err();
            assert!(problem.contains(expected), "{line}: {problem}");
        }
    }
}

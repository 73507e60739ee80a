//! A virtual screen, and the windows on it.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

use crate::cargo::not_started;
use crate::failure::{Failure, Result};
use crate::setup::find;

/// An X display without hardware (Xvfb), which ends with this value.
pub(crate) struct VirtualScreen {
    server: Child,
    /// As the variable `DISPLAY` holds it.
    display: String,
}

impl VirtualScreen {
    /// Starts one, under a number that no other display has.
    ///
    /// # Errors
    /// Xvfb cannot be started, or names no display.
    pub(crate) fn start() -> Result<Self> {
        let mut command = Command::new(find("Xvfb").unwrap_or_else(|| "Xvfb".into()));
        command.args(["-displayfd", "1", "-screen", "0", "1280x1024x24", "-nolisten", "tcp"]);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut server = command.spawn().map_err(|error| not_started(&command, &error))?;
        let mut number = String::new();
        if let Some(output) = server.stdout.take() {
            // Xvfb prints its number when it is ready for windows.
            BufReader::new(output).read_line(&mut number).map_err(|error| not_started(&command, &error))?;
        }
        let screen = Self { server, display: format!(":{}", number.trim()) };
        if number.trim().is_empty() { Err(Failure::new("Xvfb ended without naming a display")) } else { Ok(screen) }
    }

    /// Lets `command` open its windows here.
    pub(crate) fn lend<'a>(&self, command: &'a mut Command) -> &'a mut Command {
        command.env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET").env("DISPLAY", &self.display)
    }

    /// Whether a window with a title is open.
    pub(crate) fn has_window(&self) -> bool {
        let mut list = Command::new("xwininfo");
        let output = self.lend(list.args(["-root", "-children"])).output();
        output.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).lines().any(is_titled_window))
    }
}

impl Drop for VirtualScreen {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// Whether a line of `xwininfo -root -children` is of a window with a title and more than one pixel:
/// `0x200004 "halfway": ("halfway" "halfway")  1280x720+0+0  +0+0`.
fn is_titled_window(line: &str) -> bool {
    let line = line.trim();
    let titled = line.starts_with("0x") && line.contains(" \"");
    let size = line.split_whitespace().rev().nth(1).and_then(|place| place.split_once('x'));
    titled && size.is_some_and(|(width, rest)| width != "1" || !rest.starts_with("1+"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_told_from_what_is_none() {
        let rows = [
            (r#"     0x200004 "halfway – teapot": ("halfway" "halfway")  1280x720+0+0  +0+0"#, true),
            (r#"     0x200001 "winit helper": ()  1x1+-1+-1  +-1+-1"#, false),
            ("     0x200002 (has no name): ()  640x480+0+0  +0+0", false),
            (r#"  Root window id: 0x50f (the root window) "root""#, false),
            ("     0 children.", false),
            ("", false),
        ];
        for (line, expected) in rows {
            assert_eq!(is_titled_window(line), expected, "{line}");
        }
    }
}

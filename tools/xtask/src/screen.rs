//! A virtual screen.

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
}

impl Drop for VirtualScreen {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

//! A Wayland display in a window of the X display, whose contents can be read there.

use std::process::{Child, Command, Stdio};

use tempfile::TempDir;
use x11rb::protocol::xproto::{ConnectionExt, MapState, Window};

use super::viewer::{Picture, Screen, eventually};

/// Weston with one full-screen program, until it is dropped.
pub(crate) struct Compositor<'a> {
    screen: &'a Screen,
    process: Child,
    window: Window,
    /// Where its socket is.
    folder: TempDir,
}

impl<'a> Compositor<'a> {
    const SOCKET: &'static str = "halfway-test";

    pub(crate) fn start(screen: &'a Screen, width: u16, height: u16) -> Self {
        let folder = TempDir::new().expect("there is room for a folder");
        let process = Command::new("weston")
            .args([
                "--no-config",
                "--backend=x11-backend.so",
                "--shell=kiosk-shell.so",
                "--use-pixman",
                "--idle-time=0",
            ])
            .args([format!("--socket={}", Self::SOCKET), format!("--width={width}"), format!("--height={height}")])
            .env("DISPLAY", &screen.name)
            .env("XDG_RUNTIME_DIR", folder.path())
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .stdin(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap_or_else(|error| {
                panic!(
                    "no Wayland display for the test: weston does not start ({error}). \
                     Install it (Debian and Ubuntu: apt-get install weston)"
                )
            });
        let mut compositor = Self { screen, process, window: 0, folder };
        // It has no window before it has drawn for the first time, and the display answers once the socket is there.
        compositor.window = eventually("weston opens a window", || {
            if let Some(status) = compositor.process.try_wait().expect("it is a child") {
                panic!("weston ended by itself: {status}");
            }
            let tree = screen.connection.query_tree(screen.root).ok()?.reply().ok()?;
            tree.children.into_iter().find(|&window| {
                let picture = screen.picture_of(window).filter(|shown| (shown.width, shown.height) == (width, height));
                let looks = screen.connection.get_window_attributes(window).ok().and_then(|asked| asked.reply().ok());
                picture.is_some() && looks.is_some_and(|looks| looks.map_state == MapState::VIEWABLE)
            })
        });
        eventually("weston answers", || compositor.folder.path().join(Self::SOCKET).exists().then_some(()));
        compositor
    }

    /// Starts a program that has no other display.
    pub(crate) fn run(&self, mut program: Command) -> Shown<'_> {
        program.env_remove("DISPLAY").env("WAYLAND_DISPLAY", Self::SOCKET).env("XDG_RUNTIME_DIR", self.folder.path());
        // Without images of pointers none lies over the picture.
        program.env("XCURSOR_PATH", self.folder.path());
        Shown { on: self, process: program.spawn().expect("the program starts") }
    }
}

impl Drop for Compositor<'_> {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// A program whose window fills the display.
pub(crate) struct Shown<'a> {
    on: &'a Compositor<'a>,
    process: Child,
}

impl Shown<'_> {
    pub(crate) fn picture(&mut self) -> Option<Picture> {
        if let Some(status) = self.process.try_wait().expect("it is a child") {
            panic!("the program ended by itself: {status}");
        }
        self.on.screen.picture_of(self.on.window)
    }
}

impl Drop for Shown<'_> {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

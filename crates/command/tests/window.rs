//! The window as people meet it: it opens, shows the model, follows keys and size, and closes.
//!
//! It opens on the X display that `DISPLAY` names, or, where none is named, on a virtual screen (Xvfb) that the test
//! starts. Where neither can be had, the tests fail; `cargo xtask test` sees to it that one can.

#![cfg(target_os = "linux")]

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::Duration;

use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    AtomEnum, ClientMessageEvent, ConfigureWindowAux, ConnectionExt, EventMask, ImageFormat, InputFocus,
    KEY_PRESS_EVENT, KEY_RELEASE_EVENT, KeyButMask, KeyPressEvent, Keysym, MapState, Window,
};
use x11rb::rust_connection::RustConnection;
use x11rb::{CURRENT_TIME, NONE};

const ESCAPE: Keysym = 0xff1b;

/// Looks this often before giving up: minutes on a machine that is not stuck.
const LOOKS: u32 = 2400;
const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

/// Displays have one focus; the tests that open windows take turns.
static TURN: Mutex<()> = Mutex::new(());

#[test]
fn keys_choose_the_shading_and_the_size_is_followed() {
    let screen = Screen::open();
    let mut viewer = Viewer::open(&screen);
    let phong = viewer.shown("Phong, Blinn–Phong", None);
    // A clear colour and an unlit outline would have two.
    assert!(phong.colours() > 50, "{} colours", phong.colours());

    viewer.press('1'.into());
    let flat = viewer.shown("flat, Blinn–Phong", Some(&phong));
    viewer.press('2'.into());
    let gouraud = viewer.shown("Gouraud, Blinn–Phong", Some(&flat));
    assert!(gouraud != phong, "Gouraud shading looks like Phong shading");
    viewer.press('b'.into());
    let other_highlights = viewer.shown("Gouraud, Phong", Some(&gouraud));
    viewer.press('3'.into());
    viewer.shown("Phong, Phong", Some(&other_highlights));
    viewer.press('b'.into());
    // Nothing moves in this scene, so the picture is the first one to the bit.
    eventually("the first picture comes back", || (viewer.picture()? == phong).then_some(()));

    viewer.resize(1000, 600);
    eventually("the model fills as much of the new height as of the old", || {
        let picture = viewer.picture().filter(|picture| (picture.width, picture.height) == (1000, 600))?;
        same_framing(&phong, &picture).then_some(())
    });

    viewer.request_close();
    assert_eq!(viewer.end().code(), Some(0), "the exit code of a closed window");
}

#[test]
fn the_title_counts() {
    let screen = Screen::open();
    let mut viewer = Viewer::open(&screen);
    viewer.shown("Phong, Blinn–Phong", None);
    // The first title comes before there is a rate of frames, and tells of the frame that uploads everything.
    let settled = |title: &String| title.contains(" fps · ") && title.contains(" · 0 B · ");
    let title = eventually("a title with frames a second and nothing uploaded", || viewer.title().filter(settled));
    let (names, counted) = title.split_once(" — ").unwrap_or_else(|| panic!("no counters: {title}"));
    assert_eq!(names, "halfway – teapot.obj");
    // What shows only where there is some of it.
    let sometimes = ["culled", "listed", "awaiting levels", "pending"];
    let mut parts = counted.split(" · ").filter(|part| !sometimes.iter().any(|end| part.ends_with(end)));
    for noun in ["draw", "triangle", "light", "pipeline"] {
        let part = parts.next().unwrap_or_default();
        let (number, what) = part.split_once(' ').unwrap_or_else(|| panic!("{part:?} in {title}"));
        assert!(number.parse::<f64>().is_ok_and(|number| number > 0.0), "{part:?} in {title}");
        assert_eq!(what.rsplit(' ').next().map(|what| what.trim_end_matches('s')), Some(noun), "{title}");
    }
    assert_eq!(parts.next(), Some("0 B"), "{title}");
    let mut times = parts.filter_map(|part| part.split_once(" ms ").or(part.split_once(' ')));
    let cpu = times.next().filter(|(number, what)| *what == "CPU" && number.parse::<f64>().is_ok());
    assert!(cpu.is_some(), "{title}");
    // An adapter without a clock has no time of the GPU.
    let rest: Vec<_> = times.filter(|(_, what)| *what != "GPU").collect();
    assert!(matches!(rest[..], [(rate, "fps"), ("Phong,", "Blinn–Phong")] if rate.parse::<f64>().is_ok()), "{title}");
    viewer.request_close();
    assert_eq!(viewer.end().code(), Some(0));
}

#[test]
fn pipelines_come_in_beside_the_frames() {
    let screen = Screen::open();
    let mut viewer = Viewer::open(&screen);
    let settles = |viewer: &Viewer, pipelines: u32, shading: &str| {
        let counted = format!(" · {pipelines} pipelines · 0 B · ");
        let settled =
            |title: &String| title.contains(&counted) && title.ends_with(&format!(" · {shading}, Blinn–Phong"));
        eventually(&format!("{shading} by {pipelines} pipelines"), || viewer.title().filter(settled));
    };
    // The first frame's, and generic ones for three shadings by two reflectances.
    settles(&viewer, 7, "Phong");
    // One for each that is chosen and was not seen before.
    viewer.press('1'.into());
    settles(&viewer, 8, "flat");
    viewer.press('2'.into());
    settles(&viewer, 9, "Gouraud");
    viewer.press('3'.into());
    settles(&viewer, 9, "Phong");
    viewer.request_close();
    assert_eq!(viewer.end().code(), Some(0));
}

#[test]
fn a_lost_device_is_said_once_and_all_is_drawn_on() {
    const LOSSES: usize = 3;
    let screen = Screen::open();
    let mut program = device_loser();
    program.stdin(Stdio::piped()).stderr(Stdio::piped());
    let mut viewer = Viewer::run(&screen, program);
    let phong = viewer.shown("Phong, Blinn–Phong", None);
    for _ in 0..LOSSES {
        writeln!(viewer.process.stdin.as_ref().expect("it is piped")).expect("the program reads");
        viewer.press('1'.into());
        viewer.shown("flat, Blinn–Phong", Some(&phong));
        viewer.press('3'.into());
        eventually("the first picture comes back", || (viewer.picture()? == phong).then_some(()));
    }
    viewer.resize(1000, 600);
    eventually("a picture of the new size", || {
        let picture = viewer.picture().filter(|picture| (picture.width, picture.height) == (1000, 600))?;
        same_framing(&phong, &picture).then_some(())
    });
    viewer.request_close();
    assert_eq!(viewer.end().code(), Some(0));
    let mut said = String::new();
    viewer.process.stderr.take().expect("it is piped").read_to_string(&mut said).expect("messages are text");
    assert_eq!(said.matches("the graphics device was lost: it was destroyed").count(), LOSSES, "{said}");
    assert!(!said.contains("panicked"), "{said}");
}

#[test]
fn an_app_that_has_drawn_before_there_is_a_window_draws_in_it() {
    let screen = Screen::open();
    let mut program = device_loser();
    program.arg("--update-first");
    let mut viewer = Viewer::run(&screen, program);
    let after = viewer.shown("Phong, Blinn–Phong", None);
    viewer.request_close();
    assert_eq!(viewer.end().code(), Some(0));
    let mut viewer = Viewer::run(&screen, device_loser());
    assert!(after == viewer.shown("Phong, Blinn–Phong", None), "another picture than without");
    viewer.request_close();
    assert_eq!(viewer.end().code(), Some(0));
}

#[test]
fn a_window_whose_size_changes_without_end_keeps_drawing() {
    let screen = Screen::open();
    let mut viewer = Viewer::open(&screen);
    let before = viewer.shown("Phong, Blinn–Phong", None);
    // As often as a frame is drawn and oftener, down to a pixel, and beyond what is seen of the screen.
    for step in 0..300u32 {
        viewer.resize(1 + step * 37 % 900, 1 + step * 53 % 1500);
        if step % 3 == 0 {
            sleep(Duration::from_millis(u64::from(step % 7)));
        }
        viewer.assert_running();
    }
    viewer.resize(before.width.into(), before.height.into());
    eventually("the first picture comes back", || (viewer.picture()? == before).then_some(()));
    viewer.request_close();
    assert_eq!(viewer.end().code(), Some(0));
}

#[test]
fn escape_closes() {
    let screen = Screen::open();
    let mut viewer = Viewer::open(&screen);
    viewer.shown("Phong, Blinn–Phong", None);
    viewer.press(ESCAPE);
    assert_eq!(viewer.end().code(), Some(0));
}

#[test]
fn without_a_display_it_says_so() {
    let output = view().env_remove("DISPLAY").output().expect("the command starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), said.lines().count()), (Some(3), 1), "{said}");
    assert!(said.contains("DISPLAY") || said.contains("display"), "{said}");
}

/// The command that shows the teapot, on whatever X display it will be told.
fn view() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_halfway"));
    command.args(["view", concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/teapot.obj")]);
    command.env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET").stdin(Stdio::null());
    command
}

/// The example that loses its device by command, which Cargo builds beside this test.
fn device_loser() -> Command {
    let test = std::env::current_exe().expect("a running test has a path");
    let program = test.ancestors().nth(2).expect("tests lie in target/PROFILE/deps").join("examples/lose_device");
    assert!(program.is_file(), "{} is missing; run `cargo build --examples` with the same profile", program.display());
    let mut command = Command::new(program);
    command.env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET").stdin(Stdio::null());
    command
}

/// Asks until there is an answer.
fn eventually<T>(what: &str, mut ask: impl FnMut() -> Option<T>) -> T {
    for _ in 0..LOOKS {
        if let Some(answer) = ask() {
            return answer;
        }
        sleep(BETWEEN_LOOKS);
    }
    panic!("waited in vain: {what}")
}

/// Whether the model's edges are as far from the middle in both pictures, in heights. The field of view is a vertical
/// one, so that this holds for every width.
fn same_framing(a: &Picture, b: &Picture) -> bool {
    let (Some(a_edges), Some(b_edges)) = (a.edges(), b.edges()) else { return false };
    // Edges are whole pixels: half a pixel each way, and as much for where the pixels' centres fall.
    let tolerance = 1.0 / f64::from(a.height) + 1.0 / f64::from(b.height);
    a_edges.iter().zip(b_edges).all(|(a, b)| (a - b).abs() <= tolerance)
}

/// What a window shows.
#[derive(PartialEq)]
struct Picture {
    width: u16,
    height: u16,
    /// Four bytes a pixel, top row first; the fourth is no part of the colour and 0.
    bytes: Vec<u8>,
}

impl Picture {
    fn is_flat(&self) -> bool {
        self.bytes.chunks_exact(4).all(|pixel| pixel == &self.bytes[..4])
    }

    fn colours(&self) -> usize {
        self.bytes.chunks_exact(4).collect::<std::collections::HashSet<_>>().len()
    }

    /// Left, top, right and bottom of what is not background, from the middle, in heights; none where nothing is.
    fn edges(&self) -> Option<[f64; 4]> {
        let background = self.bytes.get(..4)?;
        let width = usize::from(self.width);
        let drawn = self.bytes.chunks_exact(4).enumerate().filter(|(_, pixel)| *pixel != background);
        let (mut left, mut top, mut right, mut bottom) = (usize::MAX, usize::MAX, 0, 0);
        for (index, _) in drawn {
            let (x, y) = (index % width, index / width);
            (left, right) = (left.min(x), right.max(x + 1));
            (top, bottom) = (top.min(y), bottom.max(y + 1));
        }
        let height = f64::from(self.height);
        let across = |x: usize| (x as f64 - f64::from(self.width) / 2.0) / height;
        let down = |y: usize| y as f64 / height - 0.5;
        (right > 0).then(|| [across(left), down(top), across(right), down(bottom)])
    }
}

/// An X display, to which the test itself is connected.
struct Screen {
    connection: RustConnection,
    root: Window,
    name: String,
    server: Option<Child>,
    _turn: MutexGuard<'static, ()>,
}

impl Screen {
    fn open() -> Self {
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let given = std::env::var("DISPLAY").ok().filter(|name| !name.is_empty());
        let (name, server) = given.map_or_else(Self::start, |name| (name, None));
        let (connection, number) = Self::connect(&name);
        let root = connection.setup().roots[number].root;
        Self { connection, root, name, server, _turn: turn }
    }

    /// Connects to a display. One that has just lost its last program may start afresh, and hangs up on whoever comes
    /// meanwhile; so it is asked again for a second.
    fn connect(name: &str) -> (RustConnection, usize) {
        let mut problem = None;
        for _ in 0..20 {
            match RustConnection::connect(Some(name)) {
                Ok(connected) => return connected,
                Err(error) => problem = Some(error),
            }
            sleep(BETWEEN_LOOKS);
        }
        panic!("the X display {name} does not answer: {}", problem.expect("there was one"));
    }

    /// Starts a virtual screen under a free number, which it writes when it is ready.
    fn start() -> (String, Option<Child>) {
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1280x1024x24", "-nolisten", "tcp"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap_or_else(|error| {
                panic!(
                    "no display for the tests of the window: DISPLAY is not set, and Xvfb does not start ({error}). \
                     Install it (Debian and Ubuntu: apt-get install xvfb)"
                )
            });
        let mut number = String::new();
        let output = server.stdout.take().expect("it is piped");
        BufReader::new(output).read_line(&mut number).expect("Xvfb writes text");
        assert!(!number.is_empty(), "Xvfb ended without a screen");
        (format!(":{}", number.trim()), Some(server))
    }

    /// The window of a process that can be seen, at any depth, since window managers put frames around it.
    fn window_of(&self, process: u32) -> Option<Window> {
        let pid = self.atom("_NET_WM_PID");
        let mut open = vec![self.root];
        while let Some(window) = open.pop() {
            // Windows come and go meanwhile; one that is gone is not the one.
            let Ok(tree) = self.connection.query_tree(window).ok()?.reply() else { continue };
            open.extend(tree.children);
            let owner = self.connection.get_property(false, window, pid, AtomEnum::CARDINAL, 0, 1).ok()?.reply();
            let is_its = owner.is_ok_and(|owner| owner.value32().is_some_and(|mut pid| pid.next() == Some(process)));
            let attributes = self.connection.get_window_attributes(window).ok()?.reply();
            if is_its && attributes.is_ok_and(|attributes| attributes.map_state == MapState::VIEWABLE) {
                return Some(window);
            }
        }
        None
    }

    fn atom(&self, name: &str) -> u32 {
        let request = self.connection.intern_atom(false, name.as_bytes()).expect("the display is there");
        request.reply().expect("every name can be an atom").atom
    }

    fn key_code(&self, symbol: Keysym) -> u8 {
        let setup = self.connection.setup();
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let request = self.connection.get_keyboard_mapping(first, last - first + 1).expect("the display is there");
        let mapping = request.reply().expect("a display has a keyboard");
        let columns = usize::from(mapping.keysyms_per_keycode).max(1);
        let mut keys = (first..=last).zip(mapping.keysyms.chunks(columns));
        let key = keys.find(|(_, symbols)| symbols.contains(&symbol));
        key.unwrap_or_else(|| panic!("no key of the display types {symbol:#x}")).0
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        if let Some(server) = &mut self.server {
            // Asked rather than killed, so that it leaves no lock behind.
            let _ = Command::new("sh").args(["-c", &format!("kill {}", server.id())]).status();
            let _ = server.wait();
        }
    }
}

/// The running command and its window.
struct Viewer<'a> {
    screen: &'a Screen,
    process: Child,
    window: Window,
}

impl<'a> Viewer<'a> {
    fn open(screen: &'a Screen) -> Self {
        Self::run(screen, view())
    }

    /// Starts a program, and waits for its window.
    fn run(screen: &'a Screen, mut program: Command) -> Self {
        let process = program.env("DISPLAY", &screen.name).spawn().expect("the program starts");
        let mut viewer = Self { screen, process, window: NONE };
        viewer.window = eventually("a window opens", || {
            viewer.assert_running();
            screen.window_of(viewer.process.id())
        });
        viewer
    }

    fn assert_running(&mut self) {
        if let Some(status) = self.process.try_wait().expect("it is a child") {
            panic!("the viewer ended by itself: {status}");
        }
    }

    /// The picture under a title that ends with `state`, once it has settled and is another than `before`.
    fn shown(&mut self, state: &str, before: Option<&Picture>) -> Picture {
        let mut last = None;
        eventually(&format!("another picture, under the title … {state}"), || {
            self.assert_running();
            let current = self.picture().filter(|picture| Some(picture) != before && !picture.is_flat());
            let settled = current.is_some() && current == last;
            last = current;
            if settled && self.title()?.ends_with(&format!(" · {state}")) { last.take() } else { None }
        })
    }

    fn title(&self) -> Option<String> {
        let (name, text) = (self.screen.atom("_NET_WM_NAME"), self.screen.atom("UTF8_STRING"));
        let request = self.screen.connection.get_property(false, self.window, name, text, 0, 256).ok()?;
        String::from_utf8(request.reply().ok()?.value).ok()
    }

    /// `None` while the window is not all on the screen, or its size changes at this moment.
    fn picture(&self) -> Option<Picture> {
        const COLOUR: u32 = 0x00ff_ffff;
        let connection = &self.screen.connection;
        let size = connection.get_geometry(self.window).ok()?.reply().ok()?;
        let (width, height) = (size.width, size.height);
        let image = connection.get_image(ImageFormat::Z_PIXMAP, self.window, 0, 0, width, height, COLOUR);
        let bytes = image.ok()?.reply().ok()?.data;
        (bytes.len() == 4 * usize::from(width) * usize::from(height)).then_some(Picture { width, height, bytes })
    }

    /// Gives the window the focus and a key to press and release.
    fn press(&self, key: Keysym) {
        let Screen { connection, root, .. } = self.screen;
        let press = KeyPressEvent {
            response_type: KEY_PRESS_EVENT,
            detail: self.screen.key_code(key),
            sequence: 0,
            time: CURRENT_TIME,
            root: *root,
            event: self.window,
            child: NONE,
            root_x: 0,
            root_y: 0,
            event_x: 0,
            event_y: 0,
            state: KeyButMask::default(),
            same_screen: true,
        };
        let release = KeyPressEvent { response_type: KEY_RELEASE_EVENT, ..press };
        let focus = connection.set_input_focus(InputFocus::PARENT, self.window, CURRENT_TIME);
        focus.expect("the display is there").check().expect("a window that is seen takes the focus");
        for event in [press, release] {
            // With no mask, an event goes to the program that made the window.
            let sent = connection.send_event(false, self.window, EventMask::NO_EVENT, event);
            sent.expect("the display is there").check().expect("the window takes keys");
        }
    }

    fn resize(&self, width: u32, height: u32) {
        let size = ConfigureWindowAux::new().width(width).height(height);
        let request = self.screen.connection.configure_window(self.window, &size);
        request.expect("the display is there").check().expect("the window takes a size");
    }

    /// What a window manager sends when the close button is clicked.
    fn request_close(&self) {
        let [protocols, delete] = ["WM_PROTOCOLS", "WM_DELETE_WINDOW"].map(|name| self.screen.atom(name));
        let message = ClientMessageEvent::new(32, self.window, protocols, [delete, CURRENT_TIME, 0, 0, 0]);
        let sent = self.screen.connection.send_event(false, self.window, EventMask::NO_EVENT, message);
        sent.expect("the display is there").check().expect("the window takes messages");
    }

    /// Waits until the viewer has ended.
    fn end(&mut self) -> ExitStatus {
        eventually("the viewer ends", || self.process.try_wait().expect("it is a child"))
    }
}

impl Drop for Viewer<'_> {
    fn drop(&mut self) {
        // After a failure it still runs.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

//! Tools of the tests: an X display, a program with a window on it, and the contents of the window.

use std::cell::RefCell;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::Duration;

use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    AtomEnum, BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ClientMessageEvent, ConfigureWindowAux, ConnectionExt,
    CreateWindowAux, EventMask, ImageFormat, InputFocus, KEY_PRESS_EVENT, KEY_RELEASE_EVENT, KeyButMask, KeyPressEvent,
    Keysym, MOTION_NOTIFY_EVENT, MapState, PropMode, Window, WindowClass,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;
use x11rb::{CURRENT_TIME, NONE};

/// The number of polls before giving up: minutes on a machine that is not stuck.
const LOOKS: u32 = 2400;
pub(crate) const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

/// Displays have one focus; the tests that open windows take turns.
static TURN: Mutex<()> = Mutex::new(());

/// Selects a graphics adapter unless the environment names another: only surfaces and devices can be lost.
fn by_a_driver(command: &mut Command) {
    if std::env::var_os("HALFWAY_ADAPTER").is_none() {
        command.env("HALFWAY_ADAPTER", "gpu");
    }
}

/// The command that shows the teapot without panels; the X display is set later.
pub(crate) fn view() -> Command {
    let mut command = view_with_panels();
    command.arg("--bare");
    command
}

/// The same with panels.
pub(crate) fn view_with_panels() -> Command {
    command(&["view", concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/teapot.obj")])
}

/// The command with arguments that open a window.
pub(crate) fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_halfway"));
    command.args(arguments);
    by_a_driver(&mut command);
    // The viewer begins as if for the first time, and remembers nothing.
    command.env("XDG_CONFIG_HOME", "/dev/null");
    command.env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET").stdin(Stdio::null());
    command
}

/// The example that loses its device by command, which Cargo builds beside this test.
pub(crate) fn device_loser() -> Command {
    let test = std::env::current_exe().expect("a running test has a path");
    let program = test.ancestors().nth(2).expect("tests lie in target/PROFILE/deps").join("examples/lose_device");
    assert!(program.is_file(), "{} is missing; run `cargo build --examples` with the same profile", program.display());
    let mut command = Command::new(program);
    by_a_driver(&mut command);
    command.env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET").stdin(Stdio::null());
    command
}

/// Polls until there is a value.
pub(crate) fn eventually<T>(what: &str, mut ask: impl FnMut() -> Option<T>) -> T {
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
pub(crate) fn same_framing(a: &Picture, b: &Picture) -> bool {
    let (Some(a_edges), Some(b_edges)) = (a.edges(), b.edges()) else { return false };
    // Edges are whole pixels: half a pixel each way, and as much for where the pixels' centres fall.
    let tolerance = 1.0 / f64::from(a.height) + 1.0 / f64::from(b.height);
    a_edges.iter().zip(b_edges).all(|(a, b)| (a - b).abs() <= tolerance)
}

/// The contents of a window.
#[derive(PartialEq)]
pub(crate) struct Picture {
    pub(crate) width: u16,
    pub(crate) height: u16,
    /// Four bytes a pixel, top row first; the fourth is no part of the colour and 0.
    bytes: Vec<u8>,
}

impl Picture {
    pub(crate) fn is_flat(&self) -> bool {
        self.bytes.chunks_exact(4).all(|pixel| pixel == &self.bytes[..4])
    }

    pub(crate) fn colors(&self) -> usize {
        self.bytes.chunks_exact(4).collect::<std::collections::HashSet<_>>().len()
    }

    /// The share of the pixels of a rectangle (left, top, right, bottom) that differ from another picture's by more than
    /// `steps` in a channel.
    pub(crate) fn share_of_others(&self, other: &Self, [left, top, right, bottom]: [u16; 4], steps: u8) -> f64 {
        let pixel = |picture: &Self, x: u16, y: u16| {
            let first = 4 * (usize::from(y) * usize::from(picture.width) + usize::from(x));
            <[u8; 4]>::try_from(&picture.bytes[first..first + 4]).expect("a pixel has four bytes")
        };
        let differs = |x, y| {
            let (a, b) = (pixel(self, x, y), pixel(other, x, y));
            a.iter().zip(b).any(|(a, b)| a.abs_diff(b) > steps)
        };
        let all = (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y)));
        all.filter(|&(x, y)| differs(x, y)).count() as f64 / f64::from(right - left) / f64::from(bottom - top)
    }

    /// Left, top, right and bottom of the non-background pixels, from the middle, in heights; `None` if there are none.
    pub(crate) fn edges(&self) -> Option<[f64; 4]> {
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
pub(crate) struct Screen {
    pub(super) connection: RustConnection,
    pub(super) root: Window,
    pub(crate) name: String,
    server: RefCell<Option<Child>>,
    _turn: MutexGuard<'static, ()>,
}

impl Screen {
    pub(crate) fn open() -> Self {
        let given = std::env::var("DISPLAY").ok().filter(|name| !name.is_empty());
        Self::from_server(|| given.map_or_else(Self::start, |name| (name, None)))
    }

    /// A display of the test's own, which it may end.
    pub(crate) fn open_own() -> Self {
        Self::from_server(Self::start)
    }

    /// Ends the display, if it is the test's own, under whatever is on it.
    pub(crate) fn end(&self) {
        if let Some(mut server) = self.server.take() {
            // Terminated rather than killed, so that it leaves no lock behind.
            let _ = Command::new("sh").args(["-c", &format!("kill {}", server.id())]).status();
            let _ = server.wait();
        }
    }

    fn from_server(server: impl FnOnce() -> (String, Option<Child>)) -> Self {
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let (name, server) = server();
        let (connection, number) = Self::connect(&name);
        let root = connection.setup().roots[number].root;
        Self { connection, root, name, server: server.into(), _turn: turn }
    }

    /// Connects to a display. A display that has just lost its last client may restart and close new connections
    /// meanwhile, so this retries for a second.
    pub(crate) fn connect(name: &str) -> (RustConnection, usize) {
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
    pub(crate) fn start() -> (String, Option<Child>) {
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

    /// The visible window of a process, at any depth, since window managers put frames around it.
    pub(crate) fn window_of(&self, process: u32) -> Option<Window> {
        let pid = self.atom("_NET_WM_PID");
        let mut open = vec![self.root];
        while let Some(window) = open.pop() {
            // Windows may close meanwhile; those are skipped.
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

    /// The contents of a window. `None` while it is not all on the screen, or its size changes at this moment.
    pub(crate) fn picture_of(&self, window: Window) -> Option<Picture> {
        const COLOUR: u32 = 0x00ff_ffff;
        let size = self.connection.get_geometry(window).ok()?.reply().ok()?;
        let (width, height) = (size.width, size.height);
        let image = self.connection.get_image(ImageFormat::Z_PIXMAP, window, 0, 0, width, height, COLOUR);
        let bytes = image.ok()?.reply().ok()?.data;
        (bytes.len() == 4 * usize::from(width) * usize::from(height)).then_some(Picture { width, height, bytes })
    }

    /// A window over all of the screen, that no window manager touches.
    pub(crate) fn cover(&self) -> Window {
        let cover = self.connection.generate_id().expect("there are ids");
        let look = CreateWindowAux::new().override_redirect(1).background_pixel(0);
        let class = WindowClass::INPUT_OUTPUT;
        let made = self.connection.create_window(0, cover, self.root, 0, 0, 1280, 1024, 0, class, 0, &look);
        made.expect("the display is there").check().expect("a window is made");
        self.connection.map_window(cover).expect("the display is there").check().expect("the window is mapped");
        cover
    }

    pub(crate) fn destroy(&self, window: Window) {
        self.connection.destroy_window(window).expect("the display is there").check().expect("the window is there");
    }

    /// Publishes the screen's dots per inch to programs, as a desktop does (XSETTINGS 0.5): the first call, before
    /// programs start, creates the window that owns the setting; later calls change it.
    pub(crate) fn tell_resolution(&self, teller: Option<Window>, dots: u32) -> Window {
        let connection = &self.connection;
        let teller = teller.unwrap_or_else(|| {
            let window = connection.generate_id().expect("there are ids");
            let class = WindowClass::INPUT_OUTPUT;
            let made = connection.create_window(0, window, self.root, 0, 0, 1, 1, 0, class, 0, &CreateWindowAux::new());
            made.expect("the display is there").check().expect("a window is made");
            let owned = connection.set_selection_owner(window, self.atom("_XSETTINGS_S0"), CURRENT_TIME);
            owned.expect("the display is there").check().expect("nothing else tells it");
            window
        });
        // In the order of this machine: a header with the number of settings, which is 1; a whole number, its name, and
        // it.
        let mut settings = vec![u8::from(cfg!(target_endian = "big")), 0, 0, 0];
        settings.extend([0, 1].map(u32::to_ne_bytes).as_flattened());
        settings.extend([0, 0]);
        settings.extend(7u16.to_ne_bytes());
        settings.extend(b"Xft/DPI\0");
        settings.extend([0, 1024 * dots].map(u32::to_ne_bytes).as_flattened());
        let name = self.atom("_XSETTINGS_SETTINGS");
        let length = settings.len() as u32;
        let told = connection.change_property(PropMode::REPLACE, teller, name, name, 8, length, &settings);
        told.expect("the display is there").check().expect("the window is there");
        teller
    }

    pub(crate) fn atom(&self, name: &str) -> u32 {
        let request = self.connection.intern_atom(false, name.as_bytes()).expect("the display is there");
        request.reply().expect("every name can be an atom").atom
    }

    pub(crate) fn key_code(&self, symbol: Keysym) -> u8 {
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

/// A window manager, until it is dropped.
pub(crate) struct Manager(Child);

impl Manager {
    /// Starts one, which changes nothing where the screen has one already.
    pub(crate) fn start(screen: &Screen) -> Self {
        let mut program = Command::new("openbox");
        program.env("DISPLAY", &screen.name).stdin(Stdio::null()).stderr(Stdio::null());
        let process = program.spawn().unwrap_or_else(|error| {
            panic!("no window manager for the test: openbox does not start ({error}). Install it (Debian and Ubuntu: apt-get install openbox)")
        });
        let manager = Self(process);
        let check = screen.atom("_NET_SUPPORTING_WM_CHECK");
        eventually("the screen has a window manager", || {
            let request = screen.connection.get_property(false, screen.root, check, AtomEnum::WINDOW, 0, 1).ok()?;
            (request.reply().ok()?.value_len == 1).then_some(())
        });
        manager
    }
}

impl Drop for Manager {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        self.end();
    }
}

/// The running command and its window.
pub(crate) struct Viewer<'a> {
    screen: &'a Screen,
    pub(crate) process: Child,
    pub(crate) window: Window,
}

impl<'a> Viewer<'a> {
    pub(crate) fn open(screen: &'a Screen) -> Self {
        Self::run(screen, view())
    }

    /// Starts a program, and waits for its window.
    pub(crate) fn run(screen: &'a Screen, mut program: Command) -> Self {
        let process = program.env("DISPLAY", &screen.name).spawn().expect("the program starts");
        let mut viewer = Self { screen, process, window: NONE };
        viewer.window = eventually("a window opens", || {
            viewer.assert_running();
            screen.window_of(viewer.process.id())
        });
        viewer
    }

    pub(crate) fn assert_running(&mut self) {
        if let Some(status) = self.process.try_wait().expect("it is a child") {
            panic!("the viewer ended by itself: {status}");
        }
    }

    /// The picture under a title that ends with `state`, once it has settled and differs from `before`.
    pub(crate) fn shown(&mut self, state: &str, before: Option<&Picture>) -> Picture {
        let mut last = None;
        eventually(&format!("another picture, under the title … {state}"), || {
            self.assert_running();
            let current = self.picture().filter(|picture| Some(picture) != before && !picture.is_flat());
            let settled = current.is_some() && current == last;
            last = current;
            if settled && self.title()?.ends_with(&format!(" · {state}")) { last.take() } else { None }
        })
    }

    /// A picture under a title that ends with `state`. Unlike those of [`shown`](Self::shown) it need not have settled:
    /// panels have a graph of times, which never does.
    pub(crate) fn titled(&mut self, state: &str) -> Picture {
        eventually(&format!("a picture under the title … {state}"), || {
            self.assert_running();
            let is_titled = self.title()?.ends_with(&format!(" · {state}"));
            self.picture().filter(|picture| is_titled && !picture.is_flat())
        })
    }

    pub(crate) fn title(&self) -> Option<String> {
        let (name, text) = (self.screen.atom("_NET_WM_NAME"), self.screen.atom("UTF8_STRING"));
        let request = self.screen.connection.get_property(false, self.window, name, text, 0, 256).ok()?;
        String::from_utf8(request.reply().ok()?.value).ok()
    }

    pub(crate) fn picture(&self) -> Option<Picture> {
        self.screen.picture_of(self.window)
    }

    /// Gives the window the focus and a key to press and release.
    pub(crate) fn press(&self, key: Keysym) {
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

    /// Moves the pointer to a pixel of the window and clicks there.
    pub(crate) fn click(&self, x: i16, y: i16) {
        let Screen { connection, root, .. } = self.screen;
        let corner = connection.translate_coordinates(self.window, *root, x, y).expect("the display is there");
        let at = corner.reply().expect("the window is there");
        for (kind, detail) in [(MOTION_NOTIFY_EVENT, 0), (BUTTON_PRESS_EVENT, 1), (BUTTON_RELEASE_EVENT, 1)] {
            let sent = connection.xtest_fake_input(kind, detail, CURRENT_TIME, *root, at.dst_x, at.dst_y, 0);
            sent.expect("the display is there").check().expect("it has a pointer");
            // The window draws between them.
            sleep(BETWEEN_LOOKS);
        }
    }

    /// Gives the window a size, and waits until it shows a picture of that.
    pub(crate) fn take_size(&self, width: u16, height: u16) {
        self.resize(width.into(), height.into());
        eventually("the window takes the size", || {
            self.picture().filter(|shown| (shown.width, shown.height) == (width, height) && !shown.is_flat())
        });
    }

    pub(crate) fn resize(&self, width: u32, height: u32) {
        let size = ConfigureWindowAux::new().width(width).height(height);
        let request = self.screen.connection.configure_window(self.window, &size);
        request.expect("the display is there").check().expect("the window takes a size");
    }

    pub(crate) fn set_mapped(&self, mapped: bool) {
        let connection = &self.screen.connection;
        let request = if mapped { connection.map_window(self.window) } else { connection.unmap_window(self.window) };
        request.expect("the display is there").check().expect("the window is there");
    }

    /// How long the viewer has worked, in the system's ticks.
    pub(crate) fn cpu_ticks(&self) -> u64 {
        let status = std::fs::read_to_string(format!("/proc/{}/stat", self.process.id())).expect("the viewer runs");
        // The twelfth and thirteenth fields after the name, which may contain spaces.
        let (_, behind) = status.rsplit_once(')').expect("a name in brackets");
        behind.split_whitespace().skip(11).take(2).map(|ticks| ticks.parse::<u64>().expect("a number")).sum()
    }

    /// Asks the window manager for something of this window, by the name of the message (ICCCM 4.1.4, EWMH).
    pub(crate) fn ask_manager(&self, request: &str, data: [u32; 5]) {
        let Screen { connection, root, .. } = self.screen;
        let message = ClientMessageEvent::new(32, self.window, self.screen.atom(request), data);
        let mask = EventMask::SUBSTRUCTURE_REDIRECT | EventMask::SUBSTRUCTURE_NOTIFY;
        let sent = connection.send_event(false, *root, mask, message);
        sent.expect("the display is there").check().expect("the root takes messages");
    }

    /// The message that a window manager sends when the close button is clicked.
    pub(crate) fn request_close(&self) {
        let [protocols, delete] = ["WM_PROTOCOLS", "WM_DELETE_WINDOW"].map(|name| self.screen.atom(name));
        let message = ClientMessageEvent::new(32, self.window, protocols, [delete, CURRENT_TIME, 0, 0, 0]);
        let sent = self.screen.connection.send_event(false, self.window, EventMask::NO_EVENT, message);
        sent.expect("the display is there").check().expect("the window takes messages");
    }

    /// Waits until the viewer has ended.
    pub(crate) fn end(&mut self) -> ExitStatus {
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

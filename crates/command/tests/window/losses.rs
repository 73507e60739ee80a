//! Losses of the window's resources: the device, the surface, the window and the display.

use std::io::{Read, Write};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use super::viewer::{Screen, Viewer, device_loser, eventually, same_framing, view};

/// The program, its input and its errors in pipes.
fn heard(mut program: Command) -> Command {
    program.stdin(Stdio::piped()).stderr(Stdio::piped());
    program
}

fn tell(viewer: &Viewer, line: &str) {
    writeln!(viewer.process.stdin.as_ref().expect("it is piped"), "{line}").expect("the program reads");
}

/// Waits until the program has ended, and returns its exit code and its output, which must not be a panic's.
fn last_words(viewer: &mut Viewer) -> (Option<i32>, String) {
    let code = viewer.end().code();
    let mut said = String::new();
    viewer.process.stderr.take().expect("it is piped").read_to_string(&mut said).expect("messages are text");
    assert!(!said.contains("panicked"), "{said}");
    (code, said)
}

/// Runs `view` on the tested adapter and on the CPU, several times, and calls a function with each, a little later
/// after the first picture each time.
fn each_a_little_later(screen: impl Fn() -> Screen, mut take_away: impl FnMut(&Screen, Viewer)) {
    for adapter in [None, Some("cpu")] {
        for milliseconds in [0, 3, 7, 240, 490] {
            let screen = screen();
            let mut program = heard(view());
            program.args(adapter.map(|name| ["--adapter", name]).iter().flatten());
            let mut viewer = Viewer::run(&screen, program);
            viewer.shown("Phong, Blinn–Phong", None);
            sleep(Duration::from_millis(milliseconds));
            take_away(&screen, viewer);
        }
    }
}

#[test]
fn a_lost_device_is_logged_once_and_drawing_continues() {
    const LOSSES: usize = 3;
    let screen = Screen::open();
    let mut viewer = Viewer::run(&screen, heard(device_loser()));
    let phong = viewer.shown("Phong, Blinn–Phong", None);
    for _ in 0..LOSSES {
        tell(&viewer, "device");
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
    let (code, said) = last_words(&mut viewer);
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(said.matches("the graphics device was lost: it was destroyed").count(), LOSSES, "{said}");
}

#[test]
fn a_lost_surface_is_made_anew() {
    let screen = Screen::open();
    let mut viewer = Viewer::run(&screen, heard(device_loser()));
    let phong = viewer.shown("Phong, Blinn–Phong", None);
    for _ in 0..3 {
        tell(&viewer, "surface");
        viewer.press('1'.into());
        viewer.shown("flat, Blinn–Phong", Some(&phong));
        viewer.press('3'.into());
        eventually("the first picture comes back", || (viewer.picture()? == phong).then_some(()));
    }
    // The new one has the window's size, and follows it.
    viewer.resize(1000, 600);
    tell(&viewer, "surface");
    eventually("a picture of the new size", || {
        let picture = viewer.picture().filter(|picture| (picture.width, picture.height) == (1000, 600))?;
        same_framing(&phong, &picture).then_some(())
    });
    viewer.request_close();
    assert_eq!(last_words(&mut viewer), (Some(0), String::new()));
}

#[test]
fn permanently_lost_surfaces_end_the_app_with_an_error() {
    let screen = Screen::open();
    let mut viewer = Viewer::run(&screen, heard(device_loser()));
    viewer.shown("Phong, Blinn–Phong", None);
    tell(&viewer, "surfaces");
    let (code, said) = last_words(&mut viewer);
    let expected = "the window's surface or the graphics device was lost 10 times in a row; the driver may be broken";
    assert!(code == Some(1) && said.lines().count() == 1 && said.contains(expected), "{code:?}: {said}");
}

#[test]
fn a_destroyed_window_ends_the_app() {
    each_a_little_later(Screen::open, |screen, mut viewer| {
        screen.destroy(viewer.window);
        let (code, said) = last_words(&mut viewer);
        // The loss of its surface may be detected before the display reports that of the window.
        let is_told = code == Some(1) && said.lines().count() == 1;
        assert!((code, said.as_str()) == (Some(0), "") || is_told, "{code:?}: {said}");
    });
}

#[test]
fn a_closed_display_ends_the_app_with_an_error() {
    each_a_little_later(Screen::open_own, |screen, mut viewer| {
        screen.end();
        let (code, said) = last_words(&mut viewer);
        assert!(code == Some(1) && !said.is_empty(), "{code:?}: {said}");
    });
}

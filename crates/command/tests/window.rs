//! The window from a user's view: it opens, shows the model, follows keys and size, and closes.
//!
//! It opens on the X display that `DISPLAY` names, or, where none is named, on a virtual screen (Xvfb) that the test
//! starts. Without either the tests fail; `cargo xtask test` provides one. The Wayland display of one test is a window
//! on that.

#![cfg(target_os = "linux")]

mod window {
    mod losses;
    pub(crate) mod viewer;
    pub(crate) mod wayland;
}

use std::process::Command;
use std::thread::sleep;
use std::time::Duration;

use window::viewer::{
    BETWEEN_LOOKS, Manager, Picture, Screen, Viewer, command, device_loser, eventually, same_framing,
};
use window::viewer::{view, view_with_panels};
use window::wayland::Compositor;
use x11rb::CURRENT_TIME;
use x11rb::protocol::xproto::Keysym;

const ESCAPE: Keysym = 0xff1b;

#[test]
fn keys_choose_the_shading_and_the_size_is_followed() {
    follows_keys_and_size(view());
}

#[test]
fn without_a_driver_the_cpu_draws_in_the_window() {
    let mut program = view();
    without_drivers(&mut program);
    program.args(["--adapter", "cpu"]);
    follows_keys_and_size(program);
}

#[test]
fn opengl_draws_in_the_window_where_it_is_asked_for() {
    let mut program = view();
    // Otherwise a graphics card's driver may be found, under its own name.
    program.env("LIBGL_ALWAYS_SOFTWARE", "true").args(["--adapter", "gl:llvmpipe"]);
    follows_keys_and_size(program);
}

/// Panels hear the mouse and the keys, and look the same painted by the CPU and by a graphics card.
#[test]
fn panels_are_used_by_hand() {
    // Between the graph of times, which differs, and the lower edge; and the values of what is selected.
    const TREE: [u16; 4] = [2, 100, 186, 600];
    const VALUES: [u16; 4] = [1014, 30, 1278, 600];
    let shown = |on_cpu: bool| -> [Picture; 2] {
        let mut program = view_with_panels();
        if on_cpu {
            without_drivers(&mut program);
            program.args(["--adapter", "cpu"]);
        }
        let screen = Screen::open();
        let mut viewer = Viewer::run(&screen, program);
        let first = viewer.titled("Phong, Blinn–Phong");
        // "Camera" in the list.
        viewer.click(38, 138);
        let camera = eventually("the camera's values are shown", || {
            viewer.picture().filter(|picture| picture.share_of_others(&first, VALUES, 8) > 0.01)
        });
        viewer.press(Keysym::from(b'1'));
        viewer.titled("flat, Blinn–Phong");
        // Panels come and go.
        viewer.press(Keysym::from(b'p'));
        eventually("the panels are gone", || {
            viewer.picture().filter(|picture| picture.share_of_others(&first, TREE, 8) > 0.5)
        });
        viewer.press(Keysym::from(b'p'));
        eventually("the panels are back", || {
            viewer.picture().filter(|picture| picture.share_of_others(&first, TREE, 8) < 0.1)
        });
        [first, camera]
    };
    let (by_cpu, by_card) = (shown(true), shown(false));
    for (number, (cpu, card)) in by_cpu.iter().zip(&by_card).enumerate() {
        // In the second one the pointer is on the tree, whose highlight fades in.
        for area in if number == 0 { &[TREE, VALUES][..] } else { &[VALUES] } {
            // Rounded corners and text may differ at their edges, since the card filters images and the CPU does not.
            let share = cpu.share_of_others(card, *area, 40);
            assert!(share < 0.02, "picture {number}: {share} of {area:?}");
        }
    }
}

/// Lines lie over the picture of a window, whoever draws it.
#[test]
fn lines_are_shown() {
    const LINES: [&str; 5] = ["--edges", "all", "--show", "axes", "--background=white..teal"];
    const SIZE: [u16; 2] = [600, 400];
    // The first picture that is as it should be: on a busy machine the window may show an earlier one for a while.
    let shown = |what: &str, arguments: &[&str], adapter: &str, is_right: &dyn Fn(&Picture) -> bool| -> Picture {
        let mut program = view();
        program.args(arguments);
        match adapter {
            "cpu" => without_drivers(&mut program),
            // Its windows take no copies.
            "gl:llvmpipe" => {
                program.env("LIBGL_ALWAYS_SOFTWARE", "true");
                // Lines take floats, which it draws where it is told to.
                program.env("MESA_EXTENSION_OVERRIDE", "+GL_ARB_color_buffer_float");
            }
            _ => {}
        }
        if !adapter.is_empty() {
            program.args(["--adapter", adapter]);
        }
        let screen = Screen::open();
        let mut viewer = Viewer::run(&screen, program);
        viewer.take_size(SIZE[0], SIZE[1]);
        viewer.shown("Phong, Blinn–Phong", None);
        let has_size = |picture: &Picture| [picture.width, picture.height] == SIZE;
        let mut last = None;
        eventually(what, || {
            let current = viewer.picture().filter(|picture| has_size(picture) && is_right(picture));
            let has_settled = current.is_some() && current == last;
            last = current;
            if has_settled { last.take() } else { None }
        })
    };
    let whole = [0, 0, SIZE[0], SIZE[1]];
    let plain = shown("a teapot", &[], "cpu", &|picture| picture.colors() > 50);
    let by_cpu = shown("lines by the CPU", &LINES, "cpu", &|picture| plain.share_of_others(picture, whole, 40) > 0.5);
    // Along silhouettes the card's surfaces may reach a pixel farther, and hide or show a line there.
    for adapter in ["", "gl:llvmpipe"] {
        let is_same = |picture: &Picture| by_cpu.share_of_others(picture, whole, 40) < 0.005;
        shown("the same lines by a card", &LINES, adapter, &is_same);
    }
}

/// Hides all graphics drivers from the program.
fn without_drivers(program: &mut Command) {
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES", "__EGL_VENDOR_LIBRARY_DIRS"] {
        program.env(variable, "/dev/null");
    }
}

// Of one scene and size the CPU makes the same bits everywhere; a window on X and one on Wayland are to show them.
#[test]
fn a_window_on_wayland_matches_one_on_x() {
    let screen = Screen::open();
    let program = || {
        let mut program = view();
        program.args(["--adapter", "cpu"]);
        program
    };
    let on_x = {
        let mut viewer = Viewer::run(&screen, program());
        viewer.take_size(600, 400);
        viewer.shown("Phong, Blinn–Phong", None)
    };
    assert!((on_x.width, on_x.height) == (600, 400) && on_x.colors() > 50, "{} colours", on_x.colors());
    let compositor = Compositor::start(&screen, 600, 400);
    let mut on_wayland = compositor.run(program());
    eventually("the same picture on Wayland", || (on_wayland.picture()? == on_x).then_some(()));
}

fn follows_keys_and_size(program: Command) {
    let screen = Screen::open();
    let mut viewer = Viewer::run(&screen, program);
    let phong = viewer.shown("Phong, Blinn–Phong", None);
    // A clear colour and an unlit outline would have two.
    assert!(phong.colors() > 50, "{} colours", phong.colors());

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
fn an_example_of_the_command_is_shown_and_leaves_no_files() {
    let screen = Screen::open();
    let folder = tempfile::tempdir().expect("a folder");
    let mut program = command(&["demo", "transforms", "--adapter", "cpu", "--shading", "gouraud", "--bare"]);
    program.env("TMPDIR", folder.path());
    let mut viewer = Viewer::run(&screen, program);
    assert!(viewer.shown("Gouraud, Blinn–Phong", None).colors() > 50);
    assert!(viewer.title().is_some_and(|title| title.starts_with("halfway – transforms.json — ")));
    viewer.press(ESCAPE);
    assert_eq!(viewer.end().code(), Some(0));
    assert_eq!(folder.path().read_dir().expect("the folder").count(), 0);
}

#[test]
fn the_title_shows_the_counters() {
    let screen = Screen::open();
    let mut viewer = Viewer::run(&screen, view());
    viewer.shown("Phong, Blinn–Phong", None);
    // The first title comes before the frame rate is known, and shows the counters of the frame that uploads
    // everything.
    let settled = |title: &String| title.contains(" fps · ") && title.contains(" · 0 B · ");
    let title = eventually("a title with frames a second and nothing uploaded", || viewer.title().filter(settled));
    let (names, counted) = title.split_once(" — ").unwrap_or_else(|| panic!("no counters: {title}"));
    assert_eq!(names, "halfway – teapot.obj");
    // Counters that are shown only if they are not 0.
    let sometimes = ["culled", "listed", "pending"];
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
    let mut viewer = Viewer::run(&screen, view());
    let settles = |viewer: &Viewer, pipelines: u32, shading: &str| {
        let counted = format!(" · {pipelines} pipelines · 0 B · ");
        let settled =
            |title: &String| title.contains(&counted) && title.ends_with(&format!(" · {shading}, Blinn–Phong"));
        eventually(&format!("{shading} by {pipelines} pipelines"), || viewer.title().filter(settled));
    };
    // The first frame's, and generic ones for three shadings by two reflectances.
    settles(&viewer, 7, "Phong");
    // One for each shading that is chosen for the first time.
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
    // Sizes change as often as frames are drawn and more often, down to a pixel, and beyond the screen.
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
fn a_window_follows_the_scale_of_its_screen() {
    let screen = Screen::open();
    let teller = screen.tell_resolution(None, 96);
    let mut viewer = Viewer::open(&screen);
    viewer.take_size(600, 400);
    let before = viewer.shown("Phong, Blinn–Phong", None);
    for _ in 0..3 {
        screen.tell_resolution(Some(teller), 192);
        eventually("the same picture, twice as large", || {
            let picture = viewer.picture().filter(|picture| (picture.width, picture.height) == (1200, 800))?;
            same_framing(&before, &picture).then_some(())
        });
        screen.tell_resolution(Some(teller), 96);
        eventually("the first picture comes back", || (viewer.picture()? == before).then_some(()));
    }
    viewer.request_close();
    assert_eq!(viewer.end().code(), Some(0));
}

#[test]
fn a_window_manager_minimises_it_and_fills_the_screen_with_it() {
    const ICONIC: u32 = 3;
    const REMOVE: u32 = 0;
    const ADD: u32 = 1;
    let screen = Screen::open();
    let _manager = Manager::start(&screen);
    let mut viewer = Viewer::open(&screen);
    // Within the screen, including the frame, so that all of it can be read, and with the screen's aspect ratio.
    viewer.take_size(500, 400);
    let before = viewer.shown("Phong, Blinn–Phong", None);
    viewer.ask_manager("WM_CHANGE_STATE", [ICONIC, 0, 0, 0, 0]);
    eventually("nothing is drawn", || {
        let ticks = viewer.cpu_ticks();
        sleep(4 * BETWEEN_LOOKS);
        (viewer.picture().is_none() && viewer.cpu_ticks() == ticks).then_some(())
    });
    viewer.ask_manager("_NET_ACTIVE_WINDOW", [2, CURRENT_TIME, 0, 0, 0]);
    eventually("the picture comes back", || (viewer.picture()? == before).then_some(()));

    let fullscreen = screen.atom("_NET_WM_STATE_FULLSCREEN");
    viewer.ask_manager("_NET_WM_STATE", [ADD, fullscreen, 0, 2, 0]);
    eventually("the model fills as much of another height", || {
        let picture = viewer.picture().filter(|picture| picture.height != before.height)?;
        same_framing(&before, &picture).then_some(())
    });
    viewer.ask_manager("_NET_WM_STATE", [REMOVE, fullscreen, 0, 2, 0]);
    eventually("the first picture comes back", || (viewer.picture()? == before).then_some(()));
    viewer.request_close();
    assert_eq!(viewer.end().code(), Some(0));
}

#[test]
fn nothing_is_drawn_while_nothing_can_be_seen() {
    let screen = Screen::open();
    let mut viewer = Viewer::open(&screen);
    let phong = viewer.shown("Phong, Blinn–Phong", None);
    let cover = screen.cover();
    eventually("the window knows that it is covered", || {
        let before = viewer.cpu_ticks();
        sleep(4 * BETWEEN_LOOKS);
        (viewer.cpu_ticks() == before).then_some(())
    });
    // The key takes effect when the window is visible again.
    viewer.press('1'.into());
    sleep(4 * BETWEEN_LOOKS);
    assert!(viewer.title().is_some_and(|title| title.ends_with(" · Phong, Blinn–Phong")), "the App went on");
    screen.destroy(cover);
    let flat = viewer.shown("flat, Blinn–Phong", Some(&phong));
    // The window is unmapped and mapped again.
    for _ in 0..3 {
        viewer.set_mapped(false);
        sleep(BETWEEN_LOOKS);
        viewer.set_mapped(true);
        eventually("the picture comes back", || (viewer.picture()? == flat).then_some(()));
    }
    viewer.press('3'.into());
    viewer.shown("Phong, Blinn–Phong", Some(&flat));
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
fn a_missing_display_is_an_error() {
    let output = view().env_remove("DISPLAY").output().expect("the command starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), said.lines().count()), (Some(3), 1), "{said}");
    assert!(said.contains("DISPLAY") || said.contains("display"), "{said}");
}

#[test]
fn a_missing_adapter_is_an_error() {
    let screen = Screen::open();
    for (name, has_drivers) in [("nothing", true), ("gpu", false)] {
        let mut program = view();
        if !has_drivers {
            without_drivers(&mut program);
            program.env("WGPU_BACKEND", "vulkan");
        }
        let output = program.args(["--adapter", name]).env("DISPLAY", &screen.name).output();
        let output = output.expect("the command starts");
        let said = String::from_utf8_lossy(&output.stderr);
        // The available adapters follow, a line each.
        let errors = said.lines().filter(|line| !line.starts_with("  "));
        assert_eq!((output.status.code(), errors.count()), (Some(3), 1), "{name}: {said}");
        assert!(said.contains("no graphics adapter"), "{name}: {said}");
    }
}

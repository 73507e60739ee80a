//! Choosing a graphics adapter by its name.

use crate::command::{asset, folder, succeeds};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Runs the command with these variables, and without all others that choose an adapter or a session.
fn run(folder: &Path, set: &[(&str, &str)], arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_halfway"));
    for variable in ["HALFWAY_ADAPTER", "HALFWAY_SIMD", "WGPU_BACKEND", "WGPU_ADAPTER_NAME"] {
        command.env_remove(variable);
    }
    for variable in ["XDG_RUNTIME_DIR", "WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"] {
        command.env_remove(variable);
    }
    let command = command.args(arguments).envs(set.iter().copied()).current_dir(folder);
    command.output().expect("the command was built with this test")
}

/// The lines that `halfway adapters` prints.
fn listed(folder: &Path, set: &[(&str, &str)]) -> Vec<String> {
    let output = run(folder, set, &["adapters"]);
    assert!(output.status.success(), "{output:?}");
    String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect()
}

/// A name for an adapter of the list: its backend and the first word of its own name.
fn name_of(line: &str) -> String {
    let (name, kind) = line.rsplit_once(" (").expect("a name and a backend");
    let backend = kind.split([',', ')']).next().unwrap_or_default();
    format!("{backend}:{}", name.split(' ').next().unwrap_or_default())
}

/// The renderer chosen by these variables and arguments, from the output of `verify`.
#[track_caller]
fn device(folder: &Path, set: &[(&str, &str)], more: &[&str]) -> String {
    let teapot = asset("assets/teapot.obj");
    // Its accuracy is for other tests to check.
    let verify = ["verify", &teapot, "--size", "16x12", "--json", "--max", "255"];
    let output = run(folder, set, &[&verify[..], more].concat());
    assert!(output.status.success(), "{set:?} {more:?}: {output:?}");
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    json["device"].as_str().expect("a line of the list").to_owned()
}

/// The first of these lines that is about this backend.
#[cfg(target_os = "linux")]
#[track_caller]
fn line_of<'a>(all: &'a [String], backend: &str) -> &'a str {
    let line = all.iter().find(|line| line.contains(&format!(" ({backend}")));
    line.unwrap_or_else(|| panic!("no adapter of {backend}; `cargo xtask test` installs its driver: {all:?}"))
}

// Otherwise tests over the whole list could pass on one adapter.
#[cfg(target_os = "linux")]
#[test]
fn the_list_has_vulkan_opengl_and_the_cpu() {
    let all = listed(&folder("three_adapters"), &[]);
    for backend in ["vulkan", "gl", "cpu"] {
        line_of(&all, backend);
    }
}

#[test]
fn every_adapter_of_the_list_can_be_chosen() {
    let folder = folder("adapters");
    let teapot = asset("assets/teapot.obj");
    let all = listed(&folder, &[]);
    assert!(!all.is_empty());
    for line in &all {
        let name = name_of(line).to_uppercase();
        // Its accuracy is for other tests to check.
        let verify = ["verify", &teapot, "--size", "32x24", "--json", "--max", "255", "--adapter", &name];
        let json: serde_json::Value = serde_json::from_str(&succeeds(&folder, &verify)).expect("JSON");
        assert_eq!(json["device"], **line, "{name}");
        assert_eq!(listed(&folder, &[("HALFWAY_ADAPTER", &name)])[0], *line, "the one that is used comes first");
    }
    let own = name_of(&all[0]);
    succeeds(&folder, &["render", &teapot, "--size", "32x24", "-o", "a.png", "--adapter", &own]);
    let bench = ["bench", "s4", "--size", "16x16", "--rounds", "1", "--json", "--adapter", &own];
    let json: serde_json::Value = serde_json::from_str(&succeeds(&folder, &bench)).expect("JSON");
    assert!(json["machine"]["adapter"].as_str().is_some_and(|adapter| all[0].starts_with(adapter)), "{json}");
}

/// Variables of the environment, arguments, and the exit code.
type Row<'a> = (&'a [(&'a str, &'a str)], &'a [&'a str], i32);

#[test]
fn a_name_without_a_match_lists_the_adapters() {
    let folder = folder("no_such_adapter");
    let teapot = asset("assets/teapot.obj");
    let all = listed(&folder, &[]);
    let own = name_of(&all[0]);
    let render = ["render", &teapot, "--size", "32x24", "-o", "a.png"];
    let by_name = |name: &str| [&render[..], &["--adapter", name]].concat().join("\n");
    let commands = [
        by_name("nothing"),
        by_name("metal:nothing"),
        format!("verify\n{teapot}\n--adapter\nnothing"),
        "bench\ns4\n--adapter\nnothing".to_owned(),
        "bench\nfeatures\n--adapter\nnothing".to_owned(),
    ];
    for command in commands {
        let output = run(&folder, &[], &command.split('\n').collect::<Vec<_>>());
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{command}: {error}");
        assert!(error.contains("no graphics adapter fits"), "{command}: {error}");
        assert!(all.iter().all(|line| error.contains(line)), "{command}: {error}");
    }
    assert!(!folder.join("a.png").exists(), "the reference renderer did not step in");

    // The more specific choice wins.
    let backend = own.split(':').next().unwrap_or_default();
    let rows: [Row; 6] = [
        (&[("HALFWAY_ADAPTER", "nothing")], &[], 3),
        (&[("HALFWAY_ADAPTER", "nothing")], &["--adapter", &own], 0),
        (&[("WGPU_ADAPTER_NAME", "nothing")], &[], 3),
        (&[("WGPU_ADAPTER_NAME", "nothing"), ("HALFWAY_ADAPTER", &own)], &[], 0),
        (&[("WGPU_BACKEND", "noop"), ("HALFWAY_ADAPTER", backend)], &[], 0),
        (&[("HALFWAY_ADAPTER", "")], &[], 0),
    ];
    for (set, more, expected) in rows {
        let output = run(&folder, set, &[&render[..], more].concat());
        assert_eq!(output.status.code(), Some(expected), "{set:?} {more:?}: {output:?}");
    }
}

#[test]
fn wgpu_s_own_variable_chooses_any_driver_of_the_list() {
    let folder = folder("own_variable");
    let all = listed(&folder, &[]);
    let drivers: Vec<_> = all.iter().filter(|line| !line.contains(" (cpu")).collect();
    assert!(!drivers.is_empty(), "{all:?}");
    for line in drivers {
        assert_eq!(device(&folder, &[("WGPU_ADAPTER_NAME", &name_of(line))], &[]), *line);
    }
}

// As promised by `AdapterChoice` and docs/decisions/0027-which-adapter.md.
#[cfg(target_os = "linux")]
#[test]
fn a_name_outranks_drivers_but_reveals_no_hidden_ones() {
    let folder = folder("named_drivers");
    let all = listed(&folder, &[]);
    let [vulkan, gl, cpu] = ["vulkan", "gl", "cpu"].map(|backend| line_of(&all, backend));
    let of_gl = name_of(gl);
    // Named drivers count as chosen, software ones included, and an adapter's name is more specific.
    let mesa_s = ("VK_DRIVER_FILES", "/usr/share/vulkan/icd.d");
    assert!(device(&folder, &[mesa_s], &[]).contains(" (vulkan"));
    for (name, line) in [("cpu", cpu), (of_gl.as_str(), gl)] {
        assert_eq!(device(&folder, &[mesa_s], &["--adapter", name]), line);
        assert_eq!(device(&folder, &[mesa_s, ("HALFWAY_ADAPTER", name)], &[]), line);
    }
    assert_eq!(device(&folder, &[mesa_s, ("WGPU_BACKEND", "gl")], &[]), gl);
    // Without a Vulkan driver no name selects one; other adapters can be selected.
    let none = [("VK_DRIVER_FILES", "/nowhere.json"), ("VK_ICD_FILENAMES", "/nowhere.json")];
    assert_eq!(device(&folder, &none, &["--adapter", &of_gl]), gl);
    let teapot = asset("assets/teapot.obj");
    let output = run(&folder, &none, &["render", &teapot, "-o", "a.png", "--adapter", &name_of(vulkan)]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{error}");
    assert!(error.contains("no graphics adapter fits") && error.contains(gl) && error.contains(cpu), "{error}");
    assert!(!error.contains(vulkan) && !folder.join("a.png").exists(), "{error}");
}

/// A blended box before the camera, brighter than 16-bit floats can be.
const BRIGHT: &str = r#"{"size": [8, 8], "lights": [], "camera": {"position": [0, 0, 3], "target": [0, 0, 0]},
    "objects": [{"mesh": {"box": {}}, "blend": true,
        "material": {"diffuse": [0, 0, 0], "emission": [100000, 100000, 100000]}}]}"#;

#[test]
fn a_picture_holds_32_bit_floats_or_is_an_error_and_no_file() {
    for line in listed(&folder("floats"), &[]) {
        let folder = folder("floats");
        fs::write(folder.join("bright.json"), BRIGHT).expect("the folder can be written");
        let name = name_of(&line);
        let draw = |file: &str| run(&folder, &[], &["render", "bright.json", "-o", file, "--adapter", &name]);
        let output = draw("a.exr");
        if output.status.success() {
            let picture = image::open(folder.join("a.exr")).expect("it was written").into_rgb32f();
            assert!(picture.get_pixel(4, 4).0.iter().all(|value| (value - 1e5).abs() < 1.0), "{line}: {picture:?}");
        } else {
            let error = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{line}: {error}");
            assert!(error.contains("32-bit floats, and the adapter cannot"), "{line}: {error}");
            assert!(!line.contains(" (cpu"), "{error}");
            assert_eq!(fs::read_dir(&folder).expect("it was made").count(), 1, "{line}: something was left");
        }
        // One of the remedies that the error names.
        assert!(draw("a.png").status.success(), "{line}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn opengl_is_tried_before_giving_up() {
    let folder = folder("opengl");
    let teapot = asset("assets/teapot.obj");
    let opengl = listed(&folder, &[]).into_iter().find(|line| line.contains(" (gl"));
    let without_vulkan = [("VK_DRIVER_FILES", "/dev/null"), ("VK_ICD_FILENAMES", "/dev/null")];
    let output = run(&folder, &without_vulkan, &["adapters"]);
    let (said, error) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if let Some(line) = opengl {
        assert_eq!(said.lines().next(), Some(line.as_str()), "{error}");
        let output = run(&folder, &without_vulkan, &["render", &teapot, "--size", "32x24", "-o", "a.png"]);
        assert!(output.status.success(), "{output:?}");
        assert!(!String::from_utf8_lossy(&output.stderr).contains("reference renderer"), "{output:?}");
    } else {
        assert!(said.ends_with("(cpu, software)\n"), "{said}{error}");
    }
    // The message names the limit exactly.
    let output = run(&folder, &[("WGPU_BACKEND", "metal")], &["adapters"]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{error}");
    assert!(error.contains("WGPU_BACKEND") && !error.contains("OpenGL"), "{error}");
}

#[test]
fn a_machine_without_a_session_prints_no_warning() {
    let folder = folder("no_session");
    let teapot = asset("assets/teapot.obj");
    let render = ["render", &teapot, "--size", "32x24", "-o", "a.png"];
    // The second draws with a driver, whatever the machine's default is.
    for arguments in [&render[..], &[&render[..], &["--adapter", "gpu"]].concat(), &["adapters"]] {
        let output = run(&folder, &[], arguments);
        assert!(output.status.success(), "{output:?}");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{arguments:?}");
    }
}

//! Machines made of empty files.

use super::*;
use std::fs;
use tempfile::{TempDir, tempdir};

/// Name and value.
type Pair<'a> = (&'a str, &'a str);
/// Case, drivers, devices, and the manifest or part of the problem.
type Row<'a> = (&'a str, &'a [Pair<'a>], &'a [&'a str], Result<&'a str, &'a str>);

/// Writes a file in the machine's folder, and makes the folders it is in.
fn file(scratch: &TempDir, name: &str, text: &str) {
    let path = scratch.path().join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
}

/// A machine with the loader and the named drivers, each `name: library_path`; `@` stands for the machine's folder.
fn machine(scratch: &TempDir, drivers: &[Pair]) -> Drivers {
    file(scratch, "lib/libvulkan.so.1", "");
    for name in ["libvulkan_lvp.so", "libvulkan_intel.so", "libGLX_nvidia.so.0", "libvulkan_dzn.so"] {
        file(scratch, &format!("lib/{name}"), "");
    }
    for (name, library) in drivers {
        let library = library.replace('@', scratch.path().to_str().unwrap());
        file(scratch, &format!("icd.d/{name}.json"), &format!(r#"{{"ICD": {{"library_path": "{library}"}}}}"#));
    }
    Drivers {
        libraries: Libraries::in_folder(&scratch.path().join("lib")),
        manifests: expanded(scratch.path().join("icd.d")),
        devices: scratch.path().join("dev"),
    }
}

#[test]
fn drivers_need_their_library_and_their_device() {
    const LVP: Pair = ("lvp_icd.x86_64", "@/lib/libvulkan_lvp.so");
    const INTEL: Pair = ("intel_icd.x86_64", "libvulkan_intel.so");
    const NVIDIA: Pair = ("nvidia_icd", "libGLX_nvidia.so.0");
    const DZN: Pair = ("dzn_icd", "../lib/libvulkan_dzn.so");
    let rows: [Row; 11] = [
        ("software", &[LVP], &[], Ok("lvp_icd.x86_64.json")),
        ("software beside idle hardware drivers", &[INTEL, LVP], &[], Ok("lvp_icd.x86_64.json")),
        ("hardware first", &[INTEL, LVP], &["dri/renderD128"], Ok("intel_icd.x86_64.json")),
        ("a driver without a card", &[INTEL], &[], Err("intel_icd.x86_64.json: needs a graphics card")),
        ("a card that only shows pictures", &[INTEL], &["dri/card0"], Err("needs a graphics card")),
        ("NVIDIA", &[NVIDIA], &["nvidia0"], Ok("nvidia_icd.json")),
        ("NVIDIA's driver without a card", &[NVIDIA], &["nvidiactl", "dri/renderD128"], Err("needs an NVIDIA card")),
        ("a Windows host", &[DZN], &["dxg"], Ok("dzn_icd.json")),
        ("no Windows host", &[DZN], &[], Err("needs a Windows host")),
        ("a manifest whose library is gone", &[("lvp_icd", "@/gone/lvp.so")], &[], Err("gone/lvp.so is missing")),
        ("none", &[], &["dri/renderD128"], Err("no driver is installed")),
    ];
    for (name, drivers, devices, expected) in rows {
        let scratch = tempdir().unwrap();
        for device in devices {
            file(&scratch, &format!("dev/{device}"), "");
        }
        let machine = machine(&scratch, drivers);
        match (machine.usable(), expected) {
            (Ok(manifest), Ok(expected)) => assert!(manifest.ends_with(expected), "{name}: {manifest:?}"),
            (Err(problem), Err(expected)) => assert!(problem.to_string().contains(expected), "{name}: {problem}"),
            (found, _) => panic!("{name}: {found:?}"),
        }
    }
}

#[test]
fn drivers_need_the_loader() {
    let scratch = tempdir().unwrap();
    let machine = machine(&scratch, &[("lvp", "libvulkan_lvp.so"), ("intel", "libvulkan_intel.so")]);
    fs::remove_file(scratch.path().join("lib/libvulkan.so.1")).unwrap();
    let problem = machine.usable().unwrap_err();
    assert_eq!(problem.reasons, ["the loader libvulkan.so.1 is missing"]);
}

#[test]
fn broken_manifests_are_told_of() {
    let scratch = tempdir().unwrap();
    file(&scratch, "icd.d/a.json", "{}");
    file(&scratch, "icd.d/b.json", "");
    let problem = machine(&scratch, &[]).usable().unwrap_err();
    assert_eq!(problem.reasons.len(), 2, "{problem}");
    assert!(problem.reasons[0].ends_with("a.json: names no library_path"), "{problem}");
    assert!(problem.reasons[1].contains("b.json: not JSON: "), "{problem}");
}

#[test]
fn manifests_are_where_the_loader_looks() {
    let scratch = tempdir().unwrap();
    let root = scratch.path().to_str().unwrap();
    for name in ["home/.local/share/vulkan/icd.d/own.json", "data/vulkan/icd.d/b.json", "data/vulkan/icd.d/a.json"] {
        file(&scratch, name, "");
    }
    file(&scratch, "data/vulkan/icd.d/readme.txt", "");
    file(&scratch, "given/x.json", "");
    file(&scratch, "given/y.json", "");
    // Without these, the folders of the machine that runs the test would be read too; /etc still is.
    let elsewhere = [("XDG_CONFIG_DIRS", "@/none"), ("XDG_DATA_DIRS", "@/data"), ("HOME", "@/home")];
    let usual: &[&str] =
        &["home/.local/share/vulkan/icd.d/own.json", "data/vulkan/icd.d/a.json", "data/vulkan/icd.d/b.json"];
    let rows: [(&str, &[Pair], Vec<&str>); 4] = [
        ("the usual folders", &[], usual.to_vec()),
        ("one named file", &[("VK_DRIVER_FILES", "@/given/x.json:@/given/none.json")], vec!["given/x.json"]),
        ("the older name, a folder", &[("VK_ICD_FILENAMES", "@/given")], vec!["given/x.json", "given/y.json"]),
        ("one more", &[("VK_ADD_DRIVER_FILES", "@/given/y.json")], [&["given/y.json"], usual].concat()),
    ];
    for (name, variables, expected) in rows {
        let variable = |wanted: &str| {
            let set = variables.iter().chain(&elsewhere).find(|(name, _)| *name == wanted);
            set.map(|(_, value)| OsString::from(value.replace('@', root)))
        };
        let found = manifests(variable);
        let own: Vec<_> = found.iter().filter_map(|path| path.strip_prefix(root).ok()?.to_str()).collect();
        assert_eq!(own, expected, "{name}");
    }
}

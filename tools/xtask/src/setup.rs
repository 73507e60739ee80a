//! Set-up: a chore's requirements of the machine, and their installation.

use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;

use crate::cargo::step;
use crate::failure::{Failure, Result};

/// Whether set-up may change the machine.
#[derive(Args, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Setup {
    /// Install nothing; list missing requirements and their packages
    #[arg(long)]
    pub(crate) no_install: bool,
}

/// Something outside the project that a chore needs on Linux. Other systems bring all of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Need {
    /// For messages.
    name: &'static str,
    /// Any of these programs will do.
    programs: &'static [&'static str],
    /// All of these shared libraries are needed.
    libraries: &'static [&'static str],
    /// Any of these files will do.
    files: &'static [&'static str],
    /// The Debian packages that bring it.
    packages: &'static [&'static str],
}

const NOTHING: Need = Need { name: "", programs: &[], libraries: &[], files: &[], packages: &[] };

const fn program(name: &'static str, programs: &'static [&'static str], packages: &'static [&'static str]) -> Need {
    Need { name, programs, packages, ..NOTHING }
}

/// A C compiler, which links Rust programs, and one of C++ for what the fuzzer is written in.
pub(crate) const COMPILER: Need = program("a C++ compiler", &["c++"], &["g++"]);

/// The software driver of Vulkan.
pub(crate) const LAVAPIPE: Need = Need {
    name: "lavapipe, Mesa's software Vulkan driver",
    libraries: &["libvulkan.so.1"],
    files: &[
        "/usr/share/vulkan/icd.d/lvp_icd.json",
        "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json",
        "/usr/share/vulkan/icd.d/lvp_icd.aarch64.json",
    ],
    packages: &["libvulkan1", "mesa-vulkan-drivers"],
    ..NOTHING
};

/// The software driver of OpenGL, to be drawn with without a display.
pub(crate) const OPENGL: Need = Need {
    name: "llvmpipe, Mesa's software OpenGL driver, without a display",
    libraries: &["libEGL.so.1", "libEGL_mesa.so.0"],
    packages: &["libegl1", "libegl-mesa0", "libgl1-mesa-dri"],
    ..NOTHING
};

/// The manifests of `SwiftShader` where browsers keep it.
const SWIFTSHADER_MANIFESTS: &[&str] = &[
    "/usr/lib/chromium/vk_swiftshader_icd.json",
    "/usr/lib64/chromium-browser/vk_swiftshader_icd.json",
    "/usr/lib/chromium-browser/vk_swiftshader_icd.json",
];

/// `SwiftShader`, a second software driver of Vulkan.
pub(crate) const SWIFTSHADER: Need = Need {
    name: "SwiftShader, the software Vulkan driver that chromium brings",
    files: SWIFTSHADER_MANIFESTS,
    packages: &["chromium"],
    ..NOTHING
};

/// The manifest of `SwiftShader`.
pub(crate) fn swiftshader() -> Option<&'static str> {
    SWIFTSHADER_MANIFESTS.iter().copied().find(|path| Path::new(path).is_file())
}

/// The browser that opens the page of the charts.
pub(crate) const BROWSER: Need =
    program("the browser chromium", &["chromium", "chromium-browser", "google-chrome"], &["chromium"]);

/// A linker for 64-bit ARM, with its library of C.
pub(crate) const ARM_LINKER: Need =
    program("a linker for 64-bit ARM", &["aarch64-linux-gnu-gcc"], &["gcc-aarch64-linux-gnu", "libc6-dev-arm64-cross"]);

/// The emulator of 64-bit ARM processors on others.
pub(crate) const ARM_EMULATOR: Need =
    program("QEMU, which runs programs for ARM", &["qemu-aarch64-static"], &["qemu-user-static"]);

/// The counter of a processor's instructions.
pub(crate) const CALLGRIND: Need =
    program("valgrind, whose callgrind counts instructions", &["valgrind"], &["valgrind"]);

/// Python, which makes environments of its own.
pub(crate) const PYTHON: Need =
    Need { name: "Python with venv", programs: &["python3"], packages: &["python3", "python3-venv"], ..NOTHING };

/// An X display without hardware, to open windows on.
pub(crate) const VIRTUAL_SCREEN: Need = program("the virtual screen Xvfb", &["Xvfb"], &["xvfb"]);

/// A window manager, for the tests of the window on the virtual screen.
pub(crate) const WINDOW_MANAGER: Need = program("the window manager openbox", &["openbox"], &["openbox"]);

/// A Wayland display in a window of the virtual screen, for the tests of the window.
pub(crate) const COMPOSITOR: Need = program("the Wayland compositor weston", &["weston"], &["weston"]);

/// The libraries that windows on an X display load.
pub(crate) const X11_WINDOWS: Need = Need {
    name: "the libraries of windows on X",
    libraries: &[
        "libX11.so.6",
        "libX11-xcb.so.1",
        "libxcb.so.1",
        "libXcursor.so.1",
        "libXi.so.6",
        "libxkbcommon.so.0",
        "libxkbcommon-x11.so.0",
    ],
    packages: &["libx11-6", "libx11-xcb1", "libxcb1", "libxcursor1", "libxi6", "libxkbcommon0", "libxkbcommon-x11-0"],
    ..NOTHING
};

/// The libraries that windows on a Wayland display load.
pub(crate) const WAYLAND_WINDOWS: Need = Need {
    name: "the libraries of windows on Wayland",
    libraries: &["libwayland-client.so.0", "libxkbcommon.so.0"],
    packages: &["libwayland-client0", "libxkbcommon0"],
    ..NOTHING
};

impl Need {
    fn is_met(&self) -> bool {
        let any = |names: &[&str], is_there: fn(&str) -> bool| names.is_empty() || names.iter().any(|it| is_there(it));
        any(self.programs, |name| find(name).is_some())
            && any(self.files, |path| Path::new(path).is_file())
            && self.libraries.iter().all(|name| has_library(name))
    }
}

impl Setup {
    /// Checks that `needs` are met, and installs missing ones by apt-get where it may.
    ///
    /// # Errors
    /// The message lists the missing requirements, why they were not installed, and their packages.
    pub(crate) fn meet(self, needs: &[Need]) -> Result {
        let missing = missing(needs);
        if missing.is_empty() || !cfg!(target_os = "linux") {
            return Ok(());
        }
        if self.no_install {
            return Err(refusal(&missing, "--no-install was given"));
        }
        if find("apt-get").is_none() {
            return Err(refusal(&missing, "only apt-get is run from here"));
        }
        eprintln!("missing:\n{}\nInstalling them by apt-get.", listed(&missing));
        // An outdated list, or a repository that does not answer, need not prevent the installation.
        if let Err(failure) = step("what packages there are", &mut apt(&["update"])) {
            eprintln!("warning: {failure}");
        }
        let install = [&["install", "-y", "--no-install-recommends"], &packages(&missing)[..]].concat();
        step("installing", &mut apt(&install)).map_err(|failure| refusal(&missing, &failure.to_string()))?;
        let missing = self::missing(&missing);
        if missing.is_empty() { Ok(()) } else { Err(refusal(&missing, "the packages do not bring it")) }
    }
}

fn missing(needs: &[Need]) -> Vec<Need> {
    needs.iter().copied().filter(|need| !need.is_met()).collect()
}

fn listed(needs: &[Need]) -> String {
    needs.iter().map(|need| format!("  - {}", need.name)).collect::<Vec<_>>().join("\n")
}

fn packages(needs: &[Need]) -> Vec<&'static str> {
    needs.iter().flat_map(|need| need.packages).copied().collect()
}

/// The message if nothing is installed.
fn refusal(missing: &[Need], why: &str) -> Failure {
    let packages = packages(missing).join(" ");
    Failure::new(format!(
        "missing:\n{}\nNot installed: {why}. Install these Debian packages, or what your system calls them, and try \
         again:\n\n    {packages}",
        listed(missing)
    ))
}

/// A command of apt-get, by `sudo` for users other than root if that asks for no password. `env` follows `sudo`, which
/// passes no variables on; the variable keeps packages from asking questions.
fn apt(words: &[&str]) -> Command {
    let user = Command::new("id").arg("-u").output();
    let is_root = user.is_ok_and(|output| output.stdout.trim_ascii() == b"0");
    let mut command = Command::new(if is_root { "env" } else { "sudo" });
    if !is_root {
        command.args(["-n", "env"]);
    }
    command.args(["DEBIAN_FRONTEND=noninteractive", "apt-get"]).args(words);
    command
}

/// The path of a program: on the search path, or in the folders of administrators, which are not on every user's path.
pub(crate) fn find(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::env::split_paths(&path).chain(["/usr/sbin", "/sbin"].map(PathBuf::from));
    folders.map(|folder| folder.join(name)).find(|file| file.is_file())
}

/// Whether the dynamic loader finds a library: in the usual folders, or by its cache.
fn has_library(name: &str) -> bool {
    let given = std::env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
    let triple = format!("/usr/lib/{}-linux-gnu", std::env::consts::ARCH);
    let usual = [&triple, "/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib"].map(PathBuf::from);
    if std::env::split_paths(&given).chain(usual).any(|folder| folder.join(name).is_file()) {
        return true;
    }
    let cache = find("ldconfig").and_then(|ldconfig| Command::new(ldconfig).arg("-p").output().ok());
    cache.is_some_and(|output| is_cached(&String::from_utf8_lossy(&output.stdout), name))
}

/// Whether `ldconfig -p` lists a library that is still there, as in `libm.so.6 (libc6,x86-64) => /lib/libm.so.6`.
fn is_cached(listing: &str, name: &str) -> bool {
    listing
        .lines()
        .filter_map(|line| line.split_once("=>"))
        .any(|(entry, path)| entry.split_whitespace().next() == Some(name) && Path::new(path.trim()).is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNMET: Need = Need { name: "a thing", programs: &["no-program-has-this-name"], packages: &["x"], ..NOTHING };

    #[cfg(target_os = "linux")]
    #[test]
    fn missing_needs_are_not_installed_unasked() {
        let met = program("a shell", &["no-program-has-this-name", "sh"], &[]);
        let no_install = Setup { no_install: true };
        assert_eq!(no_install.meet(&[met]), Ok(()));
        let message = no_install.meet(&[met, UNMET]).unwrap_err().to_string();
        assert!(message.starts_with("missing:\n  - a thing\nNot installed: --no-install was given."), "{message}");
        assert!(message.ends_with("\n    x"), "{message}");
    }

    #[cfg(unix)]
    #[test]
    fn each_part_of_a_need_counts() {
        let rows = [
            (NOTHING, true),
            (UNMET, false),
            (Need { files: &["/no/such/file", "/bin/sh"], ..NOTHING }, true),
            (Need { files: &["/no/such/file"], ..NOTHING }, false),
            (Need { programs: &["sh"], libraries: &["libno-such-library.so"], ..NOTHING }, false),
        ];
        for (need, expected) in rows {
            assert_eq!(need.is_met(), expected, "{need:?}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn the_cache_lists_what_still_exists() {
        let listing = "2 libs found in cache `/etc/ld.so.cache'\n\tlibthere.so.1 (libc6,x86-64) => /bin/sh\n\
                       \tlibgone.so.1 (libc6) => /no/such/libgone.so.1\n";
        assert!(is_cached(listing, "libthere.so.1"));
        assert!(!is_cached(listing, "libthere.so"));
        assert!(!is_cached(listing, "libgone.so.1"));
    }

    #[test]
    fn packages_are_installed_without_questions() {
        let words: Vec<_> = apt(&["install", "x"]).get_args().map(|word| word.to_string_lossy().into_owned()).collect();
        assert!(words.ends_with(&["DEBIAN_FRONTEND=noninteractive", "apt-get", "install", "x"].map(String::from)));
    }
}

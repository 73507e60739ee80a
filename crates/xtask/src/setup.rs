//! Set-up: what a chore needs of the machine, and getting it.

use std::path::PathBuf;

use clap::Args;

use crate::cargo::{cargo, step, written};
use crate::failure::{Failure, Result};
use crate::machine::display::Display;
use crate::machine::driver::Drivers;
use crate::machine::libraries::Libraries;
use crate::machine::packages::{Manager, Packages, Rights, apt, is_root};
use crate::machine::programs;

/// Whether set-up may change the machine.
#[derive(Args, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Setup {
    /// Install nothing; say what is missing and how to get it
    #[arg(long)]
    pub(crate) no_install: bool,
}

/// Something outside the project that a chore needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Need {
    /// Why it is not met, or `None` where it is.
    missing: fn() -> Option<String>,
    packages: Packages,
}

/// A driver of Vulkan; the software one will do.
pub(crate) const VULKAN: Need = Need {
    missing: || Drivers::here().usable().err().map(|problem| problem.to_string()),
    packages: Packages {
        apt: &["libvulkan1", "mesa-vulkan-drivers"],
        dnf: &["vulkan-loader", "mesa-vulkan-drivers"],
        pacman: &["vulkan-icd-loader", "vulkan-swrast"],
    },
};

/// A driver to draw with: one of Vulkan, unless the environment chooses something else.
pub(crate) const DRIVER: Need =
    Need { missing: || if is_chosen(variable) { None } else { (VULKAN.missing)() }, ..VULKAN };

/// An environment variable that says something, in lower case.
fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok().filter(|value| !value.is_empty()).map(|value| value.to_lowercase())
}

/// Whether the environment chooses what Vulkan has no part in: the CPU, or another backend. That is the user's to care
/// for; whether it works is seen after the build.
fn is_chosen(variable: impl Fn(&str) -> Option<String>) -> bool {
    let is_vulkan = |backends: &str| backends.contains("vulkan") || backends.contains("vk");
    match variable("HALFWAY_ADAPTER") {
        // A part of an adapter's name may be that of one behind Vulkan.
        Some(name) => ["cpu", "gl", "opengl", "metal", "dx12"].contains(&name.split(':').next().unwrap_or_default()),
        None => variable("WGPU_BACKEND").is_some_and(|backends| !is_vulkan(&backends)),
    }
}

/// The software driver of OpenGL, to be drawn with without a display.
pub(crate) const OPENGL: Need = Need {
    missing: || missing_libraries("OpenGL without a display", &["libEGL.so.1", "libEGL_mesa.so.0"]),
    packages: Packages {
        apt: &["libegl1", "libegl-mesa0", "libgl1-mesa-dri"],
        dnf: &["libglvnd-egl", "mesa-libEGL", "mesa-dri-drivers"],
        pacman: &["libglvnd", "mesa"],
    },
};

/// `SwiftShader`, a second software driver of Vulkan, which comes with a browser.
pub(crate) const SWIFTSHADER: Need = Need {
    missing: || swiftshader().is_none().then(|| "SwiftShader, the software Vulkan driver that chromium brings".into()),
    packages: Packages { apt: &["chromium"], dnf: &["chromium"], pacman: &["chromium"] },
};

/// The manifest of `SwiftShader`.
pub(crate) fn swiftshader() -> Option<PathBuf> {
    let folders = ["/usr/lib/chromium", "/usr/lib64/chromium-browser", "/usr/lib/chromium-browser"];
    folders.map(|folder| PathBuf::from(folder).join("vk_swiftshader_icd.json")).into_iter().find(|path| path.is_file())
}

/// The browser that opens the page of the charts.
pub(crate) const BROWSER: Need = Need {
    missing: || {
        let names = ["chromium", "chromium-browser", "google-chrome"];
        let there = names.iter().any(|name| programs::find(name).is_some());
        (!there).then(|| "chromium, for the tests of the page with the charts".into())
    },
    packages: Packages { apt: &["chromium"], dnf: &["chromium"], pacman: &["chromium"] },
};

/// A compiler for the parts of dependencies that are written in C++.
pub(crate) const COMPILER: Need = Need {
    missing: || programs::find("c++").is_none().then(|| "a C++ compiler".into()),
    packages: Packages { apt: &["g++"], dnf: &["gcc-c++"], pacman: &["gcc"] },
};

/// A linker for 64-bit ARM, with its library of C.
pub(crate) const ARM_LINKER: Need = Need {
    missing: || programs::find("aarch64-linux-gnu-gcc").is_none().then(|| "a linker for 64-bit ARM".into()),
    packages: Packages {
        apt: &["gcc-aarch64-linux-gnu", "libc6-dev-arm64-cross"],
        dnf: &["gcc-aarch64-linux-gnu"],
        pacman: &["aarch64-linux-gnu-gcc"],
    },
};

/// What runs programs for 64-bit ARM on other processors.
pub(crate) const ARM_EMULATOR: Need = Need {
    missing: || programs::find("qemu-aarch64-static").is_none().then(|| "QEMU, which runs programs for ARM".into()),
    packages: Packages {
        apt: &["qemu-user-static"],
        dnf: &["qemu-user-static-aarch64"],
        pacman: &["qemu-user-static"],
    },
};

/// A screen to open windows on.
pub(crate) const SCREEN: Need = Need {
    missing: || {
        let there = programs::find("Xvfb").is_some() || Display::x11_answers();
        (!there).then(|| "no screen for the tests of the window (the virtual one, Xvfb, will do)".into())
    },
    packages: Packages { apt: &["xvfb"], dnf: &["xorg-x11-server-Xvfb"], pacman: &["xorg-server-xvfb"] },
};

/// The program that lists the windows of an X display.
pub(crate) const WINDOW_LIST: Need = Need {
    missing: || programs::find("xwininfo").is_none().then(|| "xwininfo, which lists windows".into()),
    packages: Packages { apt: &["x11-utils"], dnf: &["xwininfo"], pacman: &["xorg-xwininfo"] },
};

/// The virtual screen, Xvfb.
pub(crate) const VIRTUAL_SCREEN: Need =
    Need { missing: || programs::find("Xvfb").is_none().then(|| "the virtual screen Xvfb".into()), ..SCREEN };

/// A window manager, for the tests of the window on the virtual screen.
pub(crate) const WINDOW_MANAGER: Need = Need {
    missing: || programs::find("openbox").is_none().then(|| "the window manager openbox".into()),
    packages: Packages { apt: &["openbox"], dnf: &["openbox"], pacman: &["openbox"] },
};

/// A Wayland display in a window of the virtual screen, for the tests of the window.
pub(crate) const COMPOSITOR: Need = Need {
    missing: || programs::find("weston").is_none().then(|| "the Wayland compositor weston".into()),
    packages: Packages { apt: &["weston"], dnf: &["weston"], pacman: &["weston"] },
};

/// What windows on an X display load when they open.
pub(crate) const X11_WINDOWS: Need = Need {
    missing: || {
        let needed = [
            "libX11.so.6",
            "libX11-xcb.so.1",
            "libxcb.so.1",
            "libXcursor.so.1",
            "libXi.so.6",
            "libxkbcommon.so.0",
            "libxkbcommon-x11.so.0",
        ];
        missing_libraries("windows", &needed)
    },
    packages: Packages {
        apt: &["libx11-6", "libx11-xcb1", "libxcb1", "libxcursor1", "libxi6", "libxkbcommon0", "libxkbcommon-x11-0"],
        dnf: &["libX11", "libX11-xcb", "libxcb", "libXcursor", "libXi", "libxkbcommon", "libxkbcommon-x11"],
        pacman: &["libx11", "libxcb", "libxcursor", "libxi", "libxkbcommon", "libxkbcommon-x11"],
    },
};

/// What windows on a Wayland display load when they open.
pub(crate) const WAYLAND_WINDOWS: Need = Need {
    missing: || missing_libraries("windows", &["libwayland-client.so.0", "libxkbcommon.so.0"]),
    packages: Packages {
        apt: &["libwayland-client0", "libxkbcommon0"],
        dnf: &["libwayland-client", "libxkbcommon"],
        pacman: &["wayland", "libxkbcommon"],
    },
};

fn missing_libraries(what_loads: &str, needed: &[&str]) -> Option<String> {
    let missing = Libraries::here().missing(needed);
    (!missing.is_empty()).then(|| format!("libraries for {what_loads}: {}", missing.join(", ")))
}

impl Setup {
    /// Sees that `needs` are met, and installs what is missing where it may. Systems other than Linux bring all of it.
    ///
    /// # Errors
    /// What is missing, why it was not installed, and the command that would install it.
    pub(crate) fn meet(self, needs: &[Need]) -> Result {
        if !cfg!(target_os = "linux") {
            return Ok(());
        }
        let (reasons, missing) = missing(needs);
        if reasons.is_empty() {
            return Ok(());
        }
        self.install(&reasons, &missing)?;
        let (reasons, _) = self::missing(needs);
        if reasons.is_empty() {
            return Ok(());
        }
        Err(Failure::new(format!("still missing after the installation:\n{}", listed(&reasons))))
    }

    fn install(self, reasons: &[String], missing: &[Packages]) -> Result {
        let manager = Manager::here();
        let names: Vec<&str> =
            missing.iter().flat_map(|&packages| manager.unwrap_or(Manager::Apt).names(packages)).copied().collect();
        let rights = match manager {
            _ if self.no_install => Err("--no-install was given"),
            Some(Manager::Apt) => match Rights::here() {
                Rights::Nothing => Err("it takes root, or sudo without a password"),
                rights => Ok(rights),
            },
            _ => Err("only apt-get is run from here"),
        };
        let rights = rights.map_err(|why_not| Failure::new(refusal(reasons, &names, manager, why_not, is_root())))?;
        eprintln!("missing:\n{}\nInstalling {} by apt-get.", listed(reasons), names.join(" "));
        let [mut update, mut install] = apt(rights, &names);
        // A list that is out of date, or a repository that does not answer, need not keep the packages from coming.
        if let Err(failure) = step("what packages there are", &mut update) {
            eprintln!("warning: {failure}");
        }
        step("installing", &mut install)
    }
}

/// Why needs are not met, and the packages that would meet them.
fn missing(needs: &[Need]) -> (Vec<String>, Vec<Packages>) {
    needs.iter().filter_map(|need| Some(((need.missing)()?, need.packages))).unzip()
}

fn listed(reasons: &[String]) -> String {
    reasons.iter().map(|reason| format!("  - {reason}")).collect::<Vec<_>>().join("\n")
}

/// The message where nothing is installed.
fn refusal(reasons: &[String], names: &[&str], manager: Option<Manager>, why_not: &str, is_root: bool) -> String {
    let remedy = match manager {
        Some(manager) => format!("Install it yourself, and try again:\n\n    {}", manager.remedy(names, is_root)),
        None => {
            format!("Install what your system calls these Debian packages, and try again:\n\n    {}", names.join(" "))
        }
    };
    format!("missing:\n{}\nNothing was installed: {why_not}. {remedy}", listed(reasons))
}

/// Asks the built command for what it can draw with, prints it, and sees that a driver is there, or what the
/// environment chooses; the CPU draws without.
///
/// # Errors
/// There is none: a driver that looked usable is not. Where set-up may install, the software driver is tried first.
pub(crate) fn adapters(setup: Setup) -> Result {
    if list_adapters()? {
        return Ok(());
    }
    if !cfg!(target_os = "linux") {
        return Err(Failure::new("no graphics adapter: install the driver of your graphics card"));
    }
    let reason = "an adapter: the drivers that are installed find nothing to draw with".to_owned();
    setup.install(&[reason], &[DRIVER.packages])?;
    if list_adapters()? {
        return Ok(());
    }
    Err(Failure::new("no graphics adapter, even with the software driver; VK_LOADER_DEBUG=all tells what it tries"))
}

/// Whether the command finds an adapter by a driver, or the one that is chosen; its list goes to the standard error
/// output.
fn list_adapters() -> Result<bool> {
    const NONE: i32 = 3;
    let mut command = cargo(["run", "--release", "--quiet", "--bin", "halfway", "--", "adapters"]);
    let output = command.output().map_err(|error| crate::cargo::not_started(&command, &error))?;
    match output.status.code() {
        Some(0) => {
            eprintln!("\nadapters:");
            let said = String::from_utf8_lossy(&output.stdout);
            said.lines().for_each(|line| eprintln!("   {line}"));
            Ok(is_chosen(variable) || said.lines().any(has_driver))
        }
        Some(NONE) => Ok(false),
        _ => {
            let said = String::from_utf8_lossy(&output.stderr);
            Err(Failure::new(format!("{} failed:\n{}", written(&command), said.trim_end())))
        }
    }
}

/// Whether a line of the list is of an adapter, and not of the CPU without a driver.
fn has_driver(line: &str) -> bool {
    !line.contains("(cpu,")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cpu_is_no_driver() {
        assert!(has_driver("llvmpipe (LLVM 15.0.6, 256 bits) (vulkan, software)"));
        assert!(!has_driver("avx2 (cpu, software)"));
    }

    #[test]
    fn what_the_environment_chooses_needs_no_vulkan() {
        let rows: [(&[(&str, &str)], bool); 9] = [
            (&[], false),
            (&[("HALFWAY_ADAPTER", "cpu")], true),
            (&[("HALFWAY_ADAPTER", "cpu:avx2")], true),
            (&[("HALFWAY_ADAPTER", "gl:llvmpipe")], true),
            (&[("HALFWAY_ADAPTER", "llvmpipe")], false),
            (&[("HALFWAY_ADAPTER", "vulkan:llvmpipe"), ("WGPU_BACKEND", "gl")], false),
            (&[("WGPU_BACKEND", "gl")], true),
            (&[("WGPU_BACKEND", "gl,vulkan")], false),
            (&[("WGPU_BACKEND", "vk")], false),
        ];
        for (variables, chosen) in rows {
            let of = |name: &str| variables.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).to_owned());
            assert_eq!(is_chosen(of), chosen, "{variables:?}");
        }
    }

    const MET: Need = Need { missing: || None, ..DRIVER };
    const UNMET: Need = Need { missing: || Some("a thing".into()), ..SCREEN };

    #[test]
    fn what_is_there_needs_no_installation() {
        assert_eq!(Setup { no_install: true }.meet(&[MET, MET]), Ok(()));
        assert_eq!(Setup::default().meet(&[]), Ok(()));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn what_is_missing_is_not_installed_unasked() {
        let message = Setup { no_install: true }.meet(&[MET, UNMET]).unwrap_err().to_string();
        assert!(message.contains("  - a thing\n"), "{message}");
        assert!(message.contains("--no-install was given"), "{message}");
    }

    #[test]
    fn refusals_have_a_remedy() {
        let reasons = ["a driver".to_owned(), "a screen".to_owned()];
        let rows = [
            (
                Some(Manager::Apt),
                false,
                "\n    sudo apt-get update && sudo apt-get install -y --no-install-recommends x y",
            ),
            (Some(Manager::Apt), true, "\n    apt-get update && apt-get install -y --no-install-recommends x y"),
            (Some(Manager::Dnf), false, "\n    sudo dnf install -y x y"),
            (None, false, "Debian packages, and try again:\n\n    x y"),
        ];
        for (manager, is_root, remedy) in rows {
            let message = refusal(&reasons, &["x", "y"], manager, "because", is_root);
            assert!(message.starts_with("missing:\n  - a driver\n  - a screen\n"), "{message}");
            assert!(message.contains("Nothing was installed: because."), "{message}");
            assert!(message.ends_with(remedy), "{message}");
        }
    }
}

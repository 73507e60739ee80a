//! The package manager, and what it calls the things that may be missing.

use std::process::Command;

use super::programs;

/// A package manager and how to install with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Manager {
    /// Debian, Ubuntu and their like; the only one that is run from here.
    Apt,
    /// Fedora and its like.
    Dnf,
    /// Arch and its like.
    Pacman,
}

/// Packages by manager.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Packages {
    pub(crate) apt: &'static [&'static str],
    pub(crate) dnf: &'static [&'static str],
    pub(crate) pacman: &'static [&'static str],
}

impl Manager {
    /// The machine's.
    pub(crate) fn here() -> Option<Self> {
        let managers = [(Self::Apt, "apt-get"), (Self::Dnf, "dnf"), (Self::Pacman, "pacman")];
        managers.into_iter().find(|(_, program)| programs::find(program).is_some()).map(|(manager, _)| manager)
    }

    pub(crate) fn names(self, packages: Packages) -> &'static [&'static str] {
        match self {
            Self::Apt => packages.apt,
            Self::Dnf => packages.dnf,
            Self::Pacman => packages.pacman,
        }
    }

    /// The command that installs packages, without what it takes to be allowed to.
    fn install(self) -> &'static [&'static str] {
        match self {
            Self::Apt => &["apt-get", "install", "-y", "--no-install-recommends"],
            Self::Dnf => &["dnf", "install", "-y"],
            Self::Pacman => &["pacman", "-S", "--needed", "--noconfirm"],
        }
    }

    /// The command for people to copy.
    pub(crate) fn remedy(self, packages: &[&str], is_root: bool) -> String {
        let sudo = if is_root { "" } else { "sudo " };
        // Only apt-get has to be told apart to learn what packages there are.
        let update = if self == Self::Apt { format!("{sudo}apt-get update && ") } else { String::new() };
        format!("{update}{sudo}{} {}", self.install().join(" "), packages.join(" "))
    }
}

/// What this process may do to the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rights {
    Root,
    /// `sudo` asks for no password.
    Sudo,
    Nothing,
}

impl Rights {
    pub(crate) fn here() -> Self {
        if is_root() {
            return Self::Root;
        }
        // -n: fail rather than ask for a password.
        let asked = Command::new("sudo").args(["-n", "true"]).output();
        if asked.is_ok_and(|output| output.status.success()) { Self::Sudo } else { Self::Nothing }
    }
}

pub(crate) fn is_root() -> bool {
    std::fs::read_to_string("/proc/self/status").is_ok_and(|status| effective_user(&status) == Some(0))
}

/// The second number of the line `Uid:` is the user whose rights count.
fn effective_user(status: &str) -> Option<u32> {
    status.lines().find_map(|line| line.strip_prefix("Uid:"))?.split_whitespace().nth(1)?.parse().ok()
}

/// The commands that install packages by apt-get: one that learns what there is, one that installs.
///
/// `env` sets the variable on either side of `sudo`, which hands none on; it keeps packages from asking questions.
pub(crate) fn apt(rights: Rights, packages: &[&str]) -> [Command; 2] {
    let install = [Manager::Apt.install(), packages].concat();
    [vec!["apt-get", "update"], install].map(|words| {
        let mut all = if rights == Rights::Sudo { vec!["sudo", "-n"] } else { Vec::new() };
        all.extend(["env", "DEBIAN_FRONTEND=noninteractive"]);
        all.extend(words);
        let mut command = Command::new(all[0]);
        command.args(&all[1..]);
        command
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cargo::written;

    #[test]
    fn the_effective_user_counts() {
        let rows = [
            ("Name:\tx\nUid:\t1000\t0\t0\t0\n", Some(0)),
            ("Uid:\t0\t1000\t0\t0\n", Some(1000)),
            ("Uid:\n", None),
            ("", None),
        ];
        for (status, expected) in rows {
            assert_eq!(effective_user(status), expected, "{status:?}");
        }
    }

    #[test]
    fn apt_is_run_with_the_rights_there_are() {
        let [update, install] = apt(Rights::Root, &["a", "b"]);
        assert_eq!(written(&update), "env 'DEBIAN_FRONTEND=noninteractive' apt-get update");
        assert_eq!(
            written(&install),
            "env 'DEBIAN_FRONTEND=noninteractive' apt-get install -y --no-install-recommends a b"
        );
        let [update, _] = apt(Rights::Sudo, &["a"]);
        assert_eq!(written(&update), "sudo -n env 'DEBIAN_FRONTEND=noninteractive' apt-get update");
    }

    #[test]
    fn remedies_can_be_copied() {
        let rows = [
            (Manager::Apt, false, "sudo apt-get update && sudo apt-get install -y --no-install-recommends a b"),
            (Manager::Apt, true, "apt-get update && apt-get install -y --no-install-recommends a b"),
            (Manager::Dnf, false, "sudo dnf install -y a b"),
            (Manager::Pacman, false, "sudo pacman -S --needed --noconfirm a b"),
        ];
        for (manager, is_root, expected) in rows {
            assert_eq!(manager.remedy(&["a", "b"], is_root), expected);
        }
    }
}

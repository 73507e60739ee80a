//! The display on which a window can be opened.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The kind of a display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Display {
    Wayland,
    X11,
    /// The system's own: macOS and Windows always have one.
    System,
}

impl Display {
    /// The display on which a window would open, if one is named and answers. Of both kinds, the Wayland display has
    /// priority, as for windows.
    pub(crate) fn here() -> Option<Self> {
        if cfg!(any(windows, target_os = "macos")) {
            return Some(Self::System);
        }
        find(|name| std::env::var_os(name).filter(|value| !value.is_empty()), answers)
    }
}

/// The address of a display.
#[derive(Debug, PartialEq, Eq)]
enum Address {
    /// A socket of the machine.
    Local(PathBuf),
    /// Host and port.
    Network(String, u16),
}

fn find(variable: impl Fn(&str) -> Option<OsString>, answers: impl Fn(&Address) -> bool) -> Option<Display> {
    let wayland =
        variable("WAYLAND_DISPLAY").and_then(|name| wayland_address(Path::new(&name), variable("XDG_RUNTIME_DIR")));
    if wayland.is_some_and(|address| answers(&address)) {
        return Some(Display::Wayland);
    }
    let x11 = variable("DISPLAY").and_then(|name| x11_address(&name.to_string_lossy()));
    x11.is_some_and(|address| answers(&address)).then_some(Display::X11)
}

/// A path, or a name in the folder of the session.
fn wayland_address(name: &Path, session: Option<OsString>) -> Option<Address> {
    if name.is_absolute() {
        return Some(Address::Local(name.to_owned()));
    }
    session.map(|session| Address::Local(Path::new(&session).join(name)))
}

/// `[HOST]:NUMBER[.SCREEN]`. Without a host, or with the host `unix`, it is a socket of the machine.
fn x11_address(name: &str) -> Option<Address> {
    let (host, number) = name.rsplit_once(':')?;
    let number: u16 = number.split('.').next()?.parse().ok()?;
    if host.is_empty() || host == "unix" {
        return Some(Address::Local(format!("/tmp/.X11-unix/X{number}").into()));
    }
    let host = host.rsplit('/').next().unwrap_or(host).trim_matches(['[', ']']);
    Some(Address::Network(host.to_owned(), number.checked_add(6000)?))
}

#[cfg(unix)]
fn answers(address: &Address) -> bool {
    use std::net::{TcpStream, ToSocketAddrs};
    use std::os::unix::net::UnixStream;
    use std::time::Duration;

    match address {
        Address::Local(path) => UnixStream::connect(path).is_ok(),
        Address::Network(host, port) => {
            let mut addresses = (host.as_str(), *port).to_socket_addrs().into_iter().flatten();
            addresses.any(|address| TcpStream::connect_timeout(&address, Duration::from_secs(3)).is_ok())
        }
    }
}

#[cfg(not(unix))]
fn answers(_: &Address) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    fn local(path: &str) -> Address {
        Address::Local(path.into())
    }

    fn network(host: &str, port: u16) -> Address {
        Address::Network(host.into(), port)
    }

    #[test]
    fn names_of_x_displays() {
        let rows = [
            (":0", Some(local("/tmp/.X11-unix/X0"))),
            (":99.0", Some(local("/tmp/.X11-unix/X99"))),
            ("unix:1", Some(local("/tmp/.X11-unix/X1"))),
            ("localhost:10.0", Some(network("localhost", 6010))),
            ("tcp/example.org:2", Some(network("example.org", 6002))),
            ("[::1]:3", Some(network("::1", 6003))),
            ("0", None),
            (":", None),
            (":x", None),
            ("host:65535", None),
        ];
        for (name, expected) in rows {
            assert_eq!(x11_address(name), expected, "{name}");
        }
    }

    /// Variables, sockets that answer, and the display.
    type Row<'a> = (&'a [(&'a str, &'a str)], &'a [&'a str], Option<Display>);

    #[test]
    fn the_display_is_one_that_answers() {
        let wayland = ("WAYLAND_DISPLAY", "wayland-0");
        let session = ("XDG_RUNTIME_DIR", "/run/user/1");
        let x11 = ("DISPLAY", ":0");
        let (wayland_socket, x11_socket) = ("/run/user/1/wayland-0", "/tmp/.X11-unix/X0");
        let rows: [Row; 7] = [
            (&[], &[wayland_socket, x11_socket], None),
            (&[x11], &[x11_socket], Some(Display::X11)),
            (&[x11], &[], None),
            (&[wayland, session], &[wayland_socket], Some(Display::Wayland)),
            (&[wayland, session, x11], &[wayland_socket, x11_socket], Some(Display::Wayland)),
            (&[wayland, session, x11], &[x11_socket], Some(Display::X11)),
            (&[wayland], &[wayland_socket], None),
        ];
        for (variables, listening, expected) in rows {
            let variable = |wanted: &str| {
                variables.iter().find(|(name, _)| *name == wanted).map(|(_, value)| OsString::from(value))
            };
            let answers = |address: &Address| listening.iter().any(|path| *address == local(path));
            assert_eq!(find(variable, answers), expected, "{variables:?} {listening:?}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn sockets_answer_while_somebody_listens() {
        let scratch = tempfile::tempdir().unwrap();
        let path = scratch.path().join("wayland-7");
        let listener = std::os::unix::net::UnixListener::bind(&path).unwrap();
        assert!(answers(&Address::Local(path.clone())));
        drop(listener);
        assert!(!answers(&Address::Local(path)), "the file is still there, but nobody listens");
    }
}

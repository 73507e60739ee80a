//! Detects a display.

/// Whether the environment names a display to open a window on. True where displays have no names
/// (macOS, Windows); whether the named one answers shows only when a window is opened.
pub fn has_display() -> bool {
    names_display(|variable| std::env::var_os(variable).is_some_and(|value| !value.is_empty()))
}

fn names_display(is_set: impl Fn(&str) -> bool) -> bool {
    let named = cfg!(all(unix, not(any(target_vendor = "apple", target_os = "android"))));
    !named || ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"].into_iter().any(is_set)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn displays_are_named_by_the_environment() {
        if !cfg!(target_os = "linux") {
            return;
        }
        let rows = [
            (&[][..], false),
            (&["DISPLAY"], true),
            (&["WAYLAND_DISPLAY"], true),
            (&["WAYLAND_SOCKET"], true),
            (&["HOME"], false),
        ];
        for (set, expected) in rows {
            assert_eq!(names_display(|variable| set.contains(&variable)), expected, "{set:?}");
        }
    }
}

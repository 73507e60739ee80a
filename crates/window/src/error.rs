//! Errors of opening a window.

use bevy_app::AppExit;
use halfway_render::RenderError;
use thiserror::Error;

/// Why a window could not be opened, or kept.
#[derive(Debug, Error, PartialEq)]
pub(crate) enum WindowError {
    #[error(
        "no display: set DISPLAY or WAYLAND_DISPLAY to one, or draw headless (`halfway render SCENE -o PICTURE.png`; \
         in code, an App without `WindowPlugin`)"
    )]
    NoDisplay,
    #[error(
        "the display cannot be used: {0}. Check DISPLAY or WAYLAND_DISPLAY, or draw headless \
         (`halfway render SCENE -o PICTURE.png`; in code, an App without `WindowPlugin`)"
    )]
    Display(String),
    #[error("the display refused a window of {width} × {height}: {reason}")]
    Window { width: u32, height: u32, reason: String },
    #[error("nothing can be drawn in the window: {0}")]
    Surface(String),
    #[error("nothing can be drawn in the window: {0}")]
    Gpu(#[from] RenderError),
    #[error("the window's surface or the graphics device was lost {0} times in a row; the driver may be broken")]
    LostAgain(u32),
}

impl WindowError {
    /// The exit code: 3 without an adapter or a display, else 1.
    pub(crate) fn exit(&self) -> AppExit {
        use RenderError as E;
        let missing = matches!(
            self,
            Self::NoDisplay
                | Self::Display(_)
                | Self::Gpu(
                    E::NoAdapter
                        | E::NoAdapterAmong { .. }
                        | E::NoSuchAdapter { .. }
                        | E::NoDevice { .. }
                        | E::NoVectors { .. }
                )
        );
        AppExit::from_code(if missing { 3 } else { 1 })
    }
}

/// The display's message, without the line of winit's source that winit appends.
pub(crate) fn reason(error: &impl ToString) -> String {
    let text = error.to_string();
    match text.strip_prefix("os error at ").and_then(|rest| rest.split_once(": ")) {
        Some((_, reason)) => reason.to_owned(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_leave_out_source_files() {
        let rows = [
            ("os error at /src/x11/mod.rs:75: cannot connect: refused", "cannot connect: refused"),
            ("EventLoop can't be recreated", "EventLoop can't be recreated"),
        ];
        for (text, expected) in rows {
            assert_eq!(reason(&text), expected);
        }
    }
}

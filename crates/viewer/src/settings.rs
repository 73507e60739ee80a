//! The viewer's own settings, which the next window begins with.

use std::path::PathBuf;

use serde_json::{Value, json};

/// How the viewer itself looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Settings {
    /// Whether the panels are shown.
    pub(crate) panels: bool,
    /// Whether lights are shown where they are.
    pub(crate) handles: bool,
    /// The size of the panels' text, 1 as the system has it.
    pub(crate) zoom: f32,
    /// Whether changes are written. This is no setting itself.
    pub(crate) remembers: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { panels: true, handles: true, zoom: 1.0, remembers: true }
    }
}

impl Settings {
    /// Reads them from where they were written; the default ones where they cannot be read.
    pub(crate) fn read() -> Self {
        let text = file().and_then(|file| std::fs::read_to_string(file).ok());
        text.map_or_else(Self::default, |text| Self::from_json(&text))
    }

    fn from_json(text: &str) -> Self {
        let default = Self::default();
        let Ok(json) = serde_json::from_str::<Value>(text) else { return default };
        let flag = |key: &str, otherwise| json[key].as_bool().unwrap_or(otherwise);
        let zoom = json["zoom"].as_f64().map_or(default.zoom, |zoom| (zoom as f32).clamp(0.5, 4.0));
        let (panels, handles) = (flag("panels", default.panels), flag("handles", default.handles));
        Self { panels, handles, zoom, ..default }
    }

    fn to_json(self) -> String {
        format!("{:#}\n", json!({ "panels": self.panels, "handles": self.handles, "zoom": self.zoom }))
    }

    /// Writes them, if that is possible; a viewer that cannot remember works all the same.
    pub(crate) fn write(self) {
        let Some(file) = file() else { return };
        let written = file.parent().map_or(Ok(()), std::fs::create_dir_all);
        if let Err(error) = written.and_then(|()| std::fs::write(&file, self.to_json())) {
            log::warn!("{}: the viewer's settings are not remembered: {error}", file.display());
        }
    }
}

/// Where programs of this system keep such files.
fn file() -> Option<PathBuf> {
    let folder = |variable: &str| std::env::var_os(variable).filter(|value| !value.is_empty()).map(PathBuf::from);
    let base = if cfg!(windows) {
        folder("APPDATA")
    } else {
        folder("XDG_CONFIG_HOME").or_else(|| folder("HOME").map(|home| home.join(".config")))
    };
    base.map(|base| base.join("halfway").join("view.json"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_read_as_they_were_written() {
        let settings = Settings { panels: false, handles: false, zoom: 1.5, ..Settings::default() };
        assert_eq!(Settings::from_json(&settings.to_json()), settings);
        for text in ["", "[]", "{\"panels\": 3}", "{\"zoom\": \"large\"}"] {
            assert_eq!(Settings::from_json(text), Settings::default(), "{text}");
        }
        assert!(Settings::from_json("{\"zoom\": 1e9}").zoom < 4.5);
    }
}

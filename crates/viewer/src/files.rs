//! A small dialog for files: opening one, or naming the one to write.

use std::path::{Path, PathBuf};

use egui::{Context, Key, ScrollArea, TextEdit, Ui};

/// The use of the chosen file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    Open,
    SaveScene,
    SavePicture,
    SaveTurntable,
}

impl Purpose {
    fn title(self) -> &'static str {
        match self {
            Self::Open => "Open a scene or a model",
            Self::SaveScene => "Save the scene",
            Self::SavePicture => "Save a picture",
            Self::SaveTurntable => "Save a turn as an animated PNG",
        }
    }

    fn verb(self) -> &'static str {
        if self == Self::Open { "Open" } else { "Save" }
    }
}

/// The endings of the files that can be opened.
const ENDINGS: [&str; 9] = ["json", "smf", "obj", "gltf", "glb", "ply", "stl", "off", "3mf"];

/// The dialog.
pub(crate) struct FileDialog {
    pub(crate) purpose: Purpose,
    text: String,
    /// The folder that is listed, and its entries: folders first.
    listed: Option<(PathBuf, Vec<(String, bool)>)>,
    is_new: bool,
}

/// How the dialog ended.
pub(crate) enum Ended {
    Chosen(PathBuf),
    Closed,
}

impl FileDialog {
    pub(crate) fn new(purpose: Purpose, file: &Path) -> Self {
        Self { purpose, text: file.display().to_string(), listed: None, is_new: true }
    }

    /// Shows it; `None` while it goes on.
    pub(crate) fn show(&mut self, ctx: &Context) -> Option<Ended> {
        let mut ended = ctx.input(|input| input.key_pressed(Key::Escape)).then_some(Ended::Closed);
        let mut is_open = true;
        egui::Window::new(self.purpose.title())
            .id(egui::Id::unique("files"))
            .open(&mut is_open)
            .collapsible(false)
            .default_width(440.0)
            .pivot(egui::Align2::CENTER_CENTER)
            .default_pos(ctx.content_rect().center())
            .show(ctx, |ui| {
                if let Some(end) = self.contents(ui) {
                    ended = Some(end);
                }
            });
        if is_open { ended } else { Some(Ended::Closed) }
    }

    fn contents(&mut self, ui: &mut Ui) -> Option<Ended> {
        let field = ui.add(TextEdit::singleline(&mut self.text).desired_width(f32::INFINITY));
        if std::mem::take(&mut self.is_new) {
            field.request_focus();
        }
        let mut is_chosen = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let path = PathBuf::from(&self.text);
        let folder = if path.is_dir() { path } else { path.parent().unwrap_or(Path::new("")).to_owned() };
        self.list(&folder);
        let mut next = None;
        ScrollArea::vertical().max_height(260.0).auto_shrink(false).show(ui, |ui| {
            if ui.selectable_label(false, "..").clicked() {
                next = Some((parent_of(&folder), true));
            }
            for (name, is_folder) in self.listed.as_ref().map_or(&[][..], |(_, entries)| entries) {
                let text = if *is_folder { format!("{name}/") } else { name.clone() };
                let response = ui.selectable_label(false, text);
                if response.clicked() {
                    next = Some((folder.join(name), *is_folder));
                }
                is_chosen |= response.double_clicked() && !is_folder;
            }
        });
        if let Some((path, is_folder)) = next {
            self.text = if is_folder { format!("{}/", path.display()) } else { path.display().to_string() };
        }
        ui.horizontal(|ui| {
            is_chosen |= ui.button(self.purpose.verb()).clicked();
            if ui.button("Cancel").clicked() { Some(Ended::Closed) } else { None }
        })
        .inner
        .or_else(|| {
            let path = PathBuf::from(&self.text);
            (is_chosen && !path.is_dir()).then_some(Ended::Chosen(path))
        })
    }

    fn list(&mut self, folder: &Path) {
        if self.listed.as_ref().is_some_and(|(listed, _)| listed == folder) {
            return;
        }
        let shown = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let mut entries: Vec<(String, bool)> = std::fs::read_dir(shown)
            .into_iter()
            .flatten()
            .flatten()
            .map(|entry| (entry.file_name().to_string_lossy().into_owned(), entry.path().is_dir()))
            .filter(|(name, is_folder)| !name.starts_with('.') && (*is_folder || can_be_opened(Path::new(name))))
            .collect();
        entries.sort_by_key(|(name, is_folder)| (!is_folder, name.to_lowercase()));
        self.listed = Some((folder.to_owned(), entries));
    }
}

fn can_be_opened(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ENDINGS.iter().any(|known| ending.eq_ignore_ascii_case(known)))
}

fn parent_of(folder: &Path) -> PathBuf {
    let absolute = std::path::absolute(folder).or_else(|_| std::env::current_dir()).unwrap_or_default();
    absolute.parent().unwrap_or(&absolute).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_can_be_opened_is_listed() {
        let rows = [("a.obj", true), ("b.GLB", true), ("scene.json", true), ("c.txt", false), ("obj", false)];
        for (name, expected) in rows {
            assert_eq!(can_be_opened(Path::new(name)), expected, "{name}");
        }
        assert!(parent_of(Path::new("")).is_absolute());
    }
}

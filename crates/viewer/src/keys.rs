//! The viewer's keys, and the list of them that H shows.

use egui::{Context, Key, KeyboardShortcut, Modifiers, Ui};

/// A command, by a key or a button.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Command {
    Shading(usize),
    Reflectance,
    Intensity,
    Tolerance,
    View(usize),
    Orthographic,
    Panels,
    Handles,
    Edges,
    Wireframe,
    Normals,
    Split,
    Help,
    AddLight,
    Remove,
    Undo,
    Redo,
    Save,
    Open,
    Picture,
    Turntable,
    Explain,
    Leave,
    Close,
}

const PLAIN: Modifiers = Modifiers::NONE;
const CONTROL: Modifiers = Modifiers::COMMAND;
const CONTROL_SHIFT: Modifiers = Modifiers { shift: true, ..Modifiers::COMMAND };

/// All keys: the modifiers, the key, the command, and what it does where the list says so.
const KEYS: &[(Modifiers, Key, Command, &str)] = &[
    (PLAIN, Key::Num1, Command::Shading(0), "flat shading"),
    (PLAIN, Key::Num2, Command::Shading(1), "Gouraud shading"),
    (PLAIN, Key::Num3, Command::Shading(2), "Phong shading"),
    (PLAIN, Key::Num4, Command::Shading(3), "unlit"),
    (PLAIN, Key::B, Command::Reflectance, "Phong or Blinn–Phong reflectance"),
    (PLAIN, Key::I, Command::Intensity, "next treatment of intensities above 1"),
    (PLAIN, Key::T, Command::Tolerance, "next tolerance"),
    (PLAIN, Key::D, Command::Split, "divide the window between two ways of drawing"),
    (PLAIN, Key::F, Command::View(0), "from the front"),
    (PLAIN, Key::K, Command::View(1), "from the back"),
    (PLAIN, Key::L, Command::View(2), "from the left"),
    (PLAIN, Key::Period, Command::View(3), "from the right"),
    (PLAIN, Key::U, Command::View(4), "from above"),
    (PLAIN, Key::J, Command::View(5), "from below"),
    (PLAIN, Key::V, Command::View(6), "isometric view"),
    (PLAIN, Key::O, Command::Orthographic, "orthographic or perspective"),
    (PLAIN, Key::P, Command::Panels, "show or hide the panels"),
    (PLAIN, Key::G, Command::Handles, "show or hide the lights' handles"),
    (PLAIN, Key::E, Command::Edges, "lines along sharp edges and outlines"),
    (PLAIN, Key::W, Command::Wireframe, "a wireframe in place of surfaces"),
    (PLAIN, Key::N, Command::Normals, "the normals of vertices"),
    (PLAIN, Key::A, Command::AddLight, "add a light where the camera is"),
    (PLAIN, Key::Delete, Command::Remove, "remove the light that is selected"),
    (PLAIN, Key::X, Command::Explain, "explain the pixel under the pointer"),
    (CONTROL, Key::Z, Command::Undo, "undo"),
    (CONTROL_SHIFT, Key::Z, Command::Redo, "redo"),
    (CONTROL, Key::Y, Command::Redo, "redo"),
    (CONTROL, Key::O, Command::Open, "open a scene or a model"),
    (CONTROL, Key::S, Command::Save, "save the scene"),
    (CONTROL, Key::P, Command::Picture, "save a picture"),
    (PLAIN, Key::H, Command::Help, "this list"),
    (PLAIN, Key::Escape, Command::Leave, "close what is open, at last the window"),
    (PLAIN, Key::Q, Command::Close, "close the window"),
];

/// The mouse, and the keys that the orbit camera reads.
const ORBIT: &[(&str, &str)] = &[
    ("left drag, arrows", "turn"),
    ("right drag, Shift + left drag", "move sideways"),
    ("wheel, + and −", "nearer or farther"),
    ("Home, R", "back to the first view"),
];

/// The commands of this frame, unless text is being written.
pub(crate) fn commands(ctx: &Context) -> Vec<Command> {
    if ctx.text_edit_focused() {
        return Vec::new();
    }
    let mut commands = Vec::new();
    ctx.input_mut(|input| {
        // Keys with more modifiers come first, since egui lets a shortcut ignore Shift.
        for with_modifiers in [true, false] {
            for &(modifiers, key, command, _) in KEYS {
                if (modifiers != PLAIN) != with_modifiers || key == Key::Z && modifiers == CONTROL {
                    continue;
                }
                if input.consume_shortcut(&KeyboardShortcut::new(modifiers, key)) {
                    commands.push(command);
                }
            }
            if with_modifiers && input.consume_shortcut(&KeyboardShortcut::new(CONTROL, Key::Z)) {
                commands.push(Command::Undo);
            }
        }
    });
    commands
}

/// The list of all keys.
pub(crate) fn show(ui: &mut Ui) {
    egui::Grid::new("keys").num_columns(2).spacing([18.0, 4.0]).show(ui, |ui| {
        for (input, effect) in ORBIT {
            ui.label(*input);
            ui.label(*effect);
            ui.end_row();
        }
        for &(modifiers, key, _, effect) in KEYS {
            ui.label(ui.ctx().format_shortcut(&KeyboardShortcut::new(modifiers, key)));
            ui.label(effect);
            ui.end_row();
        }
    });
}

//! Fields of the panels, each a line: a name and a value that can be changed. Each returns whether it was.

use std::ops::RangeInclusive;

use egui::{ComboBox, DragValue, Slider, SliderClamping, Ui};
use halfway::lighting::Choices;
use halfway::prelude::*;

/// A colour in linear light: its hue as a button, and how bright it is as a number.
pub(crate) fn color(ui: &mut Ui, name: &str, hint: &str, color: &mut LinearRgba) -> bool {
    let mut channels = [color.red, color.green, color.blue];
    let changed = channels_field(ui, name, hint, &mut channels);
    if changed {
        *color = LinearRgba::rgb(channels[0], channels[1], channels[2]);
    }
    changed
}

/// The same for three numbers.
pub(crate) fn channels_field(ui: &mut Ui, name: &str, hint: &str, channels: &mut [f32; 3]) -> bool {
    line(ui, name, hint, |ui| {
        let strongest = channels.iter().copied().fold(0.0, f32::max);
        // The button shows what is at most 1; the number says how much more it is.
        let mut strength = strongest.max(1.0);
        let mut shown = channels.map(|channel| channel / strength);
        let mut changed = ui.color_edit_button_rgb(&mut shown).changed();
        // Black stays black however much of it there is.
        let number = DragValue::new(&mut strength).range(1.0..=1e6).speed(0.02).prefix("× ");
        changed |= ui.add_enabled(strongest > 0.0, number).on_hover_text("Brighter than 1").changed();
        if changed {
            *channels = shown.map(|channel| channel.max(0.0) * strength);
        }
        changed
    })
}

pub(crate) fn slider(ui: &mut Ui, name: &str, hint: &str, value: &mut f32, range: RangeInclusive<f32>) -> bool {
    line(ui, name, hint, |ui| ui.add(Slider::new(value, range).clamping(SliderClamping::Edits)).changed())
}

/// A slider whose middle is nearer to its lower end.
pub(crate) fn wide_slider(ui: &mut Ui, name: &str, hint: &str, value: &mut f32, range: RangeInclusive<f32>) -> bool {
    let slider = Slider::new(value, range).logarithmic(true).max_decimals(4).clamping(SliderClamping::Edits);
    line(ui, name, hint, |ui| ui.add(slider).changed())
}

/// Three numbers that are dragged.
pub(crate) fn vector<N: egui::emath::Numeric>(
    ui: &mut Ui,
    name: &str,
    hint: &str,
    values: &mut [N],
    speed: f64,
) -> bool {
    line(ui, name, hint, |ui| {
        let mut changed = false;
        for value in values {
            changed |= ui.add(DragValue::new(value).speed(speed).max_decimals(3)).changed();
        }
        changed
    })
}

pub(crate) fn check(ui: &mut Ui, name: &str, hint: &str, value: &mut bool) -> bool {
    ui.checkbox(value, name).on_hover_text(hint).changed()
}

/// One of the values that have names.
pub(crate) fn choice<T: Choices>(ui: &mut Ui, name: &str, hint: &str, value: &mut T) -> bool {
    line(ui, name, hint, |ui| {
        let mut changed = false;
        let shown = value.choice().map_or("other", |choice| choice.name);
        ComboBox::from_id_salt(name).selected_text(shown).show_ui(ui, |ui| {
            for choice in T::CHOICES {
                changed |=
                    ui.selectable_value(value, choice.value, choice.name).on_hover_text(choice.meaning).changed();
            }
        });
        changed
    })
}

/// One of the values that have names, or none, which has a name too.
pub(crate) fn own_choice<T: Choices>(ui: &mut Ui, name: &str, hint: &str, value: &mut Option<T>, none: &str) -> bool {
    line(ui, name, hint, |ui| {
        let mut changed = false;
        let shown = match value {
            None => none,
            Some(value) => value.choice().map_or("other", |choice| choice.name),
        };
        ComboBox::from_id_salt(name).selected_text(shown).show_ui(ui, |ui| {
            changed |= ui.selectable_value(value, None, none).changed();
            for choice in T::CHOICES {
                let response = ui.selectable_value(value, Some(choice.value), choice.name);
                changed |= response.on_hover_text(choice.meaning).changed();
            }
        });
        changed
    })
}

/// One of a few values.
pub(crate) fn one_of<T: PartialEq + Copy>(
    ui: &mut Ui,
    name: &str,
    hint: &str,
    value: &mut T,
    all: &[(T, &str)],
) -> bool {
    line(ui, name, hint, |ui| {
        let mut changed = false;
        let shown = all.iter().find(|(known, _)| known == value).map_or("other", |(_, name)| name);
        ComboBox::from_id_salt(name).selected_text(shown).show_ui(ui, |ui| {
            for (known, name) in all {
                changed |= ui.selectable_value(value, *known, *name).changed();
            }
        });
        changed
    })
}

/// The name of a value, in a column of one width.
pub(crate) fn name_of(ui: &mut Ui, name: &str) -> egui::Response {
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let column = egui::vec2(84.0, 18.0);
    let label = ui.allocate_ui_with_layout(column, layout, |ui| {
        ui.set_min_size(column);
        ui.add(egui::Label::new(name).truncate())
    });
    label.inner
}

fn line(ui: &mut Ui, name: &str, hint: &str, field: impl FnOnce(&mut Ui) -> bool) -> bool {
    ui.horizontal(|ui| {
        let label = name_of(ui, name);
        if !hint.is_empty() {
            label.on_hover_text(hint);
        }
        field(ui)
    })
    .inner
}

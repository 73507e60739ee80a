//! The values of a material.

use egui::{ComboBox, Ui};
use halfway::prelude::*;
use halfway::scene::MaterialEntry;

use super::fields::{color, name_of, slider, wide_slider};

pub(crate) fn show(ui: &mut Ui, entry: &mut MaterialEntry) -> bool {
    let mut changed = false;
    let shown = match entry {
        MaterialEntry::Preset(name) => name.clone(),
        MaterialEntry::Values(_) => "own values".into(),
    };
    ui.horizontal(|ui| {
        name_of(ui, "preset");
        ComboBox::from_id_salt("preset").selected_text(shown).show_ui(ui, |ui| {
            for (name, _) in Material::PRESETS {
                let is_shown = *entry == MaterialEntry::Preset((*name).to_owned());
                if ui.selectable_label(is_shown, *name).clicked() {
                    *entry = MaterialEntry::Preset((*name).to_owned());
                    changed = true;
                }
            }
        });
    });
    let Some(mut material) = entry.material() else { return changed };
    if values(ui, &mut material) {
        *entry = MaterialEntry::Values(material);
        changed = true;
    }
    changed
}

fn values(ui: &mut Ui, material: &mut Material) -> bool {
    let mut changed = color(ui, "ambient ka", "What it returns of ambient light", &mut material.ambient);
    changed |= color(ui, "diffuse kd", "What it returns in all directions", &mut material.diffuse);
    changed |= color(ui, "specular ks", "What it returns in highlights", &mut material.specular);
    changed |= color(ui, "emission ke", "What it shines by itself", &mut material.emission);
    changed |= wide_slider(ui, "shininess", "The exponent of the highlight", &mut material.shininess, 0.0..=1000.0);
    changed | slider(ui, "opacity", "Where the object is blended or masked", &mut material.opacity, 0.0..=1.0)
}

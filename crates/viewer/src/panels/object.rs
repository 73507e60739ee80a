//! The values of an object.

use egui::Ui;
use halfway::scene::{MaterialEntry, ObjectEntry, TransformEntry};

use super::fields::{check, own_choice, vector};
use super::material;

pub(crate) fn show(ui: &mut Ui, object: &mut ObjectEntry) -> bool {
    let mut changed = false;
    if let TransformEntry::Parts(parts) = &mut object.transform {
        changed |= vector(ui, "position", "Where its origin is", &mut parts.translation, 0.02);
        let before = parts.scale;
        if vector(ui, "scale", "Stretched along x, y and z", &mut parts.scale, 0.01) {
            parts.scale = if parts.scale.contains(&0.0) { before } else { parts.scale };
            changed = true;
        }
    } else {
        ui.label("It is placed by a matrix.");
    }
    changed |= own_choice(ui, "shading", "How often this object is shaded", &mut object.shading, "the scene's");
    changed |= own_choice(ui, "reflectance", "Its specular term", &mut object.reflectance, "the scene's");
    ui.separator();
    if object.scalars.is_some() {
        ui.label("Its numbers are shown by colours.");
        return changed;
    }
    if let Some(entry) = &mut object.material {
        ui.push_id("front", |ui| changed |= material::show(ui, entry));
        if ui.button("Use the model's own").clicked() {
            object.material = None;
            changed = true;
        }
    } else {
        ui.label("It has the model's own materials, or the default one.");
        if ui.button("Give it another").clicked() {
            object.material = Some(MaterialEntry::default());
            changed = true;
        }
    }
    ui.separator();
    let mut has_back = object.back_material.is_some();
    if check(ui, "another material at the back", "Whether back faces have a material of their own", &mut has_back) {
        object.back_material = has_back.then(MaterialEntry::default);
        changed = true;
    }
    if let Some(entry) = &mut object.back_material {
        ui.push_id("back", |ui| changed |= material::show(ui, entry));
    }
    changed
}

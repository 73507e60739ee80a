//! The values of a light.

use egui::Ui;
use halfway::lighting::PointLight;
use halfway::scene::{AttachEntry, LightEntry, LightKind};

use super::fields::{check, color, one_of, slider, vector, wide_slider};

/// All kinds, with the names that the panels have for them.
pub(crate) const KINDS: [(LightKind, &str); 5] = [
    (LightKind::Point, "point light"),
    (LightKind::Spot, "spot light"),
    (LightKind::Directional, "directional light"),
    (LightKind::Homogeneous, "homogeneous light"),
    (LightKind::Hemisphere, "hemisphere light"),
];

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Edited {
    pub(crate) changed: bool,
    pub(crate) removed: bool,
}

pub(crate) fn show(ui: &mut Ui, light: &mut LightEntry) -> Edited {
    let mut changed = kind(ui, light);
    if light.attach == AttachEntry::Camera {
        ui.label("It moves with the camera.");
    }
    if let AttachEntry::Object(_) = light.attach {
        ui.label("It moves with an object.");
    }
    let near = matches!(light.kind, LightKind::Point | LightKind::Spot | LightKind::Homogeneous);
    if near {
        let count = if light.kind == LightKind::Homogeneous { 4 } else { 3 };
        let hint = "Where the light is, in the frame that it is attached to";
        let before = light.position;
        if vector(ui, "position", hint, &mut light.position[..count], 0.02) {
            // Not everything may be 0.
            let is_nowhere = light.position.iter().all(|along| *along == 0.0);
            light.position = if is_nowhere { before } else { light.position };
            changed = true;
        }
    }
    let has_axis = light.kind != LightKind::Point && !(light.kind == LightKind::Homogeneous && light.cone.is_none());
    if has_axis {
        let toward_sky = "The direction toward the sky";
        let hint = if light.kind == LightKind::Hemisphere { toward_sky } else { "The way the light travels" };
        let before = light.cone.direction;
        if vector(ui, "direction", hint, &mut light.cone.direction, 0.01) {
            let is_none = light.cone.direction.iter().all(|along| *along == 0.0);
            light.cone.direction = if is_none { before } else { light.cone.direction };
            changed = true;
        }
    }
    if light.kind == LightKind::Hemisphere {
        changed |= color(ui, "sky", "The light from the sky", &mut light.hemisphere.sky);
        changed |= color(ui, "ground", "The light from the ground", &mut light.hemisphere.ground);
    } else {
        let colors = &mut light.light;
        changed |= color(ui, "ambient La", "What it adds to the light from everywhere", &mut colors.ambient);
        changed |= color(ui, "diffuse Ld", "Its color where surfaces are matte", &mut colors.diffuse);
        changed |= color(ui, "specular Ls", "Its color in highlights", &mut colors.specular);
    }
    if matches!(light.kind, LightKind::Spot | LightKind::Homogeneous) && !light.cone.is_none() {
        changed |= cone(ui, light);
    }
    if near {
        changed |= attenuation(ui, &mut light.light);
    }
    ui.add_space(8.0);
    Edited { changed, removed: ui.button("Remove this light").clicked() }
}

fn kind(ui: &mut Ui, light: &mut LightEntry) -> bool {
    let before = light.kind;
    let changed = one_of(ui, "kind", "The kind of light", &mut light.kind, &KINDS);
    if changed && light.kind != before {
        let default = LightEntry::white(light.kind);
        // The keys that the other kind does not have begin anew.
        if light.kind != LightKind::Homogeneous {
            let [x, y, z, w] = light.position;
            light.position = if w == 0.0 { default.position } else { [x / w, y / w, z / w, 1.0] };
        }
        light.cone.cutoff_deg = default.cone.cutoff_deg;
        light.cone.inner_deg = default.cone.inner_deg;
        light.animation.clear();
    }
    changed
}

fn cone(ui: &mut Ui, light: &mut LightEntry) -> bool {
    let cone = &mut light.cone;
    let mut changed = slider(ui, "cutoff", "From the axis to the edge, in degrees", &mut cone.cutoff_deg, 0.0..=90.0);
    let mut is_soft = cone.inner_deg.is_some();
    if check(ui, "soft edge", "Whether the light fades between an inner angle and the cutoff", &mut is_soft) {
        cone.inner_deg = is_soft.then_some(cone.cutoff_deg * 0.7);
        changed = true;
    }
    if let Some(inner) = &mut cone.inner_deg {
        changed |= slider(ui, "inner", "Where it begins to fade, in degrees", inner, 0.0..=cone.cutoff_deg);
        *inner = inner.min(cone.cutoff_deg);
    }
    changed | slider(ui, "exponent", "e of cos^e φ, φ the angle from the axis", &mut cone.exponent, 0.0..=128.0)
}

fn attenuation(ui: &mut Ui, light: &mut PointLight) -> bool {
    let before = *light;
    let values = &mut light.attenuation;
    let mut changed = wide_slider(ui, "constant", "a of 1/(a + b·d + c·d²)", &mut values.constant, 0.0..=10.0);
    changed |= wide_slider(ui, "linear", "b of 1/(a + b·d + c·d²)", &mut values.linear, 0.0..=10.0);
    changed |= wide_slider(ui, "quadratic", "c of 1/(a + b·d + c·d²)", &mut values.quadratic, 0.0..=10.0);
    if values.constant == 0.0 && values.linear == 0.0 && values.quadratic == 0.0 {
        *values = before.attenuation;
    }
    let mut has_range = light.range.is_some();
    if check(ui, "range", "Whether nothing beyond a distance is lit", &mut has_range) {
        light.range = has_range.then_some(10.0);
        changed = true;
    }
    if let Some(range) = &mut light.range {
        changed |= wide_slider(ui, "", "In world units", range, 0.01..=1000.0);
    }
    changed
}

//! Handles: lights are shown where they are, and dragged.

use egui::{Color32, Context, CursorIcon, Id, LayerId, Order, Painter, Pos2, Sense, Stroke, vec2};
use halfway::prelude::*;
use halfway::scene::{AttachEntry, LightEntry, LightKind};

use crate::projected::Projected;

/// The axes of the world, with their colours.
const AXES: [(Vec3, Color32); 3] = [
    (Vec3::X, Color32::from_rgb(235, 90, 80)),
    (Vec3::Y, Color32::from_rgb(110, 200, 90)),
    (Vec3::Z, Color32::from_rgb(90, 140, 245)),
];

/// The length of an axis of the light that is selected, in points.
const AXIS: f32 = 56.0;

/// The result of a drag or a click.
#[derive(Default)]
pub(crate) struct Handled {
    /// The light that was clicked or dragged.
    pub(crate) light: Option<usize>,
    pub(crate) changed: bool,
}

/// The middle of what the camera turns about, and how far away it is.
#[derive(Clone, Copy)]
pub(crate) struct Around {
    pub(crate) target: Vec3,
    pub(crate) distance: f32,
}

/// Shows the lights of the world's frame. Lights that move with something else have no handle.
pub(crate) fn show(
    ctx: &Context,
    lights: &mut [LightEntry],
    (projected, around, origin): (&Projected, Around, DVec3),
    selected: Option<usize>,
) -> Handled {
    let mut handled = Handled::default();
    for (index, light) in lights.iter_mut().enumerate() {
        if light.attach != AttachEntry::World || !light.animation.is_empty() {
            continue;
        }
        let is_selected = selected == Some(index);
        let before = place(light, around, origin);
        let Some(at) = projected.place(before) else { continue };
        rays(ctx, light, (before, at), (projected, around), is_selected);
        let mut moved = drag(ctx, Id::unique(("light", index)), at, 9.0, |response| {
            if response.clicked() || response.drag_started() {
                handled.light = Some(index);
            }
        })
        .map(|by| projected.moved(before, by));
        if is_selected && is_local(light.kind) {
            for (axis, color) in AXES {
                moved = moved.or(drag_axis(ctx, index, (before, at), (axis, color), projected));
            }
        }
        mark(ctx, light, (projected, at), is_selected);
        if let Some(by) = moved {
            handled.light = Some(index);
            handled.changed = true;
            put(light, before + by, around, origin);
        }
    }
    handled
}

fn is_local(kind: LightKind) -> bool {
    matches!(kind, LightKind::Point | LightKind::Spot | LightKind::Homogeneous)
}

/// Where a light is shown, counted from the origin: one that is far away is shown around what the camera looks at.
fn place(light: &LightEntry, around: Around, origin: DVec3) -> Vec3 {
    let [x, y, z, w] = light.position;
    match light.kind {
        LightKind::Directional => around.target - way(light) * away(around),
        LightKind::Hemisphere => around.target + way(light) * away(around),
        _ if w == 0.0 => around.target + DVec3::new(x, y, z).normalize_or_zero().as_vec3() * away(around),
        _ => (DVec3::new(x, y, z) / w - origin).as_vec3(),
    }
}

/// Puts a light to where its handle was dragged.
fn put(light: &mut LightEntry, at: Vec3, around: Around, origin: DVec3) {
    let toward = (at - around.target).normalize_or_zero();
    match light.kind {
        LightKind::Directional if toward != Vec3::ZERO => light.cone.direction = (-toward).to_array(),
        LightKind::Hemisphere if toward != Vec3::ZERO => light.cone.direction = toward.to_array(),
        LightKind::Point | LightKind::Spot | LightKind::Homogeneous => {
            let w = light.position[3];
            let [x, y, z] =
                if w == 0.0 { toward.as_dvec3().to_array() } else { ((at.as_dvec3() + origin) * w).to_array() };
            if w != 0.0 || toward != Vec3::ZERO {
                light.position = [x, y, z, w];
            }
        }
        LightKind::Directional | LightKind::Hemisphere => {}
    }
}

fn way(light: &LightEntry) -> Vec3 {
    Vec3::from(light.cone.direction).normalize_or_zero()
}

/// How far from the middle the handles of far lights are.
fn away(around: Around) -> f32 {
    0.35 * around.distance
}

/// Paints over the picture, and not over the panels beside it.
fn painter(ctx: &Context, projected: &Projected) -> Painter {
    ctx.layer_painter(LayerId::background()).with_clip_rect(projected.window)
}

/// A part of the window that can be dragged; gives by how many points it was.
fn drag(ctx: &Context, id: Id, at: Pos2, radius: f32, mut look: impl FnMut(&egui::Response)) -> Option<egui::Vec2> {
    let corner = at - vec2(radius, radius);
    let area = egui::Area::new(id).order(Order::Background).fixed_pos(corner).constrain(false);
    let response =
        area.show(ctx, |ui| ui.allocate_exact_size(vec2(radius, radius) * 2.0, Sense::click_and_drag()).1).inner;
    let response = response.on_hover_cursor(CursorIcon::Grab);
    look(&response);
    let by = response.drag_delta();
    (response.dragged() && by != egui::Vec2::ZERO).then_some(by)
}

/// An axis at a light, along which it is dragged.
fn drag_axis(
    ctx: &Context,
    index: usize,
    (point, at): (Vec3, Pos2),
    (axis, color): (Vec3, Color32),
    projected: &Projected,
) -> Option<Vec3> {
    let tip = projected.place(point + axis * projected.length(point, AXIS))?;
    let along = tip - at;
    // An axis that points at the eye cannot be dragged along.
    if along.length() < 8.0 {
        return None;
    }
    let painter = painter(ctx, projected);
    painter.arrow(at, along, Stroke::new(2.0, color));
    let by = drag(ctx, Id::unique(("axis", index, axis.to_array().map(f32::to_bits))), tip, 7.0, |response| {
        if response.hovered() || response.dragged() {
            painter.circle_filled(tip, 5.0, color);
        }
    })?;
    let share = by.dot(along) / along.length_sq();
    Some(axis * projected.length(point, AXIS) * share)
}

/// The mark of a light, in its colour.
fn mark(ctx: &Context, light: &LightEntry, (projected, at): (&Projected, Pos2), is_selected: bool) {
    let painter = painter(ctx, projected);
    let color = if light.kind == LightKind::Hemisphere { light.hemisphere.sky } else { light.light.diffuse };
    let strongest = color.red.max(color.green).max(color.blue).max(1e-9);
    let shown = egui::Rgba::from_rgb(color.red / strongest, color.green / strongest, color.blue / strongest);
    let ring = if is_selected { Color32::WHITE } else { Color32::from_black_alpha(200) };
    painter.circle(at, 6.0, Color32::from(shown), Stroke::new(if is_selected { 2.5 } else { 1.5 }, ring));
}

/// The way a light shines, the edge of its cone, and the range beyond which it is dark.
fn rays(
    ctx: &Context,
    light: &LightEntry,
    (point, at): (Vec3, Pos2),
    (projected, around): (&Projected, Around),
    is_selected: bool,
) {
    let painter = painter(ctx, projected);
    let faint = Stroke::new(1.0, Color32::from_rgba_unmultiplied(255, 230, 150, if is_selected { 200 } else { 90 }));
    let line = |from: Pos2, to: Vec3| {
        if let Some(to) = projected.place(to) {
            painter.line_segment([from, to], faint);
        }
    };
    let circle = |middle: Vec3, [across, up]: [Vec3; 2]| {
        let at = |step: u32| {
            let angle = step as f32 / 48.0 * std::f32::consts::TAU;
            projected.place(middle + across * angle.cos() + up * angle.sin())
        };
        for step in 0..48 {
            if let (Some(from), Some(to)) = (at(step), at(step + 1)) {
                painter.line_segment([from, to], faint);
            }
        }
    };
    match light.kind {
        LightKind::Directional => {
            let tip = projected.place(point + way(light) * away(around) * 0.5);
            if let Some(tip) = tip {
                painter.arrow(at, tip - at, faint);
            }
        }
        LightKind::Spot | LightKind::Homogeneous if !light.cone.is_none() && is_selected => {
            let (axis, length) = (way(light), 0.3 * around.distance);
            let across = axis.any_orthonormal_vector();
            let up = axis.cross(across);
            let angle = light.cone.cutoff_deg.min(89.0).to_radians();
            let middle = point + axis * length * angle.cos();
            let radius = length * angle.sin();
            circle(middle, [across * radius, up * radius]);
            for side in [across, -across, up, -up] {
                line(at, middle + side * radius);
            }
        }
        LightKind::Spot => line(at, point + way(light) * 0.15 * around.distance),
        LightKind::Point if is_selected => {
            if let Some(range) = light.light.range.filter(|range| range.is_finite()) {
                for pair in [[Vec3::X, Vec3::Y], [Vec3::Y, Vec3::Z], [Vec3::Z, Vec3::X]] {
                    circle(point, pair.map(|axis| axis * range));
                }
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AROUND: Around = Around { target: Vec3::new(1.0, 2.0, 3.0), distance: 10.0 };

    #[test]
    fn a_light_stays_where_its_handle_is_put() {
        let origin = DVec3::new(1000.0, 0.0, -500.0);
        let mut far = LightEntry::white(LightKind::Homogeneous);
        far.position = [0.0, 3.0, 4.0, 0.0];
        let mut twice = LightEntry::white(LightKind::Homogeneous);
        twice.position = [2002.0, 2.0, -1000.0, 2.0];
        let lights = [
            LightEntry::white(LightKind::Point),
            LightEntry::white(LightKind::Spot),
            LightEntry::white(LightKind::Directional),
            LightEntry::white(LightKind::Hemisphere),
            far,
            twice,
        ];
        for mut light in lights {
            let at = AROUND.target + Vec3::new(2.0, 1.0, -2.0).normalize() * away(AROUND);
            put(&mut light, at, AROUND, origin);
            let found = place(&light, AROUND, origin);
            // Some roundings in f32.
            assert!(found.distance(at) < 1e-4, "{:?}: {found} instead of {at}", light.kind);
        }
    }
}

//! The values that concern the whole picture: the scene's and the camera's.

use bevy_ecs::prelude::*;
use egui::{Slider, Ui};
use halfway::lighting::{Choices, HiddenEdges, Projection, Upright, View, WhichEdges, Width};
use halfway::prelude::*;
use halfway::scene::{EdgesEntry, SceneFile};
use halfway::window::OrbitCamera;

use super::fields::{channels_field, check, choice, one_of, own_choice, slider};

pub(crate) fn scene(ui: &mut Ui, scene: &mut SceneFile) -> bool {
    ui.heading("Scene");
    let mut changed = choice(ui, "shading", "How often surfaces are shaded", &mut scene.shading);
    changed |= choice(ui, "reflectance", "The specular term", &mut scene.reflectance);
    let viewers = [(Viewer::Local, "local"), (Viewer::Infinite, "infinite")];
    changed |= one_of(ui, "viewer", "Where the viewer is for the highlights", &mut scene.viewer, &viewers);
    changed |= intensity(ui, &mut scene.intensity);
    let counts = [(1, "1"), (4, "4"), (16, "16"), (64, "64")];
    changed |= one_of(ui, "samples", "Samples a pixel; a window has at most 4", &mut scene.samples, &counts);
    let mut steps = scene.tolerance.map_or(0.0, |tolerance| tolerance.steps);
    let hint = "How far the picture may be from the exact one, in steps of 1/255; 0 is exact";
    if slider(ui, "tolerance", hint, &mut steps, 0.0..=8.0) {
        let pixels = scene.tolerance.map_or(0.0, |tolerance| tolerance.pixels);
        scene.tolerance = Some(Tolerance { steps, pixels }).filter(|tolerance| *tolerance != Tolerance::EXACT);
        changed = true;
    }
    ui.separator();
    changed |= channels_field(ui, "ambient Ga", "The light from everywhere", &mut scene.ambient);
    changed |= channels_field(ui, "background", "Where nothing is drawn", &mut scene.background);
    ui.separator();
    changed |= edges(ui, &mut scene.edges);
    ui.horizontal_wrapped(|ui| {
        for (name, hint) in SHOWN {
            if let Some(shown) = scene.show.named(name) {
                changed |= check(ui, &name.replace('_', " "), hint, shown);
            }
        }
    });
    changed
}

/// Lines that explain a scene, by the names that files have, with a sentence for each.
const SHOWN: [(&str, &str); 5] = [
    ("axes", "The axes of the world: x red, y green, z blue"),
    ("normals", "The normals of vertices"),
    ("face_normals", "The normals of triangles"),
    ("lights", "Where lights are, and where they shine"),
    ("grid", "A grid on the ground"),
];

/// Lines along the edges of all objects that have none of their own.
fn edges(ui: &mut Ui, edges: &mut Option<EdgesEntry>) -> bool {
    let mut which = edges.as_ref().map(|edges| edges.which);
    let mut changed = own_choice(ui, "edges", "Lines along the edges of objects", &mut which, "none");
    if changed {
        *edges = which.map(|which| EdgesEntry { which, ..edges.unwrap_or_else(thin) });
    }
    let Some(edges) = edges else { return changed };
    if let Width::Pixels(width) = &mut edges.width {
        changed |= slider(ui, "width", "The width of the lines, in pixels", width, 0.25..=8.0);
    }
    changed |= channels_field(ui, "colour", "The colour of the lines", &mut edges.color);
    ui.horizontal(|ui| {
        let mut dashes = edges.hidden == HiddenEdges::Dash;
        if check(ui, "hidden edges", "Whether edges behind surfaces are dashed", &mut dashes) {
            edges.hidden = if dashes { HiddenEdges::Dash } else { HiddenEdges::Omit };
            changed = true;
        }
        changed |= check(ui, "surfaces", "Without them the lines are a wireframe", &mut edges.surface);
    });
    changed
}

/// Lines of a pixel.
pub(crate) fn thin() -> EdgesEntry {
    EdgesEntry { width: Width::Pixels(1.0), ..EdgesEntry::default() }
}

/// A wireframe that stands out from this background.
pub(crate) fn wireframe(background: [f32; 3]) -> EdgesEntry {
    let is_dark = background.iter().all(|channel| *channel < 0.2);
    let color = if is_dark { [0.7; 3] } else { [0.0; 3] };
    EdgesEntry { which: WhichEdges::All, surface: false, color, ..thin() }
}

fn intensity(ui: &mut Ui, value: &mut Intensity) -> bool {
    one_of(ui, "intensity", "The treatment of intensities above 1", value, &INTENSITIES)
}

/// The treatments of intensities above 1, with their names.
pub(crate) const INTENSITIES: [(Intensity, &str); 4] = [
    (Intensity::Clamp, "clamp"),
    (Intensity::Renormalize { smoothing: 0.0 }, "renormalise"),
    (Intensity::Reinhard { white: Intensity::WHITE }, "reinhard"),
    (Intensity::Aces, "aces"),
];

/// The camera is no part of what can be undone: it is changed where it stands.
pub(crate) fn camera(ui: &mut Ui, camera: Entity, world: &mut World) {
    ui.heading("Camera");
    ui.horizontal_wrapped(|ui| {
        for choice in View::CHOICES {
            if ui.button(choice.name).on_hover_text(choice.meaning).clicked() {
                look_from(choice.value, camera, world);
            }
        }
    });
    if let Some(mut up) = world.get::<OrbitCamera>(camera).map(|orbit| orbit.orbit.up)
        && one_of(ui, "up", "The direction that is up in the picture", &mut up, &UP)
    {
        set_up(up, camera, world);
    }
    let distance = world.get::<OrbitCamera>(camera).map_or(1.0, |orbit| orbit.orbit.distance);
    let Some(mut of_camera) = world.get_mut::<Camera>(camera) else { return };
    let mut is_orthographic = matches!(of_camera.projection, Projection::Orthographic { .. });
    if check(ui, "orthographic", "Whether rays are parallel", &mut is_orthographic) {
        of_camera.projection = other_projection(of_camera.projection, distance);
    }
    let mut projection = of_camera.projection;
    match &mut projection {
        Projection::Perspective { fov_y, .. } => {
            let mut degrees = fov_y.to_degrees();
            if ui.add(Slider::new(&mut degrees, 1.0..=150.0).suffix("°").text("field of view")).changed() {
                *fov_y = degrees.to_radians();
            }
        }
        Projection::Orthographic { height, .. } => {
            let range = 0.01 * distance..=10.0 * distance;
            ui.add(Slider::new(height, range).logarithmic(true).text("height"));
        }
    }
    of_camera.bypass_change_detection();
    if of_camera.projection != projection {
        of_camera.projection = projection;
    }
    if let Some(orbit) = world.get::<OrbitCamera>(camera) {
        let (eye, target) = (orbit.orbit.eye(), orbit.orbit.target);
        ui.label(format!("at {:.3}, {:.3}, {:.3}", eye.x, eye.y, eye.z));
        ui.label(format!("toward {:.3}, {:.3}, {:.3}", target.x, target.y, target.z));
    }
}

/// The directions that can be up.
const UP: [(Vec3, &str); 6] =
    [(Vec3::Y, "y"), (Vec3::Z, "z"), (Vec3::X, "x"), (Vec3::NEG_Y, "−y"), (Vec3::NEG_Z, "−z"), (Vec3::NEG_X, "−x")];

/// Turns the camera to the same side of what stands this way.
fn set_up(up: Vec3, camera: Entity, world: &mut World) {
    if let Some(mut orbit) = world.get_mut::<OrbitCamera>(camera) {
        orbit.orbit.up = up;
        world.entity_mut(camera).insert(Upright(up));
    }
}

/// Turns the camera to a side of what it looks at.
pub(crate) fn look_from(view: View, camera: Entity, world: &mut World) {
    if let Some(mut orbit) = world.get_mut::<OrbitCamera>(camera) {
        orbit.orbit.yaw = view.azimuth;
        orbit.orbit.pitch = view.elevation.clamp(-halfway::window::PITCH_LIMIT, halfway::window::PITCH_LIMIT);
    }
}

/// Parallel rays in place of a perspective, or the other way round, so that what is `distance` away keeps its size.
pub(crate) fn other_projection(projection: Projection, distance: f32) -> Projection {
    match projection {
        Projection::Perspective { film, .. } => {
            Projection::Orthographic { height: projection.height_at(distance), near: -1e3 * distance, far: None, film }
        }
        Projection::Orthographic { height, film, .. } => {
            Projection::Perspective { fov_y: 2.0 * (0.5 * height / distance).atan(), near: 0.01 * distance, film }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_looked_at_keeps_its_size() {
        let perspective = Projection::perspective(0.9);
        let orthographic = other_projection(perspective, 7.0);
        let back = other_projection(orthographic, 7.0);
        for projection in [orthographic, back] {
            assert!(projection.validate().is_ok());
            // Some roundings.
            assert!((projection.height_at(7.0_f32) - perspective.height_at(7.0_f32)).abs() < 1e-5, "{projection:?}");
        }
    }
}

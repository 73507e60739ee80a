//! The panels: the list of what is in the scene, and the values of what is selected.

mod fields;
mod light;
pub(crate) mod look;
mod material;
mod object;

use bevy_ecs::prelude::*;
use egui::{Panel, ScrollArea, Ui};
use halfway::prelude::*;
use halfway::scene::{LightEntry, LightKind, MeshEntry, ObjectEntry, SceneFile};

use crate::live::Live;

/// The part of the scene that is selected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Selected {
    /// The scene as a whole: shading, background, ambient light.
    Scene,
    Camera,
    Light(usize),
    Object(usize),
}

/// The list of the scene's camera, lights and objects. Returns whether the scene has changed.
pub(crate) fn tree(ui: &mut Ui, scene: &mut SceneFile, selected: &mut Selected, live: &Live, world: &World) -> bool {
    let mut changed = false;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let mut item = |ui: &mut Ui, what: Selected, text: String| {
            if ui.selectable_label(*selected == what, text).clicked() {
                *selected = what;
            }
        };
        item(ui, Selected::Scene, "Scene".into());
        item(ui, Selected::Camera, "Camera".into());
        ui.add_space(6.0);
        let lights = live.light_entries(scene, world);
        ui.horizontal(|ui| {
            ui.strong(format!("Lights ({})", lights.len()));
            ui.menu_button("+", |ui| {
                for (kind, name) in light::KINDS {
                    if ui.button(name).clicked() {
                        changed |= add_light(scene, kind, live, world);
                    }
                }
            })
            .response
            .on_hover_text("Add a light where the camera is");
        });
        for (index, light) in lights.iter().enumerate() {
            item(ui, Selected::Light(index), light_name(light, index));
        }
        ui.add_space(6.0);
        ui.strong(format!("Objects ({})", scene.objects.len()));
        for (index, object) in scene.objects.iter().enumerate() {
            item(ui, Selected::Object(index), object_name(object, index));
        }
    });
    changed
}

/// Adds a light at the camera, which shines to where it looks. Returns `true`, since the scene has changed.
pub(crate) fn add_light(scene: &mut SceneFile, kind: LightKind, live: &Live, world: &World) -> bool {
    let mut light = LightEntry::white(kind);
    if let Some(camera) = live.camera_entry(world) {
        let [eye, target] = [camera.position, camera.target].map(DVec3::from);
        let up = Vec3::from(camera.up).as_dvec3();
        let away = eye.distance(target);
        let right = (target - eye).cross(up).normalize_or_zero();
        // Before the camera and a little beside it, so that it is seen and shades what it lights.
        let at = eye + 0.4 * (target - eye) + 0.1 * away * (right + up);
        let [x, y, z] = at.to_array();
        if matches!(kind, LightKind::Point | LightKind::Spot | LightKind::Homogeneous) {
            light.position = [x, y, z, 1.0];
        }
        if matches!(kind, LightKind::Spot | LightKind::Directional) {
            light.cone.direction = (target - at).normalize_or(DVec3::NEG_Y).as_vec3().to_array();
        }
        if kind == LightKind::Hemisphere {
            light.cone.direction = camera.up;
        }
    }
    live.edit_lights(scene, world, |lights| lights.push(light));
    true
}

fn light_name(light: &LightEntry, index: usize) -> String {
    let kind = light::KINDS.iter().find(|(kind, _)| *kind == light.kind).map_or("light", |(_, name)| *name);
    light.name.clone().unwrap_or_else(|| format!("{kind} {index}"))
}

fn object_name(object: &ObjectEntry, index: usize) -> String {
    object.name.clone().unwrap_or_else(|| match &object.mesh {
        MeshEntry::Path(path) => path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        MeshEntry::Model(model) => model.path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        MeshEntry::UvSphere(_) | MeshEntry::Icosphere(_) => format!("sphere {index}"),
        MeshEntry::Plane(_) => format!("plane {index}"),
        MeshEntry::Box(_) => format!("box {index}"),
        MeshEntry::Teapot(_) => format!("teapot {index}"),
        MeshEntry::Surface(_) => format!("surface {index}"),
        MeshEntry::Inline(_) => format!("mesh {index}"),
    })
}

/// The values of what is selected. Returns whether the scene has changed.
pub(crate) fn inspector(
    ui: &mut Ui,
    scene: &mut SceneFile,
    selected: &mut Selected,
    live: &Live,
    world: &mut World,
) -> bool {
    ScrollArea::vertical()
        .auto_shrink(false)
        .show(ui, |ui| match *selected {
            Selected::Scene => look::scene(ui, scene),
            Selected::Camera => {
                look::camera(ui, live.spawned.camera, world);
                false
            }
            Selected::Light(index) => {
                let mut lights = live.light_entries(scene, world);
                let Some(light) = lights.get_mut(index) else {
                    *selected = Selected::Scene;
                    return false;
                };
                ui.heading(light_name(light, index));
                let edited = light::show(ui, light);
                if edited.removed {
                    remove_light(scene, index, live, world);
                    *selected = Selected::Scene;
                } else if edited.changed {
                    let light = light.clone();
                    live.edit_lights(scene, world, |lights| lights[index] = light);
                }
                edited.removed || edited.changed
            }
            Selected::Object(index) => {
                let Some(object) = scene.objects.get_mut(index) else {
                    *selected = Selected::Scene;
                    return false;
                };
                ui.heading(object_name(object, index));
                object::show(ui, object)
            }
        })
        .inner
}

/// Removes a light of the scene; the lights of models or the default ones become a list of the scene's before.
pub(crate) fn remove_light(scene: &mut SceneFile, index: usize, live: &Live, world: &World) -> bool {
    live.edit_lights(scene, world, |lights| {
        let is_there = index < lights.len();
        if is_there {
            lights.remove(index);
        }
        is_there
    })
}

/// A panel at a side of the window.
pub(crate) fn side(left: bool) -> Panel {
    let panel = if left { Panel::left("tree") } else { Panel::right("values") };
    panel.resizable(true).default_size(if left { 190.0 } else { 270.0 })
}

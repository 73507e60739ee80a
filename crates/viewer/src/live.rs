//! The entities of the scene that is shown.

use bevy_ecs::prelude::*;
use halfway::lighting::Viewport;
use halfway::prelude::*;
use halfway::scene::{CameraEntry, LightEntry, LightKind, LightsEntry, SceneFile, Spawned, spawn, spawn_seen_from};
use halfway::window::OrbitCamera;

use crate::document::Document;
use crate::error::ViewerError;

/// The scene in the world.
pub(crate) struct Live {
    pub(crate) spawned: Spawned,
    /// The cameras that share the picture, each with its part of the whole; one that has it for itself has none.
    pub(crate) parts: Vec<(Entity, Option<Viewport>)>,
    /// The scene as it was spawned, with the changes since.
    shown: SceneFile,
}

impl Live {
    pub(crate) fn new(document: &Document, world: &mut World) -> Result<Self, ViewerError> {
        let shown = document.scene.clone();
        let spawned = match &document.camera {
            None => spawn(&shown, &document.base_dir, world),
            Some(camera) => spawn_seen_from(&shown, &document.base_dir, camera, world),
        };
        let spawned = spawned.map_err(ViewerError::Scene)?;
        // A scene without one leaves that of the scene before.
        world.insert_resource(ViewTolerance(shown.tolerance.unwrap_or(Tolerance::EXACT)));
        let part = |camera: &Entity| (*camera, world.get::<Viewport>(*camera).copied());
        let parts = spawned.cameras.iter().map(part).collect();
        Ok(Self { spawned, parts, shown })
    }

    /// Shows the document as it stands. Where a change needs a new scene, the cameras stay where they are. Of several cameras
    /// that share the picture only the first one can follow, so that they need one each time.
    pub(crate) fn follow(&mut self, document: &Document, world: &mut World) -> Result<(), ViewerError> {
        if self.parts.len() < 2 && self.spawned.follow(&self.shown, &document.scene, world) {
            self.shown = document.scene.clone();
            return Ok(());
        }
        let mut anew = Self::new(document, world)?;
        std::mem::swap(self, &mut anew);
        for (before, camera) in anew.spawned.cameras.iter().zip(&self.spawned.cameras) {
            keep_place(*before, *camera, world);
        }
        anew.spawned.despawn(world);
        Ok(())
    }

    /// The camera as it stands, as an entry of the scene.
    pub(crate) fn camera_entry(&self, world: &World) -> Option<CameraEntry> {
        let camera = world.get::<Camera>(self.spawned.camera)?;
        let transform = world.get::<Transform>(self.spawned.camera)?;
        let distance = world.get::<OrbitCamera>(self.spawned.camera).map_or(1.0, |orbit| orbit.orbit.distance);
        let origin = world.get::<Origin>(self.spawned.camera).map_or(self.spawned.origin, |origin| origin.0);
        let mut entry = CameraEntry::of(camera, transform, distance, origin);
        let up = world.get::<OrbitCamera>(self.spawned.camera).map_or(Vec3::Y, |orbit| orbit.orbit.up);
        // A picture that was turned upright is one that the orbit keeps so.
        if up.dot(transform.rotation * Vec3::X).abs() < 1e-4 * up.length() {
            entry.up = up.to_array();
        }
        Some(entry)
    }

    /// The scene, seen as it is now.
    pub(crate) fn scene_to_save(&self, document: &Document, world: &World) -> SceneFile {
        let mut scene = document.scene.clone();
        if let Some(now) = self.camera_entry(world)
            && scene.all_cameras().all(|camera| camera.viewport.is_none())
        {
            let CameraEntry { position, target, up, fov_y_deg, near, shift, pixel_aspect, height, far, .. } = now;
            let aspect = scene.all_cameras().next().and_then(|camera| camera.aspect);
            let place = CameraEntry {
                position,
                target,
                up,
                fov_y_deg,
                near,
                shift,
                aspect,
                pixel_aspect,
                height,
                far,
                zoom: 1.0,
                view: None,
                fit: None,
                intrinsics: None,
                ortho: false,
                ..scene.camera.take().unwrap_or_default()
            };
            scene.camera = Some(place);
        }
        scene
    }

    /// The lights of the scene, one by one: those of its list, of its rig, of its models, or the default ones.
    pub(crate) fn light_entries(&self, scene: &SceneFile, world: &World) -> Vec<LightEntry> {
        if let Some(lights) = &scene.lights {
            return lights.entries().into_owned();
        }
        let default = halfway::scene::default_lights();
        let are_default = self.spawned.lights.len() == default.len()
            && (0..default.len()).all(|index| {
                let name = world.get::<Name>(self.spawned.lights[index]);
                name.is_some_and(|name| name.as_str() == format!("lights[{index}]"))
            });
        if are_default {
            return default;
        }
        self.spawned.lights.iter().filter_map(|light| entry_of(*light, world)).collect()
    }

    /// Changes the lights of the scene, which become a list of its own.
    pub(crate) fn edit_lights<R>(
        &self,
        scene: &mut SceneFile,
        world: &World,
        edit: impl FnOnce(&mut Vec<LightEntry>) -> R,
    ) -> R {
        let mut list = match &mut scene.lights {
            Some(LightsEntry::List(list)) => std::mem::take(list),
            _ => self.light_entries(scene, world),
        };
        let edited = edit(&mut list);
        scene.lights = Some(LightsEntry::List(list));
        edited
    }
}

/// Puts a camera where another stands.
fn keep_place(before: Entity, camera: Entity, world: &mut World) {
    let place = (world.get::<Transform>(before).copied(), world.get::<OrbitCamera>(before).cloned());
    let projection = world.get::<Camera>(before).map(|camera| camera.projection);
    if let (Some(transform), Some(orbit)) = place {
        world.entity_mut(camera).insert((transform, orbit));
    }
    if let (Some(mut camera), Some(projection)) = (world.get_mut::<Camera>(camera), projection) {
        camera.projection = projection;
    }
}

/// A light of a model as an entry of the world.
fn entry_of(light: Entity, world: &World) -> Option<LightEntry> {
    let entity = world.get_entity(light).ok()?;
    let at = entity.get::<GlobalTransform>()?;
    let direction = at.forward().as_vec3().to_array();
    let [x, y, z] = at.translation().as_dvec3().to_array();
    let name = entity.get::<Name>().map(|name| name.as_str().to_owned());
    let white = |kind| LightEntry { name: name.clone(), ..LightEntry::white(kind) };
    let mut entry = if let Some(light) = entity.get::<SpotLight>() {
        let mut entry = LightEntry { light: light.light, ..white(LightKind::Spot) };
        entry.cone.cutoff_deg = light.cone.cutoff.to_degrees();
        entry.cone.inner_deg = light.cone.inner.map(f32::to_degrees);
        entry.cone.exponent = light.cone.exponent;
        entry
    } else if let Some(light) = entity.get::<PointLight>() {
        LightEntry { light: *light, ..white(LightKind::Point) }
    } else if let Some(light) = entity.get::<DirectionalLight>() {
        let mut entry = white(LightKind::Directional);
        (entry.light.ambient, entry.light.diffuse, entry.light.specular) =
            (light.ambient, light.diffuse, light.specular);
        entry
    } else {
        LightEntry { hemisphere: *entity.get::<HemisphereLight>()?, ..white(LightKind::Hemisphere) }
    };
    entry.cone.direction = direction;
    if entry.kind == LightKind::Hemisphere {
        entry.cone.direction = at.up().as_vec3().to_array();
    }
    entry.position = [x, y, z, 1.0];
    Some(entry)
}

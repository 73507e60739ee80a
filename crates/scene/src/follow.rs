//! A scene that was spawned follows changes of its file, without being read again.

use std::sync::Arc;

use bevy_color::{ColorToComponents, LinearRgba};
use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Vec3};
use bevy_transform::components::Transform;
use halfway_lighting::{
    BackMaterial, Camera, Film, GlobalAmbient, Projection, Reflectance, Samples, Shading, Show, Tolerance,
    ViewTolerance,
};
use halfway_mesh::Mesh3d;

use crate::edges::EdgesEntry;
use crate::file::SceneFile;
use crate::lights_entry::LightsEntry;
use crate::material::MaterialEntry;
use crate::mesh::{LoadedModel, MeshEntry};
use crate::object::ObjectEntry;
use crate::placement::Placement;
use crate::spawn::{Spawned, spawn_listed_lights};
use crate::view::CameraEntry;

impl Spawned {
    /// Makes the entities of `shown`, the scene that was spawned, those of `scene`. Lights may come and go, and materials,
    /// shading and all that concerns the whole picture may change. The camera stays where it is. Returns `false`, and has
    /// changed nothing, where more is different: then the scene has to be [despawned](Self::despawn) and spawned again.
    ///
    /// ```
    /// use std::path::Path;
    /// use bevy_ecs::world::World;
    /// use halfway_asset::Assets;
    /// use halfway_lighting::Shading;
    /// use halfway_mesh::{Lines, Mesh};
    /// use halfway_scene::{LightsEntry, SceneFile, spawn};
    ///
    /// let mut world = World::new();
    /// world.init_resource::<Assets<Mesh>>();
    /// world.init_resource::<Assets<Lines>>();
    /// let shown = SceneFile::default();
    /// let mut spawned = spawn(&shown, Path::new(""), &mut world)?;
    /// let dark = SceneFile { lights: Some(LightsEntry::List(Vec::new())), shading: Shading::Flat, ..shown.clone() };
    /// assert!(spawned.follow(&shown, &dark, &mut world) && spawned.lights.is_empty());
    /// # Ok::<(), halfway_scene::SceneError>(())
    /// ```
    pub fn follow(&mut self, shown: &SceneFile, scene: &SceneFile, world: &mut World) -> bool {
        let same_lights = shown.lights == scene.lights;
        let is_whole = |scene: &SceneFile| scene.only.is_none() && scene.light.is_none();
        let can_follow = is_whole(shown)
            && is_whole(scene)
            && plain(shown) == plain(scene)
            && (same_lights || scene.lights.is_some())
            && shown.objects.len() == scene.objects.len()
            && shown.objects.iter().zip(&scene.objects).all(|(shown, object)| follows(shown, object))
            && scene.validate().is_ok()
            && self.can_place(shown, scene, world);
        if !can_follow {
            return false;
        }
        for (index, (shown, object)) in shown.objects.iter().zip(&scene.objects).enumerate() {
            if shown.transform != object.transform {
                self.place_object(index, &object.transform.matrix(), world);
            }
            if !has_same_looks(shown, object) {
                self.dress_again(index, object, world);
            }
        }
        if !same_lights {
            self.light_again(shown, scene, world);
        }
        self.look_again(scene, world);
        true
    }

    /// Whether the objects that have moved can be placed anew: neither was nor becomes one of them two entities, since it
    /// shears.
    fn can_place(&self, shown: &SceneFile, scene: &SceneFile, world: &World) -> bool {
        let has_moved = |(shown, object): &(&ObjectEntry, &ObjectEntry)| shown.transform != object.transform;
        let is_one = |(index, (_, object)): (usize, (&ObjectEntry, &ObjectEntry))| {
            let is_placed = self.objects.get(index).is_some_and(|frame| world.get::<ChildOf>(*frame).is_none());
            is_placed && Placement::from_matrix(&object.transform.matrix()).inner.is_none()
        };
        let pairs = shown.objects.iter().zip(&scene.objects).enumerate();
        pairs.filter(|(_, pair)| has_moved(pair)).all(is_one)
    }

    /// Removes all entities of the scene. Resources stay.
    pub fn despawn(self, world: &mut World) {
        let environment = self.environment.into_iter().collect();
        for entity in [self.lights, self.objects, environment, self.cameras, vec![self.camera]].concat() {
            // An object that shears has its frame in another entity.
            let parent = world.get::<ChildOf>(entity).map(ChildOf::parent);
            let is_outer =
                |outer: &Entity| world.get::<Camera>(*outer).is_none() && world.get::<Mesh3d>(*outer).is_none();
            let entity = parent.filter(is_outer).unwrap_or(entity);
            // Lights may have gone with what they are attached to.
            if let Ok(entity) = world.get_entity_mut(entity) {
                entity.despawn();
            }
        }
    }

    fn dress_again(&self, index: usize, object: &ObjectEntry, world: &mut World) {
        let Some(&frame) = self.objects.get(index) else { return };
        for entity in with_descendants(frame, world) {
            let mut entity = world.entity_mut(entity);
            if !entity.contains::<Mesh3d>() {
                continue;
            }
            if let Some(material) = object.material.as_ref().and_then(MaterialEntry::material) {
                entity.insert(material);
            }
            put(&mut entity, object.back_material.as_ref().and_then(MaterialEntry::material).map(BackMaterial));
            put(&mut entity, object.shading);
            put(&mut entity, object.reflectance);
            put(&mut entity, object.tolerance);
        }
    }

    fn light_again(&mut self, shown: &SceneFile, scene: &SceneFile, world: &mut World) {
        let (Some(LightsEntry::List(before)), Some(LightsEntry::List(lights))) = (&shown.lights, &scene.lights) else {
            return self.spawn_lights_again(scene, world);
        };
        let is_placed = before.len() == lights.len()
            && (0..lights.len()).all(|index| {
                let (before, light) = (&before[index], &lights[index]);
                before == light || before.name == light.name && self.place_light(index, light, world)
            });
        if !is_placed {
            self.spawn_lights_again(scene, world);
        }
    }

    fn spawn_lights_again(&mut self, scene: &SceneFile, world: &mut World) {
        for light in std::mem::take(&mut self.lights) {
            if let Ok(light) = world.get_entity_mut(light) {
                light.despawn();
            }
        }
        let entries = scene.lights.as_ref().map(LightsEntry::entries).unwrap_or_default();
        self.lights = spawn_listed_lights((scene, &entries), self.camera, &self.objects, self.origin, world);
    }

    /// Follows the values that concern the whole picture.
    fn look_again(&self, scene: &SceneFile, world: &mut World) {
        world.insert_resource(GlobalAmbient(LinearRgba::from_f32_array_no_alpha(scene.ambient)));
        world.insert_resource(ViewTolerance(scene.tolerance.unwrap_or(Tolerance::EXACT)));
        let Ok(mut entity) = world.get_entity_mut(self.camera) else { return };
        let entry = scene.all_cameras().next();
        if let Some(mut camera) = entity.get_mut::<Camera>() {
            let samples = entry.and_then(|entry| entry.samples).unwrap_or(scene.samples);
            let changed = Camera {
                background: LinearRgba::from_f32_array_no_alpha(scene.background),
                background_below: scene.background_below.map(LinearRgba::from_f32_array_no_alpha),
                background_opacity: scene.background_opacity,
                viewer: scene.viewer,
                samples: Samples::from_count(samples).unwrap_or_default(),
                encoding: scene.output,
                intensity: scene.intensity,
                ..*camera
            };
            camera.set_if_neq(changed);
        }
        let view = (
            entry.and_then(|entry| entry.shading).unwrap_or(scene.shading),
            entry.and_then(|entry| entry.reflectance).unwrap_or(scene.reflectance),
        );
        if (entity.get::<Shading>(), entity.get::<Reflectance>()) != (Some(&view.0), Some(&view.1)) {
            entity.insert(view);
        }
        put(&mut entity, scene.edges.as_ref().map(EdgesEntry::component));
        put(&mut entity, Some(scene.show).filter(Show::any));
    }
}

/// The scene without all that [`Spawned::follow`] can follow, and without the objects.
fn plain(scene: &SceneFile) -> SceneFile {
    let default = SceneFile::default();
    SceneFile {
        background: default.background,
        background_below: None,
        background_opacity: default.background_opacity,
        output: default.output,
        intensity: default.intensity,
        samples: default.samples,
        ambient: default.ambient,
        viewer: default.viewer,
        shading: default.shading,
        tolerance: None,
        reflectance: default.reflectance,
        edges: None,
        show: default.show,
        lights: None,
        only: None,
        light: None,
        objects: Vec::new(),
        // Animations and images are not copied for nothing.
        size: scene.size,
        line_style: scene.line_style,
        environment: scene.environment.clone(),
        camera: scene.camera.clone(),
        cameras: scene.cameras.clone(),
        animation: scene.animation.clone(),
        schema_version: scene.schema_version,
        warnings: Vec::new(),
    }
}

/// Whether one object becomes another by its place and its looks alone.
fn follows(shown: &ObjectEntry, object: &ObjectEntry) -> bool {
    let can_dress = shown.scalars.is_none() && shown.material.is_some() == object.material.is_some();
    (can_dress || has_same_looks(shown, object))
        && is_same_mesh(&shown.mesh, &object.mesh)
        && rest(shown) == rest(object)
}

fn has_same_looks(shown: &ObjectEntry, object: &ObjectEntry) -> bool {
    let looks = |object: &ObjectEntry| (object.shading, object.reflectance, object.tolerance);
    looks(shown) == looks(object) && shown.material == object.material && shown.back_material == object.back_material
}

/// All but the mesh, the place and the looks.
fn rest(object: &ObjectEntry) -> impl PartialEq + '_ {
    let ObjectEntry {
        mesh: _,
        transform: _,
        material: _,
        back_material: _,
        shading: _,
        tolerance: _,
        reflectance: _,
        name,
        normals,
        displacement,
        vertex_colors,
        maps,
        solid,
        scalars,
        mark_missing_images,
        edges,
        layers,
        line_style,
        animation,
        faces,
        mask,
        blend,
    } = object;
    let shape = (name, normals, displacement, vertex_colors, maps, solid, scalars);
    (shape, (mark_missing_images, edges, layers, line_style, animation), (faces, mask, blend))
}

/// Whether two meshes are the same; models in memory by their place, since they may be large.
fn is_same_mesh(a: &MeshEntry, b: &MeshEntry) -> bool {
    match (a, b) {
        (MeshEntry::Model(LoadedModel { model: a, .. }), MeshEntry::Model(LoadedModel { model: b, .. })) => {
            Arc::ptr_eq(a, b)
        }
        _ => a == b,
    }
}

/// Gives an entity a component, or takes it away.
fn put<T: Component + PartialEq>(entity: &mut EntityWorldMut, component: Option<T>) {
    match component {
        Some(component) if entity.get::<T>() != Some(&component) => drop(entity.insert(component)),
        None if entity.contains::<T>() => drop(entity.remove::<T>()),
        _ => {}
    }
}

fn with_descendants(root: Entity, world: &World) -> Vec<Entity> {
    let (mut all, mut next) = (vec![root], 0);
    while let Some(&entity) = all.get(next) {
        next += 1;
        all.extend(world.get::<Children>(entity).into_iter().flat_map(RelationshipTarget::iter));
    }
    all
}

impl CameraEntry {
    /// The entry of a camera as it stands in a world, `distance` before the point that it looks at. Its position counts
    /// from `origin`, as [`Spawned::origin`] has it. A camera whose film is not the default one keeps it.
    pub fn of(camera: &Camera, transform: &Transform, distance: f32, origin: DVec3) -> Self {
        let axis = |local: Vec3| (transform.rotation * local).normalize();
        let position = transform.translation.as_dvec3() + origin;
        let target = position + axis(Vec3::NEG_Z).as_dvec3() * f64::from(distance);
        let up = axis(Vec3::Y).to_array();
        let place = Self { position: position.to_array(), target: target.to_array(), up, ..Self::default() };
        let film = |film: Film, entry: Self| Self {
            shift: film.shift,
            aspect: film.aspect,
            pixel_aspect: film.pixel_aspect,
            ..entry
        };
        match camera.projection {
            Projection::Perspective { fov_y, near, film: on } => {
                film(on, Self { fov_y_deg: fov_y.to_degrees(), near, ..place })
            }
            Projection::Orthographic { height, near, far, film: on } => {
                film(on, Self { height: Some(height), near, far, ..place })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use halfway_asset::Assets;
    use halfway_lighting::{Intensity, Material, PointLight, Viewer};
    use halfway_mesh::{Lines, Mesh, UvSphere};

    use super::*;
    use crate::light::{LightEntry, LightKind};
    use crate::spawn::spawn;

    /// A change of a scene, with its name.
    type Edit = (&'static str, fn(&mut SceneFile));

    fn world() -> World {
        let mut world = World::new();
        world.init_resource::<Assets<Mesh>>();
        world.init_resource::<Assets<Lines>>();
        world
    }

    fn ball() -> ObjectEntry {
        let material = Some(MaterialEntry::Values(Material::DEFAULT));
        ObjectEntry { material, ..ObjectEntry::new(MeshEntry::UvSphere(UvSphere::default())) }
    }

    fn scene() -> SceneFile {
        let lights = vec![LightEntry::white(LightKind::Point), LightEntry::white(LightKind::Spot)];
        let camera = Some(CameraEntry::default());
        SceneFile { camera, lights: Some(lights.into()), objects: vec![ball(), ball()], ..SceneFile::default() }
    }

    /// The components that pictures depend on, of all entities in the order of the scene.
    fn seen(spawned: &Spawned, world: &World) -> Vec<String> {
        let entities = [&[spawned.camera][..], &spawned.objects, &spawned.lights].concat();
        let shown = |entity: Entity| {
            let object = (world.get::<Material>(entity), world.get::<BackMaterial>(entity));
            let looks =
                (world.get::<Shading>(entity), world.get::<Reflectance>(entity), world.get::<Tolerance>(entity));
            let light = (world.get::<PointLight>(entity), world.get::<halfway_lighting::SpotLight>(entity));
            let place = (world.get::<Transform>(entity), world.get::<Camera>(entity), world.get::<Name>(entity));
            format!("{object:?} {looks:?} {light:?} {place:?}")
        };
        let ambient = format!("{:?} {:?}", world.resource::<GlobalAmbient>(), world.get_resource::<ViewTolerance>());
        entities.into_iter().map(shown).chain([ambient]).collect()
    }

    #[test]
    fn what_follows_is_what_is_spawned() {
        let edits: [Edit; 12] = [
            ("material", |scene| scene.objects[1].material = Some(MaterialEntry::Preset("brass".into()))),
            ("back", |scene| scene.objects[0].back_material = Some(MaterialEntry::Preset("jade".into()))),
            ("looks", |scene| (scene.objects[0].shading, scene.objects[1].reflectance) = (Some(Shading::Flat), None)),
            ("moved object", |scene| {
                let parts = crate::transform::TransformParts { translation: [1.0, 2.0, 3.0], ..Default::default() };
                scene.objects[1].transform = crate::transform::TransformEntry::Parts(parts);
            }),
            ("moved light", |scene| lights(scene)[0].position[1] = 7.0),
            ("kind", |scene| lights(scene)[0].kind = LightKind::Directional),
            ("new light", |scene| lights(scene).push(LightEntry::white(LightKind::Hemisphere))),
            ("fewer lights", |scene| drop(lights(scene).remove(0))),
            ("no light", |scene| lights(scene).clear()),
            ("attached", |scene| lights(scene)[1].attach = crate::light::AttachEntry::Camera),
            ("picture", |scene| {
                (scene.background, scene.ambient, scene.samples) = ([0.5; 3], [0.25; 3], 4);
                (scene.viewer, scene.intensity) = (Viewer::Infinite, Intensity::Aces);
            }),
            ("view", |scene| (scene.shading, scene.reflectance) = (Shading::Gouraud, Reflectance::BlinnPhong)),
        ];
        for (name, edit) in edits {
            let (mut world, before) = (world(), scene());
            let mut spawned = spawn(&before, Path::new(""), &mut world).unwrap();
            let mut after = before.clone();
            edit(&mut after);
            let first = seen(&spawned, &world);
            assert!(spawned.follow(&before, &after, &mut world), "{name}");
            let mut fresh = self::world();
            let anew = spawn(&after, Path::new(""), &mut fresh).unwrap();
            fresh.get_resource_or_init::<ViewTolerance>();
            let now = seen(&spawned, &world);
            assert_eq!(now, seen(&anew, &fresh), "{name}");
            assert_ne!(first, now, "{name} changes something");
            // And back.
            assert!(spawned.follow(&after, &before, &mut world), "{name}");
            let back = seen(&spawned, &world);
            assert_eq!(back[..back.len() - 1], first[..first.len() - 1], "{name}");
        }
    }

    fn lights(scene: &mut SceneFile) -> &mut Vec<LightEntry> {
        match &mut scene.lights {
            Some(LightsEntry::List(list)) => list,
            other => panic!("no list: {other:?}"),
        }
    }

    #[test]
    fn other_changes_need_a_new_scene() {
        let edits: [Edit; 6] = [
            ("mesh", |scene| scene.objects[0].mesh = MeshEntry::Box(halfway_mesh::Cuboid::default())),
            ("objects", |scene| scene.objects.push(ball())),
            ("own material", |scene| scene.objects[0].material = None),
            ("lights of models", |scene| scene.lights = None),
            ("not valid", |scene| scene.samples = 3),
            ("one term", |scene| scene.only = Some(halfway_lighting::Term::Diffuse)),
        ];
        for (name, edit) in edits {
            let (mut world, before) = (world(), scene());
            let mut spawned = spawn(&before, Path::new(""), &mut world).unwrap();
            let mut after = before.clone();
            edit(&mut after);
            let first = seen(&spawned, &world);
            assert!(!spawned.follow(&before, &after, &mut world), "{name}");
            assert_eq!(seen(&spawned, &world), first, "{name}");
        }
    }

    #[test]
    fn nothing_is_left_of_a_scene_that_is_despawned() {
        let mut world = world();
        let mut placed = world.query::<&Transform>();
        let mut with_shear = scene();
        let columns = [1.0, 0.0, 0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        let matrix = crate::transform::TransformMatrix { matrix: columns };
        with_shear.objects[0].transform = crate::transform::TransformEntry::Matrix(matrix);
        lights(&mut with_shear)[0].attach = crate::light::AttachEntry::Object(crate::named::NameOrIndex::Index(0));
        let spawned = spawn(&with_shear, Path::new(""), &mut world).unwrap();
        // The camera, two objects of which one is two entities, and two lights.
        assert_eq!(placed.iter(&world).count(), 6);
        spawned.despawn(&mut world);
        assert_eq!(placed.iter(&world).count(), 0);
    }

    #[test]
    fn a_camera_is_written_as_it_stands() {
        let entry = CameraEntry {
            position: [1.0, 2.0, 5.0],
            target: [0.5, 0.25, 0.0],
            fov_y_deg: 30.0,
            ..CameraEntry::default()
        };
        let camera = Camera { projection: entry.projection(), ..Camera::default() };
        let transform = entry.transform(DVec3::ZERO);
        let distance = DVec3::from(entry.position).distance(DVec3::from(entry.target)) as f32;
        let again = CameraEntry::of(&camera, &transform, distance, DVec3::ZERO);
        // Some roundings of a rotation in f32.
        assert!(again.transform(DVec3::ZERO).rotation.angle_between(transform.rotation) < 1e-6);
        assert!(DVec3::from(again.target).distance(DVec3::from(entry.target)) < 1e-6);
        assert_eq!((again.position, again.near), (entry.position, entry.near));
        assert!((again.fov_y_deg - 30.0).abs() < 1e-5);
    }
}

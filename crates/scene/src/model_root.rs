//! Model files as one entity.

use std::path::{Path, PathBuf};

use bevy_ecs::lifecycle::HookContext;
use bevy_ecs::prelude::*;
use bevy_ecs::world::DeferredWorld;
use bevy_transform::components::Transform;
use halfway_asset::Handle;
use halfway_mesh::{LoadError, Mesh, Mesh3d};
use thiserror::Error;

use crate::error::SceneError;
use crate::mesh::MeshEntry;
use crate::models::Shapes;
use crate::object::ObjectEntry;
use crate::spawn::{Handles, TextureHandles, has_mesh_assets, spawn_own_lights, spawn_parts};

/// A model file as one entity: its meshes, with their materials and images, its lines and points and its lights are children, each with its
/// `Name`. Despawning the entity despawns all of them.
///
/// The file is loaded when the commands are applied, relative to the working directory. The entity then has
/// [`ModelParts`], which finds the children by name. Where the file cannot be loaded, the entity has a [`ModelFailed`],
/// and the error is logged; [`spawn_model`] returns it. Inserting another `ModelRoot` replaces the children.
///
/// ```
/// use bevy_app::App;
/// use bevy_transform::components::Transform;
/// use halfway_mesh::MeshPlugin;
/// use halfway_scene::{ModelParts, ModelRoot};
///
/// # let lantern = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/lantern.glb");
/// # if !std::path::Path::new(lantern).is_file() { return } // A package on its own has no assets.
/// let mut app = App::new();
/// app.add_plugins(MeshPlugin);
/// let root = app.world_mut().spawn((ModelRoot::new(lantern), Transform::from_xyz(1.0, 0.0, 0.0))).id();
/// app.update();
/// let parts = app.world().get::<ModelParts>(root).unwrap();
/// assert!(parts.iter().count() > 1);
/// ```
#[derive(Component, Clone, Debug, PartialEq, Eq)]
#[component(immutable, on_insert = load)]
#[require(Transform)]
pub struct ModelRoot(pub PathBuf);

impl ModelRoot {
    /// The model of a file: SMF, OBJ, glTF, PLY, STL, OFF or 3MF.
    pub fn new(file: impl Into<PathBuf>) -> Self {
        Self(file.into())
    }
}

/// The children of a [`ModelRoot`], by the names that the file gives them; a mesh without one is `parts[0]` and so on.
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub struct ModelParts(Vec<ModelPart>);

#[derive(Clone, Debug, PartialEq)]
struct ModelPart {
    name: String,
    entity: Entity,
    mesh: Option<Handle<Mesh>>,
}

impl ModelParts {
    /// The first mesh or light of that name.
    pub fn entity(&self, name: &str) -> Option<Entity> {
        self.iter().find(|(other, _)| *other == name).map(|(_, entity)| entity)
    }

    /// The mesh of the first part of that name that has one.
    pub fn mesh(&self, name: &str) -> Option<&Handle<Mesh>> {
        self.0.iter().filter(|part| part.name == name).find_map(|part| part.mesh.as_ref())
    }

    /// All meshes, then lines and points, then all lights, in the order of the file, with their names.
    pub fn iter(&self) -> impl Iterator<Item = (&str, Entity)> {
        self.0.iter().map(|part| (part.name.as_str(), part.entity))
    }
}

/// Why the file of a [`ModelRoot`] could not be loaded, as a sentence.
#[derive(Component, Clone, Debug, PartialEq, Eq)]
pub struct ModelFailed(pub String);

/// A model file that cannot be spawned.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ModelError {
    /// The file cannot be loaded. The source names it and the place in it.
    #[error("{0}")]
    Load(LoadError),
    /// A material or a light holds a value that cannot be used.
    #[error("{at}: {source}")]
    Value {
        /// The file, and the name of the material or light in it.
        at: String,
        /// Which value, and what was expected.
        source: halfway_lighting::InvalidValue,
    },
    /// The world lacks something; the source says which plugin adds it.
    #[error("{0}")]
    World(SceneError),
}

impl From<SceneError> for ModelError {
    fn from(error: SceneError) -> Self {
        match error {
            SceneError::Model { source, .. } => Self::Load(source),
            SceneError::ModelValue { at, source, .. } => Self::Value { at, source },
            other => Self::World(other),
        }
    }
}

/// Spawns a model file as one entity, a [`ModelRoot`], and loads it at once.
///
/// # Errors
/// The file cannot be loaded, or the world has no `Assets<Mesh>`. Nothing is spawned then.
pub fn spawn_model(file: impl Into<PathBuf>, world: &mut World) -> Result<Entity, ModelError> {
    let root = world.spawn(ModelRoot::new(file)).id();
    // The hook has queued the load.
    world.flush();
    let failed = world.entity_mut(root).take::<LoadFailure>();
    match failed {
        None => Ok(root),
        Some(LoadFailure(error)) => {
            world.despawn(root);
            Err(error)
        }
    }
}

/// The error itself, until [`spawn_model`] takes it.
#[derive(Component)]
struct LoadFailure(ModelError);

fn load(mut world: DeferredWorld, HookContext { entity, .. }: HookContext) {
    world.commands().queue(move |world: &mut World| {
        let Some(ModelRoot(file)) = world.get::<ModelRoot>(entity).cloned() else { return };
        let old = world.entity_mut(entity).take::<ModelParts>();
        for (_, child) in old.iter().flat_map(ModelParts::iter) {
            world.try_despawn(child).ok();
        }
        world.entity_mut(entity).remove::<(ModelFailed, LoadFailure)>();
        match fill(entity, &file, world) {
            Ok(parts) => drop(world.entity_mut(entity).insert(parts)),
            Err(error) => {
                log::error!("the model of entity {entity} is not shown: {error}");
                world.entity_mut(entity).insert((ModelFailed(error.to_string()), LoadFailure(error)));
            }
        }
    });
}

/// Gives the root its children.
fn fill(root: Entity, file: &Path, world: &mut World) -> Result<ModelParts, ModelError> {
    if !has_mesh_assets(world) {
        return Err(SceneError::NoMeshAssets.into());
    }
    let object = ObjectEntry::new(MeshEntry::Path(file.to_owned()));
    let mut shapes = Shapes::new(Path::new(""), None);
    let shape = shapes.load_once(&object, 0)?;
    for warning in shapes.warnings.iter().chain(&shapes.unused_cameras) {
        log::warn!("{warning}");
    }
    let (mut handles, mut textures) = (Handles::new(), TextureHandles::new());
    let meshes = spawn_parts(&object, root, &shape, (&mut handles, &mut textures), world);
    let lights = spawn_own_lights(&[(&object, shape)], &[root], world);
    let part = |entity: Entity| ModelPart {
        name: world.get::<Name>(entity).map(|name| name.as_str().to_owned()).unwrap_or_default(),
        entity,
        mesh: world.get::<Mesh3d>(entity).map(|mesh| mesh.0.clone()),
    };
    Ok(ModelParts(meshes.into_iter().chain(lights).map(part).collect()))
}

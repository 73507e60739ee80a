//! What can go wrong between a scene and its picture.

use bevy_ecs::prelude::Entity;
use halfway_lighting::InvalidValue;
use thiserror::Error;

/// Why a frame could not be drawn as asked.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum RenderError {
    /// No graphics adapter was found.
    #[error(
        "no graphics adapter: no Vulkan, Metal, DirectX 12 or OpenGL driver answered. Install a graphics driver; \
         a software one will do (Debian and Ubuntu: apt install mesa-vulkan-drivers)"
    )]
    NoAdapter,
    /// The adapter was found but would not open.
    #[error("the adapter {adapter} could not be opened: {reason}")]
    NoDevice {
        /// The adapter's name.
        adapter: String,
        /// What the driver said.
        reason: String,
    },
    /// A component holds a value outside its range.
    #[error("{entity}: {source}")]
    Invalid {
        /// The entity that carries the component, by its `Name` where it has one.
        entity: String,
        /// Which field, and what it may hold.
        source: InvalidValue,
    },
    /// There is nothing to look through.
    #[error("the scene has no camera: spawn an entity with a `Camera` and a `Transform`")]
    NoCamera,
    /// More than one camera is in the world.
    #[error("the scene has {0} cameras and only one can be drawn; keep one `Camera` component")]
    ManyCameras(usize),
    /// An object's mesh handle leads to no mesh.
    #[error("{entity}: its mesh is not in `Assets<Mesh>` (was it removed, or never added?)")]
    MissingMesh {
        /// The entity that carries the handle.
        entity: String,
    },
    /// A buffer or a picture is larger than the adapter can hold.
    #[error("{what} needs {needed}, and the adapter's limit is {limit}")]
    TooLarge {
        /// What did not fit.
        what: String,
        /// How much it needs, in the unit of the limit.
        needed: u64,
        /// The adapter's limit.
        limit: u64,
    },
    /// There is no headless picture to read.
    #[error("there is no headless target to read a picture from: add `Headless`")]
    NoPicture,
    /// The device was lost, or the driver failed.
    #[error("the graphics device failed: {0}")]
    Device(String),
}

/// An entity's name for an error: its `Name`, or its number.
pub(crate) fn label(entity: Entity, name: Option<&bevy_ecs::name::Name>) -> String {
    name.map_or_else(|| format!("entity {entity}"), |name| format!("\"{name}\""))
}

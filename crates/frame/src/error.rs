//! Errors between a scene and its picture.

use bevy_ecs::prelude::Entity;
use bevy_transform::components::GlobalTransform;
use halfway_lighting::InvalidValue;
use std::fmt;
use thiserror::Error;

/// Why a frame could not be drawn as asked.
///
/// Its `Debug` reads as its message, so that `fn main() -> Result<(), RenderError>` prints a sentence:
///
/// ```
/// use halfway_frame::error::RenderError;
///
/// let error = RenderError::NoCamera;
/// assert_eq!(format!("{error:?}"), error.to_string());
/// assert!(error.to_string().starts_with("there is no camera: spawn one with"));
/// ```
#[derive(Clone, Error, PartialEq)]
#[non_exhaustive]
pub enum RenderError {
    /// No graphics adapter was found.
    #[error(
        "no graphics adapter: no Vulkan, Metal, DirectX 12 or OpenGL driver answered. Install a graphics driver; \
         a software one will do (Debian and Ubuntu: apt install mesa-vulkan-drivers)"
    )]
    NoAdapter,
    /// Of the backends that the environment allows none has an adapter.
    #[error("no graphics adapter: none answered by {backends}, and WGPU_BACKEND lets nothing else be asked; unset it")]
    NoAdapterAmong {
        /// The value of `WGPU_BACKEND`.
        backends: String,
    },
    /// No adapter fits the name that `AdapterChoice` or the environment gives.
    #[error("no graphics adapter fits \"{wanted}\"; {}", listed(there))]
    NoSuchAdapter {
        /// The name, in lower case.
        wanted: String,
        /// The adapters that there are, a line each.
        there: Vec<String>,
    },
    /// The adapter was found but would not open.
    #[error(
        "the adapter {adapter} could not be opened: {reason}. Choose another by `AdapterChoice`, or let the CPU draw (`AdapterChoice::cpu()`)"
    )]
    NoDevice {
        /// The adapter's name.
        adapter: String,
        /// The driver's message.
        reason: String,
    },
    /// The vectors that the CPU is to draw with are unknown, or it does not have them.
    #[error("{asked_by}: {reason}")]
    NoVectors {
        /// The environment variable `HALFWAY_SIMD`, or the adapter's name.
        asked_by: String,
        /// The name that was found, and those that there are.
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
    /// An entity's `GlobalTransform` holds a number that is not finite, or gives a camera no direction.
    #[error(
        "{entity}: its GlobalTransform is {found}; expected finite numbers, and for a camera a scale that is not 0"
    )]
    BadTransform {
        /// The entity, by its `Name` where it has one.
        entity: String,
        /// The matrix as it was found, column by column.
        found: String,
    },
    /// Nothing carries `Transform`s over to `GlobalTransform`s, so that everything would be at the origin.
    #[error(
        "{entity}: its `Transform` has not reached its `GlobalTransform`. Add `TransformPlugin` or, in a schedule \
         of the app's own, propagate transforms before `RenderSet::View`"
    )]
    NotPropagated {
        /// The first entity found, by its `Name` where it has one.
        entity: String,
    },
    /// The headless picture has no pixels.
    #[error("the picture is {width} × {height} pixels; expected at least 1 × 1 (`Headless::size`, `Viewport::part`)")]
    EmptyPicture {
        /// Its width in pixels.
        width: u32,
        /// Its height in pixels.
        height: u32,
    },
    /// There is nothing to look through.
    #[error("there is no camera: spawn one with `(Camera::default(), Transform::from_xyz(0.0, 0.0, 5.0))`")]
    NoCamera,
    /// More than one camera is in the world, and it is not said which part of the picture each of them draws.
    #[error("the scene has {0} cameras: give each a `Viewport`, or keep one `Camera` component")]
    ManyCameras(usize),
    /// More than one environment lights the scene.
    #[error(
        "the scene has {0} environments and only one can light it: that of the first entity does; keep one `EnvironmentLight`"
    )]
    ManyEnvironments(usize),
    /// Objects have images, and an environment lights the scene, on an adapter that crashes where a draw reads both.
    #[error(
        "{0} objects with images cannot be drawn in the environment: llvmpipe through Vulkan crashes where a draw reads both; the \
         CPU draws them (`--adapter cpu`), and so does OpenGL (`--adapter gl:llvmpipe`)"
    )]
    ImagesInEnvironment(usize),
    /// An object's mesh handle leads to no mesh.
    #[error(
        "{entity}: its mesh is not in `Assets<Mesh>` (was it removed, or never added?); show what `Assets::add` returns"
    )]
    MissingMesh {
        /// The entity that carries the handle.
        entity: String,
    },
    /// A buffer or a picture is larger than the adapter can hold.
    #[error("{what} needs {needed}, and the adapter's limit is {limit}; make it smaller, or choose another adapter")]
    TooLarge {
        /// The thing that did not fit.
        what: String,
        /// How much it needs, in the unit of the limit.
        needed: u64,
        /// The adapter's limit.
        limit: u64,
    },
    /// The system refuses memory.
    #[error("{bytes} bytes of memory for {what} were refused; free some, or draw a smaller picture or scene")]
    Memory {
        /// The purpose of the memory.
        what: String,
        /// How much was asked for.
        bytes: u64,
    },
    /// The adapter cannot draw this scene into 32-bit floating point.
    #[error(
        "the picture is to hold 32-bit floats, and the adapter cannot {cannot}; expected another adapter, a picture of 8 \
         bits, or a scene that does without"
    )]
    FloatTarget {
        /// The operation that it cannot do with them.
        cannot: String,
    },
    /// There is no headless picture to read.
    #[error("there is no headless picture to read: add `RenderPlugin` without a window, and draw a frame")]
    NoPicture,
    /// There is no frame to encode.
    #[error(
        "there is no frame to encode: insert a `TextureTarget` and run the schedule that draws before `encode_frame`"
    )]
    NoFrame,
    /// A frame cannot be drawn into a texture as the scene asks.
    #[error("the frame cannot be drawn into the `TextureTarget` of {format}: {reason}")]
    BadTarget {
        /// The format of its pixels.
        format: String,
        /// The feature that it lacks, or the part of the scene that does not go with it.
        reason: String,
    },
    /// The levels of detail of a mesh could not be made; it is drawn as it is.
    #[error("{mesh}: its levels of detail could not be made, and it is drawn as it is: {reason}")]
    NoLevels {
        /// The mesh, by the number of its asset.
        mesh: String,
        /// The failure.
        reason: String,
    },
    /// Draws were left out of the picture, and nothing else says why: what they read was not there.
    #[error("{draws} draws are left out of the picture, since what they read is not there: a fault of the renderer")]
    LeftOut {
        /// How many.
        draws: u32,
    },
    /// A pass of the App's own could not be made ready, and is left out.
    #[error("the pass {pass} is not drawn: {reason}")]
    Pass {
        /// Its name.
        pass: String,
        /// The error that it gave.
        reason: String,
    },
    /// The device was lost, and the frame with it. The next one is drawn on a new device.
    #[error("the graphics device was lost: {0}. Everything is made anew on a new device")]
    DeviceLost(String),
    /// The driver failed.
    #[error("the graphics device failed: {0}")]
    Device(String),
    /// The CPU refused to draw the frame.
    #[error("the CPU could not draw the frame: {0}")]
    Cpu(String),
}

impl fmt::Debug for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

fn listed(adapters: &[String]) -> String {
    if adapters.is_empty() { "there is none".into() } else { format!("there are:\n  {}", adapters.join("\n  ")) }
}

/// The error of a transform that cannot be drawn with.
pub(crate) fn bad_transform(
    entity: Entity,
    name: Option<&bevy_ecs::name::Name>,
    transform: &GlobalTransform,
) -> RenderError {
    let found = format!("{:?}", transform.affine().to_cols_array());
    RenderError::BadTransform { entity: label(entity, name), found }
}

/// An entity's name for an error: its `Name`, or its number.
pub fn label(entity: Entity, name: Option<&bevy_ecs::name::Name>) -> String {
    name.map_or_else(|| format!("entity {entity}"), |name| format!("\"{name}\""))
}

/// The message of a panic.
pub fn panic_message(panic: &(dyn std::any::Any + Send)) -> String {
    let literal = panic.downcast_ref::<&str>().map(|message| (*message).to_owned());
    literal.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "it panicked".into())
}

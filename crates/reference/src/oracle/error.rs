//! The errors of a scene that cannot be drawn.

use bevy_ecs::prelude::{Entity, Name};
use halfway_lighting::InvalidValue;
use thiserror::Error;

/// Why a scene cannot be drawn.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum OracleError {
    /// The world has no camera.
    #[error("the scene has no camera: spawn an entity with a `Camera` and a `Transform`")]
    NoCamera,
    /// More than one camera is in the world.
    #[error("the scene has {0} cameras and only one can be drawn; keep one `Camera` component")]
    ManyCameras(usize),
    /// A component holds a value outside its range.
    #[error("{entity}: {source}")]
    Invalid {
        /// The entity that carries the component, by its `Name` where it has one.
        entity: String,
        /// The field and its range.
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
    /// No system propagates `Transform`s to `GlobalTransform`s, so everything would be at the origin.
    #[error(
        "{entity}: its `Transform` has not reached its `GlobalTransform`. Add `TransformPlugin` and run the app's \
         schedules once, or propagate transforms before the oracle looks at the world"
    )]
    NotPropagated {
        /// The first entity found, by its `Name` where it has one.
        entity: String,
    },
    /// An object's mesh handle leads to no mesh.
    #[error("{entity}: its mesh is not in `Assets<Mesh>` (was it removed, or never added?)")]
    MissingMesh {
        /// The entity that carries the handle.
        entity: String,
    },
    /// The picture has no pixels.
    #[error("the picture is {width} × {height} pixels; expected at least 1 × 1")]
    EmptyPicture {
        /// Its width in pixels.
        width: u32,
        /// Its height in pixels.
        height: u32,
    },
    /// The picture has more pixels than the oracle draws.
    #[error("the picture is {width} × {height} pixels; expected at most {limit} in all")]
    TooLarge {
        /// Its width in pixels.
        width: u32,
        /// Its height in pixels.
        height: u32,
        /// The most pixels that are drawn.
        limit: u64,
    },
    /// A pixel outside the picture.
    #[error(
        "({x}, {y}) lies outside the picture of {width} × {height} pixels; expected a column from 0 to {} and a row from 0 \
         to {}", width - 1, height - 1
    )]
    Outside {
        /// The column.
        x: u32,
        /// The row.
        y: u32,
        /// The picture's width in pixels.
        width: u32,
        /// The picture's height in pixels.
        height: u32,
    },
}

/// The drawing was stopped from outside.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("stopped")]
pub struct Stopped;

/// The queries read no resource that a world could lack.
pub(super) const ALWAYS: &str = "queries can be had of every world";

/// An entity's name for an error: its `Name`, or its number.
pub(super) fn label(entity: Entity, name: Option<&Name>) -> String {
    name.map_or_else(|| format!("entity {entity}"), |name| format!("\"{name}\""))
}

/// An entity's name, or its number.
pub(super) fn plain_name(entity: Entity, name: Option<&Name>) -> String {
    name.map_or_else(|| format!("entity {entity}"), |name| name.as_str().to_owned())
}

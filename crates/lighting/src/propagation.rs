//! Whether transforms are propagated: what is placed by its `Transform` and drawn by its `GlobalTransform` is at the
//! origin where nothing carries the one over to the other.

use bevy_ecs::entity::Entity;
use bevy_transform::components::{GlobalTransform, Transform};

/// Whether the transforms of a world are propagated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Propagation {
    /// An entity's `GlobalTransform` is its `Transform`, and not the identity: something propagates.
    Works,
    /// This entity has a `Transform` that is not the identity and a `GlobalTransform` that is, and no entity speaks for
    /// [`Works`](Self::Works).
    Missing(Entity),
    /// Neither: all transforms are the identity, or somebody writes `GlobalTransform`s by hand.
    Unknown,
}

/// Looks at `roots`, entities without a parent. It stops at the first that speaks for [`Propagation::Works`].
pub fn propagation<'a>(roots: impl IntoIterator<Item = (Entity, &'a Transform, &'a GlobalTransform)>) -> Propagation {
    let mut found = Propagation::Unknown;
    for (entity, transform, global) in roots {
        let expected = GlobalTransform::from(*transform);
        if expected == GlobalTransform::IDENTITY {
            continue;
        }
        if *global == expected {
            return Propagation::Works;
        }
        if *global == GlobalTransform::IDENTITY && found == Propagation::Unknown {
            found = Propagation::Missing(entity);
        }
    }
    found
}

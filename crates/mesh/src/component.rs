//! The mesh on an entity, and the plugin that makes meshes assets of an app.

use std::sync::atomic::{AtomicU64, Ordering};

use bevy_app::{App, Plugin};
use bevy_ecs::component::Component;
use bevy_transform::components::Transform;
use halfway_asset::{Handle, add_assets};

use crate::Mesh;

/// The mesh that an entity shows.
///
/// The entity's `GlobalTransform` places it; an identity [`Transform`] is added where there is none.
#[derive(Component, Clone, Debug, Default, PartialEq, Eq)]
#[require(Transform, SpawnOrder = SpawnOrder::next())]
pub struct Mesh3d(pub Handle<Mesh>);

impl From<Handle<Mesh>> for Mesh3d {
    fn from(handle: Handle<Mesh>) -> Self {
        Self(handle)
    }
}

/// When an object was spawned, among objects. Entities do not tell: their indices are used again.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SpawnOrder(u64);

impl SpawnOrder {
    /// Later than all that came before.
    fn next() -> Self {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        Self(COUNT.fetch_add(1, Ordering::Relaxed))
    }
}

/// Gives an app [`Assets<Mesh>`](halfway_asset::Assets), so that systems can take `ResMut<Assets<Mesh>>`.
///
/// May be added late and more than once: meshes that the app has already stay.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeshPlugin;

impl Plugin for MeshPlugin {
    fn build(&self, app: &mut App) {
        add_assets::<Mesh>(app);
    }

    fn is_unique(&self) -> bool {
        false
    }
}

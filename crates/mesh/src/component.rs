//! The mesh on an entity, and the plugin that makes meshes assets of an app.

use std::sync::atomic::{AtomicU64, Ordering};

use bevy_app::{App, Plugin};
use bevy_ecs::component::Component;
use bevy_transform::components::Transform;
use halfway_asset::{Handle, add_assets};

use crate::{Lines, Mesh};

/// The mesh that an entity shows.
///
/// The entity's `GlobalTransform` places it; an identity [`Transform`] is added where there is none.
///
/// ```
/// use bevy_app::App;
/// use bevy_transform::components::Transform;
/// use halfway_asset::Assets;
/// use halfway_mesh::{Mesh, Mesh3d, MeshPlugin, Teapot};
///
/// let mut app = App::new();
/// app.add_plugins(MeshPlugin);
/// let teapot = app.world_mut().resource_mut::<Assets<Mesh>>().add(Teapot::new(8));
/// // Two entities share one mesh.
/// app.world_mut().spawn((Mesh3d(teapot.clone()), Transform::from_xyz(-3.0, 0.0, 0.0)));
/// app.world_mut().spawn((Mesh3d(teapot), Transform::from_xyz(3.0, 0.0, 0.0)));
/// ```
#[derive(Component, Clone, Debug, Default, PartialEq, Eq)]
#[require(Transform, SpawnOrder = SpawnOrder::next())]
pub struct Mesh3d(pub Handle<Mesh>);

impl From<Handle<Mesh>> for Mesh3d {
    fn from(handle: Handle<Mesh>) -> Self {
        Self(handle)
    }
}

/// The lines and points that an entity shows.
///
/// They are drawn over the finished picture (`LineStyle` of `halfway_lighting` says how wide), hidden by the surfaces before them. The
/// entity's `GlobalTransform` places them; an identity [`Transform`] is added where there is none.
///
/// ```
/// use bevy_app::App;
/// use glam::Vec3;
/// use halfway_asset::Assets;
/// use halfway_mesh::{Lines, Lines3d, MeshPlugin};
///
/// let mut app = App::new();
/// app.add_plugins(MeshPlugin);
/// let helix = (0..200).map(|i| 0.1 * i as f32).map(|t| Vec3::new(t.cos(), 0.1 * t, t.sin()));
/// let helix = Lines::path(helix.collect()).expect("200 points");
/// let helix = app.world_mut().resource_mut::<Assets<Lines>>().add(helix);
/// app.world_mut().spawn(Lines3d(helix));
/// ```
#[derive(Component, Clone, Debug, Default, PartialEq, Eq)]
#[require(Transform, SpawnOrder = SpawnOrder::next())]
pub struct Lines3d(pub Handle<Lines>);

impl From<Handle<Lines>> for Lines3d {
    fn from(handle: Handle<Lines>) -> Self {
        Self(handle)
    }
}

/// The order in which objects were spawned. Entity indices do not tell: they are reused.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SpawnOrder(u64);

impl SpawnOrder {
    /// Later than all earlier ones.
    fn next() -> Self {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        Self(COUNT.fetch_add(1, Ordering::Relaxed))
    }
}

/// Gives an app `Assets<Mesh>` and `Assets<Lines>`, so that systems can take `ResMut<Assets<Mesh>>`.
///
/// May be added late and more than once: what the app has already stays.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeshPlugin;

impl Plugin for MeshPlugin {
    fn build(&self, app: &mut App) {
        add_assets::<Mesh>(app);
        add_assets::<Lines>(app);
    }

    fn is_unique(&self) -> bool {
        false
    }
}

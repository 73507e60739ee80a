//! The mesh on an entity, and the plugin that makes meshes assets of an app.

use std::sync::atomic::{AtomicU64, Ordering};

use bevy_app::{App, Plugin};
use bevy_asset::{AssetApp, AssetEvent, AssetServer, Assets, Handle};
use bevy_ecs::component::Component;
use bevy_ecs::message::Messages;
use bevy_ecs::reflect::ReflectComponent;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::Transform;

use crate::Mesh;

/// The mesh that an entity shows.
///
/// The entity's `GlobalTransform` places it; an identity [`Transform`] is added where there is none.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
#[require(Transform, SpawnOrder = SpawnOrder::next())]
pub struct Mesh3d(pub Handle<Mesh>);

impl From<Handle<Mesh>> for Mesh3d {
    fn from(handle: Handle<Mesh>) -> Self {
        Self(handle)
    }
}

/// When an object was spawned, among objects. Entities do not tell: their indices are used again.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[reflect(opaque, Component, Clone, Debug, PartialEq)]
pub struct SpawnOrder(u64);

impl SpawnOrder {
    /// Later than all that came before.
    fn next() -> Self {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        Self(COUNT.fetch_add(1, Ordering::Relaxed))
    }
}

/// Registers [`Mesh`] as an asset, so that systems can take `ResMut<Assets<Mesh>>`, and [`Mesh3d`] for reflection.
///
/// May be added late and more than once: meshes that the app has already stay.
///
/// Adds `bevy_asset`'s `AssetPlugin` with its defaults where the app does not have it yet; add your own before this one
/// to set it up otherwise.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeshPlugin;

impl Plugin for MeshPlugin {
    fn build(&self, app: &mut App) {
        if !app.world().contains_resource::<AssetServer>() {
            app.add_plugins(bevy_asset::AssetPlugin::default());
        }
        app.register_type::<Mesh3d>().register_type::<SpawnOrder>();
        // `init_asset` replaces what is there, so it runs once, and what somebody put there before is put back.
        if !app.world().contains_resource::<Messages<AssetEvent<Mesh>>>() {
            let early = app.world_mut().remove_resource::<Assets<Mesh>>();
            app.init_asset::<Mesh>();
            if let Some(early) = early {
                app.world().resource::<AssetServer>().register_asset(&early);
                app.insert_resource(early);
            }
        }
    }

    fn is_unique(&self) -> bool {
        false
    }
}

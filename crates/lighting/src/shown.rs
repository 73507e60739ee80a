//! Which entities are shown: by their visibility and layers, and those of all above them.

use bevy_ecs::entity::Entity;
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::system::{Query, SystemParam};

use crate::{Cameras, Layers, Visibility};

/// The most entities that [`Shown`] looks at on the way up, so that a hierarchy that runs in a circle comes to an end.
/// Ancestors farther above do not count.
const HIGHEST: usize = 10_000;

/// Tells which entities are shown in the view of the [current](Cameras::current) camera, as a parameter of a system.
///
/// It looks up the hierarchy when it is asked, so there is nothing to keep current.
#[derive(SystemParam)]
pub struct Shown<'w, 's> {
    visibilities: Query<'w, 's, &'static Visibility>,
    layers: Query<'w, 's, &'static Layers>,
    parents: Query<'w, 's, &'static ChildOf>,
    cameras: Cameras<'w, 's>,
}

impl Shown<'_, '_> {
    /// The same as [`is_shown`](Self::is_shown), for many entities: where nothing is [`Visibility::Hidden`] and nothing
    /// has [`Layers`], it looks at none of them.
    pub fn by_entity(&self) -> impl Fn(Entity) -> bool {
        let hides = self.hides_any();
        let seen = self.seen_layers();
        move |entity| !hides || self.is_in(seen, entity)
    }

    /// Whether any entity is [`Visibility::Hidden`] or has [`Layers`]. Where none is, all are shown.
    pub fn hides_any(&self) -> bool {
        !self.layers.is_empty() || self.visibilities.iter().any(|&visibility| visibility == Visibility::Hidden)
    }

    /// Whether the entity is visible by its [`Visibility`] and those above it, and shares a layer with the camera.
    pub fn is_shown(&self, entity: Entity) -> bool {
        self.is_in(self.seen_layers(), entity)
    }

    fn is_in(&self, seen: Option<Layers>, entity: Entity) -> bool {
        self.is_visible(entity) && seen.is_none_or(|seen| self.layers_of(entity).share(seen))
    }

    fn is_visible(&self, entity: Entity) -> bool {
        let mut decided = self.upwards(entity).filter_map(|entity| match self.visibilities.get(entity) {
            Ok(Visibility::Hidden) => Some(false),
            Ok(Visibility::Visible) => Some(true),
            Ok(Visibility::Inherited) | Err(_) => None,
        });
        decided.next().unwrap_or(true)
    }

    /// Of the entity itself, or of the nearest one above it that has some.
    fn layers_of(&self, entity: Entity) -> Layers {
        self.upwards(entity).find_map(|entity| self.layers.get(entity).ok().copied()).unwrap_or_default()
    }

    /// The layers of the camera; `None` where nothing has any.
    fn seen_layers(&self) -> Option<Layers> {
        let of_camera = || self.cameras.current().map_or_else(|_| Layers::default(), |camera| self.layers_of(camera));
        (!self.layers.is_empty()).then(of_camera)
    }

    /// An entity and those above it.
    fn upwards(&self, entity: Entity) -> impl Iterator<Item = Entity> {
        core::iter::once(entity).chain(self.parents.iter_ancestors(entity)).take(HIGHEST)
    }
}

//! Visibility: a choice on an entity that everything below it inherits.

use bevy_ecs::component::Component;
use bevy_ecs::entity::Entity;
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::system::{Query, SystemParam};

/// Whether an object is drawn, a light shines. It holds for the entity and, unless they say otherwise, for all entities
/// below it in the hierarchy of [`ChildOf`]. An entity without it inherits. On cameras it has no meaning.
///
/// Hidden entities are as if they were not there: neither counted nor checked. The global ambient light stays.
/// [`Shown`] says what holds for an entity.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Visibility {
    /// As the nearest entity above that says [`Hidden`](Self::Hidden) or [`Visible`](Self::Visible); visible where
    /// there is none.
    #[default]
    Inherited,
    /// Hidden.
    Hidden,
    /// Visible, even where an entity above is hidden.
    Visible,
}

/// The most entities that [`Shown`] looks at on the way up, so that a hierarchy that runs in a circle comes to an end.
/// Ancestors farther above do not count.
const HIGHEST: usize = 10_000;

/// Tells which entities are hidden, as a parameter of a system.
///
/// It looks up the hierarchy when it is asked, so there is nothing to keep current.
#[derive(SystemParam)]
pub struct Shown<'w, 's> {
    visibilities: Query<'w, 's, &'static Visibility>,
    parents: Query<'w, 's, &'static ChildOf>,
}

impl Shown<'_, '_> {
    /// The same as [`is_shown`](Self::is_shown), for many entities: where nothing is [`Visibility::Hidden`], it looks
    /// at none of them.
    pub fn by_entity(&self) -> impl Fn(Entity) -> bool {
        let hides = self.hides_any();
        move |entity| !hides || self.is_shown(entity)
    }

    /// Whether any entity is [`Visibility::Hidden`]. If none is, all are shown.
    pub fn hides_any(&self) -> bool {
        self.visibilities.iter().any(|&visibility| visibility == Visibility::Hidden)
    }

    /// Whether the entity is visible by its [`Visibility`] and those above it.
    pub fn is_shown(&self, entity: Entity) -> bool {
        let upwards = core::iter::once(entity).chain(self.parents.iter_ancestors(entity)).take(HIGHEST);
        let mut decided = upwards.filter_map(|entity| match self.visibilities.get(entity) {
            Ok(Visibility::Hidden) => Some(false),
            Ok(Visibility::Visible) => Some(true),
            Ok(Visibility::Inherited) | Err(_) => None,
        });
        decided.next().unwrap_or(true)
    }
}

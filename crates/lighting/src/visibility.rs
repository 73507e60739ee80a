//! Visibility: a choice on an entity that everything below it inherits.

/// Whether an object is drawn, a light shines. It holds for the entity and, unless they say otherwise, for all entities
/// below it in the hierarchy of `ChildOf`. An entity without it inherits. On cameras it has no meaning.
///
/// Hidden entities are as if they were not there: neither counted nor checked. The global ambient light stays.
/// `Shown` says what holds for an entity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component))]
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

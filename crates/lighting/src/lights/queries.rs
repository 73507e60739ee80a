//! The lights of a world.

use bevy_ecs::entity::Entity;
use bevy_ecs::entity_disabling::Disabled;
use bevy_ecs::name::Name;
use bevy_ecs::query::{Added, Changed, Or, With};
use bevy_ecs::system::{Query, SystemParam};
use bevy_ecs::world::{EntityRef, EntityWorldMut};
use bevy_transform::components::GlobalTransform;

use super::{Kind, LightComponent};
use crate::shown::Shown;

/// The data of a light of one kind in a query.
type LightData<L> = (Entity, &'static L, &'static GlobalTransform, Option<&'static Name>);

macro_rules! light_queries {
    ($($(#[$meaning:meta])* $kind:ident $name:ident: $component:ident $source:ident $constant:literal;)*) => {
        impl LightComponent {
            /// Puts the component on an entity.
            pub fn insert_into(self, entity: &mut EntityWorldMut) {
                match self {
                    $(Self::$kind(light) => entity.insert(light)),*
                };
            }

            /// The light of an entity, if it has one.
            pub fn from_entity(entity: EntityRef) -> Option<Self> {
                let none = None;
                $(let none = none.or_else(|| entity.get::<super::$component>().map(|light| Self::$kind(*light)));)*
                none
            }

            /// Whether an entity has a light of this kind.
            pub fn is_kind_of(self, entity: EntityRef) -> bool {
                match self {
                    $(Self::$kind(_) => entity.contains::<super::$component>()),*
                }
            }
        }

        type AnyLight = Or<($(With<super::$component>,)*)>;
        type AnyLightChange = Or<($(Changed<super::$component>,)* Changed<GlobalTransform>)>;

        /// The lights of a world, as a parameter of a system.
        #[derive(SystemParam)]
        pub struct LightQueries<'w, 's> {
            $($name: Query<'w, 's, LightData<super::$component>>,)*
            changed: Query<'w, 's, (), (AnyLight, AnyLightChange)>,
            disabled: Query<'w, 's, (), (AnyLight, With<Disabled>, Added<Disabled>)>,
            shown: Shown<'w, 's>,
        }

        impl LightQueries<'_, '_> {
            /// How many entities have a light of each kind, shown or not.
            pub fn counts(&self) -> [usize; Kind::ALL.len()] {
                [$(self.$name.iter().len()),*]
            }

            /// Visits the lights that are shown in a fixed order, so that sums repeat: by kind, then by entity.
            pub fn visit(&self, mut visit: impl FnMut(Entity, Option<&Name>, LightComponent, &GlobalTransform)) {
                let is_shown = self.shown.by_entity();
                $({
                    let mut all: Vec<_> = self.$name.iter().filter(|(entity, ..)| is_shown(*entity)).collect();
                    all.sort_unstable_by_key(|(entity, ..)| *entity);
                    for (entity, light, at, name) in all {
                        visit(entity, name, LightComponent::$kind(*light), at);
                    }
                })*
            }
        }
    };
}

with_kinds!(light_queries);

impl LightQueries<'_, '_> {
    /// Whether a light or its transform has changed, or a light was disabled, since the system ran last. A light that
    /// was removed is missing from [`counts`](Self::counts).
    pub fn have_changed(&self) -> bool {
        !self.changed.is_empty() || !self.disabled.is_empty()
    }

    /// Whether anything in the world is hidden or in layers, and so perhaps a light.
    pub fn may_be_hidden(&self) -> bool {
        self.shown.hides_any()
    }
}

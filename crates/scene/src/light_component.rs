//! A light of whichever kind.

use bevy_ecs::world::EntityWorldMut;
use halfway_lighting::{DirectionalLight, PointLight, SpotLight};

/// One of the three light components, where a file decides which. It shines along its entity's local −Z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightComponent {
    /// Parallel rays.
    Directional(DirectionalLight),
    /// All directions.
    Point(PointLight),
    /// A cone.
    Spot(SpotLight),
}

impl LightComponent {
    /// Puts the component on an entity.
    pub fn insert_into(self, entity: &mut EntityWorldMut) {
        match self {
            Self::Directional(light) => entity.insert(light),
            Self::Point(light) => entity.insert(light),
            Self::Spot(light) => entity.insert(light),
        };
    }
}

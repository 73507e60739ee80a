//! Rigs: sets of lights that suit a model of any size, fixed to the camera.

use glam::Vec3;

use crate::choices::{Choice, Choices};
use crate::{DirectionalLight, HemisphereLight, LightComponent, LinearRgba};

/// A set of lights with a name, fixed to the camera, so that a model is lit alike from every side. Its lights have no
/// place, only directions, and suit models of any size.
///
/// ```
/// use halfway_lighting::{Choices, LightComponent, LightRig};
///
/// assert_eq!(LightRig::from_key("three_point"), Some(LightRig::ThreePoint));
/// let lights = LightRig::Headlight.lights();
/// let [(LightComponent::Directional(light), direction)] = lights[..] else { unreachable!() };
/// assert_eq!(direction, glam::Vec3::NEG_Z);
/// assert!(light.diffuse.red > 0.5);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LightRig {
    /// A key light from the upper left, a weak fill light from the right, a faint light from behind, and light from a
    /// sky and a floor, so that no side is black and edges stand out. The default.
    #[default]
    Studio,
    /// The photographer's three: a key light from the upper left, a fill light from the right, a back light from above.
    ThreePoint,
    /// One light from the camera: what faces the viewer is bright.
    Headlight,
}

impl Choices for LightRig {
    const CHOICES: &'static [Choice<Self>] = &[
        Choice {
            value: Self::Studio,
            key: "studio",
            name: "studio",
            meaning: "A key light, weak light from the right and from behind, and a sky over a floor.",
        },
        Choice {
            value: Self::ThreePoint,
            key: "three_point",
            name: "three-point",
            meaning: "A key light from the upper left, a fill light from the right, a back light from above.",
        },
        Choice { value: Self::Headlight, key: "headlight", name: "headlight", meaning: "One light from the camera." },
    ];
}

impl LightRig {
    /// The lights, each with the direction in which it shines in the camera's frame (+X is right, +Y up, −Z away from
    /// the viewer), of any length; of a [`HemisphereLight`] it is the direction toward the sky.
    pub fn lights(self) -> Vec<(LightComponent, Vec3)> {
        let directional = |[red, green, blue]: [f32; 3], shine: f32, direction: [f32; 3]| {
            let light = DirectionalLight {
                specular: LinearRgba::rgb(red * shine, green * shine, blue * shine),
                ..DirectionalLight::new(LinearRgba::rgb(red, green, blue))
            };
            (LightComponent::Directional(light), Vec3::from(direction))
        };
        match self {
            Self::Studio => {
                let sky = HemisphereLight {
                    sky: LinearRgba::rgb(0.14, 0.145, 0.16),
                    ground: LinearRgba::rgb(0.035, 0.032, 0.028),
                };
                vec![
                    directional([0.7, 0.68, 0.64], 1.0, [0.8, -0.9, -0.7]),
                    directional([0.07, 0.08, 0.1], 0.5, [-0.9, 0.1, -0.5]),
                    directional([0.3, 0.31, 0.33], 0.5, [-0.4, -0.5, 0.8]),
                    (LightComponent::Hemisphere(sky), Vec3::Y),
                ]
            }
            Self::ThreePoint => vec![
                directional([0.75, 0.73, 0.7], 1.0, [0.8, -0.7, -0.9]),
                directional([0.22, 0.23, 0.25], 0.3, [-0.9, -0.1, -0.7]),
                directional([0.5, 0.5, 0.5], 1.0, [-0.2, -0.9, 0.8]),
            ],
            Self::Headlight => vec![directional([0.8; 3], 0.6, [0.0, 0.0, -1.0])],
        }
    }

    /// Spawns the lights as children of a camera.
    ///
    /// ```
    /// use bevy_ecs::prelude::*;
    /// use halfway_lighting::{Camera, LightRig};
    ///
    /// fn scene(mut commands: Commands) {
    ///     let camera = commands.spawn(Camera::default()).id();
    ///     LightRig::Studio.spawn(camera, &mut commands);
    /// }
    ///
    /// let mut world = World::new();
    /// world.run_system_cached(scene).unwrap();
    /// world.flush();
    /// assert_eq!(world.query::<&ChildOf>().iter(&world).count(), LightRig::Studio.lights().len());
    /// ```
    #[cfg(feature = "ecs")]
    pub fn spawn(
        self,
        camera: bevy_ecs::entity::Entity,
        commands: &mut bevy_ecs::system::Commands,
    ) -> Vec<bevy_ecs::entity::Entity> {
        use bevy_ecs::hierarchy::ChildOf;
        use bevy_transform::components::Transform;
        use glam::Quat;

        let spawn = |(light, direction): (LightComponent, Vec3)| {
            let from = if matches!(light, LightComponent::Hemisphere(_)) { Vec3::Y } else { Vec3::NEG_Z };
            let place = Transform::from_rotation(Quat::from_rotation_arc(from, direction.normalize()));
            let entity = commands.spawn((place, ChildOf(camera))).id();
            commands.queue(move |world: &mut bevy_ecs::world::World| light.insert_into(&mut world.entity_mut(entity)));
            entity
        };
        self.lights().into_iter().map(spawn).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_rig_is_too_bright_for_a_surface_that_reflects_all() {
        for choice in LightRig::CHOICES {
            let most = |light: &LightComponent| match light {
                LightComponent::Directional(light) => light.diffuse.red,
                LightComponent::Hemisphere(light) => light.sky.red,
                _ => f32::NAN,
            };
            let toward = |direction: &Vec3| if direction.z < 0.0 { 1.0 } else { 0.0 };
            let lights = choice.value.lights();
            let sum: f32 = lights.iter().map(|(light, direction)| most(light) * toward(direction)).sum();
            assert!((0.5..=1.0).contains(&sum), "{}: {sum}", choice.key);
        }
    }
}

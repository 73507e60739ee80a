//! The component that lights a scene by an environment.

use bevy_ecs::component::Component;
use halfway_asset::Handle;

use super::drawn::EnvironmentMap;

/// Lights everything from all directions, and shows where it comes from behind everything.
///
/// For a normal n, a direction v toward the viewer and the exponent α of Phong's lobe (β/4 of a Blinn–Phong exponent β)
/// it adds
///
/// ```text
/// I += o·kd·s·E(n) + ks·s·L(2(n·v)n − v, α)
/// ```
///
/// E is the mean light that a matt surface receives, by nine harmonics; L the light around the mirrored direction, from
/// the level whose texels are as wide as the lobe; s the strength; o what an image of occlusion has there. Colors and
/// images multiply kd, and images ks, as they do for lights. It is evaluated at each fragment, whatever the shading;
/// under flat shading with the triangle's normal.
///
/// A scene has one: of more the one of the first entity counts, and the renderer says so.
/// [`TexturePlugin`](crate::TexturePlugin) registers it.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct EnvironmentLight {
    /// The light; while it is not there [`EnvironmentMap::missing`] is.
    pub map: Handle<EnvironmentMap>,
    /// s: multiplies all of it, 0 to 10⁶. Default 1.
    pub strength: f32,
    /// The environment is turned by this around +Y, in radians, counter-clockwise as seen from above. Default 0.
    pub rotation: f32,
    /// Whether it is seen where nothing is drawn, in place of the camera's background. Default true.
    pub sky: bool,
}

impl From<Handle<EnvironmentMap>> for EnvironmentLight {
    fn from(map: Handle<EnvironmentMap>) -> Self {
        Self { map, strength: 1.0, rotation: 0.0, sky: true }
    }
}

/// A number of an [`EnvironmentLight`] that cannot be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrongEnvironment {
    /// Its name.
    pub field: &'static str,
    /// The number.
    pub value: f32,
    /// Those that can be used, in words.
    pub expected: &'static str,
}

impl EnvironmentLight {
    /// The first of its numbers that cannot be used.
    pub fn wrong(&self) -> Option<WrongEnvironment> {
        if !(0.0..=1e6).contains(&self.strength) {
            return Some(WrongEnvironment { field: "strength", value: self.strength, expected: "0 to 1000000" });
        }
        let rotation = self.rotation;
        (!rotation.is_finite()).then_some(WrongEnvironment {
            field: "rotation",
            value: rotation,
            expected: "a finite number",
        })
    }

    /// The rows of the rotation from the world to the environment.
    pub fn environment_from_world(&self) -> [[f64; 3]; 3] {
        let angle = f64::from(self.rotation);
        let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
        [[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]]
    }
}

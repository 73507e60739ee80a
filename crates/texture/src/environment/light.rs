//! The component that lights a scene by an environment.

use bevy_ecs::component::Component;
use halfway_asset::Handle;

use super::drawn::EnvironmentMap;

/// Lights everything from all directions, and shows the environment as the background.
///
/// For a normal n, a direction v toward the viewer and the exponent α of Phong's lobe (β/4 of a Blinn–Phong exponent β)
/// it adds
///
/// ```text
/// I += o·kd·s·E(n) + ks·s·L(2(n·v)n − v, α)
/// ```
///
/// E is the diffuse light by nine harmonics; L the light around the mirrored direction, from the level whose texels are
/// as wide as the lobe; s the strength; o the value of an occlusion map. Colors and images multiply kd, and images ks,
/// as they do for lights. It is evaluated at each fragment, whatever the shading; under flat shading with the
/// triangle's normal.
///
/// A scene has one: of several, that of the first entity is used, and the renderer warns.
/// [`TexturePlugin`](crate::TexturePlugin) registers it.
///
/// ```
/// use bevy_app::App;
/// use halfway_asset::Assets;
/// use halfway_texture::TexturePlugin;
/// use halfway_texture::environment::{Environment, EnvironmentLight, EnvironmentMap, EnvironmentShape};
///
/// let mut app = App::new();
/// app.add_plugins(TexturePlugin);
/// let overcast = Environment::from_fn(EnvironmentShape::Cube, 8, |_| [0.6, 0.7, 0.8, 1.0])?;
/// let map = EnvironmentMap::new(&overcast)?;
/// let map = app.world_mut().resource_mut::<Assets<EnvironmentMap>>().add(map);
/// app.world_mut().spawn(EnvironmentLight { strength: 0.5, ..EnvironmentLight::from(map) });
/// # Ok::<(), halfway_texture::TextureError>(())
/// ```
#[derive(Component, Clone, Debug, PartialEq)]
pub struct EnvironmentLight {
    /// The light; until the asset exists, [`EnvironmentMap::missing`] is drawn.
    pub map: Handle<EnvironmentMap>,
    /// s: multiplies all light of the environment, 0 to 10⁶. Default 1.
    pub strength: f32,
    /// The rotation of the environment around +Y, in radians, counter-clockwise as seen from above. Default 0.
    pub rotation: f32,
    /// Whether it is visible as the sky, in place of the camera's background. Default true.
    pub sky: bool,
}

impl From<Handle<EnvironmentMap>> for EnvironmentLight {
    fn from(map: Handle<EnvironmentMap>) -> Self {
        Self { map, strength: 1.0, rotation: 0.0, sky: true }
    }
}

/// An invalid field of an [`EnvironmentLight`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrongEnvironment {
    /// Its name.
    pub field: &'static str,
    /// Its value.
    pub value: f32,
    /// The valid values, in words.
    pub expected: &'static str,
}

impl EnvironmentLight {
    /// The first invalid field.
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

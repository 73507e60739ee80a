//! The plugin.

use bevy_app::{App, Plugin};

use crate::{
    BackMaterial, Blend, Camera, DirectionalLight, Faces, GlobalAmbient, Mask, Material, PointLight, Reflectance,
    Shading, SpotLight, Terms, Tolerance, VertexColors, ViewTolerance, Visibility,
};

/// Puts the resources of lighting into an [`App`]: [`GlobalAmbient`] and [`ViewTolerance`] with their defaults, unless
/// they are there already; and registers the components for reflection.
///
/// Works alone; drawing is another plugin's work. May be added more than once.
#[derive(Clone, Copy, Debug, Default)]
pub struct LightingPlugin;

impl Plugin for LightingPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<GlobalAmbient>()
            .init_resource::<ViewTolerance>()
            .register_type::<ViewTolerance>()
            .register_type::<Tolerance>()
            .register_type::<GlobalAmbient>()
            .register_type::<PointLight>()
            .register_type::<SpotLight>()
            .register_type::<DirectionalLight>()
            .register_type::<Material>()
            .register_type::<BackMaterial>()
            .register_type::<Camera>()
            .register_type::<Shading>()
            .register_type::<Terms>()
            .register_type::<Reflectance>()
            .register_type::<Faces>()
            .register_type::<Blend>()
            .register_type::<Mask>()
            .register_type::<VertexColors>()
            .register_type::<Visibility>();
    }

    fn is_unique(&self) -> bool {
        false
    }
}

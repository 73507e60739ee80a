//! What puts an image onto a surface.

use bevy_app::{App, Plugin};
use bevy_asset::{Asset, AssetApp, AssetEvent, AssetPlugin, AssetServer, Assets, Handle};
use bevy_ecs::component::Component;
use bevy_ecs::message::Messages;
use bevy_ecs::reflect::ReflectComponent;
use bevy_reflect::{Reflect, TypePath};

use crate::pyramid::Pyramid;
use crate::sampling::Sampling;
use crate::texels::TexelImage;
use crate::uv::UvTransform;

/// An image with its pyramid, as an asset. Its clones share their texels.
#[derive(Asset, TypePath, Clone, Debug, PartialEq)]
pub struct Texture(pub Pyramid);

impl Texture {
    /// What stands for an image that is missing or broken: [`Pyramid::missing`].
    pub fn missing() -> Self {
        Self(Pyramid::missing())
    }
}

impl From<TexelImage> for Texture {
    fn from(image: TexelImage) -> Self {
        Self(Pyramid::new(image))
    }
}

/// An image on an object, whose color multiplies the ambient and the diffuse reflectance at each fragment, and whose alpha
/// multiplies the opacity where the object is blended; on both sides, by the mesh's texture coordinates. What the filter makes
/// of the texels is taken into 0 to 1.
///
/// Under Gouraud and flat shading the terms that the color multiplies and the specular ones are interpolated apart, so that
/// highlights keep their color. An object whose mesh has no texture coordinates is drawn without it.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component, Clone, Debug, PartialEq)]
pub struct ColorMap {
    /// The image. While it is not there, [`Pyramid::missing`] is drawn.
    pub texture: Handle<Texture>,
    /// How it is looked up.
    pub sampling: Sampling,
    /// Where on it the mesh's texture coordinates lie.
    pub transform: UvTransform,
}

impl From<Handle<Texture>> for ColorMap {
    fn from(texture: Handle<Texture>) -> Self {
        Self { texture, sampling: Sampling::default(), transform: UvTransform::default() }
    }
}

/// Registers [`Texture`] as an asset, and [`ColorMap`] for reflection. May be added late and more than once: textures that
/// the app has already stay. Adds `bevy_asset`'s `AssetPlugin` where the app does not have it yet.
#[derive(Clone, Copy, Debug, Default)]
pub struct TexturePlugin;

impl Plugin for TexturePlugin {
    fn build(&self, app: &mut App) {
        if !app.world().contains_resource::<AssetServer>() {
            app.add_plugins(AssetPlugin::default());
        }
        app.register_type::<ColorMap>();
        // As of meshes: `init_asset` replaces what is there.
        if !app.world().contains_resource::<Messages<AssetEvent<Texture>>>() {
            let early = app.world_mut().remove_resource::<Assets<Texture>>();
            app.init_asset::<Texture>();
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

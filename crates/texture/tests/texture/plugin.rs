//! The plugin, added late and again.

use bevy_app::App;
use halfway_asset::{Assets, Handle};
use halfway_texture::environment::EnvironmentMap;
use halfway_texture::{Texture, TexturePlugin};

fn is_there<T: Send + Sync + 'static>(app: &App, handle: &Handle<T>) -> bool {
    app.world().resource::<Assets<T>>().get(handle).is_some()
}

fn add<T: Send + Sync + 'static>(app: &mut App, asset: T) -> Handle<T> {
    app.world_mut().resource_mut::<Assets<T>>().add(asset)
}

/// For one kind of asset: assets from before the plugin stay, and those without a handle are removed.
fn stays<T: Send + Sync + 'static>(make: impl Fn() -> T) {
    let mut app = App::new();
    // The app had assets before any plugin.
    app.init_resource::<Assets<T>>();
    let early = add(&mut app, make());
    app.add_plugins(TexturePlugin);
    let second = add(&mut app, make());
    assert_ne!(early, second);
    app.add_plugins(TexturePlugin);
    app.update();
    app.add_plugins((TexturePlugin, TexturePlugin));
    app.update();
    assert!(is_there(&app, &early) && is_there(&app, &second));

    let id = early.id();
    drop(early);
    app.update();
    app.update();
    assert!(app.world().resource::<Assets<T>>().get(id).is_none() && is_there(&app, &second));
}

#[test]
fn adding_the_plugin_again_keeps_assets() {
    stays(Texture::missing);
    stays(EnvironmentMap::missing);
}

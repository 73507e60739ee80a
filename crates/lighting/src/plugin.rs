//! The plugin.

use bevy_app::{App, Plugin};

use crate::{GlobalAmbient, ViewTolerance};

/// Puts the resources of lighting into an [`App`]: [`GlobalAmbient`] and [`ViewTolerance`] with their defaults, unless
/// they are there already.
///
/// Works alone; drawing is another plugin's work. May be added more than once.
#[derive(Clone, Copy, Debug, Default)]
pub struct LightingPlugin;

impl Plugin for LightingPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<GlobalAmbient>().init_resource::<ViewTolerance>();
    }

    fn is_unique(&self) -> bool {
        false
    }
}

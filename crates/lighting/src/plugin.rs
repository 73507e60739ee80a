//! The plugin.

use bevy_app::{App, Plugin};

use crate::GlobalAmbient;

/// Puts the resources of lighting into an [`App`]: [`GlobalAmbient`] with its default, unless one is there already.
///
/// Works alone; drawing is another plugin's work.
#[derive(Clone, Copy, Debug, Default)]
pub struct LightingPlugin;

impl Plugin for LightingPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<GlobalAmbient>();
    }
}

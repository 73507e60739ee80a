//! The plugin group.

use bevy_app::{App, Plugin, PluginGroup, PluginGroupBuilder, TaskPoolPlugin};
use bevy_math::UVec2;
use bevy_time::TimePlugin;
use bevy_transform::TransformPlugin;
use halfway_lighting::LightingPlugin;
use halfway_mesh::MeshPlugin;
use halfway_render::RenderPlugin;
use halfway_scene::AnimationPlugin;
use halfway_texture::TexturePlugin;

use crate::demo::Demo;
use halfway_record::HeadlessPlugin;

/// Everything that a lit scene needs: tasks, assets, time, transforms, meshes, lighting, rendering, animations of scene
/// files, and a window where the feature `window` is on. Each plugin also works alone.
///
/// The group does not replace plugins of bevy that the app already has: add your own before the group.
///
/// Without a window: [`HalfwayPlugins::headless`]. Without a renderer: [`HalfwayPlugins::reference`]. As a demo that
/// takes its target from the command line: [`HalfwayPlugins::from_args`].
#[derive(Clone, Copy, Debug, Default)]
pub struct HalfwayPlugins;

impl PluginGroup for HalfwayPlugins {
    fn build(self) -> PluginGroupBuilder {
        let group = Self::common();
        #[cfg(feature = "window")]
        let group = group.add(halfway_window::WindowPlugin::default());
        group
    }
}

impl HalfwayPlugins {
    /// The group without a window: pictures of `size` pixels, to be drawn with
    /// [`render_picture`](halfway_render::render_picture) or [`record`](halfway_record::record).
    pub fn headless(size: UVec2) -> PluginGroupBuilder {
        Self::common().add(HeadlessPlugin { size })
    }

    /// The group without a renderer, for scenes that only the [`Oracle`](halfway_reference::Oracle) draws. No graphics
    /// adapter is needed.
    ///
    /// ```
    /// use halfway::prelude::*;
    /// use halfway::reference::{Oracle, OracleError};
    ///
    /// fn main() -> Result<(), OracleError> {
    ///     let mut app = App::new();
    ///     app.add_plugins(HalfwayPlugins::reference()).add_systems(Startup, scene);
    ///     // One frame spawns the scene and puts everything in its place.
    ///     app.update();
    ///     let picture = Oracle::new(app.world_mut(), UVec2::new(64, 48))?.draw();
    ///     let [red, _, blue] = picture.pixel(32, 24);
    ///     assert!(red > 0.1 && red > blue);
    ///     Ok(())
    /// }
    ///
    /// fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
    ///     commands.spawn((Camera::default(), Transform::from_xyz(0.0, 0.0, 4.0)));
    ///     commands.spawn((Mesh3d(meshes.add(UvSphere::default())), Material::BRASS));
    ///     commands.spawn((PointLight::white(), Transform::from_xyz(0.0, 1.0, 4.0)));
    /// }
    /// ```
    pub fn reference() -> PluginGroupBuilder {
        PluginGroupBuilder::start::<Self>()
            .add(FoundationPlugin)
            .add(MeshPlugin)
            .add(LightingPlugin)
            .add(TexturePlugin)
            .add(AnimationPlugin)
    }

    /// The group for a demo program: a window, or, with `--headless OUT.png` on the command line, pictures on disk.
    ///
    /// | argument | meaning |
    /// |---|---|
    /// | `--headless FILE` | draw without a window and write FILE: a PNG or EXR, an animated PNG with `--frames` |
    /// | `--frames N` | draw N frames, 30 a second; 1 unless given |
    /// | `--size WxH` | pixels; 1280x720 unless given |
    /// | `--contact-sheet FILE` | write up to 16 of the frames, small, on one PNG |
    /// | `--model FILE` | left to the program |
    /// | `--help` | print these and stop |
    ///
    /// Arguments that are not understood are refused: the App then draws nothing, [`App::run`](bevy_app::App::run)
    /// prints what is wrong, and the exit code is 2.
    pub fn from_args() -> PluginGroupBuilder {
        match Demo::from_args() {
            Demo::Window => Self.build(),
            Demo::Record(recording) => Self::common().add(recording),
            Demo::Stop(stop) => Self::common().add(stop),
        }
    }

    fn common() -> PluginGroupBuilder {
        Self::reference().add(RenderPlugin::default())
    }
}

/// The plugins of bevy that a scene needs: tasks, time and transforms, each with its defaults unless the app has
/// it already.
#[derive(Clone, Copy, Debug, Default)]
struct FoundationPlugin;

impl Plugin for FoundationPlugin {
    fn build(&self, app: &mut App) {
        fn add_missing<P: Plugin + Default>(app: &mut App) {
            if !app.is_plugin_added::<P>() {
                app.add_plugins(P::default());
            }
        }
        add_missing::<TaskPoolPlugin>(app);
        add_missing::<TimePlugin>(app);
        add_missing::<TransformPlugin>(app);
    }
}

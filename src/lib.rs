//! Classic local lighting and shading as plugins for ECS apps.
//!
//! Flat, Gouraud and Phong shading with Phong and Blinn–Phong reflectance, for point, spot, directional
//! and ambient lights, in any `bevy_app` App, on wgpu, in a window or without one:
//!
//! ```no_run
//! use halfway::prelude::*;
//!
//! fn main() -> AppExit {
//!     App::new().add_plugins(HalfwayPlugins).add_systems(Startup, scene).run()
//! }
//!
//! fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
//!     commands.spawn((Camera::default(), Transform::from_xyz(0.0, 2.0, 6.0).looking_at(Vec3::ZERO, Vec3::Y)));
//!     commands.spawn((Mesh3d(meshes.add(Teapot::new(8))), Material::BRASS, Shading::Phong));
//!     commands.spawn((PointLight::white(), Transform::from_xyz(2.0, 3.0, 2.0)));
//! }
//! ```
//!
//! The same App draws without a window: [`HalfwayPlugins::headless`] and [`render_picture`](render::render_picture)
//! for one picture, [`record`] for many. [`scene`] reads scene files. This crate holds the [`prelude`] and the group of
//! plugins; all else is re-exported from crates of one subject each: [`mesh`], [`texture`], [`asset`], [`lighting`],
//! [`scene`], [`render`], [`mod@reference`], [`record`], [`output`] and, with the feature `window`, `window`.

pub mod beside_bevy;
pub mod prelude;

mod demo;
mod plugins;

pub use plugins::HalfwayPlugins;

pub use halfway_asset as asset;
pub use halfway_lighting as lighting;
pub use halfway_mesh as mesh;
pub use halfway_record as record;
pub use halfway_record::output;
pub use halfway_reference as reference;
pub use halfway_render as render;
pub use halfway_scene as scene;
pub use halfway_texture as texture;
#[cfg(feature = "window")]
pub use halfway_window as window;

/// The README's code and the guide's, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
#[doc = include_str!("../docs/guide.md")]
struct Pages;

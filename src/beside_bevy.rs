//! Names for use beside bevy's prelude.
//!
//! halfway and bevy both have a `Mesh`, a `Camera` and a `PointLight`, and a name that two globs import cannot be used.
//! In a program with bevy's prelude, import this module instead of [`prelude`](crate::prelude): it gives types that
//! share a name with one of bevy's the prefix `Halfway`.
//!
//! ```
//! // use bevy::prelude::*;
//! use bevy_app::{App, Startup};
//! use bevy_ecs::prelude::*;
//! use bevy_transform::components::Transform;
//! use halfway::beside_bevy::*;
//!
//! fn scene(mut commands: Commands, mut meshes: ResMut<HalfwayAssets<HalfwayMesh>>) {
//!     commands.spawn((HalfwayCamera::default(), Transform::from_xyz(0.0, 0.0, 5.0)));
//!     commands.spawn((HalfwayMesh3d(meshes.add(Teapot::new(2))), HalfwayMaterial::BRASS, Shading::Phong));
//!     commands.spawn((HalfwayPointLight::white(), Transform::from_xyz(2.0, 3.0, 2.0)));
//! }
//!
//! let mut app = App::new();
//! app.add_plugins(HalfwayPlugins::reference()).add_systems(Startup, scene).update();
//! ```
//!
//! The types of `bevy_app`, `bevy_ecs`, `bevy_color`, `bevy_math`, `bevy_time` and `bevy_transform` are bevy's own if
//! bevy has the same version.

pub use crate::HalfwayPlugins;
pub use halfway_asset::{Assets as HalfwayAssets, Handle as HalfwayHandle};
pub use halfway_lighting::{
    AlphaMode as HalfwayAlphaMode, Attenuation, BackMaterial, Camera as HalfwayCamera, Cone as HalfwayCone,
    DirectionalLight as HalfwayDirectionalLight, Encoding, Faces, Frequency, GlobalAmbient, Intensity, Layers,
    LightingPlugin, Material as HalfwayMaterial, PointLight as HalfwayPointLight, Reflectance, Samples, Shading,
    SpotLight as HalfwaySpotLight, Terms, Tolerance, VertexColors, ViewTolerance, Viewer, Viewport as HalfwayViewport,
    Visibility as HalfwayVisibility,
};
pub use halfway_mesh::{
    Cuboid as HalfwayCuboid, Mesh as HalfwayMesh, Mesh3d as HalfwayMesh3d, MeshPlugin as HalfwayMeshPlugin,
    Plane as HalfwayPlane, Teapot, UvSphere,
};
pub use halfway_record::output::SavePicture;
pub use halfway_render::{
    FrameReport, Headless, Picture, Pixels, RenderError, RenderPlugin as HalfwayRenderPlugin, RenderSet,
    render_picture, take_picture,
};
pub use halfway_scene::{ModelParts, ModelRoot, spawn_model};
pub use halfway_texture::{
    MapKind, Maps, Sampling, SolidKind, SolidTexture, SurfaceMap, Texture as HalfwayTexture,
    TexturePlugin as HalfwayTexturePlugin,
};
#[cfg(feature = "window")]
pub use halfway_window::{
    OrbitCamera, OrbitCameraPlugin, ViewerKeysPlugin, WindowPlugin as HalfwayWindowPlugin, WindowTitle,
};

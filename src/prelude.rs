//! All names for a scene in code: `use halfway::prelude::*`.
//!
//! It holds bevy's derives, too: `#[derive(Component)]` and `#[derive(Resource)]` work in a package that depends on
//! halfway alone, since the prelude brings the crates that they name, `bevy_ecs` and `bevy_app`, into the module.
//! (`#[derive(Reflect)]` is not among them: halfway does without reflection.)
//!
//! Beside bevy's own prelude, which has a `Mesh` and a `Camera` of its own, use [`beside_bevy`](crate::beside_bevy).

pub use crate::HalfwayPlugins;
pub use bevy_app::{self, prelude::*};
pub use bevy_color::{Color, ColorToComponents as _, Gray as _, LinearRgba, Srgba};
pub use bevy_ecs::{self, prelude::*};
pub use bevy_math::{DMat4, DVec3, EulerRot, Mat3, Mat4, Quat, UVec2, Vec2, Vec3, Vec4};
pub use bevy_time::{Fixed, Real, Time, Virtual};
pub use bevy_transform::prelude::{GlobalTransform, Transform, TransformPlugin};
pub use halfway_asset::{Assets, Handle};
pub use halfway_lighting::{
    AlphaMode, Attenuation, BackMaterial, Camera, Cone, DirectionalLight, Encoding, Faces, Film, Frequency,
    GlobalAmbient, HemisphereLight, Intensity, Layers, LightingPlugin, Load, Material, Origin, PointLight, Projection,
    Reflectance, Samples, Shading, SpotLight, Terms, Tolerance, VertexColors, ViewTolerance, Viewer, Viewport,
    Visibility,
};
pub use halfway_mesh::{Cuboid, Lines, Lines3d, Mesh, Mesh3d, MeshPlugin, Plane, Teapot, UvSphere};
pub use halfway_record::output::SavePicture;
#[cfg(feature = "wgpu")]
pub use halfway_render::Compile;
pub use halfway_render::{
    FrameReport, Headless, Picture, Pixels, Quantity, QuantityImage, QuantityValues, RenderError, RenderPlugin,
    RenderSet, Surfaces, render_picture, take_picture, take_quantities,
};
pub use halfway_scene::import::{ModelMaterial, model_light};
pub use halfway_scene::{ModelParts, ModelRoot, spawn_model};
pub use halfway_texture::{MapKind, Maps, Sampling, SolidKind, SolidTexture, SurfaceMap, Texture, TexturePlugin};
#[cfg(feature = "window")]
pub use halfway_window::{OrbitCamera, OrbitCameraPlugin, ViewerKeysPlugin, WindowPlugin, WindowTitle};

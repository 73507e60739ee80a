//! What a scene in code needs, in one `use`.

pub use crate::HalfwayPlugins;
pub use bevy_app::prelude::*;
pub use bevy_color::{Color, ColorToComponents as _, Gray as _, LinearRgba, Srgba};
pub use bevy_ecs::prelude::*;
pub use bevy_math::{EulerRot, Mat3, Mat4, Quat, UVec2, Vec2, Vec3, Vec4};
pub use bevy_time::{Fixed, Real, Time, Virtual};
pub use bevy_transform::prelude::{GlobalTransform, Transform, TransformPlugin};
pub use halfway_asset::{Assets, Handle};
pub use halfway_lighting::{
    Attenuation, BackMaterial, Blend, Camera, Cone, DirectionalLight, Encoding, Faces, Frequency, GlobalAmbient,
    Intensity, LightingPlugin, Mask, Material, PointLight, Projection, Reflectance, Samples, Shading, SpotLight, Terms,
    Tolerance, VertexColors, ViewTolerance, Viewer, Visibility,
};
pub use halfway_mesh::{Cuboid, Mesh, Mesh3d, MeshPlugin, Plane, Teapot, UvSphere};
pub use halfway_render::{Compile, FrameReport, Headless, Picture, Pixels, RenderPlugin, RenderSet, render_picture};
pub use halfway_scene::import::{ModelMaterial, model_light};
pub use halfway_texture::{MapKind, Maps, Sampling, SolidKind, SolidTexture, SurfaceMap, Texture, TexturePlugin};
#[cfg(feature = "window")]
pub use halfway_window::{OrbitCamera, OrbitCameraPlugin, ViewerKeysPlugin, WindowPlugin, WindowTitle};

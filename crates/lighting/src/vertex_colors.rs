//! The use of the colours at the vertices of a mesh.

/// The use that an object makes of the colours at the vertices of its mesh. It has no effect on a mesh without them.
///
/// A colour is linear RGB and an opacity, each taken into 0 to 1 as glTF 2.0 §3.7.2.1 has it for `COLOR_0`. Emission
/// and specular reflectance are the material's alone.
///
/// - Gouraud: each vertex is shaded with its own colour; intensities are interpolated, and so is the opacity.
/// - Phong: the colour is interpolated, perspective-correctly, to each fragment.
/// - Flat: the mean of the three corners' colours, at the centroid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component))]
pub enum VertexColors {
    /// They multiply the ambient and diffuse reflectance, and the opacity where the object is blended
    /// ([`AlphaMode`](crate::AlphaMode)); on both sides.
    #[default]
    Multiply,
    /// They do nothing, and cost nothing.
    Ignore,
}

//! Lines that explain a scene.

/// Lines that explain a scene, as a component of the camera: axes, normals, lights, the ground. Default: none.
///
/// Their lengths follow the scene: d is the diagonal of the box around all that is shown.
///
/// ```
/// use bevy_ecs::world::World;
/// use halfway_lighting::{Camera, Show};
///
/// let mut world = World::new();
/// world.spawn((Camera::default(), Show { axes: true, grid: true, ..Show::default() }));
/// ```
///
/// They are drawn as [`LineStyle`](crate::LineStyle) says of lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component))]
#[expect(clippy::struct_excessive_bools, reason = "each is shown or not, whatever the others are")]
pub struct Show {
    /// The axes of the world: x red, y green, z blue. They start at its origin or, where that is farther than d from the
    /// scene, at the scene's lowest corner, and reach past the scene by d/10. Behind surfaces they are dashed.
    pub axes: bool,
    /// The normals of vertices, light blue; as long as the edges of the mesh are in the mean, from d/200 to d/20.
    pub normals: bool,
    /// The normals of triangles, orange, as long as those of vertices.
    pub face_normals: bool,
    /// The lights, over everything, in their own colours made as bright as can be. Point lights are stars of d/25; spot
    /// lights stars with their cone, d/4 long; directional lights arrows toward the middle of the scene; hemisphere
    /// lights a short arrow from the sky and one from the ground.
    pub lights: bool,
    /// A grid on the ground, the plane through the lowest point of the scene, across the axis that is nearest to the
    /// camera's [`Upright`](crate::Upright). Its spacing is 1, 2 or 5 times a power of ten, the least that makes 20 squares
    /// or fewer along the scene.
    pub grid: bool,
}

impl Show {
    /// The names of what can be shown, in scene files and, with `-` for `_`, on the command line.
    pub const NAMES: [&'static str; 5] = ["axes", "normals", "face_normals", "lights", "grid"];

    /// Whether something of this name is shown; `None` for a name that is not one of [`NAMES`](Self::NAMES).
    pub fn named(&mut self, name: &str) -> Option<&mut bool> {
        Some(match name {
            "axes" => &mut self.axes,
            "normals" => &mut self.normals,
            "face_normals" => &mut self.face_normals,
            "lights" => &mut self.lights,
            "grid" => &mut self.grid,
            _ => return None,
        })
    }

    /// Whether anything is shown.
    pub fn any(&self) -> bool {
        self.axes || self.normals || self.face_normals || self.lights || self.grid
    }
}

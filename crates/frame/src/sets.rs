//! The steps of a frame.

use bevy_ecs::prelude::SystemSet;

/// The steps of a frame, in order. Each says what holds after it.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RenderSet {
    /// The adapter is open, the camera is validated, [`View`](crate::view::camera::View) holds its matrices and projection, and there
    /// is something to draw into.
    View,
    /// [`Visible`](crate::view::select::Visible) holds the objects that the frustum sees; their
    /// [`ModelView`](crate::view::matrices::ModelView) and [`NormalMatrix`](crate::view::matrices::NormalMatrix) are
    /// current.
    Select,
    /// The [`Shading`](halfway_lighting::Shading) of every visible object can be drawn, and its mesh is in patches laid
    /// out for it.
    Choose,
    /// [`Lights`](crate::lights::gather::Lights) holds the lights in eye space; each visible object has a level of detail, and each of
    /// its patches that is seen has its light lists.
    Illuminate,
    /// Turns those patches into draws: sorted, equal ones instanced, and those with the same state together.
    Batch,
    /// The adapter has the data that the draws read: meshes, pipelines, instances, materials, lights and their lists.
    Upload,
    /// The passes are encoded and submitted, or drawn by the CPU.
    Draw,
    /// The picture is presented on the surface, or readable from the headless target.
    Deliver,
}

impl RenderSet {
    /// All of them, in the order of a frame.
    pub const ALL: [Self; 8] = [
        Self::View,
        Self::Select,
        Self::Choose,
        Self::Illuminate,
        Self::Batch,
        Self::Upload,
        Self::Draw,
        Self::Deliver,
    ];

    /// Its name as it is written in code.
    pub const fn name(self) -> &'static str {
        match self {
            Self::View => "View",
            Self::Select => "Select",
            Self::Choose => "Choose",
            Self::Illuminate => "Illuminate",
            Self::Batch => "Batch",
            Self::Upload => "Upload",
            Self::Draw => "Draw",
            Self::Deliver => "Deliver",
        }
    }
}

//! The steps of a frame.

use bevy_ecs::prelude::SystemSet;

/// The steps of a frame, in order. Each says what holds after it.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RenderSet {
    /// The adapter is open, the camera is validated, and [`View`](crate::View) holds its matrices and projection.
    View,
    /// [`Visible`](crate::Visible) holds the objects that the frustum sees.
    Select,
    /// [`ModelView`](crate::ModelView) and [`NormalMatrix`](crate::NormalMatrix) of every visible object are current.
    Matrices,
    /// [`Lights`](crate::Lights) holds the lights in eye space.
    Illuminate,
    /// [`Chosen`](crate::Chosen) holds each visible object's shading frequencies.
    Choose,
    /// Draws are sorted, and equal ones are instanced.
    Batch,
    /// What changed is on the GPU, and so are the pipelines of the draws.
    Upload,
    /// The passes are encoded and submitted.
    Draw,
    /// The picture is presented on the surface, or readable from the headless target.
    Deliver,
}

impl RenderSet {
    /// All of them, in the order of a frame.
    pub const ALL: [Self; 9] = [
        Self::View,
        Self::Select,
        Self::Matrices,
        Self::Illuminate,
        Self::Choose,
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
            Self::Matrices => "Matrices",
            Self::Illuminate => "Illuminate",
            Self::Choose => "Choose",
            Self::Batch => "Batch",
            Self::Upload => "Upload",
            Self::Draw => "Draw",
            Self::Deliver => "Deliver",
        }
    }
}

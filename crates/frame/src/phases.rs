//! The phases of a view, and how much a pass draws in one.

/// The phases of a view, in the order in which they are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Phase {
    /// The environment behind everything.
    Sky,
    /// The objects that hide what is behind them.
    Opaque,
    /// The objects that are blended over the picture, the farthest first.
    Blended,
    /// The passes of the App's own, over the scene and with its depth.
    Over,
    /// The camera's intensity policy, over the finished picture.
    Policy,
}

impl Phase {
    /// All of them, in order.
    pub const ALL: [Self; 5] = [Self::Sky, Self::Opaque, Self::Blended, Self::Over, Self::Policy];
}

/// The draws and triangles of a pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PassCounts {
    /// Draw commands. Of a policy: the times that the picture is passed over.
    pub draws: u32,
    /// Triangles of meshes in those draws. The sky and a policy have none.
    pub triangles: u64,
}

/// One pass of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pass {
    /// Its place in the order.
    pub phase: Phase,
    /// Its draws and triangles.
    pub counts: PassCounts,
}

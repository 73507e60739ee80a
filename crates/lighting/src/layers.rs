//! Layers: which objects and lights a camera sees.

/// The layers that an object, a light or a camera belongs to, of 32 with the numbers 0 to 31. A camera draws the objects,
/// and is lit by the lights, that share a layer with it.
///
/// It holds for the entity and for all entities below it in the hierarchy of `ChildOf` that have none of their own. Without
/// it an entity belongs to layer 0. The global ambient light is in all layers.
///
/// ```
/// use halfway_lighting::Layers;
///
/// let marks = Layers::layer(3);
/// let camera = Layers::default().and(3);
/// assert!(camera.share(marks) && camera.share(Layers::default()) && !marks.share(Layers::default()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component))]
pub struct Layers(
    /// A bit for each layer: bit n stands for layer n.
    pub u32,
);

impl Layers {
    /// The number of layers.
    pub const COUNT: u32 = u32::BITS;

    /// One layer; none, if the number is above 31.
    pub const fn layer(number: u32) -> Self {
        Self(if number < Self::COUNT { 1 << number } else { 0 })
    }

    /// The same layers and one more.
    #[must_use]
    pub const fn and(self, number: u32) -> Self {
        Self(self.0 | Self::layer(number).0)
    }

    /// Whether there is a layer that both belong to.
    pub const fn share(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// The numbers of its layers, ascending.
    pub fn numbers(self) -> impl Iterator<Item = u32> {
        (0..Self::COUNT).filter(move |&number| self.share(Self::layer(number)))
    }
}

impl Default for Layers {
    /// Layer 0.
    fn default() -> Self {
        Self::layer(0)
    }
}

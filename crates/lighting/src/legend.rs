//! A legend for pictures that show numbers by colours.

/// A bar of the colours that stand for numbers, with ticks and a title, at the right edge of windows and of pictures that
/// are taken (`take_picture`, `render_picture`, files). Pictures of less than 160 × 120 pixels have no room for it.
///
/// ```
/// use bevy_ecs::world::World;
/// use halfway_lighting::Legend;
///
/// let grey: Vec<[u8; 3]> = (0..=255).map(|level| [level; 3]).collect();
/// World::new().insert_resource(Legend { title: "height, m".into(), range: [-1.0, 3.0], colors: grey });
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::resource::Resource))]
pub struct Legend {
    /// The words above the bar. Characters other than those of ASCII are shown as `?`.
    pub title: String,
    /// The numbers at the lower and at the upper end of the bar, the lower first.
    pub range: [f32; 2],
    /// The colours from the lower end to the upper one, at even distances, in bytes of sRGB. Without any, nothing is
    /// drawn.
    pub colors: Vec<[u8; 3]>,
}

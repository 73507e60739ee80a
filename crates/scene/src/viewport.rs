//! The keys of a scene file for several cameras in one picture: their parts of it, and layers.

use bevy_ecs::world::EntityWorldMut;
use halfway_lighting::{Layers, Load, Range, Viewport};

use crate::check::{Check, KeyProblem, Limits};
use crate::keys::{Object, keys, words};

keys! {
    /// `viewport`: the part of the picture that a camera draws, where several share it.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct ViewportEntry {
        [optional]
        /// The left edge, upper edge, width and height, in shares of the picture's width and height; each 0 to 1, and
        /// within the picture.
        fractions: [f32; 4] = [0.0, 0.0, 1.0, 1.0] => Limits::Numbers(Range::UNIT),
        /// The same in pixels, in place of `fractions`; each up to 16384. null: none.
        pixels: Option<[u32; 4]> = None => Limits::Counts(0, 16384),
        /// Cameras are drawn by ascending order, 0 to 1000, those of the same order as they stand in the file.
        order: u32 = 0 => Limits::Counts(0, 1000),
        /// Whether the part begins with the background or with what cameras before it have drawn there.
        load: Load = Load::Clear,
    }
}

words! {
    /// `load`: how the part of a camera begins.
    Load {
        /// With the background.
        clear = Self::Clear,
        /// With what cameras before it have drawn there.
        keep = Self::Keep,
    }
}

impl Object for ViewportEntry {
    const EXPECTED: &'static str = "an object such as {\"fractions\": [0, 0, 0.5, 1]}";

    fn check_whole(&self) -> Check {
        #[allow(clippy::float_cmp, reason = "the default was not given, or might as well not have been")]
        if self.pixels.is_some() && self.fractions != Self::default().fractions {
            return Err(KeyProblem::new("pixels", "cannot stand beside `fractions`"));
        }
        if self.pixels.is_some_and(|[_, _, width, height]| width == 0 || height == 0) {
            return Err(KeyProblem::new("pixels", "has no width or no height; expected 1 or more"));
        }
        let outside = |_| {
            KeyProblem::new(
                "fractions",
                "reaches beyond the picture; expected left + width and top + height to be at most 1",
            )
        };
        self.component(0).validate().map_err(outside)
    }
}

impl ViewportEntry {
    /// As a component of the camera with this number, which is drawn after those of the same order before it.
    pub(crate) fn component(&self, number: usize) -> Viewport {
        let part = self.pixels.map_or_else(|| Viewport::fractions(self.fractions), Viewport::pixels);
        let order = i32::try_from(self.order as usize * 10_000 + number.min(9_999)).unwrap_or(i32::MAX);
        Viewport { load: self.load, ..part.with_order(order) }
    }
}

/// The numbers of layers.
pub(crate) const LAYERS: Limits = Limits::Counts(0, Layers::COUNT - 1);

/// Puts an entity into these layers; into none where nothing is said.
pub(crate) fn insert_layers(entity: &mut EntityWorldMut, numbers: Option<&Vec<u32>>) {
    if let Some(numbers) = numbers {
        entity.insert(numbers.iter().fold(Layers(0), |layers, &number| layers.and(number)));
    }
}

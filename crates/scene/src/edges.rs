//! The keys of a scene file for lines along edges.

use std::ops::Bound::Included;

use bevy_color::{ColorToComponents as _, LinearRgba};
use halfway_lighting::{Choices, Edges, HiddenEdges, Range, WhichEdges, Width};

use crate::check::Limits;
use crate::keys::{Fill, Key, Keys, Object, Visit, Words, keys, named_words, words};

keys! {
    /// `edges`: lines along the edges of a mesh, over the picture.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct EdgesEntry {
        [optional]
        /// The edges that are drawn.
        which: WhichEdges = WhichEdges::SHARP,
        /// The color of the lines, linear RGB. 0 to 1e12.
        color: [f32; 3] = [0.0; 3] => Limits::Numbers(Range::CHANNEL),
        /// The opacity of the lines, 0 to 1.
        opacity: f32 = 1.0 => Limits::Numbers(Range::UNIT),
        /// The width of the lines, above 0: pixels, or world units as in "0.01w".
        width: Width = Edges::new(WhichEdges::SHARP).width => Limits::Numbers(Range::POSITIVE),
        /// The parts of edges that lie behind surfaces.
        hidden: HiddenEdges = HiddenEdges::default(),
        /// Whether the surface is drawn, too; false: a wireframe.
        surface: bool = true,
    }
}

impl Object for EdgesEntry {
    const EXPECTED: &'static str = "an object such as {\"which\": \"feature\"}";
}

impl EdgesEntry {
    /// As a component.
    pub(crate) fn component(&self) -> Edges {
        let Self { which, color, opacity, width, hidden, surface } = *self;
        Edges { which, color: LinearRgba::from_f32_array_no_alpha(color), opacity, width, hidden, surface }
    }
}

impl From<Edges> for EdgesEntry {
    fn from(edges: Edges) -> Self {
        let Edges { which, color, opacity, width, hidden, surface } = edges;
        Self { which, color: color.to_f32_array_no_alpha(), opacity, width, hidden, surface }
    }
}

impl Keys for WhichEdges {
    const NAME: &'static str = "WhichEdges";
    const MEANING: &'static str = "`which`: the edges that are drawn.";
    const WORDS: Words<Self> = &named_words::<Self, { Self::CHOICES.len() }>();

    fn blank() -> Self {
        Self::SHARP
    }

    fn visit<V: Visit>(&self, visitor: &mut V) -> Result<(), V::Error> {
        match *self {
            Self::Feature(angle) => visitor.key(&FEATURE, Some(&Feature { angle_deg: angle.to_degrees() })),
            _ => Ok(()),
        }
    }

    fn fill<F: Fill>(&mut self, from: &mut F) -> Result<(), F::Error> {
        from.key(&FEATURE, |Feature { angle_deg }| *self = Self::Feature(angle_deg.to_radians()))
    }
}

impl Object for WhichEdges {
    const ONE_KEY: bool = true;
    const EXAMPLES: &'static [&'static str] = &["{\"feature\": {\"angle_deg\": 20}}"];
}

const FEATURE: Key = Key::required("feature", "As `feature`, from another angle on.");

keys! {
    /// The value of `{"feature": …}`.
    #[derive(Clone, Copy, PartialEq)]
    struct Feature {
        [optional]
        /// The least angle between the normals of the two triangles, in degrees from 0 to 180.
        angle_deg: f32 = 30.0
            => Limits::Numbers(Range::new(Included(0.0), Included(180.0), "degrees from 0 to 180")),
    }
}

impl Object for Feature {
    const EXPECTED: &'static str = "an object such as {\"angle_deg\": 20}";
}

words! {
    /// `hidden`: the parts of edges and lines that lie behind surfaces.
    HiddenEdges {
        /// They are left out.
        omit = Self::Omit,
        /// They are dashed: 5 pixels of line, 4 pixels of nothing.
        dash = Self::Dash,
    }
}

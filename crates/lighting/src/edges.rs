//! Lines along the edges of a mesh.

use crate::LinearRgba;
use crate::choices::{Choice, Choices};
use crate::hidden::HiddenEdges;
use crate::invalid::{Fields, InvalidValue};
use crate::line_style::Width;
use crate::range::Range;

/// Lines along the edges of an object's mesh, over its surface. On a camera it holds for all objects that have none of
/// their own.
///
/// They are drawn over the finished picture, smooth whatever the camera's samples are, and do not take part in lighting:
/// their colour is the one that is given, under any intensity policy. Of an edge that lies behind a surface the hidden
/// part is left out or dashed. Windows show them, and pictures that are taken have them (`take_picture`, `render_picture`,
/// files); textures of an engine do not.
///
/// ```
/// use bevy_color::LinearRgba;
/// use bevy_ecs::world::World;
/// use halfway_lighting::{Camera, WhichEdges, Edges};
///
/// let mut world = World::new();
/// // A part as in a drawing: its sharp edges and outlines, thin and dark.
/// world.spawn((Camera::default(), Edges::new(WhichEdges::Feature(30_f32.to_radians()))));
/// // A wireframe, one pixel wide.
/// let wires = Edges { color: LinearRgba::rgb(0.0, 0.2, 0.6), width: 1.0.into(), surface: false, ..Edges::new(WhichEdges::All) };
/// assert!(wires.validate().is_ok());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component))]
pub struct Edges {
    /// The edges that are drawn. Default: sharp ones, from 30° on, with the outline.
    pub which: WhichEdges,
    /// The colour, linear RGB, each channel 0 to 10¹²; alpha is ignored. Default black.
    pub color: LinearRgba,
    /// The opacity, 0 to 1. Default 1.
    pub opacity: f32,
    /// The width, above 0. Default 1.5 pixels.
    pub width: Width,
    /// The parts that lie behind surfaces. Default: left out.
    pub hidden: HiddenEdges,
    /// Whether the surface is drawn, too. Without it the lines are a wireframe, which hides nothing. Default true.
    pub surface: bool,
}

/// The edges that [`Edges`] draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WhichEdges {
    /// All edges of all triangles.
    All,
    /// Edges between triangles whose normals are this angle apart or more, in radians from 0 to π; borders and the
    /// silhouette.
    Feature(f32),
    /// Edges of one triangle only: the borders of an open surface.
    Boundary,
    /// Edges between a triangle that faces the camera and one that does not, and borders: the outline.
    Silhouette,
}

impl Choices for WhichEdges {
    const CHOICES: &'static [Choice<Self>] = &[
        Choice { value: Self::All, key: "all", name: "all edges", meaning: "All edges of all triangles." },
        Choice {
            value: Self::SHARP,
            key: "feature",
            name: "feature edges",
            meaning: "Edges between triangles whose normals are 30° apart or more, borders and the silhouette.",
        },
        Choice { value: Self::Boundary, key: "boundary", name: "borders", meaning: "The borders of an open surface." },
        Choice {
            value: Self::Silhouette,
            key: "silhouette",
            name: "the silhouette",
            meaning: "Edges between a front and a back, and borders.",
        },
    ];
}

impl WhichEdges {
    /// [`Feature`](Self::Feature) from 30° on.
    pub const SHARP: Self = Self::Feature(std::f32::consts::FRAC_PI_6);
}

impl Edges {
    /// Black lines of 1.5 pixels along these edges, hidden parts left out, over the surface.
    pub const fn new(which: WhichEdges) -> Self {
        Self {
            which,
            color: LinearRgba::BLACK,
            opacity: 1.0,
            width: Width::Pixels(1.5),
            hidden: HiddenEdges::Omit,
            surface: true,
        }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The first field that is outside the range it documents.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let fields = Fields::for_owner("Edges");
        if let WhichEdges::Feature(angle) = self.which {
            fields.within("which", angle, ANGLE)?;
        }
        fields.color("color", self.color)?;
        fields.within("opacity", self.opacity, Range::UNIT)?;
        fields.within("width", self.width.value(), Range::POSITIVE)
    }
}

/// The range of an angle between normals.
const ANGLE: Range =
    Range::new(std::ops::Bound::Included(0.0), std::ops::Bound::Included(std::f32::consts::PI), "radians from 0 to π");

impl Default for Edges {
    fn default() -> Self {
        Self::new(WhichEdges::SHARP)
    }
}

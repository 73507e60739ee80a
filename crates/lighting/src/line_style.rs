//! The looks of lines and points.

use std::fmt;
use std::str::FromStr;

use crate::LinearRgba;
use crate::hidden::HiddenEdges;
use crate::invalid::{Fields, InvalidValue};
use crate::range::Range;

/// The width of a line, or the diameter of a point, above 0.
///
/// As text, in scene files and on the command line, a number alone is pixels and one with a `w` world units:
///
/// ```
/// use halfway_lighting::Width;
///
/// assert_eq!("2.5".parse(), Ok(Width::Pixels(2.5)));
/// assert_eq!("0.01w".parse(), Ok(Width::World(0.01)));
/// assert_eq!(Width::World(0.01).to_string(), "0.01w");
/// assert!(["", "w", "0", "-1", "inf", "2px"].iter().all(|text| text.parse::<Width>().is_err()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Width {
    /// In pixels, the same at every distance.
    Pixels(f32),
    /// In world units: less of the picture the farther away. The scale of the entity's transform does not count.
    World(f32),
}

impl Width {
    /// Its number, whatever the unit.
    pub const fn value(self) -> f32 {
        match self {
            Self::Pixels(width) | Self::World(width) => width,
        }
    }

    /// The width in pixels where a pixel is this many world units large.
    pub fn in_pixels(self, pixel_size: f64) -> f64 {
        match self {
            Self::Pixels(width) => width.into(),
            Self::World(width) => f64::from(width) / pixel_size,
        }
    }
}

impl From<f32> for Width {
    fn from(pixels: f32) -> Self {
        Self::Pixels(pixels)
    }
}

impl fmt::Display for Width {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Pixels(width) => write!(f, "{width}"),
            Self::World(width) => write!(f, "{width}w"),
        }
    }
}

impl FromStr for Width {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (number, in_world) = text.strip_suffix('w').map_or((text, false), |number| (number, true));
        let number = number.parse().ok().filter(|number: &f32| number.is_finite() && *number > 0.0);
        let number = number.ok_or("expected pixels above 0, such as 2, or world units, such as 0.01w")?;
        Ok(if in_world { Self::World(number) } else { Self::Pixels(number) })
    }
}

/// The looks of an entity's lines and points (`Lines3d`); without it they have the default ones.
///
/// Their colour is the one given here, else that of the vertices times the diffuse reflectance of the entity's
/// [`Material`](crate::Material). Where the vertices have normals, and no colour is given here, the material reflects the
/// lights of the scene there, from the side that is seen; environments do not count. Opacities count where the entity has
/// [`AlphaMode::Blend`](crate::AlphaMode). Lit ones have the curve of the camera's [`Intensity`](crate::Intensity), as the
/// surfaces behind them have it, but are not divided under `Renormalize`; no policy changes others.
///
/// Lines and points are drawn over the finished picture, smooth whatever the camera's samples are, and hidden by the
/// surfaces before them; hidden parts of lines may be dashed. Pictures that are taken have them (`take_picture`,
/// `render_picture`, files); windows do not.
///
/// ```
/// use bevy_color::LinearRgba;
/// use halfway_lighting::{LineStyle, Width};
///
/// let style = LineStyle { line_width: Width::World(0.02), color: Some(LinearRgba::RED), ..LineStyle::default() };
/// assert!(style.validate().is_ok());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component))]
pub struct LineStyle {
    /// The width of lines. Default 1.5 pixels.
    pub line_width: Width,
    /// The diameter of points, which are round. Default 4 pixels.
    pub point_size: Width,
    /// The colour, linear RGB, each channel 0 to 10¹²; alpha is ignored. Default: their own.
    pub color: Option<LinearRgba>,
    /// The parts of lines that lie behind surfaces; hidden points are left out. Dashes go on from one segment
    /// of a path to the next. Default: left out.
    pub hidden: HiddenEdges,
}

impl LineStyle {
    /// The value of [`LineStyle::default`], for constants.
    pub const DEFAULT: Self =
        Self { line_width: Width::Pixels(1.5), point_size: Width::Pixels(4.0), color: None, hidden: HiddenEdges::Omit };

    /// Checks every field.
    ///
    /// # Errors
    /// The first field that is outside the range it documents.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let fields = Fields::for_owner("LineStyle");
        fields.within("line_width", self.line_width.value(), Range::POSITIVE)?;
        fields.within("point_size", self.point_size.value(), Range::POSITIVE)?;
        self.color.map_or(Ok(()), |color| fields.color("color", color))
    }
}

impl Default for LineStyle {
    fn default() -> Self {
        Self::DEFAULT
    }
}

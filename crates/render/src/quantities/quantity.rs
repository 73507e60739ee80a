//! Pictures of quantities.

use crate::quantities::redrawn::{self, Shows, Taken};
use crate::quantities::surfaces::{SurfacePoint, Surfaces};
use crate::views::{self, Views};
use bevy_ecs::prelude::World;
use bevy_math::UVec2;
use halfway_frame::error::RenderError;
use halfway_lighting::{Choice, Choices};
use image::Rgba32FImage;

/// A property of what each pixel shows. Every one is 0 where there is only background.
///
/// All but [averages](Self::is_average) are of the surface in the middle of the pixel, as [`Surfaces`] has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// The depth along the axis of the camera, in world units.
    Depth,
    /// The distance from the camera, in world units.
    Distance,
    /// The point in world space, counted from the camera's [origin](Surfaces::origin) where it has one.
    Position,
    /// The interpolated unit normal in world space, of the side that is seen.
    Normal,
    /// The same in eye space.
    EyeNormal,
    /// The unit normal of the triangle in world space, of the side that is seen.
    FaceNormal,
    /// The same in eye space.
    EyeFaceNormal,
    /// The number of the object, from 1 on; see [`SurfacePoint::object`].
    Id,
    /// The number of the part in its object, from 1 on.
    Part,
    /// The number of the triangle in its mesh, from 1 on.
    Triangle,
    /// The weights of the triangle's corners.
    Barycentrics,
    /// The texture coordinates of the first set.
    Uv,
    /// The diffuse reflectance, linear RGB: of the material, times vertex colours, images and solids; blended and
    /// averaged over samples as the picture is, over black.
    Albedo,
    /// The share of the pixel that is not background, by its samples and opacities, 0 to 1.
    Coverage,
}

impl Choices for Quantity {
    const CHOICES: &'static [Choice<Self>] = &[
        choice(Self::Depth, "depth", "depth", "The depth along the axis of the camera, in world units."),
        choice(Self::Distance, "distance", "distance", "The distance from the camera, in world units."),
        choice(
            Self::Position,
            "position",
            "position",
            "The point in world space, counted from the camera's origin where it has one.",
        ),
        choice(Self::Normal, "normal", "normal", "The interpolated normal in world space."),
        choice(Self::EyeNormal, "eye_normal", "normal in eye space", "The interpolated normal in eye space."),
        choice(Self::FaceNormal, "face_normal", "normal of the triangle", "The triangle's normal in world space."),
        choice(
            Self::EyeFaceNormal,
            "eye_face_normal",
            "normal of the triangle in eye space",
            "The triangle's normal in eye space.",
        ),
        choice(Self::Id, "id", "object", "The number of the object, from 1 on."),
        choice(Self::Part, "part", "part", "The number of the part in its object, from 1 on."),
        choice(Self::Triangle, "triangle", "triangle", "The number of the triangle in its mesh, from 1 on."),
        choice(Self::Barycentrics, "barycentrics", "barycentrics", "The weights of the triangle's corners."),
        choice(Self::Uv, "uv", "texture coordinates", "The texture coordinates of the first set."),
        choice(Self::Albedo, "albedo", "albedo", "The diffuse reflectance, linear RGB."),
        choice(Self::Coverage, "coverage", "coverage", "The share of the pixel that is not background, 0 to 1."),
    ];
}

const fn choice(value: Quantity, key: &'static str, name: &'static str, meaning: &'static str) -> Choice<Quantity> {
    Choice { value, key, name, meaning }
}

impl Quantity {
    /// The names of its channels.
    pub const fn channels(self) -> &'static [&'static str] {
        match self {
            Self::Depth | Self::Distance => &["Z"],
            Self::Position | Self::Normal | Self::EyeNormal | Self::FaceNormal | Self::EyeFaceNormal => {
                &["X", "Y", "Z"]
            }
            Self::Id | Self::Part | Self::Triangle => &["id"],
            Self::Barycentrics => &["a", "b", "c"],
            Self::Uv => &["U", "V"],
            Self::Albedo => &["R", "G", "B"],
            Self::Coverage => &["A"],
        }
    }

    /// Whether it is an average over the samples of a pixel: the albedo and the coverage.
    pub const fn is_average(self) -> bool {
        matches!(self, Self::Albedo | Self::Coverage)
    }

    /// Its numbers in a point of a surface, as many as it has channels.
    fn at(self, surfaces: &Surfaces, point: &SurfacePoint, out: &mut Vec<f32>) {
        let mut push = |values: &[f64]| out.extend(values.iter().map(|&value| value as f32));
        match self {
            Self::Depth => push(&[point.depth]),
            Self::Distance => push(&[point.distance]),
            Self::Position => push(&(point.position - surfaces.origin()).to_array()),
            Self::Normal => push(&point.normal.to_array()),
            Self::EyeNormal => push(&surfaces.in_eye_space(point.normal).to_array()),
            Self::FaceNormal => push(&point.face_normal.to_array()),
            Self::EyeFaceNormal => push(&surfaces.in_eye_space(point.face_normal).to_array()),
            Self::Barycentrics => push(&point.barycentrics.to_array()),
            Self::Uv => push(&point.uv.unwrap_or_default().to_array()),
            Self::Id | Self::Part | Self::Triangle | Self::Albedo | Self::Coverage => {}
        }
    }

    /// Whether it is a whole number.
    fn is_number(self) -> bool {
        matches!(self, Self::Id | Self::Part | Self::Triangle)
    }

    /// Its number in a point of a surface, if it is one.
    fn number(self, point: &SurfacePoint) -> Option<u32> {
        match self {
            Self::Id => Some(point.object),
            Self::Part => Some(point.part),
            Self::Triangle => Some(point.triangle + 1),
            _ => None,
        }
    }
}

/// A picture of a quantity, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct QuantityImage {
    /// The quantity.
    pub quantity: Quantity,
    /// Width and height in pixels.
    pub size: UVec2,
    /// Its values.
    pub values: QuantityValues,
}

/// The values of a [`QuantityImage`].
#[derive(Clone, Debug, PartialEq)]
pub enum QuantityValues {
    /// As many numbers a pixel as the quantity has [channels](Quantity::channels), one pixel after the other.
    Floats(Vec<f32>),
    /// One number a pixel, for [`Quantity::Id`], [`Quantity::Part`] and [`Quantity::Triangle`].
    Numbers(Vec<u32>),
}

/// Pictures of some quantities of the newest frame of this world, in the order in which they are asked for.
///
/// ```
/// use bevy_app::App;
/// use bevy_math::UVec2;
/// use bevy_transform::{TransformPlugin, components::Transform};
/// use halfway_asset::Assets;
/// use halfway_lighting::Camera;
/// use halfway_mesh::{Mesh, Mesh3d, Plane};
/// use halfway_render::{
///     AdapterChoice, Headless, Quantity, QuantityValues, RenderError, RenderPlugin, take_picture, take_quantities,
/// };
///
/// # fn main() -> Result<(), RenderError> {
/// let mut app = App::new();
/// app.add_plugins((TransformPlugin, RenderPlugin::default()))
///     .insert_resource(Headless { size: UVec2::new(8, 6), ..Headless::default() })
///     .insert_resource(AdapterChoice::cpu());
/// let world = app.world_mut();
/// let (camera, place) = Camera::default().framing((bevy_math::Vec3::ZERO, 1.0), bevy_math::Vec3::NEG_Y);
/// world.spawn((camera, place));
/// let floor = world.resource_mut::<Assets<Mesh>>().add(Plane { size: 100.0, divisions: 1 });
/// world.spawn((Mesh3d(floor), Transform::default()));
/// take_picture(world)?;
/// let [depth, id] = &take_quantities(world, &[Quantity::Depth, Quantity::Id])?[..] else { panic!() };
/// assert_eq!(id.values, QuantityValues::Numbers(vec![1; 48]));
/// let QuantityValues::Floats(depth) = &depth.values else { panic!() };
/// assert!(depth.iter().all(|depth| (depth - place.translation.y).abs() < 1e-5));
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// Those of [`Surfaces::take`].
pub fn take_quantities(world: &mut World, quantities: &[Quantity]) -> Result<Vec<QuantityImage>, RenderError> {
    let whole = world.get_resource::<Views>().filter(|views| !views.is_empty()).map(Views::size);
    let parts = views::for_each(world, |world, place| {
        let mut surfaces = None;
        let images = quantities.iter().map(|&quantity| image(world, quantity, &mut surfaces));
        Ok::<_, RenderError>((place.corner, images.collect::<Result<Vec<_>, _>>()?))
    })?;
    let Some(size) = whole else { return Ok(parts.into_iter().flat_map(|(_, images)| images).collect()) };
    let mut together: Vec<_> = quantities.iter().map(|&quantity| QuantityImage::empty(quantity, size)).collect();
    for (corner, images) in parts {
        together.iter_mut().zip(images).for_each(|(whole, part)| whole.put(corner, &part));
    }
    Ok(together)
}

impl QuantityImage {
    /// A picture of background alone.
    pub fn empty(quantity: Quantity, size: UVec2) -> Self {
        let count = quantity.channels().len() * size.element_product() as usize;
        let values = if quantity.is_number() {
            QuantityValues::Numbers(vec![0; count])
        } else {
            QuantityValues::Floats(vec![0.0; count])
        };
        Self { quantity, size, values }
    }

    /// Puts another picture of the same quantity over this one, with its upper left corner here, as far as it lies within.
    pub fn put(&mut self, corner: UVec2, part: &Self) {
        fn copy<T: Copy>(whole: &mut [T], from: &[T], [start, stride, length, taken]: [usize; 4]) {
            for (row, from) in from.chunks_exact(length).enumerate() {
                if let Some(to) = whole.get_mut(start + row * stride..).and_then(|to| to.get_mut(..taken)) {
                    to.copy_from_slice(&from[..taken]);
                }
            }
        }
        if corner.cmpge(self.size).any() || part.size.x == 0 {
            return;
        }
        let taken = part.size.x.min(self.size.x - corner.x);
        let start = corner.y as usize * self.size.x as usize + corner.x as usize;
        let channels = self.quantity.channels().len();
        let [stride, length, taken] = [self.size.x, part.size.x, taken].map(|pixels| channels * pixels as usize);
        let rows = [channels * start, stride, length, taken];
        match (&mut self.values, &part.values) {
            (QuantityValues::Floats(whole), QuantityValues::Floats(part)) => copy(whole, part, rows),
            (QuantityValues::Numbers(whole), QuantityValues::Numbers(part)) => copy(whole, part, rows),
            _ => {}
        }
    }
}

fn image(world: &mut World, quantity: Quantity, surfaces: &mut Option<Surfaces>) -> Result<QuantityImage, RenderError> {
    match quantity {
        Quantity::Albedo => {
            let drawn = redrawn::draw(world, Shows::Albedo, Taken::All)?;
            Ok(of_picture(quantity, &drawn, |[r, g, b, _], out| out.extend([r, g, b])))
        }
        Quantity::Coverage => {
            let drawn = redrawn::draw(world, Shows::Background, Taken::All)?;
            Ok(of_picture(quantity, &drawn, |[background, ..], out| out.push(1.0 - background)))
        }
        _ => {
            let surfaces = match surfaces {
                Some(surfaces) => surfaces,
                none => none.insert(Surfaces::take(world)?),
            };
            Ok(QuantityImage::of_surfaces(quantity, surfaces))
        }
    }
}

fn of_picture(quantity: Quantity, drawn: &Rgba32FImage, push: impl Fn([f32; 4], &mut Vec<f32>)) -> QuantityImage {
    let mut values = Vec::with_capacity(quantity.channels().len() * drawn.len() / 4);
    drawn.pixels().for_each(|pixel| push(pixel.0, &mut values));
    QuantityImage { quantity, size: drawn.dimensions().into(), values: QuantityValues::Floats(values) }
}

impl QuantityImage {
    /// A quantity of surfaces, whichever drawer found them. [Averages](Quantity::is_average) are not of the surface in
    /// the middle of a pixel; they are 0 here.
    pub fn of_surfaces(quantity: Quantity, surfaces: &Surfaces) -> Self {
        let values = if quantity.is_number() {
            let number = |point: Option<SurfacePoint>| point.and_then(|point| quantity.number(&point)).unwrap_or(0);
            QuantityValues::Numbers(surfaces.iter().map(number).collect())
        } else {
            let channels = quantity.channels().len();
            let mut values = Vec::with_capacity(channels * surfaces.size().element_product() as usize);
            for point in surfaces.iter() {
                match point {
                    Some(point) => quantity.at(surfaces, &point, &mut values),
                    None => values.extend(std::iter::repeat_n(0.0, channels)),
                }
            }
            QuantityValues::Floats(values)
        };
        Self { quantity, size: surfaces.size(), values }
    }
}

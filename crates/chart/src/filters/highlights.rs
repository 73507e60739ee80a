//! Highlights of normal maps from afar: by the mean of the normals, by Toksvig and by LEAN, against pictures of many
//! samples.

use std::f64::consts::TAU;

use halfway::prelude::*;
use halfway::reference::Image;
use halfway::render::{Adapter, AdapterChoice};
use halfway::texture::normals::from_heights;
use halfway::texture::{FarNormals, TexelImage, UvTransform, Wrap};

use super::FilterPlan;
use crate::measure::{MeasureError, MeasureProgress};
use crate::page::data_uri;
use crate::timing::{Spread, in_turns, ratios, settle};

/// Texels along a side of the images.
const SIDE: u32 = 256;
/// The plane's side, in lengths of the scene.
const PLANE: f32 = 24.0;
/// The least samples of a pixel along each axis, of what stands for the truth.
const LEAST_SAMPLES: u32 = 4;
/// How far the camera moves between two frames, in pixels.
const STEP: [f32; 2] = [0.43, 0.29];

/// A surface whose highlights are charted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoughSurface {
    /// Waves of four directions.
    Bumps,
    /// Waves of one direction.
    Furrows,
}

impl RoughSurface {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Bumps, Self::Furrows];

    /// In a word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bumps => "bumps",
            Self::Furrows => "furrows",
        }
    }

    /// Its normals. They repeat without seams.
    fn texture(self) -> Texture {
        // Cycles along the columns and the rows, and where they begin.
        let waves: &[[f64; 3]] = match self {
            Self::Bumps => &[[30.0, 11.0, 0.3], [-18.0, 35.0, 1.1], [50.0, 22.0, 2.0], [11.0, -58.0, 0.7]],
            Self::Furrows => &[[30.0, 15.0, 0.3], [44.0, 22.0, 1.1], [58.0, 29.0, 2.0]],
        };
        let height = |x: u32, y: u32| {
            let [x, y] = [x, y].map(|at| f64::from(at) / f64::from(SIDE));
            waves.iter().map(|[i, j, first]| (TAU * (i * x + j * y) + first).sin()).sum::<f64>() as f32
        };
        let normals = TexelImage::from_fn(SIDE, SIDE, |x, y| [height(x, y); 4])
            .and_then(|heights| from_heights(&heights, [Wrap::Repeat; 2], 0.3));
        match normals {
            Ok(normals) => Texture::from(normals),
            // The size is within the limits and every number finite.
            Err(_) => Texture::missing(),
        }
    }
}

/// In words.
pub fn far_normals_name(far: FarNormals) -> &'static str {
    match far {
        FarNormals::Mean => "mean normal",
        FarNormals::Toksvig => "Toksvig",
        FarNormals::Lean => "LEAN",
    }
}

/// The memory that is read, in multiples of the image's.
pub fn far_normals_memory(far: FarNormals) -> f64 {
    if far == FarNormals::Lean { 8.0 / 3.0 } else { 4.0 / 3.0 }
}

/// What was found of one of [`FarNormals::ALL`] on one surface.
#[derive(Clone, Debug, Default)]
pub struct HighlightFigures {
    /// The RMS error at each of the plan's distances, linear, of highlights that are 1 at most.
    pub rms: Vec<f64>,
    /// The RMS of what changes from a frame of the moving camera to the next, less what changes in the truth, at each
    /// distance.
    pub shimmer: Vec<f64>,
    /// A frame's time at the last but one distance over that by the mean normal in the same round.
    pub ratio: Spread,
    /// What it looks like at the last but one distance, as a `data:` address.
    pub picture: String,
}

/// What was found of one surface.
#[derive(Clone, Debug)]
pub struct MeasuredHighlights {
    /// The surface.
    pub surface: RoughSurface,
    /// What the truth looks like at the last but one distance, as a `data:` address.
    pub truth: String,
    /// For each of [`FarNormals::ALL`].
    pub figures: [HighlightFigures; 3],
}

impl FilterPlan {
    /// How many texels a pixel is wide at each of the distances that highlights are charted at.
    pub const TEXELS: [u32; 5] = [1, 2, 4, 8, 16];
    /// The place of the distance at which they are timed and shown.
    pub const SHOWN: usize = 3;

    /// The units of [`highlights`]: one for each distance, and one for the timing, of each surface.
    pub(super) fn highlight_units() -> u64 {
        (RoughSurface::ALL.len() * (Self::TEXELS.len() + 1)) as u64
    }
}

/// Draws the surfaces on the CPU without a driver; `progress` hears of a unit for each distance and one for the timing.
///
/// # Errors
/// What could not be drawn.
pub fn highlights(
    plan: &FilterPlan,
    progress: &mut MeasureProgress<'_>,
) -> Result<Vec<MeasuredHighlights>, MeasureError> {
    let adapter = AdapterChoice::cpu().open()?;
    RoughSurface::ALL.into_iter().map(|surface| of_surface(plan, &adapter, surface, progress)).collect()
}

fn of_surface(
    plan: &FilterPlan,
    adapter: &Adapter,
    surface: RoughSurface,
    progress: &mut MeasureProgress<'_>,
) -> Result<MeasuredHighlights, MeasureError> {
    let mut figures: [HighlightFigures; 3] = Default::default();
    let mut shown = String::new();
    for (place, texels) in FilterPlan::TEXELS.into_iter().enumerate() {
        let samples = texels.max(LEAST_SAMPLES);
        let truth = Frames::new(plan, adapter, surface, (FarNormals::Mean, texels), samples)?;
        if place == FilterPlan::SHOWN {
            shown = truth.uri()?;
        }
        for (far, figures) in FarNormals::ALL.into_iter().zip(&mut figures) {
            let frames = Frames::new(plan, adapter, surface, (far, texels), 1)?;
            figures.rms.push(rms(&frames.0[0], &truth.0[0]));
            figures.shimmer.push(frames.shimmer(&truth));
            if place == FilterPlan::SHOWN {
                figures.picture = frames.uri()?;
            }
        }
        progress.advance(1, &format!("highlights of {}, {texels} texels a pixel", surface.name()));
    }
    for (figures, ratio) in figures.iter_mut().zip(timed(plan, adapter, surface)?) {
        figures.ratio = ratio;
    }
    progress.advance(1, &format!("times of highlights of {}", surface.name()));
    Ok(MeasuredHighlights { surface, truth: shown, figures })
}

/// The frames of the moving camera, in linear light.
struct Frames(Vec<Image>);

impl Frames {
    /// Each pixel is the mean of `samples`² of them.
    fn new(
        plan: &FilterPlan,
        adapter: &Adapter,
        surface: RoughSurface,
        (far, texels): (FarNormals, u32),
        samples: u32,
    ) -> Result<Self, MeasureError> {
        let size = UVec2::from_array(plan.size);
        let mut app = shown(adapter, (size * samples, size.y), surface, (far, texels));
        let mut frames = Vec::with_capacity(plan.frames as usize);
        for frame in 0..plan.frames {
            move_to(&mut app, size.y, texels, frame);
            let Picture::Float(picture) = render_picture(&mut app)? else {
                return Err(MeasureError::Scene("a picture in floating point was expected".to_owned()));
            };
            let mut means = vec![[0.0; 3]; (size.x * size.y) as usize];
            for (x, y, pixel) in picture.enumerate_pixels() {
                let mean = &mut means[(y / samples * size.x + x / samples) as usize];
                (0..3).for_each(|c| mean[c] += f64::from(pixel.0[c]) / f64::from(samples * samples));
            }
            frames.push(Image::new(size.x, size.y, means));
        }
        Ok(Self(frames))
    }

    fn shimmer(&self, truth: &Self) -> f64 {
        let pairs = self.0.windows(2).zip(truth.0.windows(2));
        let changes = |pair: &[Image]| -> Vec<f64> {
            let pixels = pair[0].pixels().iter().zip(pair[1].pixels());
            pixels.map(|(before, after)| after[0] - before[0]).collect()
        };
        let squares: Vec<f64> = pairs
            .flat_map(|(own, right)| changes(own).into_iter().zip(changes(right)))
            .map(|(own, right)| (own - right).powi(2))
            .collect();
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
    }

    /// The first of them.
    fn uri(&self) -> Result<String, MeasureError> {
        data_uri(&self.0[0].to_bytes(Encoding::Srgb)).map_err(MeasureError::Picture)
    }
}

/// Of highlights that are white all channels are alike.
fn rms(picture: &Image, truth: &Image) -> f64 {
    let pixels = picture.pixels().iter().zip(truth.pixels());
    let sum: f64 = pixels.map(|(a, b)| (a[0] - b[0]).powi(2)).sum();
    (sum / picture.pixels().len().max(1) as f64).sqrt()
}

/// A plane that shows nothing but highlights, from above, in a picture of one size; a texel at a distance of 1 is as
/// wide as a pixel of pictures of this height.
fn shown(
    adapter: &Adapter,
    (size, height): (UVec2, u32),
    surface: RoughSurface,
    (far, texels): (FarNormals, u32),
) -> App {
    let mut app = App::new();
    adapter.clone().insert_into(app.world_mut());
    app.add_plugins(HalfwayPlugins::headless(size)).insert_resource(GlobalAmbient(LinearRgba::BLACK));
    app.finish();
    app.cleanup();
    let world = app.world_mut();
    world.resource_mut::<Headless>().pixels = Pixels::Float;
    let texture = world.resource_mut::<Assets<Texture>>().add(surface.texture());
    let times = PLANE / (pixel(height, 1) * SIDE as f32);
    let transform = UvTransform { scale: [times; 2], ..UvTransform::default() };
    let map = SurfaceMap { far_normals: far, transform, ..SurfaceMap::from(texture) };
    let material = Material { specular: LinearRgba::WHITE, shininess: 60.0, ..Material::matte(LinearRgba::BLACK) };
    let mesh = world.resource_mut::<Assets<Mesh>>().add(Mesh::from(Plane { size: PLANE, divisions: 1 }));
    let mut maps = Maps::default();
    maps.set(MapKind::Normal, Some(map));
    world.spawn((Mesh3d(mesh), material, maps, Shading::Phong, Reflectance::BlinnPhong, Transform::default()));
    let light = DirectionalLight { ambient: LinearRgba::BLACK, ..DirectionalLight::white() };
    world.spawn((light, Transform::default().looking_to(Vec3::new(-0.15, -1.0, -0.1), Vec3::Z)));
    world.spawn((Camera { fov_y: FOV_Y, ..Camera::default() }, Transform::default()));
    move_to(&mut app, height, texels, 0);
    app
}

/// How far the camera opens, from top to bottom.
const FOV_Y: f32 = 0.5;

/// How wide a pixel is on the plane, of a picture so high and seen from so many units away.
fn pixel(height: u32, distance: u32) -> f32 {
    2.0 * (0.5 * FOV_Y).tan() * distance as f32 / height as f32
}

/// Puts the camera above the plane, so far away that a pixel of a picture of this height is so many texels wide.
fn move_to(app: &mut App, height: u32, texels: u32, frame: u32) {
    let step = pixel(height, texels) * frame as f32;
    let eye = Vec3::new(STEP[0] * step, texels as f32, STEP[1] * step);
    let world = app.world_mut();
    for (mut transform, _) in world.query::<(&mut Transform, &Camera)>().iter_mut(world) {
        *transform = Transform::from_translation(eye).looking_to(Vec3::NEG_Y, Vec3::NEG_Z);
    }
}

/// The times of frames, each over that by the mean normal of the same round.
fn timed(plan: &FilterPlan, adapter: &Adapter, surface: RoughSurface) -> Result<[Spread; 3], MeasureError> {
    // Four pixels for one, so that a frame is mostly pixels.
    let size = UVec2::from_array(plan.size) * 4;
    let texels = FilterPlan::TEXELS[FilterPlan::SHOWN];
    let mut apps = FarNormals::ALL.map(|far| shown(adapter, (size, size.y), surface, (far, texels)));
    for app in &mut apps {
        settle(app)?;
    }
    let mut all: Vec<&mut App> = apps.iter_mut().collect();
    let times = in_turns(&mut all, plan.rounds)?;
    Ok([0, 1, 2].map(|far| ratios(&times[far], &times[0])))
}

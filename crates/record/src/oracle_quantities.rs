//! The surfaces that the reference renderer sees, quantities, and the cameras that share its picture.

use bevy_ecs::prelude::{Resource, World};
use bevy_ecs::system::SystemState;
use bevy_math::UVec2;
use halfway_lighting::{Camera, CameraTurn, Samples, SharedPart, SharingCameras, current_camera};
use halfway_reference::{Image, Mode, Oracle, OracleError, Shows};
use halfway_render::{Quantity, QuantityImage, QuantityValues, Surfaces};

/// How the oracle drew its last picture, until the quantities of that are written.
#[derive(Resource, Clone, Copy)]
pub(crate) struct OracleFrame {
    /// The size of the whole picture.
    pub(crate) size: UVec2,
    pub(crate) mode: Mode,
    pub(crate) supersampling: Option<u32>,
}

/// The square root of the samples a pixel.
pub(crate) fn side(samples: Samples) -> u32 {
    samples.count().isqrt()
}

/// The surfaces of meshes in the middle of each pixel.
pub(crate) fn surfaces(world: &mut World, size: UVec2) -> Result<Surfaces, OracleError> {
    let oracle = Oracle::new(world, size)?;
    let found = Surfaces::found_by(world, size, |x, y| {
        let nearest = oracle.probe(f64::from(x) + 0.5, f64::from(y) + 0.5).nearest?;
        Some((nearest.object, nearest.triangle?))
    });
    found.map_err(|_| OracleError::NoCamera)
}

/// The cameras that share a picture of this size.
pub(crate) fn sharing(world: &mut World, size: UVec2) -> Vec<SharedPart> {
    let mut cameras = SystemState::<SharingCameras>::new(world);
    cameras.get(world).map(|cameras| cameras.parts(size.to_array())).unwrap_or_default()
}

/// Quantities as the oracle sees them, in the order in which they are asked for.
pub(crate) fn quantities(
    world: &mut World,
    frame: OracleFrame,
    quantities: &[Quantity],
) -> Result<Vec<QuantityImage>, OracleError> {
    let parts = sharing(world, frame.size);
    if parts.is_empty() {
        return of_camera(world, frame, quantities);
    }
    let mut whole: Vec<_> = quantities.iter().map(|&quantity| QuantityImage::empty(quantity, frame.size)).collect();
    for SharedPart { camera, corner, size, .. } in parts {
        world.insert_resource(CameraTurn(Some(camera)));
        let images = of_camera(world, OracleFrame { size: size.into(), ..frame }, quantities);
        world.insert_resource(CameraTurn(None));
        whole.iter_mut().zip(images?).for_each(|(whole, part)| whole.put(corner.into(), &part));
    }
    Ok(whole)
}

/// Those of the camera whose turn it is.
fn of_camera(
    world: &mut World,
    frame: OracleFrame,
    quantities: &[Quantity],
) -> Result<Vec<QuantityImage>, OracleError> {
    let is_of_surfaces = |quantity: &Quantity| !quantity.is_average();
    let surfaces = quantities.iter().any(is_of_surfaces).then(|| surfaces(world, frame.size)).transpose()?;
    let image = |&quantity: &Quantity| match (quantity, &surfaces) {
        (Quantity::Albedo, _) => averaged(world, frame, (quantity, Shows::Albedo)),
        (Quantity::Coverage, _) => averaged(world, frame, (quantity, Shows::Coverage)),
        (_, Some(surfaces)) => Ok(QuantityImage::of_surfaces(quantity, surfaces)),
        (_, None) => Ok(QuantityImage::empty(quantity, frame.size)),
    };
    quantities.iter().map(image).collect()
}

/// A quantity that the oracle draws as a picture.
fn averaged(
    world: &mut World,
    frame: OracleFrame,
    (quantity, shows): (Quantity, Shows),
) -> Result<QuantityImage, OracleError> {
    let camera = current_camera(world).ok().and_then(|entity| world.get::<Camera>(entity));
    let samples = camera.map(|camera| camera.samples).unwrap_or_default();
    let oracle = Oracle::new(world, frame.size)?
        .with_mode(frame.mode)
        .with_supersampling(frame.supersampling.unwrap_or_else(|| side(samples)))
        .showing(shows);
    let image: Image = oracle.draw();
    let channels = quantity.channels().len();
    let values = image.pixels().iter().flat_map(|pixel| &pixel[..channels]).map(|&value| value as f32).collect();
    Ok(QuantityImage { quantity, size: frame.size, values: QuantityValues::Floats(values) })
}

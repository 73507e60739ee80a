//! The surfaces that the reference renderer sees, for lines and quantities, and the cameras that share its picture.

use bevy_ecs::prelude::{Resource, World};
use bevy_ecs::system::SystemState;
use bevy_math::UVec2;
use halfway_lighting::{SharedPart, SharingCameras};
use halfway_reference::{Oracle, OracleError};
use halfway_render::Surfaces;

/// The size of the picture that the oracle drew last, until its quantities are written.
#[derive(Resource)]
pub(crate) struct OracleFrame(pub(crate) UVec2);

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

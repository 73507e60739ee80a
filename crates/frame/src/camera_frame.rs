//! Frames of cameras that share a picture.

use crate::batch::batches::Batches;
use crate::batch::lit_patches::LitPatches;
use crate::lights::gather::Lights;
use crate::passes::Passes;
use crate::view::camera::View;
use crate::view::select::{Representatives, Selected, Visible};
use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::*;

/// The newest frame of a camera, up to its draws, while the world has that of another: its next frame makes anew only
/// what has changed since.
#[derive(Debug, Default)]
pub struct CameraFrame {
    view: View,
    visible: Visible,
    representatives: Representatives,
    selected: Selected,
    lights: Lights,
    lit: LitPatches,
    batches: Batches,
    passes: Passes,
}

impl CameraFrame {
    /// Exchanges it for the one in the world, which counts as no change of the resources.
    pub fn exchange(&mut self, world: &mut World) {
        fn swap<T: Resource<Mutability = Mutable>>(world: &mut World, frame: &mut T) {
            if let Some(mut there) = world.get_resource_mut::<T>() {
                std::mem::swap(there.bypass_change_detection(), frame);
            }
        }
        swap(world, &mut self.view);
        swap(world, &mut self.visible);
        swap(world, &mut self.representatives);
        swap(world, &mut self.selected);
        swap(world, &mut self.lights);
        swap(world, &mut self.lit);
        swap(world, &mut self.batches);
        swap(world, &mut self.passes);
    }
}

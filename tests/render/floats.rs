//! Pictures in 32-bit floating point hold 32 bits, or are an error.

use crate::render::scene::{Scene, Thing, glowing};
use crate::render::stage::Stage;
use futures_lite::future::block_on;
use halfway::prelude::*;
use halfway::render::{Gpu, RenderError, wgpu};

/// 16 bits hold no more than 65,504.
const BRIGHT: f32 = 100_000.25;

/// A device of the adapter that supports formats only as WebGPU guarantees: no blending and no four samples of 32-bit
/// floats.
fn plain_device() -> Gpu {
    let mut gpu = Gpu::open_headless().expect("an adapter");
    let adapter = gpu.adapter.clone().expect("a device of its own has one");
    let descriptor = wgpu::DeviceDescriptor { required_limits: adapter.limits(), ..Default::default() };
    (gpu.device, gpu.queue) = block_on(adapter.request_device(&descriptor)).expect("a plain device");
    gpu
}

fn stage_on(gpu: Gpu) -> Stage {
    let mut stage = Stage::new(5, 5);
    stage.app.insert_resource(gpu);
    stage
}

fn bright(blend: bool, samples: Samples) -> Scene {
    let square = Thing::square(Vec3::NEG_Z * 2.0, Vec3::Z, 9.0).with_material(glowing(BRIGHT, 0.1, 1e-9));
    let mut scene = Scene::in_eye_space().with(if blend { square.blended(1.0) } else { square });
    scene.camera.samples = samples;
    scene
}

const NEEDS: [(bool, Samples); 4] =
    [(false, Samples::One), (true, Samples::One), (false, Samples::Four), (true, Samples::Four)];

#[test]
fn this_adapter_keeps_32_bits() {
    let mut stage = Stage::new(5, 5);
    for (blend, samples) in NEEDS {
        let pixel = stage.draw(&bright(blend, samples)).get_pixel(2, 2).0;
        assert_eq!(pixel, [BRIGHT, 0.1, 1e-9, 1.0], "blended {blend}, {samples:?}");
    }
}

#[test]
fn a_device_that_cannot_says_so_and_draws_what_it_can() {
    let mut stage = stage_on(plain_device());
    for (blend, samples) in NEEDS {
        stage.set(&bright(blend, samples));
        stage.pixels(Pixels::Float);
        let row = format!("blended {blend}, {samples:?}");
        match (stage.try_draw(), blend || samples == Samples::Four) {
            (Ok(Picture::Float(picture)), false) => {
                assert_eq!(picture.get_pixel(2, 2).0, [BRIGHT, 0.1, 1e-9, 1.0], "{row}");
            }
            (Err(error @ RenderError::FloatTarget { .. }), true) => {
                let said = error.to_string();
                assert!(said.contains(if blend { "blend" } else { "four samples" }), "{row}: {said}");
                assert!(said.contains("32-bit floats") && said.contains("expected"), "{row}: {said}");
            }
            (other, _) => panic!("{row}: {other:?}"),
        }
        // Bytes are blended and smoothed everywhere.
        assert_eq!(stage.bytes().get_pixel(2, 2).0[0], 255, "{row}");
    }
}

//! Memory in the steady state: with one thread a frame allocates nothing, and with more only the blocks that distribute
//! it.
//!
//! This is a program of its own, since the counting allocator is global, with one test, since it counts all threads.

#![allow(unsafe_code, reason = "an allocator is unsafe by its trait; this one only counts and hands on")]

#[path = "../examples/common/mod.rs"]
mod common;

use common::{Scene, Shading, sphere};
use halfway_lighting::Samples;
use halfway_raster::{ClearTiles, Output, PixelFormat, RasterOptions, Rasterizer};
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// The system's allocator, with a count of the allocated blocks.
struct Counting(AtomicUsize);

// SAFETY: every call is passed unchanged to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        self.0.fetch_add(1, Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        self.0.fetch_add(1, Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting(AtomicUsize::new(0));

const WARM_UP: usize = 3;
const FRAMES: usize = 8;

/// The blocks that N frames allocate, once warm, with scenes in turn.
fn blocks(scenes: &[Scene], threads: usize) -> usize {
    let mut rasterizer = Rasterizer::new(RasterOptions { width: None, threads: Some(threads) }).expect("threads");
    let most = scenes.iter().map(|scene| 4 * scene.size[0] as usize * scene.size[1] as usize).max().expect("scenes");
    let mut bytes = vec![0; most];
    let mut floats = vec![0.0; most];
    let mut clear_tiles = ClearTiles::default();
    let mut blocks = 0;
    for frame in 0..WARM_UP + FRAMES {
        for scene in scenes {
            let count = 4 * scene.size[0] as usize * scene.size[1] as usize;
            let output = match scene.pixels {
                PixelFormat::Floats => Output::Floats(&mut floats[..count]),
                _ => Output::Bytes(&mut bytes[..count]),
            };
            scene.with_pass(|pass| {
                let before = ALLOCATOR.0.load(Relaxed);
                rasterizer.draw(pass, output, &mut clear_tiles).expect("a sound pass");
                if frame >= WARM_UP {
                    blocks += ALLOCATOR.0.load(Relaxed) - before;
                }
            });
        }
    }
    blocks
}

/// Pictures of all kinds and sizes.
fn scenes() -> Vec<Scene> {
    let mut scenes = Vec::new();
    for shading in Shading::ALL {
        for samples in [Samples::One, Samples::Four] {
            for pixels in [PixelFormat::SrgbBytes, PixelFormat::Floats] {
                let mut scene = sphere(true, shading).expect("a sound mesh");
                (scene.samples, scene.pixels) = (samples, pixels);
                scene.draws[0].blend = shading == Shading::Flat;
                scenes.push(scene);
            }
        }
    }
    scenes.push(sphere(false, Shading::Phong).expect("a sound mesh"));
    scenes
}

#[test]
fn frames_allocate_nothing_once_warm() {
    let scenes = scenes();
    assert_eq!(blocks(&scenes, 1), 0, "with one thread");
    // To pass a picture to a thread the pool allocates one block, and another for each 63 entries of its queue. For the
    // last scene, which is large, the pieces are passed first, and then the picture.
    let pictures = scenes.len() * FRAMES;
    for threads in [2, 3] {
        let found = blocks(&scenes, threads);
        let handed_over = (threads - 1) * (pictures + FRAMES);
        println!("{found} blocks for {pictures} pictures with {threads} threads");
        assert!(
            found <= handed_over + handed_over / 63 + 1,
            "{found} blocks for {pictures} pictures, {threads} threads"
        );
    }
}

//! Memory in the steady state: a frame takes none that grows with the scene.
//!
//! This is a program of its own, since the counting allocator is global, with one test, since it counts all threads.

#![allow(unsafe_code, reason = "an allocator is unsafe by its trait; this one only counts and hands on")]

use halfway::prelude::*;
use halfway::render::{AdapterChoice, Gpu, wgpu};
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// The system's allocator, with a count of the allocated blocks and bytes.
struct Counting {
    blocks: AtomicUsize,
    bytes: AtomicUsize,
}

impl Counting {
    fn add(&self, bytes: usize) {
        self.blocks.fetch_add(1, Relaxed);
        self.bytes.fetch_add(bytes, Relaxed);
    }

    /// The blocks and bytes that some work allocates.
    fn count(&self, work: impl FnOnce()) -> [usize; 2] {
        let now = || [self.blocks.load(Relaxed), self.bytes.load(Relaxed)];
        let before = now();
        work();
        let after = now();
        [after[0] - before[0], after[1] - before[1]]
    }
}

// SAFETY: every call is passed unchanged to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        self.add(layout.size());
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        self.add(size);
        // SAFETY: as the caller promises.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting { blocks: AtomicUsize::new(0), bytes: AtomicUsize::new(0) };

/// Frames until buffers have their sizes.
const WARM_UP: usize = 8;
const FRAMES: usize = 16;
/// The most blocks of one frame. One without changes takes 71 to 77 on a software adapter, and 10 more if instances are
/// uploaded: nearly all of them wgpu's, for the pass, its commands, their submission and staging buffers.
const MOST_BLOCKS: usize = 110;
/// The most bytes of one frame; those blocks have 14,000 to 19,000.
const MOST_BYTES: usize = 32_000;
/// How many more blocks frames of many objects may take than frames of few: wgpu's own tables grow now and then.
const SLACK: usize = 4;

/// An App with `count` cubes in rows, all of them in the picture, in a few materials.
fn crowd(count: usize) -> App {
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::headless(UVec2::splat(32))).insert_resource(AdapterChoice::gpu());
    let world = app.world_mut();
    let side = (count as f32).sqrt().ceil();
    world.spawn((Camera::default(), Transform::from_xyz(0.0, 0.0, 2.0 * side)));
    world.spawn((PointLight::white(), Transform::from_xyz(0.5 * side, 0.5 * side, side)));
    world.spawn((DirectionalLight::white(), Transform::default()));
    let cube = world.resource_mut::<Assets<Mesh>>().add(Cuboid::new(0.5, 0.5, 0.5));
    for i in 0..count {
        let material = [Material::BRASS, Material::DEFAULT, Material::matte(LinearRgba::GREEN)][i % 3];
        let at = Vec3::new(i as f32 % side, (i as f32 / side).floor(), 0.0) - 0.5 * side;
        world.spawn((Mesh3d(cube.clone()), material, Transform::from_translation(at.with_z(0.0))));
    }
    app
}

fn turn(app: &mut App) {
    let world = app.world_mut();
    let mut objects = world.query_filtered::<&mut Transform, With<Mesh3d>>();
    for mut transform in objects.iter_mut(world) {
        transform.rotate_y(0.1);
    }
}

/// The most blocks, and the most bytes, of any frame in the steady state.
fn of_a_frame(count: usize, moving: bool) -> [usize; 2] {
    let mut app = crowd(count);
    let mut most = [0; 2];
    for frame in 0..WARM_UP + FRAMES {
        if moving {
            turn(&mut app);
        }
        let taken = ALLOCATOR.count(|| app.update());
        // If the previous frame is unfinished, the next one cannot reuse its buffers and allocates new ones.
        let device = &app.world().resource::<Gpu>().device;
        device.poll(wgpu::PollType::wait_indefinitely()).expect("the device finishes");
        if frame >= WARM_UP {
            most = [0, 1].map(|k| most[k].max(taken[k]));
        }
    }
    let report = app.world().resource::<FrameReport>();
    assert_eq!((report.visible as usize, report.errors.len()), (count, 0));
    assert_eq!(report.matrices as usize, if moving { count } else { 0 });
    most
}

#[test]
fn frames_allocate_no_more_for_more_objects() {
    for (row, moving) in [("static", false), ("moving", true)] {
        let counts = [100, 1_000, 10_000];
        let taken = counts.map(|count| of_a_frame(count, moving));
        println!("{row}: blocks and bytes a frame with {counts:?} objects: {taken:?}");
        let few = taken[0][0];
        for (count, [blocks, bytes]) in counts.into_iter().zip(taken) {
            let row = format!("{row}, {count} objects: {blocks} blocks and {bytes} bytes a frame");
            assert!(blocks <= MOST_BLOCKS && bytes <= MOST_BYTES, "{row}, not {MOST_BLOCKS} and {MOST_BYTES} at most");
            assert!(blocks <= few + SLACK, "{row}; {few} blocks with few objects");
        }
    }
}

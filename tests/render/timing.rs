//! The times of a frame, by the renderer's own clocks. No test depends on the machine's speed: times are compared with
//! each other, with the test's own clock around them, or with the time that a system slept.

use crate::render::compare::assert_identical;
use crate::render::scene::{Lamp, Scene, Thing, directional_light};
use crate::render::stage::Stage;
use bevy_transform::TransformSystems;
use halfway::prelude::*;
use halfway::render::{FrameTimes, Gpu, GpuTimer, SetTimes, wgpu};
use std::thread::sleep;
use std::time::{Duration, Instant};

const NAP: Duration = Duration::from_millis(20);

fn ball() -> Scene {
    Scene::seen_from(Vec3::Z * 3.0, Vec3::ZERO)
        .with(Thing::new(UvSphere::new(1.0, 64, 32)))
        .lit(Lamp::directional(directional_light(), Vec3::NEG_Z))
}

fn stage() -> Stage {
    let mut stage = Stage::new(64, 64);
    stage.set(&ball());
    stage
}

fn times(stage: &Stage) -> &FrameTimes {
    stage.app.world().resource::<FrameTimes>()
}

#[test]
fn a_frames_sets_take_no_longer_than_the_frame() {
    let mut stage = stage();
    assert_eq!(*times(&stage).newest(), SetTimes::default(), "before the first frame");
    for frame in 0..3 {
        let start = Instant::now();
        stage.frame();
        let whole = start.elapsed();
        let newest = *times(&stage).newest();
        assert!(newest.total() <= whole, "frame {frame}: {:?} of {whole:?}", newest.total());
        // Encoding and submitting a pass takes more than a tick of any clock.
        assert!(newest.duration(RenderSet::Draw) > Duration::ZERO, "frame {frame}: {newest:?}");
        assert_eq!(newest.display(), Duration::ZERO, "there is no display");
    }
    assert!(times(&stage).smoothed().total() > Duration::ZERO);
}

/// Sleeps in `set`, and draws three frames.
fn with_a_nap_in(set: RenderSet) -> SetTimes {
    let mut stage = stage();
    stage.app.add_systems(PostUpdate, (|| sleep(NAP)).in_set(set));
    for _ in 0..3 {
        stage.frame();
    }
    *times(&stage).newest()
}

#[test]
fn a_slow_system_counts_to_its_own_set() {
    for slow in RenderSet::ALL {
        let newest = with_a_nap_in(slow);
        assert!(newest.duration(slow) >= NAP, "{slow:?}: {newest:?}");
    }
}

#[test]
fn systems_outside_of_the_sets_do_not_count() {
    let mut stage = stage();
    stage.app.add_systems(Update, || sleep(NAP));
    stage.app.add_systems(PostUpdate, (|| sleep(NAP)).before(RenderSet::View).before(TransformSystems::Propagate));
    stage.app.add_systems(PostUpdate, (|| sleep(NAP)).after(RenderSet::Deliver));
    stage.app.add_systems(Last, || sleep(NAP));
    for _ in 0..3 {
        let start = Instant::now();
        stage.frame();
        let whole = start.elapsed();
        let total = times(&stage).newest().total();
        assert!(total + 4 * NAP <= whole, "{total:?} of {whole:?}, of which {:?} are others'", 4 * NAP);
    }
}

#[test]
fn the_gpu_is_timed_where_it_can_be_and_is_asked_to() {
    let mut stage = stage();
    stage.frame();
    assert!(!stage.app.world().contains_resource::<GpuTimer>(), "nobody asked");
    stage.world().init_resource::<GpuTimer>();
    let can = stage
        .app
        .world()
        .resource::<Gpu>()
        .adapter
        .as_ref()
        .expect("an adapter")
        .features()
        .contains(wgpu::Features::TIMESTAMP_QUERY);
    for frame in 0..20 {
        // Reading the picture waits for the GPU, so that the time of every frame has arrived by the next but one.
        stage.float();
        let timer = stage.app.world().resource::<GpuTimer>();
        if !can {
            assert_eq!((timer.newest(), timer.smoothed()), (None, None), "without a clock");
        } else if frame >= 2 {
            let (newest, smoothed) = (timer.newest(), timer.smoothed());
            assert!(newest.is_some() && smoothed.is_some(), "frame {frame}: {newest:?}, {smoothed:?}");
        }
    }
    if can {
        // A clock may be too coarse for one pass; not for the mean of eighteen.
        let smoothed = stage.app.world().resource::<GpuTimer>().smoothed();
        assert!(smoothed > Some(Duration::ZERO), "{smoothed:?}");
    }
}

#[test]
fn the_gpus_time_is_within_the_frames() {
    let mut stage = stage();
    stage.world().init_resource::<GpuTimer>();
    let start = Instant::now();
    for _ in 0..10 {
        stage.float();
    }
    let all = start.elapsed();
    if let Some(newest) = stage.app.world().resource::<GpuTimer>().newest() {
        assert!(newest < all, "one pass of ten took {newest:?}, and all ten {all:?}");
    }
}

#[test]
fn timing_the_gpu_changes_no_pixel() {
    let mut stage = stage();
    let plain = stage.float();
    stage.world().init_resource::<GpuTimer>();
    for _ in 0..6 {
        assert_identical("timed", &plain, &stage.float());
    }
    stage.world().remove_resource::<GpuTimer>();
    assert_identical("no longer timed", &plain, &stage.float());
    // Inserted anew while the old one's buffers may still be on their way.
    stage.world().init_resource::<GpuTimer>();
    assert_identical("timed again", &plain, &stage.float());
}

#[test]
fn frames_that_nobody_waits_for_are_timed_too() {
    let mut stage = stage();
    stage.world().init_resource::<GpuTimer>();
    for _ in 0..200 {
        stage.frame();
    }
    // Pending times arrive with this frame.
    stage.float();
    let errors = &stage.frame().errors;
    assert!(errors.is_empty(), "{errors:?}");
    let world = stage.app.world();
    let can = world.resource::<Gpu>().device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
    assert_eq!(world.resource::<GpuTimer>().newest().is_some(), can);
}

//! A part of a recording equals the same frames of the whole.

use bevy_app::{App, Update};
use bevy_ecs::prelude::*;
use bevy_math::UVec2;
use halfway_lighting::{Camera, Intensity};
use halfway_record::{Continue, FrameToDraw, Recording, ReferenceDrawing, record_with};
use halfway_render::{Headless, Picture};
use std::ops::{ControlFlow, Range};

const SIZE: UVec2 = UVec2::new(40, 30);

/// The sizes that frames ran at.
#[derive(Resource, Default)]
struct Sizes(Vec<UVec2>);

/// The red of the background, another in each frame.
const REDS: [f32; 6] = [8.0, 4.0, 2.0, 2.0, 1.0, 0.5];

/// The frames drawn by the oracle, and the sizes that all frames ran at.
fn recorded(frames: Range<u32>, intensity: Intensity) -> (Vec<(u32, f32)>, Vec<UVec2>) {
    let mut app = App::new();
    app.init_resource::<Sizes>();
    app.world_mut().spawn(Camera { intensity, ..Camera::default() });
    app.add_systems(Update, |headless: Res<Headless>, mut sizes: ResMut<Sizes>, mut camera: Single<&mut Camera>| {
        camera.background.red = REDS[sizes.0.len()];
        sizes.0.push(headless.size);
    });
    let folder = tempfile::tempdir().expect("a folder");
    let recording = Recording { frames, size: SIZE, ..Recording::new(folder.path().join("{}.exr")) };
    let (drawing, mut drawn) = (ReferenceDrawing::default(), Vec::new());
    let draw = |app: &mut App, frame: FrameToDraw| {
        let picture = drawing.picture(app, frame, &|_, _| ControlFlow::Continue(()))?;
        let Picture::Float(floats) = &picture else { panic!("a picture of floats") };
        assert_eq!(UVec2::from(floats.dimensions()), SIZE);
        drawn.push((frame.number, floats.get_pixel(1, 1).0[0]));
        Ok(picture)
    };
    record_with(&mut app, &recording, draw, |_, _| Continue::Yes).expect("it is drawn and written");
    let sizes = std::mem::take(&mut app.world_mut().resource_mut::<Sizes>().0);
    (drawn, sizes)
}

#[test]
fn frames_before_the_first_run_and_are_small() {
    let (whole, sizes) = recorded(0..6, Intensity::Clamp);
    assert_eq!(sizes, [SIZE; 6]);
    let (part, sizes) = recorded(3..6, Intensity::Clamp);
    let small = UVec2::new(2, 1);
    assert_eq!(sizes, [small, small, small, SIZE, SIZE, SIZE]);
    assert_eq!(part, whole[3..]);
}

#[test]
fn dependent_frames_before_the_first_are_drawn_in_full() {
    let smoothed = Intensity::Renormalize { smoothing: 0.75 };
    let (whole, _) = recorded(0..6, smoothed);
    let (part, sizes) = recorded(3..6, smoothed);
    assert_eq!(sizes, [SIZE; 6]);
    assert_eq!((part.len(), &part[3..]), (6, &whole[3..]));
    // The result if the frames before were not drawn.
    assert!((recorded(3..6, Intensity::Renormalize { smoothing: 0.0 }).0[0].1 - part[3].1).abs() > 0.1);
}

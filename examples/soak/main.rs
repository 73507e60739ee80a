//! A long run: lights move, objects and a light come and go, meshes are replaced in place, materials change; for
//! 100,000 frames. It fails if memory grows, if a frame has an error, or if the last picture differs from that of the
//! same scene in a new App.
//!
//! ```text
//! cargo run --release --example soak
//! cargo run --release --example soak -- --frames 3000
//! cargo run --release --example soak -- --frames 3000 --leak
//! ```
//!
//! With `--leak` it keeps a handle of every mesh, and so has to fail.

#![allow(unsafe_code, reason = "an allocator is unsafe by its trait; this one only counts and hands on")]

mod memory;
mod scene;

use halfway::prelude::*;
use halfway::render::PendingPicture;
use memory::Memory;
use scene::Life;
use std::error::Error;
use std::process::ExitCode;

#[global_allocator]
static ALLOCATOR: memory::Counting = memory::Counting::new();

const FRAMES: u64 = 100_000;
/// Frames until buffers, caches and pipelines have their sizes.
const WARM_UP: u64 = 1_000;
/// The interval of memory samples, in frames. It shares no factor with the periods of the scene, so that the largest of
/// some samples is near the true maximum.
const LOOK: u64 = 7;
/// A picture is read back this often, in frames.
const READ: u64 = 500;
/// The program's own bytes on the heap may grow by this much from the first frames after the warm-up to the last:
/// tables double when a rare frame has more of something. `--leak` grows by more than this.
const SLACK_LIVE: u64 = 64 << 10;
/// The resident memory, including the driver's, may grow by this much: allocators keep pages in reserve.
const SLACK_RESIDENT: u64 = 4 << 20;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let frames = match arguments.iter().position(|argument| argument == "--frames") {
        Some(at) => {
            arguments.get(at + 1).and_then(|number| number.parse().ok()).ok_or("--frames: expected a number")?
        }
        None => FRAMES,
    };
    if frames < 2 * WARM_UP {
        return Err(format!("--frames {frames}: expected at least {}", 2 * WARM_UP).into());
    }
    let mut life = Life::new(arguments.iter().any(|argument| argument == "--leak"));
    let tenth = (frames - WARM_UP) / 10;
    // The most of the first tenth after the warm-up, and of the last.
    let (mut first, mut last) = (Memory::default(), Memory::default());
    println!("{:>8} {:>16} {:>16}", "frame", "live bytes", "resident bytes");
    for frame in 1..=frames {
        life.step(frame);
        life.app.update();
        if let Some(error) = life.app.world().resource::<FrameReport>().errors.first() {
            return Err(format!("frame {frame}: {error}").into());
        }
        if frame % READ == 0 {
            PendingPicture::request(life.app.world())?.wait()?;
        }
        if frame > WARM_UP && frame % LOOK == 0 {
            let now = Memory::now(&ALLOCATOR);
            if frame <= WARM_UP + tenth {
                first = first.max(now);
            } else if frame > frames - tenth {
                last = last.max(now);
            }
        }
        if frame == WARM_UP || frame % (frames / 10) == 0 {
            let Memory { live, resident } = Memory::now(&ALLOCATOR);
            println!("{frame:8} {live:16} {resident:16}");
        }
    }
    println!("the most of the first tenth after {WARM_UP} frames: {} live, {} resident", first.live, first.resident);
    println!("the most of the last tenth: {} live, {} resident", last.live, last.resident);
    for (what, first, last, slack) in
        [("live", first.live, last.live, SLACK_LIVE), ("resident", first.resident, last.resident, SLACK_RESIDENT)]
    {
        if last > first + slack {
            return Err(format!("memory grows: {first} bytes {what} became {last}, {slack} more being allowed").into());
        }
    }
    if life.settled_picture()? != life.fresh()?.settled_picture()? {
        return Err("the last picture is another than that of the same scene in a new App".into());
    }
    println!("the last picture is that of the same scene in a new App");
    Ok(())
}

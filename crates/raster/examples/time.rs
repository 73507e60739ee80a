//! How long scenes S1 and S4 take, by shading, width and threads, in milliseconds a frame: with one thread the mean of
//! what it was running (on Linux; so a busy machine disturbs less), with two the shortest.
//!
//! `cargo run --release -p halfway_raster --example time [FRAMES [FOLDER]]`; pictures go into the folder, unless it is `-`.
//! Only what has the words of `ONLY` in its line is timed, such as `ONLY="S1 avx2 1"`, and of the shadings those that it
//! names, if any, as in `ONLY="S1 avx2 1 Phong"`.

mod common;

use common::{Shading, sphere};
use halfway_raster::{Output, RasterOptions, Rasterizer, SampleCount, VectorWidth};
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let frames: u32 = arguments.next().map_or(Ok(200), |argument| argument.parse())?;
    let folder = arguments.next().filter(|folder| folder != "-");
    let only = std::env::var("ONLY").unwrap_or_default();
    let named = |shading: &Shading| only.split_whitespace().any(|word| word == format!("{shading:?}"));
    let mut shadings: Vec<_> = Shading::ALL.into_iter().filter(named).collect();
    let only: Vec<_> =
        only.split_whitespace().filter(|word| !Shading::ALL.iter().any(|s| format!("{s:?}") == **word)).collect();
    if shadings.is_empty() {
        shadings.extend(Shading::ALL);
    }
    println!("{:12}{:>8}{:>8} {shadings:?}", "scene", "width", "threads");
    for (small, samples, name) in
        [(false, SampleCount::One, "S1"), (false, SampleCount::Four, "S1x4"), (true, SampleCount::One, "S4")]
    {
        for width in VectorWidth::available() {
            for threads in [1, 2] {
                let mut rasterizer = Rasterizer::new(RasterOptions { width: Some(width), threads: Some(threads) })?;
                let line = format!("{name:12}{:>8}{threads:>8}", width.to_string());
                if !only.iter().all(|&word| line.split_whitespace().any(|found| found == word)) {
                    continue;
                }
                print!("{line}");
                for &shading in &shadings {
                    let mut scene = sphere(small, shading)?;
                    scene.samples = samples;
                    let mut bytes = vec![0; 4 * scene.size[0] as usize * scene.size[1] as usize];
                    let mut shortest = f64::INFINITY;
                    let first = running();
                    for _ in 0..frames {
                        let start = Instant::now();
                        scene.with_pass(|pass| rasterizer.draw(pass, Output::Bytes(&mut bytes)))?;
                        shortest = shortest.min(start.elapsed().as_secs_f64());
                    }
                    let mean = first.zip(running()).map(|(first, last)| (last - first) / f64::from(frames));
                    print!(" {:8.3}", 1e3 * mean.filter(|_| threads == 1).unwrap_or(shortest));
                    if let Some(folder) = folder.as_ref().filter(|_| threads == 1) {
                        write_png(&format!("{folder}/{name}_{shading:?}_{width}.png"), scene.size, &bytes)?;
                    }
                }
                println!();
            }
        }
    }
    Ok(())
}

/// For how many seconds this thread has been running.
fn running() -> Option<f64> {
    let line = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(line.split_whitespace().next()?.parse::<f64>().ok()? * 1e-9)
}

fn write_png(path: &str, [width, height]: [u32; 2], bytes: &[u8]) -> Result<(), Box<dyn Error>> {
    let mut encoder = png::Encoder::new(std::fs::File::create(path)?, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header()?.write_image_data(bytes)?;
    Ok(())
}

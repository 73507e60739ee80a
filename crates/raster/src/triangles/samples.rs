//! The positions of a pixel's samples.

use halfway_lighting::Samples;

/// The positions of the four samples, in sixteenths of a pixel from its center.
const PLACES: [[i32; 2]; 4] = [[-2, -6], [6, -2], [-6, 2], [2, 6]];

/// The same in steps of the grid.
pub(crate) const GRID_PLACES: [[i32; 2]; 4] = [[-32, -96], [96, -32], [-96, 32], [32, 96]];

/// The same in pixels, by axis.
pub(crate) const OFFSETS: [[f32; 4]; 2] = [[-0.125, 0.375, -0.375, 0.125], [-0.375, -0.125, 0.125, 0.375]];

/// The positions of samples in steps of the grid; the center for one sample.
pub(crate) fn sample_offsets(samples: Samples) -> [[i32; 2]; 4] {
    match samples {
        Samples::One => [[0; 2]; 4],
        _ => GRID_PLACES,
    }
}

/// The mean of the covered samples, in pixels from the center, by their bits from 0 (the center itself is covered) to 15.
pub(crate) const CENTROIDS: [[f32; 2]; 16] = centroids();

const fn centroids() -> [[f32; 2]; 16] {
    let mut means = [[0.0; 2]; 16];
    let mut mask = 1;
    while mask < 15 {
        let (mut sum, mut count, mut sample) = ([0, 0], 0, 0);
        while sample < 4 {
            if mask >> sample & 1 == 1 {
                sum = [sum[0] + PLACES[sample][0], sum[1] + PLACES[sample][1]];
                count += 1;
            }
            sample += 1;
        }
        means[mask] = [sum[0] as f32 / (16 * count) as f32, sum[1] as f32 / (16 * count) as f32];
        mask += 1;
    }
    means
}

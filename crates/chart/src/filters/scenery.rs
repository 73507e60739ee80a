//! The inputs of the filters: images on a plane, and the views of it.

use halfway::texture::{PictureMap, Pyramid, TexelImage};

/// Texels along a side of the images.
const SIDE: u32 = 256;

/// An image that the filters are tried on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChartedImage {
    /// Squares of 8 × 8 texels, black and white.
    Checkerboard,
    /// Noise of colors whose amplitude falls with the frequency, as that of photographs does (Field 1987).
    Noise,
}

impl ChartedImage {
    /// All.
    pub const ALL: [Self; 2] = [Self::Checkerboard, Self::Noise];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Checkerboard => "checkerboard",
            Self::Noise => "noise as of photographs",
        }
    }

    /// The image with its pyramid. It repeats without seams.
    pub fn pyramid(self) -> Pyramid {
        let texel = |x: u32, y: u32| match self {
            Self::Checkerboard => {
                let white = (x / 8 + y / 8) % 2 == 1;
                if white { [0.9, 0.9, 0.85, 1.0] } else { [0.05, 0.05, 0.08, 1.0] }
            }
            Self::Noise => {
                let [gray, r, g, b] = [0, 1, 2, 3].map(|seed| noise(x, y, seed));
                let color = |own: f64| (0.45 + 0.55 * gray + 0.25 * own).clamp(0.0, 1.0) as f32;
                [color(r), color(g), color(b), 1.0]
            }
        };
        match TexelImage::from_fn(SIDE, SIDE, texel) {
            Ok(image) => Pyramid::new(image),
            // The size is within the limits and every number finite.
            Err(_) => Pyramid::missing(),
        }
    }
}

/// Octaves of smooth noise of one amplitude each: in two dimensions that is an amplitude like 1/f. About −1 to 1.
fn noise(x: u32, y: u32, seed: u32) -> f64 {
    let mut sum = 0.0;
    for octave in 1..=7_u32 {
        let cell = SIDE >> octave;
        let lattice = |i: u32, j: u32| {
            let [i, j] = [i % (1 << octave), j % (1 << octave)];
            let mut bits = i.wrapping_mul(0x9E37_79B1)
                ^ j.wrapping_mul(0x85EB_CA77)
                ^ (octave << 8 | seed).wrapping_mul(0xC2B2_AE3D);
            bits = (bits ^ bits >> 15).wrapping_mul(0x2C1B_3C6D);
            bits = (bits ^ bits >> 12).wrapping_mul(0x297A_2D39);
            f64::from(bits ^ bits >> 15) / f64::from(u32::MAX) * 2.0 - 1.0
        };
        let [(i, f), (j, g)] = [x, y].map(|at| {
            let part = f64::from(at % cell) / f64::from(cell);
            (at / cell, part * part * (3.0 - 2.0 * part))
        });
        let row = |j: u32| lattice(i, j) + f * (lattice(i + 1, j) - lattice(i, j));
        sum += row(j) + g * (row(j + 1) - row(j));
    }
    sum / 3.5
}

/// A view of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterView {
    /// Degrees between the view and the plane's normal.
    pub tilt: f64,
    /// The rotation of the image on the plane, in degrees.
    pub turn: f64,
}

impl FilterView {
    /// Upright and rotated: seen from above, at two slants, and toward the horizon.
    pub const ALL: [Self; 8] = [
        Self { tilt: 0.0, turn: 0.0 },
        Self { tilt: 0.0, turn: 30.0 },
        Self { tilt: 45.0, turn: 0.0 },
        Self { tilt: 45.0, turn: 30.0 },
        Self { tilt: 70.0, turn: 0.0 },
        Self { tilt: 70.0, turn: 30.0 },
        Self { tilt: 85.0, turn: 0.0 },
        Self { tilt: 85.0, turn: 30.0 },
    ];
    /// The views of the moving camera.
    pub const MOVING: [Self; 2] = [Self::ALL[5], Self::ALL[7]];

    /// In words.
    pub fn name(self) -> String {
        format!("{}°{}", self.tilt, if self.turn == 0.0 { "" } else { ", turned" })
    }

    /// The map from the pixels of a picture of this size to the image, after `frame` frames of the camera's motion over
    /// the plane.
    ///
    /// The camera is one unit away from the plane, and opens 60°. A unit has 300 texels where it is seen from above, 3
    /// a pixel of pictures 120 pixels high, and 100 elsewhere, 1 a pixel near the lower edge. Between two frames the
    /// camera moves by 0.4 texels to the side and 0.9 forward.
    pub fn map(self, [width, height]: [u32; 2], frame: u32) -> PictureMap {
        let [width, height] = [f64::from(width), f64::from(height)];
        let focal = 0.5 * height / 30_f64.to_radians().tan();
        let texels = if self.tilt == 0.0 { 300.0 } else { 100.0 } * height / 120.0 / f64::from(SIDE);
        let ((sin, cos), (s, c)) = (self.tilt.to_radians().sin_cos(), self.turn.to_radians().sin_cos());
        // With X and Y on the picture's plane, one unit before the eye, the ray (X, Y·cos + sin, Y·sin − cos) hits the
        // ground after 1/(cos − Y·sin).
        let x = [1.0 / focal, 0.0, -0.5 * width / focal];
        let y = [0.0, -1.0 / focal, 0.5 * height / focal];
        let both = |a: f64, b: f64, constant: f64| -> [f64; 3] {
            std::array::from_fn(|k| a * x[k] + b * y[k] + if k == 2 { constant } else { 0.0 })
        };
        let (right, ahead, w) = (both(1.0, 0.0, 0.0), both(0.0, cos, sin), both(0.0, -sin, cos));
        let moved = [0.4, 0.9].map(|step| step * f64::from(frame) / f64::from(SIDE) + 0.137);
        let row = |a: f64, b: f64, offset: f64| -> [f64; 3] {
            std::array::from_fn(|k| texels * (a * right[k] + b * ahead[k]) + offset * w[k])
        };
        // v runs downward on the image.
        PictureMap { rows: [row(c, s, moved[0]), row(s, -c, -moved[1]), w] }
    }
}

//! An image and its halves.

use std::sync::Arc;

use crate::texels::TexelImage;

/// One image of a pyramid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level {
    /// Texels in a row, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// The number of its first texel in [`Pyramid::texels`].
    pub start: usize,
}

/// An image, and images of half its width and height (rounded down, at least 1), and so on down to one texel: 4/3 of the
/// image's memory, a little more for odd sizes. Its clones share their texels.
///
/// Each level is made of the one before it, in linear light: a texel is the mean of what lies under it, by area. Of even
/// sizes these are four texels; of odd ones three in a row count, two of them in part. So no level is brighter or darker than
/// the image as a whole, none leaves the range of its texels, and none depends on what lies beyond the image.
#[derive(Clone, Debug, PartialEq)]
pub struct Pyramid {
    levels: Arc<[Level]>,
    texels: Arc<[[f32; 4]]>,
}

impl Pyramid {
    /// The pyramid over an image.
    pub fn new(image: TexelImage) -> Self {
        let [mut width, mut height] = image.size();
        let mut levels = vec![Level { width, height, start: 0 }];
        let mut texels = image.into_texels();
        while width.max(height) > 1 {
            let before = levels[levels.len() - 1];
            (width, height) = ((width / 2).max(1), (height / 2).max(1));
            let start = texels.len();
            let narrower = halved(&texels[before.start..], [before.width, before.height], width);
            let turned = transposed(&narrower, width, before.height);
            let lower = halved(&turned, [before.height, width], height);
            texels.extend(transposed(&lower, height, width));
            levels.push(Level { width, height, start });
        }
        Self { levels: levels.into(), texels: texels.into() }
    }

    /// What stands for an image that is missing or broken: a checker of magenta and black, 8 × 8.
    pub fn missing() -> Self {
        let texel = |at: u32| [[1.0, 0.0, 1.0, 1.0], [0.0, 0.0, 0.0, 1.0]][((at + at / 8) % 2) as usize];
        Self::new(TexelImage::checked(8, 8, (0..64).map(texel).collect()))
    }

    /// Columns and rows of the image itself.
    pub fn size(&self) -> [u32; 2] {
        [self.levels[0].width, self.levels[0].height]
    }

    /// The levels, the image itself first, one texel last.
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// The texels of all levels, one after the other, each row by row.
    pub fn texels(&self) -> &[[f32; 4]] {
        &self.texels
    }

    /// The texels of one level.
    ///
    /// # Panics
    /// There is no such level.
    pub fn level(&self, number: usize) -> &[[f32; 4]] {
        let Level { width, height, start } = self.levels[number];
        &self.texels[start..start + width as usize * height as usize]
    }

    /// Whether the two are clones of each other.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.texels, &other.texels)
    }
}

/// Rows of `width` texels from rows of `size[0]`, each texel the mean of what lies under it.
fn halved(texels: &[[f32; 4]], size: [u32; 2], width: u32) -> Vec<[f32; 4]> {
    let [from, height] = size.map(|side| side as usize);
    let width = width as usize;
    let share = from as f64 / width as f64;
    let mut means = Vec::with_capacity(width * height);
    for row in texels[..from * height].chunks_exact(from) {
        for x in 0..width {
            // From share·x to share·(x + 1), in whole numbers: over `width`.
            let (low, high) = (x * from, (x + 1) * from);
            let mut sum = [0.0_f64; 4];
            for (at, texel) in row.iter().enumerate().take(high.div_ceil(width)).skip(low / width) {
                let covered = ((at + 1) * width).min(high) - (at * width).max(low);
                for (sum, number) in sum.iter_mut().zip(texel) {
                    *sum += covered as f64 * f64::from(*number);
                }
            }
            means.push(sum.map(|sum| (sum / (share * width as f64)) as f32));
        }
    }
    means
}

fn transposed(texels: &[[f32; 4]], width: u32, height: u32) -> Vec<[f32; 4]> {
    let (width, height) = (width as usize, height as usize);
    (0..width).flat_map(|x| (0..height).map(move |y| (x, y))).map(|(x, y)| texels[y * width + x]).collect()
}

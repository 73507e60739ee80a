//! An image and its halves along each axis.

use crate::halves::{Level, half, lower, narrower};

/// An image, and for each pair of halvings, (i, j), the image that is halved i times in width and j times in height,
/// down to one texel: 4 times the image's memory: a ripmap (Akenine-Möller et al., *Real-Time Rendering*, on
/// anisotropic filters).
///
/// Each is made by area means, as the levels of a [`Pyramid`](crate::Pyramid).
///
/// ```
/// use halfway_texture::{Pyramid, TexelImage};
///
/// let pyramid = Pyramid::new(TexelImage::from_fn(8, 8, |x, y| [(x + y) as f32; 4])?);
/// let (level, texels) = pyramid.ripmap().level([3, 0]);
/// assert_eq!((level.width, level.height, texels[0][0]), (1, 8, 3.5));
/// # Ok::<(), halfway_texture::TextureError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Ripmap {
    columns: usize,
    levels: Vec<Level>,
    texels: Vec<[f32; 4]>,
}

impl Ripmap {
    /// From the texels of an image of this size.
    pub(crate) fn new(texels: &[[f32; 4]], [width, height]: [u32; 2]) -> Self {
        let [columns, rows] = [width, height].map(|side| side.ilog2() as usize + 1);
        let mut made =
            Self { columns, levels: Vec::new(), texels: texels[..width as usize * height as usize].to_vec() };
        made.levels.push(Level { width, height, start: 0 });
        for j in 0..rows {
            if j > 0 {
                let above = made.levels[(j - 1) * columns];
                let source = &made.texels[above.start..];
                made.add(
                    lower(source, [above.width, above.height], half(above.height)),
                    above.width,
                    half(above.height),
                );
            }
            for i in 1..columns {
                let left = made.levels[j * columns + i - 1];
                let source = &made.texels[left.start..][..left.width as usize * left.height as usize];
                made.add(narrower(source, [left.width, left.height], half(left.width)), half(left.width), left.height);
            }
        }
        made
    }

    fn add(&mut self, texels: Vec<[f32; 4]>, width: u32, height: u32) {
        self.levels.push(Level { width, height, start: self.texels.len() });
        self.texels.extend(texels);
    }

    /// The number of widths, and of heights.
    pub fn counts(&self) -> [usize; 2] {
        [self.columns, self.levels.len() / self.columns]
    }

    /// The image that is halved i times in width and j times in height, and its texels row by row.
    ///
    /// # Panics
    /// There is no such image.
    pub fn level(&self, [i, j]: [usize; 2]) -> (Level, &[[f32; 4]]) {
        assert!(i < self.columns, "{i} of {} widths", self.columns);
        let level = self.levels[j * self.columns + i];
        (level, &self.texels[level.start..][..level.width as usize * level.height as usize])
    }

    /// All texels.
    pub fn texels(&self) -> &[[f32; 4]] {
        &self.texels
    }
}

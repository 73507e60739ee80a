//! Mipmap pyramids.

use std::sync::{Arc, OnceLock};

use crate::halves::{Level, half, lower, narrower};
use crate::moments::moments;
use crate::ripmap::Ripmap;
use crate::sums::SummedAreas;
use crate::texels::TexelImage;

/// A mipmap pyramid: an image, and images of half its width and height (rounded down, at least 1), and so on down to
/// one texel: 4/3 of the image's memory, a little more for odd sizes. Clones share the texels.
///
/// Each level is made of the one before it, in linear light: a texel is the mean of the area under it. Of even sizes
/// these are four texels; of odd ones three in a row, two of them in part. So every level has the mean of the image,
/// stays in the range of its texels, and does not depend on the wrapping.
///
/// [`Ripmap`], [`SummedAreas`] and [moments](Self::moments), which some filters and highlights need, are made on first
/// use and shared by the clones.
///
/// ```
/// use halfway_texture::{Pyramid, TexelImage};
///
/// let pyramid = Pyramid::new(TexelImage::from_fn(8, 4, |x, _| [x as f32; 4])?);
/// assert_eq!(pyramid.levels().len(), 4); // 8 × 4, 4 × 2, 2 × 1, 1 × 1
/// assert_eq!(pyramid.level(3), [[3.5; 4]]);
/// # Ok::<(), halfway_texture::TextureError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Pyramid {
    levels: Arc<[Level]>,
    texels: Arc<[[f32; 4]]>,
    more: Arc<More>,
}

#[derive(Debug, Default)]
struct More {
    ripmap: OnceLock<Ripmap>,
    sums: OnceLock<SummedAreas>,
    moments: OnceLock<[Pyramid; 2]>,
}

impl PartialEq for Pyramid {
    fn eq(&self, other: &Self) -> bool {
        self.levels == other.levels && self.texels == other.texels
    }
}

impl Pyramid {
    /// The pyramid over an image.
    pub fn new(image: TexelImage) -> Self {
        let [mut width, mut height] = image.size();
        let mut levels = vec![Level { width, height, start: 0 }];
        let mut texels = image.into_texels();
        while width.max(height) > 1 {
            let before = levels[levels.len() - 1];
            (width, height) = (half(width), half(height));
            let start = texels.len();
            let slim = narrower(&texels[before.start..], [before.width, before.height], width);
            texels.extend(lower(&slim, [width, before.height], height));
            levels.push(Level { width, height, start });
        }
        Self { levels: levels.into(), texels: texels.into(), more: Arc::default() }
    }

    /// The placeholder for a missing or broken image: a checker of magenta and black, 8 × 8.
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

    /// The image and its halves along each axis: 4 times the image's memory beside the pyramid's, cached from the first
    /// call on.
    pub fn ripmap(&self) -> &Ripmap {
        self.more.ripmap.get_or_init(|| Ripmap::new(&self.texels, self.size()))
    }

    /// The sums of the image's texels: twice the image's memory beside the pyramid's, cached from the first call on.
    pub fn summed_areas(&self) -> &SummedAreas {
        self.more.sums.get_or_init(|| SummedAreas::new(&self.texels, self.size()))
    }

    /// For a normal map, its slopes and their products: two more images with their pyramids, cached from the first call
    /// on. [`SlopeSpread`](crate::normals::SlopeSpread) explains their use.
    pub fn moments(&self) -> &[Self; 2] {
        let [width, height] = self.size();
        let made = || moments(self.level(0)).map(|texels| Self::new(TexelImage::checked(width, height, texels)));
        self.more.moments.get_or_init(made)
    }

    /// Whether one is a clone of the other.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.texels, &other.texels)
    }
}

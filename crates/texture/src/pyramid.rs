//! An image and its halves.

use std::sync::{Arc, OnceLock};

use crate::halves::{Level, half, lower, narrower};
use crate::moments::moments;
use crate::ripmap::Ripmap;
use crate::sums::SummedAreas;
use crate::texels::TexelImage;

/// An image, and images of half its width and height (rounded down, at least 1), and so on down to one texel: 4/3 of
/// the image's memory, a little more for odd sizes. Its clones share their texels.
///
/// Each level is made of the one before it, in linear light: a texel is the mean of what lies under it, by area. Of
/// even sizes these are four texels; of odd ones three in a row count, two of them in part. So no level is brighter or
/// darker than the image as a whole, none leaves the range of its texels, and none depends on what lies beyond the
/// image.
///
/// [`Ripmap`], [`SummedAreas`] and [moments](Self::moments), which some filters and highlights need, are made when they
/// are first asked for, and shared by the clones.
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

    /// The image and its halves along each axis: 4 times the image's memory beside the pyramid's, kept from the first
    /// call on.
    pub fn ripmap(&self) -> &Ripmap {
        self.more.ripmap.get_or_init(|| Ripmap::new(&self.texels, self.size()))
    }

    /// The sums of the image's texels: twice the image's memory beside the pyramid's, kept from the first call on.
    pub fn summed_areas(&self) -> &SummedAreas {
        self.more.sums.get_or_init(|| SummedAreas::new(&self.texels, self.size()))
    }

    /// Of an image of normals the slopes, and their products: two more images with their pyramids, kept from the first
    /// call on. [`SlopeSpread`](crate::normals::SlopeSpread) says what they are for.
    pub fn moments(&self) -> &[Self; 2] {
        let [width, height] = self.size();
        let made = || moments(self.level(0)).map(|texels| Self::new(TexelImage::checked(width, height, texels)));
        self.more.moments.get_or_init(made)
    }

    /// Whether the two are clones of each other.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.texels, &other.texels)
    }
}

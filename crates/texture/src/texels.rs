//! An image of four numbers a texel.

use crate::error::TextureError;
use crate::limits::{LONGEST_SIDE, MOST_TEXELS};

/// Red, green, blue and alpha in linear light, or four values of data, row by row from the top. All are finite.
///
/// ```
/// use halfway_texture::TexelImage;
///
/// let gradient = TexelImage::from_fn(256, 1, |x, _| [x as f32 / 255.0, 0.0, 0.0, 1.0])?;
/// assert_eq!((gradient.size(), gradient.texels()[255][0]), ([256, 1], 1.0));
/// # Ok::<(), halfway_texture::TextureError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TexelImage {
    width: u32,
    height: u32,
    texels: Vec<[f32; 4]>,
    /// The size in its file, if it was larger.
    reduced_from: Option<[u32; 2]>,
}

impl TexelImage {
    /// An image of these texels.
    ///
    /// # Errors
    /// No texels, too many ([`LONGEST_SIDE`], [`MOST_TEXELS`]), another number of them than `width`·`height`, or one
    /// that is not finite.
    pub fn new(width: u32, height: u32, texels: Vec<[f32; 4]>) -> Result<Self, TextureError> {
        check_size(IN_CODE, width, height)?;
        if texels.len() as u64 != u64::from(width) * u64::from(height) {
            return Err(TextureError::Count { width, height, found: texels.len() });
        }
        check_finite(&texels, width)?;
        Ok(Self::checked(width, height, texels))
    }

    /// An image whose texel in column `x` of row `y` is `texel(x, y)`.
    ///
    /// # Errors
    /// See [`TexelImage::new`].
    pub fn from_fn(width: u32, height: u32, texel: impl Fn(u32, u32) -> [f32; 4]) -> Result<Self, TextureError> {
        check_size(IN_CODE, width, height)?;
        Self::new(
            width,
            height,
            (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| texel(x, y)).collect(),
        )
    }

    /// From texels that are known to be valid.
    pub(crate) fn checked(width: u32, height: u32, texels: Vec<[f32; 4]>) -> Self {
        Self { width, height, texels, reduced_from: None }
    }

    /// With the size that it had in its file.
    pub(crate) fn reduced_from(self, width: u32, height: u32) -> Self {
        Self { reduced_from: Some([width, height]), ..self }
    }

    /// A sentence without its subject where the image in the file was larger than the limits: it was scaled down.
    pub fn reduction(&self) -> Option<String> {
        let Self { width, height, .. } = self;
        let [from_width, from_height] = self.reduced_from?;
        Some(format!(
            "is scaled down from {from_width} × {from_height} to {width} × {height} texels, to keep within the limits"
        ))
    }

    /// Columns and rows.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// The texels, row by row.
    pub fn texels(&self) -> &[[f32; 4]] {
        &self.texels
    }

    /// With negative numbers clamped to 0.
    pub(crate) fn not_below_zero(mut self) -> Self {
        for number in self.texels.as_flattened_mut() {
            *number = number.max(0.0);
        }
        self
    }

    pub(crate) fn into_texels(self) -> Vec<[f32; 4]> {
        self.texels
    }
}

/// The name of images without a file in errors.
const IN_CODE: &str = "the image";

/// Refuses the first texel, in rows of this width, that is not finite.
pub(crate) fn check_finite(texels: &[[f32; 4]], width: u32) -> Result<(), TextureError> {
    let wrong = |texel: &[f32; 4]| texel.iter().copied().find(|number| !number.is_finite());
    match texels.iter().enumerate().find_map(|(at, texel)| Some((at as u32, wrong(texel)?))) {
        Some((at, value)) => {
            Err(TextureError::NotFinite { image: IN_CODE.into(), x: at % width, y: at / width, value })
        }
        None => Ok(()),
    }
}

pub(crate) fn check_size(image: &str, width: u32, height: u32) -> Result<(), TextureError> {
    let image = || image.to_owned();
    if width == 0 || height == 0 {
        return Err(TextureError::Empty { image: image(), width, height });
    }
    if width.max(height) > LONGEST_SIDE || u64::from(width) * u64::from(height) > MOST_TEXELS {
        return Err(TextureError::TooLarge { image: image(), width, height });
    }
    Ok(())
}

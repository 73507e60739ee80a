//! Placements: the positions of images in the textures that hold them, and the transforms from a mesh's coordinates to
//! images, in the layout of maps.wgsl. The test of the twins of maps.wgsl is a user of this file too, so it needs no
//! other.

use bytemuck::{Pod, Zeroable};
use halfway_texture::{ImageForm, Level, MapKind, Pyramid, Ripmap, SummedAreas};
use std::borrow::Cow;

/// The placements of all images of a draw; `Placings` in maps.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct PlacingsRecord {
    pub(crate) cutoff: [f32; 4],
    pub(crate) each: [PlacingRecord; MapKind::COUNT],
}

/// The transform of coordinates to an image, its amount, and the positions of its levels; `Placing` in maps.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct PlacingRecord {
    pub(crate) row0: [f32; 4],
    pub(crate) row1: [f32; 4],
    pub(crate) levels: [u32; 4],
    pub(crate) level: [[u32; 4]; 14],
}

impl PlacingRecord {
    /// The placement of an image stored in this form, in rows of `width` texels.
    pub(crate) fn new(
        [[a, b, c], [d, e, f]]: [[f32; 3]; 2],
        amount: f32,
        (pyramid, form): (&Pyramid, ImageForm),
        width: u32,
    ) -> Self {
        let (row0, row1) = ([a, b, c, amount], [d, e, f, 0.0]);
        let ([columns, rows, all], level) = match form {
            ImageForm::Pyramid => of_pyramid(pyramid),
            ImageForm::Ripmap => of_ripmap(pyramid.ripmap()),
            ImageForm::SummedAreas => of_sums(pyramid.size(), pyramid.summed_areas()),
        };
        Self { row0, row1, levels: [columns, width, rows, all], level }
    }
}

/// The numbers of levels (along u and along v for ripmaps), a further number for `by_shape.wgsl`, and the positions of
/// the levels.
type Places = ([u32; 3], [[u32; 4]; 14]);

fn of_pyramid(pyramid: &Pyramid) -> Places {
    let mut level = [[0; 4]; 14];
    for (record, Level { width, height, start }) in level.iter_mut().zip(pyramid.levels()) {
        *record = [*start as u32, *width, *height, 0];
    }
    ([pyramid.levels().len() as u32, 0, 0], level)
}

/// For each number of halvings: the columns of all wider images of a row, its width, its height, and the rows of all
/// higher ones.
fn of_ripmap(ripmap: &Ripmap) -> Places {
    let [columns, rows] = ripmap.counts();
    let mut level = [[0; 4]; 14];
    let (mut wider, mut higher) = (0, 0);
    for (k, record) in level.iter_mut().enumerate().take(columns.max(rows)) {
        let (of_columns, _) = ripmap.level([k.min(columns - 1), 0]);
        let (of_rows, _) = ripmap.level([0, k.min(rows - 1)]);
        *record = [wider, of_columns.width, of_rows.height, higher];
        wider += if k < columns { of_columns.width } else { 0 };
        higher += of_rows.height;
    }
    ([columns as u32, rows as u32, wider], level)
}

/// The image itself, then the table of its sums, two texels each, the mean, and the unit of the sums.
fn of_sums([width, height]: [u32; 2], sums: &SummedAreas) -> Places {
    let mut level = [[0; 4]; 14];
    level[0] = [0, width, height, 0];
    level[1] = [width * height, 2 * (width + 1), height + 1, 0];
    level[2] = sums.mean().map(|mean| (mean as f32).to_bits());
    level[3] = unit_of(sums).map(|unit| (unit as f32).to_bits());
    ([1, 0, 0], level)
}

/// The unit of stored sums, exact in f32: the largest sum, or 1 if all are 0.
fn unit_of(sums: &SummedAreas) -> [f64; 4] {
    sums.largest().map(|largest| if largest > 0.0 { f64::from(largest.min(f32::MAX.into()) as f32) } else { 1.0 })
}

/// The texels of an image in a form, one after the other.
pub(crate) fn stored(pyramid: &Pyramid, form: ImageForm) -> Cow<'_, [[f32; 4]]> {
    match form {
        ImageForm::Pyramid => pyramid.texels().into(),
        ImageForm::Ripmap => pyramid.ripmap().texels().into(),
        ImageForm::SummedAreas => {
            let sums = pyramid.summed_areas();
            let unit = unit_of(sums);
            let halves = sums.sums().iter().flat_map(|sum| split(std::array::from_fn(|k| sum[k] / unit[k])));
            pyramid.level(0).iter().copied().chain(halves).collect()
        }
    }
}

/// Splits numbers of at most about 1 into a multiple of 2⁻²² and the rest. Sums and differences of four of the first
/// halves are exact in f32, in any order; the others are off by 2⁻⁴⁸.
fn split(numbers: [f64; 4]) -> [[f32; 4]; 2] {
    const STEPS: f64 = (1 << 22) as f64;
    let coarse = numbers.map(|number| (number * STEPS).round() / STEPS);
    let rest: [f64; 4] = std::array::from_fn(|k| numbers[k] - coarse[k]);
    [coarse, rest].map(|half| half.map(|number| number as f32))
}

/// Columns and rows of the texture that holds all texels, one after the other, in rows of at most `longest` of them.
pub(crate) fn packed_size(texels: &[[f32; 4]], longest: u32) -> [u32; 2] {
    let count = texels.len() as u32;
    let width = count.min(longest);
    [width, count.div_ceil(width)]
}

/// The texture of this size with the texels of all levels, in 32-bit floats.
pub(crate) fn packed(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texels: &[[f32; 4]],
    [width, height]: [u32; 2],
) -> wgpu::Texture {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("a map"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let write = |y: u32, texels: &[[f32; 4]], rows: u32| {
        let to = wgpu::TexelCopyTextureInfo {
            texture: &texture,
            mip_level: 0,
            origin: wgpu::Origin3d { x: 0, y, z: 0 },
            aspect: wgpu::TextureAspect::All,
        };
        let size = wgpu::Extent3d { width: width.min(texels.len() as u32), height: rows, depth_or_array_layers: 1 };
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * width), rows_per_image: None };
        queue.write_texture(to, bytemuck::cast_slice(texels), layout, size);
    };
    // The last row may be a part.
    let whole = texels.len() as u32 / width;
    let (rows, rest) = texels.split_at((whole * width) as usize);
    write(0, rows, whole);
    if !rest.is_empty() {
        write(whole, rest, 1);
    }
    texture
}

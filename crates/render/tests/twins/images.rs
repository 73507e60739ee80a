//! Images for the functions of maps.wgsl: one in each slot, and where they lie.

use halfway_render::wgpu;
use halfway_texture::{Channel, ImageForm, LevelFilter, MapKind, Pyramid, Sampling, TexelFilter, TexelImage, Wrap};
use std::sync::LazyLock;

use crate::adapter::Bound;
use crate::inputs::between;
use crate::placings::{PlacingRecord, PlacingsRecord, packed, packed_size, stored};
use fastrand::Rng;

/// The slots that rows look up, and their images in maps.wgsl: 5 × 3, 1 × 1, 1 × 7, 6 × 4, 5 × 4, 9 × 1, 1 × 3 and 16 ×
/// 8 texels.
pub(crate) const COLOR: usize = 0;
pub(crate) const SPECULAR: usize = 1;
pub(crate) const EMISSION: usize = 2;
pub(crate) const OPACITY: usize = 3;
pub(crate) const SHININESS: usize = 4;
pub(crate) const OCCLUSION: usize = 5;
pub(crate) const NORMAL: usize = 6;
pub(crate) const HEIGHT: usize = 7;

const SIZES: [[u32; 2]; MapKind::COUNT] = [[5, 3], [1, 1], [1, 7], [6, 4], [5, 4], [9, 1], [1, 3], [16, 8]];

/// The form of an image in its texture.
fn form(slot: usize) -> ImageForm {
    match slot {
        OPACITY | OCCLUSION => ImageForm::Ripmap,
        SHININESS | NORMAL => ImageForm::SummedAreas,
        _ => ImageForm::Pyramid,
    }
}

/// Texels in a row of the textures: no side of an image, so that levels begin and end within rows.
const LONGEST: u32 = 11;

/// Numbers beyond 0 to 1 too, as heights have them, and where clamping shows.
pub(crate) static IMAGES: LazyLock<[Pyramid; MapKind::COUNT]> = LazyLock::new(|| {
    let mut random = Rng::with_seed(0x2545_f491_4f6c_dd1d);
    SIZES.map(|[width, height]| {
        let texels = (0..width * height).map(|_| [0; 4].map(|_| between(&mut random, -0.5, 1.5))).collect();
        Pyramid::new(TexelImage::new(width, height, texels).expect("a small image"))
    })
});

pub(crate) static PLACINGS: LazyLock<PlacingsRecord> = LazyLock::new(|| {
    let mut random = Rng::with_seed(0x1234_5678_9abc_def1);
    let each = std::array::from_fn(|slot| {
        let rows = [[0; 3]; 2].map(|row| row.map(|_| between(&mut random, -2.0, 2.0)));
        let image = (&IMAGES[slot], form(slot));
        let width = packed_size(&stored(image.0, image.1), LONGEST)[0];
        PlacingRecord::new(rows, between(&mut random, -1.0, 2.0), image, width)
    });
    PlacingsRecord { cutoff: [0.5, 0.0, 0.0, 0.0], each }
});

/// Of a slot: the rows of its placing, in f64.
pub(crate) fn rows_of(slot: usize) -> [[f64; 3]; 2] {
    let PlacingRecord { row0, row1, .. } = PLACINGS.each[slot];
    [row0, row1].map(|[a, b, c, _]| [a, b, c].map(f64::from))
}

/// How much the image in a slot counts.
pub(crate) fn amount_of(slot: usize) -> f64 {
    PLACINGS.each[slot].row0[3].into()
}

/// The largest magnitude of a texel.
pub(crate) fn largest(slot: usize) -> f64 {
    let numbers = IMAGES[slot].texels().iter().flatten();
    numbers.fold(0.0, |largest, number| f64::max(largest, number.abs().into()))
}

pub(crate) const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
pub(crate) const FILTERS: [TexelFilter; 4] =
    [TexelFilter::Nearest, TexelFilter::Bilinear, TexelFilter::BSpline, TexelFilter::CatmullRom];
const LEVELS: [LevelFilter; 3] = [LevelFilter::None, LevelFilter::Nearest, LevelFilter::Linear];
/// By their numbers in `by_shape.wgsl`, from 1 on.
const SHAPES: [LevelFilter; 7] = [
    LevelFilter::Ripmap,
    LevelFilter::SummedArea,
    LevelFilter::Anisotropic2,
    LevelFilter::Anisotropic4,
    LevelFilter::Anisotropic8,
    LevelFilter::Anisotropic16,
    LevelFilter::Elliptical,
];
const CHANNELS: [Channel; 4] = [Channel::Red, Channel::Green, Channel::Blue, Channel::Alpha];

/// How an image is looked up, as the number that maps.wgsl reads, and as what it means.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    magnify: usize,
    minify: usize,
    levels: usize,
    wrap: [usize; 2],
    channel: usize,
    second: bool,
    shape: usize,
}

impl Look {
    pub(crate) fn random(random: &mut Rng) -> Self {
        let mut below = |count: f32| (between(random, 0.0, count) as usize).min(count as usize - 1);
        Self {
            magnify: below(4.0),
            minify: below(4.0),
            levels: below(3.0),
            wrap: [below(3.0), below(3.0)],
            channel: below(4.0),
            second: below(2.0) == 1,
            shape: 0,
        }
    }

    /// The same by the footprint's shape, without steps.
    pub(crate) fn by_shape(self, shape: usize) -> Self {
        Self { levels: if shape > 0 { 2 } else { self.levels }, shape, ..self.without_steps() }
    }

    /// The same that is reduced everywhere.
    pub(crate) fn reduced(self) -> Self {
        Self { magnify: self.minify, ..self }
    }

    pub(crate) fn shape(self) -> usize {
        self.shape
    }

    /// Without filters that have steps.
    pub(crate) fn without_steps(self) -> Self {
        Self { magnify: self.magnify.max(1), minify: self.minify.max(1), ..self }
    }

    /// The same, and without steps where levels follow each other or where the image begins to be reduced.
    pub(crate) fn smooth(self) -> Self {
        let filter = self.minify.max(1);
        Self { magnify: filter, minify: filter, levels: 2 * (self.levels / 2), ..self }
    }

    pub(crate) fn bits(self) -> f32 {
        let Self { magnify, minify, levels, wrap: [u, v], channel, second, shape } = self;
        let fields = [magnify, minify, levels, u, v, channel, usize::from(second) + 2 * shape];
        fields.iter().rev().fold(0, |bits, field| 4 * bits + field) as f32
    }

    /// Of [`bits`](Self::bits).
    pub(crate) fn from_bits(bits: f32) -> Self {
        let field = |place: u32| bits as usize >> (2 * place) & 3;
        Self {
            magnify: field(0),
            minify: field(1),
            levels: field(2),
            wrap: [field(3), field(4)],
            channel: field(5),
            second: field(6) & 1 == 1,
            shape: bits as usize >> 13 & 7,
        }
    }

    pub(crate) fn sampling(self) -> Sampling {
        Sampling {
            wrap: self.wrap.map(|wrap| WRAPS[wrap]),
            magnify: FILTERS[self.magnify],
            minify: FILTERS[self.minify],
            levels: if self.shape > 0 { SHAPES[self.shape - 1] } else { LEVELS[self.levels] },
        }
    }

    /// The fields in the order of their bits.
    pub(crate) fn fields(self) -> [usize; 6] {
        [self.magnify, self.minify, self.levels, self.wrap[0], self.wrap[1], self.channel]
    }

    pub(crate) fn channel(self) -> Channel {
        CHANNELS[self.channel]
    }

    pub(crate) fn takes_second(self) -> bool {
        self.second
    }
}

/// The images and their placings, in group 1 as maps.wgsl has it.
pub(crate) fn bound(device: &wgpu::Device, queue: &wgpu::Queue) -> Bound {
    let visibility = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
    let uniform = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let image = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let slots = 1..=MapKind::COUNT as u32;
    let entries: Vec<_> = std::iter::once(entry(0, uniform)).chain(slots.map(|slot| entry(slot, image))).collect();
    let layout =
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("maps"), entries: &entries });
    let placings = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("where maps lie"),
        size: size_of::<PlacingsRecord>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    queue.write_buffer(&placings, 0, bytemuck::bytes_of(&*PLACINGS));
    let views: Vec<_> = (IMAGES.iter().enumerate())
        .map(|(slot, pyramid)| {
            let texels = stored(pyramid, form(slot));
            let texture = packed(device, queue, &texels, packed_size(&texels, LONGEST));
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        })
        .collect();
    let first = wgpu::BindGroupEntry { binding: 0, resource: placings.as_entire_binding() };
    let image = |(slot, view)| wgpu::BindGroupEntry {
        binding: slot as u32 + 1,
        resource: wgpu::BindingResource::TextureView(view),
    };
    let entries: Vec<_> = std::iter::once(first).chain(views.iter().enumerate().map(image)).collect();
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("maps"),
        layout: &layout,
        entries: &entries,
    });
    Bound { layout, group }
}

//! The lighting text with its bindings, and what goes with them.

use crate::device::gpu::Gpu;
use crate::shaders::light_slots::COUNTED_LIGHTS;
use crate::shaders::records::{LightRecord, RECORD_BYTES};
use crate::shaders::template::Template;
use halfway_texture::MapKind;
use std::sync::OnceLock;

/// How the text reads records and lights. Each is a text of its own, since a driver spends time and memory on what a
/// pipeline leaves unused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum LightText {
    /// From uniform buffers, up to [`COUNTED_LIGHTS`].
    Few,
    /// From storage, any number.
    Listed,
}

/// A text of the GPU's: how it reads lights, and what it knows of surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Text {
    pub(crate) lights: LightText,
    pub(crate) surface: SurfaceText,
    /// It has the filters of images that go by the footprint's shape, where it has images.
    pub(crate) by_shape: bool,
}

/// What a text knows of surfaces. What has more than a material takes a text of its own, so that nothing else pays for
/// it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum SurfaceText {
    /// Materials.
    Plain,
    /// Materials, and colors of the vertices.
    Colored,
    /// Materials, images, a mask, and colors of the vertices, white where there are none.
    Mapped,
    /// The same, in an environment.
    Surrounded,
    /// As [`Mapped`](Self::Mapped), and a solid.
    Solid,
    /// As [`Surrounded`](Self::Surrounded), and a solid.
    SolidSurrounded,
}

/// The lighting text, and the layout that goes with it.
pub(crate) struct Shader {
    pub(crate) template: Template,
    pub(crate) bindings: wgpu::BindGroupLayout,
    /// Those of images.
    pub(crate) map_bindings: Option<wgpu::BindGroupLayout>,
    pub(crate) layout: wgpu::PipelineLayout,
}

/// The texts, each made when a pipeline first needs it, on whichever thread that is: by lights, then by filters and
/// surface.
#[derive(Default)]
pub(crate) struct Shaders([[[OnceLock<Shader>; SurfaceText::ALL.len()]; 2]; 2]);

impl Shaders {
    /// A text that reads lights so, once there is one. The layouts of all of them are the same.
    pub(crate) fn any(&self, lights: LightText) -> Option<&Shader> {
        self.0[lights as usize].iter().flatten().find_map(OnceLock::get)
    }

    /// The layout of the bindings of images, and of a solid where there is one, once a text has it.
    pub(crate) fn map_bindings(&self, has_solid: bool) -> Option<&wgpu::BindGroupLayout> {
        let all = self.0.iter().flatten().flat_map(|shaders| SurfaceText::ALL.into_iter().zip(shaders));
        let those = all.filter(|(text, _)| text.has_solid() == has_solid).filter_map(|(_, shader)| shader.get());
        those.into_iter().find_map(|shader| shader.map_bindings.as_ref())
    }

    pub(crate) fn get_or_make(&self, gpu: &Gpu, text: Text) -> &Shader {
        self.0[text.lights as usize][usize::from(text.by_shape)][text.surface as usize]
            .get_or_init(|| Shader::new(gpu, text))
    }
}

const ENVIRONMENT: &str = include_str!("environment.wgsl");
const SURROUNDINGS: &str = include_str!("surroundings.wgsl");

/// The files of the sky's text.
pub(crate) const SKY: [&str; 4] = [include_str!("lighting.wgsl"), ENVIRONMENT, SURROUNDINGS, include_str!("sky.wgsl")];

/// The bytes of lights at fixed places.
pub(crate) const COUNTED_LIGHT_BYTES: u64 = COUNTED_LIGHTS as u64 * size_of::<LightRecord>() as u64;

impl SurfaceText {
    /// All of them.
    pub(crate) const ALL: [Self; 6] =
        [Self::Plain, Self::Colored, Self::Mapped, Self::Surrounded, Self::Solid, Self::SolidSurrounded];

    fn has_solid(self) -> bool {
        matches!(self, Self::Solid | Self::SolidSurrounded)
    }

    fn files(self, by_shape: bool) -> Vec<&'static str> {
        const FILTERS: [&str; 2] = [include_str!("by_level.wgsl"), include_str!("by_shape.wgsl")];
        const MAPPED: &str = include_str!("mapped.wgsl");
        const SURROUNDED: &str = include_str!("surrounded.wgsl");
        const SOLIDS: &str = include_str!("solids.wgsl");
        const SOLID: &str = include_str!("solid.wgsl");
        let filters = FILTERS[usize::from(by_shape)];
        let maps = [include_str!("maps.wgsl"), filters, include_str!("factors.wgsl"), include_str!("parts.wgsl")];
        let surroundings = [ENVIRONMENT, SURROUNDINGS, SURROUNDED];
        match self {
            Self::Plain => vec![include_str!("plain.wgsl")],
            Self::Colored => vec![include_str!("colored.wgsl")],
            Self::Mapped => [&maps[..], &[MAPPED]].concat(),
            Self::Surrounded => [&maps[..], &surroundings].concat(),
            Self::Solid => [&maps[..], &[MAPPED, SOLIDS, SOLID, include_str!("solid_mapped.wgsl")]].concat(),
            Self::SolidSurrounded => {
                [&maps[..], &surroundings, &[SOLIDS, SOLID, include_str!("solid_surrounded.wgsl")]].concat()
            }
        }
    }
}

impl Text {
    /// The files that it is put together of, end to end. Each needs only those before it, so that it is valid WGSL with
    /// them; `lighting.wgsl` needs none.
    pub(crate) fn files(self) -> Vec<&'static str> {
        [self.lights.files(), &self.surface.files(self.by_shape)].concat()
    }
}

impl LightText {
    fn files(self) -> &'static [&'static str] {
        const LIGHTING: &str = include_str!("lighting.wgsl");
        const RECORDS: &str = include_str!("records.wgsl");
        const MESH: &str = include_str!("mesh.wgsl");
        match self {
            Self::Few => &[LIGHTING, RECORDS, include_str!("uniform.wgsl"), MESH],
            Self::Listed => &[LIGHTING, RECORDS, include_str!("storage.wgsl"), MESH],
        }
    }
}

impl Shader {
    fn new(gpu: &Gpu, text: Text) -> Self {
        let storage = text.lights == LightText::Listed;
        let template = Template::new(&gpu.provoking_vertex().text(&text.files().concat()));
        let entry = |binding, ty, size| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty,
                has_dynamic_offset: binding == 1,
                min_binding_size: std::num::NonZeroU64::new(size),
            },
            count: None,
        };
        let uniform = wgpu::BufferBindingType::Uniform;
        let read = wgpu::BufferBindingType::Storage { read_only: true };
        let entries = if storage {
            vec![entry(1, read, RECORD_BYTES), entry(2, read, size_of::<LightRecord>() as u64), entry(3, read, 4)]
        } else {
            vec![entry(1, uniform, RECORD_BYTES), entry(2, uniform, COUNTED_LIGHT_BYTES)]
        };
        let bindings = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("draw"),
            entries: &[vec![entry(0, uniform, 16)], entries].concat(),
        });
        let is_surrounded = matches!(text.surface, SurfaceText::Surrounded | SurfaceText::SolidSurrounded);
        let has_maps = !matches!(text.surface, SurfaceText::Plain | SurfaceText::Colored);
        let map_bindings = has_maps.then(|| map_bindings(gpu, text.surface.has_solid()));
        let surroundings = is_surrounded.then(|| surroundings_bindings(gpu));
        let all = [Some(&bindings), map_bindings.as_ref(), surroundings.as_ref()];
        let count = all.iter().flatten().count();
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("draw"),
            bind_group_layouts: &all[..count],
            ..Default::default()
        });
        Self { template, bindings, map_bindings, layout }
    }
}

/// Where a solid is bound, behind the images.
pub(crate) const SOLID_BINDING: u32 = MapKind::COUNT as u32 + 1;

fn map_bindings(gpu: &Gpu, has_solid: bool) -> wgpu::BindGroupLayout {
    let images = (1..).take(MapKind::COUNT).map(image_binding);
    let solid = has_solid.then(|| uniform_of_fragments(SOLID_BINDING));
    let entries: Vec<_> = std::iter::once(uniform_of_fragments(0)).chain(images).chain(solid).collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("maps"), entries: &entries })
}

/// Those of the environment: how it is looked up, and its texels.
pub(crate) fn surroundings_bindings(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entries = [uniform_of_fragments(0), image_binding(1)];
    let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some("surroundings"), entries: &entries };
    gpu.device.create_bind_group_layout(&descriptor)
}

fn image_binding(binding: u32) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            // The filters are the shader's, so that they are the same everywhere.
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    }
}

fn uniform_of_fragments(binding: u32) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

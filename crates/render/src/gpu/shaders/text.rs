//! The texts of surfaces, with their bindings.

use crate::gpu::device::Gpu;
use crate::gpu::shaders::records::{RECORD_BYTES, VIEW_BYTES};
use crate::gpu::shaders::switches::assembled;
use crate::gpu::shaders::template::Template;
use bevy_platform::collections::HashMap;
use halfway_frame::lights::slots::COUNTED_LIGHTS;
use halfway_frame::lights::terms::{by_fragment_shader, by_vertex_shader};
use halfway_lighting::lights;
use halfway_lighting::record::LightRecord;
use halfway_lighting::{Frequency, Terms};
use halfway_texture::MapKind;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The way a text reads records and lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum LightText {
    /// From uniform buffers, up to [`COUNTED_LIGHTS`].
    Few,
    /// From storage, any number.
    Listed,
}

/// The features of a surface's shader: each combination is a text of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(clippy::struct_excessive_bools, reason = "each is one independent switch of the text")]
pub(crate) struct Text {
    pub(crate) lights: LightText,
    /// The frequency of each term.
    pub(crate) terms: Terms,
    /// Both sides are drawn.
    pub(crate) two_sided: bool,
    /// The vertices have colors, white where the mesh has none.
    pub(crate) painted: bool,
    /// There may be images, and a mask.
    pub(crate) mapped: bool,
    /// Some filter of images uses the footprint's shape.
    pub(crate) by_shape: bool,
    /// An image perturbs the normals of fragments.
    pub(crate) relief: bool,
    /// The object is cut from a solid.
    pub(crate) solid: bool,
    /// An environment lights it.
    pub(crate) surrounded: bool,
}

impl Text {
    /// The switches of the files, each with its name.
    pub(crate) fn switches(self) -> [(&'static str, bool); 16] {
        let Self { two_sided, painted, mapped, relief, solid, surrounded, .. } = self;
        let [vertex_diffuse, vertex_specular] = by_vertex_shader(self.terms);
        let [fragment_diffuse, fragment_specular] = by_fragment_shader(self.terms);
        let fragment = fragment_diffuse || fragment_specular;
        let flat = self.is_flat();
        [
            ("FLAT", flat),
            ("VERTEX", vertex_diffuse || vertex_specular),
            ("VERTEX_DIFFUSE", vertex_diffuse),
            ("VERTEX_SPECULAR", vertex_specular),
            ("FRAGMENT", fragment),
            ("FRAGMENT_DIFFUSE", fragment_diffuse),
            ("FRAGMENT_SPECULAR", fragment_specular),
            ("NORMALS", self.reads_normals()),
            ("NORMALS_AT_FRAGMENTS", fragment || surrounded),
            ("TWO_SIDED", two_sided),
            // The rasteriser gives each fragment its side.
            ("FACING", two_sided && !flat),
            ("PAINTED", painted),
            ("MAPPED", mapped),
            ("RELIEF", relief),
            ("SOLID", solid),
            ("SURROUNDED", surrounded),
        ]
    }

    /// Whether a triangle has one colour.
    pub(crate) fn is_flat(self) -> bool {
        self.terms.has(Frequency::Triangle)
    }

    /// Whether its vertices have normals.
    pub(crate) fn reads_normals(self) -> bool {
        self.terms != Terms::NONE || self.surrounded
    }

    /// The files of the text, concatenated. Each needs only those before it, with which it is valid WGSL;
    /// `lighting.wgsl` needs none.
    pub(crate) fn files(self) -> Vec<&'static str> {
        let mut files = vec![LIGHTING, lights::wgsl(), include_str!("records.wgsl")];
        files.push(match self.lights {
            LightText::Few => include_str!("uniform.wgsl"),
            LightText::Listed => include_str!("storage.wgsl"),
        });
        files.push(include_str!("mesh.wgsl"));
        if self.mapped {
            let filters = if self.by_shape { include_str!("by_shape.wgsl") } else { include_str!("by_level.wgsl") };
            files.extend([include_str!("maps.wgsl"), filters, include_str!("factors.wgsl")]);
        }
        if self.surrounded {
            files.extend([ENVIRONMENT, SURROUNDINGS]);
        }
        if self.solid {
            files.push(include_str!("solids.wgsl"));
        }
        files.push(include_str!("surface.wgsl"));
        files
    }

    pub(crate) fn wgsl(self) -> String {
        assembled(&self.files(), &self.switches())
    }
}

const LIGHTING: &str = include_str!("lighting.wgsl");
const ENVIRONMENT: &str = include_str!("environment.wgsl");
const SURROUNDINGS: &str = include_str!("surroundings.wgsl");

/// The files of the sky's text.
pub(crate) const SKY: [&str; 4] = [LIGHTING, ENVIRONMENT, SURROUNDINGS, include_str!("sky.wgsl")];

/// The bytes of lights at fixed places.
pub(crate) const COUNTED_LIGHT_BYTES: u64 = COUNTED_LIGHTS as u64 * size_of::<LightRecord>() as u64;

/// A text, and the layout of its bindings.
pub(crate) struct Shader {
    pub(crate) template: Template,
    pub(crate) layout: wgpu::PipelineLayout,
}

/// The texts, each compiled when a pipeline first needs it, on any thread.
#[derive(Default)]
pub(crate) struct Shaders {
    pub(crate) layouts: Layouts,
    texts: Mutex<HashMap<Text, Arc<OnceLock<Shader>>>>,
}

/// The layouts of bindings, each made when a text first needs it, since a device may not support all of them.
#[derive(Default)]
pub(crate) struct Layouts {
    few: OnceLock<wgpu::BindGroupLayout>,
    listed: OnceLock<wgpu::BindGroupLayout>,
    images: OnceLock<wgpu::BindGroupLayout>,
    images_and_solid: OnceLock<wgpu::BindGroupLayout>,
}

impl Shaders {
    /// Calls with a text.
    pub(crate) fn with<T>(&self, gpu: &Gpu, text: Text, call: impl FnOnce(&Shader) -> T) -> T {
        let mut texts = self.texts.lock().unwrap_or_else(PoisonError::into_inner);
        let shader = Arc::clone(texts.entry(text).or_default());
        // Other threads may compile texts meanwhile.
        drop(texts);
        call(shader.get_or_init(|| Shader::new(gpu, &self.layouts, text)))
    }
}

impl Shader {
    fn new(gpu: &Gpu, layouts: &Layouts, text: Text) -> Self {
        let template = Template::new(&gpu.provoking_vertex().text(&text.wgsl()));
        let draw = layouts.of_lights(text.lights).get_or_init(|| draw_bindings(gpu, text.lights));
        let images = text.mapped.then(|| layouts.of_images(text.solid).get_or_init(|| image_bindings(gpu, text.solid)));
        let surroundings = text.surrounded.then(|| surroundings_bindings(gpu));
        let all = [Some(draw), images, surroundings.as_ref()];
        let count = all.iter().flatten().count();
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("draw"),
            bind_group_layouts: &all[..count],
            ..Default::default()
        });
        Self { template, layout }
    }
}

impl Layouts {
    /// The layout of records and lights.
    pub(crate) fn of_lights(&self, lights: LightText) -> &OnceLock<wgpu::BindGroupLayout> {
        match lights {
            LightText::Few => &self.few,
            LightText::Listed => &self.listed,
        }
    }

    /// The layout of images, with a solid if there is one.
    pub(crate) fn of_images(&self, has_solid: bool) -> &OnceLock<wgpu::BindGroupLayout> {
        if has_solid { &self.images_and_solid } else { &self.images }
    }
}

/// The bindings of the view, records and lights.
fn draw_bindings(gpu: &Gpu, lights: LightText) -> wgpu::BindGroupLayout {
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
    let mut entries = vec![entry(0, uniform, VIEW_BYTES)];
    match lights {
        LightText::Few => entries.extend([entry(1, uniform, RECORD_BYTES), entry(2, uniform, COUNTED_LIGHT_BYTES)]),
        LightText::Listed => {
            let lights = entry(2, read, size_of::<LightRecord>() as u64);
            entries.extend([entry(1, read, RECORD_BYTES), lights, entry(3, read, 4)]);
        }
    }
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("draw"), entries: &entries })
}

/// The binding of a solid, after the images.
pub(crate) const SOLID_BINDING: u32 = MapKind::COUNT as u32 + 1;

fn image_bindings(gpu: &Gpu, has_solid: bool) -> wgpu::BindGroupLayout {
    let images = (1..).take(MapKind::COUNT).map(image_binding);
    let solid = has_solid.then(|| uniform_of_fragments(SOLID_BINDING));
    let entries: Vec<_> = std::iter::once(uniform_of_fragments(0)).chain(images).chain(solid).collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("maps"), entries: &entries })
}

/// The bindings of the environment: its parameters and its texels.
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
            // The shader filters, so that results are the same everywhere.
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

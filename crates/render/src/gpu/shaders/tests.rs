//! The texts are valid file by file, and the records have the layouts of the texts.

use crate::gpu::draw::placings::{PlacingRecord, PlacingsRecord};
use crate::gpu::draw::surroundings::SurroundingsRecord;
use crate::gpu::provoking_vertex::ProvokingVertex;
use crate::gpu::shaders::picture::{PICTURE_FILES, PicturePolicyRecord};
use crate::gpu::shaders::records::{INSTANCE, SolidRecord, ViewRecord};
use crate::gpu::shaders::switches::assembled;
use crate::gpu::shaders::template::{EntryPoint, Template};
use crate::gpu::shaders::text::{LightText, SKY, Text};
use bytemuck::Zeroable;
use halfway_frame::lights::slots::COUNTED_LIGHTS;
use halfway_lighting::record::{InstanceRecord, LightRecord, MaterialRecord, RecordField, SurfaceRecord};
use halfway_lighting::{Frequency, Terms};
use std::mem::offset_of;
use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};
use wgpu::naga::{self, Binding, TypeInner};

/// A material without images, whose terms are shaded at the fragments.
const PLAIN: Text = Text {
    lights: LightText::Few,
    terms: Terms::both(Frequency::Fragment),
    two_sided: false,
    painted: false,
    mapped: false,
    by_shape: false,
    relief: false,
    solid: false,
    surrounded: false,
};

const MAPPED: Text = Text { painted: true, mapped: true, ..PLAIN };

/// Every combination of switches that draws use.
fn texts() -> impl Iterator<Item = Text> {
    let (vertex, fragment) = (Frequency::Vertex, Frequency::Fragment);
    let terms = [
        Terms::NONE,
        Terms::both(Frequency::Triangle),
        Terms::both(vertex),
        Terms::both(fragment),
        Terms { diffuse: vertex, specular: fragment },
        Terms { diffuse: fragment, specular: vertex },
    ];
    let surfaces = [PLAIN, Text { painted: true, ..PLAIN }].into_iter().chain((0..16).map(|bits| Text {
        by_shape: bits & 1 > 0,
        relief: bits & 2 > 0,
        solid: bits & 4 > 0,
        surrounded: bits & 8 > 0,
        ..MAPPED
    }));
    let lit = surfaces.flat_map(move |text| terms.map(|terms| Text { terms, ..text }));
    let relieved =
        lit.filter(move |text| !text.relief || [text.terms.diffuse, text.terms.specular].contains(&fragment));
    let sides = relieved.flat_map(|text| [false, true].map(|two_sided| Text { two_sided, ..text }));
    sides.flat_map(|text| [LightText::Few, LightText::Listed].map(|lights| Text { lights, ..text }))
}

fn valid(text: &str) -> Result<naga::Module, String> {
    let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
    validator.validate(&module).map_err(|error| error.emit_to_string(text))?;
    Ok(module)
}

#[test]
fn each_file_is_valid_with_those_before_it() {
    let mut used = std::collections::HashSet::new();
    let mut each = |files: &[&'static str], switches: &[(&'static str, bool)]| {
        for count in 1..=files.len() {
            // It was valid before.
            if used.insert((files[..count].to_vec(), switches.to_vec())) {
                let text = assembled(&files[..count], switches);
                valid(&text).unwrap_or_else(|error| panic!("{count} files: {error}"));
            }
        }
    };
    for text in texts() {
        each(&text.files(), &text.switches());
    }
    each(&SKY, &[]);
    each(&PICTURE_FILES, &[]);
    let used: Vec<&str> = used.iter().filter_map(|(files, _)| files.last().copied()).collect();
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/gpu/shaders");
    for entry in std::fs::read_dir(folder).expect("the folder of the texts") {
        let path = entry.expect("a file").path();
        if path.extension().is_some_and(|extension| extension == "wgsl") {
            let text = std::fs::read_to_string(&path).expect("UTF-8");
            assert!(used.contains(&text.as_str()), "{} is in no text", path.display());
        }
    }
}

#[test]
fn opengl_gets_texts_without_the_first_vertex() {
    for text in texts() {
        let is_flat = text.is_flat();
        let text = text.wgsl();
        assert_eq!(text.contains("@interpolate(flat, first)"), is_flat);
        let opengls = ProvokingVertex::Last.text(&text);
        assert!(!opengls.contains(", first)"), "naga refuses it for OpenGL");
        valid(&opengls).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(ProvokingVertex::First.text(&text), text);
    }
}

#[test]
fn a_text_that_naga_rejects_is_found() {
    let lighting = PLAIN.files()[0];
    for (right, wrong) in [("1e6;", "ATTENUATION;"), ("return w * w;", "LOOPS"), ("fn power(", "fn powers(")] {
        assert!(valid(&lighting.replacen(right, wrong, 1)).is_err(), "{wrong} for {right} passes");
    }
}

/// The size of a pixel on the surface or on an image: it has to change by the same step from each pixel to
/// the next, so that it is taken at their centres.
const AT_CENTERS: [&str; 3] = ["at", "at_center", "middle"];

/// The wrongly interpolated varyings of a text's stages, and the number of right ones.
fn badly_interpolated(module: &naga::Module) -> (Vec<String>, usize) {
    use naga::{Interpolation, Sampling, ShaderStage};
    let (mut wrong, mut right) = (Vec::new(), 0);
    let between = |point: &naga::EntryPoint| match point.stage {
        ShaderStage::Vertex => point.function.result.iter().map(|result| result.ty).collect(),
        _ => point.function.arguments.iter().map(|argument| argument.ty).collect::<Vec<_>>(),
    };
    for point in &module.entry_points {
        for ty in between(point) {
            let TypeInner::Struct { members, .. } = &module.types[ty].inner else { continue };
            for member in members {
                let Some(Binding::Location { interpolation, sampling, .. }) = member.binding else { continue };
                let name = member.name.as_deref().unwrap_or_default();
                let expected = if AT_CENTERS.contains(&name) { Sampling::Center } else { Sampling::Centroid };
                let is_right = match interpolation {
                    Some(Interpolation::Flat) => matches!(sampling, Some(Sampling::First | Sampling::Either)),
                    Some(Interpolation::Perspective) => sampling == Some(expected),
                    _ => false,
                };
                if is_right {
                    right += 1;
                } else {
                    wrong.push(format!("{}: {name} is {interpolation:?}, {sampling:?}", point.name));
                }
            }
        }
    }
    (wrong, right)
}

/// If a triangle covers some of a pixel's four samples, the centre may lie outside the triangle.
#[test]
fn varyings_are_sampled_at_the_centroid() {
    for text in texts() {
        let (wrong, right) = badly_interpolated(&valid(&text.wgsl()).expect("a valid text"));
        assert_eq!(wrong, [""; 0], "{text:?}");
        // A fragment reads all outputs of a vertex, and these fit the limit together with the facing.
        assert!(right.is_multiple_of(2) && (2..=30).contains(&right), "{text:?}: {right} varyings");
    }
    let whole = PLAIN.wgsl();
    for wrong in ["perspective, center", "perspective", "linear, centroid"] {
        let text = whole.replacen("perspective, centroid", wrong, 1);
        let found = badly_interpolated(&naga::front::wgsl::parse_str(&text).expect("a text that can be read")).0;
        assert!(!found.is_empty(), "{wrong} passes");
    }
}

/// Name, offset and size in bytes.
type Field = (String, usize, usize);

/// The fields of a WGSL struct without padding, and the struct's size.
fn members(module: &naga::Module, name: &str) -> (Vec<Field>, usize) {
    let structs = module.types.iter().filter(|(_, ty)| ty.name.as_deref() == Some(name));
    let mut found = structs.filter_map(|(_, ty)| match &ty.inner {
        TypeInner::Struct { members, span } => Some((members, *span as usize)),
        _ => None,
    });
    let (members, span) = found.next().unwrap_or_else(|| panic!("the text has no struct {name}"));
    let fields = members.iter().map(|member| {
        let size = module.types[member.ty].inner.size(module.to_ctx()) as usize;
        (member.name.clone().unwrap_or_default(), member.offset as usize, size)
    });
    (fields.filter(|(name, ..)| !name.starts_with("padding")).collect(), span)
}

/// The fields of a record, and its size. Fields that are not named are padding.
macro_rules! fields {
    ($record:ty { $($($field:ident).+),+ }) => {{
        let zero = <$record>::zeroed();
        let last = |path: &str| path.rsplit(['.', ' ']).next().unwrap_or_default().to_owned();
        let fields: Vec<Field> = vec![$((
            last(stringify!($($field).+)),
            offset_of!($record, $($field).+),
            size_of_val(&zero.$($field).+),
        )),+];
        (fields, size_of::<$record>())
    }};
}

fn material_field(field: RecordField) -> Field {
    (field.name.to_owned(), field.first, field.count * size_of::<f32>())
}

/// Each record by the name of its struct.
fn records() -> [(&'static str, (Vec<Field>, usize)); 4] {
    [
        ("View", fields!(ViewRecord { scale, depth, w, center })),
        (
            "Light",
            fields!(LightRecord {
                position,
                inverse_range,
                diffuse,
                constant,
                specular,
                linear,
                direction,
                quadratic,
                ambient,
                cos_cutoff,
                exponent,
                inner_scale,
                inner_offset,
                kind
            }),
        ),
        ("Material", (MaterialRecord::FIELDS.map(material_field).to_vec(), size_of::<MaterialRecord>())),
        ("Surface", fields!(SurfaceRecord { front, back, lights.both, lights.diffuse, lights.specular })),
    ]
}

#[test]
fn records_lie_as_the_texts_read_them() {
    for text in texts() {
        let module = valid(&text.wgsl()).expect("a valid text");
        for (name, record) in records() {
            assert_eq!(members(&module, name), record, "{name} in {text:?}");
        }
        let strides = module.global_variables.iter().filter_map(|(_, global)| match module.types[global.ty].inner {
            TypeInner::Array { stride, .. } => Some((global.name.clone()?, stride as usize)),
            _ => None,
        });
        for (name, stride) in strides {
            let expected = match name.as_str() {
                "surfaces" => size_of::<SurfaceRecord>(),
                "lights" => size_of::<LightRecord>(),
                _ => size_of::<u32>(),
            };
            assert_eq!(stride, expected, "{name} in {text:?}");
        }
    }
}

#[test]
fn the_placement_of_an_image_has_one_layout() {
    let module = valid(&MAPPED.wgsl()).expect("a valid text");
    assert_eq!(members(&module, "Placing"), fields!(PlacingRecord { row0, row1, levels, level }));
    assert_eq!(members(&module, "Placings"), fields!(PlacingsRecord { cutoff, each }));
}

/// Inputs that no draw without them reads.
#[test]
fn filters_by_shape_are_in_their_own_texts_alone() {
    for text in texts() {
        let module = valid(&text.wgsl()).expect("a valid text");
        let has = module.functions.iter().any(|(_, function)| function.name.as_deref() == Some("elliptical"));
        assert_eq!(has, text.by_shape, "{text:?}");
    }
}

#[test]
fn a_solid_is_read_as_it_is_written() {
    let module = valid(&Text { solid: true, ..MAPPED }.wgsl()).expect("a valid text");
    assert_eq!(members(&module, "SolidData"), fields!(SolidRecord { rows, first, octaves, second }));
}

#[test]
fn a_policy_is_read_as_it_is_written() {
    let module = valid(&PICTURE_FILES.concat()).expect("a valid text");
    assert_eq!(
        members(&module, "PicturePolicy"),
        fields!(PicturePolicyRecord { smoothing, per_white, curve, encoded })
    );
}

#[test]
fn an_environment_is_read_as_it_is_written() {
    let record = fields!(SurroundingsRecord {
        row0,
        row1,
        row2,
        mean,
        strength,
        first_angle,
        sky_level,
        width,
        way,
        levels,
        level
    });
    for text in [Text { surrounded: true, ..MAPPED }.wgsl(), SKY.concat()] {
        assert_eq!(members(&valid(&text).expect("a valid text"), "Surroundings"), record);
    }
}

#[test]
fn a_field_that_moved_is_found() {
    let whole = PLAIN.wgsl();
    let moves = [
        ("Light", "    exponent: f32,\n", ""),
        ("Light", "inner_scale: f32", "inner_slope: f32"),
        ("Light", "    cos_cutoff: f32,\n", "    cos_cutoff: vec4f,\n"),
        ("Material", "base: vec3f", "base: vec4f"),
        ("View", "w: vec2f,", "w: vec4f,"),
        ("Material", "    emission: vec3f,", "    glow: vec3f,"),
        ("Surface", "    diffuse: vec2u,", "    padding0: vec2u,\n    diffuse: vec2u,"),
        ("Surface", "array<vec4u, 4>", "array<vec4u, 3>"),
    ];
    for (name, right, wrong) in moves {
        assert!(whole.contains(right), "{right} is in the text");
        // Only the structs are parsed, since code that reads the removed field would not be valid.
        let structs = whole.split("@group").next().unwrap_or_default().replace(right, wrong);
        let structs: String = structs.split_inclusive("\n}\n").filter(|part| part.contains("struct ")).collect();
        let module = naga::front::wgsl::parse_str(&structs).expect("structs alone");
        let record = records().into_iter().find(|record| record.0 == name).expect("a record of each struct").1;
        assert_ne!(members(&module, name), record, "{wrong:?} for {right:?} passes");
    }
}

#[test]
fn instances_lie_as_the_vertex_stages_read_them() {
    let (fields, bytes) = fields!(InstanceRecord { eye_from_model, normal, surface });
    let [(_, rows, _), (_, normal, _), (_, record, _)] = &fields[..] else { panic!("three fields") };
    let columns = |start: usize, size: usize| (0..3).map(move |k| start + k * size);
    let expected: Vec<u64> =
        columns(*rows, 16).chain(columns(*normal, 12)).chain([*record]).map(|at| at as u64).collect();
    assert_eq!(INSTANCE.map(|attribute| attribute.offset).to_vec(), expected);
    assert_eq!(INSTANCE.iter().map(|attribute| attribute.format.size()).sum::<u64>(), bytes as u64);

    for (text, count) in [(PLAIN, 7), (Text { terms: Terms::NONE, ..PLAIN }, 4)] {
        let module = valid(&text.wgsl()).expect("a valid text");
        let name = "Object";
        let inner = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).map(|(_, ty)| &ty.inner);
        let Some(TypeInner::Struct { members, .. }) = inner else { panic!("the text has no struct {name}") };
        assert_eq!(members.len(), count);
        for member in members {
            let Some(Binding::Location { location, .. }) = member.binding else { panic!("{name} has a location each") };
            let attribute = INSTANCE.iter().find(|attribute| attribute.shader_location == location);
            let size = module.types[member.ty].inner.size(module.to_ctx());
            assert_eq!(attribute.map(|attribute| attribute.format.size()), Some(size.into()), "{name} at {location}");
        }
    }
}

#[test]
fn fixed_lights_match_their_bindings() {
    for text in texts().filter(|text| text.lights != LightText::Listed) {
        let module = valid(&text.wgsl()).expect("a valid text");
        let lights = module.global_variables.iter().find(|(_, global)| global.name.as_deref() == Some("lights"));
        let (_, lights) = lights.expect("the lights are bound");
        let size = module.types[lights.ty].inner.size(module.to_ctx()) as usize;
        assert_eq!(size, COUNTED_LIGHTS as usize * size_of::<LightRecord>());
    }
}

/// A module has functions only for the kinds of images of its draw.
#[test]
fn constants_remove_dead_code_from_modules() {
    let functions = |text: Text, constants: &[(&'static str, f64)]| {
        let template = Template::new(&text.wgsl());
        let fragment = EntryPoint { stage: naga::ShaderStage::Fragment, name: "fs_surface", constants };
        let module = template.module_of(fragment);
        Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module).expect("a valid module");
        assert_eq!(module.entry_points.len(), 1);
        module.functions.iter().filter_map(|(_, function)| function.name.clone()).collect::<Vec<_>>()
    };
    let has = |functions: &[String], name: &str| functions.iter().any(|function| function == name);
    let none = functions(MAPPED, &[]);
    assert!(!has(&none, "filtered") && !has(&none, "gradient") && !has(&none, "mapped_normal"), "{none:?}");
    let color = functions(MAPPED, &[("COLOR_MAP", 0.0)]);
    assert!(has(&color, "filtered") && has(&color, "factor") && !has(&color, "gradient"), "{color:?}");
    let height = functions(Text { relief: true, ..MAPPED }, &[("HEIGHT_MAP", 0.0)]);
    assert!(has(&height, "gradient") && has(&height, "bumped_normal") && !has(&height, "mapped_normal"), "{height:?}");
}

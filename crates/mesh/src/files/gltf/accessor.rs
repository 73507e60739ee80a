//! Accessors: typed views into the buffers, measured before they are read.

use std::borrow::Cow;
use std::collections::HashMap;
use std::rc::Rc;

use gltf::Accessor;
use gltf::accessor::sparse::{IndexType, Sparse};
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::View;

use super::fault::Fault;

/// The most bytes of mesh data that one byte of the file may become. Honest files stay far below: a vertex of a few
/// bytes becomes one of 64 at most, and an index of one byte, in a strip, three of four bytes.
pub(super) const EXPANSION: usize = 64;

/// The types that an attribute may have.
pub(super) struct Attribute {
    shapes: &'static [Dimensions],
    /// Integers among them are normalised.
    types: &'static [DataType],
    /// The types that `KHR_mesh_quantization` adds.
    quantized: &'static [DataType],
    /// Whether that extension allows integers that are not normalised.
    plain: bool,
}

use DataType::{F32, I8, I16, U8, U16};

pub(super) const POSITION: Attribute =
    Attribute { shapes: &[Dimensions::Vec3], types: &[F32], quantized: &[I8, U8, I16, U16], plain: true };
pub(super) const NORMAL: Attribute =
    Attribute { shapes: &[Dimensions::Vec3], types: &[F32], quantized: &[I8, I16], plain: false };
pub(super) const TANGENT: Attribute =
    Attribute { shapes: &[Dimensions::Vec4], types: &[F32], quantized: &[I8, I16], plain: false };
pub(super) const TEXCOORD: Attribute =
    Attribute { shapes: &[Dimensions::Vec2], types: &[F32, U8, U16], quantized: &[I8, I16], plain: true };
pub(super) const COLOR: Attribute =
    Attribute { shapes: &[Dimensions::Vec3, Dimensions::Vec4], types: &[F32, U8, U16], quantized: &[], plain: false };

/// Times of key frames.
pub(super) const TIME: Attribute =
    Attribute { shapes: &[Dimensions::Scalar], types: &[F32], quantized: &[], plain: false };
/// Translations and scales.
pub(super) const LENGTHS: Attribute =
    Attribute { shapes: &[Dimensions::Vec3], types: &[F32], quantized: &[], plain: false };
/// Rotations.
pub(super) const TURN: Attribute =
    Attribute { shapes: &[Dimensions::Vec4], types: &[F32, I8, U8, I16, U16], quantized: &[], plain: false };
/// Weights of morph targets, in time.
pub(super) const WEIGHT: Attribute =
    Attribute { shapes: &[Dimensions::Scalar], types: &[F32, I8, U8, I16, U16], quantized: &[], plain: false };
/// Weights of joints.
pub(super) const WEIGHTS: Attribute =
    Attribute { shapes: &[Dimensions::Vec4], types: &[F32, U8, U16], quantized: &[], plain: false };
pub(super) const MATRIX: Attribute =
    Attribute { shapes: &[Dimensions::Mat4], types: &[F32], quantized: &[], plain: false };
/// Displacements of morph targets.
pub(super) const DISPLACEMENT: Attribute =
    Attribute { shapes: &[Dimensions::Vec3], types: &[F32], quantized: &[I8, I16], plain: true };

/// Measures accessors and finds their data.
///
/// The meshes made of them are counted against a budget in proportion to the buffers, so that a small file whose
/// elements share their data cannot ask for much memory.
pub(super) struct Accessors<'a> {
    buffers: &'a [Cow<'a, [u8]>],
    bytes: usize,
    budget: usize,
    /// Whether `KHR_mesh_quantization` is used.
    quantized: bool,
    /// Sparse accessors, written out.
    dense: HashMap<usize, Rc<[u8]>>,
}

/// The items of an accessor, all of which are there.
pub(super) struct Items<'a> {
    data: AccessorBytes<'a>,
    stride: usize,
    data_type: DataType,
    normalized: bool,
    pub(super) shape: Dimensions,
    pub(super) count: usize,
}

enum AccessorBytes<'a> {
    Plain(&'a [u8]),
    Dense(Rc<[u8]>),
}

impl AccessorBytes<'_> {
    fn bytes(&self) -> &[u8] {
        match self {
            Self::Plain(bytes) => bytes,
            Self::Dense(bytes) => bytes,
        }
    }
}

/// The items that are read, in order.
pub(super) enum Which {
    All,
    These(Vec<u32>),
}

impl Items<'_> {
    /// Items of `N` numbers. Integers that are normalised become fractions (glTF 2.0 §3.11).
    pub(super) fn floats<const N: usize, T>(&self, which: &Which, make: impl Fn([f32; N]) -> T) -> Vec<T> {
        match (self.data_type, self.normalized) {
            (I8, true) => self.decoded(which, |x| (f32::from(i8::from_le_bytes(x)) / 127.0).max(-1.0), make),
            (I8, false) => self.decoded(which, |x| i8::from_le_bytes(x).into(), make),
            (U8, true) => self.decoded(which, |x| f32::from(u8::from_le_bytes(x)) / 255.0, make),
            (U8, false) => self.decoded(which, |x| u8::from_le_bytes(x).into(), make),
            (I16, true) => self.decoded(which, |x| (f32::from(i16::from_le_bytes(x)) / 32767.0).max(-1.0), make),
            (I16, false) => self.decoded(which, |x| i16::from_le_bytes(x).into(), make),
            (U16, true) => self.decoded(which, |x| f32::from(u16::from_le_bytes(x)) / 65535.0, make),
            (U16, false) => self.decoded(which, |x| u16::from_le_bytes(x).into(), make),
            (F32, _) => self.decoded(which, f32::from_le_bytes, make),
            // No attribute has this type.
            (DataType::U32, _) => self.decoded(which, |x| u32::from_le_bytes(x) as f32, make),
        }
    }

    fn indices(&self) -> Vec<u32> {
        match self.data_type {
            U8 => self.decoded(&Which::All, |x| u32::from(u8::from_le_bytes(x)), |[i]| i),
            U16 => self.decoded(&Which::All, |x| u32::from(u16::from_le_bytes(x)), |[i]| i),
            _ => self.decoded(&Which::All, u32::from_le_bytes, |[i]| i),
        }
    }

    /// Items of `N` numbers of `S` bytes.
    fn decoded<const N: usize, const S: usize, X, T>(
        &self,
        which: &Which,
        number: impl Fn([u8; S]) -> X,
        make: impl Fn([X; N]) -> T,
    ) -> Vec<T> {
        let bytes = self.data.bytes();
        let item = |i: usize| {
            let (words, _) = bytes[i * self.stride..][..N * S].as_chunks::<S>();
            make(std::array::from_fn(|k| number(words[k])))
        };
        match which {
            Which::All => (0..self.count).map(item).collect(),
            Which::These(items) => items.iter().map(|&i| item(i as usize)).collect(),
        }
    }
}

impl<'a> Accessors<'a> {
    /// `bytes` of the buffers are in the file; others were unpacked.
    pub(super) fn new(buffers: &'a [Cow<'a, [u8]>], bytes: usize, quantized: bool) -> Self {
        Self { buffers, bytes, budget: bytes.saturating_mul(EXPANSION), quantized, dense: HashMap::new() }
    }

    /// Takes the bytes of the next allocation from the budget.
    pub(super) fn spend(&mut self, element: &dyn Fn() -> String, bytes: usize) -> Result<(), Fault> {
        match self.budget.checked_sub(bytes) {
            Some(left) => {
                self.budget = left;
                Ok(())
            }
            None => Err(Fault::element(
                element(),
                format!("meshes of more than {EXPANSION} times the {} bytes of data", self.bytes),
                "less is",
            )),
        }
    }

    /// The items of an attribute.
    pub(super) fn attribute(&mut self, accessor: &Accessor, attribute: &Attribute) -> Result<Items<'a>, Fault> {
        let quantized = if self.quantized { attribute.quantized } else { &[] };
        expect(accessor, attribute.shapes, &[attribute.types, quantized].concat())?;
        let may_be_plain = attribute.plain && self.quantized;
        if accessor.data_type() != F32 && !accessor.normalized() && !may_be_plain {
            let expected = "integers that are normalised are";
            return Err(Fault::element(name(accessor), "normalized false", expected));
        }
        self.items(accessor)
    }

    /// The joints of vertices: four a vertex.
    pub(super) fn joints(&mut self, accessor: &Accessor) -> Result<Items<'a>, Fault> {
        expect(accessor, &[Dimensions::Vec4], &[U8, U16])?;
        self.items(accessor)
    }

    /// All the items of an attribute, of `N` numbers each.
    pub(super) fn floats<const N: usize>(
        &mut self,
        accessor: &Accessor,
        attribute: &Attribute,
    ) -> Result<Vec<[f32; N]>, Fault> {
        let items = self.attribute(accessor, attribute)?;
        self.spend(&|| name(accessor), items.count.saturating_mul(size_of::<[f32; N]>()))?;
        let floats = items.floats(&Which::All, |numbers| numbers);
        match floats.as_flattened().iter().find(|x: &&f32| !x.is_finite()) {
            None => Ok(floats),
            Some(found) => Err(Fault::element(name(accessor), found.to_string(), "finite numbers are")),
        }
    }

    /// The indices of a primitive.
    pub(super) fn indices(&mut self, accessor: &Accessor) -> Result<Vec<u32>, Fault> {
        expect(accessor, &[Dimensions::Scalar], &[U8, U16, DataType::U32])?;
        let items = self.items(accessor)?;
        self.spend(&|| name(accessor), items.count.saturating_mul(size_of::<u32>()))?;
        Ok(items.indices())
    }

    /// The items of an accessor, after checking that they exist.
    fn items(&mut self, accessor: &Accessor) -> Result<Items<'a>, Fault> {
        self.measure(accessor)?;
        let buffers = self.buffers;
        let (data, stride) = match (accessor.view(), accessor.sparse()) {
            (Some(view), None) => {
                let bytes = &buffers[view.buffer().index()][view.offset()..][..view.length()];
                (AccessorBytes::Plain(&bytes[accessor.offset()..]), view.stride().unwrap_or(accessor.size()))
            }
            (_, sparse) => (AccessorBytes::Dense(self.densified(accessor, sparse.as_ref())?), accessor.size()),
        };
        Ok(Items {
            data,
            stride,
            data_type: accessor.data_type(),
            normalized: accessor.normalized(),
            shape: accessor.dimensions(),
            count: accessor.count(),
        })
    }

    /// The items of a sparse accessor, which has been measured, one after the other.
    fn densified(&mut self, accessor: &Accessor, sparse: Option<&Sparse>) -> Result<Rc<[u8]>, Fault> {
        if let Some(known) = self.dense.get(&accessor.index()) {
            return Ok(known.clone());
        }
        let size = accessor.size();
        self.spend(&|| name(accessor), accessor.count().saturating_mul(size))?;
        let mut dense = vec![0; accessor.count() * size];
        let view_bytes = |view: &View| &self.buffers[view.buffer().index()][view.offset()..][..view.length()];
        if let Some(view) = accessor.view() {
            let bytes = &view_bytes(&view)[accessor.offset()..];
            let stride = view.stride().unwrap_or(size);
            for (i, item) in dense.chunks_exact_mut(size).enumerate() {
                item.copy_from_slice(&bytes[i * stride..][..size]);
            }
        }
        if let Some(sparse) = sparse {
            let (view, offset) = (sparse.values().view(), sparse.values().offset());
            let bytes = &view_bytes(&view)[offset..];
            let stride = view.stride().unwrap_or(size);
            for i in 0..sparse.count() {
                let place = self.sparse_index(sparse, i) * size;
                dense[place..place + size].copy_from_slice(&bytes[i * stride..][..size]);
            }
        }
        let dense: Rc<[u8]> = dense.into();
        self.dense.insert(accessor.index(), dense.clone());
        Ok(dense)
    }

    fn measure(&self, accessor: &Accessor) -> Result<(), Fault> {
        let run = ItemRun { offset: accessor.offset(), count: accessor.count(), item: accessor.size() };
        match accessor.view() {
            Some(view) => self.measure_run(&name(accessor), &view, run)?,
            // All zero but for the sparse values: nothing else bounds the count.
            None if run.count == 0 || run.count > self.bytes => {
                return Err(Fault::element(
                    name(accessor),
                    format!("count {} without a bufferView", run.count),
                    format!("a number from 1 to the {} bytes of data is", self.bytes),
                ));
            }
            None => {}
        }
        match accessor.sparse() {
            Some(sparse) => self.measure_sparse(accessor, &sparse),
            None => Ok(()),
        }
    }

    /// Checks that a run of items lies in its view, and the view in its buffer.
    fn measure_run(&self, element: &str, view: &View, run: ItemRun) -> Result<(), Fault> {
        let buffer = self.buffers.get(view.buffer().index()).map_or(0, |buffer| buffer.len());
        let fits =
            |offset: usize, length: usize, whole: usize| offset.checked_add(length).is_some_and(|end| end <= whole);
        if !fits(view.offset(), view.length(), buffer) {
            return Err(Fault::element(
                format!("bufferViews[{}]", view.index()),
                format!("byteOffset {} and byteLength {}", view.offset(), view.length()),
                format!("at most the buffer's {buffer} bytes are"),
            ));
        }
        let stride = view.stride().unwrap_or(run.item);
        if stride < run.item {
            return Err(Fault::element(
                format!("bufferViews[{}].byteStride", view.index()),
                stride.to_string(),
                format!("at least the {} bytes of an item of {element} are", run.item),
            ));
        }
        let length = run
            .count
            .checked_sub(1)
            .and_then(|steps| steps.checked_mul(stride))
            .and_then(|length| length.checked_add(run.item));
        if length.is_some_and(|length| fits(run.offset, length, view.length())) {
            return Ok(());
        }
        Err(Fault::element(
            element,
            format!("byteOffset {} and count {}", run.offset, run.count),
            format!("at least one item, and no more than {} bytes hold, is", view.length()),
        ))
    }

    fn measure_sparse(&self, accessor: &Accessor, sparse: &Sparse) -> Result<(), Fault> {
        let element = format!("{}.sparse", name(accessor));
        let (indices, values) = (sparse.indices(), sparse.values());
        if sparse.count() > accessor.count() {
            let found = format!("count {}", sparse.count());
            let expected = format!("at most the accessor's count {} is", accessor.count());
            return Err(Fault::element(element, found, expected));
        }
        let run = |offset, item| ItemRun { offset, count: sparse.count(), item };
        let index_run = run(indices.offset(), indices.index_type().size());
        self.measure_run(&format!("{element}.indices"), &indices.view(), index_run)?;
        let value_run = run(values.offset(), accessor.size());
        self.measure_run(&format!("{element}.values"), &values.view(), value_run)?;
        self.check_sparse_indices(&element, accessor, sparse)
    }

    /// Checks that the indices of sparse values increase and are in range.
    fn check_sparse_indices(&self, element: &str, accessor: &Accessor, sparse: &Sparse) -> Result<(), Fault> {
        let mut least = 0;
        for i in 0..sparse.count() {
            let index = self.sparse_index(sparse, i);
            if index < least || index >= accessor.count() {
                return Err(Fault::element(
                    format!("{element}.indices"),
                    format!("index {index} as number {i}"),
                    format!("a growing sequence below {} is", accessor.count()),
                ));
            }
            least = index + 1;
        }
        Ok(())
    }

    /// An index of sparse values, whose run has been measured.
    fn sparse_index(&self, sparse: &Sparse, i: usize) -> usize {
        let indices = sparse.indices();
        let view = indices.view();
        let size = indices.index_type().size();
        let stride = view.stride().unwrap_or(size);
        let bytes = &self.buffers[view.buffer().index()][view.offset() + indices.offset() + i * stride..][..size];
        match (indices.index_type(), bytes) {
            (IndexType::U8, &[a]) => usize::from(a),
            (IndexType::U16, &[a, b]) => usize::from(u16::from_le_bytes([a, b])),
            (_, &[a, b, c, d]) => u32::from_le_bytes([a, b, c, d]) as usize,
            _ => usize::MAX,
        }
    }
}

/// A row of equally spaced items in a view.
#[derive(Clone, Copy)]
struct ItemRun {
    offset: usize,
    count: usize,
    item: usize,
}

pub(super) fn name(accessor: &Accessor) -> String {
    format!("accessors[{}]", accessor.index())
}

fn expect(accessor: &Accessor, shapes: &[Dimensions], types: &[DataType]) -> Result<(), Fault> {
    if shapes.contains(&accessor.dimensions()) && types.contains(&accessor.data_type()) {
        return Ok(());
    }
    let shapes: Vec<String> = shapes.iter().map(|shape| format!("{shape:?}")).collect();
    Err(Fault::element(
        name(accessor),
        format!("{:?} of {:?}", accessor.dimensions(), accessor.data_type()),
        format!("{} of one of {types:?} is", shapes.join(" or ")),
    ))
}

//! Accessors: typed views into the buffers, measured before they are read.

use std::collections::HashMap;
use std::rc::Rc;

use bevy_math::{Vec2, Vec3};
use gltf::accessor::sparse::{IndexType, Sparse};
use gltf::accessor::{DataType, Dimensions, Item, Iter};
use gltf::buffer::View;
use gltf::{Accessor, Buffer};

use super::Fault;

/// How many bytes of meshes a byte of data may become. Honest files stay far below: an index of one byte can bring a
/// vertex of 32 bytes and, in a strip, three indices of four.
const EXPANSION: usize = 64;

/// Reads accessors, each once.
///
/// What is read and made of it is counted against a budget in proportion to the buffers, so that a small file whose
/// elements share their data cannot ask for much memory.
pub(super) struct Accessors<'a> {
    buffers: &'a [Vec<u8>],
    bytes: usize,
    budget: usize,
    vec3s: HashMap<usize, Rc<[Vec3]>>,
    vec2s: HashMap<usize, Rc<[Vec2]>>,
}

impl<'a> Accessors<'a> {
    pub(super) fn new(buffers: &'a [Vec<u8>]) -> Self {
        let bytes = buffers.iter().map(Vec::len).sum::<usize>();
        Self { buffers, bytes, budget: bytes.saturating_mul(EXPANSION), vec3s: HashMap::new(), vec2s: HashMap::new() }
    }

    /// Takes the bytes of what is about to be made from the budget.
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

    /// Triples of `f32`: positions, normals.
    pub(super) fn vec3s(&mut self, accessor: &Accessor) -> Result<Rc<[Vec3]>, Fault> {
        if let Some(known) = self.vec3s.get(&accessor.index()) {
            return Ok(known.clone());
        }
        expect(accessor, Dimensions::Vec3, &[DataType::F32])?;
        self.admit(accessor, size_of::<Vec3>())?;
        let read: Rc<[Vec3]> = self.items::<[f32; 3]>(accessor)?.map(Vec3::from_array).collect();
        self.vec3s.insert(accessor.index(), read.clone());
        Ok(read)
    }

    /// Pairs of `f32`, or of normalised integers: texture coordinates.
    pub(super) fn vec2s(&mut self, accessor: &Accessor) -> Result<Rc<[Vec2]>, Fault> {
        if let Some(known) = self.vec2s.get(&accessor.index()) {
            return Ok(known.clone());
        }
        let allowed = [DataType::F32, DataType::U8, DataType::U16];
        expect(accessor, Dimensions::Vec2, &allowed)?;
        if accessor.data_type() != DataType::F32 && !accessor.normalized() {
            let expected = "integers that are normalised are";
            return Err(Fault::element(name(accessor), "normalized false", expected));
        }
        self.admit(accessor, size_of::<Vec2>())?;
        let read: Rc<[Vec2]> = match accessor.data_type() {
            DataType::U8 => {
                self.items::<[u8; 2]>(accessor)?.map(|uv| Vec2::from_array(uv.map(|x| f32::from(x) / 255.0))).collect()
            }
            DataType::U16 => self
                .items::<[u16; 2]>(accessor)?
                .map(|uv| Vec2::from_array(uv.map(|x| f32::from(x) / 65535.0)))
                .collect(),
            _ => self.items::<[f32; 2]>(accessor)?.map(Vec2::from_array).collect(),
        };
        self.vec2s.insert(accessor.index(), read.clone());
        Ok(read)
    }

    /// The indices of a primitive.
    pub(super) fn indices(&mut self, accessor: &Accessor) -> Result<Vec<u32>, Fault> {
        let allowed = [DataType::U8, DataType::U16, DataType::U32];
        expect(accessor, Dimensions::Scalar, &allowed)?;
        self.admit(accessor, size_of::<u32>())?;
        Ok(match accessor.data_type() {
            DataType::U8 => self.items::<u8>(accessor)?.map(u32::from).collect(),
            DataType::U16 => self.items::<u16>(accessor)?.map(u32::from).collect(),
            _ => self.items::<u32>(accessor)?.collect(),
        })
    }

    /// Makes sure that all items of an accessor are there, and that there is room for what they are read into.
    fn admit(&mut self, accessor: &Accessor, bytes_each: usize) -> Result<(), Fault> {
        self.measure(accessor)?;
        self.spend(&|| name(accessor), accessor.count().saturating_mul(bytes_each))
    }

    /// The items of an accessor that has been admitted.
    fn items<T: Item>(&self, accessor: &Accessor) -> Result<Iter<'a, T>, Fault> {
        let buffers = self.buffers;
        Iter::new(accessor.clone(), move |buffer: Buffer| buffers.get(buffer.index()).map(Vec::as_slice))
            .ok_or_else(|| Fault::element(name(accessor), "no data", "a buffer view is"))
    }

    fn measure(&self, accessor: &Accessor) -> Result<(), Fault> {
        let run = Run { offset: accessor.offset(), count: accessor.count(), item: accessor.size() };
        match accessor.view() {
            Some(view) => self.measure_run(&name(accessor), &view, run)?,
            // All zero but for the sparse values: nothing but this bounds the count.
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

    /// That a run of items lies in its view, and the view in its buffer.
    fn measure_run(&self, element: &str, view: &View, run: Run) -> Result<(), Fault> {
        let buffer = self.buffers.get(view.buffer().index()).map_or(0, Vec::len);
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
        let run = |offset, item| Run { offset, count: sparse.count(), item };
        let index_run = run(indices.offset(), indices.index_type().size());
        self.measure_run(&format!("{element}.indices"), &indices.view(), index_run)?;
        let value_run = run(values.offset(), accessor.size());
        self.measure_run(&format!("{element}.values"), &values.view(), value_run)?;
        self.check_sparse_indices(&element, accessor, sparse)
    }

    /// That the indices of sparse values grow from one to the next and are in range.
    fn check_sparse_indices(&self, element: &str, accessor: &Accessor, sparse: &Sparse) -> Result<(), Fault> {
        let indices = sparse.indices();
        let view = indices.view();
        let size = indices.index_type().size();
        let stride = view.stride().unwrap_or(size);
        let data = &self.buffers[view.buffer().index()][view.offset() + indices.offset()..];
        let mut least = 0;
        for i in 0..sparse.count() {
            let bytes = &data[i * stride..][..size];
            let index = match (indices.index_type(), bytes) {
                (IndexType::U8, &[a]) => usize::from(a),
                (IndexType::U16, &[a, b]) => usize::from(u16::from_le_bytes([a, b])),
                (_, &[a, b, c, d]) => u32::from_le_bytes([a, b, c, d]) as usize,
                _ => usize::MAX,
            };
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
}

/// A row of equally spaced items in a view.
#[derive(Clone, Copy)]
struct Run {
    offset: usize,
    count: usize,
    item: usize,
}

fn name(accessor: &Accessor) -> String {
    format!("accessors[{}]", accessor.index())
}

fn expect(accessor: &Accessor, shape: Dimensions, types: &[DataType]) -> Result<(), Fault> {
    if accessor.dimensions() == shape && types.contains(&accessor.data_type()) {
        return Ok(());
    }
    Err(Fault::element(
        name(accessor),
        format!("{:?} of {:?}", accessor.dimensions(), accessor.data_type()),
        format!("{shape:?} of one of {types:?} is"),
    ))
}

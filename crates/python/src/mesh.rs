//! Meshes from arrays and from files.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

use halfway::mesh::{
    Format, LoadOptions, Model, MtlMaps, MtlMaterial, Part, Property, ScalarValues, SourceMap, SourceMaterial,
    load_with,
};
use halfway::prelude::{Mat4, Vec2, Vec3, Vec4};
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;

use crate::work::{Failure, detached};

/// Triangles that can be drawn any number of times; they do not change.
#[pyclass(frozen, module = "halfway._halfway")]
pub(crate) struct Mesh {
    pub(crate) model: Arc<Model>,
    /// The name in messages.
    pub(crate) name: PathBuf,
}

/// Vectors from contiguous numbers.
fn vectors<const N: usize, V: From<[f32; N]>>(py: Python<'_>, numbers: &PyBuffer<f32>) -> PyResult<Vec<V>> {
    Ok(numbers.to_vec(py)?.as_chunks::<N>().0.iter().map(|&v| V::from(v)).collect())
}

#[pymethods]
impl Mesh {
    /// A mesh of contiguous arrays: x, y, z of each vertex, three indices a triangle, and what else there is of each
    /// vertex. `properties` are numbers with a name, of each vertex or of each triangle. `image` is the bytes of a PNG
    /// or JPEG that multiplies the diffuse colour. Vertices are counted from `origin`.
    #[new]
    #[pyo3(signature = (
        name, vertices, faces, normals=None, uvs=None, colors=None, properties=Vec::new(), image=None, origin=[0.0; 3]
    ))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn new(
        py: Python<'_>,
        name: String,
        vertices: PyBuffer<f32>,
        faces: PyBuffer<u32>,
        normals: Option<PyBuffer<f32>>,
        uvs: Option<PyBuffer<f32>>,
        colors: Option<PyBuffer<f32>>,
        properties: Vec<(String, bool, PyBuffer<f32>)>,
        image: Option<Vec<u8>>,
        origin: [f64; 3],
    ) -> PyResult<Self> {
        let positions: Vec<Vec3> = vectors(py, &vertices)?;
        let indices = faces.to_vec(py)?;
        let normals: Option<Vec<Vec3>> = normals.map(|normals| vectors(py, &normals)).transpose()?;
        let uvs: Option<Vec<Vec2>> = uvs.map(|uvs| vectors(py, &uvs)).transpose()?;
        let colors: Option<Vec<Vec4>> = colors.map(|colors| vectors(py, &colors)).transpose()?;
        let properties = properties.into_iter().map(|(name, is_of_faces, values)| {
            let values = values.to_vec(py)?;
            let values = if is_of_faces { ScalarValues::Faces(values) } else { ScalarValues::Vertices(values) };
            Ok(Property { name, part: 0, values })
        });
        let properties = properties.collect::<PyResult<Arc<[_]>>>()?;
        detached(py, move || {
            let mesh = halfway::mesh::Mesh::from_parts(positions, normals, uvs, indices).map_err(Failure::input)?;
            let mesh = colors.map_or(Ok(mesh.clone()), |colors| mesh.with_colors(colors)).map_err(Failure::input)?;
            let materials: Vec<SourceMaterial> = image.map(image_on_white).into_iter().collect();
            let material = materials.first().map(|_| 0);
            let part = Part { name: String::new(), mesh, material, world_from_part: Mat4::IDENTITY };
            let model = Model { parts: vec![part], materials, properties, origin: origin.into(), ..Model::default() };
            Ok(Self { model: Arc::new(model), name: name.into() })
        })
    }

    /// Reads a model file. `format` is the ending of such files, where that of the path does not tell.
    #[staticmethod]
    #[pyo3(signature = (path, format=None, outside=false))]
    fn read(py: Python<'_>, path: PathBuf, format: Option<&str>, outside: bool) -> PyResult<Self> {
        let format = format.map(|name| {
            let known = Format::ALL.map(Format::extension).join(", ");
            let found = Format::ALL.into_iter().find(|format| format.extension() == name);
            found.ok_or_else(|| Failure::Input(format!("format: {name:?}; expected one of {known}")))
        });
        let options = LoadOptions { outside, format: format.transpose()?, limit: None };
        detached(py, move || {
            let model = load_with(&path, options, &mut |_| ControlFlow::Continue(())).map_err(Failure::input)?;
            Ok(Self { model: Arc::new(model), name: path })
        })
    }

    /// How many vertices and triangles all parts have.
    fn counts(&self) -> (usize, usize) {
        let vertices = self.model.parts.iter().map(|part| part.mesh.positions().len()).sum();
        (vertices, self.model.triangle_count())
    }

    /// The point from which coordinates are counted.
    fn origin(&self) -> [f64; 3] {
        self.model.origin.to_array()
    }

    /// The least and the greatest coordinates, counted from the origin.
    fn bounds(&self) -> Option<([f32; 3], [f32; 3])> {
        self.model.bounds().map(|bounds| (bounds.min.to_array(), bounds.max.to_array()))
    }

    /// Sentences about all that was skipped or corrected when the file was read.
    fn warnings(&self) -> Vec<String> {
        self.model.warnings.clone()
    }

    /// Whether it comes with lights.
    fn has_lights(&self) -> bool {
        !self.model.lights.is_empty()
    }

    /// The names of the numbers beside the mesh.
    fn properties(&self) -> Vec<String> {
        self.model.properties.iter().map(|property| property.name.clone()).collect()
    }

    /// The vertices (f32, where they stand in the model) and the triangles (u32) of all parts, one after the other.
    fn arrays<'py>(&self, py: Python<'py>) -> (Bound<'py, PyByteArray>, Bound<'py, PyByteArray>) {
        let (mut vertices, mut faces, mut first) = (Vec::new(), Vec::new(), 0);
        for part in &self.model.parts {
            let placed = part.mesh.positions().iter().map(|&p| part.world_from_part.transform_point3(p));
            vertices.extend(placed.flat_map(|p| p.to_array()).flat_map(f32::to_ne_bytes));
            faces.extend(part.mesh.indices().iter().flat_map(|index| (index + first).to_ne_bytes()));
            first += part.mesh.positions().len() as u32;
        }
        (PyByteArray::new(py, &vertices), PyByteArray::new(py, &faces))
    }
}

/// The point from which the vertices of a box are counted.
#[pyfunction]
pub(crate) fn origin_of_box(low: [f64; 3], high: [f64; 3]) -> [f64; 3] {
    halfway::mesh::origin_of_box(low.into(), high.into()).to_array()
}

/// A white material with an image.
fn image_on_white(bytes: Vec<u8>) -> SourceMaterial {
    let map = SourceMap::new("image".to_owned(), bytes.into());
    let finish = halfway::scene::options::finish(halfway::prelude::LinearRgba::WHITE);
    SourceMaterial::Mtl(MtlMaterial {
        ka: Some([1.0; 3]),
        kd: Some([1.0; 3]),
        ks: Some([finish.specular.red, finish.specular.green, finish.specular.blue]),
        ns: Some(finish.shininess),
        maps: MtlMaps { kd: Some(map), ..MtlMaps::default() },
        ..MtlMaterial::default()
    })
}

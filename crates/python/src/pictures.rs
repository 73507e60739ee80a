//! Pictures as arrays of bytes or of floats: read, written and compared.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use halfway::output::{AnimationWriter, FrameDelay, PictureFormat, encode_picture, write_picture};
use halfway::prelude::{Encoding, Picture};
use halfway::reference::Image;
use halfway::reference::metrics::{Scale, compare, difference, flip};
use halfway::scene::SceneFile;
use halfway::texture::decode_stored;
use image::{DynamicImage, ImageBuffer, Limits, RgbaImage};
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes, PyDict};

use crate::work::{Failure, detached};

/// Width, height, whether the numbers are floats, and the numbers.
pub(crate) type Pixels<'py> = (u32, u32, bool, Bound<'py, PyByteArray>);

/// A picture as numbers for Python: four channels of bytes, or of floats.
pub(crate) fn to_python<'py>(py: Python<'py>, picture: &Picture) -> Pixels<'py> {
    let (width, height) = picture.dimensions();
    match picture {
        Picture::Byte(image) => (width, height, false, PyByteArray::new(py, image.as_raw())),
        Picture::Float(image) => (width, height, true, floats(py, image.as_raw())),
    }
}

/// Floats as an array for Python.
pub(crate) fn floats<'py>(py: Python<'py>, numbers: &[f32]) -> Bound<'py, PyByteArray> {
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_ne_bytes()).collect();
    PyByteArray::new(py, &bytes)
}

/// A picture from Python: contiguous rows of four bytes or four floats a pixel.
#[derive(FromPyObject)]
pub(crate) enum Given {
    Bytes(PyBuffer<u8>),
    Floats(PyBuffer<f32>),
}

impl Given {
    pub(crate) fn picture(&self, py: Python<'_>, (width, height): (u32, u32)) -> PyResult<Picture> {
        let wrong = || Failure::Input(format!("the picture is not {width} x {height} pixels of four channels"));
        Ok(match self {
            Self::Bytes(bytes) => {
                Picture::Byte(RgbaImage::from_raw(width, height, bytes.to_vec(py)?).ok_or_else(wrong)?)
            }
            Self::Floats(floats) => {
                Picture::Float(ImageBuffer::from_raw(width, height, floats.to_vec(py)?).ok_or_else(wrong)?)
            }
        })
    }
}

/// A picture as intensities.
pub(crate) fn intensities(picture: &Picture, encoding: Encoding) -> Image {
    match picture {
        Picture::Byte(image) => Image::from_bytes(image, encoding),
        Picture::Float(image) => Image::from_float(image),
    }
}

pub(crate) fn encoding(name: &str) -> Result<Encoding, Failure> {
    match name {
        "srgb" => Ok(Encoding::Srgb),
        "raw" => Ok(Encoding::Raw),
        _ => Err(Failure::Input(format!("encoding: {name:?}; expected srgb or raw"))),
    }
}

/// Writes a picture by the ending of the file's name.
#[pyfunction]
fn save(
    py: Python<'_>,
    file: PathBuf,
    pixels: Given,
    size: (u32, u32),
    bits: Option<u32>,
    encoding_name: &str,
) -> PyResult<()> {
    let (picture, encoding) = (pixels.picture(py, size)?, encoding(encoding_name)?);
    detached(py, move || {
        let format = PictureFormat::from_path(&file, bits).map_err(Failure::input)?;
        write_picture(&picture, &file, format, encoding).map_err(Failure::input)
    })
}

/// The bytes of a PNG of 8 bits a channel.
#[pyfunction]
fn png<'py>(py: Python<'py>, pixels: Given, size: (u32, u32), encoding_name: &str) -> PyResult<Bound<'py, PyBytes>> {
    let (picture, encoding) = (pixels.picture(py, size)?, encoding(encoding_name)?);
    let bytes = detached(py, move || {
        let mut bytes = Vec::new();
        let written = encode_picture(&picture, &mut bytes, Path::new("picture"), PictureFormat::Png8, encoding);
        written.map(|()| bytes).map_err(Failure::input)
    })?;
    Ok(PyBytes::new(py, &bytes))
}

/// Reads a PNG (bytes, even where it has 16 bits), or an EXR (floats).
#[pyfunction]
fn open(py: Python<'_>, file: PathBuf) -> PyResult<Pixels<'_>> {
    let picture = detached(py, move || {
        let name = file.display().to_string();
        let opened = File::open(&file).map_err(|error| Failure::Input(format!("{name}: cannot be read: {error}")))?;
        let most = SceneFile::MAX_SIDE;
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(most), Some(most));
        limits.max_alloc = Some(16 * u64::from(most) * u64::from(most));
        let decoded = decode_stored(BufReader::new(opened), &name, limits).map_err(Failure::input)?;
        Ok(match decoded {
            DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => Picture::Float(decoded.into_rgba32f()),
            bytes => Picture::Byte(bytes.into_rgba8()),
        })
    })?;
    Ok(to_python(py, &picture))
}

/// The differences of two pictures, as figures.
#[pyfunction(name = "compare")]
fn compare_pictures<'py>(
    py: Python<'py>,
    actual: Given,
    expected: Given,
    size: (u32, u32),
    encoding_name: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let encoding = encoding(encoding_name)?;
    let [actual, expected] = [actual.picture(py, size)?, expected.picture(py, size)?];
    let (comparison, perceived) = detached(py, move || {
        let [actual, expected] = [intensities(&actual, encoding), intensities(&expected, encoding)];
        let comparison = compare(&actual, &expected, encoding).map_err(Failure::input)?;
        Ok((comparison, flip(&actual, &expected, encoding).map_err(Failure::input)?))
    })?;
    let figures = PyDict::new(py);
    figures.set_item("equal", comparison.equal)?;
    figures.set_item("max_steps", comparison.anywhere.steps)?;
    figures.set_item("at", comparison.anywhere.at)?;
    figures.set_item("mean_steps", comparison.steps.all.mean)?;
    figures.set_item("rmse_steps", comparison.steps.all.rmse)?;
    figures.set_item("rmse_linear", comparison.linear.all.rmse)?;
    figures.set_item("flip", perceived.mean)?;
    Ok(figures)
}

/// A picture of the differences of two, with a legend.
#[pyfunction]
fn diff<'py>(
    py: Python<'py>,
    actual: Given,
    expected: Given,
    size: (u32, u32),
    encoding_name: &str,
) -> PyResult<Pixels<'py>> {
    let encoding = encoding(encoding_name)?;
    let [actual, expected] = [actual.picture(py, size)?, expected.picture(py, size)?];
    let picture = detached(py, move || {
        let [actual, expected] = [intensities(&actual, encoding), intensities(&expected, encoding)];
        let drawn = difference(&actual, &expected, encoding, Scale::default()).map_err(Failure::input)?;
        Ok(Picture::Byte(DynamicImage::from(drawn).into_rgba8()))
    })?;
    Ok(to_python(py, &picture))
}

/// Writes pictures of bytes and of one size as an animated PNG.
#[pyfunction]
fn save_animation(
    py: Python<'_>,
    file: PathBuf,
    frames: Vec<PyBuffer<u8>>,
    size: (u32, u32),
    fps: u16,
    encoding_name: &str,
) -> PyResult<()> {
    let encoding = encoding(encoding_name)?;
    let frames = frames.into_iter().map(|frame| Given::Bytes(frame).picture(py, size)).collect::<PyResult<Vec<_>>>()?;
    detached(py, move || {
        let delay = FrameDelay::per_second(fps);
        let mut animation =
            AnimationWriter::create(&file, size, frames.len() as u32, delay, encoding).map_err(Failure::input)?;
        frames.iter().try_for_each(|frame| animation.frame(frame)).map_err(Failure::input)?;
        animation.finish().map_err(Failure::input)
    })
}

pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(save, module)?)?;
    module.add_function(wrap_pyfunction!(png, module)?)?;
    module.add_function(wrap_pyfunction!(open, module)?)?;
    module.add_function(wrap_pyfunction!(compare_pictures, module)?)?;
    module.add_function(wrap_pyfunction!(diff, module)?)?;
    module.add_function(wrap_pyfunction!(save_animation, module)?)
}

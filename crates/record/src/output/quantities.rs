//! Files of quantities: what a picture shows beside colour.

use std::borrow::Cow;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};

use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, Layer, LayerAttributes, Text, Vec2, WritableImage};
use exr::prelude::{Compression, Encoding as ExrEncoding};
use halfway_lighting::{Choices, Encoding};
use halfway_render::{Quantity, QuantityImage, QuantityValues};

use super::OutputError;
use super::encode::quantise;
use super::format::ending;
use super::partial::Partial;
use super::picture::{not_empty, tagged};

/// Checks that a file can hold a quantity: an `.exr` holds any, exactly. A `.png` holds ids, parts and triangles as grey
/// values of 16 bits, a coverage as 8 bits, and in three channels of 8 bits an albedo (sRGB), barycentrics (0 to 1) and
/// normals (−1 to 1 as 0 to 255).
///
/// # Errors
/// [`OutputError::UnknownEnding`], and [`OutputError::NotForPng`] for quantities that a PNG cannot hold.
pub fn check_quantity_file(quantity: Quantity, file: &Path) -> Result<(), OutputError> {
    match ending(file).as_str() {
        "exr" => Ok(()),
        "png" if png_form(quantity).is_some() => Ok(()),
        "png" => Err(OutputError::NotForPng { file: file.to_owned(), quantity: name(quantity) }),
        _ => Err(OutputError::UnknownEnding { file: file.to_owned(), known: ".png or .exr" }),
    }
}

/// Writes pictures of quantities, each to its file. Those for one EXR become its layers: the channels of a layer are
/// named for the quantity, as `depth.Z`. Alone in its file, a quantity has plain channels.
///
/// ```
/// use bevy_math::UVec2;
/// use halfway_record::output::write_quantities;
/// use halfway_render::{Quantity, QuantityImage, QuantityValues};
///
/// let values = QuantityValues::Numbers(vec![0, 1, 1, 2]);
/// let id = QuantityImage { quantity: Quantity::Id, size: UVec2::new(2, 2), values };
/// let file = std::env::temp_dir().join(format!("id_{}.png", std::process::id()));
/// write_quantities(&[(id, file.clone())])?;
/// let read = image::open(&file).unwrap().into_luma16();
/// assert_eq!(read.into_raw(), [0, 1, 1, 2]);
/// # std::fs::remove_file(file).unwrap();
/// # Ok::<(), halfway_record::output::OutputError>(())
/// ```
///
/// # Errors
/// Those of [`check_quantity_file`]; [`OutputError::NumberTooLarge`] for a number above 65,535 in a PNG;
/// [`OutputError::Twice`] for two quantities in one PNG; those of the system and the encoder.
pub fn write_quantities(images: &[(QuantityImage, PathBuf)]) -> Result<(), OutputError> {
    let mut written: Vec<&Path> = Vec::new();
    for (image, file) in images {
        check_quantity_file(image.quantity, file)?;
        if written.contains(&file.as_path()) {
            continue;
        }
        written.push(file);
        not_empty(file, image.size.into())?;
        let together: Vec<_> = images.iter().filter(|(_, other)| other == file).map(|(image, _)| image).collect();
        match (png_form(image.quantity), ending(file).as_str()) {
            (Some(form), "png") if together.len() == 1 => write_png(image, form, file)?,
            (_, "png") => return Err(OutputError::Twice { file: file.clone() }),
            _ => write_exr(&together, file)?,
        }
    }
    Ok(())
}

/// How a PNG holds a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PngForm {
    /// Grey, 16 bits.
    Numbers,
    /// Grey, 8 bits.
    Share,
    /// Three channels of 0 to 1.
    Shares,
    /// Three channels of −1 to 1.
    Directions,
    /// Three channels of linear light, encoded as sRGB.
    Colors,
}

fn png_form(quantity: Quantity) -> Option<PngForm> {
    use Quantity::{
        Albedo, Barycentrics, Coverage, Depth, Distance, EyeFaceNormal, EyeNormal, FaceNormal, Id, Normal, Part,
        Position, Triangle, Uv,
    };
    match quantity {
        Id | Part | Triangle => Some(PngForm::Numbers),
        Coverage => Some(PngForm::Share),
        Barycentrics => Some(PngForm::Shares),
        Normal | EyeNormal | FaceNormal | EyeFaceNormal => Some(PngForm::Directions),
        Albedo => Some(PngForm::Colors),
        Depth | Distance | Position | Uv => None,
    }
}

fn name(quantity: Quantity) -> &'static str {
    quantity.choice().map_or("this quantity", |choice| choice.key)
}

fn write_png(image: &QuantityImage, form: PngForm, file: &Path) -> Result<(), OutputError> {
    let bytes = png_bytes(image, form, file)?;
    let (partial, writer) = Partial::create(file)?;
    let mut encoder = png::Encoder::new(writer, image.size.x, image.size.y);
    let grey = matches!(form, PngForm::Numbers | PngForm::Share);
    encoder.set_color(if grey { png::ColorType::Grayscale } else { png::ColorType::Rgb });
    encoder.set_depth(if form == PngForm::Numbers { png::BitDepth::Sixteen } else { png::BitDepth::Eight });
    if form == PngForm::Colors {
        tagged(&mut encoder);
    }
    let written = encoder.write_header().and_then(|mut writer| {
        writer.write_image_data(&bytes)?;
        writer.finish()
    });
    written.map_err(|error| OutputError::png(file, error))?;
    partial.keep()
}

fn png_bytes(image: &QuantityImage, form: PngForm, file: &Path) -> Result<Vec<u8>, OutputError> {
    match &image.values {
        QuantityValues::Numbers(numbers) => {
            let mut bytes = Vec::with_capacity(2 * numbers.len());
            for &number in numbers {
                let quantity = name(image.quantity);
                let too_large = |_| OutputError::NumberTooLarge { file: file.to_owned(), quantity, number };
                bytes.extend(u16::try_from(number).map_err(too_large)?.to_be_bytes());
            }
            Ok(bytes)
        }
        QuantityValues::Floats(floats) => {
            // The background is no direction: 0, and not grey.
            let pixels = floats.chunks(image.quantity.channels().len());
            let byte = |value: f32, encoding| quantise(value, encoding, 255) as u8;
            let bytes = pixels.flat_map(|pixel| {
                let is_nothing = pixel.iter().all(|&value| value == 0.0);
                pixel.iter().map(move |&value| match form {
                    PngForm::Directions if is_nothing => 0,
                    PngForm::Directions => byte(0.5 * value + 0.5, Encoding::Raw),
                    PngForm::Colors => byte(value, Encoding::Srgb),
                    PngForm::Numbers | PngForm::Share | PngForm::Shares => byte(value, Encoding::Raw),
                })
            });
            Ok(bytes.collect())
        }
    }
}

fn write_exr(images: &[&QuantityImage], file: &Path) -> Result<(), OutputError> {
    let alone = images.len() == 1;
    let channels = images.iter().flat_map(|image| {
        let names = image.quantity.channels();
        names.iter().enumerate().map(move |(number, channel)| {
            let full =
                if alone { Cow::Borrowed(*channel) } else { format!("{}.{channel}", name(image.quantity)).into() };
            let samples = match &image.values {
                QuantityValues::Floats(floats) => {
                    FlatSamples::F32(floats.iter().skip(number).step_by(names.len()).copied().collect())
                }
                QuantityValues::Numbers(numbers) => FlatSamples::U32(numbers.clone()),
            };
            AnyChannel::new(Text::from(&*full), samples)
        })
    });
    let channels = AnyChannels::sort(channels.collect());
    let size = images[0].size;
    let encoding = ExrEncoding { compression: Compression::ZIP16, ..ExrEncoding::default() };
    let layer = Layer::new(Vec2(size.x as usize, size.y as usize), LayerAttributes::default(), encoding, channels);
    let mut bytes = Vec::new();
    let failed = |error: exr::error::Error| OutputError::Encode { file: file.to_owned(), message: error.to_string() };
    Image::from_layer(layer).write().to_buffered(Cursor::new(&mut bytes)).map_err(failed)?;
    let (partial, mut writer) = Partial::create(file)?;
    writer.write_all(&bytes).and_then(|()| writer.flush()).map_err(|source| OutputError::io(file, source))?;
    drop(writer);
    partial.keep()
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_math::UVec2;
    use exr::prelude::read_all_flat_layers_from_file;
    use halfway_render::QuantityValues::{Floats, Numbers};

    fn image(quantity: Quantity, values: QuantityValues) -> QuantityImage {
        QuantityImage { quantity, size: UVec2::new(2, 1), values }
    }

    #[test]
    fn quantities_of_one_exr_are_its_layers_to_the_bit() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("all.exr");
        let images = [
            image(Quantity::Normal, Floats(vec![0.25, -0.5, 0.125, 0.0, 0.0, -1.0])),
            image(Quantity::Depth, Floats(vec![3.25, f32::MAX])),
            image(Quantity::Triangle, Numbers(vec![16_777_217, u32::MAX])),
        ];
        write_quantities(&images.map(|image| (image, file.clone()))).expect("it is written");
        let read = read_all_flat_layers_from_file(&file).expect("it is read");
        let [layer] = &read.layer_data[..] else { panic!("{} layers", read.layer_data.len()) };
        let channels = layer.channel_data.list.iter().map(|channel| {
            let values = match &channel.sample_data {
                FlatSamples::F32(floats) => floats.iter().map(|value| value.to_bits()).collect(),
                FlatSamples::U32(numbers) => numbers.clone(),
                FlatSamples::F16(_) => Vec::new(),
            };
            (channel.name.to_string(), values)
        });
        let bits = |values: [f32; 2]| values.map(f32::to_bits).to_vec();
        let expected = [
            ("depth.Z", bits([3.25, f32::MAX])),
            ("normal.X", bits([0.25, 0.0])),
            ("normal.Y", bits([-0.5, 0.0])),
            ("normal.Z", bits([0.125, -1.0])),
            ("triangle.id", vec![16_777_217, u32::MAX]),
        ];
        assert!(channels.eq(expected.map(|(name, values)| (name.to_owned(), values))));
    }

    #[test]
    fn pngs_hold_what_fits() {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |name: &str, image: QuantityImage| {
            let file = folder.path().join(name);
            write_quantities(&[(image, file.clone())]).map(|()| image::open(&file).expect("it is read").into_bytes())
        };
        let bytes = |name, image| write(name, image).expect("it is written");
        let normals = image(Quantity::Normal, Floats(vec![0.0, 0.0, 1.0, 0.0, 0.0, 0.0]));
        assert_eq!(bytes("n.png", normals), [128, 128, 255, 0, 0, 0]);
        assert_eq!(
            bytes("a.PNG", image(Quantity::Albedo, Floats(vec![0.5, 0.0, 1.0, 7.0, 0.0, 0.0])))[..3],
            [188, 0, 255]
        );
        assert_eq!(bytes("c.png", image(Quantity::Coverage, Floats(vec![0.25, 1.0]))), [64, 255]);
        for (name, image, expected) in [
            (
                "d.png",
                image(Quantity::Depth, Floats(vec![1.0, 2.0])),
                "a PNG cannot hold a depth exactly; expected .exr",
            ),
            ("i.png", image(Quantity::Id, Numbers(vec![1, 65_536])), "65536"),
            ("i.jpg", image(Quantity::Id, Numbers(vec![1, 2])), ".png or .exr"),
        ] {
            let error = write(name, image).expect_err("it does not fit").to_string();
            assert!(error.contains(expected) && error.contains(name), "{error}");
        }
        let both =
            [Quantity::Id, Quantity::Part].map(|quantity| (image(quantity, Numbers(vec![1, 2])), "x.png".into()));
        let error = write_quantities(&both).expect_err("two in one").to_string();
        assert!(error.contains("x.png: a PNG holds one quantity"), "{error}");
    }
}

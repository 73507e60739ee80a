//! The fuzz targets: each feeds a reader and checks that it does not panic, that any model is valid, and that memory is
//! in proportion to the bytes. One target for each format, and two for parts that a reader of bytes seldom or never
//! reaches.

use halfway_mesh::{Format, LoadError, Model, load, load_bytes};

use crate::common::{Folder, check_model, glb, zip};
use crate::counting::{Counting, most_for};

/// The further memory of a model read from files: the buffers of the two files that are open at once.
const BUFFERS: usize = 1 << 19;

/// Reads the bytes as `target` says: `mtl` is the material library of an OBJ file, `glb_chunks` the JSON of a binary
/// glTF file up to the first zero byte and its buffer after that, so that no length in the file need be guessed,
/// `threemf_model` the model in an archive of 3MF, so that no checksum need be; any other is the extension of a format.
pub(crate) fn feed(target: &str, bytes: &[u8], allocator: &Counting) {
    match target {
        "mtl" => {
            let folder = Folder::new();
            let model = folder.write("model.obj", "mtllib model.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
            folder.write("model.mtl", bytes);
            judge(target, allocator, BUFFERS + most_for(bytes.len()), || load(&model));
        }
        "glb_chunks" => {
            let end = bytes.iter().position(|&byte| byte == 0).unwrap_or(bytes.len());
            let Ok(json) = str::from_utf8(&bytes[..end]) else { return };
            let file = glb(json, bytes.get(end + 1..).unwrap_or_default());
            judge(target, allocator, most_for(file.len()), || load_bytes(Format::Glb, &file));
        }
        "threemf_model" => {
            let file = zip(&[("3D/3dmodel.model", bytes)]);
            judge(target, allocator, most_for(file.len()), || load_bytes(Format::ThreeMf, &file));
        }
        // No name of a target begins with a digit.
        "threemf" => judge(target, allocator, most_for(bytes.len()), || load_bytes(Format::ThreeMf, bytes)),
        _ => {
            let format = Format::ALL.into_iter().find(|format| format.extension() == target);
            let format = format.unwrap_or_else(|| panic!("no target is called {target}"));
            judge(target, allocator, most_for(bytes.len()), || load_bytes(format, bytes));
        }
    }
}

fn judge(target: &str, allocator: &Counting, most: usize, read: impl FnOnce() -> Result<Model, LoadError>) {
    let (read, peak) = allocator.peak_of(read);
    assert!(peak <= most, "{target}: {peak} bytes of memory where {most} are enough");
    match read {
        Ok(model) => check_model(&model),
        Err(error) => assert!(error.to_string().contains("model."), "{error}"),
    }
}

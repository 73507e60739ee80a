//! Displacement by images in scene files.

use std::path::{Path, PathBuf};

use halfway_mesh::Mesh;
use halfway_texture::lookup::in_level;
use halfway_texture::{Channel, Pyramid, TexelFilter, TexelImage, TexelMeaning, TextureError, Wrap};

use crate::keys::{Object, keys};

keys! {
    /// `displacement`: each vertex is moved along its normal by the number that an image has there.
    #[derive(Clone, Debug, PartialEq)]
    pub struct DisplacementEntry {
        [required]
        /// An image file, as a PNG, JPEG, WebP or EXR, relative to the scene file. Required.
        path: PathBuf,
        [optional]
        /// How far a 1 moves a vertex, in lengths of the mesh; any number.
        amount: f32 = 1.0,
        /// Which number of the image is taken.
        channel: Channel = Channel::default(),
        /// The continuation of the image along u.
        wrap_u: Wrap = Wrap::default(),
        /// The continuation of the image along v.
        wrap_v: Wrap = Wrap::default(),
    }
}

impl Object for DisplacementEntry {
    const EXPECTED: &'static str = "an object such as {\"path\": \"image.png\", \"amount\": 0.1}";
}

impl DisplacementEntry {
    /// The image.
    pub(crate) fn load(&self, base_dir: &Path) -> Result<TexelImage, TextureError> {
        halfway_texture::load(&base_dir.join(&self.path), TexelMeaning::Data)
    }

    /// The mesh with its vertices moved; an error is a sentence.
    pub(crate) fn displaced(&self, mesh: &Mesh, image: &Pyramid) -> Result<Mesh, String> {
        let uvs = mesh.uvs().ok_or("has no texture coordinates, and is not displaced")?;
        let height = |vertex: usize| {
            let uv = uvs[vertex].to_array();
            let texel = in_level(image, 0, [self.wrap_u, self.wrap_v], TexelFilter::Bilinear, uv);
            self.amount * texel[self.channel as usize]
        };
        mesh.displaced(height).map(|(mesh, _)| mesh).map_err(|error| error.to_string())
    }
}

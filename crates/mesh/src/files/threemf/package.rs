//! The zip archive of a 3MF file.

use std::io::{self, BufReader, Cursor, Read};

use zip::ZipArchive;

use super::failure::Failure;
use super::xml::Elements;

/// The most bytes of XML that are read: so many times the file's, and so many besides. The XML of models is packed to a
/// tenth or so, and zeros to a thousandth.
const MOST_UNPACKED: u64 = 50;
const UNPACKED_BESIDES: u64 = 1 << 16;

/// The archive, and how many bytes may still be unpacked.
pub(super) struct Package {
    archive: ZipArchive<Cursor<Vec<u8>>>,
    left: u64,
}

impl Package {
    pub(super) fn new(bytes: Vec<u8>) -> Result<Self, Failure> {
        let left = bytes.len() as u64 * MOST_UNPACKED + UNPACKED_BESIDES;
        let archive = ZipArchive::new(Cursor::new(bytes))
            .map_err(|error| Failure::new("archive", error.to_string(), "a zip archive is"))?;
        Ok(Self { archive, left })
    }

    /// The name of the part with the build: that of the relation of its type, else the first that ends in `.model`.
    pub(super) fn root(&mut self) -> Result<String, Failure> {
        const TYPE: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
        const RELATIONS: &str = "_rels/.rels";
        if self.archive.index_for_name(RELATIONS).is_some() {
            let mut relations = self.open(RELATIONS)?;
            while let Some(element) = relations.next()? {
                if element.name == "Relationship" && element.get("Type") == Some(TYPE) {
                    return Ok(element.required("Target")?.trim_start_matches('/').to_owned());
                }
            }
        }
        let mut names = self.archive.file_names().filter_map(Result::ok);
        let name = names.find(|name| name.ends_with(".model")).map(std::borrow::Cow::into_owned);
        name.ok_or_else(|| Failure::new("archive", "no model in it", "a part that ends in `.model` is"))
    }

    /// The elements of a part.
    pub(super) fn open(&mut self, part: &str) -> Result<Elements<'_>, Failure> {
        let Self { archive, left } = self;
        let file = archive.by_name(part);
        let file = file.map_err(|error| Failure::new(part, error.to_string(), "a part of the archive is"))?;
        Ok(Elements::new(part, BufReader::new(Unpacked { file, left })))
    }
}

/// The bytes of a part, as long as there may be more.
struct Unpacked<'a, R> {
    file: R,
    left: &'a mut u64,
}

impl<R: Read> Read for Unpacked<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        *self.left = self.left.checked_sub(count as u64).ok_or_else(|| {
            let message = format!("it unpacks to more than {MOST_UNPACKED} times the bytes of the file");
            io::Error::other(message)
        })?;
        Ok(count)
    }
}

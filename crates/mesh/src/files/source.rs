//! Input of the readers: a file or bytes, the progress of reading, and the folder of the files that a model refers to.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read as _};
use std::ops::ControlFlow;
use std::path::{Component, Path, PathBuf};

use super::{Format, LoadError};

/// The options for loading a model.
///
/// ```
/// use halfway_mesh::{Format, LoadOptions};
///
/// // A model of at most a megabyte, whatever its name ends in.
/// let options = LoadOptions { format: Some(Format::Stl), limit: Some(1 << 20), ..LoadOptions::default() };
/// assert!(!options.outside);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LoadOptions {
    /// Whether files that the model refers to may lie outside its own folder: by an absolute path, by `..`, or behind a
    /// symbolic link. `false` by default.
    pub outside: bool,
    /// The format; `None`, the default, where the extension tells it.
    pub format: Option<Format>,
    /// The most bytes of the model file and of each file that it refers to; `None`, the default, for any number, and
    /// for [`MOST_PIPED`] in a pipe.
    pub limit: Option<u64>,
}

/// The most bytes that are read from a pipe unless [`LoadOptions::limit`] says otherwise: 1 GiB. They are kept in memory
/// while the model is read.
pub const MOST_PIPED: u64 = 1 << 30;

/// The progress of reading a file. Each file that a model refers to counts by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoadProgress {
    /// Bytes read so far.
    pub done: u64,
    /// Bytes in total.
    pub of: u64,
}

/// The progress function, which also decides whether to go on.
pub(super) type OnProgress<'a> = dyn Fn(LoadProgress) -> ControlFlow<()> + 'a;

/// Bytes between two reports of progress.
const REPORT: u64 = 1 << 20;
/// The most bytes asked of the system at once.
const CHUNK: usize = 1 << 18;

/// A model file, opened.
pub(super) struct Source<'a> {
    pub(super) path: &'a Path,
    pub(super) reader: Reader<'a>,
    pub(super) around: ModelFolder<'a>,
}

impl<'a> Source<'a> {
    /// Opens a file that has bytes: a regular one, or a named pipe, which is read to its end.
    pub(super) fn open(
        path: &'a Path,
        options: LoadOptions,
        on_progress: &'a OnProgress<'a>,
    ) -> Result<Self, LoadError> {
        let around = ModelFolder::of_file(path, options, on_progress);
        if fs::metadata(path).is_ok_and(|metadata| is_pipe(&metadata)) {
            let piped = File::open(path).map_err(|source| LoadError::Read { path: path.to_owned(), source })?;
            return Ok(Self { around, ..Self::from_stream(path, piped, options)? });
        }
        Ok(Self { path, reader: around.open(path)?, around })
    }

    /// Reads a stream to its end, and wraps its bytes as the content of a file without a folder.
    pub(super) fn from_stream(path: &'a Path, stream: impl io::Read, options: LoadOptions) -> Result<Self, LoadError> {
        let most = options.limit.unwrap_or(MOST_PIPED);
        let mut bytes = Vec::new();
        let read = stream.take(most.saturating_add(1)).read_to_end(&mut bytes);
        read.map_err(|source| LoadError::Read { path: path.to_owned(), source })?;
        let length = bytes.len() as u64;
        if length > most {
            return Err(LoadError::TooLarge { path: path.to_owned(), most });
        }
        let reader = Reader::new(path, io::Cursor::new(bytes), length, None)?;
        Ok(Self { path, reader, around: ModelFolder::nowhere() })
    }

    /// Wraps bytes in memory as the content of a file.
    pub(super) fn from_bytes(path: &'a Path, bytes: &'a [u8]) -> Result<Self, LoadError> {
        let reader = Reader::new(path, bytes, bytes.len() as u64, None)?;
        Ok(Self { path, reader, around: ModelFolder::nowhere() })
    }
}

/// The bytes of a file, in order.
pub(super) struct Reader<'a> {
    path: &'a Path,
    from: Box<dyn BufRead + 'a>,
    on_progress: Option<&'a OnProgress<'a>>,
    done: u64,
    of: u64,
    reported: u64,
    /// Whether the first line ends in CR alone. Then an LF does not belong to a CR before it: it may be the first byte
    /// after a header.
    cr_alone: Option<bool>,
}

impl<'a> Reader<'a> {
    /// Opens a regular file that has bytes.
    fn open(path: &'a Path, limit: Option<u64>, on_progress: Option<&'a OnProgress<'a>>) -> Result<Self, LoadError> {
        let failed = |source| LoadError::Read { path: path.to_owned(), source };
        // Checked before it is opened: opening a pipe waits for its other end.
        let metadata = fs::metadata(path).map_err(failed)?;
        if !metadata.is_file() {
            return Err(LoadError::NotAFile { path: path.to_owned() });
        }
        if let Some(most) = limit.filter(|most| metadata.len() > *most) {
            return Err(LoadError::TooLarge { path: path.to_owned(), most });
        }
        let file = File::open(path).map_err(failed)?;
        Self::new(path, BufReader::with_capacity(CHUNK, file), metadata.len(), on_progress)
    }

    /// A reader of so many bytes, at least one.
    fn new(
        path: &'a Path,
        from: impl BufRead + 'a,
        of: u64,
        on_progress: Option<&'a OnProgress<'a>>,
    ) -> Result<Self, LoadError> {
        if of == 0 {
            return Err(LoadError::Empty { path: path.to_owned() });
        }
        Ok(Self { path, from: Box::new(from), on_progress, done: 0, of, reported: 0, cr_alone: None })
    }

    /// A reader of bytes that another reader has given.
    pub(super) fn of_chunk(path: &'a Path, bytes: &'a [u8]) -> Self {
        let of = bytes.len() as u64;
        Self { path, from: Box::new(bytes), on_progress: None, done: 0, of, reported: 0, cr_alone: None }
    }

    pub(super) fn path(&self) -> &'a Path {
        self.path
    }

    /// How many bytes the file had when it was opened.
    pub(super) fn length(&self) -> u64 {
        self.of
    }

    /// Appends a line with its end, which is LF, CRLF or CR; returns whether there was one.
    pub(super) fn line(&mut self, buffer: &mut Vec<u8>) -> Result<bool, LoadError> {
        let before = buffer.len();
        loop {
            let path = self.path;
            let failed = |source| LoadError::Read { path: path.to_owned(), source };
            let ahead = self.from.fill_buf().map_err(failed)?;
            let end = memchr::memchr2(b'\n', b'\r', ahead);
            let taken = end.map_or(ahead.len(), |end| end + 1);
            let is_cr = end.is_some_and(|end| ahead[end] == b'\r');
            buffer.extend_from_slice(&ahead[..taken]);
            self.from.consume(taken);
            if is_cr && self.cr_alone != Some(true) && self.from.fill_buf().map_err(failed)?.first() == Some(&b'\n') {
                buffer.push(b'\n');
                self.from.consume(1);
            }
            if end.is_some() || taken == 0 {
                self.cr_alone.get_or_insert(buffer.ends_with(b"\r"));
                break;
            }
        }
        let count = buffer.len() - before;
        self.advance(count)?;
        Ok(count > 0)
    }

    /// Appends so many bytes, or as many as there are, and then the rest of a line that no backslash continues. Returns
    /// whether there were any.
    pub(super) fn lines(&mut self, count: usize, buffer: &mut Vec<u8>) -> Result<bool, LoadError> {
        let taken = self.append(count, buffer)?;
        if taken == count {
            while self.line(buffer)? && continued_at(buffer).is_some() {}
        }
        Ok(taken > 0)
    }

    /// Appends so many bytes, or as many as there are; returns how many.
    pub(super) fn append(&mut self, count: usize, buffer: &mut Vec<u8>) -> Result<usize, LoadError> {
        let mut taken = 0;
        while taken < count {
            let step = ((count - taken) as u64).min(REPORT);
            buffer.reserve(step.min(self.of.saturating_sub(self.done)) as usize);
            match self.from.by_ref().take(step).read_to_end(buffer).map_err(|source| self.failed(source))? {
                0 => break,
                read => {
                    self.advance(read)?;
                    taken += read;
                }
            }
        }
        Ok(taken)
    }

    /// The next bytes, as many as the buffer takes and as there are, without consuming them. At most [`CHUNK`] at once.
    pub(super) fn peek(&mut self, buffer: &mut [u8]) -> Result<usize, LoadError> {
        match self.from.fill_buf() {
            Ok(ahead) => {
                let count = ahead.len().min(buffer.len());
                buffer[..count].copy_from_slice(&ahead[..count]);
                Ok(count)
            }
            Err(source) => Err(self.failed(source)),
        }
    }

    /// Fills the buffer as far as there are bytes; returns how many there were.
    pub(super) fn fill(&mut self, buffer: &mut [u8]) -> Result<usize, LoadError> {
        let mut filled = 0;
        while filled < buffer.len() {
            match self.from.read(&mut buffer[filled..]) {
                Ok(0) => break,
                Ok(count) => {
                    filled += count;
                    self.advance(count)?;
                }
                Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
                Err(source) => return Err(self.failed(source)),
            }
        }
        Ok(filled)
    }

    /// All bytes.
    pub(super) fn whole(mut self) -> Result<Vec<u8>, LoadError> {
        let mut whole = Vec::new();
        // The length is the system's claim, not the file's; it may still be wrong.
        let _ = whole.try_reserve_exact(usize::try_from(self.of).unwrap_or(0));
        self.append(usize::MAX, &mut whole)?;
        Ok(whole)
    }

    fn failed(&self, source: std::io::Error) -> LoadError {
        LoadError::Read { path: self.path.to_owned(), source }
    }

    fn advance(&mut self, bytes: usize) -> Result<(), LoadError> {
        self.done += bytes as u64;
        if self.done - self.reported < REPORT {
            return Ok(());
        }
        self.reported = self.done;
        let progress = LoadProgress { done: self.done, of: self.of.max(self.done) };
        match self.on_progress.map_or(ControlFlow::Continue(()), |on_progress| on_progress(progress)) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(LoadError::Stopped { path: self.path.to_owned() }),
        }
    }
}

/// The position of the backslash that ends a line.
pub(super) fn continued_at(line: &[u8]) -> Option<usize> {
    let line = line.strip_suffix(b"\n").unwrap_or(line);
    let line = line.strip_suffix(b"\r").unwrap_or(line);
    line.strip_suffix(b"\\").map(<[u8]>::len)
}

/// The folder of the files that a model refers to.
#[derive(Clone, Copy)]
pub(super) struct ModelFolder<'a> {
    /// The model's folder; `None` where the model is bytes in memory and has no files around it.
    folder: Option<&'a Path>,
    options: LoadOptions,
    on_progress: Option<&'a OnProgress<'a>>,
}

impl<'a> ModelFolder<'a> {
    fn of_file(path: &'a Path, options: LoadOptions, on_progress: &'a OnProgress<'a>) -> Self {
        Self { folder: Some(path.parent().unwrap_or(Path::new(""))), options, on_progress: Some(on_progress) }
    }

    fn nowhere() -> Self {
        Self { folder: None, options: LoadOptions::default(), on_progress: None }
    }

    /// Opens a file that [`find`](Self::find) has found.
    pub(super) fn open<'b>(&self, path: &'b Path) -> Result<Reader<'b>, LoadError>
    where
        'a: 'b,
    {
        Reader::open(path, self.options.limit, self.on_progress)
    }

    /// The path of a file that the model refers to, whether it exists or not; `None` if it may not be read.
    pub(super) fn find(&self, reference: &str) -> Option<PathBuf> {
        let folder = self.folder?;
        let path = folder.join(reference);
        if self.options.outside {
            return Some(path);
        }
        if !stays_inside(Path::new(reference)) {
            return None;
        }
        // A symbolic link may still lead outside.
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        match (path.canonicalize(), folder.canonicalize()) {
            (Ok(found), Ok(folder)) if !found.starts_with(&folder) => None,
            _ => Some(path),
        }
    }
}

/// Whether it is a named pipe, whose bytes end.
fn is_pipe(metadata: &fs::Metadata) -> bool {
    #[cfg(unix)]
    return std::os::unix::fs::FileTypeExt::is_fifo(&metadata.file_type());
    #[cfg(not(unix))]
    {
        let _ = metadata;
        false
    }
}

/// A file's name without its extension, which names a model that has no name of its own.
pub(super) fn stem(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Whether a path in a file stays in that file's folder: relative, and without `..`.
fn stays_inside(reference: &Path) -> bool {
    let mut names = 0;
    reference.components().all(|component| {
        names += usize::from(matches!(component, Component::Normal(_)));
        matches!(component, Component::Normal(_) | Component::CurDir)
    }) && names > 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines_of(bytes: &[u8]) -> Vec<String> {
        // A buffer of one byte, so that every line end is split.
        let from = BufReader::with_capacity(1, bytes);
        let mut reader = Reader::new(Path::new("text"), from, bytes.len() as u64, None).unwrap();
        let mut line = Vec::new();
        let mut lines = Vec::new();
        while reader.line(&mut line).unwrap() {
            lines.push(String::from_utf8(std::mem::take(&mut line)).unwrap());
        }
        lines
    }

    #[test]
    fn lines_end_in_any_of_three_ways() {
        assert_eq!(lines_of(b"a\nb\n\nc"), ["a\n", "b\n", "\n", "c"]);
        assert_eq!(lines_of(b"a\r\nb\r\n"), ["a\r\n", "b\r\n"]);
        assert_eq!(lines_of(b"a\rb\r\rc"), ["a\r", "b\r", "\r", "c"]);
        assert_eq!(lines_of(b"a\nb\rc\r\n"), ["a\n", "b\r", "c\r\n"]);
        // The body after a header of such lines may begin with the byte of an LF.
        assert_eq!(lines_of(b"ply\rend\r\n"), ["ply\r", "end\r", "\n"]);
    }

    #[test]
    fn chunks_end_with_a_line_that_is_not_continued() {
        let bytes = b"one\ntwo \\\nthree\nfour";
        let chunks = |count| {
            let mut reader = Reader::of_chunk(Path::new("text"), bytes);
            let mut chunk = Vec::new();
            let mut lengths = Vec::new();
            while reader.lines(count, &mut chunk).unwrap() {
                lengths.push(std::mem::take(&mut chunk).len());
            }
            lengths
        };
        assert_eq!(chunks(1), [4, 12, 4]);
        assert_eq!(chunks(5), [16, 4]);
        assert_eq!(chunks(100), [20]);
    }

    #[test]
    fn references_stay_inside() {
        for (reference, inside) in [
            ("a.bin", true),
            ("./a.bin", true),
            ("sub/a.bin", true),
            ("a..b", true),
            ("../a.bin", false),
            ("sub/../../a.bin", false),
            ("sub/../a.bin", false),
            ("/etc/passwd", false),
            ("", false),
            (".", false),
        ] {
            assert_eq!(stays_inside(Path::new(reference)), inside, "{reference:?}");
            let around = ModelFolder::of_file(
                Path::new("model.obj"),
                LoadOptions { outside: true, ..LoadOptions::default() },
                &|_| ControlFlow::Continue(()),
            );
            assert_eq!(around.find(reference), Some(Path::new("").join(reference)));
            assert_eq!(ModelFolder::nowhere().find(reference), None);
        }
    }
}

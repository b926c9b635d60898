//! What the reader of a format implements, gets and gives.

use std::cell::Cell;
use std::fs::{self, File};
use std::io::{self, Cursor, Read};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use encoding_rs_io::DecodeReaderBytesBuilder;

use super::delimited::Delimited;
use super::error::{Fault, unreadable};
use super::npy::Planes;
use super::raw::Interleaved;
use super::sample::SampleCode;
use crate::failure::Failure;

/// Bytes that show UTF-16 without a byte order mark: as many as the shortest recording has, `1,2` and an end of line.
const UNMARKED_BYTES: usize = 8;

/// A stream of bytes to read a recording from.
pub(super) type Stream = Box<dyn Read>;

/// Opens a file or a pipe by its path; a directory is neither.
pub fn open_file(path: &Path) -> Result<File, Failure> {
    let file = path.display().to_string();
    // Opened before anything is asked of it: a pipe of Windows, which has a name, may serve but one opening.
    let opened = File::open(path);
    let is_directory = match &opened {
        Ok(opened) => opened.metadata().is_ok_and(|there| there.is_dir()),
        Err(_) => path.is_dir(),
    };
    if is_directory {
        return Err(unreadable(&file, io::ErrorKind::IsADirectory.into()));
    }
    opened.map_err(|fault| unreadable(&file, fault))
}

/// The one path of a file that may have several; none if there is no such file, and for a device or pipe of Windows, as `open_file` says.
pub fn place(path: &Path) -> Option<PathBuf> {
    let is_device = path.as_os_str().as_encoded_bytes().starts_with(br"\\.\");
    (!is_device).then(|| fs::canonicalize(path).ok()).flatten()
}

/// The ending of a file's name, in lower case; empty if there is none.
pub fn extension(path: &Path) -> String {
    let extension = path.extension().unwrap_or_default();
    extension.to_string_lossy().to_lowercase()
}

/// Decodes text to UTF-8. UTF-16, as Windows and PowerShell's `>` write it, is known by a byte order mark or a zero in every other byte.
pub fn in_utf8(mut text: impl Read) -> io::Result<impl Read> {
    let mut head = Vec::new();
    text.by_ref()
        .take(UNMARKED_BYTES as u64)
        .read_to_end(&mut head)?;
    let mark = unmarked_utf_16(&head).unwrap_or_default();
    let text = Cursor::new(mark).chain(Cursor::new(head)).chain(text);
    Ok(DecodeReaderBytesBuilder::new()
        .utf8_passthru(true)
        .strip_bom(true)
        .build(text))
}

/// The byte order mark that is missing before these first bytes, if they are ASCII in UTF-16.
pub(super) fn unmarked_utf_16(head: &[u8]) -> Option<&'static [u8]> {
    let is_ascii = |byte: u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
    let (units, _) = head.get(..UNMARKED_BYTES)?.as_chunks();
    let all = |is: fn(&[u8; 2]) -> (u8, u8)| {
        let mut units = units.iter().map(is);
        units.all(|(zero, byte)| zero == 0 && is_ascii(byte))
    };
    if all(|&[low, high]| (high, low)) {
        Some(b"\xff\xfe")
    } else {
        all(|&[high, low]| (high, low)).then_some(b"\xfe\xff")
    }
}

/// A stream that counts the bytes read from it.
pub(super) struct Counting {
    pub stream: Stream,
    pub count: Rc<Cell<u64>>,
}

impl Read for Counting {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let read = self.stream.read(bytes)?;
        self.count.set(self.count.get() + read as u64);
        Ok(read)
    }
}

/// A source of pairs: the reader of one format.
pub(super) enum Source {
    Interleaved(Interleaved),
    Planes(Planes),
    // Boxed, as it is far larger than the others.
    Text(Box<Delimited>),
}

impl Source {
    /// Appends pairs until there are `capacity`, fewer from a live stream, none at the end. Good pairs come before an error.
    pub fn fill(&mut self, pairs: &mut Vec<[f32; 2]>, capacity: usize) -> Result<(), Fault> {
        match self {
            Self::Interleaved(samples) => samples.fill(pairs, capacity),
            Self::Planes(samples) => samples.fill(pairs, capacity),
            Self::Text(text) => text.fill(pairs, capacity),
        }
    }

    /// The text, which alone has gaps, lines left out and places of its samples.
    pub fn text(&self) -> Option<&Delimited> {
        match self {
            Self::Text(text) => Some(text),
            Self::Interleaved(_) | Self::Planes(_) => None,
        }
    }
}

/// What is known of a stream beside its bytes.
#[derive(Default)]
pub(super) struct Known {
    /// False for standard input.
    pub is_named: bool,
    /// The extension in lower case; empty if there is none.
    pub extension: String,
    /// The length of a file, bytes; none for a pipe.
    pub length: Option<u64>,
    /// A second handle of a file, to seek in.
    pub again: Option<File>,
    /// The bytes read so far, which a reader that seeks counts itself.
    pub read: Rc<Cell<u64>>,
}

/// A source, and what its header tells.
pub struct Opened {
    pub(super) source: Source,
    /// The format, in words.
    pub format: String,
    /// The sample rate in Hz from a WAV header or a time column.
    pub sample_rate: Option<f64>,
    /// What is wrong with that rate, if it must not be used.
    pub absurd: Option<String>,
    /// The time of the first pair by the recording's own time column or settings, s; 0 if there are none, or only an index.
    pub start: f64,
    /// Warnings about content that can be read but is hardly meant so, or is not read as it is written.
    pub warnings: Vec<String>,
    /// The number of pairs, if the format tells it; those that are there, if the header promises more.
    pub pairs: Option<u64>,
    /// How integers are stored; none for floats and text.
    pub(super) integers: Option<SampleCode>,
}

impl Opened {
    /// A source of binary samples, of `pairs` pairs if known, whose format does not tell their rate.
    pub(super) fn of_samples(
        format: &str,
        code: SampleCode,
        source: Source,
        pairs: Option<u64>,
    ) -> Self {
        Self {
            source,
            format: format!("{format} {}", code.words()),
            sample_rate: None,
            absurd: None,
            start: 0.0,
            warnings: Vec::new(),
            pairs,
            integers: code.integers(),
        }
    }
}

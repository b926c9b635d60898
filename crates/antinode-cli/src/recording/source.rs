//! What a format of recordings implements to be read.

use std::cell::Cell;
use std::fs::{self, File};
use std::io::{self, Cursor, Read};
use std::path::Path;
use std::rc::Rc;

use encoding_rs_io::DecodeReaderBytesBuilder;

use super::error::InputError;
use super::gaps::Gap;
use super::not_finite::Written;
use super::sample::SampleCode;

/// As long as the shortest recording, `1,2` and an end of line in UTF-16.
const UNMARKED_BYTES: usize = 8;

/// Where the bytes come from.
pub(super) type Stream = Box<dyn Read>;

/// Opens a file or a pipe by its path; a directory is neither.
pub fn open_file(path: &Path) -> Result<File, InputError> {
    let file = path.display().to_string();
    match fs::metadata(path) {
        Ok(metadata) if metadata.is_dir() => Err(InputError::Directory { file }),
        found => found
            .and_then(|_| File::open(path))
            .map_err(|fault| InputError::io(&file, fault)),
    }
}

/// Text in UTF-8, whatever its byte order mark, or a zero in every other byte, says it is: Windows writes UTF-16, PowerShell by `>` too.
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

/// The byte order mark that UTF-16 of ASCII lacks, told from its first bytes.
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
pub(super) struct Counted {
    pub stream: Stream,
    pub count: Rc<Cell<u64>>,
}

impl Read for Counted {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let read = self.stream.read(bytes)?;
        self.count.set(self.count.get() + read as u64);
        Ok(read)
    }
}

/// A format's way to deliver pairs.
pub(super) trait Source {
    /// Appends pairs until there are `capacity`; none at the end. Good pairs come before an error.
    fn fill(&mut self, pairs: &mut Vec<[f32; 2]>, capacity: usize) -> Result<(), InputError>;

    /// The bytes read so far, the header included.
    fn bytes_read(&self) -> u64;

    /// Pairs that are read, and not yet delivered.
    fn ahead(&self) -> &[[f32; 2]] {
        &[]
    }

    /// The next gap that [`pass_gap`](Self::pass_gap) has not passed.
    fn next_gap(&self) -> Option<Gap> {
        None
    }

    /// Passes the next gap; it is told at the end, or not.
    fn pass_gap(&mut self, _is_told: bool) {}

    /// The pairs from `start` up to `end` are asked for: what is left out among them is told at the end.
    fn look(&mut self, _start: u64, _end: u64) {}

    /// What to tell, at the end, of samples that are missing and of lines that are left out.
    fn lost(&self) -> Option<InputError> {
        None
    }

    /// A warning about the samples delivered that could not be given before.
    fn late_warning(&self) -> Option<String> {
        None
    }

    /// The first sample that is not a finite number, where there are lines.
    fn not_finite(&self) -> Option<Written> {
        None
    }
}

/// What is known of a stream beside its bytes.
#[derive(Default)]
pub(super) struct Known {
    /// False for standard input.
    pub is_named: bool,
    /// In lower case.
    pub extension: String,
    /// Of a file.
    pub length: Option<u64>,
    /// The file once more, to be sought in.
    pub again: Option<File>,
    /// The bytes read so far of a text that is decoded, which are others than its format counts.
    pub encoded: Rc<Cell<u64>>,
}

/// A source, and what its header tells.
pub(super) struct Opened {
    pub source: Box<dyn Source>,
    /// What it is, in words.
    pub format: String,
    pub sample_rate: Option<f64>,
    /// The time of the first pair, s.
    pub start: f64,
    pub warnings: Vec<String>,
    pub pairs: Option<u64>,
    /// How integers are stored; none for floats and text.
    pub integers: Option<SampleCode>,
}

impl Opened {
    /// Samples of so many pairs, where that is known, whose format does not tell their rate.
    pub fn of_samples(
        format: &str,
        code: SampleCode,
        source: Box<dyn Source>,
        pairs: Option<u64>,
    ) -> Self {
        Self {
            source,
            format: format!("{format} {}", code.words()),
            sample_rate: None,
            start: 0.0,
            warnings: Vec::new(),
            pairs,
            integers: code.integers(),
        }
    }
}

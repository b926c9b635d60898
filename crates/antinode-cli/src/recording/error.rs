//! Errors of recordings, each worded as `FILE: place: what is wrong; remedy`. Commands in them have `FILE` for the file's name.

mod line;

use std::fmt;
use std::io;

use super::foreign::Foreign;
use crate::digits::counted;
pub use line::{LineFault, Place, Role, TimeFault};

/// The name of standard input in messages.
pub const STANDARD_INPUT: &str = "standard input";

/// One of the two pick-off signals of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    /// S_C, the first value of a pair.
    C,
    /// S_D, the second value of a pair.
    D,
}

impl fmt::Display for Channel {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::C => "S_C (left)",
            Self::D => "S_D (right)",
        })
    }
}

/// Why a recording cannot be opened, or cannot be read further.
#[derive(Debug, thiserror::Error)]
pub struct InputError {
    file: String,
    fault: Fault,
}

impl InputError {
    /// The error for this `fault` of `file`.
    pub(super) fn new(file: &str, fault: Fault) -> Self {
        let file = file.to_owned();
        Self { file, fault }
    }

    /// The error for what the system said about `file`.
    pub fn io(file: &str, fault: io::Error) -> Self {
        Self::new(file, fault.into())
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, fault } = self;
        write!(formatter, "{file}:")?;
        if let Some(place) = fault.place() {
            write!(formatter, "{place}:")?;
        }
        write!(formatter, " {}", with_name(fault.to_string(), file))
    }
}

/// A message whose commands name this file, unless it is standard input.
fn with_name(message: String, file: &str) -> String {
    if file == STANDARD_INPUT {
        return message;
    }
    // A shell needs quotes around blanks, and around brackets, as in `a(1).wav`; within quotes a name stands as it is.
    let is_plain = |letter: char| letter.is_alphanumeric() || "._-/\\:".contains(letter);
    let quote = if file.chars().all(is_plain) { "" } else { "\"" };
    message
        .replace("'FILE'", &format!("'{file}'"))
        .replace(" FILE ", &format!(" {quote}{file}{quote} "))
}

/// What is wrong with a recording.
#[derive(Debug, thiserror::Error)]
pub enum Fault {
    /// Nothing is at the path.
    #[error("there is no such file; check the path")]
    NotFound,
    /// A directory is at the path.
    #[error("this is a directory; name the file inside it")]
    Directory,
    /// The file may not be read.
    #[error("no permission to read it; grant read access to the file and its directory")]
    Permission,
    /// The system failed to read.
    #[error("cannot be read: {0}; check the disk, the network share or the pipe")]
    Io(io::Error),
    /// The file or stream has not one byte.
    #[error("there is nothing in it; check that the recording was saved or sent")]
    Empty,
    /// A recording without a single pair of samples.
    #[error("there are no sample pairs in it; check that the recording was saved or sent")]
    NoPairs,
    /// Neither the content nor the extension is known.
    #[error(
        "the format is not known, neither by content nor by extension; give a .wav, .csv, .tsv, .txt, .lvm or .npy file, or for \
         raw samples their format with --raw u8, i8, u16, i16, i24, i32, f32 or f64, or for text the columns with --columns"
    )]
    Unknown,
    /// The content is of a known format that is not read.
    #[error("this is {}, which is not read; {}", .0.kind, .0.remedy)]
    Foreign(&'static Foreign),
    /// The content is not what the extension promises.
    #[error(
        "this is not {kind}, although its extension says so; export it again, correct the extension, or for raw samples give \
         their format with --raw"
    )]
    NotOfKind { kind: &'static str },
    /// Standard input is a terminal, from which no recording comes.
    #[error("this is a terminal; pipe a recording into the command, or name a file")]
    Terminal,
    /// Standard input of no known format, without a sample format.
    #[error(
        "this is neither WAV, NPY nor CSV; for raw samples give their format with --raw u8, i8, u16, i16, i24, i32, f32 or f64 \
         (little-endian, S_C and S_D interleaved), or for text the columns with --columns"
    )]
    RawFormatNeeded,

    /// The WAV header is damaged.
    #[error(
        "WAV header: {fault}; record or export it again as 16, 24 or 32-bit PCM or 32-bit float"
    )]
    WavHeader { fault: String },
    /// The WAV file is compressed or of an unusual width.
    #[error(
        "WAV header: the samples are {encoding}; export them as 16, 24 or 32-bit PCM or 32-bit float"
    )]
    WavEncoding { encoding: String },
    /// A WAV file of other than two channels, of which none are chosen.
    #[error(
        "WAV header: found {}, but two are needed; {}",
        counted(*.found as u64, "channel"),
        if *.found < 2 {
            "put S_C on the left channel and S_D on the right, for example with `sox -M c.wav d.wav both.wav`"
        } else {
            "choose those of S_C and S_D, as in --columns 1,2"
        }
    )]
    Channels { found: usize },
    /// More samples follow than the header promises.
    #[error(
        "the WAV header promises {promised} sample pairs, but more follow, which are not read: the header was never completed, or \
         cannot hold so large a number; correct it, for example with `sox --ignore-length FILE whole.wav`"
    )]
    MoreData { promised: u64 },
    /// Several WAV files joined byte by byte.
    #[error(
        "after {found} sample pairs another WAV file begins, which is not read; WAV files cannot be joined by `cat`, but by \
         `sox part1.wav part2.wav whole.wav`"
    )]
    AnotherWav { found: u64 },
    /// Chosen channels that do not exist, or are not given by number.
    #[error(
        "--columns {chosen}: give the channel numbers of S_C and S_D, two different ones from 1 to {channels}"
    )]
    ChannelChoice { chosen: String, channels: usize },
    /// More raw channels than two, and none chosen.
    #[error(
        "there are {channels} interleaved channels (--channels), but two are needed; choose those of S_C and S_D, as in --columns 1,2"
    )]
    RawChannels { channels: usize },
    /// Chosen raw channels beyond the two that are assumed without `--channels`, or not given by number.
    #[error(
        "--columns {chosen}: raw samples have two channels unless --channels gives another number; choose 1,2 or 2,1, or give \
         --channels too"
    )]
    RawChoice { chosen: String },
    /// Bits below the valid ones are set.
    #[error(
        "sample pair {pair} (from 0), {channel}: bits are set below the {valid} valid ones of a \
         {container}-bit sample, so its scale is unknown; export it as plain {container}-bit PCM"
    )]
    Padding {
        pair: u64,
        channel: Channel,
        valid: u32,
        container: u32,
    },
    /// The header promises more than there is.
    #[error(
        "at its end: the header promises {promised} sample pairs, but there are {found}; copy or \
         record it again, or correct the header"
    )]
    Truncated { promised: u64, found: u64 },
    /// The data end within a pair, or within the channels that were sampled together.
    #[error(
        "sample pair {found} (from 0): the data end in the middle of it; check that they hold {} channels \
         in the stated sample format, and that the recording was not cut off",
        if *.channels == 2 { "both".to_owned() } else { format!("all {channels}") }
    )]
    HalfPair { found: u64, channels: usize },
    /// Samples that are NaN, infinite, beyond single precision, text, or in a broken line; reported once all is read.
    #[error(
        "sample pair {pair} (from 0), {told}{}; \
         rows whose window contains one are flagged or missing, all others are good; check the instrument or program that wrote it",
        if *.count == 1 { String::new() } else { format!(", the first of {count}") }
    )]
    NotFinite {
        place: Option<Place>,
        pair: u64,
        told: String,
        count: u64,
    },

    /// The NPY header is damaged.
    #[error("NPY header: {fault}; save it again with `numpy.save`")]
    NpyHeader { fault: &'static str },
    /// An array of neither shape (N, 2) nor (2, N).
    #[error(
        "NPY header: the shape is {shape}, but (N, 2) is needed; of more channels \
         choose two, as in --columns 2,3 if the first is the time, or save `numpy.stack([c, d], axis=1)`"
    )]
    NpyShape { shape: String },
    /// An array of a number type that is not read.
    #[error(
        "NPY header: the dtype is {dtype}, but u1, i1, u2, i2, i4, f4 or f8 is needed; save \
         `numpy.stack([c, d], axis=1).astype('f4')`"
    )]
    NpyType { dtype: String },
    /// An array that stores one channel after the other, in a pipe.
    #[error(
        "the array holds all of S_C before S_D, which cannot be read from a pipe; name the file instead, or save \
         `numpy.stack([c, d], axis=1)` in C order"
    )]
    NpyPipe,

    /// Lines of text that are left out, as their time is not known. `lost`: the line before which other samples are missing, and how
    /// many. Reported once all is read.
    #[error(
        "{told}: the line is left out{}{}; \
         rows whose window lacks a sample are missing, all others are good; check the instrument or program that wrote it",
        if *.count == 1 { String::new() } else { format!(", the first of {count}") },
        lost.map_or(String::new(), |(line, lost)| {
            let samples = if lost == 1 { "sample is" } else { "samples are" };
            format!(", and before line {line} {lost} {samples} lost")
        })
    )]
    LeftOut {
        place: Option<Place>,
        told: String,
        count: u64,
        lost: Option<(u64, u64)>,
    },
    /// A line of text is wrong.
    #[error("{fault}")]
    Line { place: Place, fault: LineFault },
}

impl Fault {
    /// The fault of a line as a whole.
    pub(super) fn line(line: u64, fault: LineFault) -> Self {
        let place = Place { line, column: None };
        Self::Line { place, fault }
    }

    /// The place in a text.
    fn place(&self) -> Option<Place> {
        match self {
            Self::Line { place, .. } => Some(*place),
            Self::LeftOut { place, .. } | Self::NotFinite { place, .. } => *place,
            _ => None,
        }
    }
}

impl From<io::Error> for Fault {
    fn from(fault: io::Error) -> Self {
        match fault.kind() {
            // Windows calls a name with `*` invalid: no file can have it.
            io::ErrorKind::NotFound | io::ErrorKind::InvalidFilename => Self::NotFound,
            io::ErrorKind::PermissionDenied => Self::Permission,
            io::ErrorKind::IsADirectory => Self::Directory,
            _ => Self::Io(fault),
        }
    }
}

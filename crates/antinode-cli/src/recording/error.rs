//! Errors of recordings, each worded as `FILE: place: what is wrong; remedy`.

mod line;

use std::fmt;
use std::io;

pub use line::{LineFault, Place, Role, TimeFault};

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

/// A file's name as an argument of a command that a message gives: a shell needs quotes around one with blanks.
pub(super) fn argument(name: &str) -> String {
    if name.contains(' ') {
        format!("\"{name}\"")
    } else {
        name.to_owned()
    }
}

/// Why a recording cannot be opened, or cannot be read further.
#[derive(Debug, thiserror::Error)]
pub enum InputError {
    /// Nothing is at the path.
    #[error("{file}: there is no such file; check the path")]
    NotFound { file: String },
    /// A directory is at the path.
    #[error("{file}: this is a directory; name the file inside it")]
    Directory { file: String },
    /// The file may not be read.
    #[error("{file}: no permission to read it; grant read access to the file and its directory")]
    Permission { file: String },
    /// The system failed to read.
    #[error("{file}: cannot be read: {fault}; check the disk, the network share or the pipe")]
    Io { file: String, fault: io::Error },
    /// The file or stream has not one byte.
    #[error("{file}: there is nothing in it; check that the recording was saved or sent")]
    Empty { file: String },
    /// A recording without a single pair of samples.
    #[error("{file}: there are no sample pairs in it; check that the recording was saved or sent")]
    NoPairs { file: String },
    /// Neither the content nor the extension is known.
    #[error(
        "{file}: the format is not known, neither by content nor by extension; give a .wav, .csv, .tsv, .txt, .lvm or .npy file, or for \
         raw samples their format with --raw u8, i8, u16, i16, i24, i32, f32 or f64, or for text the columns with --columns"
    )]
    Unknown { file: String },
    /// The content is of a known format that is not read.
    #[error("{file}: this is {kind}, which is not read; {remedy}")]
    Foreign {
        file: String,
        kind: &'static str,
        remedy: String,
    },
    /// The content is not what the extension promises.
    #[error(
        "{file}: this is not {kind}, although its extension says so; export it again, correct the extension, or for raw samples give \
         their format with --raw"
    )]
    NotOfKind { file: String, kind: &'static str },
    /// Standard input is a terminal, from which no recording comes.
    #[error("{file}: this is a terminal; pipe a recording into the command, or name a file")]
    Terminal { file: String },
    /// Standard input of no known format, without a sample format.
    #[error(
        "{file}: this is neither WAV, NPY nor CSV; for raw samples give their format with --raw u8, i8, u16, i16, i24, i32, f32 or f64 \
         (little-endian, S_C and S_D interleaved)"
    )]
    RawFormatNeeded { file: String },

    /// The WAV header is damaged.
    #[error(
        "{file}: WAV header: {fault}; record or export it again as 16, 24 or 32-bit PCM or 32-bit float"
    )]
    WavHeader { file: String, fault: String },
    /// The WAV file is compressed or of an unusual width.
    #[error(
        "{file}: WAV header: the samples are {encoding}; export them as 16, 24 or 32-bit PCM or 32-bit float"
    )]
    WavEncoding { file: String, encoding: String },
    /// A WAV file of other than two channels, of which none are chosen.
    #[error(
        "{file}: WAV header: found {found} {}, but two are needed; {}",
        if *.found == 1 { "channel" } else { "channels" },
        if *.found < 2 {
            "put S_C on the left channel and S_D on the right, for example with `sox -M c.wav d.wav both.wav`"
        } else {
            "choose those of S_C and S_D, as in --columns 1,2"
        }
    )]
    Channels { file: String, found: usize },
    /// More samples follow than the header promises.
    #[error(
        "{file}: the WAV header promises {promised} sample pairs, but more follow, which are not read: the header was never completed, or \
         cannot hold so large a number; correct it, for example with `sox --ignore-length {} whole.wav`",
        argument(file)
    )]
    MoreData { file: String, promised: u64 },
    /// Several WAV files joined byte by byte.
    #[error(
        "{file}: after {found} sample pairs another WAV file begins, which is not read; WAV files cannot be joined by `cat`, but by \
         `sox part1.wav part2.wav whole.wav`"
    )]
    AnotherWav { file: String, found: u64 },
    /// Chosen channels that do not exist, or are not given by number.
    #[error(
        "{file}: --columns {chosen}: give the channel numbers of S_C and S_D, two different ones from 1 to {channels}"
    )]
    ChannelChoice {
        file: String,
        chosen: String,
        channels: usize,
    },
    /// More raw channels than two, and none chosen.
    #[error(
        "{file}: there are {channels} interleaved channels (--channels), but two are needed; choose those of S_C and S_D, as in --columns 1,2"
    )]
    RawChannels { file: String, channels: usize },
    /// Chosen raw channels beyond the two that are assumed without `--channels`, or not given by number.
    #[error(
        "{file}: --columns {chosen}: raw samples have two channels unless --channels gives another number; choose 1,2 or 2,1, or give \
         --channels too"
    )]
    RawChoice { file: String, chosen: String },
    /// Bits below the valid ones are set.
    #[error(
        "{file}: sample pair {pair} (from 0), {channel}: bits are set below the {valid} valid ones of a \
         {container}-bit sample, so its scale is unknown; export it as plain {container}-bit PCM"
    )]
    Padding {
        file: String,
        pair: u64,
        channel: Channel,
        valid: u32,
        container: u32,
    },
    /// The header promises more than there is.
    #[error(
        "{file}: at its end: the header promises {promised} sample pairs, but there are {found}; copy or \
         record it again, or correct the header"
    )]
    Truncated {
        file: String,
        promised: u64,
        found: u64,
    },
    /// The data end within a pair, or within the channels that were sampled together.
    #[error(
        "{file}: sample pair {found} (from 0): the data end in the middle of it; check that they hold {} channels \
         in the stated sample format, and that the recording was not cut off",
        if *.channels == 2 { "both".to_owned() } else { format!("all {channels}") }
    )]
    HalfPair {
        file: String,
        found: u64,
        channels: usize,
    },
    /// Samples that are NaN, infinite, beyond single precision, text, or in a broken line; reported once all is read.
    #[error(
        "{file}{}: sample pair {pair} (from 0), {told}{}; \
         rows whose window contains one are flagged or missing, all others are good; check the instrument or program that wrote it",
        place.map_or(String::new(), |place| format!(":{place}")),
        if *.count == 1 { String::new() } else { format!(", the first of {count}") }
    )]
    NotFinite {
        file: String,
        place: Option<Place>,
        pair: u64,
        told: String,
        count: u64,
    },

    /// The NPY header is damaged.
    #[error("{file}: NPY header: {fault}; save it again with `numpy.save`")]
    NpyHeader { file: String, fault: &'static str },
    /// An array of neither shape (N, 2) nor (2, N).
    #[error(
        "{file}: NPY header: the shape is {shape}, but (N, 2) is needed; of more channels \
         choose two, as in --columns 2,3 if the first is the time, or save `numpy.stack([c, d], axis=1)`"
    )]
    NpyShape { file: String, shape: String },
    /// An array of a number type that is not read.
    #[error(
        "{file}: NPY header: the dtype is {dtype}, but u1, i1, u2, i2, i4, f4 or f8 is needed; save \
         `numpy.stack([c, d], axis=1).astype('f4')`"
    )]
    NpyType { file: String, dtype: String },
    /// An array that stores one channel after the other, in a pipe.
    #[error(
        "{file}: the array holds all of S_C before S_D, which cannot be read from a pipe; name the file instead, or save \
         `numpy.stack([c, d], axis=1)` in C order"
    )]
    NpyPipe { file: String },

    /// Lines of text that are left out, as their time is not known. `lost`: the line before which other samples are missing, and how
    /// many. Reported once all is read.
    #[error(
        "{file}:{place}: {told}: the line is left out{}{}; \
         rows whose window lacks a sample are missing, all others are good; check the instrument or program that wrote it",
        if *.count == 1 { String::new() } else { format!(", the first of {count}") },
        lost.map_or(String::new(), |(line, lost)| {
            let samples = if lost == 1 { "sample is" } else { "samples are" };
            format!(", and before line {line} {lost} {samples} lost")
        })
    )]
    LeftOut {
        file: String,
        place: Place,
        told: String,
        count: u64,
        lost: Option<(u64, u64)>,
    },
    /// A line of text is wrong.
    #[error("{file}:{place}: {fault}")]
    Line {
        file: String,
        place: Place,
        fault: LineFault,
    },
}

impl InputError {
    /// The error for a line as a whole.
    pub(super) fn line(file: &str, line: u64, fault: LineFault) -> Self {
        let place = Place { line, column: None };
        Self::Line {
            file: file.to_owned(),
            place,
            fault,
        }
    }

    /// The error for what the system said about `file`.
    pub fn io(file: &str, fault: io::Error) -> Self {
        let file = file.to_owned();
        match fault.kind() {
            // Windows calls a name with `*` invalid: no file can have it.
            io::ErrorKind::NotFound | io::ErrorKind::InvalidFilename => Self::NotFound { file },
            io::ErrorKind::PermissionDenied => Self::Permission { file },
            io::ErrorKind::IsADirectory => Self::Directory { file },
            _ => Self::Io { file, fault },
        }
    }
}

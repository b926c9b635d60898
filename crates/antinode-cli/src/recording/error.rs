//! What can be wrong with a recording, told as `FILE: place: what is wrong; remedy`.

use std::fmt;
use std::io;

/// The command-line option that names a [`RawFormat`](super::RawFormat), as the remedies spell it.
pub const RAW_OPTION: &str = "--raw";

/// The command-line option that names the [`Columns`](super::Columns), as the remedies spell it.
pub const COLUMNS_OPTION: &str = "--columns";

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
#[expect(missing_docs, reason = "the message above each variant says what its fields are")]
pub enum InputError {
    /// The path leads nowhere.
    #[error("{file}: there is no such file; check the path")]
    NotFound { file: String },
    /// The path leads to a directory.
    #[error("{file}: this is a directory; name the recording inside it")]
    Directory { file: String },
    /// The file may not be read.
    #[error("{file}: no permission to read it; grant read access to the file and its directory")]
    Permission { file: String },
    /// The system failed to read.
    #[error("{file}: cannot be read: {source}; check the disk, the network share or the pipe")]
    Io { file: String, source: io::Error },
    /// Not one byte.
    #[error("{file}: there is nothing in it; check that the recording was saved or sent")]
    Empty { file: String },
    /// A sound file without a single pair of samples.
    #[error("{file}: there is not one sample pair in it; check that the recording was saved or sent")]
    NoPairs { file: String },
    /// Neither the content nor the extension is known.
    #[error(
        "{file}: neither its content nor its extension is known; give a .wav, .csv, .tsv, .txt or \
         .npy file, or the sample format of a raw one with {RAW_OPTION} i16, i32 or f32"
    )]
    Unknown { file: String },
    /// The content is not what the extension promises.
    #[error("{file}: this is not {kind}, whatever its extension says; export it again, or rename it to what it is")]
    NotOfKind { file: String, kind: &'static str },
    /// Standard input without a sample format.
    #[error(
        "{file}: raw samples do not tell their format; give it with {RAW_OPTION} i16, i32 or f32 \
         (little-endian, S_C and S_D in turn)"
    )]
    RawFormatNeeded { file: String },

    /// The WAV header is damaged.
    #[error("{file}: WAV header: {fault}; record or export it again as 16, 24 or 32-bit PCM or 32-bit float")]
    WavHeader { file: String, fault: String },
    /// The WAV file is compressed or of an unusual width.
    #[error("{file}: WAV header: the samples are {encoding}; export them as 16, 24 or 32-bit PCM or 32-bit float")]
    WavEncoding { file: String, encoding: String },
    /// Not two channels.
    #[error(
        "{file}: WAV header: found {found} {}, but two are needed; put S_C on the left channel and \
         S_D on the right, for example with `sox -M c.wav d.wav both.wav`",
        if *.found == 1 { "channel" } else { "channels" }
    )]
    Channels { file: String, found: u16 },
    /// Bits below the valid ones are set.
    #[error(
        "{file}: sample pair {pair} (from 0), {channel}: bits are set below the {valid} valid ones of a \
         {container}-bit sample, so its scale is unknown; export it as plain {container}-bit PCM"
    )]
    Padding { file: String, pair: u64, channel: Channel, valid: u32, container: u32 },
    /// The header promises more than there is.
    #[error(
        "{file}: after {found} sample pairs: the header promises {promised} pairs, but the data end \
         here; copy or record it again, or cut the header down to what there is"
    )]
    Truncated { file: String, promised: u64, found: u64 },
    /// An S_C without its S_D.
    #[error(
        "{file}: after {found} sample pairs: the data end in the middle of a pair; check that both \
         channels are there in the format named, and that the recording was not cut off"
    )]
    HalfPair { file: String, found: u64 },
    /// NaN, an infinity, or a number beyond single precision.
    #[error(
        "{file}: sample pair {pair} (from 0), {channel}: the value is {value}, not a finite number; \
         cut the recording there, or mend what wrote it"
    )]
    NotFinite { file: String, pair: u64, channel: Channel, value: f32 },

    /// The NPY header is damaged.
    #[error("{file}: NPY header: {fault}; save it again with `numpy.save`")]
    NpyHeader { file: String, fault: &'static str },
    /// Neither (N, 2) nor (2, N).
    #[error(
        "{file}: NPY header: the shape is {shape}, but (N, 2) is needed; save \
         `numpy.stack([c, d], axis=1)`"
    )]
    NpyShape { file: String, shape: String },
    /// A type of number that has no scale here.
    #[error(
        "{file}: NPY header: the dtype is {dtype}, but i2, i4, f4 or f8 is needed; save \
         `numpy.stack([c, d], axis=1).astype('f4')`"
    )]
    NpyType { file: String, dtype: String },
    /// One channel after the other, in a pipe.
    #[error(
        "{file}: S_D follows after all of S_C, which a pipe cannot go back for; give a file, or save \
         `numpy.stack([c, d], axis=1)` in C order"
    )]
    NpyPipe { file: String },

    /// Text of two bytes a character.
    #[error("{file}: this is UTF-16 text; save it as UTF-8")]
    Utf16 { file: String },
    /// Not lines of text.
    #[error("{file}:{line}: more than {limit} bytes without an end of line; give text with one sample pair a line")]
    LineTooLong { file: String, line: u64, limit: usize },
    /// More or fewer columns than can be understood.
    #[error(
        "{file}:{line}: found {found} {}, but two (S_C, S_D) or three (time in s, S_C, S_D) are needed; \
         drop the others, or name the right ones with {COLUMNS_OPTION}",
        if *.found == 1 { "column" } else { "columns" }
    )]
    ColumnCount { file: String, line: u64, found: usize },
    /// A column asked for that is not there.
    #[error("{file}:{line}: there is no column `{wanted}`; choose among {known} with {COLUMNS_OPTION}")]
    ColumnUnknown { file: String, line: u64, wanted: String, known: String },
    /// Time in something other than seconds.
    #[error("{file}:{line}: the time column `{name}` is not in seconds; convert it to seconds, or leave it out")]
    TimeUnit { file: String, line: u64, name: String },
    /// A field too few.
    #[error("{file}:{line}:{column}: {role} is missing here; complete or delete the line")]
    FieldMissing { file: String, line: u64, column: usize, role: Role },
    /// A field too many.
    #[error(
        "{file}:{line}: found {found} fields where the first line has {expected}; use another separator \
         than the decimal mark, and the same one in every line"
    )]
    FieldCount { file: String, line: u64, found: usize, expected: usize },
    /// A field that is no finite number.
    #[error(
        "{file}:{line}:{column}: {role} is `{text}`, not a finite number; correct or delete the line, or \
         begin it with # if it is a comment"
    )]
    Number { file: String, line: u64, column: usize, role: Role, text: String },
    /// Time stands still or runs backwards.
    #[error(
        "{file}:{line}: time goes from {from} s to {to} s, but must go up; sort the lines, cut the \
         recording here, or print the time with more digits"
    )]
    TimeBackwards { file: String, line: u64, from: f64, to: f64 },
    /// A gap of whole samples.
    #[error(
        "{file}:{line}: {lost} {} lost before this line (time goes from {from} s to {to} s); \
         cut the recording here, or record it again without loss",
        if *.lost == 1 { "sample is" } else { "samples are" }
    )]
    TimeGap { file: String, line: u64, lost: u64, from: f64, to: f64 },
    /// A step that is no whole number of samples.
    #[error(
        "{file}:{line}: time steps by {step:.4e} s here, but by {usual:.4e} s elsewhere; sample at a constant \
         rate, or resample it to one"
    )]
    TimeUneven { file: String, line: u64, step: f64, usual: f64 },
    /// The rate creeps away.
    #[error(
        "{file}:{line}: the sample rate has gone from {from:.3} Hz to {to:.3} Hz; sample at a constant rate, or \
         resample it to one"
    )]
    TimeDrift { file: String, line: u64, from: f64, to: f64 },
    /// Time with too few digits.
    #[error(
        "{file}:{line}: time is printed to {printed:.0e} s only, too coarse for samples {usual:.4e} s apart; print \
         it with more digits, or leave the column out"
    )]
    TimeCoarse { file: String, line: u64, printed: f64, usual: f64 },
}

impl InputError {
    /// What the system said about `file`, in the words of this tool.
    pub(super) fn io(file: &str, source: io::Error) -> Self {
        let file = file.to_owned();
        match source.kind() {
            io::ErrorKind::NotFound => Self::NotFound { file },
            io::ErrorKind::PermissionDenied => Self::Permission { file },
            io::ErrorKind::IsADirectory => Self::Directory { file },
            _ => Self::Io { file, source },
        }
    }
}

/// What a column of a text recording holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The time in seconds.
    Time,
    /// One of the signals.
    Signal(Channel),
}

impl Role {
    /// In the order the columns are kept: time, S_C, S_D.
    pub(super) const ALL: [Self; 3] = [Self::Time, Self::Signal(Channel::C), Self::Signal(Channel::D)];
}

impl fmt::Display for Role {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Time => "the time",
            Self::Signal(Channel::C) => "S_C",
            Self::Signal(Channel::D) => "S_D",
        })
    }
}

/// Why a recording cannot be written.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the message above each variant says what its fields are")]
pub enum OutputError {
    /// The extension names no format that is written.
    #[error("{file}: the extension names no format; end the name in .wav, .csv or .npy")]
    Unknown { file: String },
    /// A device, a pipe or a directory.
    #[error("{file}: this exists and is not a file; give the path of a file")]
    NotAFile { file: String },
    /// The system failed to write.
    #[error("{file}: cannot be written: {source}; check that its directory exists, may be written and has room")]
    Io { file: String, source: io::Error },
    /// No rate, or one the format cannot hold.
    #[error("{file}: {format} cannot hold a sample rate of {rate} Hz; {remedy}")]
    Rate { file: String, format: &'static str, rate: f64, remedy: &'static str },
    /// A sample format the container cannot hold.
    #[error("{file}: a WAV file of 64-bit floats is not written; choose 32-bit floats, or a .npy or .csv file")]
    Wav64 { file: String },
    /// WAV files end at 4 GiB.
    #[error("{file}: after {pairs} sample pairs: a WAV file holds no more than 4 GiB; write a .npy file, or fewer pairs")]
    Full { file: String, pairs: u64 },
    /// A sample that is no number.
    #[error("{file}: sample pair {pair} (from 0), {channel}: {value} is not a finite number; mend what makes it")]
    NotFinite { file: String, pair: u64, channel: Channel, value: f64 },
}

//! Recordings of the two pick-off signals: read from WAV, text, NPY and raw samples, and written.

mod by_content;
mod codes;
mod columns;
mod content;
mod delimited;
mod error;
mod foreign;
mod forms;
mod frame;
mod gaps;
mod header;
mod heading;
mod left_out;
mod lines;
mod no_number;
mod not_finite;
mod npy;
mod number;
mod preamble;
mod printed;
mod quoted;
mod raw;
mod resolution;
mod sample;
mod sequence;
mod signal_units;
mod source;
mod text;
mod time;
mod units;
mod wav;
mod write;

use std::cell::Cell;
use std::io::{self, IsTerminal};
use std::path::Path;
use std::rc::Rc;

pub use by_content::OpenOptions;
use codes::Lowest;
pub use columns::Columns;
pub use error::{Channel, InputError};
pub use gaps::Gap;
use not_finite::NotFinite;
pub use sample::Kind;
use source::{Known, Opened, Source, Stream};
pub use source::{in_utf8, open_file};
pub use write::{OutputError, RecordingWriter, SampleFormat, WholeFile};

/// The capacity given to a buffer that has none: small enough to stay in the cache.
pub const BLOCK_PAIRS: usize = 1 << 14;

/// What is between two integers of 32 bits.
const LEAST_UNIT: f32 = 1.0 / 2_147_483_648.0;

/// A recording of S_C and S_D, read once from its beginning to its end in constant memory.
pub struct Recording {
    name: String,
    bytes_total: Option<u64>,
    /// The bytes read of a text that is decoded.
    encoded: Rc<Cell<u64>>,
    opened: Opened,
    /// Pairs read to tell the resolution, and not yet delivered.
    head: std::vec::IntoIter<[f32; 2]>,
    /// The step that the first samples tell.
    step: Option<f32>,
    /// Of integers.
    lowest: Option<Lowest>,
    not_finite: NotFinite,
    /// Met while there were still good pairs to deliver.
    fault: Option<InputError>,
    ended: bool,
}

impl Recording {
    /// Opens a file or pipe by its content or else its extension, or standard input if `path` is `-`.
    pub fn open(path: &Path, options: &OpenOptions) -> Result<Self, InputError> {
        if path == Path::new("-") {
            return Self::standard_input(options);
        }
        let name = path.display().to_string();
        let io = |fault| InputError::io(&name, fault);
        let file = open_file(path)?;
        let metadata = file.metadata().map_err(io)?;
        let length = metadata.is_file().then_some(metadata.len());
        let again = if length.is_some() {
            Some(file.try_clone().map_err(io)?)
        } else {
            None
        };
        let extension = path
            .extension()
            .map(|text| text.to_string_lossy().to_lowercase());
        let encoded = Rc::default();
        let known = Known {
            encoded: Rc::clone(&encoded),
            is_named: true,
            extension: extension.unwrap_or_default(),
            length,
            again,
        };
        let opened = by_content::open(&name, Box::new(file), known, options)?;
        Ok(Self {
            encoded,
            ..Self::new(name, opened, length)
        })
    }

    fn standard_input(options: &OpenOptions) -> Result<Self, InputError> {
        let name = "standard input".to_owned();
        let stdin = io::stdin();
        let is_told = options.raw.is_some() || options.columns.is_some();
        if !is_told && stdin.is_terminal() {
            return Err(InputError::RawFormatNeeded { file: name });
        }
        let opened = by_content::open(&name, Box::new(stdin), Known::default(), options)?;
        Ok(Self::new(name, opened, None))
    }

    fn new(name: String, mut opened: Opened, bytes_total: Option<u64>) -> Self {
        let unit = opened.integers.map(|code| unit(code.full_scale()));
        let (head, step, fault) = if bytes_total.is_some() {
            // By the first samples that do not stand still: integers too may have come from a converter of fewer bits.
            let (head, step, fault) = resolution::of_head(opened.source.as_mut());
            let step = step.or_else(|| codes::of_integers(&head, unit?));
            (head, step, fault)
        } else {
            // A pipe must not wait, and what has come by now is chance, but for what its source needs.
            let step = resolution::resolution(opened.source.ahead());
            (Vec::new(), step, None)
        };
        Self {
            name,
            bytes_total,
            encoded: Rc::default(),
            opened,
            head: head.into_iter(),
            step,
            lowest: unit.map(Lowest::new),
            not_finite: NotFinite::default(),
            fault,
            ended: false,
        }
    }

    /// The path, or "standard input".
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What the recording is, in words.
    pub fn format(&self) -> &str {
        &self.opened.format
    }

    /// The sample rate in Hz from a WAV header or a time column.
    pub fn sample_rate(&self) -> Option<f64> {
        self.opened.sample_rate
    }

    /// The time of the first pair in the recording's own time column, s; 0 where there is none, or an index.
    pub fn start(&self) -> f64 {
        self.opened.start
    }

    /// Warnings: what can be read, but is hardly meant, or is not read as it is written.
    pub fn warnings(&self) -> &[String] {
        &self.opened.warnings
    }

    /// A warning that can be given only once all is read.
    pub fn late_warning(&self) -> Option<String> {
        self.opened.source.late_warning()
    }

    /// The number of pairs, where the format tells it: those that are there, if the header promises more.
    pub fn pairs(&self) -> Option<u64> {
        self.opened.pairs
    }

    /// The size of a file.
    pub fn bytes_total(&self) -> Option<u64> {
        self.bytes_total
    }

    /// The bytes read so far.
    pub fn bytes_read(&self) -> u64 {
        // A text file without a last end of line is read as if it had one.
        let most = self.bytes_total.unwrap_or(u64::MAX);
        let read = self.opened.source.bytes_read();
        read.max(self.encoded.get()).min(most)
    }

    /// The magnitude from which an integer sample is at its rail, 32767/32768 for 16 bits, 2047/2048 where only the upper 12 are in use;
    /// none for floats.
    pub fn full_scale(&self) -> Option<f32> {
        let largest = self.opened.integers?.full_scale();
        // Full scale reads as 1: the largest code is a step below it.
        Some(self.step.map_or(largest, |step| largest.min(1.0 - step)))
    }

    /// What is wrong with rails that are given, where the samples are integers.
    pub fn rails_warning(&self, rails: [f32; 2]) -> Option<String> {
        self.opened.integers?.rails_warning(rails)
    }

    /// The step between two codes of the converter: of integers, and of text and floats that lie on one.
    ///
    /// A pipe tells it only where it is text with a time, of which many lines are read ahead, and else that of its integers' bits.
    pub fn resolution(&self) -> Option<f32> {
        let of_integers = self.full_scale().map(|largest| 1.0 - largest);
        of_integers.filter(|&step| step > 0.0).or(self.step)
    }

    /// The step of all integers looked at so far, a power of two: one coarser than [`resolution`](Self::resolution) shows too late, as that
    /// of a wave that repeats its first few codes, or of a pipe.
    pub fn resolution_so_far(&self) -> Option<f32> {
        self.lowest.as_ref()?.step()
    }

    /// What is wrong with the samples looked at so far that are not finite numbers, if there are any.
    pub fn not_finite(&self) -> Option<InputError> {
        let first = self.not_finite.first?;
        // Another one may have been first where not all are looked at.
        let written = self.opened.source.not_finite();
        let written = written.filter(|written| written.pair == first.pair);
        Some(InputError::NotFinite {
            file: self.name.clone(),
            place: written.as_ref().map(|written| written.place),
            pair: first.pair,
            told: written.map_or_else(|| first.told(), |written| written.told),
            count: self.not_finite.count,
        })
    }

    /// The next gap that the samples' own time shows; those among pairs that were delivered are to be passed in turn.
    pub fn next_gap(&self) -> Option<Gap> {
        self.opened.source.next_gap()
    }

    /// Passes the next gap; it `is_told` at the end, or was not asked for.
    pub fn pass_gap(&mut self, is_told: bool) {
        self.opened.source.pass_gap(is_told);
    }

    /// What is wrong with the gaps passed so far that are to be told and with lines left out, if there are any.
    pub fn lost(&self) -> Option<InputError> {
        self.opened.source.lost()
    }

    /// Clears `buffer` and fills it to its capacity with the next pairs [S_C, S_D]; `Ok(0)` at the end.
    ///
    /// A pipe gives what is there instead of waiting for more. All good pairs before a
    /// fault are delivered first; the next call gives the error, and those after it `Ok(0)`. Samples that are
    /// not finite numbers are delivered as they are: [`look`](Self::look) finds them.
    pub fn read(&mut self, buffer: &mut Vec<[f32; 2]>) -> Result<usize, InputError> {
        buffer.clear();
        if buffer.capacity() == 0 {
            buffer.reserve_exact(BLOCK_PAIRS);
        }
        let capacity = buffer.capacity();
        buffer.extend(self.head.by_ref().take(capacity));
        if self.fault.is_none() && !self.ended {
            self.fault = self.opened.source.fill(buffer, capacity).err();
        }
        if buffer.is_empty() {
            self.ended = true;
            return self.fault.take().map_or(Ok(0), Err);
        }
        Ok(buffer.len())
    }

    /// Looks for what is no finite number or left out in `pairs`, before which the recording had so many: only these are told.
    pub fn look(&mut self, before: u64, pairs: &[[f32; 2]]) {
        self.opened.source.look(before, before + pairs.len() as u64);
        match &mut self.lowest {
            // Integers are all finite.
            Some(lowest) => lowest.look(pairs),
            None => self.not_finite.look(before, pairs),
        }
    }
}

/// What is between two integers of which this is the largest as it is decoded, which single precision does not tell from 1 of many bits.
fn unit(largest: f32) -> f32 {
    (1.0 - largest).max(LEAST_UNIT)
}

#[cfg(test)]
mod tests;

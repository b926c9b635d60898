//! Writing of recordings as WAV, text and NPY files, which appear under their name only once they are complete.

mod encode;

use std::path::Path;

use super::error::CHANNELS;
use super::extension;
use crate::failure::{Failure, unknown_extension, unwritable};
use crate::whole_file::WholeFile;
pub use encode::SampleFormat;
use encode::{Format, Output};

/// Writes pairs of samples to a file, which takes its name only in [`finish`](Self::finish).
pub struct RecordingWriter {
    whole: WholeFile,
    sample: SampleFormat,
    rate: f64,
    /// Time of the first pair, s.
    start: f64,
    output: Output,
    pairs: u64,
}

impl RecordingWriter {
    /// Begins a `.wav`, `.csv` or `.npy` file; whatever is at `path` stays there until it is finished.
    pub fn create(path: &Path, rate: f64, sample: SampleFormat) -> Result<Self, Failure> {
        let file = path.display().to_string();
        let Some(format) = Format::of(&extension(path)) else {
            return Err(unknown_extension(&file, ".wav, .csv or .npy"));
        };
        format
            .check(rate, sample)
            .map_err(|told| Failure::Usage(format!("{file}: {told}")))?;
        let (whole, output) = WholeFile::create(path)?;
        let output = Output::begin(format, output, rate, sample)
            .map_err(|fault| unwritable(&file, &fault))?;
        Ok(Self {
            whole,
            sample,
            rate,
            start: 0.0,
            output,
            pairs: 0,
        })
    }

    /// The path, as it was given.
    pub fn name(&self) -> &str {
        self.whole.name()
    }

    /// Sets the time of the first pair, s, which text states.
    pub fn count_time_from(&mut self, start: f64) {
        self.start = start;
    }

    /// Fails if the format has no room for this many pairs.
    pub fn check_room(&self, pairs: u64) -> Result<(), Failure> {
        if self.output.holds(self.sample, pairs) {
            return Ok(());
        }
        Err(Failure::Usage(format!(
            "{}: {pairs} sample pairs: a WAV file holds no more than 4 GiB; write a .npy file, or fewer pairs",
            self.name()
        )))
    }

    /// Writes S_C and S_D: integers rounded to the nearest code and held at the rails, floats as they are.
    pub fn write(&mut self, pair: [f64; 2]) -> Result<(), Failure> {
        let stored = pair.map(|value| self.sample.store(value));
        let [Some(c), Some(d)] = stored else {
            let channel = usize::from(stored[0].is_some());
            return Err(Failure::Fault(format!(
                "{}: sample pair {} (from 0), {}: {} is not a finite number; correct the values that it is computed from",
                self.name(),
                self.pairs,
                CHANNELS[channel],
                pair[channel]
            )));
        };
        self.check_room(self.pairs + 1)?;
        let seconds = self.start + self.pairs as f64 / self.rate;
        let written = self.output.write(self.sample, seconds, [c, d]);
        written.map_err(|fault| unwritable(self.whole.name(), &fault))?;
        self.pairs += 1;
        Ok(())
    }

    /// Completes the file and gives it its name; dropped without this, it leaves nothing behind.
    pub fn finish(self) -> Result<(), Failure> {
        self.output
            .finish(self.sample, self.pairs)
            .map_err(|fault| unwritable(self.whole.name(), &fault))?;
        self.whole.finish()
    }
}

#[cfg(test)]
mod tests;

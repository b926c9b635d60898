//! Writing of recordings as WAV, text and NPY files, which appear under their name only once they are complete.

mod encode;
mod error;
mod whole;

use std::path::Path;

use super::{Channel, extension};
pub use encode::SampleFormat;
use encode::{Format, Output};
pub use error::{OutputError, OutputFault};
pub use whole::WholeFile;

/// Writes pairs of samples to a file, which takes its name only in [`finish`](Self::finish).
pub struct RecordingWriter {
    whole: WholeFile,
    sample: SampleFormat,
    rate: f64,
    output: Output,
    pairs: u64,
}

impl RecordingWriter {
    /// Begins a `.wav`, `.csv` or `.npy` file; whatever is at `path` stays there until it is finished.
    pub fn create(path: &Path, rate: f64, sample: SampleFormat) -> Result<Self, OutputError> {
        let file = path.display().to_string();
        let error = |fault| OutputError::new(&file, fault);
        let Some(format) = Format::of(&extension(path)) else {
            let endings = ".wav, .csv or .npy";
            return Err(error(OutputFault::Unknown { endings }));
        };
        if let Err(remedy) = format.check_rate(rate, sample) {
            return Err(error(OutputFault::Rate { rate, remedy }));
        }
        if format == Format::Wav && sample == SampleFormat::F64 {
            return Err(error(OutputFault::Wav64));
        }
        let (whole, output) = WholeFile::create(path)?;
        let output = Output::begin(format, output, rate, sample)
            .map_err(|fault| error(OutputFault::Io(fault)))?;
        Ok(Self {
            whole,
            sample,
            rate,
            output,
            pairs: 0,
        })
    }

    /// Writes S_C and S_D: integers rounded to the nearest code and held at the rails, floats as they are.
    pub fn write(&mut self, pair: [f64; 2]) -> Result<(), OutputError> {
        let [Some(c), Some(d)] = pair.map(|value| self.sample.store(value)) else {
            return Err(self.error(self.not_finite(pair)));
        };
        if self.output.is_full(self.sample, self.pairs) {
            return Err(self.error(OutputFault::Full { pairs: self.pairs }));
        }
        let seconds = self.pairs as f64 / self.rate;
        let written = self.output.write(self.sample, seconds, [c, d]);
        written.map_err(|fault| self.error(OutputFault::Io(fault)))?;
        self.pairs += 1;
        Ok(())
    }

    /// Completes the file and gives it its name; dropped without this, it leaves nothing behind.
    pub fn finish(self) -> Result<(), OutputError> {
        self.output
            .finish(self.sample, self.pairs)
            .map_err(|fault| OutputError::io(self.whole.name(), fault))?;
        self.whole.finish()
    }

    fn error(&self, fault: OutputFault) -> OutputError {
        OutputError::new(self.whole.name(), fault)
    }

    fn not_finite(&self, [c, d]: [f64; 2]) -> OutputFault {
        let (channel, value) = match self.sample.store(c) {
            None => (Channel::C, c),
            Some(_) => (Channel::D, d),
        };
        OutputFault::NotFinite {
            pair: self.pairs,
            channel,
            value,
        }
    }
}

#[cfg(test)]
mod tests;

//! Writing of recordings as WAV, text and NPY files, which appear under their name only once they are complete.

mod encode;
mod error;
mod whole;

use std::path::Path;

use super::Channel;
pub use encode::SampleFormat;
use encode::{Format, Output};
pub use error::OutputError;
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
        let extension = path
            .extension()
            .map(|text| text.to_string_lossy().to_lowercase());
        let Some(format) = Format::of(&extension.unwrap_or_default()) else {
            return Err(OutputError::Unknown {
                file,
                endings: ".wav, .csv or .npy",
            });
        };
        if let Err(remedy) = format.check_rate(rate, sample) {
            return Err(OutputError::Rate { file, rate, remedy });
        }
        if format == Format::Wav && sample == SampleFormat::F64 {
            return Err(OutputError::Wav64 { file });
        }
        let (whole, output) = WholeFile::create(path)?;
        let output = Output::begin(format, output, rate, sample)
            .map_err(|fault| OutputError::io(&file, fault))?;
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
            return Err(self.not_finite(pair));
        };
        if self.output.is_full(self.sample, self.pairs) {
            return Err(OutputError::Full {
                file: self.whole.name().to_owned(),
                pairs: self.pairs,
            });
        }
        let seconds = self.pairs as f64 / self.rate;
        let written = self.output.write(self.sample, seconds, [c, d]);
        written.map_err(|fault| OutputError::io(self.whole.name(), fault))?;
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

    fn not_finite(&self, [c, d]: [f64; 2]) -> OutputError {
        let (channel, value) = match self.sample.store(c) {
            None => (Channel::C, c),
            Some(_) => (Channel::D, d),
        };
        OutputError::NotFinite {
            file: self.whole.name().to_owned(),
            pair: self.pairs,
            channel,
            value,
        }
    }
}

#[cfg(test)]
mod tests;

//! Writing recordings: WAV, text and NPY, which appear under their name only once they are whole.

mod encode;
mod error;

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use tempfile::TempPath;

use super::Channel;
pub use encode::WavSample;
use encode::{Encoder, Format};
pub use error::OutputError;

/// Writes pairs of samples to a file, which takes its name only in [`finish`](Self::finish).
pub struct RecordingWriter {
    file: String,
    target: PathBuf,
    /// Deleted unless it is given its name.
    temporary: TempPath,
    sample: WavSample,
    encoder: Encoder,
    pairs: u64,
}

impl RecordingWriter {
    /// Begins a `.wav`, `.csv` or `.npy` file; whatever is at `path` stays there until it is finished.
    pub fn create(path: &Path, sample_rate: f64, sample: WavSample) -> Result<Self, OutputError> {
        let file = path.display().to_string();
        let extension = path
            .extension()
            .map(|text| text.to_string_lossy().to_lowercase());
        let Some(format) = Format::of(&extension.unwrap_or_default()) else {
            return Err(OutputError::Unknown { file });
        };
        if let Err(remedy) = format.check_rate(sample_rate, sample) {
            return Err(OutputError::Rate {
                file,
                rate: sample_rate,
                remedy,
            });
        }
        if format == Format::Wav && sample == WavSample::F64 {
            return Err(OutputError::Wav64 { file });
        }
        let io = |fault| OutputError::Io {
            file: file.clone(),
            fault,
        };
        let target = match fs::metadata(path) {
            Ok(metadata) if !metadata.is_file() => return Err(OutputError::NotAFile { file }),
            // A link keeps leading to the file it leads to.
            Ok(_) => fs::canonicalize(path).map_err(io)?,
            Err(_) => path.to_owned(),
        };
        let (output, temporary) = temporary(&target).map_err(io)?.into_parts();
        let encoder = Encoder::begin(format, output, sample_rate, sample).map_err(io)?;
        Ok(Self {
            file,
            target,
            temporary,
            sample,
            encoder,
            pairs: 0,
        })
    }

    /// Writes S_C and S_D: integers rounded to the nearest code and held at the rails, floats as they are.
    pub fn write(&mut self, pair: [f64; 2]) -> Result<(), OutputError> {
        let [Some(c), Some(d)] = pair.map(|value| self.sample.store(value)) else {
            return Err(self.not_finite(pair));
        };
        if self.encoder.is_full(self.pairs) {
            return Err(OutputError::Full {
                file: self.file.clone(),
                pairs: self.pairs,
            });
        }
        let written = self.encoder.write(self.pairs, [c, d]);
        written.map_err(|fault| OutputError::Io {
            file: self.file.clone(),
            fault,
        })?;
        self.pairs += 1;
        Ok(())
    }

    /// Completes the file and gives it its name; dropped without this, it leaves nothing behind.
    pub fn finish(self) -> Result<(), OutputError> {
        let Self {
            file,
            target,
            temporary,
            encoder,
            pairs,
            ..
        } = self;
        encoder
            .finish(pairs)
            // On the disk before it replaces what may be a good recording.
            .and_then(|()| File::options().write(true).open(&temporary)?.sync_all())
            .and_then(|()| temporary.persist(target).map_err(|fault| fault.error))
            .map_err(|fault| OutputError::Io { file, fault })
    }

    fn not_finite(&self, [c, d]: [f64; 2]) -> OutputError {
        let (channel, value) = match self.sample.store(c) {
            None => (Channel::C, c),
            Some(_) => (Channel::D, d),
        };
        OutputError::NotFinite {
            file: self.file.clone(),
            pair: self.pairs,
            channel,
            value,
        }
    }
}

/// An empty file beside `target`, with the permissions of any new file.
fn temporary(target: &Path) -> io::Result<tempfile::NamedTempFile> {
    let directory = target
        .parent()
        .filter(|directory| !directory.as_os_str().is_empty());
    let mut builder = tempfile::Builder::new();
    builder.prefix(".antinode-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(directory.unwrap_or(Path::new(".")))
}

#[cfg(test)]
mod tests;

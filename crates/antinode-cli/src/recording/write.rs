//! Writing recordings: WAV, text and NPY, which appear under their name only once they are whole.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use hound::{SampleFormat, WavSpec, WavWriter};
use tempfile::TempPath;

use super::Channel;
use encode::Stored;
pub use error::OutputError;

/// A WAV file's sizes are 32-bit numbers, which count the longest header too.
const MAX_WAV_DATA: u64 = u32::MAX as u64 - 60;

/// As long as the header of any (N, 2) array, so that N can be put in at the end.
const NPY_HEADER: usize = 128;

/// Enough that a system call is made for thousands of pairs.
const BUFFER_BYTES: usize = 1 << 18;

/// How samples are stored: in a WAV file as they are, in others as numbers of this resolution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WavSample {
    /// 16-bit integers, full scale 1.0.
    I16,
    /// 24-bit integers, full scale 1.0.
    I24,
    /// 32-bit integers, full scale 1.0.
    I32,
    /// 32-bit floats.
    F32,
    /// 64-bit floats; not in WAV files.
    F64,
}

impl WavSample {
    fn bits(self) -> u16 {
        match self {
            Self::I16 => 16,
            Self::I24 => 24,
            Self::I32 | Self::F32 => 32,
            Self::F64 => 64,
        }
    }

    /// `value` in this format; none if it is not finite there.
    fn store(self, value: f64) -> Option<Stored> {
        match self {
            Self::F32 => Some(Stored::F32(value as f32)).filter(|_| (value as f32).is_finite()),
            _ if !value.is_finite() => None,
            Self::F64 => Some(Stored::F64(value)),
            _ => {
                let scale = f64::from(1u32 << (self.bits() - 1));
                let code = (value * scale).round_ties_even().clamp(-scale, scale - 1.0);
                Some(Stored::Code(code as i32))
            }
        }
    }
}

/// A sample as it is stored.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Stored {
    Code(i32),
    F32(f32),
    F64(f64),
}

/// Writes pairs of samples to a file, which takes its name only in [`finish`](Self::finish).
pub struct RecordingWriter {
    file: String,
    target: PathBuf,
    /// Deleted unless it is given its name.
    temporary: TempPath,
    sample: WavSample,
    sample_rate: f64,
    encoder: Encoder,
    pairs: u64,
}

enum Encoder {
    Wav(WavWriter<BufWriter<File>>),
    Csv(BufWriter<File>),
    Npy(BufWriter<File>),
}

impl RecordingWriter {
    /// Begins a `.wav`, `.csv` or `.npy` file; whatever is at `path` stays there until it is finished.
    pub fn create(path: &Path, sample_rate: f64, sample: WavSample) -> Result<Self, OutputError> {
        let file = path.display().to_string();
        let extension = path
            .extension()
            .map(|text| text.to_string_lossy().to_lowercase());
        let format = match extension.as_deref() {
            Some("wav") => "a WAV file",
            Some("csv") => "a text file",
            Some("npy") => "an NPY file",
            _ => return Err(OutputError::Unknown { file }),
        };
        let is_wav = extension.as_deref() == Some("wav");
        let rate = |remedy| OutputError::Rate {
            file: file.clone(),
            format,
            rate: sample_rate,
            remedy,
        };
        if !(sample_rate.is_finite() && sample_rate > 0.0) {
            return Err(rate("give a positive one"));
        }
        let frame = f64::from(sample.bits() / 4);
        if is_wav && (sample_rate.fract() != 0.0 || sample_rate * frame > f64::from(u32::MAX)) {
            return Err(rate("give a whole number of Hz, or write a .csv file"));
        }
        if is_wav && sample == WavSample::F64 {
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
        let mut output = BufWriter::with_capacity(BUFFER_BYTES, output);
        let encoder = match extension.as_deref() {
            Some("wav") => {
                let wav = WavWriter::new(output, spec(sample_rate, sample));
                Encoder::Wav(wav.map_err(|fault| io(wav_fault(fault)))?)
            }
            Some("csv") => {
                output.write_all(b"time,c,d\n").map_err(io)?;
                Encoder::Csv(output)
            }
            _ => {
                output.write_all(&npy_header(sample, 0)).map_err(io)?;
                Encoder::Npy(output)
            }
        };
        Ok(Self {
            file,
            target,
            temporary,
            sample,
            sample_rate,
            encoder,
            pairs: 0,
        })
    }

    /// Writes S_C and S_D: integers rounded to the nearest code and held at the rails, floats as they are.
    pub fn write(&mut self, pair: [f64; 2]) -> Result<(), OutputError> {
        let [c, d] = pair.map(|value| self.sample.store(value));
        let (Some(c), Some(d)) = (c, d) else {
            return Err(self.not_finite(pair));
        };
        let written = match &mut self.encoder {
            Encoder::Wav(wav) => {
                if (self.pairs + 1) * u64::from(self.sample.bits() / 4) > MAX_WAV_DATA {
                    return Err(OutputError::Full {
                        file: self.file.clone(),
                        pairs: self.pairs,
                    });
                }
                write_wav(wav, c)
                    .and_then(|()| write_wav(wav, d))
                    .map_err(wav_fault)
            }
            Encoder::Csv(output) => {
                let time = self.pairs as f64 / self.sample_rate;
                let sample = self.sample;
                write!(output, "{time:?}")
                    .and_then(|()| write_text(output, sample, c))
                    .and_then(|()| write_text(output, sample, d))
                    .and_then(|()| output.write_all(b"\n"))
            }
            Encoder::Npy(output) => {
                let sample = self.sample;
                write_npy(output, sample, c).and_then(|()| write_npy(output, sample, d))
            }
        };
        written.map_err(|source| OutputError::Io {
            file: self.file.clone(),
            source,
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
            sample,
            encoder,
            pairs,
            ..
        } = self;
        let finished = match encoder {
            Encoder::Wav(wav) => wav.finalize().map_err(wav_fault),
            Encoder::Csv(mut output) => output.flush(),
            Encoder::Npy(mut output) => {
                let header = npy_header(sample, pairs);
                output
                    .seek(SeekFrom::Start(0))
                    .and_then(|_| output.write_all(&header))
                    .and_then(|()| output.flush())
            }
        };
        finished
            // On the disk before it replaces what may be a good recording.
            .and_then(|()| File::open(&temporary)?.sync_all())
            .and_then(|()| temporary.persist(target).map_err(|fault| fault.error))
            .map_err(|source| OutputError::Io { file, source })
    }

    fn not_finite(&self, [c, d]: [f64; 2]) -> OutputError {
        let (channel, value) = if self.sample.store(c).is_none() {
            (Channel::C, c)
        } else {
            (Channel::D, d)
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

fn spec(sample_rate: f64, sample: WavSample) -> WavSpec {
    let float = sample == WavSample::F32;
    WavSpec {
        channels: 2,
        sample_rate: sample_rate as u32,
        bits_per_sample: sample.bits(),
        sample_format: if float {
            SampleFormat::Float
        } else {
            SampleFormat::Int
        },
    }
}

fn wav_fault(fault: hound::Error) -> io::Error {
    match fault {
        hound::Error::IoError(fault) => fault,
        other => io::Error::other(other),
    }
}

fn write_wav(wav: &mut WavWriter<BufWriter<File>>, value: Stored) -> hound::Result<()> {
    match value {
        Stored::Code(code) => wav.write_sample(code),
        Stored::F32(value) => wav.write_sample(value),
        Stored::F64(_) => Err(hound::Error::Unsupported),
    }
}

/// The fewest digits that read back as the same number.
fn write_text(output: &mut impl Write, sample: WavSample, value: Stored) -> io::Result<()> {
    match value {
        Stored::Code(code) => write!(
            output,
            ",{:?}",
            f64::from(code) / f64::from(1u32 << (sample.bits() - 1))
        ),
        Stored::F32(value) => write!(output, ",{value:?}"),
        Stored::F64(value) => write!(output, ",{value:?}"),
    }
}

fn write_npy(output: &mut impl Write, sample: WavSample, value: Stored) -> io::Result<()> {
    match value {
        Stored::Code(code) if sample == WavSample::I16 => {
            output.write_all(&(code as i16).to_le_bytes())
        }
        // There are no 24-bit numbers: they take the upper bits of 32.
        Stored::Code(code) => output.write_all(&(code << (32 - sample.bits())).to_le_bytes()),
        Stored::F32(value) => output.write_all(&value.to_le_bytes()),
        Stored::F64(value) => output.write_all(&value.to_le_bytes()),
    }
}

fn npy_header(sample: WavSample, pairs: u64) -> Vec<u8> {
    let kind = match sample {
        WavSample::I16 => "i2",
        WavSample::I24 | WavSample::I32 => "i4",
        WavSample::F32 => "f4",
        WavSample::F64 => "f8",
    };
    let mut header = b"\x93NUMPY\x01\x00".to_vec();
    header.extend_from_slice(&(NPY_HEADER as u16 - 10).to_le_bytes());
    header.extend_from_slice(
        format!("{{'descr': '<{kind}', 'fortran_order': False, 'shape': ({pairs}, 2), }}")
            .as_bytes(),
    );
    header.resize(NPY_HEADER - 1, b' ');
    header.push(b'\n');
    header
}

#[cfg(test)]
mod tests;

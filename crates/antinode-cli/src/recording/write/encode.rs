//! Encoding of pairs of numbers in each format.

use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};

use clap::ValueEnum;
use hound::{WavSpec, WavWriter};

/// Most bytes of samples in a WAV file: its sizes are 32-bit numbers, which count the header of up to 60 bytes too.
pub(super) const MAX_WAV_DATA: u64 = u32::MAX as u64 - 60;

/// Bytes of the NPY header: enough for any (N, 2) array, so that N can be filled in at the end.
const NPY_HEADER: usize = 128;

/// Bytes buffered: enough for thousands of pairs in each system call.
const BUFFER_BYTES: usize = 1 << 18;

/// How samples are stored: in a WAV file as they are, in others as numbers of this resolution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SampleFormat {
    /// 16-bit integers, full scale 1; CSV holds their values.
    I16,
    /// 24-bit integers, full scale 1; NPY holds them in 32 bits, CSV their values.
    I24,
    /// 32-bit integers, full scale 1; CSV holds their values.
    I32,
    /// 32-bit floating point.
    F32,
    /// 64-bit floating point; not in WAV.
    F64,
}

impl SampleFormat {
    fn bits(self) -> u16 {
        match self {
            Self::I16 => 16,
            Self::I24 => 24,
            Self::I32 | Self::F32 => 32,
            Self::F64 => 64,
        }
    }

    /// True for integers, whose range ends at full scale.
    pub fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    fn pair_bytes(self) -> u64 {
        u64::from(self.bits() / 4)
    }

    /// What 1.0 is stored as: for integers the code above the largest.
    fn scale(self) -> f64 {
        match self {
            Self::F32 | Self::F64 => 1.0,
            Self::I16 | Self::I24 | Self::I32 => f64::from(self.bits() - 1).exp2(),
        }
    }

    /// `value` as it is stored, an integer as its code; none if it is not finite there.
    pub(super) fn store(self, value: f64) -> Option<f64> {
        let scale = self.scale();
        let stored = match self {
            Self::F32 => f64::from(value as f32),
            Self::F64 => value,
            Self::I16 | Self::I24 | Self::I32 => {
                let code = (value * scale).round_ties_even();
                // A code of 0 has no sign.
                code.clamp(-scale, scale - 1.0) + 0.0
            }
        };
        (value.is_finite() && stored.is_finite()).then_some(stored)
    }
}

/// The format of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Wav,
    Csv,
    Npy,
}

impl Format {
    /// The format an extension names.
    pub fn of(extension: &str) -> Option<Self> {
        match extension {
            "wav" => Some(Self::Wav),
            "csv" => Some(Self::Csv),
            "npy" => Some(Self::Npy),
            _ => None,
        }
    }

    /// Whether the format can hold samples of this kind at this rate, or what is wrong and what to do instead.
    pub fn check(self, rate: f64, sample: SampleFormat) -> Result<(), String> {
        let per_second = rate * sample.pair_bytes() as f64;
        let remedy = if !rate.is_finite() || rate <= 0.0 {
            "give a positive number of Hz"
        } else if self == Self::Wav && (rate.fract() != 0.0 || per_second > f64::from(u32::MAX)) {
            "give a whole number of Hz below 2^32 bytes/s, or write a .csv file"
        } else if self == Self::Wav && sample == SampleFormat::F64 {
            return Err("WAV files of 64-bit floats are not written; choose --sample f32, or a .npy or .csv file".to_owned());
        } else {
            return Ok(());
        };
        Err(format!(
            "this format cannot hold a sample rate of {rate} Hz; {remedy}"
        ))
    }
}

/// A file that is being written.
pub(super) enum Output {
    // Boxed, as it is far larger than the others.
    Wav(Box<WavWriter<BufWriter<File>>>),
    Csv(BufWriter<File>),
    Npy(BufWriter<File>),
}

impl Output {
    pub fn begin(format: Format, file: File, rate: f64, sample: SampleFormat) -> io::Result<Self> {
        let mut output = BufWriter::with_capacity(BUFFER_BYTES, file);
        Ok(match format {
            Format::Wav => {
                let wav = WavWriter::new(output, spec(rate, sample)).map_err(wav_fault)?;
                Self::Wav(Box::new(wav))
            }
            Format::Csv => {
                output.write_all(b"time,c,d\n")?;
                Self::Csv(output)
            }
            Format::Npy => {
                output.write_all(&npy_header(sample, 0))?;
                Self::Npy(output)
            }
        })
    }

    /// Whether the format has room for this many pairs.
    pub fn holds(&self, sample: SampleFormat, pairs: u64) -> bool {
        let is_limited = matches!(self, Self::Wav(_));
        !is_limited || pairs.saturating_mul(sample.pair_bytes()) <= MAX_WAV_DATA
    }

    /// Writes a pair, as it is stored, and in text its time.
    pub fn write(&mut self, sample: SampleFormat, seconds: f64, pair: [f64; 2]) -> io::Result<()> {
        match self {
            Self::Wav(wav) => pair.into_iter().try_for_each(|value| {
                let written = if sample.is_integer() {
                    wav.write_sample(value as i32)
                } else {
                    wav.write_sample(value as f32)
                };
                written.map_err(wav_fault)
            }),
            // The fewest digits that read back as the same numbers.
            Self::Csv(output) if sample == SampleFormat::F32 => {
                let [c, d] = pair.map(|value| value as f32);
                writeln!(output, "{seconds:?},{c:?},{d:?}")
            }
            Self::Csv(output) => {
                let [c, d] = pair.map(|value| value / sample.scale());
                writeln!(output, "{seconds:?},{c:?},{d:?}")
            }
            Self::Npy(output) => pair.into_iter().try_for_each(|value| match sample {
                SampleFormat::I16 => output.write_all(&(value as i16).to_le_bytes()),
                // NPY has no 24-bit numbers: they take the upper bits of 32.
                SampleFormat::I24 => output.write_all(&((value as i32) << 8).to_le_bytes()),
                SampleFormat::I32 => output.write_all(&(value as i32).to_le_bytes()),
                SampleFormat::F32 => output.write_all(&(value as f32).to_le_bytes()),
                SampleFormat::F64 => output.write_all(&value.to_le_bytes()),
            }),
        }
    }

    /// Completes the file by what is known only once all `pairs` are written.
    pub fn finish(self, sample: SampleFormat, pairs: u64) -> io::Result<()> {
        match self {
            Self::Wav(wav) => wav.finalize().map_err(wav_fault),
            Self::Csv(mut output) => output.flush(),
            Self::Npy(mut output) => {
                output.seek(SeekFrom::Start(0))?;
                output.write_all(&npy_header(sample, pairs))?;
                output.flush()
            }
        }
    }
}

fn spec(rate: f64, sample: SampleFormat) -> WavSpec {
    let float = sample == SampleFormat::F32;
    WavSpec {
        channels: 2,
        sample_rate: rate as u32,
        bits_per_sample: sample.bits(),
        sample_format: if float {
            hound::SampleFormat::Float
        } else {
            hound::SampleFormat::Int
        },
    }
}

fn wav_fault(fault: hound::Error) -> io::Error {
    match fault {
        hound::Error::IoError(fault) => fault,
        other => io::Error::other(other),
    }
}

fn npy_header(sample: SampleFormat, pairs: u64) -> Vec<u8> {
    let kind = match sample {
        SampleFormat::I16 => "i2",
        SampleFormat::I24 | SampleFormat::I32 => "i4",
        SampleFormat::F32 => "f4",
        SampleFormat::F64 => "f8",
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

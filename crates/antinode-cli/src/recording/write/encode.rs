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

/// A sample as it is stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Stored {
    Code(i32),
    F32(f32),
    F64(f64),
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

    /// The code of 1.0, one more than the largest.
    fn scale(self) -> f64 {
        f64::from(self.bits() - 1).exp2()
    }

    /// `value` in this format; none if it is not finite there.
    pub(super) fn store(self, value: f64) -> Option<Stored> {
        match self {
            Self::F32 => Some(value as f32)
                .filter(|value| value.is_finite())
                .map(Stored::F32),
            Self::F64 => Some(value)
                .filter(|value| value.is_finite())
                .map(Stored::F64),
            Self::I16 | Self::I24 | Self::I32 => {
                let code = (value * self.scale()).round_ties_even();
                let code = code.clamp(-self.scale(), self.scale() - 1.0);
                value.is_finite().then_some(Stored::Code(code as i32))
            }
        }
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

    /// Whether the format can hold a sample rate, or what to do instead.
    pub fn check_rate(self, rate: f64, sample: SampleFormat) -> Result<(), &'static str> {
        let per_second = rate * sample.pair_bytes() as f64;
        if !rate.is_finite() || rate <= 0.0 {
            Err("give a positive number of Hz")
        } else if self == Self::Wav && (rate.fract() != 0.0 || per_second > f64::from(u32::MAX)) {
            Err("give a whole number of Hz below 2^32 bytes/s, or write a .csv file")
        } else {
            Ok(())
        }
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

    /// Whether the format has no room for one more pair.
    pub fn is_full(&self, sample: SampleFormat, pairs: u64) -> bool {
        let limited = matches!(self, Self::Wav(_));
        limited && (pairs + 1).saturating_mul(sample.pair_bytes()) > MAX_WAV_DATA
    }

    /// Writes a pair, and in text its time.
    pub fn write(
        &mut self,
        sample: SampleFormat,
        seconds: f64,
        [c, d]: [Stored; 2],
    ) -> io::Result<()> {
        match self {
            Self::Wav(wav) => {
                write_wav(wav, c)?;
                write_wav(wav, d)
            }
            Self::Csv(output) => {
                write!(output, "{seconds:?},")?;
                write_text(output, sample, c)?;
                output.write_all(b",")?;
                write_text(output, sample, d)?;
                output.write_all(b"\n")
            }
            Self::Npy(output) => {
                write_npy(output, sample, c)?;
                write_npy(output, sample, d)
            }
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

fn write_wav(wav: &mut WavWriter<BufWriter<File>>, value: Stored) -> io::Result<()> {
    let written = match value {
        Stored::Code(code) => wav.write_sample(code),
        Stored::F32(value) => wav.write_sample(value),
        Stored::F64(_) => Err(hound::Error::Unsupported),
    };
    written.map_err(wav_fault)
}

/// Writes the fewest digits that read back as the same number.
fn write_text(output: &mut impl Write, sample: SampleFormat, value: Stored) -> io::Result<()> {
    match value {
        Stored::Code(code) => write!(output, "{:?}", f64::from(code) / sample.scale()),
        Stored::F32(value) => write!(output, "{value:?}"),
        Stored::F64(value) => write!(output, "{value:?}"),
    }
}

fn write_npy(output: &mut impl Write, sample: SampleFormat, value: Stored) -> io::Result<()> {
    match value {
        Stored::Code(code) if sample == SampleFormat::I16 => {
            output.write_all(&(code as i16).to_le_bytes())
        }
        // NPY has no 24-bit numbers: they take the upper bits of 32.
        Stored::Code(code) => output.write_all(&(code << (32 - sample.bits())).to_le_bytes()),
        Stored::F32(value) => output.write_all(&value.to_le_bytes()),
        Stored::F64(value) => output.write_all(&value.to_le_bytes()),
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

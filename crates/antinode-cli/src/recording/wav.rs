//! WAV files: RIFF and RF64, plain and extensible, finished or written into a pipe.

use std::io::{self, Read};

use super::error::Fault;
use super::frame::Frame;
use super::raw::{Followed, Interleaved};
use super::sample::{Kind, SampleCode};
use super::time::Meaning;
use super::{OpenOptions, Opened, Source, Stream};

/// The last bytes of every `KSDATAFORMAT_SUBTYPE`, of which the first two are a format tag.
const SUBTYPE_TAIL: [u8; 14] = *b"\x00\x00\x00\x00\x10\x00\x80\x00\x00\xaa\x00\x38\x9b\x71";

/// The length of data, bytes, that SoX writes when it cannot go back to write the true one; it is rounded down to whole pairs.
const SOX_UNKNOWN: u64 = 0x7fff_f000;

/// The length of data, bytes, that arecord writes when it cannot go back.
const ARECORD_UNKNOWN: u64 = 0x8000_0000;

/// The length written for a chunk whose length stands in the `ds64` chunk or is unknown.
const UNKNOWN: u64 = 0xffff_ffff;

/// Opens a WAV file; `length` is that of the file, if it has one.
pub(super) fn open(
    stream: Stream,
    length: Option<u64>,
    options: &OpenOptions,
) -> Result<Opened, Fault> {
    let mut header = Reader {
        stream,
        position: 0,
    };
    let (format, sizes) = header.read()?;
    let start = header.position;
    // Of a single channel no choice could be right.
    let columns = options.columns.as_ref().filter(|_| format.channels > 1);
    let frame = Frame::choose(format.channels, columns)?;
    let pair_bytes = (frame.channels * format.code.sample_bytes()) as u64;
    let available = length.map(|length| length.saturating_sub(start));
    let promised = promised(sizes, pair_bytes, length);
    let bytes = match (promised, available) {
        (Some(promised), Some(available)) => Some(promised.min(available)),
        (promised, available) => promised.or(available),
    };
    let source = Interleaved::new(header.stream, format.code, frame, length.is_none());
    let source = match promised {
        Some(promised) => source.promise(promised, Followed::ByChunks),
        None => source,
    };
    let sample_rate = (format.rate > 0).then_some(f64::from(format.rate));
    let warning = sample_rate.and_then(|own| rate_warning(own, options.rate));
    let pairs = bytes.map(|bytes| bytes / pair_bytes);
    Ok(Opened {
        sample_rate,
        warnings: warning.into_iter().collect(),
        ..Opened::of_samples("WAV of", format.code, Source::Interleaved(source), pairs)
    })
}

/// The warning about a rate asked for that is not the header's own.
fn rate_warning(own: f64, asked: Option<f64>) -> Option<String> {
    match Meaning::of_rate(own, asked) {
        Meaning::OtherRate { own, asked } => Some(format!(
            "the sample rate is {own} Hz by its header and {asked} Hz by --rate, which takes precedence; \
             omit --rate if the header is right"
        )),
        _ => None,
    }
}

/// The content of the `fmt ` chunk.
struct Format {
    code: SampleCode,
    channels: usize,
    rate: u32,
}

/// The sizes of the file and of its data by the header, bytes.
type Sizes = [u64; 2];

/// The bytes of data there should be; none if they go on to the end of the file.
fn promised([of_riff, of_data]: Sizes, pair_bytes: u64, length: Option<u64>) -> Option<u64> {
    let sox = SOX_UNKNOWN - pair_bytes + 1..=SOX_UNKNOWN;
    let unknown = match of_data {
        // A finished file without samples states its own size correctly; an unfinished one does not.
        0 => length.is_none_or(|length| of_riff.saturating_add(8) != length),
        ARECORD_UNKNOWN | u64::MAX => true,
        bytes => sox.contains(&bytes) || (UNKNOWN - pair_bytes..=UNKNOWN).contains(&bytes),
    };
    (!unknown).then_some(of_data)
}

/// Reads a header and counts its bytes.
struct Reader {
    stream: Stream,
    position: u64,
}

impl Reader {
    fn read(&mut self) -> Result<(Format, Sizes), Fault> {
        let [riff, size, wave] = self.words()?;
        if wave != *b"WAVE" || riff == *b"RIFX" {
            return Err(damaged("it is big-endian (RIFX)"));
        }
        let mut riff_bytes = u64::from(u32::from_le_bytes(size));
        let mut long_data = None;
        let mut format = None;
        loop {
            let [name, size] = self.words()?;
            let size = u64::from(u32::from_le_bytes(size));
            match &name {
                b"fmt " => format = Some(self.format(size)?),
                b"ds64" => {
                    let chunk = self.chunk(size, 16)?;
                    let (sizes, _) = chunk.as_chunks::<8>();
                    riff_bytes = u64::from_le_bytes(sizes[0]);
                    // 0 in a file that was never finished, as is the size of the data chunk itself.
                    long_data = Some(u64::from_le_bytes(sizes[1]));
                }
                b"data" => {
                    let Some(format) = format else {
                        return Err(damaged("the data come before their format"));
                    };
                    let data_bytes = if size == UNKNOWN {
                        long_data.unwrap_or(size)
                    } else {
                        size
                    };
                    return Ok((format, [riff_bytes, data_bytes]));
                }
                _ => {
                    self.chunk(size, 0)?;
                }
            }
        }
    }

    fn bytes(&mut self, bytes: &mut [u8]) -> Result<(), Fault> {
        self.position += bytes.len() as u64;
        let read = self.stream.read_exact(bytes);
        read.map_err(|fault| match fault.kind() {
            io::ErrorKind::UnexpectedEof => damaged("the file ends before the data begin"),
            _ => fault.into(),
        })
    }

    fn words<const N: usize>(&mut self) -> Result<[[u8; 4]; N], Fault> {
        let mut words = [[0; 4]; N];
        self.bytes(words.as_flattened_mut())?;
        Ok(words)
    }

    /// The first `wanted` bytes of a chunk of `size` bytes; the others and the padding are skipped.
    fn chunk(&mut self, size: u64, wanted: usize) -> Result<Vec<u8>, Fault> {
        if size < wanted as u64 {
            return Err(damaged("a chunk is too short"));
        }
        let mut chunk = vec![0; wanted];
        self.bytes(&mut chunk)?;
        let rest = size.next_multiple_of(2) - wanted as u64;
        self.position += io::copy(&mut self.stream.by_ref().take(rest), &mut io::sink())?;
        Ok(chunk)
    }

    fn format(&mut self, size: u64) -> Result<Format, Fault> {
        let chunk = self.chunk(size, if size < 40 { 16 } else { 40 })?;
        let word = |at: usize| u16::from_le_bytes([chunk[at], chunk[at + 1]]);
        let (channels, frame, bits) = (word(2), u32::from(word(12)), u32::from(word(14)));
        let (mut tag, mut valid) = (word(0), bits);
        if tag == 0xfffe {
            if chunk.len() < 40 || chunk[26..40] != SUBTYPE_TAIL {
                return Err(damaged("its extensible format has an unknown subtype"));
            }
            tag = word(24);
            // Some writers leave the number of valid bits at 0.
            valid = if word(18) == 0 {
                bits
            } else {
                u32::from(word(18))
            };
        }
        let kind = match (tag, bits) {
            (1, 1..=8) => Kind::U8,
            (1, 9..=16) => Kind::I16,
            (1, 17..=24) => Kind::I24,
            (1, 25..=32) => Kind::I32,
            (3, 32) => Kind::F32,
            (3, 64) => Kind::F64,
            _ => {
                return Err(Fault::new(format!(
                    "WAV header: the samples are {}; export them as 16, 24 or 32-bit PCM or 32-bit float",
                    encoding(tag, bits)
                )));
            }
        };
        let code = SampleCode::new(kind);
        let stored = 8 * code.sample_bytes() as u32;
        let whole = tag == 3 || kind == Kind::U8;
        if frame != u32::from(channels) * stored / 8
            || valid > stored
            || valid < 2
            || whole && valid != stored
        {
            let fault = format!(
                "{valid} valid of {bits} bits in {channels} channels do not fit a frame of {frame} bytes"
            );
            return Err(damaged(&fault));
        }
        let rate = u32::from_le_bytes([chunk[4], chunk[5], chunk[6], chunk[7]]);
        Ok(Format {
            code: code.valid_bits(valid),
            channels: usize::from(channels),
            rate,
        })
    }
}

/// The fault of a damaged header.
fn damaged(fault: &str) -> Fault {
    Fault::new(format!(
        "WAV header: {fault}; record or export it again as 16, 24 or 32-bit PCM or 32-bit float"
    ))
}

/// The name of an encoding that is not read.
fn encoding(tag: u16, bits: u32) -> String {
    match tag {
        1 => format!("{bits}-bit integers"),
        2 | 0x11 => "compressed (ADPCM)".to_owned(),
        3 => format!("{bits}-bit floats"),
        6 => "compressed (A-law)".to_owned(),
        7 => "compressed (µ-law)".to_owned(),
        0x55 => "compressed (MP3)".to_owned(),
        _ => format!("of an unknown encoding (tag {tag:#06x})"),
    }
}

#[cfg(test)]
mod tests;

//! Interleaved samples, one pair after the other: the body of WAV and most NPY files, and raw streams.

use std::io::{self, Read};
use std::mem;

use super::error::InputError;
use super::frame::Frame;
use super::sample::{BadSample, Kind, SampleCode};
use super::{OpenOptions, Opened, Source, Stream};

/// Bytes read at a time: enough that system calls cost nothing, few enough to stay in the cache.
const CHUNK_BYTES: usize = 3 << 16;

/// Bytes of a WAV chunk's name and size.
const CHUNK_HEADER: usize = 8;

/// What a file holds behind the samples that its header promises.
#[derive(Debug, PartialEq, Eq)]
enum Behind {
    /// Another WAV file, as `cat` makes them.
    Wav,
    /// More samples, or anything else that is no chunk.
    Data,
}

/// A source of pairs from interleaved samples.
pub(super) struct Interleaved {
    file: String,
    stream: Stream,
    code: SampleCode,
    frame: Frame,
    /// The samples of the chosen channels, if there are others beside them.
    picked: Vec<u8>,
    /// The number of pairs that the header promises, if it does.
    promised: Option<u64>,
    /// The bytes of data not yet read, if the header promises their number.
    left: Option<u64>,
    /// The bytes read, the header included.
    consumed: u64,
    pairs: u64,
    chunk: Vec<u8>,
    /// The bytes of an incomplete pair, at the front of `chunk`.
    begun: usize,
    live: bool,
    /// True if only other chunks of a WAV file may follow the promised data.
    before_chunks: bool,
}

/// Opens samples without a header, of as many channels as the options say.
pub(super) fn open(
    file: &str,
    stream: Stream,
    kind: Kind,
    options: &OpenOptions,
    length: Option<u64>,
) -> Result<Opened, InputError> {
    let code = SampleCode::new(kind);
    let source = Interleaved::new(file, stream, code, 0)
        .of(frame(file, options)?)
        .live(length.is_none());
    let frame_bytes = source.frame_bytes() as u64;
    let pairs = length.map(|length| length / frame_bytes);
    Ok(Opened::of_samples("raw", code, Box::new(source), pairs))
}

/// The channels of raw samples, whose number only the options tell.
fn frame(file: &str, options: &OpenOptions) -> Result<Frame, InputError> {
    let channels = options.channels.unwrap_or(2);
    if channels != 2 && options.columns.is_none() {
        return Err(InputError::RawChannels {
            file: file.to_owned(),
            channels,
        });
    }
    Frame::choose(file, channels, options.columns.as_ref()).map_err(|fault| match fault {
        InputError::ChannelChoice { file, chosen, .. } if options.channels.is_none() => {
            InputError::RawChoice { file, chosen }
        }
        fault => fault,
    })
}

impl Interleaved {
    /// Samples to the end of `stream`, of which `consumed` bytes of header are read already.
    pub fn new(file: &str, stream: Stream, code: SampleCode, consumed: u64) -> Self {
        Self {
            file: file.to_owned(),
            stream,
            code,
            frame: Frame::PAIR,
            picked: Vec::new(),
            promised: None,
            left: None,
            consumed,
            pairs: 0,
            chunk: vec![0; CHUNK_BYTES],
            begun: 0,
            live: false,
            before_chunks: false,
        }
    }

    /// The same, with only other chunks of a WAV file to follow the promised data.
    pub fn before_chunks(self) -> Self {
        Self {
            before_chunks: true,
            ..self
        }
    }

    /// Takes the two channels out of frames with others.
    pub fn of(self, frame: Frame) -> Self {
        Self { frame, ..self }
    }

    /// The bytes of one pair and of the other channels that were sampled with it.
    fn frame_bytes(&self) -> usize {
        self.frame.channels * self.code.sample_bytes()
    }

    /// Reads no more than `bytes` of samples, and fails if there are fewer.
    pub fn promise(mut self, bytes: u64) -> Self {
        self.promised = Some(bytes / self.frame_bytes() as u64);
        self.left = Some(bytes);
        self
    }

    /// The same, which if `live` delivers what is there instead of waiting for more.
    pub fn live(self, live: bool) -> Self {
        Self { live, ..self }
    }

    /// Reads bytes behind those of an incomplete pair, up to `pairs` pairs with these; 0 at the end.
    fn read(&mut self, pairs: usize) -> io::Result<usize> {
        let most = pairs
            .saturating_mul(self.frame_bytes())
            .min(self.chunk.len())
            - self.begun;
        let most = self
            .left
            .map_or(most, |left| left.min(most as u64) as usize);
        let free = &mut self.chunk[self.begun..][..most];
        loop {
            match self.stream.read(free) {
                Err(fault) if fault.kind() == io::ErrorKind::Interrupted => {}
                result => return result,
            }
        }
    }

    /// What follows the promised data, unless it is padding or a chunk, known by a name in ASCII. A pipe is not waited for.
    ///
    /// It looks only once: what follows the name of a chunk may be anything.
    fn behind(&mut self) -> Option<Behind> {
        let mut header = [0; CHUNK_HEADER];
        let is_there = self.left == Some(0)
            && mem::take(&mut self.before_chunks)
            && !self.live
            && self.stream.read_exact(&mut header).is_ok();
        match &header[..4] {
            _ if !is_there || header == [0; CHUNK_HEADER] => None,
            b"RIFF" | b"RF64" => Some(Behind::Wav),
            name if name
                .iter()
                .all(|byte| byte.is_ascii_graphic() || *byte == b' ') =>
            {
                None
            }
            _ => Some(Behind::Data),
        }
    }

    fn end(&mut self) -> Result<(), InputError> {
        let behind = self.behind();
        let (file, found) = (self.file.clone(), self.pairs);
        match self.promised {
            Some(_) if behind == Some(Behind::Wav) => Err(InputError::AnotherWav { file, found }),
            Some(promised) if behind == Some(Behind::Data) => {
                Err(InputError::MoreData { file, promised })
            }
            Some(promised) if found < promised => Err(InputError::Truncated {
                file,
                promised,
                found,
            }),
            _ if self.begun > 0 => Err(InputError::HalfPair {
                file,
                found,
                channels: self.frame.channels,
            }),
            _ if found == 0 => Err(InputError::NoPairs { file }),
            _ => Ok(()),
        }
    }
}

/// The error for a sample that is `bad`, `pairs` pairs after the start.
pub(super) fn bad_sample(file: &str, code: SampleCode, pairs: u64, bad: BadSample) -> InputError {
    let (valid, container) = code.bits();
    InputError::Padding {
        file: file.to_owned(),
        pair: pairs + bad.pair as u64,
        channel: bad.channel,
        valid,
        container,
    }
}

impl Source for Interleaved {
    fn fill(&mut self, pairs: &mut Vec<[f32; 2]>, capacity: usize) -> Result<(), InputError> {
        while pairs.len() < capacity {
            let read = self
                .read(capacity - pairs.len())
                .map_err(|fault| InputError::io(&self.file, fault))?;
            if read == 0 {
                return self.end();
            }
            self.consumed += read as u64;
            self.left = self.left.map(|left| left - read as u64);
            let there = self.begun + read;
            let whole = there - there % self.frame_bytes();
            let bytes = if self.frame == Frame::PAIR {
                &self.chunk[..whole]
            } else {
                let size = self.code.sample_bytes();
                self.frame
                    .pick(&self.chunk[..whole], size, &mut self.picked);
                &self.picked
            };
            self.code
                .decode(bytes, pairs)
                .map_err(|bad| bad_sample(&self.file, self.code, self.pairs, bad))?;
            self.pairs += (whole / self.frame_bytes()) as u64;
            self.chunk.copy_within(whole..there, 0);
            self.begun = there - whole;
            if self.live && whole > 0 {
                break;
            }
        }
        Ok(())
    }

    fn bytes_read(&self) -> u64 {
        self.consumed
    }
}

#[cfg(test)]
mod tests;

//! Interleaved samples, one pair after the other: the body of WAV and most NPY files, and raw streams.

use std::io::{self, Read};

use super::error::Fault;
use super::frame::Frame;
use super::sample::{Kind, SampleCode};
use super::{OpenOptions, Opened, Source, Stream};

/// Bytes read at a time: enough that system calls cost nothing, few enough to stay in the cache.
const CHUNK_BYTES: usize = 3 << 16;

/// Bytes of a WAV chunk's name and size.
const CHUNK_HEADER: usize = 8;

/// A source of pairs from interleaved samples.
pub(super) struct Interleaved {
    stream: Stream,
    code: SampleCode,
    frame: Frame,
    /// The samples of the chosen channels, if there are others beside them.
    picked: Vec<u8>,
    /// What the header promises; none if samples go on to the end of the stream.
    promise: Option<Promise>,
    pairs: u64,
    chunk: Vec<u8>,
    /// The bytes of an incomplete pair, at the front of `chunk`.
    begun: usize,
    live: bool,
}

/// The data that a header promises.
struct Promise {
    pairs: u64,
    /// The bytes not yet read.
    left: u64,
    /// What may follow it, until that is checked.
    followed: Option<Followed>,
}

/// What may follow the data that a header promises.
#[derive(Clone, Copy)]
pub(super) enum Followed {
    /// The other chunks of a WAV file.
    ByChunks,
    /// Nothing.
    ByNothing,
}

/// Opens samples without a header, of as many channels as the options say.
pub(super) fn open(
    stream: Stream,
    kind: Kind,
    options: &OpenOptions,
    length: Option<u64>,
) -> Result<Opened, Fault> {
    let code = SampleCode::new(kind);
    let source = Interleaved::new(stream, code, frame(options)?, length.is_none());
    let frame_bytes = source.frame_bytes() as u64;
    let pairs = length.map(|length| length / frame_bytes);
    Ok(Opened::of_samples(
        "raw",
        code,
        Source::Interleaved(source),
        pairs,
    ))
}

/// The channels of raw samples, whose number only the options tell.
fn frame(options: &OpenOptions) -> Result<Frame, Fault> {
    let channels = options.channels.unwrap_or(2);
    if channels != 2 && options.columns.is_none() {
        return Err(Fault::new(format!(
            "there are {channels} interleaved channels (--channels), but two are needed; choose those of S_C and S_D, as in --columns 1,2"
        )));
    }
    let frame = Frame::choose(channels, options.columns.as_ref());
    match &options.columns {
        // Two channels are only assumed.
        Some(chosen) if frame.is_err() && options.channels.is_none() => Err(Fault::new(format!(
            "--columns {chosen}: raw samples have two channels unless --channels gives another number; choose 1,2 or 2,1, or give \
             --channels too"
        ))),
        _ => frame,
    }
}

impl Interleaved {
    /// Samples to the end of `stream`; if it is `live`, what is there is delivered instead of waiting for more.
    pub fn new(stream: Stream, code: SampleCode, frame: Frame, live: bool) -> Self {
        Self {
            stream,
            code,
            frame,
            picked: Vec::new(),
            promise: None,
            pairs: 0,
            chunk: vec![0; CHUNK_BYTES],
            begun: 0,
            live,
        }
    }

    /// The bytes of one pair and of the other channels that were sampled with it.
    fn frame_bytes(&self) -> usize {
        self.frame.channels * self.code.sample_bytes()
    }

    /// Reads no more than `bytes` of samples, and fails if there are fewer, or if something else follows them than may.
    pub fn promise(mut self, bytes: u64, followed: Followed) -> Self {
        self.promise = Some(Promise {
            pairs: bytes / self.frame_bytes() as u64,
            left: bytes,
            followed: Some(followed),
        });
        self
    }

    /// Reads bytes behind those of an incomplete pair, up to `pairs` pairs with these; 0 at the end.
    fn read(&mut self, pairs: usize) -> io::Result<usize> {
        let most = pairs
            .saturating_mul(self.frame_bytes())
            .min(self.chunk.len())
            - self.begun;
        let promise = self.promise.as_ref();
        let most = promise.map_or(most, |promise| promise.left.min(most as u64) as usize);
        let free = &mut self.chunk[self.begun..][..most];
        loop {
            match self.stream.read(free) {
                Err(fault) if fault.kind() == io::ErrorKind::Interrupted => {}
                result => return result,
            }
        }
    }

    /// The fault if something else than padding or what may be there follows the promised data.
    ///
    /// It looks only once: what follows the name of a chunk may be anything.
    fn behind(&mut self) -> Option<Fault> {
        let promise = self.promise.as_mut()?;
        let followed = promise.followed.take_if(|_| promise.left == 0)?;
        let promised = promise.pairs;
        if let Followed::ByNothing = followed {
            let is_followed = self.stream.read_exact(&mut [0]).is_ok();
            return is_followed.then(|| Fault::followed(promised));
        }
        // Chunks begin at even places: behind an odd number of bytes there is one more.
        let read = self.pairs * self.frame_bytes() as u64 + self.begun as u64;
        let mut padding = [0; 1];
        self.stream
            .read_exact(&mut padding[..(read % 2) as usize])
            .ok()?;
        let mut header = [0; CHUNK_HEADER];
        self.stream.read_exact(&mut header).ok()?;
        let size = u32::from_le_bytes([header[4], header[5], header[6], header[7]]);
        match &header[..4] {
            _ if header == [0; CHUNK_HEADER] => None,
            // As `cat` joins files.
            b"RIFF" | b"RF64" | b"BW64" => Some(Fault::new(format!(
                "after {} sample pairs another WAV file begins, which is not read; WAV files cannot be joined by `cat`, but by \
                 `sox part1.wav part2.wav whole.wav`",
                self.pairs
            ))),
            // Samples may look like a name, but hardly like the size of what follows too.
            name if is_name(name) && self.skip(size) => None,
            _ => Some(Fault::new(format!(
                "the WAV header promises {promised} sample pairs, but more follow, which are not read: the header was never completed, or \
                 cannot hold so large a number; correct it, for example with `sox --ignore-length FILE whole.wav`"
            ))),
        }
    }

    /// Skips so many bytes; false if there are fewer.
    fn skip(&mut self, bytes: u32) -> bool {
        let mut chunk = self.stream.by_ref().take(u64::from(bytes));
        io::copy(&mut chunk, &mut io::sink()).is_ok_and(|skipped| skipped == u64::from(bytes))
    }

    fn end(&mut self) -> Result<(), Fault> {
        if let Some(fault) = self.behind() {
            return Err(fault);
        }
        let found = self.pairs;
        match &self.promise {
            Some(promise) if found < promise.pairs => Err(Fault::truncated(promise.pairs, found)),
            _ if self.begun > 0 => Err(Fault::new(format!(
                "sample pair {found} (from 0): the data end in the middle of it; check that they hold {} channels \
                 in the stated sample format, and that the recording was not cut off",
                match self.frame.channels {
                    2 => "both".to_owned(),
                    channels => format!("all {channels}"),
                }
            ))),
            _ if found == 0 => Err(Fault::no_pairs()),
            _ => Ok(()),
        }
    }

    /// Appends pairs until there are `capacity`, as [`Source::fill`] says.
    pub fn fill(&mut self, pairs: &mut Vec<[f32; 2]>, capacity: usize) -> Result<(), Fault> {
        while pairs.len() < capacity {
            let read = self.read(capacity - pairs.len())?;
            if read == 0 {
                return self.end();
            }
            if let Some(promise) = &mut self.promise {
                promise.left -= read as u64;
            }
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
            self.code.decode(bytes, pairs, self.pairs)?;
            self.pairs += (whole / self.frame_bytes()) as u64;
            self.chunk.copy_within(whole..there, 0);
            self.begun = there - whole;
            if self.live && whole > 0 {
                break;
            }
        }
        Ok(())
    }
}

/// Whether this may be the name of a chunk.
fn is_name(name: &[u8]) -> bool {
    name.iter()
        .all(|byte| byte.is_ascii_graphic() || *byte == b' ')
}

#[cfg(test)]
mod tests;

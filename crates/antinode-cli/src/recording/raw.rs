//! Interleaved samples, one pair after the other: the body of WAV and most NPY files, and raw streams.

use std::io::{self, Read};

use super::error::InputError;
use super::sample::{BadSample, Kind, SampleCode};
use super::{Opened, Source, Stream};

/// Large enough that system calls cost nothing, small enough to stay in the cache.
const CHUNK_BYTES: usize = 3 << 16;

/// The format of samples that come without a header: little-endian, S_C and S_D in turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RawFormat {
    /// 16-bit integers, full scale 1.0.
    I16,
    /// 32-bit integers, full scale 1.0.
    I32,
    /// 32-bit floats.
    F32,
}

/// Reads interleaved samples as long as there are any.
pub(super) struct Interleaved {
    file: String,
    stream: Stream,
    code: SampleCode,
    /// The pairs the header promises, if it does.
    promised: Option<u64>,
    /// The bytes of data not yet read, where they are counted.
    left: Option<u64>,
    /// The bytes read, the header included.
    consumed: u64,
    pairs: u64,
    chunk: Vec<u8>,
    /// The bytes of a pair begun, at the front of `chunk`.
    begun: usize,
    live: bool,
}

/// Opens samples without a header.
pub(super) fn open(file: &str, stream: Stream, format: RawFormat, length: Option<u64>) -> Opened {
    let code = SampleCode::new(match format {
        RawFormat::I16 => Kind::I16,
        RawFormat::I32 => Kind::I32,
        RawFormat::F32 => Kind::F32,
    });
    let source = Interleaved::new(file, stream, code, 0).live(length.is_none());
    Opened {
        format: format!("raw {}", code.words()),
        source: Box::new(source),
        sample_rate: None,
        start: 0.0,
        warnings: Vec::new(),
        pairs: length.map(|length| length / code.pair_bytes() as u64),
        full_scale: code.full_scale(),
    }
}

impl Interleaved {
    /// Samples to the end of `stream`, of which `consumed` bytes of header are read already.
    pub fn new(file: &str, stream: Stream, code: SampleCode, consumed: u64) -> Self {
        Self {
            file: file.to_owned(),
            stream,
            code,
            promised: None,
            left: None,
            consumed,
            pairs: 0,
            chunk: vec![0; CHUNK_BYTES],
            begun: 0,
            live: false,
        }
    }

    /// No more than `bytes` of samples, and an error if there are fewer.
    pub fn promise(mut self, bytes: u64) -> Self {
        self.promised = Some(bytes / self.code.pair_bytes() as u64);
        self.left = Some(bytes);
        self
    }

    /// Whether to hand over what is there instead of waiting for more.
    pub fn live(self, live: bool) -> Self {
        Self { live, ..self }
    }

    /// Reads behind what is begun; 0 at the end.
    fn read(&mut self, pairs: usize) -> io::Result<usize> {
        let most = pairs
            .saturating_mul(self.code.pair_bytes())
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

    fn end(&self) -> Result<(), InputError> {
        let (file, found) = (self.file.clone(), self.pairs);
        match self.promised {
            Some(promised) if found < promised => Err(InputError::Truncated {
                file,
                promised,
                found,
            }),
            _ if self.begun > 0 => Err(InputError::HalfPair { file, found }),
            _ if found == 0 => Err(InputError::NoPairs { file }),
            _ => Ok(()),
        }
    }

    fn bad(&self, bad: BadSample) -> InputError {
        bad_sample(&self.file, self.code, self.pairs, bad)
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
            let whole = there - there % self.code.pair_bytes();
            self.code
                .decode(&self.chunk[..whole], pairs)
                .map_err(|bad| self.bad(bad))?;
            self.pairs += (whole / self.code.pair_bytes()) as u64;
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
mod tests {
    use super::super::tests::{Dribble, drain, message};
    use super::*;
    use crate::recording::Recording;

    fn raw(bytes: Vec<u8>, format: RawFormat) -> Recording {
        let stream = Box::new(Dribble::new(bytes, 7));
        Recording::new(
            "standard input".to_owned(),
            open("standard input", stream, format, None),
            None,
        )
    }

    #[test]
    fn every_format_is_read_across_ragged_chunks() {
        let codes: Vec<i16> = (0..999).map(|k| k * 31 - 15_000).collect();
        let values: Vec<f32> = codes
            .iter()
            .map(|&code| f32::from(code) / 32_768.0)
            .collect();
        let whole = |bytes: Vec<u8>| bytes[..bytes.len() / 2 * 2].to_vec();
        let pairs = values[..998].as_chunks::<2>().0.to_vec();
        let i16s = codes[..998]
            .iter()
            .flat_map(|code| code.to_le_bytes())
            .collect();
        let i32s = codes[..998]
            .iter()
            .flat_map(|&code| (i32::from(code) << 16).to_le_bytes())
            .collect();
        let f32s = values[..998]
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        for (bytes, format) in [
            (i16s, RawFormat::I16),
            (i32s, RawFormat::I32),
            (f32s, RawFormat::F32),
        ] {
            let (read, fault) = drain(&mut raw(whole(bytes), format));
            assert_eq!(read, pairs);
            assert!(fault.is_none());
        }
    }

    #[test]
    fn half_a_pair_at_the_end_is_an_error_after_the_good_data() {
        let (pairs, fault) = drain(&mut raw(vec![0, 0x40, 0, 0xc0, 1, 0], RawFormat::I16));
        assert_eq!(pairs, [[0.5, -0.5]]);
        assert!(message(fault).starts_with(
            "standard input: sample pair 1 (from 0): the data end in the middle of it"
        ));
    }

    #[test]
    fn not_finite_samples_pass_and_are_told() {
        let mut values = [0.5f32; 40];
        values[30] = f32::NEG_INFINITY;
        values[33] = f32::NAN;
        let bytes = values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        let mut recording = raw(bytes, RawFormat::F32);
        let (pairs, fault) = drain(&mut recording);
        assert_eq!((pairs.len(), fault.is_none()), (20, true));
        assert_eq!(pairs[15], [f32::NEG_INFINITY, 0.5]);
        assert!(message(recording.not_finite()).starts_with(
            "standard input: sample pair 15 (from 0), S_C (left): the value is -inf, not a finite \
             number, the first of 2; "
        ));
    }

    #[test]
    fn a_live_stream_is_handed_over_as_it_comes() {
        let mut recording = raw(vec![0; 64], RawFormat::I16);
        assert_eq!(recording.read(&mut Vec::with_capacity(100)).ok(), Some(1));
    }

    #[test]
    fn a_fault_of_the_pipe_comes_after_the_good_data() {
        struct Broken;
        impl Read for Broken {
            fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
                Err(io::Error::other("cable pulled"))
            }
        }
        let stream = Box::new(io::Cursor::new(vec![0; 8]).chain(Broken));
        let mut recording = Recording::new(
            "pipe".to_owned(),
            open("pipe", stream, RawFormat::I16, None),
            None,
        );
        let (pairs, fault) = drain(&mut recording);
        assert_eq!(pairs.len(), 2);
        assert!(message(fault).starts_with("pipe: cannot be read: cable pulled; "));
    }
}

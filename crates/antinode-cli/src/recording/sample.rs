//! Decoding of stored samples to pairs of numbers, many at a time.

use clap::ValueEnum;
use half::f16;

use super::error::{CHANNELS, Fault};

/// How one sample is stored: of raw ones little-endian, the channels in turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// 8-bit unsigned integers, mid-scale reads as 0 and full scale as 1.
    U8,
    /// 8-bit integers, full scale reads as 1.
    I8,
    /// 16-bit unsigned integers, mid-scale reads as 0 and full scale as 1; codes below 32768 may be read as i16 too.
    U16,
    /// 16-bit integers, full scale reads as 1.
    I16,
    /// 24-bit integers of three bytes, full scale reads as 1.
    I24,
    /// 32-bit integers, full scale reads as 1.
    I32,
    /// 16-bit floating point.
    F16,
    /// 32-bit floating point.
    F32,
    /// 64-bit floating point.
    F64,
}

/// How the samples of a recording are stored: interleaved pairs of one kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct SampleCode {
    kind: Kind,
    big_endian: bool,
    /// The number of upper bits of an integer that are in use; those below are zero.
    valid_bits: u32,
}

impl SampleCode {
    /// Little-endian samples, all bits valid.
    pub fn new(kind: Kind) -> Self {
        let valid_bits = 8 * bytes(kind) as u32;
        Self {
            kind,
            big_endian: false,
            valid_bits,
        }
    }

    /// The same, with the most significant byte first if `big_endian`.
    pub fn big_endian(self, big_endian: bool) -> Self {
        Self { big_endian, ..self }
    }

    /// The same, with only the upper `bits` of an integer in use.
    pub fn valid_bits(self, bits: u32) -> Self {
        Self {
            valid_bits: bits,
            ..self
        }
    }

    /// The bytes of one sample.
    pub fn sample_bytes(self) -> usize {
        bytes(self.kind)
    }

    /// The valid and the stored bits of one sample.
    pub fn bits(self) -> (u32, u32) {
        (self.valid_bits, 8 * self.sample_bytes() as u32)
    }

    /// The same for integers; none for floats.
    pub fn integers(self) -> Option<Self> {
        (!matches!(self.kind, Kind::F16 | Kind::F32 | Kind::F64)).then_some(self)
    }

    /// The largest positive code of integers as it is decoded.
    pub fn full_scale(self) -> f32 {
        let step = (1.0 - f64::from(self.valid_bits)).exp2();
        (1.0 - step) as f32
    }

    /// Codes of integers scaled as decoded samples are; none if one of them is no code of this kind.
    fn scaled(self, codes: [f32; 2]) -> Option<[f64; 2]> {
        let half = (f64::from(self.bits().1) - 1.0).exp2();
        let middle = match self.kind {
            Kind::U8 | Kind::U16 => half,
            _ => 0.0,
        };
        let scaled = codes.map(|code| (f64::from(code) - middle) / half);
        let is_code = |code: f32, scaled: f64| code.fract() == 0.0 && (-1.0..1.0).contains(&scaled);
        (is_code(codes[0], scaled[0]) && is_code(codes[1], scaled[1])).then_some(scaled)
    }

    /// The warning about rails given for integers that do not fit their scale, on which full scale is 1.
    pub fn rails_warning(self, [low, high]: [f32; 2]) -> Option<String> {
        // Rails a little beyond full scale are a way to have none.
        if low >= -2.0 && high <= 2.0 {
            return None;
        }
        let meant = self.scaled([low, high]);
        let meant = meant.map_or_else(String::new, |[low, high]| {
            format!("; if these are codes, give --full-scale {low},{high}")
        });
        Some(format!(
            "--full-scale: {low} and {high} are not rails of {}, which are scaled to lie within ±1{meant}",
            self.words()
        ))
    }

    /// What the samples are, in words.
    pub fn words(self) -> String {
        let kind = match self.kind {
            Kind::U8 | Kind::U16 => "unsigned integers",
            Kind::I8 | Kind::I16 | Kind::I24 | Kind::I32 => "integers",
            Kind::F16 | Kind::F32 | Kind::F64 => "floats",
        };
        format!("{}-bit {kind}", self.valid_bits)
    }

    /// Appends the pairs in `bytes`, all whole, to `pairs`, up to the first with bits below the valid ones; `before`: how many came before them.
    pub fn decode(self, bytes: &[u8], pairs: &mut Vec<[f32; 2]>, before: u64) -> Result<(), Fault> {
        let start = pairs.len();
        match (self.kind, self.big_endian) {
            (Kind::U8, _) => push(bytes, pairs, |[b]| (f32::from(b) - 128.0) / 128.0),
            (Kind::I8, _) => push(bytes, pairs, |b| f32::from(i8::from_le_bytes(b)) / 128.0),
            (Kind::U16, false) => push(bytes, pairs, |b| scale_u16(u16::from_le_bytes(b))),
            (Kind::U16, true) => push(bytes, pairs, |b| scale_u16(u16::from_be_bytes(b))),
            (Kind::I16, false) => push(bytes, pairs, |b| scale_16(i16::from_le_bytes(b))),
            (Kind::I16, true) => push(bytes, pairs, |b| scale_16(i16::from_be_bytes(b))),
            (Kind::I24, false) => push(bytes, pairs, |[a, b, c]| {
                scale_32(i32::from_le_bytes([0, a, b, c]))
            }),
            (Kind::I24, true) => push(bytes, pairs, |[a, b, c]| {
                scale_32(i32::from_be_bytes([a, b, c, 0]))
            }),
            (Kind::I32, false) => push(bytes, pairs, |b| scale_32(i32::from_le_bytes(b))),
            (Kind::I32, true) => push(bytes, pairs, |b| scale_32(i32::from_be_bytes(b))),
            (Kind::F16, false) => push(bytes, pairs, |b| f16::from_le_bytes(b).to_f32()),
            (Kind::F16, true) => push(bytes, pairs, |b| f16::from_be_bytes(b).to_f32()),
            (Kind::F32, false) => push(bytes, pairs, f32::from_le_bytes),
            (Kind::F32, true) => push(bytes, pairs, f32::from_be_bytes),
            (Kind::F64, false) => push(bytes, pairs, |b| f64::from_le_bytes(b) as f32),
            (Kind::F64, true) => push(bytes, pairs, |b| f64::from_be_bytes(b) as f32),
        }
        let Some(index) = self.padding(bytes) else {
            return Ok(());
        };
        pairs.truncate(start + index / 2);
        let (valid, container) = self.bits();
        Err(Fault::new(format!(
            "sample pair {} (from 0), {}: bits are set below the {valid} valid ones of a \
             {container}-bit sample, so its scale is unknown; export it as plain {container}-bit PCM",
            before + index as u64 / 2,
            channel_at(index)
        )))
    }

    /// The index of the first sample with bits set below its valid ones, which only little-endian WAV files can have.
    fn padding(self, bytes: &[u8]) -> Option<usize> {
        let (valid, stored) = self.bits();
        let mask = (1u32 << (stored - valid)) - 1;
        if mask == 0 {
            return None;
        }
        let low = |sample: &[u8]| {
            sample
                .iter()
                .rev()
                .fold(0, |code, &byte| code << 8 | u32::from(byte))
                & mask
        };
        bytes
            .chunks_exact(self.sample_bytes())
            .position(|sample| low(sample) != 0)
    }
}

fn bytes(kind: Kind) -> usize {
    match kind {
        Kind::U8 | Kind::I8 => 1,
        Kind::U16 | Kind::I16 | Kind::F16 => 2,
        Kind::I24 => 3,
        Kind::I32 | Kind::F32 => 4,
        Kind::F64 => 8,
    }
}

/// The channel of the sample at `index` among those of both.
pub(super) fn channel_at(index: usize) -> &'static str {
    CHANNELS[index % 2]
}

fn scale_16(code: i16) -> f32 {
    f32::from(code) * (1.0 / 32_768.0)
}

fn scale_u16(code: u16) -> f32 {
    // Inverting the upper bit subtracts mid-scale.
    scale_16((code ^ 0x8000).cast_signed())
}

fn scale_32(code: i32) -> f32 {
    code as f32 * (1.0 / 2_147_483_648.0)
}

/// Appends the whole pairs in `bytes`; generic in the closure, so that the loop of each kind is compiled to vector instructions.
#[inline]
fn push<const N: usize>(bytes: &[u8], pairs: &mut Vec<[f32; 2]>, value: impl Fn([u8; N]) -> f32) {
    let samples = bytes.as_chunks::<N>().0;
    pairs.extend(
        samples
            .as_chunks::<2>()
            .0
            .iter()
            .map(|&[c, d]| [value(c), value(d)]),
    );
}

#[cfg(test)]
mod tests;

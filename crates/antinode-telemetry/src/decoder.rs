//! Decoding of bytes to messages, robust against any bytes.

use core::fmt;
use core::marker::PhantomData;

use cobs::{DecodeResult, DecoderState};

use crate::PROTOCOL_VERSION;
use crate::frame::{self, Frame, MAX_PAYLOAD};

/// Why bytes between two delimiters were dropped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Damage {
    /// They are more than any frame has.
    TooLong,
    /// Some are missing, or they never were a frame.
    Framing,
    /// The checksum does not match.
    Checksum,
    /// They are an intact frame of another protocol version, or of the other direction, with this header.
    Header(u8),
    /// They are an intact frame with content that this version does not know.
    Content,
}

impl fmt::Display for Damage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::TooLong => f.write_str("longer than any frame"),
            Self::Framing => f.write_str("incomplete, or not a frame"),
            Self::Checksum => f.write_str("the checksum does not match"),
            Self::Header(header) if header / 2 == PROTOCOL_VERSION => {
                f.write_str("a frame of the other direction, as from an echo on the line")
            }
            Self::Header(header) => write!(
                f,
                "a frame of protocol version {}, not {PROTOCOL_VERSION}: both ends must be of the same release",
                header / 2
            ),
            Self::Content => f.write_str(
                "a valid frame of unknown content: both ends must be of the same release",
            ),
        }
    }
}

impl core::error::Error for Damage {}

/// Decoder from bytes, as they arrive, to messages: [`ReportFrame`](crate::ReportFrame)s on the PC,
/// [`CommandFrame`](crate::CommandFrame)s on the device.
///
/// It may start in the middle of a frame, and never panics.
#[derive(Debug)]
pub struct Decoder<M> {
    state: DecoderState,
    payload: heapless::Vec<u8, MAX_PAYLOAD>,
    /// True once the current frame exceeds `payload`.
    too_long: bool,
    message: PhantomData<M>,
}

impl<M: Frame> Decoder<M> {
    /// A decoder that has taken no bytes.
    pub const fn new() -> Self {
        Self {
            state: DecoderState::Idle,
            payload: heapless::Vec::new(),
            too_long: false,
            message: PhantomData,
        }
    }

    /// Takes one byte; gives the message that it completes, or the damage to a frame that it ends.
    ///
    /// Any run of bytes between two zeros gives exactly one of these; successive zeros give nothing.
    #[must_use = "the message is given once"]
    pub fn push(&mut self, byte: u8) -> Option<Result<M, Damage>> {
        let result = match self.state.feed(byte) {
            Ok(DecodeResult::NoData) => return None,
            Ok(DecodeResult::DataContinue(data)) => {
                self.too_long |= self.payload.push(data).is_err();
                return None;
            }
            _ if self.too_long => Err(Damage::TooLong),
            Ok(DecodeResult::DataComplete) => message(&self.payload),
            Err(_) => Err(Damage::Framing),
        };
        self.payload.clear();
        self.too_long = false;
        Some(result)
    }

    /// Ends a stream; gives the damage if it ends within a frame.
    pub fn finish(&mut self) -> Option<Damage> {
        // The zero ends a frame that has begun; without a zero of its own that is not complete.
        self.push(0)
            .map(|result| result.err().unwrap_or(Damage::Framing))
    }
}

impl<M: Frame> Default for Decoder<M> {
    fn default() -> Self {
        Self::new()
    }
}

fn message<M: Frame>(payload: &[u8]) -> Result<M, Damage> {
    let (content, checksum) = payload.split_last_chunk().ok_or(Damage::Framing)?;
    if frame::CRC.checksum(content) != u32::from_le_bytes(*checksum) {
        return Err(Damage::Checksum);
    }
    let (&header, body) = content.split_first().ok_or(Damage::Framing)?;
    if header != M::HEADER {
        return Err(Damage::Header(header));
    }
    match postcard::take_from_bytes(body) {
        Ok((message, [])) => Ok(message),
        _ => Err(Damage::Content),
    }
}

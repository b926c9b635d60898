//! Messages as frames: postcard, a checksum, COBS, and a zero at either end.

use core::fmt;

use crc::{CRC_32_ISO_HDLC, Crc, Table};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::command::Command;
use crate::report::Report;
use crate::{MAX_FRAME, PROTOCOL_VERSION};

/// Longest payload, that is header, number, body and checksum, bytes.
pub(crate) const MAX_PAYLOAD: usize = 120;

const _: () = assert!(MAX_PAYLOAD < 254, "a payload has one COBS code before it");

/// Bytes of the checksum.
const CHECKSUM_BYTES: usize = 4;

pub(crate) static CRC: Crc<u32, Table<1>> = Crc::<u32, Table<1>>::new(&CRC_32_ISO_HDLC);

mod sealed {
    pub trait Sealed {}
}

/// Message that a frame can carry: [`ReportFrame`] or [`CommandFrame`].
pub trait Frame: Serialize + DeserializeOwned + sealed::Sealed {
    /// The first byte within a frame, for version and direction.
    const HEADER: u8;
}

/// Report with its running number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReportFrame {
    /// Number of the report, from 0 at the device's start; it wraps.
    pub number: u16,
    /// The report.
    pub report: Report,
}

/// Command with the id that its acknowledgement repeats.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CommandFrame {
    /// Any number that differs from command to command.
    pub id: u16,
    /// The command.
    pub command: Command,
}

impl sealed::Sealed for ReportFrame {}
impl sealed::Sealed for CommandFrame {}

impl Frame for ReportFrame {
    const HEADER: u8 = 2 * PROTOCOL_VERSION;
}

impl Frame for CommandFrame {
    const HEADER: u8 = 2 * PROTOCOL_VERSION + 1;
}

/// The buffer does not hold the frame: [`MAX_FRAME`] bytes hold any.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BufferTooSmall;

impl fmt::Display for BufferTooSmall {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the buffer does not hold the frame: {MAX_FRAME} bytes hold any"
        )
    }
}

impl core::error::Error for BufferTooSmall {}

/// Writes a message as a frame into the start of `buffer`; gives the bytes to send.
///
/// # Errors
///
/// [`BufferTooSmall`]: never with [`MAX_FRAME`] bytes.
pub fn frame<'a, M: Frame>(message: &M, buffer: &'a mut [u8]) -> Result<&'a [u8], BufferTooSmall> {
    frame_of(&(M::HEADER, message), buffer)
}

/// Writes header, number and body as a frame.
pub(crate) fn frame_of<'a>(
    message: &impl Serialize,
    buffer: &'a mut [u8],
) -> Result<&'a [u8], BufferTooSmall> {
    // A delimiter, a place for the first COBS code, and the payload in place.
    let most = buffer.len().min(MAX_FRAME);
    let room = buffer.get_mut(..most).ok_or(BufferTooSmall)?;
    let (start, payload) = room.split_first_chunk_mut().ok_or(BufferTooSmall)?;
    *start = [0; START_BYTES];
    let message = postcard::to_slice(message, payload);
    let length = message.map_err(|_| BufferTooSmall)?.len();
    finish(room, START_BYTES + length)
}

/// Bytes before the payload.
const START_BYTES: usize = 2;

/// Adds the checksum to a payload that ends before `end`, removes the zeros, and ends the frame.
fn finish(buffer: &mut [u8], end: usize) -> Result<&[u8], BufferTooSmall> {
    let (before, rest) = buffer.split_at_mut_checked(end).ok_or(BufferTooSmall)?;
    let (sum, rest) = rest.split_first_chunk_mut().ok_or(BufferTooSmall)?;
    let message = before.get(START_BYTES..).ok_or(BufferTooSmall)?;
    *sum = CRC.checksum(message).to_le_bytes();
    *rest.first_mut().ok_or(BufferTooSmall)? = 0;
    let end = end + CHECKSUM_BYTES;
    let stuffed = buffer.get_mut(1..end).ok_or(BufferTooSmall)?;
    // COBS: each zero, from the one before the payload on, becomes the distance to the next. A code can express all of them.
    let mut distance = 0;
    for byte in stuffed.iter_mut().rev() {
        distance += 1;
        if *byte == 0 {
            *byte = distance;
            distance = 0;
        }
    }
    buffer.get(..=end).ok_or(BufferTooSmall)
}

//! Messages as frames: postcard, a checksum, COBS, and a zero at either end.

use core::fmt;

use crc::{CRC_32_ISO_HDLC, Crc, Table};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::command::Command;
use crate::report::Report;
use crate::{MAX_FRAME, PROTOCOL_VERSION};

/// Most bytes of header, number, body and checksum.
pub(crate) const MAX_PAYLOAD: usize = 120;

/// Bytes of the checksum.
const CHECKSUM: usize = 4;

pub(crate) static CRC: Crc<u32, Table<1>> = Crc::<u32, Table<1>>::new(&CRC_32_ISO_HDLC);

mod sealed {
    pub trait Sealed {}
}

/// What a frame can carry: [`ReportFrame`] or [`CommandFrame`].
pub trait Frame: Serialize + DeserializeOwned + sealed::Sealed {
    /// The first byte within a frame: it tells version and direction.
    const HEADER: u8;
}

/// A report with its running number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReportFrame {
    /// Counts reports from 0 at the device's start, and wraps.
    pub number: u16,
    /// The report.
    pub report: Report,
}

/// A command with the id that its acknowledgement repeats.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CommandFrame {
    /// Any; another one for the next command.
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
    // postcard could add the checksum and write COBS straight into the buffer, but byte by byte, and its indexing links panics in.
    let mut payload = [0; MAX_PAYLOAD];
    let message = postcard::to_slice(&(M::HEADER, message), &mut payload);
    let length = message.map_err(|_| BufferTooSmall)?.len();
    let (message, rest) = payload.split_at_mut_checked(length).ok_or(BufferTooSmall)?;
    let checksum = rest.first_chunk_mut().ok_or(BufferTooSmall)?;
    *checksum = CRC.checksum(message).to_le_bytes();
    let payload = payload.get(..length + CHECKSUM).ok_or(BufferTooSmall)?;
    let (first, rest) = buffer.split_first_mut().ok_or(BufferTooSmall)?;
    *first = 0;
    let length = cobs::try_encode(payload, rest).map_err(|_| BufferTooSmall)?;
    *rest.get_mut(length).ok_or(BufferTooSmall)? = 0;
    buffer.get(..length + 2).ok_or(BufferTooSmall)
}

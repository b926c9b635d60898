//! Errors in writing a recording or a figure, each worded as `FILE: what is wrong; remedy`.

use std::io;

use crate::recording::Channel;

/// Why a recording or a figure cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("{file}: {fault}")]
pub struct OutputError {
    file: String,
    fault: OutputFault,
}

impl OutputError {
    /// The error for this `fault` of `file`.
    pub fn new(file: &str, fault: OutputFault) -> Self {
        let file = file.to_owned();
        Self { file, fault }
    }

    /// The error for what the system said about `file`.
    pub fn io(file: &str, fault: io::Error) -> Self {
        Self::new(file, OutputFault::Io(fault))
    }

    /// True if the command line asks for something that can never be written, on any disk.
    pub fn is_usage(&self) -> bool {
        use OutputFault::{Rate, Unknown, Wav64};
        matches!(self.fault, Unknown { .. } | Rate { .. } | Wav64)
    }
}

/// What keeps a file from being written.
#[derive(Debug, thiserror::Error)]
pub enum OutputFault {
    /// The extension names no format that is written.
    #[error("the extension is not that of a known format; end the name in {endings}")]
    Unknown { endings: &'static str },
    /// A device, a pipe or a directory.
    #[error("this exists and is not a file; give the path of a file")]
    NotAFile,
    /// A read-only file that would be replaced.
    #[error("this file is read-only, and stays as it is; give another name, or make it writable")]
    ReadOnly,
    /// A file to be replaced that another program holds open.
    #[error("another program has this file open; close it there, or give another name")]
    Held,
    /// All is written, but the file could not be given its name.
    #[error(
        "cannot be given this name: {fault}; the complete data are beside it in `{kept}`: check what is at this path, and \
         whether another program has it open, then rename them"
    )]
    Unnamed { fault: io::Error, kept: String },
    /// The directory for the file does not exist.
    #[error("there is no directory `{directory}`; make it first, or correct the path")]
    NoDirectory { directory: String },
    /// The system failed to write.
    #[error(
        "cannot be written: {0}; check that its directory exists, is writable and has free space"
    )]
    Io(io::Error),
    /// A sample rate that is not positive, or that the format cannot hold.
    #[error("this format cannot hold a sample rate of {rate} Hz; {remedy}")]
    Rate { rate: f64, remedy: &'static str },
    /// A sample format the container cannot hold.
    #[error(
        "WAV files of 64-bit floats are not written; choose --sample f32, or a .npy or .csv file"
    )]
    Wav64,
    /// WAV files end at 4 GiB.
    #[error(
        "after {pairs} sample pairs: a WAV file holds no more than 4 GiB; write a .npy file, or fewer pairs"
    )]
    Full { pairs: u64 },
    /// A sample that is not a finite number.
    #[error(
        "sample pair {pair} (from 0), {channel}: {value} is not a finite number; correct the values that it is computed from"
    )]
    NotFinite {
        pair: u64,
        channel: Channel,
        value: f64,
    },
}

//! Errors in writing a recording or a figure, each worded as `FILE: what is wrong; remedy`.

use std::io;

use crate::recording::Channel;

/// Why a recording or a figure cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The extension names no format that is written.
    #[error("{file}: the extension is not that of a known format; end the name in {endings}")]
    Unknown { file: String, endings: &'static str },
    /// A device, a pipe or a directory.
    #[error("{file}: this exists and is not a file; give the path of a file")]
    NotAFile { file: String },
    /// A read-only file that would be replaced.
    #[error(
        "{file}: this file is read-only, and stays as it is; give another name, or make it writable"
    )]
    ReadOnly { file: String },
    /// A file to be replaced that another program holds open.
    #[error("{file}: another program has this file open; close it there, or give another name")]
    Held { file: String },
    /// All is written, but the file could not be given its name.
    #[error(
        "{file}: cannot be given this name: {fault}; the complete data are beside it in `{kept}`: check what is at this path, and \
         whether another program has it open, then rename them"
    )]
    Unnamed {
        file: String,
        fault: io::Error,
        kept: String,
    },
    /// The directory for the file does not exist.
    #[error("{file}: there is no directory `{directory}`; make it first, or correct the path")]
    NoDirectory { file: String, directory: String },
    /// The system failed to write.
    #[error(
        "{file}: cannot be written: {fault}; check that its directory exists, is writable and has free space"
    )]
    Io { file: String, fault: io::Error },
    /// A sample rate that is not positive, or that the format cannot hold.
    #[error("{file}: this format cannot hold a sample rate of {rate} Hz; {remedy}")]
    Rate {
        file: String,
        rate: f64,
        remedy: &'static str,
    },
    /// A sample format the container cannot hold.
    #[error(
        "{file}: WAV files of 64-bit floats are not written; choose --sample f32, or a .npy or .csv file"
    )]
    Wav64 { file: String },
    /// WAV files end at 4 GiB.
    #[error(
        "{file}: after {pairs} sample pairs: a WAV file holds no more than 4 GiB; write a .npy file, or fewer pairs"
    )]
    Full { file: String, pairs: u64 },
    /// A sample that is not a finite number.
    #[error(
        "{file}: sample pair {pair} (from 0), {channel}: {value} is not a finite number; correct the values that it is computed from"
    )]
    NotFinite {
        file: String,
        pair: u64,
        channel: Channel,
        value: f64,
    },
}

impl OutputError {
    /// The error for what the system said about `file`.
    pub fn io(file: &str, fault: io::Error) -> Self {
        let file = file.to_owned();
        Self::Io { file, fault }
    }

    /// True if the command line asks for something that can never be written, on any disk.
    pub fn is_usage(&self) -> bool {
        matches!(
            self,
            Self::Unknown { .. } | Self::Rate { .. } | Self::Wav64 { .. }
        )
    }
}

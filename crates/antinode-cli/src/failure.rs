//! Why the command ends without success.

use std::fmt;
use std::io;

use antinode::SettingsError;

use crate::recording::{InputError, OutputError};

/// A failure, and so an exit code: 1 for what was found in the data or the system, 2 for what was asked.
#[derive(Debug)]
pub enum Failure {
    /// A recording is at fault.
    Input(InputError),
    /// A recording could not be written.
    Output(OutputError),
    /// A recording is whole and yet not what was wanted: the message names the file and the remedy.
    Recording(String),
    /// What was asked makes no sense.
    Usage(String),
    /// The reader of our output has gone: nothing is wrong.
    Closed,
    /// The system failed while writing rows.
    Rows(io::Error),
}

impl Failure {
    /// The process's exit code.
    pub fn code(&self) -> u8 {
        match self {
            Self::Closed => 0,
            Self::Usage(_) => 2,
            _ => 1,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(error) => error.fmt(f),
            Self::Output(error) => error.fmt(f),
            Self::Recording(message) | Self::Usage(message) => f.write_str(message),
            Self::Closed => Ok(()),
            Self::Rows(error) => write!(f, "rows cannot be written: {error}; check the disk or the pipe"),
        }
    }
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        Self::Input(error)
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        Self::Output(error)
    }
}

impl From<SettingsError> for Failure {
    fn from(error: SettingsError) -> Self {
        Self::Usage(error.to_string())
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe { Self::Closed } else { Self::Rows(error) }
    }
}

//! Faults of recordings, each worded as `FILE: place: what is wrong; remedy`. Commands in them have `FILE` for the file's name.

use std::fmt;
use std::io;

use super::text::MAX_LINE;
use crate::failure::Failure;

/// The name of standard input in messages.
pub const STANDARD_INPUT: &str = "standard input";

/// The two signals of a pair, as messages name them.
pub(super) const CHANNELS: [&str; 2] = ["S_C (left)", "S_D (right)"];

/// What the columns of a text hold, in the order in which they are kept.
pub(super) const ROLES: [&str; 3] = ["the time", "S_C", "S_D"];
/// The place of the time among these.
pub(super) const TIME: usize = 0;

/// A line, and a column in it, both from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Place {
    /// The line.
    pub line: u64,
    /// The column, if the fault is in a single one.
    pub column: Option<usize>,
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", self.line)?;
        self.column
            .map_or(Ok(()), |column| write!(formatter, ":{column}"))
    }
}

/// What is wrong with a recording, and where in a text.
#[derive(Debug)]
pub(super) struct Fault {
    place: Option<Place>,
    told: String,
}

impl Fault {
    /// The fault of a recording as a whole.
    pub fn new(told: impl Into<String>) -> Self {
        Self::at(None, told)
    }

    /// The fault at a place, if that is known.
    pub fn at(place: Option<Place>, told: impl Into<String>) -> Self {
        let told = told.into();
        Self { place, told }
    }

    /// The fault of a line as a whole.
    pub fn line(line: u64, told: impl Into<String>) -> Self {
        Self::at(Some(Place { line, column: None }), told)
    }

    /// There is not a single pair of samples.
    pub fn no_pairs() -> Self {
        Self::new("there are no sample pairs in it; check that the recording was saved or sent")
    }

    /// The header promises more pairs than there are.
    pub fn truncated(promised: u64, found: u64) -> Self {
        Self::new(format!(
            "at its end: the header promises {promised} sample pairs, but there are {found}; copy or \
             record it again, or correct the header"
        ))
    }

    /// More data follow those that the header promises.
    pub fn followed(promised: u64) -> Self {
        Self::new(format!(
            "at its end: more data follow the {promised} sample pairs that the header promises, and are not read; save one array a file, \
             or correct the header"
        ))
    }

    /// No end of line within the limit: not lines of text.
    pub fn line_too_long(line: u64) -> Self {
        Self::line(
            line,
            format!(
                "more than {MAX_LINE} bytes without an end of line; give text with one sample pair a line"
            ),
        )
    }

    /// The failure for this fault of a file.
    pub fn of(&self, file: &str) -> Failure {
        let place = self
            .place
            .map_or(String::new(), |place| format!("{place}:"));
        let told = with_name(&self.told, file);
        Failure::Fault(format!("{file}:{place} {told}"))
    }
}

/// A message whose commands name this file, unless it is standard input.
fn with_name(message: &str, file: &str) -> String {
    if file == STANDARD_INPUT {
        return message.to_owned();
    }
    // In quotes, which shells need around blanks, brackets and backslashes; within quotes a name stands as it is.
    message
        .replace("'FILE'", &format!("'{file}'"))
        .replace(" FILE ", &format!(" \"{file}\" "))
}

impl From<io::Error> for Fault {
    fn from(fault: io::Error) -> Self {
        Self::new(match fault.kind() {
            // Windows calls a name with `*` invalid: no file can have it.
            io::ErrorKind::NotFound | io::ErrorKind::InvalidFilename => {
                "there is no such file; check the path".to_owned()
            }
            io::ErrorKind::PermissionDenied => {
                "no permission to read it; grant read access to the file and its directory"
                    .to_owned()
            }
            io::ErrorKind::IsADirectory => {
                "this is a directory; name the file inside it".to_owned()
            }
            _ => format!("cannot be read: {fault}; check the disk, the network share or the pipe"),
        })
    }
}

/// The failure for what the system said about reading a file.
pub fn unreadable(file: &str, fault: io::Error) -> Failure {
    Fault::from(fault).of(file)
}

//! The reasons for which the command fails, and their exit codes.

use std::io;

use antinode::SettingsError;

/// Windows' error code for a pipe without a process on its other end, for which `io::ErrorKind` has no kind.
const PIPE_NOT_CONNECTED: i32 = 233;

/// A failure, which sets the exit code: 1 for a fault in the data or the system, 2 for a wrong command line, 130 for an interruption.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// Something is wrong with a file, a port or the system: the message names it and the remedy.
    #[error("{0}")]
    Fault(String),
    /// The command line asks for something that makes no sense.
    #[error("{0}")]
    Usage(String),
    /// Ctrl-C or a signal from the system came before this file was complete.
    #[error("{file}: interrupted, and not written; run it again")]
    Interrupted { file: String },
    /// Ctrl-C or a signal from the system came before a recording was read to its end.
    #[error("interrupted; the rows printed so far are good")]
    Stopped,
    /// The reader of the output has gone, as `head` does: nothing is wrong, and the exit code is 0.
    #[error("")]
    Closed,
    /// The system failed while writing rows, or anything else to standard output.
    #[error("the output cannot be written: {0}; check the disk or the pipe")]
    Unwritten(io::Error),
}

impl Failure {
    /// The process's exit code.
    pub fn code(&self) -> u8 {
        match self {
            Self::Closed => 0,
            Self::Usage(_) => 2,
            // A shell's code for Ctrl-C, also for other signals: which one came is not known here.
            Self::Interrupted { .. } | Self::Stopped => 130,
            _ => 1,
        }
    }
}

/// The failure for what the system said about writing a file.
pub fn unwritable(file: &str, fault: &io::Error) -> Failure {
    Failure::Fault(format!(
        "{file}: cannot be written: {fault}; check that its directory exists, is writable and has free space"
    ))
}

/// The failure for a file whose extension is none of these `endings`.
pub fn unknown_extension(file: &str, endings: &str) -> Failure {
    Failure::Usage(format!(
        "{file}: the extension is not that of a known format; end the name in {endings}"
    ))
}

impl From<SettingsError> for Failure {
    fn from(error: SettingsError) -> Self {
        // The parsers of all other options check their ranges.
        let option = match error {
            SettingsError::HumPeriods { .. } => "--hum: ",
            _ => "",
        };
        Self::Usage(format!("{option}{error}"))
    }
}

impl From<antinode_sim::Error> for Failure {
    fn from(error: antinode_sim::Error) -> Self {
        use antinode_sim::Error;
        Self::Usage(match &error {
            Error::OutOfRange { what, need, .. } => {
                format!("{}: it must be {need}", simulate_option(what))
            }
            Error::EmptySpan { what, from, to } => format!(
                "{}: it goes from {from} s to {to} s; give FROM before TO, both finite",
                simulate_option(what)
            ),
            Error::Overlap { what, index } => format!(
                "{}: two of them overlap at sample {index} of one channel; let each end before the next begins",
                simulate_option(what)
            ),
            Error::QuadratureAboveMain { main, quadrature } => format!(
                "--quadrature-amplitude: {quadrature} exceeds the main amplitude of {main} in size; for the same wave give \
                 --main-amplitude {} --quadrature-amplitude {}, an angle 45° {} and a phase 90° less",
                quadrature.abs(),
                main.copysign(*quadrature),
                if *quadrature > 0.0 { "less" } else { "greater" }
            ),
            Error::EndlessLoss { .. } => format!("--lost: {error}"),
            other => other.to_string(),
        })
    }
}

/// The option of `simulate` that sets a field of the simulation.
fn simulate_option(field: &str) -> String {
    match field {
        "sample_rate" => "--rate".to_owned(),
        "skew" | "jitter" => format!("--{field}-ns"),
        "clip_spans" => "--clip-span".to_owned(),
        "level of clip_spans" => "--clip-span, the level".to_owned(),
        "dropouts" => "--dropout".to_owned(),
        other => format!("--{}", other.replace('_', "-")),
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        let is_disconnected = cfg!(windows) && error.raw_os_error() == Some(PIPE_NOT_CONNECTED);
        if error.kind() == io::ErrorKind::BrokenPipe || is_disconnected {
            Self::Closed
        } else {
            Self::Unwritten(error)
        }
    }
}

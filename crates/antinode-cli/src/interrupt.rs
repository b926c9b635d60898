//! Ctrl-C, or the system's wish that the command end.

use crate::failure::Failure;

/// Lets `handler` be called when it comes; once in a process.
pub fn on_interrupt(handler: impl FnMut() + Send + 'static) -> Result<(), Failure> {
    ctrlc::set_handler(handler)
        .map_err(|error| Failure::Recording(format!("Ctrl-C cannot be caught: {error}")))
}

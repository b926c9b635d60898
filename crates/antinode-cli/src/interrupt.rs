//! Handling of Ctrl-C and of the system's signals to end the command.

use std::io;

use crate::failure::Failure;

/// Has `handler` called at each Ctrl-C or signal to end, with true if that is SIGTERM, which nobody sends twice; to be installed only once
/// in a process.
pub fn on_interrupt(handler: impl FnMut(bool) + Send + 'static) -> Result<(), Failure> {
    catch(handler).map_err(|error| Failure::Fault(format!("Ctrl-C cannot be caught: {error}")))
}

#[cfg(unix)]
fn catch(mut handler: impl FnMut(bool) + Send + 'static) -> Result<(), io::Error> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;

    // SIGINT is caught even if it was ignored, as in a shell script's background: `kill -INT` ends a recorder there, and on Windows too.
    let mut signals = Signals::new([SIGINT, SIGTERM])?;
    // A command started by `nohup` must go on when its terminal is closed.
    if !is_ignored(SIGHUP) {
        signals.add_signal(SIGHUP)?;
    }
    std::thread::spawn(move || {
        signals
            .forever()
            .for_each(|signal| handler(signal == SIGTERM))
    });
    Ok(())
}

/// True if the process was started with this signal ignored; false if the system does not tell.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    // Only Linux tells; other systems cannot be asked without `unsafe`.
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mut ignored = status
        .lines()
        .filter_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored
        .next()
        .map(|mask| u64::from_str_radix(mask.trim(), 16));
    ignored.is_some_and(|mask| mask.is_ok_and(|mask| mask >> (signal - 1) & 1 == 1))
}

#[cfg(windows)]
fn catch(mut handler: impl FnMut(bool) + Send + 'static) -> Result<(), io::Error> {
    ctrlc::set_handler(move || handler(false)).map_err(io::Error::other)
}

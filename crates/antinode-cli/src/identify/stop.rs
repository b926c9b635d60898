//! Ctrl-C, or a signal to terminate: rows found so far are printed, and their flags reported.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use antinode::Flags;

use super::out::Out;
use super::remarks::flag_counts::FlagCounts;
use super::residual::Residual;
use crate::failure::Failure;
use crate::interrupt::on_interrupt;
use crate::tell::tell;

/// Time for the command to end by itself: it may be waiting for samples that a pipe never sends.
const GRACE: Duration = Duration::from_millis(300);

/// Whether the command is to end, and what it reports then.
#[derive(Debug, Clone, Default)]
pub(super) struct Stop {
    is_asked: Arc<AtomicBool>,
    /// The current recording and its flag counts, until these are reported.
    current: Arc<Mutex<Option<(String, FlagCounts)>>>,
}

impl Stop {
    /// Installs the handler, once in a process; if the command does not end by itself, it cuts the rows' file short, completes the
    /// residual's, and exits.
    pub fn new(out: &Out, residual: &Residual) -> Result<Self, Failure> {
        let stop = Self::default();
        let asked = stop.clone();
        let (out, residual) = (out.clone(), residual.clone());
        on_interrupt(move |_| {
            asked.is_asked.store(true, Ordering::Relaxed);
            thread::sleep(GRACE);
            asked.report(false);
            let _closed = out.cut_short();
            if let Err(unwritten) = residual.finish() {
                tell(format_args!("error: {unwritten}"));
            }
            let failure = Failure::Stopped;
            tell(format_args!("error: {failure}"));
            process::exit(failure.code().into());
        })?;
        Ok(stop)
    }

    pub fn is_asked(&self) -> bool {
        self.is_asked.load(Ordering::Relaxed)
    }

    /// Sets the current recording.
    pub fn begin(&self, name: &str, flagged: FlagCounts) {
        *self.lock() = Some((name.to_owned(), flagged));
    }

    /// Takes a row's flags.
    pub fn see(&self, flags: Flags) {
        if let Some((_, flagged)) = &mut *self.lock() {
            flagged.see(flags);
        }
    }

    /// Reports, once, how many rows of the current recording are flagged, with remedies unless the cause is known.
    pub fn report(&self, is_cause_known: bool) {
        let Some((name, flagged)) = self.lock().take() else {
            return;
        };
        if let Some(warning) = flagged.warning(is_cause_known) {
            tell(format_args!("warning: {name}: {warning}"));
        }
    }

    fn lock(&self) -> MutexGuard<'_, Option<(String, FlagCounts)>> {
        self.current.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

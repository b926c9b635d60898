//! Ctrl-C, or the system's wish that the command end: rows that were found are printed, and their flags are told.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use antinode::Flags;

use super::out::Out;
use super::remarks::flag_counts::FlagCounts;
use crate::failure::Failure;
use crate::interrupt::on_interrupt;

/// How long the command may take to end by itself: it may wait for samples of a pipe that do not come.
const GRACE: Duration = Duration::from_millis(300);

/// Whether the command is to end, and what is to be told then.
#[derive(Debug, Clone, Default)]
pub(super) struct Stop {
    is_asked: Arc<AtomicBool>,
    /// The present recording and its rows, as long as these are not told.
    present: Arc<Mutex<Option<(String, FlagCounts)>>>,
}

impl Stop {
    /// Waits for Ctrl-C, which cuts the rows' file short where the command does not end by itself; once in a process.
    pub fn new(out: &Out) -> Result<Self, Failure> {
        let stop = Self::default();
        let asked = stop.clone();
        let out = out.clone();
        on_interrupt(move || {
            asked.is_asked.store(true, Ordering::Relaxed);
            thread::sleep(GRACE);
            asked.tell(false);
            let _closed = out.cut_short();
            let failure = Failure::Stopped;
            eprintln!("error: {failure}");
            process::exit(failure.code().into());
        })?;
        Ok(stop)
    }

    pub fn is_asked(&self) -> bool {
        self.is_asked.load(Ordering::Relaxed)
    }

    /// Begins a recording.
    pub fn begin(&self, name: &str, flagged: FlagCounts) {
        *self.lock() = Some((name.to_owned(), flagged));
    }

    /// Takes a row's flags.
    pub fn see(&self, flags: Flags) {
        if let Some((_, flagged)) = &mut *self.lock() {
            flagged.see(flags);
        }
    }

    /// Tells, once, how many rows of the present recording are flagged, and what may be done unless something else tells why.
    pub fn tell(&self, knows_why: bool) {
        let Some((name, flagged)) = self.lock().take() else {
            return;
        };
        if let Some(told) = flagged.told(knows_why) {
            eprintln!("warning: {name}: {told}");
        }
    }

    fn lock(&self) -> MutexGuard<'_, Option<(String, FlagCounts)>> {
        self.present.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

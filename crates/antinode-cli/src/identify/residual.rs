//! `--residual`: what the waves leave of the samples, as a recording of its own.

mod fitted;

use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use antinode::{Calibration, Estimate, Flags};

use super::options::Identify;
use super::{LONGEST_PERIOD, MAX_PERIODS};
use crate::digits::{counted, significant};
use crate::failure::Failure;
use crate::recording::{Recording, RecordingWriter, SampleFormat};
use crate::tell::tell;
use fitted::Fitted;

/// Most pairs lost in a row that zeros stand for: 128 MB of single precision, or the gap of a time that is wrong.
const MAX_LEFT_OUT: u64 = 1 << 24;
/// Most pairs that wait for their row: those of the longest window.
const MAX_WAITING: usize = LONGEST_PERIOD * (MAX_PERIODS as usize + 2);

/// The residual's file, if one was asked for, until it is finished.
#[derive(Clone, Default)]
pub(super) struct Residual(Arc<Mutex<Option<Open>>>);

/// A residual that is being written.
struct Open {
    writer: RecordingWriter,
    /// The first failure to write, after which nothing more is written.
    fault: Option<Failure>,
    rate: f64,
    calibration: Calibration,
    /// Pairs written, which is also the number of the first pair that waits.
    written: u64,
    waiting: Vec<[f32; 2]>,
    has_rows: bool,
    /// The offsets of the first wave: those of each window would hide hum.
    offsets: Option<[f32; 2]>,
    /// Pairs within windows with a wave, and the sums of their squares.
    explained: u64,
    squares: [f64; 2],
}

impl Residual {
    /// Begins the file that was asked for, if any, for a recording of this sample rate.
    pub fn begin(
        &self,
        options: &Identify,
        recording: &Recording,
        rate: f64,
    ) -> Result<(), Failure> {
        let Some(path) = &options.residual else {
            return Ok(());
        };
        refuse_to_replace(path)?;
        let writer = RecordingWriter::create(path, rate, SampleFormat::F32)?;
        writer.check_room(recording.opened.pairs.unwrap_or(0))?;
        *self.lock() = Some(Open {
            writer,
            fault: None,
            rate,
            calibration: options.corrected.calibration(),
            written: 0,
            waiting: Vec::new(),
            has_rows: false,
            offsets: None,
            explained: 0,
            squares: [0.0; 2],
        });
        Ok(())
    }

    /// Takes the next pairs; the first of all was sampled at `start`, s.
    pub fn extend(&self, pairs: &[[f32; 2]], start: f64) {
        if let Some(open) = &mut *self.lock() {
            open.writer.count_time_from(start);
            open.waiting.extend(pairs);
            let beyond = open.waiting.len().saturating_sub(MAX_WAITING);
            open.leave_out(beyond as u64);
        }
    }

    /// Passes over lost pairs.
    pub fn skip(&self, lost: u64) {
        if let Some(open) = &mut *self.lock() {
            open.leave_out(open.waiting.len() as u64 + lost);
        }
    }

    /// Takes the row of a window: its samples, without its wave, are written.
    pub fn row(&self, row: &Estimate) {
        if let Some(open) = &mut *self.lock() {
            open.row(row);
        }
    }

    /// Completes the file, and tells what is in it; nothing after the first time.
    pub fn finish(&self) -> Result<(), Failure> {
        let open = self.lock().take();
        open.map_or(Ok(()), Open::finish)
    }

    /// Leaves the file unwritten, if there is one, as nobody reads the rows any more.
    pub fn leave(&self) {
        if let Some(open) = self.lock().take() {
            tell(format_args!(
                "{}: not written, as the rows' reader has gone; write the rows to a file with --out",
                open.writer.name()
            ));
        }
    }

    fn lock(&self) -> MutexGuard<'_, Option<Open>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Open {
    /// Writes zeros in place of the next pairs.
    fn leave_out(&mut self, pairs: u64) {
        if pairs == 0 {
            return;
        }
        let waiting = usize::try_from(pairs).unwrap_or(usize::MAX);
        self.waiting.drain(..waiting.min(self.waiting.len()));
        self.written += pairs;
        if pairs > MAX_LEFT_OUT && self.fault.is_none() {
            self.fault = Some(Failure::Fault(format!(
                "{}: {pairs} sample pairs in a row are lost, and the file would hold as many zeros; it is not written: give a part of the \
                 recording by --from and --to",
                self.writer.name()
            )));
        }
        for _ in 0..pairs {
            if self.fault.is_some() {
                break;
            }
            self.fault = self.writer.write([0.0; 2]).err();
        }
    }

    fn row(&mut self, row: &Estimate) {
        self.has_rows = true;
        self.leave_out(row.start.saturating_sub(self.written));
        let count = row.end().saturating_sub(self.written);
        if row.flags.contains(Flags::LOST) {
            self.leave_out(count);
            return;
        }
        let from = self.written;
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        let pairs = self.waiting.drain(..count.min(self.waiting.len()));
        let pairs: Vec<_> = pairs.collect();
        self.written += pairs.len() as u64;
        self.explained += pairs.len() as u64;
        let offsets = *self.offsets.get_or_insert(row.offsets);
        for mut left in Fitted::new(row, self.rate, self.calibration).leaves(from, &pairs) {
            for (k, left) in left.iter_mut().enumerate() {
                *left -= f64::from(offsets[k]);
                self.squares[k] += *left * *left;
            }
            if self.fault.is_none() {
                self.fault = self.writer.write(left).err();
            }
        }
    }

    fn finish(mut self) -> Result<(), Failure> {
        let name = self.writer.name().to_owned();
        if !self.has_rows {
            tell(format_args!("{name}: not written, as there are no rows"));
            return Ok(());
        }
        self.leave_out(self.waiting.len() as u64);
        if let Some(fault) = self.fault {
            return Err(fault);
        }
        self.writer.finish()?;
        let count = counted(self.written, "sample pair");
        let [c, d] = self
            .squares
            .map(|sum| significant((sum / self.explained.max(1) as f64).sqrt(), 3));
        tell(format_args!("{name}: {count}, rms {c} in C and {d} in D"));
        Ok(())
    }
}

/// Refuses to replace a file: it may be a recording, which cannot be had again.
fn refuse_to_replace(path: &Path) -> Result<(), Failure> {
    if !path.is_file() {
        return Ok(());
    }
    Err(Failure::Fault(format!(
        "{}: this file exists, and is not replaced, as it may be a recording; give another name to --residual, or delete it first",
        path.display()
    )))
}

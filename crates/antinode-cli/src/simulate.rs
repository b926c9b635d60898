//! `antinode simulate`: a recording of a synthetic gyro, and the truth beside it.

mod fields;
mod options;

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use antinode_sim::{Flaws, Gyro, Wave};
use serde::Serialize;

use crate::failure::Failure;
use crate::interrupt::on_interrupt;
use crate::recording::RecordingWriter;
use crate::tell::tell;
use crate::whole_file::WholeFile;
pub use options::Simulate;

/// The truth about the recording, as JSON.
#[derive(Debug, Serialize)]
struct Truth<'a> {
    sample_rate_hz: f64,
    sample_pairs: u64,
    seed: u64,
    /// At the first sample, with its rates.
    wave: &'a Wave,
    flaws: &'a Flaws,
}

/// Writes the recording and its truth.
pub fn run(options: &Simulate) -> Result<(), Failure> {
    let (wave, flaws) = (options.wave(), options.flaws());
    let gyro = Gyro::new(wave, flaws.clone(), options.rate, options.seed)?;
    let pairs = options.pairs()?;
    options.check_places(pairs)?;
    options.check_frequency()?;
    // Appended to the whole name, so that recordings that differ in the extension alone each have their own truth.
    let mut beside = options.out.clone().into_os_string();
    beside.push(".json");
    let beside = PathBuf::from(beside);
    // A simulation can be repeated, but a recording that was measured is not overwritten.
    if options.out.is_file() && !beside.exists() {
        return Err(Failure::Fault(format!(
            "{}: this file exists, but no {} does, so it was not simulated and is not replaced; give another name, or delete it first",
            options.out.display(),
            beside.display()
        )));
    }
    let truth = Truth {
        sample_rate_hz: options.rate,
        sample_pairs: pairs,
        seed: options.seed,
        wave: &wave,
        flaws: &flaws,
    };
    let beyond = write(options, gyro, &truth, &beside)?;
    if options.sample.is_integer() && beyond > 0 {
        tell(format_args!(
            "warning: {beyond} of {pairs} sample pairs exceeded the file's full scale of 1 and were clipped; \
             lower the amplitudes, or give --sample f32"
        ));
    }
    writeln!(
        io::stdout(),
        "{}: {pairs} sample pairs at {} Hz; the truth is in {}",
        options.out.display(),
        options.rate,
        beside.display()
    )?;
    Ok(())
}

/// Writes both files, or none; returns how many pairs lay beyond a full scale of 1.
fn write(options: &Simulate, gyro: Gyro, truth: &Truth, beside: &Path) -> Result<u64, Failure> {
    // Unfinished files are removed when they are dropped, but not if the process is killed.
    let interrupted = interrupted()?;
    let mut writer = RecordingWriter::create(&options.out, options.rate, options.sample)?;
    writer.check_room(truth.sample_pairs)?;
    let text = serde_json::to_string_pretty(truth).map_err(io::Error::from)?;
    // Written before the samples, so that a failure shows at once and not after a long recording.
    let beside = WholeFile::of(beside, (text + "\n").as_bytes())?;
    let mut beyond = 0u64;
    // Counted in 64 bits, which a 32-bit processor's `usize` lacks.
    for (_, pair) in (0..truth.sample_pairs).zip(gyro) {
        if interrupted.load(Ordering::Relaxed) {
            let file = options.out.display().to_string();
            return Err(Failure::Interrupted { file });
        }
        beyond += u64::from(pair.iter().any(|s| s.abs() > 1.0));
        writer.write(pair)?;
    }
    writer.finish()?;
    beside.finish()?;
    Ok(beyond)
}

/// A flag that becomes true when the user or the system ends the command.
fn interrupted() -> Result<Arc<AtomicBool>, Failure> {
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupted);
    on_interrupt(move |_| flag.store(true, Ordering::Relaxed))?;
    Ok(interrupted)
}

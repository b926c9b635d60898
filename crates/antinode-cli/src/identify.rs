//! `antinode identify`: recordings in, rows out, as a stream.

mod first_pairs;
mod format;
mod options;
mod out;
mod remarks;
mod residual;
mod search;
mod span;
mod stop;
mod windows;

use std::collections::HashSet;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

use antinode::{Identifier, Settings};
use indicatif::ProgressBar;

use crate::failure::Failure;
use crate::options::Format;
use crate::progress;
use crate::ranges::{RATES, in_order};
use crate::recording::{BLOCK_PAIRS, Columns, OpenOptions, Recording, place};
use crate::result_file::check_is_no_input;
use crate::rows::Rows;
use crate::tell::tell;
pub use options::Identify;
use options::{MAX_PERIODS, Shown};
use out::Out;
use remarks::flag_counts::FlagCounts;
use residual::Residual;
use stop::Stop;
use windows::Windows;

/// Samples in the longest period, and in the shortest that `--frequency` may give.
const LONGEST_PERIOD: usize = 1024;
const SHORTEST_PERIOD: f64 = 2.5;
/// Windows of up to 1022 periods.
type Core = Identifier<f32, LONGEST_PERIOD, { MAX_PERIODS as usize + 2 }>;

/// Size, bytes, above which a file gets a progress bar.
const LARGE_FILE: u64 = 32 << 20;

/// Identifies every file; a fault in one does not keep the others from being read.
pub fn run(options: &Identify) -> Result<(), Failure> {
    // Wrong options are wrong for every file: they are reported once, before any is opened.
    // The sample rate, and with it the range of the frequency, belongs to a recording.
    Settings {
        frequency: None,
        ..options.settings(1.0, None, None)
    }
    .check(usize::from(MAX_PERIODS) + 2)?;
    in_order(options.from, options.to)?;
    options.check_channels()?;
    options.check_residual()?;
    if let Some(path) = options.file() {
        check_is_no_input("--out", path, &options.files, "is a recording")?;
    }
    let format = options.format()?;
    warn_of_duplicates(&options.files);
    let (out, to) = Out::open(options)?;
    let mut rows = Rows::new(to, format, options.methods == Shown::All);
    let residual = Residual::default();
    let stop = Stop::new(&out, &residual)?;
    let mut failure = None;
    for path in &options.files {
        let result = identify(path, options, format, &stop, &residual, &mut rows);
        // Rows found before a fault are printed before the fault is reported.
        let flushed = rows.flush().map_err(Failure::from);
        let error = match flushed.and(result) {
            Ok(()) => continue,
            Err(Failure::Closed) => {
                residual.leave();
                return Err(Failure::Closed);
            }
            Err(error) => error,
        };
        let is_last = matches!(error, Failure::Stopped | Failure::Unwritten(_));
        if let Some(before) = failure.replace(error) {
            tell(format_args!("error: {before}"));
        }
        if is_last {
            break;
        }
    }
    // Rows found before a fault are good.
    let total = rows.total();
    drop(rows);
    if matches!(failure, Some(Failure::Unwritten(_))) {
        drop(out.cut_short());
    }
    let finished = out.finish(total);
    failure.map_or(finished, Err)
}

/// Warns of a file that is given twice: its rows would count twice in what is computed from them.
fn warn_of_duplicates(files: &[PathBuf]) {
    let mut seen = HashSet::new();
    for file in files {
        if place(file).is_some_and(|one| !seen.insert(one)) {
            tell(format_args!("warning: {} is given twice", file.display()));
        }
    }
}

/// Identifies one recording.
fn identify(
    path: &Path,
    options: &Identify,
    format: Format,
    stop: &Stop,
    residual: &Residual,
    rows: &mut Rows<impl Write>,
) -> Result<(), Failure> {
    let (mut recording, rate) = open(path, options)?;
    residual.begin(options, &recording, rate)?;
    let name = recording.name.clone();
    let mut windows = Windows::new(&name, options, &recording, rate, stop, residual)?;
    stop.begin(&name, FlagCounts::new(options.hum, options.coloured));
    let pairs = recording.opened.pairs;
    let length = pairs.map_or(String::new(), |pairs| format!(", {pairs} sample pairs"));
    let title = format!("{name}: {}{length} at {rate} Hz", recording.opened.format);
    // With several files, each table has a title.
    let several = options.files.len() > 1;
    let is_watched = io::stderr().is_terminal() && !(several && format == Format::Table);
    if is_watched {
        tell(&title);
    }
    rows.begin(several.then_some(title), rate);

    let is_shown = options.file().is_none() && io::stdout().is_terminal();
    let is_pipe = is_pipe(&recording);
    let bar = progress(&recording, is_shown);
    let mut buffer = Vec::with_capacity(BLOCK_PAIRS);
    let fault = loop {
        if stop.is_asked() {
            break Some(Failure::Stopped);
        }
        match recording.read(&mut buffer) {
            Ok(0) => break None,
            Ok(_) => {}
            Err(error) => break Some(error),
        }
        let goes_on = windows
            .take(&mut recording, &buffer, rows)
            .and_then(|goes_on| {
                // The rows are shown on a terminal, or the samples arrive live.
                if is_shown || is_pipe {
                    rows.flush()?;
                }
                Ok(goes_on)
            });
        match goes_on {
            Ok(true) => {}
            Ok(false) => break None,
            Err(error @ Failure::Unwritten(_)) => break Some(error),
            Err(error) => return Err(error),
        }
        bar.set_position(recording.bytes_read());
    };
    bar.finish_and_clear();
    if is_watched && pairs.is_none() {
        tell(format_args!("{name}: {} sample pairs", windows.pairs()));
    }
    windows.conclude(&recording, fault, rows)
}

/// Opens a recording, prints the warnings that belong before its rows, and returns it with its sample rate.
fn open(path: &Path, options: &Identify) -> Result<(Recording, f64), Failure> {
    let open = OpenOptions {
        raw: options.raw,
        channels: options.channels.map(usize::from),
        columns: options.columns.clone(),
        rate: options.rate,
    };
    let mut recording = Recording::open(path, &open)?;
    if options.rate.or(recording.opened.sample_rate).is_none() && !is_pipe(&recording) {
        // A fault in the first lines may be why the rate is unknown: the second read returns the fault that ended the first.
        let mut buffer = Vec::with_capacity(BLOCK_PAIRS);
        for _ in 0..2 {
            recording.read(&mut buffer)?;
        }
    }
    let rate = sample_rate(&recording, options)?;
    let name = &recording.name;
    let rails = options.full_scale;
    let rails = rails.and_then(|rails| recording.rails_warning(rails));
    for warning in rails.iter().chain(&recording.opened.warnings) {
        tell(format_args!("warning: {name}: {warning}"));
    }
    Ok((recording, rate))
}

/// True for a stream, whose samples may arrive slowly and never end.
fn is_pipe(recording: &Recording) -> bool {
    recording.bytes_total.is_none()
}

/// The rate given by `--rate`, or else the recording's own, if plausible.
fn sample_rate(recording: &Recording, options: &Identify) -> Result<f64, Failure> {
    let (name, opened) = (&recording.name, &recording.opened);
    match (options.rate, opened.sample_rate, &opened.absurd) {
        (Some(rate), ..) => Ok(rate),
        (None, Some(_), Some(absurd)) => Err(Failure::Fault(format!("{name}: {absurd}"))),
        (None, Some(rate), None) if RATES.contains(&rate) => Ok(rate),
        (None, Some(rate), None) => Err(Failure::Fault(format!(
            "{name}: the recording states an absurd sample rate of {rate} Hz; give the true one as --rate HZ"
        ))),
        (None, None, _) => {
            let time = match options.columns.as_ref().and_then(Columns::without_time) {
                Some([c, d]) => format!(
                    "; or, if a column of text has the time, name it too, as --columns TIME,{c},{d}"
                ),
                None => String::new(),
            };
            Err(Failure::Fault(format!(
                "{name}: the recording does not state its sample rate; give it as --rate HZ{time}"
            )))
        }
    }
}

/// A progress bar for a large file whose rows are not shown on the terminal; hidden otherwise.
fn progress(recording: &Recording, is_shown: bool) -> ProgressBar {
    match recording.bytes_total {
        Some(total) if total > LARGE_FILE && !is_shown => progress::bar(
            total,
            "{wide_bar} {bytes}/{total_bytes} {bytes_per_sec} {eta}",
        ),
        _ => ProgressBar::hidden(),
    }
}

//! `antinode identify`: recordings in, rows out, as a stream.

mod search;
mod silence;
mod span;

use std::io::{self, BufWriter, IsTerminal, Write};
use std::path::Path;

use antinode::{Estimate, Flags, Identifier, Settings, SettingsError};
use indicatif::{ProgressBar, ProgressStyle};

use crate::failure::Failure;
use crate::methods::History;
use crate::options::{Format, Identify, MOST_PERIODS, Methods};
use crate::recording::{BLOCK_PAIRS, OpenOptions, Recording};
use crate::rows::Rows;
use search::Search;
use silence::Silence;
use span::{Span, Step};

/// Samples of the longest period that may be known, and of the longest that is searched.
const LONGEST: usize = 1024;
const SEARCHED: usize = 200;
/// Windows of up to 1022 periods.
type Core = Identifier<f32, LONGEST, { MOST_PERIODS as usize + 2 }>;

/// Pairs between two looks at the search: no period is found and refused in fewer.
const GLANCE: usize = 8;

/// Recordings longer than this show how far they have come.
const LONG: u64 = 32 << 20;

/// Windows flagged as misfit from which on a remedy is named, where they are a quarter of all.
const MANY: u64 = 20;

/// Identifies every file; a fault in one does not keep the others from being read.
pub fn run(options: &Identify) -> Result<(), Failure> {
    // What is wrong with the options is wrong for every file: it is said once, before any is opened.
    // The rate is not among them, nor the frequency that it bounds: it belongs to a recording.
    Settings {
        frequency: None,
        ..options.settings(1.0, None, None)
    }
    .check(usize::from(MOST_PERIODS) + 2)?;
    Span::check(options)?;
    // The core would do without it there, and nothing would tell.
    let least = if options.hop.is_some() { 10 } else { 5 };
    if options.hum && options.periods < least {
        return Err(Failure::Usage(format!(
            "--hum: windows of {} periods are too short for it: give --periods {least} or more",
            options.periods
        )));
    }
    let mut rows = Rows::new(
        BufWriter::new(io::stdout().lock()),
        options.output,
        options.methods == Methods::All,
    );
    let several = options.files.len() > 1;
    let mut failure = None;
    for path in &options.files {
        let result = identify(path, options, several, &mut rows);
        // Rows found before a fault are printed before the fault is told.
        rows.flush()?;
        match result {
            Err(Failure::Closed) => return Err(Failure::Closed),
            Err(error) => {
                if let Some(before) = failure.replace(error) {
                    eprintln!("error: {before}");
                }
            }
            Ok(()) => {}
        }
    }
    failure.map_or(Ok(()), Err)
}

fn identify(
    path: &Path,
    options: &Identify,
    several: bool,
    rows: &mut Rows<impl Write>,
) -> Result<(), Failure> {
    let open = OpenOptions {
        raw: options.raw,
        columns: options.columns.clone(),
        rate: options.rate,
    };
    let mut recording = Recording::open(path, &open)?;
    let name = recording.name().to_owned();
    let mut buffer = Vec::with_capacity(BLOCK_PAIRS);
    // What comes by a pipe comes in its own time.
    let is_pipe = recording.bytes_total().is_none();
    if options.rate.or(recording.sample_rate()).is_none() && !is_pipe {
        // A fault in the first lines may be why the rate is not known: one block, and what ended it.
        for _ in 0..2 {
            recording.read(&mut buffer)?;
        }
    }
    let rate = sample_rate(&name, options.rate, recording.sample_rate())?;
    for warning in recording.warnings() {
        eprintln!("warning: {warning}");
    }
    let settings = options.settings(rate, recording.full_scale(), recording.resolution());
    let mut core = Box::new(Core::new(settings).map_err(|error| match error {
        SettingsError::Frequency(frequency) => Failure::Usage(format!(
            "{name}: --frequency: {frequency} Hz, but at {rate} Hz it must lie within {:.6} to {} Hz, {LONGEST} to 2.5 samples a period",
            rate / LONGEST as f64,
            rate / 2.5
        )),
        error => error.into(),
    })?);
    let mut history =
        (options.methods == Methods::All).then(|| History::new(&settings, longest(&settings)));
    let bar = progress(&recording);
    let length = recording
        .pairs()
        .map_or(String::new(), |pairs| format!(", {pairs} sample pairs"));
    let title = format!("{name}: {}{length} at {rate} Hz", recording.format());
    // Tables of several recordings have it above them.
    let is_told = several && options.output == Format::Table;
    let is_watched = !is_told && io::stderr().is_terminal();
    if is_watched {
        eprintln!("{title}");
    }
    rows.begin(several.then_some(title));

    let live = io::stdout().is_terminal();
    let mut search = Search::default();
    let mut span = Span::new(options, &recording, rate);
    let mut silence = Silence::default();
    let mut misfits = 0;
    let fault = 'all: loop {
        match recording.read(&mut buffer) {
            Ok(0) => break None,
            Ok(_) => {}
            Err(error) => break Some(error),
        }
        let mut pairs = buffer.as_slice();
        while !pairs.is_empty() {
            let mut most = match span.step(&mut recording, pairs) {
                Step::End => break 'all None,
                Step::Leave(count) => {
                    pairs = &pairs[count..];
                    continue;
                }
                Step::Lost(lost) => {
                    core.skip(lost);
                    if let Some(history) = &mut history {
                        history.skip(lost);
                    }
                    continue;
                }
                Step::Take(most) => most,
            };
            if !span.has_begun() {
                search.begin(&pairs[..most]);
                if let Some(frequency) = options.frequency
                    && let Some(warning) = search::elsewhere(&pairs[..most], rate, frequency)
                {
                    eprintln!("warning: {name}: {warning}");
                }
            }
            // Until the first row, what becomes of the search is to be seen.
            if rows.count() == 0 {
                most = most.min(GLANCE);
            }
            let (taken, estimate) = core.push_slice(&pairs[..most]);
            search.see(core.is_searching());
            let (new, rest) = pairs.split_at(taken);
            pairs = rest;
            recording.look(span.take(taken), new);
            if let Some(history) = &mut history {
                history.extend(new);
            }
            if let Some(estimate) = estimate {
                let methods = history
                    .as_ref()
                    .and_then(|history| history.compare(&estimate));
                silence.see(&estimate, rate, options.hop);
                let estimate = Estimate {
                    time: estimate.time + span.offset(),
                    ..estimate
                };
                misfits += u64::from(estimate.flags == Flags::MISFIT);
                rows.print(&name, &estimate, methods.as_ref())?;
            }
        }
        if live || is_pipe {
            // Somebody watches, or the samples arrive as they are taken.
            rows.flush()?;
        }
        bar.set_position(recording.bytes_read());
    };
    bar.finish_and_clear();
    if is_watched && recording.pairs().is_none() {
        eprintln!("{name}: {} sample pairs", core.index());
    }
    if !options.hum && misfits >= MANY && 4 * misfits > rows.count() {
        rows.flush()?;
        eprintln!(
            "warning: {name}: {misfits} of {} rows are flagged misfit alone; if that is mains hum or an offset that wanders, --hum takes it out; if \
             the frequency drifts or the pattern turns far within a window, give a smaller --periods",
            rows.count()
        );
    }
    let seconds = core.index() as f64 / rate;
    let of_span = span.warning().filter(|_| fault.is_none());
    let of_silence = silence.told(seconds, span.offset());
    let told = of_span.into_iter().chain(of_silence);
    let told = told.map(|warning| format!("{name}: {warning}"));
    for warning in recording.late_warning().into_iter().chain(told) {
        rows.flush()?;
        eprintln!("warning: {warning}");
    }
    let failure = match fault {
        Some(error) => Some(error.into()),
        None if rows.count() > 0 => None,
        None => Some(
            span.missing(&name)
                .unwrap_or_else(|| search.no_rows(&name, rate, &core, options)),
        ),
    };
    let told = [recording.lost(), recording.not_finite()];
    let mut failures = told.into_iter().flatten().map(Failure::from).chain(failure);
    let Some(mut last) = failures.next() else {
        return Ok(());
    };
    rows.flush()?;
    for next in failures {
        eprintln!("error: {last}");
        last = next;
    }
    Err(last)
}

/// The rate that was asked for, or else the recording's own.
fn sample_rate(name: &str, asked: Option<f64>, own: Option<f64>) -> Result<f64, Failure> {
    match (asked, own) {
        (Some(rate), _) => Ok(rate),
        (None, Some(rate)) if (1.0..=1e10).contains(&rate) => Ok(rate),
        (None, Some(rate)) => Err(Failure::Recording(format!(
            "{name}: its own sample rate of {rate} Hz is absurd; give the true one as --rate HZ"
        ))),
        (None, None) => Err(Failure::Recording(format!(
            "{name}: the sample rate is not known: the recording does not say it; give --rate HZ"
        ))),
    }
}

/// Samples of the longest period that may come, a little more of a known one.
fn longest(settings: &Settings) -> usize {
    let known = |frequency| (1.1 * settings.sample_rate / f64::from(frequency)) as usize + 1;
    settings.frequency.map_or(SEARCHED, known)
}

/// A progress bar where a person watches and rows go elsewhere.
fn progress(recording: &Recording) -> ProgressBar {
    match recording.bytes_total() {
        Some(total) if total > LONG && !io::stdout().is_terminal() => {
            let style = ProgressStyle::with_template(
                "{wide_bar} {bytes}/{total_bytes} {bytes_per_sec} {eta}",
            );
            ProgressBar::new(total)
                .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        }
        _ => ProgressBar::hidden(),
    }
}

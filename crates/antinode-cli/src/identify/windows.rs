//! Turns the samples of a recording into rows, and reports what was noticed once all are read.

use std::io::Write;

use antinode::{Estimate, SettingsError};

use super::first_pairs::{FirstPairs, other_frequency, ramp};
use super::options::{Identify, Shown};
use super::remarks::Remarks;
use super::residual::Residual;
use super::search::Search;
use super::search::unsearched_wave::alias;
use super::span::{Span, Step};
use super::stop::Stop;
use super::{Core, LONGEST_PERIOD, SHORTEST_PERIOD, is_pipe};
use crate::digits::significant;
use crate::failure::Failure;
use crate::methods::History;
use crate::recording::Recording;
use crate::rows::Rows;
use crate::tell::tell;

/// Samples in the longest period that is searched.
const LONGEST_SEARCHED: usize = 200;

/// Pairs between two looks at the search: too few for a period to be found and refused unseen.
const WATCHED_PAIRS: usize = 8;

/// Fewest and most pairs before a pipe's early warnings, else a second's: fewer may be alike by chance, more are not needed.
const EARLY_PAIRS: [f64; 2] = [64.0, 1e6];

/// The identification of one recording.
pub(super) struct Windows<'a> {
    name: &'a str,
    options: &'a Identify,
    rate: f64,
    core: Box<Core>,
    history: Option<History>,
    first: FirstPairs,
    search: Search,
    span: Span,
    remarks: Remarks,
    /// The pair after which a pipe, which may never end, gets its early warnings; `None` once they are given, and for a file.
    early: Option<u64>,
    stop: &'a Stop,
    residual: &'a Residual,
}

impl<'a> Windows<'a> {
    /// The identification of a recording of this name and sample rate.
    pub fn new(
        name: &'a str,
        options: &'a Identify,
        recording: &Recording,
        rate: f64,
        stop: &'a Stop,
        residual: &'a Residual,
    ) -> Result<Self, Failure> {
        let settings = options.settings(rate, recording.full_scale(), recording.resolution());
        let core = Core::new(settings).map_err(|error| match error {
            SettingsError::Frequency(frequency)
            | SettingsError::FrequencyTooLow { frequency, .. } => Failure::Usage(format!(
                "{name}: --frequency: {frequency} Hz is out of range: at a sample rate of {rate} Hz it must be {} to {} Hz, \
                 {LONGEST_PERIOD} to {SHORTEST_PERIOD} samples a period{}",
                significant(rate / LONGEST_PERIOD as f64, 7),
                rate / SHORTEST_PERIOD,
                alias(f64::from(frequency), rate)
            )),
            error => error.into(),
        })?;
        // A known frequency may be off.
        let known = |frequency| (1.1 * rate / f64::from(frequency)) as usize + 1;
        let longest = options.frequency.map_or(LONGEST_SEARCHED, known);
        let history = (options.methods == Shown::All).then(|| History::new(&settings, longest));
        Ok(Self {
            name,
            options,
            rate,
            core: Box::new(core),
            history,
            first: FirstPairs::default(),
            search: Search::default(),
            span: Span::new(options, recording, rate),
            remarks: Remarks::new(options, recording, settings),
            early: is_pipe(recording).then(|| rate.clamp(EARLY_PAIRS[0], EARLY_PAIRS[1]) as u64),
            stop,
            residual,
        })
    }

    /// Sample pairs identified, lost ones counted.
    pub fn pairs(&self) -> u64 {
        self.core.index()
    }

    /// Identifies the next pairs of the recording, and prints the rows that they complete; false at the end of the span.
    pub fn take(
        &mut self,
        recording: &mut Recording,
        mut pairs: &[[f32; 2]],
        rows: &mut Rows<impl Write>,
    ) -> Result<bool, Failure> {
        while !pairs.is_empty() {
            let mut most = match self.span.step(recording, pairs) {
                Step::End => return Ok(false),
                Step::Leave(count) => {
                    pairs = &pairs[count..];
                    continue;
                }
                Step::Lost(lost) => {
                    self.core.skip(lost);
                    self.residual.skip(lost);
                    self.remarks.interrupt();
                    if let Some(history) = &mut self.history {
                        history.skip(lost);
                    }
                    continue;
                }
                Step::Take(most) => most,
            };
            if let Some(first) = self.first.see(&pairs[..most]) {
                self.begin(&first)?;
            }
            // Until the first row, the search is watched closely.
            if rows.count() == 0 {
                most = most.min(WATCHED_PAIRS);
            }
            let (taken, estimate) = self.core.push_slice(&pairs[..most]);
            self.search.see(self.core.is_searching());
            self.first.pass(taken);
            let (new, rest) = pairs.split_at(taken);
            pairs = rest;
            recording.look(self.span.take(taken), new);
            if rows.count() == 0 && self.core.is_searching() {
                self.search.look(new);
            }
            self.remarks.see(new);
            self.residual.extend(new, self.span.offset());
            if let Some(history) = &mut self.history {
                history.extend(new);
            }
            if let Some(estimate) = estimate {
                self.print(&estimate, rows)?;
            }
        }
        let pairs = self.core.index();
        if self.early.take_if(|due| pairs >= *due).is_some() {
            let step = recording.resolution_so_far();
            for warning in self.remarks.early_warnings(step) {
                rows.flush()?;
                tell(format_args!("warning: {}: so far {warning}", self.name));
            }
        }
        Ok(true)
    }

    /// Checks the first pairs; fails if they come from no pick-off.
    fn begin(&mut self, pairs: &[[f32; 2]]) -> Result<(), Failure> {
        let name = self.name;
        if let Some(channel) = ramp(pairs) {
            return Err(Failure::Fault(format!(
                "{name}: {channel} rises in equal steps, as a time or a counter does: give only the two signals (see --columns)"
            )));
        }
        self.search.begin(pairs);
        if let Some(frequency) = self.options.frequency
            && let Some(warning) = other_frequency(pairs, self.rate, frequency)
        {
            tell(format_args!("warning: {name}: {warning}"));
        }
        Ok(())
    }

    fn print(&mut self, estimate: &Estimate, rows: &mut Rows<impl Write>) -> Result<(), Failure> {
        let history = self.history.as_ref();
        let methods = history.and_then(|history| history.compare(estimate));
        self.remarks.row(estimate);
        self.residual.row(estimate);
        self.stop.see(estimate.flags);
        let estimate = Estimate {
            time: estimate.time + self.span.offset(),
            ..*estimate
        };
        rows.print(self.name, &estimate, methods.as_ref())?;
        Ok(())
    }

    /// Reports the warnings and faults of a recording that was read as far as was asked, or up to a fault.
    pub fn conclude(
        mut self,
        recording: &Recording,
        fault: Option<Failure>,
        rows: &mut Rows<impl Write>,
    ) -> Result<(), Failure> {
        // Rows come before the warnings about them.
        let flushed = rows.flush().map_err(Failure::from);
        if matches!(flushed, Err(Failure::Closed)) {
            return flushed;
        }
        self.stop.report(self.remarks.is_cause_known());
        let first = self.first.rest();
        let mistaken = first.and_then(|first| self.begin(&first).err());
        let name = self.name;
        let late = recording.late_warnings();
        let seconds = self.core.index() as f64 / self.rate;
        let span = self.span.warning().filter(|_| fault.is_none());
        let step = recording.resolution_so_far();
        let remarks = self.remarks.warnings(step, &self.span, seconds);
        let scale = self.search.scale_warning().filter(|_| rows.count() > 0);
        for warning in late.chain(span).chain(remarks).chain(scale) {
            tell(format_args!("warning: {name}: {warning}"));
        }
        let unwritten = self.residual.finish().err();
        let failure = match fault {
            Some(error) => Some(error),
            None if flushed.is_err() => flushed.err(),
            None if rows.count() > 0 || mistaken.is_some() => None,
            None => Some(self.span.missing(name).unwrap_or_else(|| {
                let equal = &self.remarks.equal_samples;
                let why = self
                    .search
                    .no_rows(self.rate, &self.core, self.options, equal);
                Failure::Fault(format!("{name}: {why}"))
            })),
        };
        let missing = [recording.lost(), recording.not_finite()];
        let missing = missing.into_iter().flatten();
        let mut failures = missing.chain(mistaken).chain(unwritten).chain(failure);
        let Some(mut last) = failures.next() else {
            return Ok(());
        };
        for next in failures {
            tell(format_args!("error: {last}"));
            last = next;
        }
        Err(last)
    }
}

//! A recording's samples become rows: what is done with each stretch of pairs, and what is told once all are read.

use std::io::Write;

use antinode::{Estimate, SettingsError};

use super::first_pairs::{FirstPairs, elsewhere, straight};
use super::options::{Identify, Methods};
use super::remarks::Remarks;
use super::search::Search;
use super::search::unsearched_wave::alias;
use super::span::{Span, Step};
use super::stop::Stop;
use super::{Core, LONGEST, SHORTEST, is_pipe};
use crate::failure::Failure;
use crate::methods::History;
use crate::recording::Recording;
use crate::rows::Rows;

/// Samples of the longest period that is searched.
const SEARCHED: usize = 200;

/// Pairs between two looks at the search: no period is found and refused in fewer.
const GLANCE: usize = 8;

/// The least and the most pairs before a pipe is told of something early: fewer may be alike by chance, and more need no second.
const EARLY: [f64; 2] = [64.0, 1e6];

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
    /// From this pair on, after a second, a pipe is told what a file is told at its end, which a pipe may not have.
    early: Option<u64>,
    stop: &'a Stop,
}

impl<'a> Windows<'a> {
    /// Of a recording of this name and sample rate.
    pub fn new(
        name: &'a str,
        options: &'a Identify,
        recording: &Recording,
        rate: f64,
        stop: &'a Stop,
    ) -> Result<Self, Failure> {
        let settings = options.settings(rate, recording.full_scale(), recording.resolution());
        let core = Core::new(settings).map_err(|error| match error {
            SettingsError::Frequency(frequency)
            | SettingsError::FrequencyTooLow { frequency, .. } => Failure::Usage(format!(
                "{name}: --frequency: {frequency} Hz, but at {rate} Hz it must lie within {:.6} to {} Hz, {LONGEST} to {SHORTEST} samples a period{}",
                rate / LONGEST as f64,
                rate / SHORTEST,
                alias(f64::from(frequency), rate)
            )),
            error => error.into(),
        })?;
        // A little more of a period that is known.
        let known = |frequency| (1.1 * rate / f64::from(frequency)) as usize + 1;
        let longest = options.frequency.map_or(SEARCHED, known);
        let history = (options.methods == Methods::All).then(|| History::new(&settings, longest));
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
            early: is_pipe(recording).then(|| rate.clamp(EARLY[0], EARLY[1]) as u64),
            stop,
        })
    }

    /// Sample pairs identified, lost ones counted.
    pub fn pairs(&self) -> u64 {
        self.core.index()
    }

    /// Takes the next pairs of the recording, and prints the rows that they complete; false where no more are asked for.
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
            // Until the first row, what becomes of the search is to be seen.
            if rows.count() == 0 {
                most = most.min(GLANCE);
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
            for told in self.remarks.told_early(step) {
                rows.flush()?;
                eprintln!("warning: {}: so far {told}", self.name);
            }
        }
        Ok(true)
    }

    /// Looks at the first pairs that are identified.
    fn begin(&mut self, pairs: &[[f32; 2]]) -> Result<(), Failure> {
        let name = self.name;
        if let Some(channel) = straight(pairs) {
            return Err(Failure::Fault(format!(
                "{name}: {channel} goes up in equal steps, as a time or a counter does: give the two signals alone"
            )));
        }
        self.search.begin(pairs);
        if let Some(frequency) = self.options.frequency
            && let Some(warning) = elsewhere(pairs, self.rate, frequency)
        {
            eprintln!("warning: {name}: {warning}");
        }
        Ok(())
    }

    fn print(&mut self, estimate: &Estimate, rows: &mut Rows<impl Write>) -> Result<(), Failure> {
        let history = self.history.as_ref();
        let methods = history.and_then(|history| history.compare(estimate));
        self.remarks.row(estimate);
        self.stop.see(estimate.flags);
        let estimate = Estimate {
            time: estimate.time + self.span.offset(),
            ..*estimate
        };
        rows.print(self.name, &estimate, methods.as_ref())?;
        Ok(())
    }

    /// Tells what is to be known of a recording that was read as far as was asked, or up to a fault.
    pub fn conclude(
        mut self,
        recording: &Recording,
        fault: Option<Failure>,
        rows: &mut Rows<impl Write>,
    ) -> Result<(), Failure> {
        // Rows before what is told of them.
        let flushed = rows.flush().map_err(Failure::from);
        if matches!(flushed, Err(Failure::Closed)) {
            return flushed;
        }
        self.stop.tell(self.remarks.why().is_some());
        let first = self.first.rest();
        let mistaken = first.and_then(|first| self.begin(&first).err());
        let name = self.name;
        if let Some(warning) = recording.late_warning() {
            eprintln!("warning: {warning}");
        }
        let seconds = self.core.index() as f64 / self.rate;
        let span = self.span.warning().filter(|_| fault.is_none());
        let step = recording.resolution_so_far();
        let remarks = self.remarks.told(step, &self.span, seconds);
        let scale = self.search.scale().filter(|_| rows.count() > 0);
        for warning in span.into_iter().chain(remarks).chain(scale) {
            eprintln!("warning: {name}: {warning}");
        }
        let failure = match fault {
            Some(error) => Some(error),
            None if flushed.is_err() => flushed.err(),
            None if rows.count() > 0 || mistaken.is_some() => None,
            None => Some(self.span.missing(name).unwrap_or_else(|| {
                let constant = &self.remarks.constant_pick_off;
                let why = self
                    .search
                    .no_rows(self.rate, &self.core, self.options, constant);
                Failure::Fault(format!("{name}: {why}"))
            })),
        };
        let told = [recording.lost(), recording.not_finite()];
        let told = told.into_iter().flatten().map(Failure::from);
        let mut failures = told.chain(mistaken).chain(failure);
        let Some(mut last) = failures.next() else {
            return Ok(());
        };
        for next in failures {
            eprintln!("error: {last}");
            last = next;
        }
        Err(last)
    }
}

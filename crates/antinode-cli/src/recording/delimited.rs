//! Text recordings: one pair a line, with or without the time before it.

mod doubts;
mod fields;
mod rows;

use super::error::{Fault, TIME};
use super::gaps::{Found, Gap, Gaps, are_lost};
use super::not_finite::Flaw;
use super::time::{Meaning, TimeAxis, are_paired, roundest, standstill};
use super::{OpenOptions, Opened, Source, Stream, first_of};
use rows::{Row, Rows};

/// Lines read ahead if there is a time column, to find the sample rate from times that are rounded by printing.
const HEAD_LINES: u64 = 1 << 16;

/// Lines read ahead if there is no time column: enough to tell whether they hold numbers.
const FEW_LINES: u64 = 16;

/// Lines read ahead if there is one, on a live stream of a known rate.
const LIVE_LINES: u64 = 1 << 10;

/// What is wrong if each time stands in two lines.
const PAIRED: &str = "each time stands in two lines; if these are a minimum and a maximum (peak detect, envelope), record or export single \
                      samples; if times are rounded, print more digits";

/// Opens text; pairs of a `live` stream, a pipe, are delivered as they come.
pub(super) fn open(stream: Stream, options: &OpenOptions, live: bool) -> Result<Opened, Fault> {
    let mut source = Delimited {
        rows: Rows::open(stream, options.columns.as_ref())?,
        start: 0.0,
        gaps: Gaps::default(),
        left_out: 0,
        live,
        used: None,
        ahead: Vec::new().into_iter(),
        fault: None,
    };
    if options.rate.is_none() {
        source.rows.header.use_stated_rate();
    }
    source.read_ahead(match source.rows.header.places[TIME] {
        None => FEW_LINES,
        Some(_) if live && options.rate.is_some() => LIVE_LINES,
        Some(_) => HEAD_LINES,
    })?;
    if source.ahead.len() == 0 {
        return Err(source.fault.take().unwrap_or_else(Fault::no_pairs));
    }
    let (sample_rate, start) = (source.rate(), source.start());
    if live && options.rate.or(sample_rate).is_none() {
        // A fault may be why the rate is unknown; a pipe may have no more lines yet.
        if let Some(fault) = source.fault.take() {
            return Err(fault);
        }
    }
    let axis = source.times();
    let meaning = match (source.rows.header.sequence, sample_rate) {
        (Some(_), Some(own)) => Some(Meaning::of_rate(own, options.rate)),
        _ => axis.map(|axis| axis.meaning(source.rows.printed, options.rate)),
    };
    let is_time = matches!(meaning, Some(Meaning::Time | Meaning::PerhapsIndex));
    if is_time && source.rows.header.sequence.is_none() {
        source.used = options.rate.or(sample_rate);
    }
    let mut warnings = std::mem::take(&mut source.rows.header.warnings);
    warnings.extend(meaning.and_then(|meaning| source.warning(meaning)));
    Ok(Opened {
        format: "CSV".to_owned(),
        sample_rate,
        absurd: sample_rate.and_then(|own| source.absurd(own)),
        start: if meaning == Some(Meaning::Index) {
            0.0
        } else {
            start
        },
        warnings,
        source: Source::Text(Box::new(source)),
        pairs: None,
        integers: None,
    })
}

/// A source of pairs from lines of numbers.
pub(super) struct Delimited {
    rows: Rows,
    /// The first number in the time column, or 0 if there is none.
    start: f64,
    pub gaps: Gaps,
    /// The lines left out since the last pair.
    left_out: u64,
    live: bool,
    /// The rate in use, Hz, if the time column is taken for times.
    used: Option<f64>,
    /// Pairs read ahead to find the sample rate, not yet delivered.
    ahead: std::vec::IntoIter<[f32; 2]>,
    /// The fault behind the last of them.
    fault: Option<Fault>,
}

impl Delimited {
    /// Reads as many lines as it takes to find the sample rate, and checks their times.
    fn read_ahead(&mut self, mut head: u64) -> Result<(), Fault> {
        self.rows.find_counter(FEW_LINES as usize)?;
        let mut times = Vec::new();
        if self.rows.header.places[TIME].is_some() && self.rows.axis.is_none() {
            times = self.rows.look_ahead(head as usize)?;
            // Few lines show no rate if times are rounded to several samples; of others that show none, more lines show none either.
            let are_coarse = self.rows.axis.is_none() && times.is_sorted() && !are_paired(&times);
            if are_coarse && head < HEAD_LINES {
                head = HEAD_LINES;
                times = self.rows.look_ahead(head as usize)?;
            }
        }
        let standing = if are_paired(&times) {
            Some((0, PAIRED.to_owned()))
        } else if self.rows.axis.is_none() {
            standstill(&times, self.rows.printed)
        } else {
            None
        };
        let start = self.times().map(TimeAxis::start);
        let start = start.or(times.first().copied());
        self.start = start.map_or(0.0, |start| self.rows.printed.absolute(start));
        let (mut pairs, mut broken) = (Vec::new(), None);
        while self.rows.read < head && !self.rows.begin_garbled() && self.fault.is_none() {
            match self.rows.next() {
                Ok(Some(Row::LeftOut)) => self.left_out += 1,
                Ok(Some(Row::Pair(time, pair))) => {
                    let before = pairs.len() as u64;
                    pairs.push(pair);
                    if broken.is_some() {
                        continue;
                    }
                    let fault = match (&standing, time) {
                        (Some((at, fault)), _) if *at as u64 == before => {
                            let line = self.rows.lines.number();
                            Err(self.rows.header.time_fault(line, fault))
                        }
                        (_, Some(time)) => self.check(time),
                        _ => Ok(()),
                    };
                    broken = fault.err().map(|fault| (before, fault));
                }
                Ok(None) => break,
                Err(fault) => self.fault = Some(fault),
            }
        }
        let garbled = self.rows.mostly_garbled();
        let faults = broken.into_iter().chain(garbled);
        if let Some((pair, fault)) = faults.min_by_key(|&(pair, _)| pair) {
            pairs.truncate(pair as usize);
            self.fault = Some(fault);
        }
        self.ahead = pairs.into_iter();
        Ok(())
    }

    /// The sample rate, Hz, by the times or else by the header.
    fn rate(&self) -> Option<f64> {
        let by_times = self.times().map(TimeAxis::rate);
        match self.rows.header.sequence {
            Some(sequence) => Some(roundest(by_times.unwrap_or(1.0) / sequence.step, 0.0)),
            None => by_times,
        }
    }

    /// Whether the samples are counted, and have no times.
    fn is_counted(&self) -> bool {
        self.rows.header.counter.is_some()
    }

    /// The times of the samples: a count shows which samples are missing, and no more.
    fn times(&self) -> Option<&TimeAxis> {
        self.rows.axis.as_ref().filter(|_| !self.is_counted())
    }

    /// The first sample's time, s.
    fn start(&self) -> f64 {
        match self.rows.header.sequence {
            Some(sequence) if self.rows.axis.is_some() || !sequence.is_counted => {
                sequence.seconds(self.start)
            }
            _ => self.start,
        }
    }

    /// Checks the time of the pair last read, and records a gap before it.
    fn check(&mut self, time: f64) -> Result<(), Fault> {
        let left_out = std::mem::take(&mut self.left_out);
        let before = self.rows.pairs - 1;
        let Some(axis) = self.rows.axis.as_mut().filter(|_| before > 0) else {
            return Ok(());
        };
        let line = self.rows.lines.number();
        let last = axis.last();
        let lost = axis.check(time, self.rows.printed);
        if lost.is_err() && self.is_counted() {
            // A count that begins anew tells nothing.
            self.rows.ignore_counter();
            return Ok(());
        }
        let lost = lost.map_err(|fault| self.rows.header.time_fault(line, &fault))?;
        if lost > 0 {
            let sequence = self.rows.header.sequence;
            let times = [last, time].map(|time| {
                let time = self.rows.printed.absolute(time);
                sequence.map_or(time, |sequence| sequence.seconds(time))
            });
            self.gaps.add(Found {
                gap: Gap { before, lost },
                line,
                times,
                is_explained: lost <= left_out,
            });
        }
        Ok(())
    }

    /// Appends pairs until there are `capacity`, as [`Source::fill`] says.
    pub fn fill(&mut self, pairs: &mut Vec<[f32; 2]>, capacity: usize) -> Result<(), Fault> {
        let room = capacity.saturating_sub(pairs.len());
        pairs.extend(self.ahead.by_ref().take(room));
        if self.is_held_up(pairs) {
            return Ok(());
        }
        while pairs.len() < capacity {
            if let Some(fault) = self.fault.take() {
                return Err(fault);
            }
            let Some(row) = self.rows.next()? else {
                break;
            };
            if let Row::Pair(Some(time), _) = row {
                self.check(time)?;
            }
            if let Some((_, fault)) = self.rows.mostly_garbled() {
                return Err(fault);
            }
            match row {
                Row::LeftOut => self.left_out += 1,
                Row::Pair(_, pair) => pairs.push(pair),
            }
            if self.is_held_up(pairs) {
                break;
            }
        }
        Ok(())
    }

    /// Whether these pairs of a live stream would be held up by its next line.
    fn is_held_up(&self, pairs: &[[f32; 2]]) -> bool {
        self.live && !pairs.is_empty() && self.rows.lines.is_drained()
    }

    /// Pairs that are read ahead and not yet delivered.
    pub fn ahead(&self) -> &[[f32; 2]] {
        self.ahead.as_slice()
    }

    /// Notes that the pairs from `start` up to `end` are asked for: lines left out among them are reported at the end.
    pub fn look(&mut self, start: u64, end: u64) {
        self.rows.left_out.look(start, end);
    }

    /// The fault to report at the end for samples that are missing and lines that are left out.
    pub fn lost(&self) -> Option<Fault> {
        if let Some((first, count)) = self.rows.left_out.reported() {
            let lost = self.gaps.reported().map_or(String::new(), |(line, lost)| {
                format!(", and before line {line} {}", are_lost(lost))
            });
            let told = format!(
                "{}: the line is left out{}{lost}; \
                 rows whose window lacks a sample are missing, all others are good; check the instrument or program that wrote it",
                first.description,
                first_of(count)
            );
            return Some(Fault::at(first.place, told));
        }
        let (line, fault) = self.gaps.fault(self.is_counted())?;
        Some(self.rows.header.time_fault(line, &fault))
    }

    /// The warnings about the samples delivered that could not be given before.
    pub fn late_warnings(&self) -> impl Iterator<Item = String> {
        let warnings = |axis: &TimeAxis| [axis.late_warning(self.used), axis.coarse_warning()];
        self.times().map(warnings).into_iter().flatten().flatten()
    }

    /// The flaw of the sample in this pair that is not a finite number, with its place, if it is the first of all or the first behind pairs
    /// without values.
    pub fn not_finite(&self, pair: u64) -> Option<&Flaw> {
        let mut known = self.rows.not_finite.iter().flatten();
        known.find(|flaw| flaw.pair == pair)
    }

    /// Whether a line was met that holds something else than numbers and what stands for missing ones.
    pub fn is_garbled(&self) -> bool {
        self.rows.is_garbled()
    }
}

#[cfg(test)]
mod tests;

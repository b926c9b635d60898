//! Which samples of a recording are identified: `--from` and `--to`.

use super::options::Identify;
use crate::digits::decimals_of_times;
use crate::failure::Failure;
use crate::recording::Recording;

/// Rounding of a time, in samples, that is allowed for at least, and at most: times since 1970 have steps of 2.4·10⁻⁷ s.
const ROUNDING: [f64; 2] = [1e-3, 0.5];

/// Resolution of a time, in periods, below which it still gives the phase: 10⁻³ rad.
const MAX_TIME_STEP: f64 = 1.6e-4;

/// What to do with the next pairs.
pub(super) enum Step {
    /// This many samples are missing before them.
    Lost(u64),
    /// This many of them lie before the span.
    Leave(usize),
    /// This many of them are to be identified.
    Take(usize),
    /// The rest of the recording is not asked for.
    End,
}

/// The samples to identify, and how far the recording is read.
pub(super) struct Span {
    asked: [Option<f64>; 2],
    rate: f64,
    /// The time of the sample numbered 0, s.
    start: f64,
    /// The numbers of the first sample, and of the one after the last.
    first: u64,
    end: u64,
    /// The pairs passed, and the number of the next one; numbers include lost samples.
    pairs: u64,
    number: u64,
    /// The number of the first pair that was identified.
    begun: Option<u64>,
}

impl Span {
    /// The span that is asked for, of a recording of this sample rate.
    pub fn new(options: &Identify, recording: &Recording, rate: f64) -> Self {
        let start = recording.opened.start;
        let [least, most] = ROUNDING;
        let number = |time: f64| {
            let rounding = (f64::EPSILON * time.abs() * rate).clamp(least, most);
            ((time - start) * rate - rounding).ceil().max(0.0) as u64
        };
        Self {
            asked: [options.from, options.to],
            rate,
            start,
            first: options.from.map_or(0, number),
            end: options.to.map_or(u64::MAX, number),
            pairs: 0,
            number: 0,
            begun: None,
        }
    }

    /// What to do with the next `pairs` of a recording.
    pub fn step(&mut self, recording: &mut Recording, pairs: &[[f32; 2]]) -> Step {
        let mut most = pairs.len();
        if let Some(gap) = recording.next_gap() {
            if gap.before == self.pairs {
                self.number += gap.lost;
                let is_within = self.begun.is_some() && self.number < self.end;
                recording.pass_gap(is_within);
                return if is_within {
                    Step::Lost(gap.lost)
                } else {
                    Step::Leave(0)
                };
            }
            most = most.min(usize::try_from(gap.before - self.pairs).unwrap_or(most));
        }
        let up_to = |number: u64| {
            usize::try_from(number - self.number)
                .unwrap_or(most)
                .min(most)
        };
        if self.number < self.first {
            let most = up_to(self.first);
            self.pass(most);
            Step::Leave(most)
        } else if self.number < self.end {
            Step::Take(up_to(self.end))
        } else {
            Step::End
        }
    }

    /// Notes that the next pairs are identified, and returns how many pairs of the recording came before them.
    pub fn take(&mut self, pairs: usize) -> u64 {
        self.begun.get_or_insert(self.number);
        self.pass(pairs)
    }

    fn pass(&mut self, pairs: usize) -> u64 {
        let before = self.pairs;
        self.pairs += pairs as u64;
        self.number += pairs as u64;
        before
    }

    /// The time of the first pair identified, s.
    pub fn offset(&self) -> f64 {
        self.time(self.begun.unwrap_or(0))
    }

    fn time(&self, number: u64) -> f64 {
        self.start + number as f64 / self.rate
    }

    /// A warning if times are too coarse to give the phase of a wave of this frequency, Hz.
    pub fn coarse_time(&self, frequency: f64) -> Option<String> {
        let start = self.offset();
        let step = start.abs() * f64::EPSILON;
        (step * frequency > MAX_TIME_STEP).then(|| {
            format!(
                "time begins at {start} s, where `time_s` has steps of {step:.0e} s, too coarse for use with `phase_rad`; count time from the \
                 recording's start"
            )
        })
    }

    /// The failure if the recording, read as far as was asked, has no sample in the span.
    pub fn missing(&self, name: &str) -> Option<Failure> {
        let (start, end) = (self.start, self.time(self.number));
        let decimals = decimals_of_times(self.rate);
        let told = match self.asked {
            _ if self.begun.is_some() => return None,
            [_, Some(to)] if self.end == 0 => {
                format!("--to {to} s: the recording begins only at {start} s; give a later time")
            }
            [Some(from), _] if self.number <= self.first => {
                format!(
                    "--from {from} s: the recording goes from {start} s to {end:.decimals$} s; give a time within it"
                )
            }
            [Some(from), Some(to)] => {
                format!(
                    "--from {from} --to {to}: all samples in this span are lost; give another span"
                )
            }
            _ => return None,
        };
        Some(Failure::Fault(format!("{name}: {told}")))
    }

    /// A warning if the recording has only a part of the span.
    pub fn warning(&self) -> Option<String> {
        let (begins, ends) = (self.start, self.time(self.number));
        let decimals = decimals_of_times(self.rate);
        let early = self.asked[0].filter(|&from| (begins - from) * self.rate > 0.5);
        let late = self.asked[1].filter(|_| self.number < self.end);
        let early = early.map(|from| format!("begins at {begins} s, after --from {from} s"));
        let late = late.map(|to| format!("ends at {ends:.decimals$} s, before --to {to} s"));
        let told: Vec<String> = early.into_iter().chain(late).collect();
        (self.begun.is_some() && !told.is_empty())
            .then(|| format!("the recording {}", told.join(", and ")))
    }
}

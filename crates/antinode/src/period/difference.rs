//! Period by the squared difference of the signals from themselves a lag before, formula (10).
//!
//! D(T) = Σ |S(t) − S(t−T)|² over both pick-offs has its first minimum after its first maximum at the period, whatever the
//! offsets. All lags from 4 to 200 samples would cost hundreds of products a sample. Here the stream is halved again and again,
//! each octave sees lags of 1 to 10 of its own samples, and so all octaves together cost no more than twenty lags.

use super::PERIODS;
use super::attempt::{Attempt, Verdict};
use crate::phase::Phase;
use crate::sample::{Sample, SamplePair};

/// Lags of an octave.
pub(crate) const LAGS: usize = 10;
/// Samples of a frame: more than three of the longest periods of its octave.
pub(crate) const FRAME: usize = 32;
/// Octaves: periods of 4 to 8, 8 to 16, … 128 to 256 samples.
const OCTAVES: usize = 6;
/// Periods that an octave answers for, in its own samples: wider than an octave, so that neighbours overlap.
const RANGE: core::ops::RangeInclusive<f32> = 3.7..=9.2;
/// Periods that a trial may end with, from one proposed within the range.
const FOUND: core::ops::RangeInclusive<f32> = 3.5..=9.6;
/// Power lost by halving beyond the wave's own, as a share of the wave's: noise of 20 % loses 0.2.
const STRANGER: f32 = 0.4;
/// Periods that a frame must hold before it is tried.
const HELD: f32 = 2.2;
/// Samples of a frame before its D(T) is looked at, and while it is looked at with every second one; later with every fourth.
const LEAST: u16 = 10;
const OFTEN: u16 = 22;

/// D(1)…D(10), not yet divided by the count of pairs in each.
pub(crate) type Lags<S> = [<S as Sample>::Square; LAGS];

/// One octave of the stream: a frame of samples and its D(T).
#[derive(Debug, Clone, Copy)]
struct Octave<S: Sample> {
    frame: [[S; 2]; FRAME],
    /// Samples in the frame; of an odd count the last is not in D(T) yet.
    count: u16,
    /// D(T) over the frame so far.
    differences: Lags<S>,
    /// D(1) of the last frame.
    last: S::Square,
    pace: Pace,
}

/// What an octave makes of the wave of its frame. As wide as the count: padding would be cleared apart, through a copy on the stack.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u16)]
enum Pace {
    /// It may be the octave's own.
    Own,
    /// Too slow for this octave: only D(1) goes on.
    Slow,
}

impl<S: Sample> Octave<S> {
    fn new() -> Self {
        Self {
            frame: [[S::default(); 2]; FRAME],
            count: 0,
            differences: Lags::<S>::default(),
            last: S::Square::default(),
            pace: Pace::Own,
        }
    }

    fn restart(&mut self) {
        self.count = 0;
        // What the frame before the first lost.
        self.differences[0] = S::Square::default();
    }

    /// Takes a sample; gives the next octave's at every second one, and only then is D(T) whole.
    #[inline(always)]
    fn push(&mut self, sample: [S; 2]) -> Option<[S; 2]> {
        let place = usize::from(self.count) % FRAME;
        self.frame[place] = sample;
        self.count = place as u16 + 1;
        (!place.is_multiple_of(2)).then(|| self.compare(place - 1, sample))
    }

    /// Takes two samples into D(T): what is before them is read once for both. Gives their mean.
    #[inline(never)]
    fn compare(&mut self, place: usize, second: [S; 2]) -> [S; 2] {
        let (before, first) = match self.frame.split_at_checked(place) {
            Some((before, [first, ..])) => (before, *first),
            _ => (&[][..], second),
        };
        let before = match before {
            [] => {
                self.last = self.differences[0];
                self.pace = Pace::Own;
                before
            }
            [.., a, b] if self.pace == Pace::Slow => &[*a, *b],
            _ => before,
        };
        S::add_differences(&mut self.differences, [first, second], before);
        S::mean(first, second)
    }

    /// Power that halving takes away: the mean square of half a difference of neighbours.
    fn lost(&self) -> f32 {
        let (sum, count) = if self.count >= 8 {
            (self.differences[0], f32::from(self.count) - 1.0)
        } else {
            (self.last, FRAME as f32 - 1.0)
        };
        0.25 * S::square_to_f32(sum) / count
    }

    /// True when enough samples are new to look at D(T), after an even count of them.
    #[inline(always)]
    fn is_due(&self) -> bool {
        self.pace == Pace::Own
            && self.count >= LEAST
            && (self.count <= OFTEN || self.count.is_multiple_of(4))
    }

    /// The first minimum of D(T) after its first maximum, between samples, where the frame is long enough for it.
    #[inline(never)]
    fn period(&mut self) -> Option<f32> {
        let (shift, count) = (S::shift(&self.differences), usize::from(self.count));
        let level = |lag: usize| S::level(self.differences[lag - 1], shift, count - lag);
        // Of a wave beyond this octave D(1) is next to nothing: above a fourteenth of D(7) within it, below at 13 samples and more.
        let sixteenth = S::halved(S::halved(S::halved(S::halved(level(7)))));
        if level(1) < sixteenth {
            self.pace = Pace::Slow;
            return None;
        }
        // A minimum lies within 0.6 of its lag: beyond these the frame cannot hold enough of it.
        let most = ((5 * count + 7) / 12).min(LAGS - 1);
        let (mut before, mut here) = (level(1), level(2));
        let mut greatest = if before < here { here } else { before };
        let mut lag = 2;
        while lag <= most {
            let after = level(lag + 1);
            if here < S::halved(greatest) && here <= before && here < after {
                return self.between(lag as f32, [before, here, after]);
            }
            if after > greatest {
                greatest = after;
            }
            (before, here) = (here, after);
            lag += 1;
        }
        None
    }

    /// The minimum of D(T) about a lag.
    #[inline(never)]
    fn between(&self, lag: f32, levels: [S::Level; 3]) -> Option<f32> {
        let [before, here, after] = levels.map(S::level_to_f32);
        // About its minimum D(T) = level − depth·cos ω(T − P): three lags give P.
        let ratio = (after - before) / (after + before - 2.0 * here);
        let omega = core::f32::consts::TAU / (lag - 0.5 * ratio);
        let half = Phase::from_radians(0.5 * omega).unit();
        let period = lag - libm::atan2f(ratio * half.im, half.re) / omega;
        (RANGE.contains(&period) && HELD * period <= f32::from(self.count)).then_some(period)
    }
}

/// A frame under trial, and what it was found under.
#[derive(Debug, Clone)]
struct Candidate<S: Sample> {
    is_open: bool,
    attempt: Attempt<S>,
    halvings: usize,
    /// Power that the octaves below lost.
    lost: f32,
}

impl<S: Sample> Candidate<S> {
    /// The period in samples of the stream, where halving took little of the wave found: it takes all of a faster one that folds
    /// down to the same period or hides it.
    fn accept(&self, period: f32, power: f32) -> Option<f32> {
        let scale = (1u32 << self.halvings.min(OCTAVES)) as f32;
        let found = period * scale;
        // cos ½t cos ¼t … is sin t over all halvings of t and the sine of what is left: a small angle.
        let turn = core::f32::consts::PI / period;
        let rest = turn / scale;
        let square = rest * rest;
        let least = turn * (1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0)));
        let whole = Phase::from_radians(turn).unit().im;
        let kept = whole * whole / (least * least);
        let is_whole = self.lost < power * (1.0 / kept - 1.0 + STRANGER);
        (is_whole && FOUND.contains(&period) && PERIODS.contains(&found)).then_some(found)
    }
}

/// The streaming detector of formula (10): periods of 4 to 200 samples, from cold, with any offset.
///
/// Work a sample: ten lags of an octave, on average of two octaves, and a few samples of a trial while there is a candidate; it is
/// done in integers on codes, but for the trial. White noise is taken for a wave with a chance below 10⁻⁹ a frame; a wave in 20 %
/// noise is found within about four periods, and never at a fraction or a multiple of its period.
#[derive(Debug, Clone)]
pub struct DifferenceDetector<S: Sample> {
    octaves: [Octave<S>; OCTAVES],
    /// The octaves that are still to take a sample, as bits, and their samples.
    waiting: u8,
    samples: [[S; 2]; OCTAVES],
    candidate: Candidate<S>,
}

impl<S: Sample> DifferenceDetector<S> {
    /// A detector at rest.
    pub fn new() -> Self {
        Self {
            octaves: [Octave::new(); OCTAVES],
            waiting: 0,
            samples: [[S::default(); 2]; OCTAVES],
            candidate: Candidate {
                is_open: false,
                attempt: Attempt::new(),
                halvings: 0,
                lost: 0.0,
            },
        }
    }

    /// Forgets all samples.
    pub fn restart(&mut self) {
        self.candidate.is_open = false;
        self.waiting = 0;
        for octave in &mut self.octaves {
            octave.restart();
        }
    }

    /// Takes a sample pair; gives the period in samples once it is sure.
    ///
    /// In one call one octave at most takes samples into its D(T) and one is looked at, the lowest first: an octave has half of the
    /// work of the one below, so all of them are done before their next samples come.
    pub fn push(&mut self, pair: impl SamplePair<S>) -> Option<f32> {
        let [first, ..] = &mut self.octaves;
        let due = if let Some(next) = first.push(pair.pair().map(S::search_form)) {
            let is_due = first.is_due();
            self.rise(0, next);
            is_due.then_some(0)
        } else if self.waiting > 0 {
            self.halve()
        } else {
            None
        };
        if self.candidate.is_open {
            return self.attempt();
        }
        if let Some(halvings) = due {
            self.look(halvings);
        }
        None
    }

    /// Keeps the sample that an octave gives to the next.
    #[inline(always)]
    fn rise(&mut self, halvings: usize, sample: [S; 2]) {
        if let Some(place) = self.samples.get_mut(halvings + 1) {
            *place = sample;
            self.waiting |= 2 << halvings;
        }
    }

    /// Gives the samples that wait to their octaves, up to the first that takes two of them into its D(T); gives that one where it is
    /// to be looked at.
    #[inline(never)]
    fn halve(&mut self) -> Option<usize> {
        while self.waiting > 0 {
            let halvings = self.waiting.trailing_zeros() as usize;
            self.waiting &= self.waiting - 1;
            let (Some(octave), Some(&sample)) =
                (self.octaves.get_mut(halvings), self.samples.get(halvings))
            else {
                return None;
            };
            if let Some(next) = octave.push(sample) {
                let is_due = octave.is_due();
                self.rise(halvings, next);
                return is_due.then_some(halvings);
            }
        }
        None
    }

    /// Looks at D(T) of an octave.
    #[inline(never)]
    fn look(&mut self, halvings: usize) {
        let octave = self.octaves.get_mut(halvings);
        if let Some(period) = octave.and_then(Octave::period) {
            self.propose(halvings, period);
        }
    }

    /// Goes on with the trial of the candidate.
    #[inline(never)]
    fn attempt(&mut self) -> Option<f32> {
        let candidate = &mut self.candidate;
        let period = match candidate.attempt.advance() {
            Verdict::Open => return None,
            Verdict::Refused => None,
            Verdict::Accepted(fitted) => candidate.accept(fitted.period, fitted.power),
        };
        candidate.is_open = false;
        period
    }

    /// Puts the frame of an octave on trial.
    #[inline(never)]
    fn propose(&mut self, halvings: usize, period: f32) {
        let below = self.octaves.iter().take(halvings);
        let lost = below.map(Octave::lost).sum();
        if let Some(octave) = self.octaves.get(halvings) {
            let candidate = &mut self.candidate;
            candidate
                .attempt
                .begin(&octave.frame, usize::from(octave.count), period);
            candidate.halvings = halvings;
            candidate.lost = lost;
            candidate.is_open = true;
        }
    }
}

impl<S: Sample> Default for DifferenceDetector<S> {
    fn default() -> Self {
        Self::new()
    }
}

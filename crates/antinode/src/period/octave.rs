//! One octave of the stream, and its D(T).

use num_complex::Complex32;

use crate::phase::{Phase, argument};
use crate::sample::{Arithmetic, Sample, Zero};

/// Lags of an octave.
pub(crate) const LAGS: usize = 10;
/// Samples of a frame: more than three of the longest periods of its octave.
pub(crate) const FRAME: usize = 32;
/// Periods that an octave answers for, in its own samples: wider than an octave, so that neighbours overlap.
const RANGE: core::ops::RangeInclusive<f32> = 3.7..=9.2;
/// Periods that a frame must hold before it is tried.
const HELD: f32 = 2.2;
/// Samples of a frame before its D(T) is looked at, and while it is looked at with every second one; later with every fourth.
const LEAST: u16 = 10;
const OFTEN: u16 = 22;

/// D(1)…D(10), not yet divided by the count of pairs in each.
pub(crate) type Lags<S> = [<S as Arithmetic>::Square; LAGS];
/// Two sample pairs that follow each other.
pub(super) type Two<S> = [[S; 2]; 2];
/// The samples of a frame.
pub(super) type Frame<S> = [Two<S>; FRAME / 2];

/// One octave of the stream: a frame of samples and its D(T).
#[derive(Debug, Clone, Copy)]
pub(super) struct Octave<S: Sample> {
    pub frame: Frame<S>,
    /// Samples in the frame; of an odd count the last is not in D(T) yet.
    pub count: u16,
    /// D(T) over the frame so far.
    differences: Lags<S>,
    /// Power that halving took away in the last frame.
    last: f32,
}

impl<S: Sample> Octave<S> {
    /// An octave of no samples.
    pub(super) const fn new() -> Self {
        Self {
            frame: [[[S::ZERO; 2]; 2]; FRAME / 2],
            count: 0,
            differences: [S::Square::ZERO; LAGS],
            last: 0.0,
        }
    }

    /// Forgets all samples.
    pub(super) fn restart(&mut self) {
        self.count = 0;
    }

    /// Keeps a sample; true when it is the second of two, which are to be taken into D(T) before the next comes.
    #[inline(always)]
    pub(super) fn keep(&mut self, sample: [S; 2]) -> bool {
        let place = usize::from(self.count) % FRAME;
        self.frame.as_flattened_mut()[place] = sample;
        self.count = place as u16 + 1;
        place % 2 == 1
    }

    /// Takes the last two samples into D(T): what is before them is read once for both. Gives their mean.
    #[inline(always)]
    pub(super) fn compare(&mut self) -> Option<[S; 2]> {
        let (&two, before) = self
            .frame
            .get(..usize::from(self.count) / 2)?
            .split_last()?;
        let [first, second] = two;
        add_lags::<S>(&mut self.differences, two, before);
        if usize::from(self.count) == FRAME {
            self.last = self.lost_so_far();
        }
        Some(S::mean(first, second))
    }

    /// Power that halving takes away: the mean square of half a difference of neighbours.
    #[inline(never)]
    pub(super) fn lost(&self) -> f32 {
        if self.count < 8 {
            self.last
        } else {
            self.lost_so_far()
        }
    }

    #[inline(always)]
    fn lost_so_far(&self) -> f32 {
        0.25 * S::square_to_f32(self.differences[0]) / (f32::from(self.count) - 1.0)
    }

    /// True when enough samples are new to look at D(T), after an even count of them.
    #[inline(always)]
    pub(super) fn is_due(&self) -> bool {
        self.count >= LEAST && (self.count <= OFTEN || self.count.is_multiple_of(4))
    }

    /// The first minimum of D(T) after its first maximum, between samples, where the frame is long enough for it.
    #[inline(never)]
    pub(super) fn period(&mut self) -> Option<f32> {
        let (shift, count) = (S::shift(&self.differences), usize::from(self.count));
        let level = |lag: usize| {
            let sum = self.differences.get(lag - 1).copied();
            S::level(sum.unwrap_or(S::Square::ZERO), shift, count - lag)
        };
        // Of a wave that is too slow for this octave D(T) still rises at its fourth lag, and at its sixth is not yet below its third: of
        // one that the next octave cannot hold, of less than 7.4 samples, D(6) is below 0.4 of D(3). The frame begins anew, for a
        // wave that began late in it looks slow as well.
        if level(4) > level(3) && level(6) > level(3) {
            self.last = self.lost_so_far();
            self.count = 0;
            return None;
        }
        // A minimum lies within 0.6 of its lag: beyond these the frame cannot hold enough of it.
        let most = ((5 * count + 7) / 12).min(LAGS - 1);
        let (mut before, mut here) = (level(1), level(1));
        let mut greatest = here;
        let mut lag = 1;
        while lag <= most {
            let after = level(lag + 1);
            if here < S::halved(greatest) && here < after {
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
        let period = lag - argument(Complex32::new(half.re, ratio * half.im)) / omega;
        (RANGE.contains(&period) && HELD * period <= f32::from(self.count)).then_some(period)
    }
}

/// Adds the squared differences of two samples from all those before them. A lag that is there for the first time begins its sum.
#[inline(always)]
fn add_lags<S: Sample>(sums: &mut Lags<S>, now: Two<S>, before: &[Two<S>]) {
    const { assert!(LAGS.is_multiple_of(2), "lags are taken in twos") };
    let [first, second] = now;
    let (twos, _) = sums.as_chunks_mut();
    let mut last = first;
    for (sums, before) in twos.iter_mut().zip(before.iter().rev()) {
        last = add_two_lags::<S>(sums, now, before, last);
    }
    // The next two lags begin here: no sum is cleared beforehand.
    if let Some(new) = twos.get_mut(before.len()) {
        let oldest = before.first().map_or(first, |&[oldest, _]| oldest);
        *new = [S::Square::ZERO; 2];
        S::add_difference(&mut new[0], second, oldest);
    }
}

/// Adds to an odd lag and the even one after it, from what is the even lag before the first sample and what is the odd one before
/// it; `last` came after those. Gives what the next two lags need of them.
#[inline(always)]
fn add_two_lags<S: Sample>(
    [odd, even]: &mut [S::Square; 2],
    [first, second]: Two<S>,
    &[[far_c, far_d], near]: &Two<S>,
    last: [S; 2],
) -> [S; 2] {
    // Number by number: as a pair it would be loaded into a register of whole numbers.
    let far = [far_c, far_d];
    S::add_difference(odd, first, near);
    S::add_difference(odd, second, last);
    S::add_difference(even, first, far);
    S::add_difference(even, second, near);
    far
}

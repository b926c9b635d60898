//! One octave of the search: the stream decimated by a power of two, and its D(T).

use num_complex::Complex32;

use crate::phase::{Phase, argument};
use crate::sample::{Arithmetic, Sample, Zero};

/// Lags compared in an octave.
pub(crate) const LAGS: usize = 10;
/// Samples of a frame: more than three of the longest periods that its octave finds.
pub(crate) const FRAME: usize = 32;
/// Periods that an octave may find, in its own samples: more than a factor of two, so that neighbours overlap.
const PERIODS: core::ops::RangeInclusive<f32> = 3.7..=9.2;
/// Periods that a frame must hold before it is put on trial.
const MIN_PERIODS: f32 = 2.2;
/// Samples of a frame from which on its D(T) is examined.
const MIN_SAMPLES: u16 = 10;
/// Samples of a frame up to which its D(T) is examined after every second one; later after every fourth.
const DENSE_UP_TO: u16 = 22;

/// D(1)…D(10), not divided by their counts of differences.
pub(crate) type Lags<S> = [<S as Arithmetic>::Square; LAGS];
/// Two successive sample pairs.
pub(super) type Two<S> = [[S; 2]; 2];
/// The samples of a frame.
pub(super) type Frame<S> = [Two<S>; FRAME / 2];

/// One octave of the stream: a frame of samples and its D(T).
#[derive(Debug, Clone, Copy)]
pub(super) struct Octave<S: Sample> {
    pub frame: Frame<S>,
    /// Samples in the frame; if the count is odd, the last is not in D(T) yet.
    pub count: u16,
    /// D(T) over the frame so far.
    differences: Lags<S>,
    /// Power that halving lost in the last frame.
    last_lost: f32,
}

impl<S: Sample> Octave<S> {
    /// An octave of no samples.
    pub(super) const fn new() -> Self {
        Self {
            frame: [[[S::ZERO; 2]; 2]; FRAME / 2],
            count: 0,
            differences: [S::Square::ZERO; LAGS],
            last_lost: 0.0,
        }
    }

    /// Forgets all samples.
    pub(super) fn restart(&mut self) {
        self.count = 0;
    }

    /// Stores a sample; true if it is the second of two, which [`compare`](Self::compare) must take before the next one comes.
    #[inline(always)]
    pub(super) fn keep(&mut self, sample: [S; 2]) -> bool {
        let place = usize::from(self.count) % FRAME;
        self.frame.as_flattened_mut()[place] = sample;
        self.count = place as u16 + 1;
        place % 2 == 1
    }

    /// Takes the last two samples into D(T), in one pass over the samples before them. Gives their mean.
    #[inline(always)]
    pub(super) fn compare(&mut self) -> Option<[S; 2]> {
        let (&two, before) = self
            .frame
            .get(..usize::from(self.count) / 2)?
            .split_last()?;
        let [first, second] = two;
        add_lags::<S>(&mut self.differences, two, before);
        if usize::from(self.count) == FRAME {
            self.last_lost = self.lost_so_far();
        }
        Some(S::mean(first, second))
    }

    /// Power that halving loses: the mean square of half the difference of neighbours. Of a short frame it is that of the last one.
    #[inline(never)]
    pub(super) fn lost(&self) -> f32 {
        if self.count < 8 {
            self.last_lost
        } else {
            self.lost_so_far()
        }
    }

    #[inline(always)]
    fn lost_so_far(&self) -> f32 {
        0.25 * S::square_to_f32(self.differences[0]) / (f32::from(self.count) - 1.0)
    }

    /// True if D(T) is to be examined now. To be asked after an even count of samples.
    #[inline(always)]
    pub(super) fn is_due(&self) -> bool {
        self.count >= MIN_SAMPLES && (self.count <= DENSE_UP_TO || self.count.is_multiple_of(4))
    }

    /// The period by the first minimum of D(T) after its first maximum, interpolated, if the frame is long enough for it.
    #[inline(never)]
    pub(super) fn period(&mut self) -> Option<f32> {
        let (shift, count) = (S::shift(&self.differences), usize::from(self.count));
        let level = |lag: usize| {
            let sum = self.differences.get(lag - 1).copied();
            S::level(sum.unwrap_or(S::Square::ZERO), shift, count - lag)
        };
        // Of a wave too slow for this octave, D(4) > D(3) and D(6) > D(3); one too fast for the next octave, below 7.4 samples, has
        // D(6) < 0.4 D(3). The frame begins anew, as a wave that began late in it looks slow as well.
        if level(4) > level(3) && level(6) > level(3) {
            self.last_lost = self.lost_so_far();
            self.count = 0;
            return None;
        }
        // A minimum lies within 0.6 of its lag: the frame does not hold enough periods of greater lags.
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

    /// The minimum of D(T) near `lag`, from the levels there and at both neighbours.
    #[inline(never)]
    fn between(&self, lag: f32, levels: [S::Level; 3]) -> Option<f32> {
        let [before, here, after] = levels.map(S::level_to_f32);
        // About its minimum D(T) = level − depth·cos ω(T − P): three lags give P.
        let ratio = (after - before) / (after + before - 2.0 * here);
        let omega = core::f32::consts::TAU / (lag - 0.5 * ratio);
        let half = Phase::from_radians(0.5 * omega).unit();
        let period = lag - argument(Complex32::new(half.re, ratio * half.im)) / omega;
        (PERIODS.contains(&period) && MIN_PERIODS * period <= f32::from(self.count))
            .then_some(period)
    }
}

/// Adds the squared differences between the two samples `now` and all those before them. A lag met for the first time begins its sum.
#[inline(always)]
fn add_lags<S: Sample>(sums: &mut Lags<S>, now: Two<S>, before: &[Two<S>]) {
    const { assert!(LAGS.is_multiple_of(2), "lags are taken in twos") };
    let [first, second] = now;
    let (twos, _) = sums.as_chunks_mut();
    let mut last = first;
    for (sums, before) in twos.iter_mut().zip(before.iter().rev()) {
        last = add_two_lags::<S>(sums, now, before, last);
    }
    // The next two lags begin here, so that no sum needs clearing beforehand.
    if let Some(new) = twos.get_mut(before.len()) {
        let oldest = before.first().map_or(first, |&[oldest, _]| oldest);
        *new = [S::Square::ZERO; 2];
        S::add_difference(&mut new[0], second, oldest);
    }
}

/// Adds to an odd lag and the even one after it: `near` lies the odd lag before `first`, `far` the even lag, and `last` follows `near`.
/// Gives `far`, which is the `last` of the next two lags.
#[inline(always)]
fn add_two_lags<S: Sample>(
    [odd, even]: &mut [S::Square; 2],
    [first, second]: Two<S>,
    &[[far_c, far_d], near]: &Two<S>,
    last: [S; 2],
) -> [S; 2] {
    // Number by number: a pair would be loaded into an integer register.
    let far = [far_c, far_d];
    S::add_difference(odd, first, near);
    S::add_difference(odd, second, last);
    S::add_difference(even, first, far);
    S::add_difference(even, second, near);
    far
}

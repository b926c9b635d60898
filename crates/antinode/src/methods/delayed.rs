//! Products of the pick-offs with their samples a quarter period before: the sums of algorithm 2.

use super::moments::Moments;
use crate::block::Pair;
use crate::sample::{Arithmetic, Sample, SamplePair};

/// Delayed products of a window. Those of several windows at the same lag can be added.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Delayed {
    /// t₃ in samples.
    pub lag: u16,
    /// Products in each sum.
    pub count: u32,
    /// Σ S_C(t) S_D(t − t₃), input units squared.
    pub cd: f64,
    /// Σ S_C(t) S_C(t − t₃) + S_D(t) S_D(t − t₃), 0 by (17) at a quarter period.
    pub own: f64,
}

impl Delayed {
    /// Products of the centred sample pairs from index `start` on, each with the pair `lag` before it; those that would need pairs before
    /// the slice are left out.
    pub fn of(pairs: &[Pair], start: usize, lag: u16) -> Self {
        let shift = usize::from(lag);
        let from = start.max(shift);
        let now = pairs.get(from..).unwrap_or(&[]);
        let before = pairs.get(from - shift..).unwrap_or(&[]);
        let mut sums = Default::default();
        for (&now, &before) in now.iter().zip(before) {
            f32::add_delayed(&mut sums, now, before);
        }
        Self::new(lag, now.len() as u32, sums.map(f32::product_to_f64))
    }

    fn new(lag: u16, count: u32, [own, cd]: [f64; 2]) -> Self {
        Self {
            lag,
            count,
            cd,
            own,
        }
    }

    /// Products of this window and `other` together; the lag is this one's.
    #[must_use = "it gives the sum, and changes neither"]
    pub fn with(&self, other: &Self) -> Self {
        Self {
            lag: self.lag,
            count: self.count + other.count,
            cd: self.cd + other.cd,
            own: self.own + other.own,
        }
    }

    /// q = ⟨S_C(t) S_D(t − t₃)⟩ of (16) at the whole-sample lag; NaN for an empty window.
    pub fn q(&self) -> f64 {
        self.cd / f64::from(self.count)
    }

    /// q at an exact quarter period: the error of the whole-sample lag is removed.
    ///
    /// r(t₃) = ⟨S_C(t) S_D(t − t₃)⟩ is a sinusoid of t₃, r(0) = ⟨S_C S_D⟩, so q = [r(t₃) − r(0) cos ωt₃]/sin ωt₃. `omega` is in
    /// rad a sample; the lag must not be near a multiple of half a period.
    pub fn quarter(&self, moments: &Moments, omega: f64) -> f64 {
        let (sine, cosine) = libm::sincos(omega * f64::from(self.lag));
        let (_, _, cd) = moments.means();
        (self.q() - cd * cosine) / sine
    }

    /// Deviation of (17) from zero: ⟨S(t) S(t − t₃)⟩ over both pick-offs, as a share of ⟨S_C² + S_D²⟩; it is about cos ωt₃.
    pub fn imbalance(&self, moments: &Moments) -> f64 {
        self.own / f64::from(self.count) / moments.power()
    }
}

/// Accumulates [`Delayed`] at sample rate, with about the work of [`MomentSums`](super::MomentSums) and a delay line of up to `LAGS` pairs.
///
/// A period of 200 samples, the longest, needs `LAGS` of 50. Push the whole stream: a window's first products use pairs before it.
#[derive(Debug, Clone)]
pub struct DelayedSums<const LAGS: usize, S: Sample = f32> {
    offsets: S::Centred,
    lag: u16,
    line: [S::Centred; LAGS],
    /// Index of the oldest pair in the line.
    place: u16,
    /// Pairs in the line, at most the lag.
    filled: u16,
    count: u32,
    sums: [S::Product; 2],
}

impl<const LAGS: usize, S: Sample> DelayedSums<LAGS, S> {
    /// Empty sums at a lag in samples, limited to 1…`LAGS`; `offsets` of S_C and S_D, in input units, are subtracted from every sample,
    /// (4).
    pub fn new(lag: u16, offsets: [f32; 2]) -> Self {
        Self {
            offsets: S::offsets(offsets),
            lag: lag.min(LAGS.min(usize::from(u16::MAX)) as u16).max(1),
            line: [S::Centred::default(); LAGS],
            place: 0,
            filled: 0,
            count: 0,
            sums: Default::default(),
        }
    }

    /// Adds a sample pair. The first pairs of a stream, up to the lag, only fill the line.
    #[inline]
    pub fn push(&mut self, pair: impl SamplePair<S>) {
        let now = S::centred(pair.pair(), self.offsets);
        let Some(slot) = self.line.get_mut(usize::from(self.place)) else {
            return;
        };
        let before = core::mem::replace(slot, now);
        self.place += 1;
        if self.place == self.lag {
            self.place = 0;
        }
        if self.filled < self.lag {
            self.filled += 1;
            return;
        }
        S::add_delayed(&mut self.sums, now, before);
        self.count += 1;
    }

    /// Adds the pairs of a slice, with the same result bit for bit as [`push`](Self::push). After its first pairs the slice serves as its
    /// own delay line.
    #[inline]
    pub fn extend<P: SamplePair<S>>(&mut self, pairs: &[P]) {
        let lag = usize::from(self.lag);
        let (first, rest) = pairs.split_at_checked(lag).unwrap_or((pairs, &[]));
        let is_in_order = self.place == 0 && self.filled == self.lag;
        if rest.is_empty() || !is_in_order {
            for &pair in first {
                self.push(pair);
            }
        }
        if rest.is_empty() {
            return;
        }
        let (offsets, mut sums) = (self.offsets, self.sums);
        if is_in_order {
            for (pair, &before) in first.iter().zip(&self.line) {
                S::add_delayed(&mut sums, S::centred(pair.pair(), offsets), before);
            }
            self.count += u32::from(self.lag);
        }
        let mut add = |now: P, before: P| {
            let [now, before] = [now, before].map(|pair| S::centred(pair.pair(), offsets));
            S::add_delayed(&mut sums, now, before);
        };
        // In eights, as the loop's own overhead is as much as a pair's work.
        let (now, now_rest) = rest.as_chunks::<8>();
        let (before, _) = pairs.as_chunks::<8>();
        for (now, before) in now.iter().zip(before) {
            for (&now, &before) in now.iter().zip(before) {
                add(now, before);
            }
        }
        let before = pairs.iter().skip(rest.len() - now_rest.len());
        for (&now, &before) in now_rest.iter().zip(before) {
            add(now, before);
        }
        self.sums = sums;
        self.count += rest.len() as u32;
        for (slot, &pair) in self.line.iter_mut().zip(pairs.iter().skip(rest.len())) {
            *slot = S::centred(pair.pair(), offsets);
        }
        self.place = 0;
    }

    /// Takes the products since the last call; the sums restart, the delay line continues.
    pub fn take(&mut self) -> Delayed {
        let sums = core::mem::take(&mut self.sums).map(S::product_to_f64);
        Delayed::new(self.lag, core::mem::take(&mut self.count), sums)
    }

    /// Refills the delay line, as is necessary if samples are missing before the next pair.
    pub fn restart(&mut self) {
        self.filled = 0;
        self.place = 0;
    }
}

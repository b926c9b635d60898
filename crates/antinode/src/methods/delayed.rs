//! Products of the pick-offs with themselves a quarter of a period before: the sums of algorithm 2.

use super::moments::Moments;
use crate::block::Pair;
use crate::sum::Sum;

/// Delayed products of a window. Those of two windows with one lag add.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Delayed {
    /// t₃ in samples.
    pub lag: u16,
    /// Products in each sum.
    pub count: u32,
    /// Σ S_C(t) S_D(t − t₃), input units squared.
    pub cd: f64,
    /// Σ S_C(t) S_C(t − t₃), which (17) wants to vanish.
    pub cc: f64,
    /// Σ S_D(t) S_D(t − t₃), which (17) wants to vanish.
    pub dd: f64,
}

impl Delayed {
    /// Of the centred sample pairs from `start` on, each with the one `lag` before it; pairs before the slice are left out.
    pub fn of(pairs: &[Pair], start: usize, lag: u16) -> Self {
        let shift = usize::from(lag);
        let from = start.max(shift);
        let now = pairs.get(from..).unwrap_or(&[]);
        let before = pairs.get(from - shift..).unwrap_or(&[]);
        let mut sums = [Sum::default(); 3];
        let mut count = 0;
        for (now, before) in now.iter().zip(before) {
            add(&mut sums, *now, *before);
            count += 1;
        }
        Self::new(lag, count, sums)
    }

    fn new(lag: u16, count: u32, sums: [Sum; 3]) -> Self {
        let [cd, cc, dd] = sums.map(Sum::value);
        Self {
            lag,
            count,
            cd,
            cc,
            dd,
        }
    }

    /// The products of this window and `other` as one; the lag is this one's.
    pub fn with(&self, other: &Self) -> Self {
        Self {
            lag: self.lag,
            count: self.count + other.count,
            cd: self.cd + other.cd,
            cc: self.cc + other.cc,
            dd: self.dd + other.dd,
        }
    }

    /// q = ⟨S_C(t) S_D(t − t₃)⟩ of (16) at the lag as it is; NaN for an empty window.
    pub fn q(&self) -> f64 {
        self.cd / f64::from(self.count)
    }

    /// q at an exact quarter of a period: what is left of the whole-sample lag's grid error is taken out.
    ///
    /// r(t₃) = ⟨S_C(t) S_D(t − t₃)⟩ is a sinusoid of t₃, r(0) = ⟨S_C S_D⟩, so q = [r(t₃) − r(0) cos ωt₃]/sin ωt₃. `omega` is in
    /// rad a sample; the lag must not be near a multiple of half a period.
    pub fn quarter(&self, moments: &Moments, omega: f64) -> f64 {
        let (sine, cosine) = libm::sincos(omega * f64::from(self.lag));
        let (_, _, cd) = moments.means();
        (self.q() - cd * cosine) / sine
    }

    /// How far (17) is from zero: ⟨S(t) S(t − t₃)⟩ over both pick-offs, as a share of ⟨S_C² + S_D²⟩; it is about cos ωt₃.
    pub fn imbalance(&self, moments: &Moments) -> f64 {
        (self.cc + self.dd) / f64::from(self.count) / moments.power()
    }
}

#[inline(always)]
fn add(sums: &mut [Sum; 3], now: Pair, before: Pair) {
    let [cd, cc, dd] = sums;
    cd.add(now[0] * before[1]);
    cc.add(now[0] * before[0]);
    dd.add(now[1] * before[1]);
}

/// Gathers [`Delayed`] at sample rate: 3 multiplications and 14 additions a pair, and a delay line of up to `LAGS` pairs.
///
/// A quarter of the longest period, 200 samples, takes 50.
#[derive(Debug, Clone)]
pub struct DelayedSums<const LAGS: usize> {
    offsets: [f32; 2],
    lag: u16,
    line: [Pair; LAGS],
    /// Place in the line of the oldest pair.
    place: u16,
    /// Pairs in the line, up to the lag.
    filled: u16,
    count: u32,
    sums: [Sum; 3],
}

impl<const LAGS: usize> DelayedSums<LAGS> {
    /// Empty sums at a lag in samples, brought into 1…`LAGS`; `offsets` of S_C and S_D are taken off every sample, (4).
    pub fn new(lag: u16, offsets: [f32; 2]) -> Self {
        Self {
            offsets,
            lag: lag.min(LAGS as u16).max(1),
            line: [[0.0; 2]; LAGS],
            place: 0,
            filled: 0,
            count: 0,
            sums: [Sum::default(); 3],
        }
    }

    /// Adds a sample pair. The first pairs of a stream, up to the lag, only fill the line.
    #[inline]
    pub fn push(&mut self, pair: Pair) {
        let now = [pair[0] - self.offsets[0], pair[1] - self.offsets[1]];
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
        add(&mut self.sums, now, before);
        self.count += 1;
    }

    /// Adds the pairs of a slice, to the bit as [`push`](Self::push) would: the sums stay in registers.
    #[inline]
    pub fn extend(&mut self, mut pairs: &[Pair]) {
        let offsets = self.offsets;
        while !pairs.is_empty() {
            if self.filled < self.lag {
                let Some((first, rest)) = pairs.split_first() else {
                    return;
                };
                self.push(*first);
                pairs = rest;
                continue;
            }
            // As far as the line's end, or the slice's.
            let place = usize::from(self.place);
            let open = usize::from(self.lag).saturating_sub(place).min(pairs.len());
            let (Some(line), Some((taken, rest))) = (
                self.line.get_mut(place..place + open),
                pairs.split_at_checked(open),
            ) else {
                return;
            };
            let mut sums = self.sums;
            for (slot, pair) in line.iter_mut().zip(taken) {
                let now = [pair[0] - offsets[0], pair[1] - offsets[1]];
                add(&mut sums, now, core::mem::replace(slot, now));
            }
            self.sums = sums;
            self.count += open as u32;
            self.place += open as u16;
            if self.place == self.lag {
                self.place = 0;
            }
            pairs = rest;
        }
    }

    /// The products since the last call; the sums start anew, the line goes on.
    pub fn take(&mut self) -> Delayed {
        let delayed = Delayed::new(self.lag, self.count, self.sums);
        self.count = 0;
        self.sums = [Sum::default(); 3];
        delayed
    }

    /// Tells that samples are missing before the next pair: the line is filled anew.
    pub fn restart(&mut self) {
        self.filled = 0;
        self.place = 0;
    }
}

//! Re-gridding: low-passes a stream and resamples it to a grid that fits the wave's period, as the paper advises after (10).
//!
//! On the new grid a window of whole periods is a whole number of samples, so condition (8) holds, and if the number of samples a period
//! divides by 4, so is the quarter-period delay of algorithm 2. It can precede any method; the [`Tracker`](crate::Tracker), whose sums are
//! exact on any grid, needs it only for the filter.
//!
//! Each output is one product with a row of filter taps, a windowed sinc whose response at the wave's own frequency is made exactly 1; rows
//! are tabulated at 64 places between two samples, and interpolated linearly. The wave itself passes with a relative error below
//! (2π/64P)²/8, with P samples a period, plus rounding: 3.5·10⁻⁶ at 18.75, and up to 10⁻⁶ at 50 and more with up to 400 taps.
//!
//! # Example
//!
//! ```
//! use antinode::methods::{Products, algorithm4};
//! use antinode::regrid::Regrid;
//!
//! // From 18.75 samples a period to 20, by a filter of two periods.
//! let mut regrid = Regrid::<38>::new(18.75, 20, 2.0)?;
//! let mut pairs = Vec::new();
//! for k in 0..200 {
//!     let (sine, cosine) = (core::f32::consts::TAU / 18.75 * k as f32).sin_cos();
//!     let (s2, c2) = 0.6f32.sin_cos();
//!     regrid.push([cosine * c2 - 0.1 * sine * s2, cosine * s2 + 0.1 * sine * c2], |pair| pairs.push(pair));
//! }
//! // One period is 20 samples now: nothing leaks.
//! let wave = algorithm4::wave(&Products::of(&pairs[..20], core::f64::consts::TAU / 20.0));
//! assert!((wave.shape.main_amplitude - 1.0).abs() < 1e-5);
//! # Ok::<(), antinode::regrid::RegridError>(())
//! ```

use core::fmt;

use crate::block::Pair;
use crate::phase::Phase;

/// Places between two samples at which the filter is tabulated.
const PLACES: usize = 64;

/// A grid that cannot be made.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RegridError {
    /// The period is outside 2.5 to 1000 samples.
    Period(f32),
    /// The new grid has fewer than 3 samples a period, or more than 1000.
    PerPeriod(u16),
    /// The cut-off, in multiples of the wave's frequency, is not above 1, or is above half the samples a period of either grid.
    CutOff(f32),
    /// There are fewer than 4 taps, or an odd number of them.
    Taps(usize),
}

impl fmt::Display for RegridError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Period(period) => {
                write!(
                    f,
                    "period of {period} samples: it must lie within 2.5 to 1000"
                )
            }
            Self::PerPeriod(count) => write!(
                f,
                "{count} samples a period on the new grid: it takes 3 to 1000"
            ),
            Self::CutOff(cut_off) => write!(
                f,
                "cut-off at {cut_off} times the wave's frequency: it must be above 1, and at most half the samples a period of either grid"
            ),
            Self::Taps(taps) => write!(f, "{taps} taps: it takes an even number of 4 or more"),
        }
    }
}

impl core::error::Error for RegridError {}

/// Resamples a stream of sample pairs to `per_period` samples a period. `TAPS` input samples make an output: even, 4 or more.
///
/// It holds 65 × `TAPS` f32 of filter. An output costs 3 `TAPS` multiplications and 4 `TAPS` additions, all f32.
#[derive(Debug, Clone)]
pub struct Regrid<const TAPS: usize> {
    rows: [[f32; TAPS]; PLACES + 1],
    line: [Pair; TAPS],
    /// Index of the oldest pair in `line`.
    oldest: usize,
    /// Input samples from one output to the next, in units of 2⁻³².
    step: u64,
    /// Time of the next output after the sample in the middle of the line, in the same units.
    ahead: u64,
    per_period: u16,
}

impl<const TAPS: usize> Regrid<TAPS> {
    /// A grid of `per_period` samples for a wave of `period` input samples, low-passed at `cut_off` times the wave's frequency.
    ///
    /// A filter is only as steep as it is long: one of 2 periods makes a cut-off of 2 a real one.
    ///
    /// # Errors
    ///
    /// The first value, or `TAPS`, that is not allowed.
    pub fn new(period: f32, per_period: u16, cut_off: f32) -> Result<Self, RegridError> {
        let step = Self::step_of(period, per_period)?;
        // Above half of either rate there is nothing to pass.
        if !(cut_off > 1.0 && cut_off <= 0.5 * period.min(f32::from(per_period))) {
            return Err(RegridError::CutOff(cut_off));
        }
        if TAPS < 4 || !TAPS.is_multiple_of(2) {
            return Err(RegridError::Taps(TAPS));
        }
        let mut regrid = Self {
            rows: [[0.0; TAPS]; PLACES + 1],
            line: [[0.0; 2]; TAPS],
            oldest: 0,
            step,
            // The line is filled first: the first output stands at input sample TAPS/2 − 1.
            ahead: (TAPS as u64) << 32,
            per_period,
        };
        for (place, row) in regrid.rows.iter_mut().enumerate() {
            fill(row, place as f32 / PLACES as f32, period, cut_off);
        }
        Ok(regrid)
    }

    /// Follows a wave whose period moved to `period` input samples. The filter stays: valid within 1 % of the first period.
    ///
    /// # Errors
    ///
    /// A period outside 2.5 to 1000 samples; nothing is changed then.
    pub fn retune(&mut self, period: f32) -> Result<(), RegridError> {
        self.step = Self::step_of(period, self.per_period)?;
        Ok(())
    }

    /// Input samples from one output to the next, in units of 2⁻³².
    fn step_of(period: f32, per_period: u16) -> Result<u64, RegridError> {
        if !(2.5..=1000.0).contains(&period) {
            return Err(RegridError::Period(period));
        }
        if !(3..=1000).contains(&per_period) {
            return Err(RegridError::PerPeriod(per_period));
        }
        let step = f64::from(period) / f64::from(per_period);
        Ok((step * 4_294_967_296.0) as u64)
    }

    /// Input samples from one output to the next.
    pub fn step(&self) -> f64 {
        self.step as f64 / 4_294_967_296.0
    }

    /// Takes a sample pair; hands the outputs that it completes to `report`. The first output stands at input sample `TAPS`/2 − 1.
    #[inline]
    pub fn push(&mut self, pair: Pair, mut report: impl FnMut(Pair)) {
        if let Some(slot) = self.line.get_mut(self.oldest) {
            *slot = pair;
        }
        self.oldest += 1;
        if self.oldest == TAPS {
            self.oldest = 0;
        }
        self.ahead = self.ahead.saturating_sub(1 << 32);
        while self.ahead >> 32 == 0 {
            report(self.output());
            self.ahead += self.step;
        }
    }

    /// The signals at the time `ahead`.
    #[inline]
    fn output(&self) -> Pair {
        // 2⁻³² of a sample in 64 places: 6 bits of place, 26 bits between two of them.
        let place = (self.ahead >> 26) as usize;
        let share = (self.ahead & ((1 << 26) - 1)) as f32 / (1u64 << 26) as f32;
        let (Some(low), Some(high)) = (self.rows.get(place), self.rows.get(place + 1)) else {
            return [0.0; 2];
        };
        let (newer, older) = self.line.split_at(self.oldest.min(TAPS));
        let mut sum = [0.0f32; 2];
        for (pair, (low, high)) in older.iter().chain(newer).zip(low.iter().zip(high)) {
            let weight = low + share * (high - low);
            sum[0] += weight * pair[0];
            sum[1] += weight * pair[1];
        }
        sum
    }
}

/// The taps for an output that stands `place` of a sample after the middle one: a windowed sinc, then exact at the wave's frequency.
fn fill<const TAPS: usize>(row: &mut [f32; TAPS], place: f32, period: f32, cut_off: f32) {
    let half = TAPS as f32 / 2.0;
    let turn = core::f32::consts::TAU / period;
    let time = |tap: usize| tap as f32 + 1.0 - half - place;
    // Hann's window, a little wider than the taps, so that none has a weight of zero.
    let window = |t: f32| 0.5 + 0.5 * libm::cosf(core::f32::consts::PI * t / (half + 0.5));
    let mut normal = [0.0f32; 3];
    let mut seen = [0.0f32; 2];
    for (tap, weight) in row.iter_mut().enumerate() {
        let t = time(tap);
        let x = turn * cut_off * t;
        let sinc = if x.abs() < 1e-3 {
            1.0
        } else {
            libm::sinf(x) / x
        };
        *weight = window(t) * sinc * 2.0 * cut_off / period;
        let unit = Phase::from_radians(turn * t).unit();
        seen[0] += *weight * unit.re;
        seen[1] += *weight * unit.im;
        normal[0] += window(t) * unit.re * unit.re;
        normal[1] += window(t) * unit.re * unit.im;
        normal[2] += window(t) * unit.im * unit.im;
    }
    // The smallest change that makes Σ h cos ωt = 1 and Σ h sin ωt = 0.
    let (cosine, sine) = (1.0 - seen[0], -seen[1]);
    let scale = 1.0 / (normal[0] * normal[2] - normal[1] * normal[1]);
    let along = scale * (normal[2] * cosine - normal[1] * sine);
    let across = scale * (normal[0] * sine - normal[1] * cosine);
    for (tap, weight) in row.iter_mut().enumerate() {
        let t = time(tap);
        let unit = Phase::from_radians(turn * t).unit();
        *weight += window(t) * (along * unit.re + across * unit.im);
    }
}

//! Predicts the sums of blocks from a window's waves.
//!
//! Every sum of a block is the real part of each wave's phasor there times a constant; the constants are made once for a run of blocks.

use num_complex::Complex32;

use super::model::Model;
use super::response::{Answer, Whitened};
use super::waves::Waves;

/// The two constants of one sum: it is the real part of the sum of their products with the waves, as the pick-off sees them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gains([Complex32; 2]);

impl Gains {
    #[inline(always)]
    pub(super) fn of(&self, [plus, minus]: &[Complex32; 2]) -> f32 {
        let [p, m] = &self.0;
        p.re * plus.re - p.im * plus.im + m.re * minus.re - m.im * minus.im
    }

    /// The gains for the waves that C sees, if pick-off D sees them times these factors.
    #[inline(always)]
    fn through(&self, [plus, minus]: &[Complex32; 2]) -> Self {
        Self([self.0[0] * plus, self.0[1] * minus])
    }
}

/// z′/z of each wave, and its square.
pub(super) struct Slopes([[Complex32; 2]; 2]);

impl Slopes {
    #[inline(always)]
    pub(super) fn new(waves: &Waves) -> Self {
        let [plus, minus] = waves.slope;
        Self([[plus, plus * plus], [minus, minus * minus]])
    }

    /// Gains of a sum that is even in time.
    #[inline(always)]
    pub(super) fn even(&self, answer: &Answer) -> Gains {
        let gain = |[slope, square]: [Complex32; 2]| {
            let turned = Complex32::new(slope.im, -slope.re) * answer.slope;
            turned + square * answer.curve + answer.level
        };
        let [plus, minus] = self.0;
        Gains([gain(plus), gain(minus)])
    }

    /// Gains of a sum that is odd in time.
    #[inline(always)]
    pub(super) fn odd(&self, answer: &Answer) -> Gains {
        // The imaginary part of a number is the real part of −j times it.
        let Gains(gains) = self.even(answer);
        Gains(gains.map(|gain| Complex32::new(gain.im, -gain.re)))
    }

    /// The factors of a [`Prediction`], with the course of the waves during the skew.
    #[inline(always)]
    fn factors(&self, model: &Model) -> [Complex32; 2] {
        let delay = model.correction.delay * model.per_half;
        let half = 0.5 * delay * delay;
        let [plus, minus] = self.0;
        let [d_plus, d_minus] = model.correction.of_waves;
        let later = |[slope, square]: [Complex32; 2]| slope * delay + square * half + 1.0;
        [d_plus * later(plus), d_minus * later(minus)]
    }
}

/// Predicts the whitened sums of one pick-off.
#[derive(Debug, Clone, Copy)]
pub(super) struct Prediction {
    mean: Gains,
    even: Gains,
    odd: Gains,
    offset: f32,
    /// What raw pick-off D sees of each wave of which C sees one.
    pub factors: [Complex32; 2],
    /// The offset that pick-off D adds to the mean.
    offset_d: f32,
}

impl Prediction {
    /// The prediction for pick-off C.
    #[inline(never)]
    pub(super) fn of_c(model: &Model, waves: &Waves, offsets: &[f32; 2]) -> Self {
        let slopes = Slopes::new(waves);
        let response = &model.response;
        Self {
            mean: slopes.even(&response.mean),
            even: slopes.even(&response.even),
            odd: slopes.odd(&response.odd),
            offset: response.offset * offsets[0],
            factors: slopes.factors(model),
            offset_d: response.offset * offsets[1],
        }
    }

    /// Turns it into the prediction for pick-off D.
    #[inline(always)]
    pub(super) fn change_to_d(&mut self) {
        let factors = self.factors;
        for gains in [&mut self.mean, &mut self.even, &mut self.odd] {
            *gains = gains.through(&factors);
        }
        self.offset = self.offset_d;
    }

    /// The mean less its prediction.
    #[inline(always)]
    pub(super) fn mean_residual(&self, seen: &Whitened, waves: &[Complex32; 2]) -> f32 {
        seen.mean - self.offset - self.mean.of(waves)
    }

    /// The sums less their predictions.
    #[inline(always)]
    pub(super) fn residual(&self, seen: &Whitened, waves: &[Complex32; 2]) -> Whitened {
        Whitened {
            mean: self.mean_residual(seen, waves),
            even: seen.even - self.even.of(waves),
            odd: seen.odd - self.odd.of(waves),
        }
    }
}

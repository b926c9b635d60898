//! What blocks would sum of a window's waves.
//!
//! Every sum of every block is the real part of a constant times each wave's phasor there: the constants are made once a pass.

use num_complex::Complex32;

use super::course::Here;
use super::model::Model;
use super::response::{Answer, Whitened};
use super::waves::Waves;

/// The constants by which one sum of one pick-off answers to z₊ and z₋: it is the real part of their products.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gains([Complex32; 2]);

impl Gains {
    #[inline(always)]
    pub(super) fn of(&self, here: &Here) -> f32 {
        let [p, m] = &self.0;
        let [plus, minus] = &here.waves;
        p.re * plus.re - p.im * plus.im + m.re * minus.re - m.im * minus.im
    }
}

/// What the two waves make of the pick-offs: raw z_C and z_D are these factors times z₊ and z₋.
pub(super) struct Mixing {
    /// Of each pick-off, for each wave.
    factors: [[Complex32; 2]; 2],
    /// z′/z of each wave, a sample, and its square.
    slope: [[Complex32; 2]; 2],
}

impl Mixing {
    pub(super) fn new(model: &Model, waves: &Waves) -> Self {
        let slope = waves.slope.map(|slope| slope * model.per_half);
        let mut factors = [[Complex32::ZERO; 2]; 2];
        for (w, side) in [1.0, -1.0].into_iter().enumerate() {
            let ideal = [Complex32::new(0.5, 0.0), Complex32::new(0.0, -0.5 * side)];
            let [c, d] = model.correction.distort(ideal);
            factors[0][w] = c;
            factors[1][w] = d * (slope[w] * model.correction.delay + 1.0);
        }
        Self {
            factors,
            slope: slope.map(|s| [s, s * s]),
        }
    }

    /// The gains of each pick-off in a sum that is even in time: level·Re v₀ + slope·Im v₁ + curve·Re v₂.
    pub(super) fn even(&self, answer: &Answer) -> [Gains; 2] {
        self.gains(self.slope.map(|[s, square]| {
            let turned = Complex32::new(s.im, -s.re) * answer.slope;
            turned + square * answer.curve + answer.level
        }))
    }

    /// The gains of each pick-off in a sum that is odd in time: level·Im v₀ + slope·Re v₁ + curve·Im v₂.
    pub(super) fn odd(&self, answer: &Answer) -> [Gains; 2] {
        self.gains(self.slope.map(|[s, square]| {
            let turned = Complex32::new(-s.im, s.re) * answer.slope;
            let gain = turned + square * answer.curve + answer.level;
            // The imaginary part of a number is the real part of −j times it.
            Complex32::new(gain.im, -gain.re)
        }))
    }

    fn gains(&self, of_waves: [Complex32; 2]) -> [Gains; 2] {
        self.factors
            .map(|factors| Gains([factors[0] * of_waves[0], factors[1] * of_waves[1]]))
    }
}

/// Predicts the whitened sums of one pick-off.
#[derive(Debug, Clone, Copy)]
pub(super) struct Prediction {
    mean: Gains,
    even: Gains,
    odd: Gains,
    offset: f32,
}

impl Prediction {
    /// For both pick-offs.
    pub(super) fn new(model: &Model, mixing: &Mixing, offsets: [f32; 2]) -> [Self; 2] {
        let response = &model.response;
        let [mean_c, mean_d] = mixing.even(&response.mean);
        let [even_c, even_d] = mixing.even(&response.even);
        let [odd_c, odd_d] = mixing.odd(&response.odd);
        let [offset_c, offset_d] = offsets.map(|offset| response.offset * offset);
        [
            Self {
                mean: mean_c,
                even: even_c,
                odd: odd_c,
                offset: offset_c,
            },
            Self {
                mean: mean_d,
                even: even_d,
                odd: odd_d,
                offset: offset_d,
            },
        ]
    }

    /// The mean alone, less what is predicted here.
    pub(super) fn mean_rest(&self, seen: &Whitened, here: &Here) -> f32 {
        seen.mean - self.offset - self.mean.of(here)
    }

    /// The sums less what is predicted here.
    #[inline(always)]
    pub(super) fn rest(&self, seen: &Whitened, here: &Here) -> Whitened {
        Whitened {
            mean: self.mean_rest(seen, here),
            even: seen.even - self.even.of(here),
            odd: seen.odd - self.odd.of(here),
        }
    }
}

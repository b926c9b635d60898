//! What blocks would sum of a window's waves.
//!
//! Every sum of every block is the real part of a constant times each wave's phasor there: the constants are made once a pass.

use num_complex::Complex32;

use super::course::Here;
use super::model::Model;
use super::response::{Answer, Whitened};
use super::waves::Waves;

/// The constants by which one sum of one pick-off answers to both waves in C: it is the real part of their products.
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

/// What a wave makes of the pick-offs.
#[derive(Clone, Copy)]
struct Mixed {
    /// Raw z_D for a z_C of one.
    factor: Complex32,
    /// z′/z, and its square.
    slope: Complex32,
    square: Complex32,
}

/// What the two waves make of the pick-offs.
pub(super) struct Mixing([Mixed; 2]);

impl Mixing {
    pub(super) fn new(model: &Model, waves: &Waves) -> Self {
        let delay = model.correction.delay * model.per_half;
        let mixed = |slope: Complex32, d: Complex32| Mixed {
            factor: d * (slope * delay + 1.0),
            slope,
            square: slope * slope,
        };
        let [plus, minus] = waves.slope;
        let [d_plus, d_minus] = model.correction.of_waves;
        Self([mixed(plus, d_plus), mixed(minus, d_minus)])
    }

    /// The gains of each pick-off in a sum that is even in time.
    #[inline(always)]
    pub(super) fn even(&self, answer: &Answer) -> [Gains; 2] {
        self.gains(answer, |gain| gain)
    }

    /// The gains of each pick-off in a sum that is odd in time.
    #[inline(always)]
    pub(super) fn odd(&self, answer: &Answer) -> [Gains; 2] {
        // The imaginary part of a number is the real part of −j times it.
        self.gains(answer, |gain| Complex32::new(gain.im, -gain.re))
    }

    #[inline(always)]
    fn gains(&self, answer: &Answer, part: impl Fn(Complex32) -> Complex32) -> [Gains; 2] {
        let c = self.0.map(|Mixed { slope, square, .. }| {
            let turned = Complex32::new(slope.im, -slope.re) * answer.slope;
            part(turned + square * answer.curve + answer.level)
        });
        let [plus, minus] = &self.0;
        [Gains(c), Gains([plus.factor * c[0], minus.factor * c[1]])]
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
    #[inline(always)]
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

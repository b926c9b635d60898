//! The third harmonic of a window, beyond what the wave itself puts there.

use num_complex::Complex32;

use super::course::Here;
use super::examine::Remains;
use super::model::Model;
use super::prediction::{Gains, Mixing};
use super::seen::Seen;
use crate::order::greater;

/// Gathers the third-harmonic sums of the blocks, turned back by the carrier.
pub(super) struct Thirds {
    predictions: [Third; 2],
    sum: [Complex32; 2],
    power: f32,
    watched: u16,
}

impl Thirds {
    pub(super) fn new(model: &Model, mixing: &Mixing, offsets: [f32; 2]) -> Self {
        Self {
            predictions: Third::new(model, mixing, offsets),
            sum: [Complex32::ZERO; 2],
            power: 0.0,
            watched: 0,
        }
    }

    /// Takes a run of blocks.
    #[inline]
    pub(super) fn add(&mut self, blocks: &[Seen], here: &[Here]) {
        for (block, here) in blocks.iter().zip(here) {
            let Some(seen) = &block.watched else {
                continue;
            };
            let back = here.unit.conj();
            let back = back * back * back;
            for ((prediction, sum), &third) in
                self.predictions.iter().zip(&mut self.sum).zip(&seen.third)
            {
                let rest = prediction.rest(third, here);
                *sum += rest * back;
                self.power += rest.norm_sqr();
            }
            self.watched += 1;
        }
    }

    /// The amplitudes and their noise; `doubled` is two over the samples of a block.
    pub(super) fn conclude(&self, remains: &mut Remains, doubled: f32) {
        let per_count = 1.0 / f32::from(self.watched.max(1));
        let coherent = (self.sum[0].norm_sqr() + self.sum[1].norm_sqr()) * per_count;
        let incoherent = if self.power > coherent {
            self.power - coherent
        } else {
            0.0
        };
        let freedom = 4.0 * f32::from(self.watched.saturating_sub(1));
        remains.third = self.sum.map(|sum| sum * (doubled * per_count));
        remains.third_noise = incoherent * doubled / greater(freedom, 1.0);
        remains.third_freedom = freedom;
    }
}

/// Predicts the third-harmonic sums of one pick-off: what the wave itself puts there in blocks that do not fit its period.
struct Third {
    cosine: Gains,
    sine: Gains,
    offset: f32,
}

impl Third {
    fn new(model: &Model, mixing: &Mixing, offsets: [f32; 2]) -> [Self; 2] {
        let response = &model.response;
        let [cosine_c, cosine_d] = mixing.even(&response.third_even);
        let [sine_c, sine_d] = mixing.odd(&response.third_odd);
        let [offset_c, offset_d] = offsets.map(|offset| response.third_offset * offset);
        [
            Self {
                cosine: cosine_c,
                sine: sine_c,
                offset: offset_c,
            },
            Self {
                cosine: cosine_d,
                sine: sine_d,
                offset: offset_d,
            },
        ]
    }
}

impl Third {
    /// The sums less what is predicted here: Σ S e^(−3jφ).
    #[inline(always)]
    fn rest(&self, seen: Complex32, here: &Here) -> Complex32 {
        Complex32::new(
            seen.re - self.offset - self.cosine.of(here),
            self.sine.of(here) - seen.im,
        )
    }
}

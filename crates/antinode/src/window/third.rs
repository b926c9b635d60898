//! The third harmonic of a window, beyond what the wave itself puts there.

use num_complex::Complex32;

use super::course::Course;
use super::examine::Remains;
use super::model::Model;
use super::prediction::Slopes;
use super::seen::Seen;
use super::waves::Waves;
use crate::scalar::greater;

/// Gathers the third-harmonic sums of the blocks, turned back by the carrier, less what the wave itself puts there in blocks that do
/// not fit its period.
#[derive(Default)]
pub(super) struct Thirds {
    sum: [Complex32; 2],
    power: f32,
    /// The most of it in a block.
    most: f32,
    watched: u16,
}

impl Thirds {
    /// Takes a run of blocks.
    #[inline(never)]
    pub(super) fn add(
        &mut self,
        model: &Model,
        waves: &Waves,
        offsets: &[f32; 2],
        factors: &[Complex32; 2],
        blocks: &[Seen],
        course: &Course,
    ) {
        let slopes = Slopes::new(waves);
        let response = &model.response;
        let (cosine, sine) = (
            slopes.even(&response.third_even),
            slopes.odd(&response.third_odd),
        );
        let offsets = offsets.map(|offset| response.third_offset * offset);
        let turn = model.turn;
        let turn = turn * turn * turn;
        let mut thirds = Self { ..*self };
        let course = course[0].iter().zip(&course[1]);
        for (block, (&plus, &minus)) in blocks.iter().zip(course) {
            let Some(seen) = &block.watched else {
                continue;
            };
            let waves = [[plus, minus], [plus * factors[0], minus * factors[1]]];
            let before = thirds.power;
            for (channel, sum) in thirds.sum.iter_mut().enumerate() {
                let (third, waves) = (seen.third[channel], &waves[channel]);
                // Σ S e^(−3jφ).
                let rest = Complex32::new(
                    third.re - offsets[channel] - cosine.of(waves),
                    sine.of(waves) - third.im,
                );
                // Against thrice the carrier's phase in the middle of the last block taken.
                *sum = *sum * turn + rest;
                thirds.power += rest.norm_sqr();
            }
            thirds.most = greater(thirds.power - before, thirds.most);
            thirds.watched += 1;
        }
        *self = thirds;
    }

    /// The amplitudes and their noise.
    #[inline(never)]
    pub(super) fn conclude(&self, model: &Model, remains: &mut Remains) {
        // Two over the samples of a block.
        let doubled = model.per_half * f32::from(model.blocks);
        let watched = f32::from(self.watched.max(1));
        let freedom = 4.0 * (watched - 1.0);
        // One over the product of both makes one over each.
        let least = greater(freedom, 1.0);
        let per_both = 1.0 / (watched * least);
        let per_count = least * per_both;
        let unit = model.basis.unit;
        let (amplitude, power) = (doubled * unit, doubled * unit * unit);
        let coherent = (self.sum[0].norm_sqr() + self.sum[1].norm_sqr()) * per_count;
        let incoherent = if self.power > coherent {
            self.power - coherent
        } else {
            0.0
        };
        remains.third_spared = (self.power - self.most) * power * (watched * per_both);
        remains.third = self.sum.map(|sum| sum * (amplitude * per_count));
        remains.third_noise = incoherent * power * (watched * per_both);
        remains.third_freedom = freedom;
    }
}

//! The third harmonic of a window, beyond what the wave itself puts there.

use num_complex::Complex32;

use super::course::Course;
use super::examine::Remains;
use super::model::Model;
use super::prediction::Slopes;
use super::seen::Seen;
use super::waves::Waves;
use crate::scalar::greater;

/// A line in the sums about the third harmonic, which sampling may bring there from elsewhere.
///
/// As wide as what stands beside it: of a single byte the compiler clears it and others by a store that is not aligned.
#[derive(Clone, Copy)]
#[repr(u16)]
pub(super) enum Line {
    /// The third harmonic.
    Third,
    /// Its own image.
    OwnImage,
    /// That of the fifth harmonic.
    ImageOfFifth,
}

impl Line {
    /// By what it turns in a block in which the carrier turns so.
    pub(super) fn turn(self, turn: Complex32) -> Complex32 {
        let third = turn * turn * turn;
        match self {
            Self::Third => third,
            Self::OwnImage => third.conj(),
            Self::ImageOfFifth => (third * turn * turn).conj(),
        }
    }
}

/// Gathers the third-harmonic sums of the blocks, turned back by the carrier, less what the wave itself puts there in blocks that do
/// not fit its period.
pub(super) struct Thirds {
    pub sum: [Complex32; 2],
    pub power: f32,
    /// The most of it in a block.
    most: f32,
    pub watched: u16,
    pub line: Line,
}

impl Thirds {
    /// Those of a line.
    pub(super) fn of(line: Line) -> Self {
        Self {
            sum: [Complex32::ZERO; 2],
            power: 0.0,
            most: 0.0,
            watched: 0,
            line,
        }
    }

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
        let turn = self.line.turn(model.turn);
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
                // Against the line's phase in the middle of the last block taken.
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
        let (amplitude, power) = Self::scales(model);
        let watched = f32::from(self.watched.max(1));
        let freedom = 4.0 * (watched - 1.0);
        // One over the product of both makes one over each.
        let least = greater(freedom, 1.0);
        let per_both = 1.0 / (watched * least);
        let per_count = least * per_both;
        let squares = self.sum.map(|sum| sum.norm_sqr() * per_count);
        let incoherent = greater(self.power - (squares[0] + squares[1]), 0.0);
        let per_freedom = watched * per_both;
        remains.third = squares.map(|square| square * (amplitude * amplitude * per_count));
        remains.third_noise = incoherent * power * per_freedom;
        remains.third_alone = remains.third_noise;
        remains.third_spared = (self.power - self.most) * power * per_freedom;
        remains.third_freedom = freedom;
    }

    /// What makes an amplitude of the mean sum, and a noise variance a sample of a sum's.
    #[inline]
    pub(super) fn scales(model: &Model) -> (f32, f32) {
        // Two over the samples of a block.
        let doubled = model.per_half * f32::from(model.blocks);
        let unit = model.basis.unit;
        (doubled * unit, doubled * unit * unit)
    }
}

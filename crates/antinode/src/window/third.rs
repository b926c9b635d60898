//! The third harmonic of a window, less what the wave itself adds to its sums.

use num_complex::Complex32;

use super::course::Course;
use super::examine::Remains;
use super::model::Model;
use super::prediction::Slopes;
use super::seen::Seen;
use super::waves::Waves;
use crate::scalar::greater;

/// A line in the sums about the third harmonic: that harmonic, or an alias that sampling brings there.
///
/// As wide as the field beside it: with a single byte the compiler clears both by a store that is not aligned.
#[derive(Clone, Copy)]
#[repr(u16)]
pub(super) enum Line {
    /// The third harmonic.
    Third,
    /// Its own image.
    OwnImage,
    /// The image of the fifth harmonic.
    ImageOfFifth,
}

impl Line {
    /// Turn of the line in a block in which the carrier turns by `turn`.
    pub(super) fn turn(self, turn: Complex32) -> Complex32 {
        let third = turn * turn * turn;
        match self {
            Self::Third => third,
            Self::OwnImage => third.conj(),
            Self::ImageOfFifth => (third * turn * turn).conj(),
        }
    }
}

/// Gathers the third-harmonic sums of the blocks along a line, less what the wave itself adds to them in blocks that do not fit its period.
pub(super) struct Thirds {
    pub sum: [Complex32; 2],
    pub power: f32,
    /// The largest share of a block in `power`.
    worst: f32,
    pub line: Line,
}

/// Half a window, in samples, above which its third harmonic is known: what the wave leaves of ten sample pairs looks like one by chance.
const MIN_HALF: f32 = 5.0;

impl Thirds {
    /// No sums yet, for a line.
    pub(super) fn of(line: Line) -> Self {
        Self {
            sum: [Complex32::ZERO; 2],
            power: 0.0,
            worst: 0.0,
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
                // The sum refers to the line's phase at the middle of the last block taken.
                *sum = *sum * turn + rest;
                thirds.power += rest.norm_sqr();
            }
            thirds.worst = greater(thirds.power - before, thirds.worst);
        }
        *self = thirds;
    }

    /// Gives the amplitudes and their noise.
    #[inline(never)]
    pub(super) fn conclude(&self, model: &Model, remains: &mut Remains) {
        let (amplitude, power) = Self::scales(model);
        // In a window all blocks are watched, or none is.
        let watched = f32::from(model.blocks);
        let freedom = 4.0 * (watched - 1.0);
        // A single division: the inverse of the product gives both inverses.
        let per_both = 1.0 / (watched * freedom);
        let per_count = freedom * per_both;
        let squares = self.sum.map(|sum| sum.norm_sqr() * per_count);
        let incoherent = greater(self.power - (squares[0] + squares[1]), 0.0);
        let per_freedom = watched * per_both;
        remains.third = squares.map(|square| square * (amplitude * amplitude * per_count));
        remains.third_noise = incoherent * power * per_freedom;
        remains.third_without_image = remains.third_noise;
        remains.third_without_worst = (self.power - self.worst) * power * per_freedom;
        remains.third_freedom = freedom;
    }

    /// Factors from the mean sum to an amplitude, 0 in a window too short to know it, and from a sum's variance to a noise variance a
    /// sample.
    #[inline]
    pub(super) fn scales(model: &Model) -> (f32, f32) {
        // Two over the samples of a block.
        let doubled = model.per_half * f32::from(model.blocks);
        let unit = model.basis.unit;
        let is_long = model.half > MIN_HALF;
        let amplitude = if is_long { doubled * unit } else { 0.0 };
        (amplitude, doubled * unit * unit)
    }
}

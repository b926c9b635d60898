//! The third harmonic of a window, beyond what the wave itself puts there.

use num_complex::Complex32;

use super::course::Course;
use super::examine::Remains;
use super::model::Model;
use super::prediction::Slopes;
use super::seen::Seen;
use super::waves::Waves;
use crate::scalar::greater;

/// Where the image of a line answers in a block with less than one over this, it is not among what looks like noise.
const IMAGE: f32 = 6.0;
/// The lines of a limiter whose image is looked for, by how many carriers these are from the third harmonic: its own, and that of the fifth.
const IMAGES: [i64; 2] = [6, 8];
/// No image is slow at more samples a period.
const FEW: f32 = 10.5;
/// Of fewer blocks a line beside the first would leave too few degrees of freedom.
const LEAST_BLOCKS: u16 = 5;
/// Below this share of what they have apart a line and its image are one.
const APART: f32 = 0.02;

/// Gathers the third-harmonic sums of the blocks, turned back by the carrier, less what the wave itself puts there in blocks that do
/// not fit its period.
pub(super) struct Thirds {
    /// By what the line looked at turns in a block.
    turn: Complex32,
    sum: [Complex32; 2],
    power: f32,
    /// The most of it in a block.
    most: f32,
    watched: u16,
}

impl Thirds {
    /// Those of a line that turns so in a block.
    pub(super) fn of(turn: Complex32) -> Self {
        Self {
            turn,
            sum: [Complex32::ZERO; 2],
            power: 0.0,
            most: 0.0,
            watched: 0,
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
                *sum = *sum * thirds.turn + rest;
                thirds.power += rest.norm_sqr();
            }
            thirds.most = greater(thirds.power - before, thirds.most);
            thirds.watched += 1;
        }
        *self = thirds;
    }

    /// The amplitudes and their noise; `image` are the sums of a second line.
    #[inline(never)]
    pub(super) fn conclude(&self, model: &Model, image: Option<&Self>, remains: &mut Remains) {
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
        let mut explained = self.sum.map(|sum| sum.norm_sqr() * per_count);
        let mut per_line = amplitude * amplitude * per_count;
        let left = |explained: &[f32; 2]| greater(self.power - (explained[0] + explained[1]), 0.0);
        let incoherent = left(&explained);
        remains.third_noise = incoherent * power * (watched * per_both);
        remains.third_alone = remains.third_noise;
        if let Some(image) = image
            && self.take_image(image, &mut explained)
        {
            remains.third_alone = left(&explained) * power * watched / (freedom - 4.0);
            per_line *= 0.5;
        }
        remains.third_spared = (self.power - self.most) * power * (watched * per_both);
        remains.third = explained.map(|explained| explained * per_line);
        remains.third_freedom = freedom;
    }

    /// Adds to what the line explains of each pick-off's sums what its image explains beside it; false where both are one.
    #[cold]
    #[inline(never)]
    fn take_image(&self, image: &Self, explained: &mut [f32; 2]) -> bool {
        // Both lines, block for block before the last one, one against the other.
        let (mut mixed, mut unit) = (Complex32::ZERO, Complex32::ONE);
        let against = self.turn * image.turn.conj();
        for _ in 0..self.watched {
            mixed += unit;
            unit *= against;
        }
        let count = f32::from(self.watched);
        let apart = count * count - mixed.norm_sqr();
        if self.watched < LEAST_BLOCKS || apart < APART * count * count {
            return false;
        }
        for ((explained, line), other) in explained.iter_mut().zip(self.sum).zip(image.sum) {
            // What is left of the other sum when the line is taken out, and of the unit that it answers to.
            let rest = other - line * mixed.conj() / count;
            *explained += rest.norm_sqr() * count / apart;
        }
        true
    }
}

/// By what a third harmonic turns in a block where the carrier turns so.
pub(super) fn cube(turn: Complex32) -> Complex32 {
    turn * turn * turn
}

/// By what the image of a limiter's line turns in a block, where so few samples a period bring one next to the third harmonic that it
/// would look like noise there.
#[inline]
pub(super) fn image_turn(model: &Model) -> Option<Complex32> {
    if model.layout.step.period() > FEW {
        return None;
    }
    slow_image(model)
}

#[cold]
#[inline(never)]
fn slow_image(model: &Model) -> Option<Complex32> {
    let (carrier, length) = (model.carrier, i64::from(model.layout.length));
    // A tone `carriers` away adds up to the sine of all its turn over that of a sample's.
    let answer = |carriers: i64| carrier.after_half_samples(carriers).unit().im.abs();
    let [own, fifth] = IMAGES.map(answer);
    let (carriers, nearest) = if own < fifth {
        (IMAGES[0], own)
    } else {
        (IMAGES[1], fifth)
    };
    let is_slow = nearest * (length as f32) < IMAGE;
    let half_samples = 2 * length * (3 - carriers);
    is_slow.then(|| carrier.after_half_samples(half_samples).unit())
}

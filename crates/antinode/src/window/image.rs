//! The alias of a harmonic next to the third: at few samples a period it would look like noise there, and hide the third harmonic that a
//! limiter leaves.

use num_complex::Complex32;

use super::examine::Remains;
use super::model::Model;
use super::third::{Line, Thirds};
use crate::phase::PhaseStep;
use crate::scalar::greater;

/// Lowest frequency at which an image can be near: below it, at more than 10.5 samples a period, none is.
const MIN_STEP: PhaseStep = PhaseStep((4_294_967_296.0 / 10.5) as u32);
/// Distance of an image, as [`near`] measures it, below which it is taken out: a block shows more than one over this of it. Beyond, it
/// stays in what looks like noise.
const MAX_DISTANCE: f32 = 6.0;
/// The same for the image of the second harmonic, which common electronics have: if that is nearer, no image is taken out.
const MIN_SECOND_DISTANCE: f32 = 0.55;
/// Fewest blocks with which a second line leaves enough degrees of freedom.
const MIN_BLOCKS: u16 = 5;
/// A line and its image cannot be told apart if their determinant is below this share of that of independent lines.
const MIN_DETERMINANT: f32 = 0.02;

/// The image that a window would take for noise, if any.
#[inline]
pub(super) fn of(model: &Model) -> Option<Line> {
    if model.layout.step.0 < MIN_STEP.0 {
        return None;
    }
    near(model)
}

/// The nearer image, if it is near enough. Distances are those from the third harmonic, times the samples of a block.
#[cold]
#[inline(never)]
fn near(model: &Model) -> Option<Line> {
    // Over a block a tone n carriers away sums to no more than one over this: the sine of half its turn in a sample.
    let half_turn_sine = |carriers: i64| model.carrier.after_half_samples(carriers).unit().im.abs();
    let (second, own, fifth) = (half_turn_sine(5), half_turn_sine(6), half_turn_sine(8));
    let (line, nearest) = if own < fifth {
        (Line::OwnImage, own)
    } else {
        (Line::ImageOfFifth, fifth)
    };
    let samples = f32::from(model.layout.length);
    // Near five samples a period the second harmonic's image is there, and would be taken for a limiter's.
    (nearest * samples < MAX_DISTANCE && second * samples > MIN_SECOND_DISTANCE).then_some(line)
}

impl Thirds {
    /// Takes this image out of the noise about the third harmonic and into that harmonic's amplitudes: after a limiter both are about as
    /// large.
    #[cold]
    #[inline(never)]
    pub(super) fn take_out(&self, thirds: &Thirds, model: &Model, remains: &mut Remains) {
        // The sum over all blocks of the phase of one line against the other.
        let against = Line::Third.turn(model.turn) * self.line.turn(model.turn).conj();
        let (mut mixed, mut unit) = (Complex32::ZERO, Complex32::ONE);
        for _ in 0..model.blocks {
            mixed += unit;
            unit *= against;
        }
        let count = f32::from(model.blocks);
        let determinant = count * count - mixed.norm_sqr();
        if model.blocks < MIN_BLOCKS || determinant < MIN_DETERMINANT * count * count {
            return;
        }
        let (amplitude, power) = Self::scales(model);
        let mut left = thirds.power;
        let sums = thirds.sum.iter().zip(&self.sum);
        for (third, (sum, other)) in remains.third.iter_mut().zip(sums) {
            // The image's sum less what the line adds to it.
            let rest = other - sum * mixed.conj() / count;
            let explained = sum.norm_sqr() / count + rest.norm_sqr() * count / determinant;
            left -= explained;
            *third = 0.5 * explained * amplitude * amplitude / count;
        }
        remains.third_without_image = greater(left, 0.0) * power / (remains.third_freedom - 4.0);
    }
}

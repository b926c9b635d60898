//! The image of a harmonic that sampling brings next to the third: in a window of few samples a period it would look like noise there, and
//! hide the third harmonic that a limiter leaves.

use num_complex::Complex32;

use super::examine::Remains;
use super::model::Model;
use super::third::{Line, Thirds};
use crate::phase::PhaseStep;
use crate::scalar::greater;

/// No image is slow at a lower frequency: at more than 10.5 samples a period.
const LEAST: PhaseStep = PhaseStep((4_294_967_296.0 / 10.5) as u32);
/// Where an image answers in a block with less than one over this, it is left among what looks like noise.
const SLOW: f32 = 6.0;
/// The same of the second harmonic, which common electronics have: where it is nearer than that, nothing is told from it.
const SECOND: f32 = 0.55;
/// Of fewer blocks a line beside the first would leave too few degrees of freedom.
const LEAST_BLOCKS: u16 = 5;
/// Below this share of what they have apart a line and its image are one.
const APART: f32 = 0.02;

/// The image that a window would take for noise.
#[inline]
pub(super) fn of(model: &Model) -> Option<Line> {
    if model.layout.step.0 < LEAST.0 {
        return None;
    }
    slow(model)
}

#[cold]
#[inline(never)]
fn slow(model: &Model) -> Option<Line> {
    // A block adds up a tone so many carriers away to the sine of all its turn over that of a sample's.
    let answer = |carriers: i64| model.carrier.after_half_samples(carriers).unit().im.abs();
    let (second, own, fifth) = (answer(5), answer(6), answer(8));
    let (line, nearest) = if own < fifth {
        (Line::OwnImage, own)
    } else {
        (Line::ImageOfFifth, fifth)
    };
    let samples = f32::from(model.layout.length);
    // Near five samples a period the second harmonic has its image there: it would be taken for a limiter's.
    (nearest * samples < SLOW && second * samples > SECOND).then_some(line)
}

impl Thirds {
    /// Takes this image out of what looks like noise about the third harmonic, and into the latter's amplitudes: of a limiter both are about
    /// as large.
    #[cold]
    #[inline(never)]
    pub(super) fn take_out(&self, thirds: &Thirds, model: &Model, remains: &mut Remains) {
        // Both lines, block for block before the last one, one against the other.
        let against = Line::Third.turn(model.turn) * self.line.turn(model.turn).conj();
        let (mut mixed, mut unit) = (Complex32::ZERO, Complex32::ONE);
        for _ in 0..thirds.watched {
            mixed += unit;
            unit *= against;
        }
        let count = f32::from(thirds.watched);
        let apart = count * count - mixed.norm_sqr();
        if thirds.watched < LEAST_BLOCKS || apart < APART * count * count {
            return;
        }
        let (amplitude, power) = Self::scales(model);
        let mut left = thirds.power;
        let sums = thirds.sum.iter().zip(&self.sum);
        for (third, (sum, other)) in remains.third.iter_mut().zip(sums) {
            // What is left of the other sum when the line is taken out, and of the unit that it answers to.
            let rest = other - sum * mixed.conj() / count;
            let explained = sum.norm_sqr() / count + rest.norm_sqr() * count / apart;
            left -= explained;
            *third = 0.5 * explained * amplitude * amplitude / count;
        }
        remains.third_alone = greater(left, 0.0) * power / (remains.third_freedom - 4.0);
    }
}

//! The phasors of both waves and of the carrier, from block to block of a window.

use num_complex::Complex32;

use super::model::Model;
use super::waves::Waves;
use crate::exponential::growth;
use crate::phase::Phase;

/// Blocks from one exact exponential to the next; between them a recursion.
pub(super) const CHUNK: usize = 5;

/// z₊ and z₋ at the middles of a chunk's blocks, turned with the carrier: their halves, which is what C sees of each.
pub(super) type Course = [[Complex32; CHUNK]; 2];

/// Both waves at one block of them.
#[inline(always)]
pub(super) fn at([plus, minus]: &Course, block: usize) -> [Complex32; 2] {
    [plus[block], minus[block]]
}

/// A factor near 1, j, −1 or −j, and what it is of that beyond one: its own rounding, the same at every block, is then no bias.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    whole: Complex32,
    beyond: Complex32,
}

impl Turn {
    /// None at all.
    pub(super) const NONE: Self = Self {
        whole: Complex32::ONE,
        beyond: Complex32::ZERO,
    };

    pub(super) fn by(Phase(phase): Phase) -> Self {
        let whole = phase.wrapping_add(1 << 29) & (3 << 30);
        let rest = phase.wrapping_sub(whole);
        // 1 − cos x = 2 sin² ½x keeps its digits.
        let half = Phase((rest as i32 >> 1) as u32).unit().im;
        Self {
            whole: Phase(whole).unit(),
            beyond: Complex32::new(-2.0 * half * half, Phase(rest).unit().im),
        }
    }

    /// This factor times 1 + `growth`.
    fn grown(self, growth: Complex32) -> Self {
        Self {
            beyond: growth + growth * self.beyond + self.beyond,
            ..self
        }
    }

    /// The factor as one number.
    pub(super) fn rounded(self) -> Complex32 {
        self.whole + self.whole * self.beyond
    }

    /// What one over this factor is beyond one over its whole part.
    fn inverse(self) -> Complex32 {
        let square = self.beyond.norm_sqr();
        (self.beyond + square) * (-1.0 / (1.0 + 2.0 * self.beyond.re + square))
    }
}

/// That of the blocks from block `index` of a window on, but for what [`mend`] adds: they may be more than the window has.
#[inline(never)]
pub(super) fn course(model: &Model, waves: &Waves, index: usize) -> Course {
    let (u, unit) = model.carrier(index + CHUNK / 2);
    let half = unit * 0.5;
    [
        outwards(model, waves.value[0] * half, waves.slope[0], u),
        outwards(model, waves.value[1] * half, waves.slope[1], u),
    ]
}

/// A wave from its chunk's middle outwards: at time `u`, where it is `middle` but for what it has grown since the window's middle.
#[inline(always)]
fn outwards(model: &Model, mut middle: Complex32, slope: Complex32, u: f32) -> [Complex32; CHUNK] {
    if u != 0.0 {
        middle += middle * growth(slope * u);
    }
    // What a block does to the wave beyond what it does to the carrier.
    let turn = model.turn.grown(growth(slope * model.advance));
    let (back, on) = (turn.inverse(), turn.beyond);
    let by = |z: Complex32, beyond: Complex32| z + z * beyond;
    let (before, after) = (by(middle, back), by(middle, on));
    [by(before, back), before, middle, after, by(after, on)]
}

/// Adds to the first `count` blocks of a course what blocks of no whole periods, and changes that are not exponential, do to it.
#[inline(always)]
pub(super) fn mend(course: &mut Course, model: &Model, waves: &Waves, index: usize, count: usize) {
    // A slope may be that of a steady wave: then it adds nothing.
    if model.turn.whole.re < 1.0 || waves.slope[0].re == 0.0 || waves.slope[1].re == 0.0 {
        turn_and_bend(course, model, waves, index, count);
    }
}

#[cold]
#[inline(never)]
fn turn_and_bend(course: &mut Course, model: &Model, waves: &Waves, index: usize, count: usize) {
    let whole = model.turn.whole;
    let mut turned = (whole * whole).conj();
    let rests = waves.rest();
    for i in 0..count.min(CHUNK) {
        let (u, unit) = model.carrier(index + i);
        for (wave, rest) in course.iter_mut().zip(rests) {
            // What turns by quarters loses no digits.
            wave[i] = wave[i] * turned + rest * unit * (0.5 * u);
        }
        turned *= whole;
    }
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;

    use super::*;
    use crate::block::Layout;
    use crate::calibration::Calibration;
    use crate::phase::PhaseStep;

    #[test]
    fn a_chunk_keeps_its_digits_whatever_a_block_turns() {
        let mut seed = 1u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / 8_388_608.0 - 1.0
        };
        // A fifth, a quarter, half of a period and all of it; a third is the furthest from a whole number of quarters.
        for (length, limit) in [
            (4u16, 1.5e-7),
            (5, 1.5e-7),
            (9, 1.5e-7),
            (19, 1.5e-7),
            (6, 2.4e-7),
        ] {
            let mut squares = 0.0;
            for _ in 0..1000 {
                let carrier = PhaseStep::from_period(18.75 + 0.5 * random());
                let layout = Layout::new::<f32>(carrier, length);
                let model = Model::new(
                    layout,
                    carrier,
                    CHUNK as u16,
                    Calibration::IDEAL,
                    1e5,
                    false,
                );
                let value = Complex32::new(random(), random());
                let slope = Complex32::new(1e-3 * random(), 0.05 * random());
                let waves = Waves {
                    value: [value; 2],
                    slope: [slope; 2],
                    ..Waves::default()
                };
                let mut course = course(&model, &waves, 0);
                mend(&mut course, &model, &waves, 0, CHUNK);
                // The last block is the worst.
                let u = 1.0 - 1.0 / CHUNK as f64;
                let samples = f64::from(length) * 0.5 * (CHUNK - 1) as f64;
                let turns = f64::from(carrier.0) / 4_294_967_296.0 * samples;
                let phase = core::f64::consts::TAU * turns + u * f64::from(slope.im);
                let (sine, cosine) = libm::sincos(phase);
                let long = |z: Complex32| Complex64::new(f64::from(z.re), f64::from(z.im));
                let grown = Complex64::new(cosine, sine) * libm::exp(u * f64::from(slope.re));
                let truth = long(value) * grown * 0.5;
                let error = long(course[0][CHUNK - 1]) - truth;
                squares += error.norm_sqr() / truth.norm_sqr();
            }
            let error = libm::sqrt(squares / 1000.0);
            assert!(error < limit, "blocks of {length}: {error:e}");
        }
    }
}

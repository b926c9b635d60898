//! The phasors of both waves and of the carrier, from block to block of a window.

use num_complex::Complex32;

use super::model::Model;
use super::waves::Waves;
use crate::exponential::growth;
use crate::phase::Phase;

/// Blocks from one exact exponential to the next; between them a recursion.
pub(super) const CHUNK: usize = 5;

/// One block's phasors, and what is left of its sums.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Here {
    /// Time of the block's middle, −1 to 1 over the window.
    pub u: f32,
    /// The carrier at the block's middle.
    pub unit: Complex32,
    /// z₊ and z₋ there, turned with the carrier: their halves, which is what C sees of each.
    pub waves: [Complex32; 2],
    /// What a slope of the offset of the pick-off looked at adds to its odd sum there.
    pub slope: f32,
    /// What both pick-offs leave beside the waves: the sum of the squares.
    pub power: f32,
    /// The squared sums, from the first block to this one, of what is left along z.
    pub run: f32,
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

    /// Multiplies by the factor, of which the whole part is 1 where `is_near`: mostly, for a block is about whole periods.
    #[inline(always)]
    fn apply(self, z: Complex32, is_near: bool) -> Complex32 {
        let z = z + z * self.beyond;
        if is_near { z } else { z * self.whole }
    }
}

/// Fills in the blocks from block `index` of a window on, up to [`CHUNK`].
#[inline(never)]
pub(super) fn fill(model: &Model, waves: &Waves, index: usize, here: &mut [Here]) {
    let Model { advance, turn, .. } = *model;
    let (mut u, mut unit) = model.carrier(index);
    let half = unit * 0.5;
    let at = |w: usize| waves.value[w & 1] * (growth(waves.slope[w & 1] * u) + 1.0) * half;
    let mut running = [at(0), at(1)];
    // What a block does to each wave beyond what it does to the carrier.
    let grown = |w: usize| turn.grown(growth(waves.slope[w & 1] * advance));
    let turns = [grown(0), grown(1)];
    let is_near = turn.whole == Complex32::ONE;
    // Only residuals are turned by it: they have no digits to lose.
    let turn = turn.rounded();
    for here in &mut *here {
        *here = Here {
            u,
            unit,
            waves: running,
            slope: 0.0,
            power: 0.0,
            run: 0.0,
        };
        u += advance;
        unit *= turn;
        running = [
            turns[0].apply(running[0], is_near),
            turns[1].apply(running[1], is_near),
        ];
    }
    if waves.slope.contains(&Complex32::ZERO) {
        bend(here, waves);
    }
}

/// Adds to each wave what of its change is not exponential.
#[cold]
#[inline(never)]
fn bend(here: &mut [Here], waves: &Waves) {
    let rest = waves.rest();
    for here in here {
        for (wave, rest) in here.waves.iter_mut().zip(rest) {
            *wave += rest * here.unit * (0.5 * here.u);
        }
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
                let mut here = [Here::default(); CHUNK];
                fill(&model, &waves, 0, &mut here);
                // The last block is the worst.
                let u = 1.0 - 1.0 / CHUNK as f64;
                let samples = f64::from(length) * 0.5 * (CHUNK - 1) as f64;
                let turns = f64::from(carrier.0) / 4_294_967_296.0 * samples;
                let phase = core::f64::consts::TAU * turns + u * f64::from(slope.im);
                let (sine, cosine) = libm::sincos(phase);
                let long = |z: Complex32| Complex64::new(f64::from(z.re), f64::from(z.im));
                let grown = Complex64::new(cosine, sine) * libm::exp(u * f64::from(slope.re));
                let truth = long(value) * grown * 0.5;
                let error = long(here[CHUNK - 1].waves[0]) - truth;
                squares += error.norm_sqr() / truth.norm_sqr();
            }
            let error = libm::sqrt(squares / 1000.0);
            assert!(error < limit, "blocks of {length}: {error:e}");
        }
    }
}

//! What a block is, and the reference that its samples are multiplied with.

use crate::phase::{Phase, PhaseStep};

/// What a block is: its reference frequency, its count of sample pairs, and how its reference is rounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Reference frequency. Within 1 % of the wave's for the stated accuracy.
    pub step: PhaseStep,
    /// Sample pairs in a block, 1 to the capacity of the [`Demodulator`](super::Demodulator).
    pub length: u16,
    /// The whole number that stands for a reference of one, 1 to 32 767; 0 if the reference is not rounded.
    pub scale: u16,
}

/// The reference at one sample of a block, times the scale if there is one.
#[derive(Debug, Clone, Copy, Default)]
pub struct Reference {
    pub cosine: f32,
    pub sine: f32,
    pub third_cosine: f32,
    pub third_sine: f32,
}

impl Layout {
    /// Blocks whose reference is not rounded: those of f32.
    pub(crate) const fn unrounded(step: PhaseStep, length: u16) -> Self {
        Self {
            step,
            length,
            scale: 0,
        }
    }

    /// Twice the time from the middle of the block to sample `index`, in samples.
    pub(crate) fn twice_from_middle(self, index: u16) -> i64 {
        2 * i64::from(index) + 1 - i64::from(self.length)
    }

    /// The reference at sample `index`: the demodulator and the solution both compute it, so that it need not be handed over.
    pub(crate) fn reference(self, index: u16) -> Reference {
        let twice = self.twice_from_middle(index);
        // Computed after the middle and mirrored before it: exactly even and odd in spite of rounding.
        let phase = self.step.after_half_samples(twice.abs());
        let side = if twice < 0 { -1.0 } else { 1.0 };
        let ([cosine, sine], [third_cosine, third_sine]) = if self.scale == 0 {
            let unit = phase.unit();
            let carrier = [unit.re, unit.im];
            (carrier, third_harmonic(carrier))
        } else {
            let rounded = |phase: Phase| phase.scaled_unit(self.scale).map(f32::from);
            (rounded(phase), rounded(Phase(phase.0.wrapping_mul(3))))
        };
        Reference {
            cosine,
            sine: side * sine,
            third_cosine,
            third_sine: side * third_sine,
        }
    }

    /// The value of a reference of one in the sums.
    pub(crate) fn one(self) -> f32 {
        f32::from(self.scale.max(1))
    }
}

/// cos 3φ and sin 3φ from cos φ and sin φ.
fn third_harmonic([cosine, sine]: [f32; 2]) -> [f32; 2] {
    let square = 4.0 * cosine * cosine;
    [cosine * (square - 3.0), sine * (square - 1.0)]
}

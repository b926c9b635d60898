//! The phasors of both waves and of the carrier, from block to block of a window.

use num_complex::Complex32;

use super::model::Model;
use super::waves::Waves;

/// Blocks from one exact exponential to the next; between them a recursion, whose rounding grows by 6·10⁻⁸ a block.
pub(super) const CHUNK: usize = 10;

/// One block's phasors.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Here {
    /// Time of the block's middle, −1 to 1 over the window.
    pub u: f32,
    /// The carrier at the block's middle.
    pub unit: Complex32,
    /// z₊ and z₋ there, turned with the carrier.
    pub waves: [Complex32; 2],
}

/// The phasors of up to [`CHUNK`] blocks.
pub(super) type Chunk = [Here; CHUNK];

/// Walks through the blocks of a window.
pub(super) struct Course<'a> {
    model: &'a Model,
    waves: &'a Waves,
    /// What a block adds to the phase and the logarithm of each wave, as a factor.
    factor: [Complex32; 2],
    turn: Complex32,
    /// Time between two blocks.
    advance: f32,
    index: u16,
}

impl<'a> Course<'a> {
    pub(super) fn new(model: &'a Model, waves: &'a Waves) -> Self {
        let turn = model
            .carrier
            .after_half_samples(2 * i64::from(model.layout.length))
            .unit();
        let advance = 2.0 / f32::from(model.blocks);
        Self {
            model,
            waves,
            factor: waves.slope.map(|slope| exponential(slope * advance) * turn),
            turn,
            advance,
            index: 0,
        }
    }

    /// Fills in the next blocks, up to [`CHUNK`].
    #[inline(never)]
    pub(super) fn next(&mut self, here: &mut [Here]) {
        let waves = self.waves;
        let mut u = self.model.time(self.index);
        let mut unit = self.model.phase(self.index).unit();
        let at = |w: usize| waves.value[w & 1] * exponential(waves.slope[w & 1] * u) * unit;
        let mut running = [at(0), at(1)];
        let is_bent = waves.rest != [Complex32::ZERO; 2];
        self.index += here.len() as u16;
        for here in here {
            *here = Here {
                u,
                unit,
                waves: running,
            };
            if is_bent {
                here.waves[0] += waves.rest[0] * unit * u;
                here.waves[1] += waves.rest[1] * unit * u;
            }
            u += self.advance;
            unit *= self.turn;
            running = [running[0] * self.factor[0], running[1] * self.factor[1]];
        }
    }
}

/// e^x for |x| up to 1: within 3·10⁻⁶ there, and 10⁻⁸ up to 0.5.
pub(super) fn exponential(x: Complex32) -> Complex32 {
    const INVERSE: [f32; 8] = [
        1.0 / 8.0,
        1.0 / 7.0,
        1.0 / 6.0,
        1.0 / 5.0,
        1.0 / 4.0,
        1.0 / 3.0,
        1.0 / 2.0,
        1.0,
    ];
    // Four terms leave 3·10⁻⁹ here.
    let small = x.norm_sqr() < 0.05 * 0.05;
    let terms = if small { &INVERSE[4..] } else { &INVERSE[..] };
    terms
        .iter()
        .fold(Complex32::ONE, |sum, &inverse| sum * x * inverse + 1.0)
}

//! The right-hand sides of the normal equations, of the sums themselves or of what is left of them.

use num_complex::Complex32;

use super::course::CHUNK;
use super::model::Model;
use super::response::{Response, Whitened};
use super::seen::Seen;

/// The sums that make the right-hand side of one pick-off.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Gradient {
    /// Along z, block for block.
    pub level: Complex32,
    /// Along z′.
    pub slope: Complex32,
    /// Of the means: an offset is so often in it.
    pub mean: f32,
}

impl Gradient {
    /// Takes a block in whose middle, at time `u`, the carrier is `unit`; `known` is what its mean says of the wave.
    #[inline(always)]
    pub(super) fn take(
        &mut self,
        response: &Response,
        sums: &Whitened,
        known: f32,
        u: f32,
        unit: Complex32,
    ) {
        let Response {
            mean, even, odd, ..
        } = response;
        let along = Complex32::new(
            mean.level * known + even.level * sums.even,
            odd.level * sums.odd,
        );
        let across = Complex32::new(
            -odd.slope * sums.odd,
            mean.slope * known + even.slope * sums.even,
        );
        let back = unit.conj();
        self.level += along * back;
        self.slope += (along * u + across) * back;
        self.mean += sums.mean;
    }
}

/// The right-hand sides of both pick-offs' sums, nothing taken off them.
#[inline(never)]
pub(super) fn of_sums(model: &Model, blocks: &[Seen]) -> [Gradient; 2] {
    let mut gradients = [Gradient::default(); 2];
    let (response, shared) = (model.response, model.shared);
    let (advance, turn) = (model.advance, model.turn.rounded());
    for (chunk, blocks) in blocks.chunks(CHUNK).enumerate() {
        let (mut u, mut unit) = model.carrier(chunk * CHUNK);
        for block in blocks {
            for (gradient, sums) in gradients.iter_mut().zip(&block.whitened) {
                gradient.take(&response, sums, shared * sums.mean, u, unit);
            }
            u += advance;
            unit *= turn;
        }
    }
    gradients
}

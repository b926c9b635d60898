//! The right-hand sides of the normal equations, from the sums themselves or from their residuals.

use num_complex::Complex32;

use super::course::CHUNK;
use super::model::Model;
use super::seen::Seen;

/// The sums that make the right-hand side of one pick-off.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Gradient {
    /// Along z, summed over the blocks.
    pub level: Complex32,
    /// Along z′.
    pub slope: Complex32,
    /// Sum of the means, to which an offset adds as often as there are blocks.
    pub mean: f32,
}

/// The right-hand sides from both pick-offs' sums themselves.
#[inline(never)]
pub(super) fn of_sums(model: &Model, blocks: &[Seen]) -> [Gradient; 2] {
    let mut gradients = [Gradient::default(); 2];
    let (response, shared) = (model.response, model.shared);
    let (advance, turn) = (model.advance, model.turn);
    for (chunk, blocks) in blocks.chunks(CHUNK).enumerate() {
        let (mut u, mut unit) = model.carrier(chunk * CHUNK);
        for block in blocks {
            let back = unit.conj();
            for (gradient, sums) in gradients.iter_mut().zip(&block.whitened) {
                let known = shared * sums.mean;
                let along = response.along(sums, known);
                gradient.level += along * back;
                gradient.slope += (along * u + response.across(sums, known)) * back;
                gradient.mean += sums.mean;
            }
            u += advance;
            unit *= turn;
        }
    }
    gradients
}

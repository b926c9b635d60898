//! The right-hand sides of the normal equations, of the sums themselves or of what is left of them.

use num_complex::Complex32;

use super::course::{CHUNK, Carrier};
use super::model::Model;
use super::normal::Row;
use super::response::{Response, Whitened};
use super::seen::Seen;

/// The sums that make the right-hand side of one pick-off.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Gradient {
    /// Along z, block for block.
    pub level: Complex32,
    /// Along z′ a sample.
    slope: Complex32,
    mean: f32,
}

impl Gradient {
    /// Takes a block whose middle lies `time` samples from that of the window, where the carrier is `unit`.
    #[inline(always)]
    pub(super) fn take(
        &mut self,
        response: &Response,
        sums: &Whitened,
        time: f32,
        unit: Complex32,
    ) {
        let Response {
            known, even, odd, ..
        } = response;
        let along = Complex32::new(
            known.level * sums.mean + even.level * sums.even,
            odd.level * sums.odd,
        );
        let across = Complex32::new(
            odd.slope * sums.odd,
            known.slope * sums.mean + even.slope * sums.even,
        );
        let back = unit.conj();
        self.level += along * back;
        self.slope += (along * time + across) * back;
        self.mean += sums.mean;
    }

    /// The right-hand side, even and odd, its slope scaled to half windows.
    pub(super) fn sides(&self, model: &Model) -> [Row; 2] {
        let slope = self.slope * model.per_half;
        [
            [self.level.re, slope.im, model.response.offset * self.mean],
            [self.level.im, slope.re, 0.0],
        ]
    }
}

/// The right-hand sides of both pick-offs' sums, nothing taken off them.
#[inline(never)]
pub(super) fn of_sums(model: &Model, blocks: &[Seen]) -> [Gradient; 2] {
    let mut gradients = [Gradient::default(); 2];
    let mut carrier = Carrier::new(model);
    let (half, advance, turn) = (model.half, model.advance, model.turn.rounded());
    for chunk in blocks.chunks(CHUNK) {
        let (mut u, mut unit) = carrier.next();
        for block in chunk {
            for (gradient, sums) in gradients.iter_mut().zip(&block.whitened) {
                gradient.take(&model.response, sums, u * half, unit);
            }
            u += advance;
            unit *= turn;
        }
    }
    gradients
}

//! One pass over a window's blocks: which way its parameters must move.

use num_complex::Complex32;

use super::course::{CHUNK, Chunk, Course, Here};
use super::model::Model;
use super::normal::Row;
use super::prediction::{Mixing, Prediction};
use super::response::Response;
use super::seen::Seen;
use super::waves::Waves;

/// The gradient of both pick-offs' parameters.
#[inline(never)]
pub(super) fn gradient(
    model: &Model,
    blocks: &[Seen],
    waves: &Waves,
    offsets: [f32; 2],
    here: &mut Chunk,
) -> [Row; 2] {
    let mixing = Mixing::new(model, waves);
    let predictions = Prediction::new(model, &mixing, offsets);
    let mut course = Course::new(model, waves);
    let mut gathered = [Gathered::default(); 2];
    for chunk in blocks.chunks(CHUNK) {
        let here = here.get_mut(..chunk.len()).unwrap_or_default();
        course.next(here);
        for (channel, prediction) in predictions.iter().enumerate() {
            gathered[channel].add(model, prediction, channel, chunk, here);
        }
    }
    let per_sample = 1.0 / model.half();
    gathered.map(|gathered| {
        let slope = gathered.slope * per_sample;
        [
            gathered.level.re,
            gathered.level.im,
            slope.re,
            slope.im,
            model.response.offset * gathered.mean,
        ]
    })
}

/// The sums that make the gradient of one pick-off.
#[derive(Debug, Clone, Copy, Default)]
struct Gathered {
    level: Complex32,
    slope: Complex32,
    mean: f32,
}

impl Gathered {
    /// Takes a run of blocks of one pick-off: one at a time, so that its constants stay in registers.
    #[inline(never)]
    fn add(
        &mut self,
        model: &Model,
        prediction: &Prediction,
        channel: usize,
        blocks: &[Seen],
        here: &[Here],
    ) {
        let Response {
            mean, even, odd, ..
        } = model.response;
        let half = model.half();
        let prediction = *prediction;
        let mut sums = *self;
        for (block, here) in blocks.iter().zip(here) {
            let rest = prediction.rest(&block.whitened[channel & 1], here);
            let back = here.unit.conj();
            let along = Complex32::new(
                mean.level * rest.mean + even.level * rest.even,
                odd.level * rest.odd,
            );
            let across = Complex32::new(
                odd.slope * rest.odd,
                mean.slope * rest.mean + even.slope * rest.even,
            );
            sums.level += along * back;
            // The block's own extent; scaled to half windows at the end.
            sums.slope += (along * (here.u * half) + across) * back;
            sums.mean += rest.mean;
        }
        *self = sums;
    }
}

//! What hum does to a window whose blocks have offsets of their own: hum that moves these also runs within each block.

use num_complex::Complex32;

use super::course::{CHUNK, Course, at, bend, course};
use super::model::Model;
use super::prediction::Prediction;
use super::response::Whitened;
use super::seen::Seen;
use super::waves::Waves;

/// Offsets kept of the blocks before a run.
const KEPT: usize = 3;

/// The offsets of the blocks taken so far, beyond that of the window.
#[derive(Default)]
pub(super) struct Hum {
    /// The sum of their squares, of each pick-off.
    pub squares: [f32; 2],
    /// Those of the last blocks, of each pick-off.
    before: [[f32; KEPT]; 2],
    /// The block after the run, and the waves there.
    after: Option<([Whitened; 2], [Complex32; 2])>,
    /// What their slopes add to the odd sums of the pick-off and the run of blocks looked at.
    pub slopes: [f32; CHUNK],
}

impl Hum {
    /// Looks at the block after the run that begins with block `index`, where there is one.
    #[cold]
    #[inline(never)]
    pub fn look_ahead(&mut self, model: &Model, waves: &Waves, index: usize, blocks: &[Seen]) {
        let index = index + CHUNK;
        self.after = blocks.get(index).map(|block| {
            let mut course = course(model, waves, index);
            bend(&mut course, model, waves, index, 1);
            (block.whitened, at(&course, 0))
        });
    }

    /// Takes the run of blocks of pick-off `channel` from block `index` on.
    ///
    /// The slope of a block is that between its neighbours' offsets, less what the wave puts there; of a window's first and last block it is
    /// that of the parabola of least squares through four: as noisy as a straight line through two, and exact to one order more.
    #[cold]
    #[inline(never)]
    pub fn take(
        &mut self,
        model: &Model,
        prediction: &Prediction,
        channel: usize,
        (index, blocks): (usize, &[Seen]),
        course: &Course,
    ) {
        let channel = channel & 1;
        let count = blocks.len().min(CHUNK);
        let [a, b, c] = self.before[channel];
        let mut rests = [a, b, c, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        for (i, block) in blocks.iter().enumerate().take(CHUNK) {
            let rest = prediction.mean_rest(&block.whitened[channel], &at(course, i));
            self.squares[channel] += rest * rest;
            rests[KEPT + i] = rest;
        }
        if index == 0 {
            let [_, _, before, a, b, c, d, ..] = &mut rests;
            *before = *b - slope_at_first([*a, *b, *c, *d]);
        }
        let last: [f32; 4] = core::array::from_fn(|i| rests[(KEPT + count - 1).saturating_sub(i)]);
        rests[KEPT + count] = match &self.after {
            Some((block, waves)) => prediction.mean_rest(&block[channel], waves),
            None => last[1] - slope_at_first(last),
        };
        for (slope, rests) in self.slopes.iter_mut().zip(rests[KEPT - 1..].windows(3)) {
            *slope = model.basis.ramp * (rests[2] - rests[0]);
        }
        self.before[channel] = [last[2], last[1], last[0]];
    }
}

/// The slope over two blocks in the first of four of these offsets.
fn slope_at_first([a, b, c, d]: [f32; 4]) -> f32 {
    1.3 * b + 1.7 * c - 2.1 * a - 0.9 * d
}

//! What hum does to a window whose blocks have offsets of their own: hum that moves these also runs within each block.

use super::course::{CHUNK, Course, at};
use super::model::Model;
use super::prediction::Prediction;
use super::seen::Seen;

/// The offsets of the blocks taken so far, beyond that of the window.
#[derive(Default)]
pub(super) struct Hum {
    /// The sum of their squares, of each pick-off.
    pub squares: [f32; 2],
    /// That of the last block, of each pick-off.
    last: [f32; 2],
    /// What their slopes add to the odd sums of the pick-off and the run of blocks looked at.
    pub slopes: [f32; CHUNK],
}

impl Hum {
    /// Takes the blocks of pick-off `channel` from block `index` on.
    ///
    /// The slope of a block is that between its neighbours' offsets, less what the wave puts there; of the first of a window and the last of
    /// a run, which has its next one yet to come, it is that to the only one.
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
        // A block alone has no slope.
        let ramp = if index + blocks.len() < 2 {
            0.0
        } else {
            model.basis.ramp
        };
        let channel = channel & 1;
        let (mut before, mut now) = (0.0, self.last[channel]);
        for i in 0..=blocks.len() {
            let next = match blocks.get(i) {
                Some(block) if i < CHUNK => {
                    let rest = prediction.mean_rest(&block.whitened[channel], &at(course, i));
                    self.squares[channel] += rest * rest;
                    self.last[channel] = rest;
                    rest
                }
                // One more after the last, in line with the two before it; and one before the first.
                _ => 2.0 * now - before,
            };
            if i == 1 && index == 0 {
                before = 2.0 * now - next;
            }
            if let Some(slope) = self.slopes.get_mut(i.wrapping_sub(1)) {
                *slope = ramp * (next - before);
            }
            (before, now) = (now, next);
        }
    }
}

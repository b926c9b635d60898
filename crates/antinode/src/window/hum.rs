//! What a slope of the offset within a block does to its sums: hum that moves the offsets of blocks also runs within them.

use super::course::{CHUNK, Course, at};
use super::model::Model;
use super::prediction::Prediction;
use super::seen::Seen;

/// Fills in what the slopes of the offset of pick-off `channel` add to the odd sums of a run of blocks that have offsets of their own,
/// and adds the squares of these to `wander`.
///
/// The slope of a block is that between its neighbours' offsets, less what the wave puts there; of the first and the last it is that
/// to the only one.
#[cold]
#[inline(never)]
pub(super) fn take_slopes(
    model: &Model,
    prediction: &Prediction,
    channel: usize,
    blocks: &[Seen],
    course: &Course,
    slopes: &mut [f32; CHUNK],
    wander: &mut [f32; 2],
) {
    // A block alone has no slope.
    let ramp = if blocks.len() < 2 {
        0.0
    } else {
        model.basis.ramp
    };
    let (mut before, mut now) = (0.0, 0.0);
    for i in 0..=blocks.len() {
        let next = match blocks.get(i) {
            Some(block) if i < CHUNK => {
                let rest = prediction.mean_rest(&block.whitened[channel & 1], &at(course, i));
                wander[channel & 1] += rest * rest;
                rest
            }
            // One more after the last, in line with the two before it; and one before the first.
            _ => 2.0 * now - before,
        };
        if i == 1 {
            before = 2.0 * now - next;
        }
        if let Some(slope) = slopes.get_mut(i.wrapping_sub(1)) {
            *slope = ramp * (next - before);
        }
        (before, now) = (now, next);
    }
}

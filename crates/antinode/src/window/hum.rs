//! What a slope of the offset within a block does to its sums: hum that moves the offsets of blocks also runs within them.

use super::course::Here;
use super::model::Model;
use super::prediction::Prediction;
use super::seen::Seen;

/// Fills in what the slopes of both pick-offs' offsets add to the odd sums of a run of blocks that have offsets of their own.
///
/// The slope of a block is that between its neighbours' offsets, less what the wave puts there; of the first and the last it is that
/// to the only one.
#[cold]
#[inline(never)]
pub(super) fn take_slopes(
    model: &Model,
    predictions: &[Prediction; 2],
    blocks: &[Seen],
    here: &mut [Here],
) {
    for (channel, prediction) in predictions.iter().enumerate() {
        // The one before the last, and the last.
        let (mut far, mut near) = (None, None);
        for i in 0..=blocks.len() {
            let next = blocks.get(i).zip(here.get(i));
            let next =
                next.map(|(block, here)| prediction.mean_rest(&block.whitened[channel], here));
            if let Some(slope) = slope(far, near, next)
                && let Some(here) = here.get_mut(i.wrapping_sub(1))
            {
                here.slopes[channel] = model.basis.ramp * slope;
            }
            (far, near) = (near, next);
        }
    }
}

/// The slope at the middle one of three, of which the first and the last may be missing.
fn slope(before: Option<f32>, here: Option<f32>, after: Option<f32>) -> Option<f32> {
    match (before, here?, after) {
        (Some(before), _, Some(after)) => Some(0.5 * (after - before)),
        (Some(before), here, None) => Some(here - before),
        (None, here, Some(after)) => Some(after - here),
        (None, _, None) => None,
    }
}

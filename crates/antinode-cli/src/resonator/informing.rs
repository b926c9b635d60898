//! Which runs tell something by themselves: where a ring-down reaches the noise its last rows are many runs of a few.

use super::DECAY_SEEN;
use super::found::Found;
use crate::runs::Run;

/// A run that tells less of its decay than this share of what the best one tells of its own adds nothing to that.
const LITTLE: f64 = 0.01;

/// The decay of the best run must be so many deviations of another's, or by chance that one seems not to decay.
const SHOWN: f64 = 2.0 * DECAY_SEEN;

/// The runs, from 0, but for those whose rows would not show the decay of the best one, and tell little beside it.
pub fn informing(runs: &[Run], found: &Found) -> Vec<usize> {
    let told: Vec<_> = runs.iter().map(of_decay).collect();
    let best = (0..runs.len()).max_by(|&one, &other| told[one].total_cmp(&told[other]));
    let least = best.map_or(0.0, |best| {
        let (decay, _) = found.decay_of_run(best);
        (LITTLE * told[best]).min((SHOWN / decay).powi(2))
    });
    (0..runs.len()).filter(|&run| told[run] >= least).collect()
}

/// What the amplitudes of a run tell of its decay: one over the variance, s².
fn of_decay(run: &Run) -> f64 {
    let (mut weights, mut mean, mut squares) = (0.0, 0.0, 0.0);
    for row in &run.rows {
        let weight = (row.main / row.deviations[0]).powi(2);
        weights += weight;
        let apart = row.time - mean;
        mean += apart * weight / weights;
        squares += weight * apart * (row.time - mean);
    }
    squares
}

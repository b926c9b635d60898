//! Selection of the runs that are informative by themselves: where a ring-down reaches the noise, its last rows form many short runs.

use super::Resonance;
use crate::line::Times;
use crate::runs::{Row, Run};

/// Deviations below which a decay is not significant.
pub const DECAY_SEEN: f64 = 3.0;
/// Information on the decay, as a share of that of the best run, below which a run adds nothing to that.
const MIN_SHARE: f64 = 0.01;

/// Deviations that the best run's decay must amount to in another run: with fewer, that one may by chance seem not to decay.
const MIN_DEVIATIONS: f64 = 2.0 * DECAY_SEEN;

impl Resonance {
    /// Indices of the runs, without those whose rows would not show the decay of the best one, and add little to it.
    pub fn informing(&self) -> Vec<usize> {
        let Self { runs, found, .. } = self;
        let information: Vec<_> = runs.iter().map(on_decay).collect();
        let best =
            (0..runs.len()).max_by(|&one, &other| information[one].total_cmp(&information[other]));
        let min = best.map_or(0.0, |best| {
            let (decay, _) = found.decay_of_run(best);
            (MIN_SHARE * information[best]).min((MIN_DEVIATIONS / decay).powi(2))
        });
        (0..runs.len())
            .filter(|&run| information[run] >= min)
            .collect()
    }
}

/// Information that the amplitudes of a run have on its decay: one over the variance, s².
fn on_decay(run: &Run) -> f64 {
    let weighted = |row: &Row| [(row.main / row.deviations[0]).powi(2), row.time];
    Times::new(run.rows.iter().map(weighted)).along
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn information_is_that_of_a_line_through_logarithms() {
        // Rows at 0, 1 and 2 s: times are 2 s² in all from their middle.
        let run = |main: f64, noise: f64| Run {
            file: String::new(),
            rows: (0..3)
                .map(|k| Row::of(k.into(), [main, 0.0, 0.0], [noise; 3]))
                .collect(),
        };
        for (main, noise, expected) in [(1.0, 1.0, 2.0), (1.0, 0.01, 2e4), (3.0, 1.0, 18.0)] {
            let information = on_decay(&run(main, noise));
            assert!(
                (information / expected - 1.0).abs() < 1e-12,
                "{information} {expected}"
            );
        }
    }
}

//! How fast the frequency of a run moves: the straight line through its rows.

use super::by_energy::Seen;
use super::found::Measured;
use super::line::Times;

/// Deviations from which on a drift is seen.
const SEEN: f64 = 3.5;

/// A straight line through the frequencies of a run.
pub struct Drift {
    /// Its slope, Hz/s; wider where frequencies scatter about it by more than their deviations, if these are told.
    pub slope: Measured,
    /// The squares of the frequencies, over their variances, that go with it; 0 where it may be noise, or these are not told.
    pub squares: f64,
}

/// The line through a run.
pub fn drift(run: &[Seen], is_told: bool) -> Drift {
    let times = Times::new(run.iter().map(|row| [row.weight, row.time]));
    let slope = times.slope(run.iter().map(|row| row.beyond));
    let squares = slope * slope * times.along;
    let weights: f64 = run.iter().map(|row| row.weight).sum();
    let mean = run.iter().map(|row| row.weight * row.beyond).sum::<f64>() / weights;
    let all = run
        .iter()
        .map(|row| row.weight * (row.beyond - mean).powi(2));
    let scatter = (all.sum::<f64>() - squares) / (run.len() - 2) as f64;
    let scatter = if is_told { scatter.max(1.0) } else { scatter };
    Drift {
        slope: (slope, (scatter / times.along).sqrt()),
        squares: if is_told && squares > SEEN * SEEN * scatter {
            squares
        } else {
            0.0
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deviates::Deviates;

    /// The error of the drift over its deviation, of rows that scatter by `times` of theirs.
    fn off(seed: u64, times: f64, is_told: bool) -> f64 {
        let mut random = Deviates(seed);
        let rows: Vec<_> = (0..60)
            .map(|k| {
                let time = 1000.0 + f64::from(k);
                // Of a wave that decays.
                let std = 1e-3 * (0.02 * f64::from(k)).exp();
                Seen {
                    time,
                    weight: if is_told { std.powi(-2) } else { 1.0 },
                    energy: 0.0,
                    beyond: 5.0 - 2e-4 * time + times * std * random.draw(),
                }
            })
            .collect();
        let (slope, std) = drift(&rows, is_told).slope;
        (slope + 2e-4) / std
    }

    #[test]
    fn stated_deviations_are_the_rms_errors() {
        for (times, is_told, least) in [(1.0, true, 0.85), (3.0, true, 0.9), (1.0, false, 0.9)] {
            let squares: f64 = (0..400).map(|seed| off(seed, times, is_told).powi(2)).sum();
            let rms = (squares / 400.0).sqrt();
            assert!((least..1.15).contains(&rms), "{times}, {is_told}: {rms}");
        }
    }
}

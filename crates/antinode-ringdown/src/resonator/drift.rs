//! Drift of a run's frequency, from a straight line through its points.

use super::by_energy::Point;
use super::found::Measured;
use super::frequency::widened;
use crate::line::Times;

/// Deviations from which on a drift is significant.
const SEEN: f64 = 3.5;

/// A straight line through the frequencies of a run.
pub struct Drift {
    /// Its slope, Hz/s; the deviation is wider if frequencies scatter by more than theirs, and from the scatter alone if these are unknown.
    pub slope: Measured,
    /// Squares of the frequencies, over their variances, that it explains; 0 if it may be noise, or the variances are unknown.
    pub squares: f64,
}

/// The line through a run; `are_weighted` says whether its points have known variances.
pub fn drift(run: &[Point], are_weighted: bool) -> Drift {
    let times = Times::new(run.iter().map(|row| [row.weight, row.time]));
    let (slope, left) = times.line(run.iter().map(|row| row.excess));
    let squares = slope * slope * times.along;
    let scatter = widened(left / (run.len() - 2) as f64, are_weighted);
    Drift {
        slope: (slope, (scatter / times.along).sqrt()),
        squares: if are_weighted && squares > SEEN * SEEN * scatter {
            squares
        } else {
            0.0
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use antinode_sim::Deviates;

    /// The drift of points that fall by 0.2 mHz/s and scatter by `times` their deviations.
    fn falling(seed: u64, times: f64, are_weighted: bool) -> Drift {
        let mut random = Deviates::new(seed);
        let rows: Vec<_> = (0..60)
            .map(|k| {
                let time = 1000.0 + f64::from(k);
                // As for a wave that decays.
                let std = 1e-3 * (0.02 * f64::from(k)).exp();
                Point {
                    time,
                    weight: if are_weighted { std.powi(-2) } else { 1.0 },
                    energy: 0.0,
                    excess: 5.0 - 2e-4 * time + times * std * random.draw(),
                }
            })
            .collect();
        drift(&rows, are_weighted)
    }

    /// The error of the drift over its deviation.
    fn off(seed: u64, times: f64, are_weighted: bool) -> f64 {
        let (slope, std) = falling(seed, times, are_weighted).slope;
        (slope + 2e-4) / std
    }

    #[test]
    fn the_squares_of_a_drift_are_those_beyond_chance() {
        let Drift {
            slope: (slope, std),
            squares,
        } = falling(1, 1.0, true);
        assert!((squares / (slope / std).powi(2) - 1.0).abs() < 0.5 && squares > 100.0);
        // Of more scatter, or of any without deviations, it may be chance.
        assert_eq!(falling(1, 30.0, true).squares, 0.0);
        assert_eq!(falling(1, 1.0, false).squares, 0.0);
    }

    #[test]
    fn stated_deviations_are_the_rms_errors() {
        for (times, are_weighted, min) in [(1.0, true, 0.85), (3.0, true, 0.9), (1.0, false, 0.9)] {
            let squares: f64 = (0..400)
                .map(|seed| off(seed, times, are_weighted).powi(2))
                .sum();
            let rms = (squares / 400.0).sqrt();
            assert!((min..1.15).contains(&rms), "{times}, {are_weighted}: {rms}");
        }
    }
}

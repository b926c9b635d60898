//! Dependence of the frequency on the energy, as distinct from a drift with time: while the wave decays, both change together.
//!
//! So each run gets powers of time of its own, and the energy explains what these leave: a straight line if no drift is seen, as a slow one
//! would not be, and otherwise as many powers as are significant, two at least. What further powers would still explain is not noise, and
//! widens the deviation. All that changes with the energy is attributed to it only if the turning of patterns by their amplitudes agrees;
//! if that gives another value, or none, the dependence is not reported: a temperature that settles may fall just as the energy does.

use super::SIGNIFICANT;
use super::found::Measured;
use super::frequency::widened;
use crate::line::weighted_mean;

/// Highest power of time if no drift is seen; the lowest and highest allowed if one is; and the highest that is computed.
const UNSEEN_POWER: usize = 1;
const MIN_POWER: usize = 2;
const MAX_POWER: usize = 6;
const POWERS: usize = 8;
/// Deviations by which the result may differ from what the turning of patterns says, even if that is not significant.
const MAX_DISAGREEMENT: f64 = 3.0;
/// Deviations beyond chance from which on the reduction of squares by further terms, or a turning of patterns, is significant.
const BEYOND_CHANCE: f64 = 2.0;

/// The frequency at one time, from a row or a stretch of rows.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    /// Time, s.
    pub time: f64,
    /// One over the variance of the frequency, 1/Hz², or 1 if that is unknown.
    pub weight: f64,
    /// a_A² + a_B².
    pub energy: f64,
    /// Frequency without the contribution of the splits, relative to a fixed value, Hz.
    pub excess: f64,
}

/// Rise of the frequency at an energy of one input unit squared, Hz, or why it is not reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ByEnergy {
    /// None: chance explains the dependence.
    Chance,
    /// Confirmed by the turning of patterns, with no drift seen; also the drift, Hz/s, whose effect would be one deviation.
    Alone(Measured, f64),
    /// Determined beside a drift, seen or not.
    Beside(Measured),
    /// Not distinguishable from a drift.
    Ambiguous,
    /// Contradicted by the turning of patterns: it is a drift, or has another cause.
    Denied,
}

impl ByEnergy {
    /// The value, if it is determined.
    pub fn value(self) -> Option<Measured> {
        match self {
            Self::Alone(by, _) | Self::Beside(by) => Some(by),
            Self::Chance | Self::Ambiguous | Self::Denied => None,
        }
    }
}

/// Determines it from the points of each run, if it is significant in the sums of [`without_mean`]. `are_weighted` says whether weights
/// are known, and `by_turning` is the value that the turning of patterns implies.
pub(super) fn by_energy(
    runs: &[Vec<Point>],
    (alone, of_drift): (Sums, f64),
    are_weighted: bool,
    by_turning: Option<Measured>,
) -> ByEnergy {
    let beside = without_powers(runs);
    let (rows, count): (usize, usize) = (runs.iter().map(Vec::len).sum(), runs.len());
    let scatter = |sums: &Sums, unknowns: usize| {
        widened(sums.left() / (rows - unknowns) as f64, are_weighted)
    };
    let noise = scatter(&beside[POWERS], (POWERS + 1) * count + 1);
    let is_more = |before: &Sums, after: usize, terms: usize| {
        let chance = terms as f64 + BEYOND_CHANCE * (2.0 * terms as f64).sqrt();
        before.left() - beside[after].left() > chance * noise
    };
    let is_drift = is_more(&alone, MIN_POWER, (MIN_POWER + 1) * count - 1);
    let (value, std) = alone.measured(scatter(&alone, 2));
    let is_turned = by_turning.is_some_and(|(said, of_said)| said.abs() > BEYOND_CHANCE * of_said);
    let is_denied = |(value, std): Measured| {
        by_turning.is_some_and(|(said, of_said)| {
            (value - said).abs() > MAX_DISAGREEMENT * std.hypot(of_said)
        })
    };
    if !is_drift && is_turned && !is_denied((value, std)) {
        return ByEnergy::Alone((value, std), std / of_drift.abs());
    }
    let mut powers = MIN_POWER..=MAX_POWER;
    let enough = powers.find(|&power| !is_more(&beside[power], power + 2, 2 * count));
    let Some(power) = (if is_drift { enough } else { Some(UNSEEN_POWER) }) else {
        return ByEnergy::Ambiguous;
    };
    let slow = beside[power].left() - beside[POWERS].left();
    let slow = slow / ((POWERS - power) * count) as f64;
    let scatter = scatter(&beside[power], (power + 1) * count + 1).max(slow);
    let by_energy = beside[power].measured(scatter);
    if !beside[power].is_significant(scatter) {
        ByEnergy::Ambiguous
    } else if is_denied(by_energy) {
        ByEnergy::Denied
    } else {
        ByEnergy::Beside(by_energy)
    }
}

/// Weighted sums of products of energy and frequency, after other terms were removed from both.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sums {
    of_energy: f64,
    product: f64,
    of_excess: f64,
}

impl Sums {
    fn add(&mut self, weight: f64, energy: f64, excess: f64) {
        self.of_energy += weight * energy * energy;
        self.product += weight * energy * excess;
        self.of_excess += weight * excess * excess;
    }

    /// Squares of the frequency that the energy explains.
    pub fn along(&self) -> f64 {
        self.product * self.product / self.of_energy
    }

    /// True if these are beyond chance for this scatter.
    pub fn is_significant(&self, scatter: f64) -> bool {
        self.along() > SIGNIFICANT * SIGNIFICANT * scatter
    }

    /// Squares that it does not explain.
    fn left(&self) -> f64 {
        self.of_excess - self.along()
    }

    /// Slope of the frequency over the energy, with its deviation for this scatter.
    fn measured(&self, scatter: f64) -> Measured {
        (
            self.product / self.of_energy,
            (scatter / self.of_energy).sqrt(),
        )
    }
}

/// Sums after removal of one common mean, and the apparent slope over the energy that a drift of 1 Hz/s in every run causes.
pub fn without_mean(runs: &[Vec<Point>]) -> (Sums, f64) {
    let points = || runs.iter().flatten();
    let (mean_energy, _) = weighted_mean(points().map(|point| [point.weight, point.energy]));
    let (mean_excess, _) = weighted_mean(points().map(|point| [point.weight, point.excess]));
    let mut sums = Sums::default();
    let mut along_time = 0.0;
    for run in runs {
        for point in run {
            let energy = point.energy - mean_energy;
            sums.add(point.weight, energy, point.excess - mean_excess);
            along_time += point.weight * energy * (point.time - run[0].time);
        }
    }
    (sums, along_time / sums.of_energy)
}

/// Sums after removal of each run's own mean and powers of time, up to each power.
fn without_powers(runs: &[Vec<Point>]) -> [Sums; POWERS + 1] {
    let mut all = [Sums::default(); POWERS + 1];
    for run in runs {
        let weights: Vec<_> = run.iter().map(|point| point.weight).collect();
        let dot = |one: &[f64], other: &[f64]| -> f64 {
            let products = one.iter().zip(other).zip(&weights);
            products
                .map(|((one, other), weight)| weight * one * other)
                .sum()
        };
        let without = |from: &mut Vec<f64>, what: &[f64]| {
            let share = dot(from, what) / dot(what, what);
            for (from, what) in from.iter_mut().zip(what) {
                *from -= share * what;
            }
        };
        let mut energy: Vec<_> = run.iter().map(|point| point.energy).collect();
        let mut excess: Vec<_> = run.iter().map(|point| point.excess).collect();
        // Scaled to −1 to 1.
        let (first, last) = (run[0].time, run[run.len() - 1].time);
        let times: Vec<_> = run
            .iter()
            .map(|point| (2.0 * point.time - first - last) / (last - first))
            .collect();
        let mut powers = vec![vec![1.0; run.len()]];
        for sums in &mut all {
            let newest = &powers[powers.len() - 1];
            without(&mut energy, newest);
            without(&mut excess, newest);
            for ((weight, energy), excess) in weights.iter().zip(&energy).zip(&excess) {
                sums.add(*weight, *energy, *excess);
            }
            let mut next: Vec<_> = newest
                .iter()
                .zip(&times)
                .map(|(by, time)| by * time)
                .collect();
            for power in &powers {
                without(&mut next, power);
            }
            powers.push(next);
        }
    }
    all
}

#[cfg(test)]
mod tests;

//! The mean frequency of both modes.

use std::f64::consts::TAU;

use super::by_energy::{ByEnergy, Point, by_energy, without_mean};
use super::drift::drift;
use super::found::{Found, Measured};
use super::model::Model;
use super::stretches::{RowFrequency, stretches};
use crate::line::weighted_mean;
use crate::runs::{Row, Run, is_alike};

/// Stretches per run to aim at, if it has that many rows.
const STRETCHES: usize = 100;
/// Difference of the mean by phases from that of the rows' own frequencies, in deviations of one row, that no error of rows explains.
const MAX_CONTRADICTION: f64 = 4.0;

/// The mean frequency of both modes.
#[derive(Debug)]
pub struct Frequency {
    /// The mean, Hz.
    pub mean: Measured,
    /// Rms variation beyond noise, Hz: with the energy, with time, or alike from stretch to stretch; `None` if chance explains it.
    pub moves: Option<f64>,
    /// Its rise with the energy.
    pub by_energy: ByEnergy,
    /// The mean of each run, Hz.
    pub means: Vec<Measured>,
    /// Its drift in each run, Hz/s.
    pub drifts: Vec<Measured>,
    /// The mean by the phases and times of rows, Hz, if rows' own frequencies contradict it; all else is without phases then.
    pub contradicted: Option<f64>,
}

/// Contributions to the frequency of a row.
pub(super) struct Moved {
    /// The part due to the splits, rad/s, as coefficients for [`Found::splits`].
    pub by_splits: [f64; 4],
    /// The same, averaged since the row before by Simpson's rule.
    pub by_splits_since: [f64; 4],
    /// Change of the part due to the pattern's turning since the row before, rad/s.
    pub change: f64,
}

/// The contributions to the frequency of each row.
pub(super) fn moved(found: &Found, runs: &[Run]) -> Vec<Moved> {
    let mut list = Vec::new();
    for (index, run) in runs.iter().enumerate() {
        let terms = found.model.terms(index, run);
        let parameters = Model::parameters(&terms, &found.values);
        let mut motion = found.model.motion(run, &parameters);
        let mut last = &run.rows[0];
        let mut before = motion.frequency_by_turning();
        let mut by_splits_before = motion.frequency_by_splits(0.0);
        for row in &run.rows {
            found.model.advance(&mut motion, last, row);
            let half_back = 0.5 * (last.time - row.time);
            last = row;
            let by_turning = motion.frequency_by_turning();
            let by_splits = motion.frequency_by_splits(0.0);
            let between = motion.frequency_by_splits(half_back);
            let by_splits_since = std::array::from_fn(|i| {
                (by_splits_before[i] + 4.0 * between[i] + by_splits[i]) / 6.0
            });
            by_splits_before = by_splits;
            list.push(Moved {
                by_splits,
                by_splits_since,
                change: by_turning - std::mem::replace(&mut before, by_turning),
            });
        }
    }
    list
}

/// The mean frequency by the phases of rows, or without these if they contradict the rows' own frequencies, as where times are rounded.
pub(super) fn frequency(runs: &mut [Run], found: &Found) -> Frequency {
    let moved = moved(found, runs);
    let by_phases = by_stretches(runs, &moved, found);
    let (mean, _) = by_phases.mean;
    if !is_contradicted(mean, runs, &moved, found) {
        return by_phases;
    }
    let all = runs.iter_mut().flat_map(|run| &mut run.rows);
    all.for_each(|row| row.phase = None);
    Frequency {
        contradicted: Some(mean),
        ..by_stretches(runs, &moved, found)
    }
}

/// Whether rows' own frequencies differ from this mean, Hz, by more than any turn or split explains.
fn is_contradicted(mean: f64, runs: &[Run], moved: &[Moved], found: &Found) -> bool {
    let all = runs.iter().flat_map(|run| &run.rows);
    let count = all.clone().count() as f64;
    let all = all.zip(moved);
    // The mean is without the splits' part, which rows have.
    let apart = |(row, moved): (&Row, &Moved)| {
        let of_row = weighed(row, moved, found, true);
        [of_row.weight, row.frequency - of_row.by_splits - mean]
    };
    let (apart, weights) = weighted_mean(all.map(apart));
    let of_row = (count / weights).sqrt();
    apart.abs() > MAX_CONTRADICTION * of_row
}

/// The mean frequency of stretches of rows, weighted by their variances. Its deviation is wider if stretches scatter by more than theirs,
/// and by all variation with the energy, with time, or alike in consecutive stretches.
///
/// A row has the frequency along its pattern: the part due to the splits is subtracted, if they are determined. With quadrature, a turning
/// pattern looks like another frequency, and a row assumes that it turns as in the rows before: a change of that adds to its deviation.
fn by_stretches(runs: &[Run], moved: &[Moved], found: &Found) -> Frequency {
    let mut all = runs.iter().flat_map(|run| &run.rows);
    let are_weighted = all.all(|row| row.frequency_deviation.is_finite());
    let mut moved = moved.iter();
    // Relative to the first, so as to keep digits.
    let from = runs[0].rows[0].frequency;
    let (mut of_rows, mut mean_by) = (0.0, [0.0; 4]);
    let stretched = runs.iter().map(|run| {
        let pairs = run.rows.iter().zip(&mut moved);
        let weighed = pairs.map(|(row, moved)| {
            let weighed = weighed(row, moved, found, are_weighted);
            of_rows += weighed.weight;
            for (sum, by) in mean_by.iter_mut().zip(moved.by_splits) {
                *sum += weighed.weight * by;
            }
            weighed
        });
        let max_rows = if are_weighted {
            run.rows.len().div_ceil(STRETCHES)
        } else {
            1
        };
        stretches(&weighed.collect::<Vec<_>>(), max_rows, from)
    });
    let runs: Vec<Vec<Point>> = stretched.collect();
    let all = || runs.iter().flatten();
    let (mean, weights) = weighted_mean(all().map(weighted));
    let (squares, neighbours) = residuals(all(), mean);
    let count = all().count() as f64;
    let widened = widened(squares / (count - 1.0), are_weighted);
    let beside = without_mean(&runs);
    let alone = beside.0;
    let is_along = alone.is_significant(widened);
    let is_alike = are_weighted && is_alike(neighbours / squares, count);
    let moved_alike = if is_alike {
        (widened - 1.0) * count
    } else {
        0.0
    };
    let drifts: Vec<_> = runs.iter().map(|run| drift(run, are_weighted)).collect();
    let drifted: f64 = drifts.iter().map(|drift| drift.squares).sum();
    let is_moving = is_along || is_alike || drifted > 0.0;
    let moved = alone.along().max(moved_alike).max(drifted);
    let moves = is_moving.then(|| (moved / weights).sqrt());
    // Uncertainty of the splits is also one of their part of the frequency.
    let (_, of_splits) = found.splits(&mean_by.map(|sum| sum / of_rows / TAU));
    let std = (widened / weights).sqrt().hypot(of_splits);
    let means = runs.iter().map(|run| {
        let (mean, std) = mean_of_run(run, are_weighted);
        (from + mean, std.hypot(of_splits))
    });
    Frequency {
        mean: (from + mean, std.hypot(moves.unwrap_or(0.0))),
        moves,
        means: means.collect(),
        drifts: drifts.iter().map(|drift| drift.slope).collect(),
        contradicted: None,
        by_energy: if is_along {
            by_energy(&runs, beside, are_weighted, by_turning(found))
        } else {
            ByEnergy::Chance
        },
    }
}

/// A point as [`weighted_mean`] takes it.
fn weighted(point: &Point) -> [f64; 2] {
    [point.weight, point.excess]
}

/// The mean of a run's points, Hz, and its deviation, which is wider if they scatter by more than theirs.
fn mean_of_run(run: &[Point], are_weighted: bool) -> Measured {
    let (mean, weights) = weighted_mean(run.iter().map(weighted));
    let (squares, _) = residuals(run.iter(), mean);
    let scatter = squares / (run.len() as f64 - 1.0).max(1.0);
    (mean, (widened(scatter, are_weighted) / weights).sqrt())
}

/// The frequency of a row, weighted by its variance if that is known.
fn weighed<'a>(row: &'a Row, moved: &Moved, found: &Found, is_weighted: bool) -> RowFrequency<'a> {
    RowFrequency {
        row,
        by_splits: found.splits(&moved.by_splits).0 / TAU,
        by_splits_since: found.splits(&moved.by_splits_since).0 / TAU,
        weight: if is_weighted {
            row.frequency_deviation.hypot(moved.change / TAU).powi(-2)
        } else {
            1.0
        },
    }
}

/// Sum of squared residuals about a mean, in deviations, and of the products of consecutive ones.
fn residuals<'a>(points: impl Iterator<Item = &'a Point>, mean: f64) -> (f64, f64) {
    let (mut squares, mut neighbours, mut before) = (0.0, 0.0, 0.0);
    for point in points {
        let rest = point.weight.sqrt() * (point.excess - mean);
        squares += rest * rest;
        neighbours += rest * std::mem::replace(&mut before, rest);
    }
    (squares, neighbours)
}

/// Factor of variances if values scatter by this mean square: of known variances not below 1, and of unknown ones the scatter itself.
pub fn widened(scatter: f64, are_weighted: bool) -> f64 {
    if are_weighted {
        scatter.max(1.0)
    } else {
        scatter
    }
}

/// Rise of the frequency with the energy that the turning of patterns by their amplitudes implies, Hz at one input unit squared.
fn by_turning(found: &Found) -> Option<Measured> {
    // θ turns by −γ a_A a_B, and the frequency rises by 3γ (a_A² + a_B²) rad/s.
    // Flaws of pick-offs look like it, but leave residuals beyond noise.
    let turning = found.turning_by_amplitudes();
    let turning = turning.filter(|_| !found.is_beyond_noise());
    turning.map(|(turning, std)| (-3.0 * turning / TAU, 3.0 * std / TAU))
}

//! The mean frequency of both modes.

use std::f64::consts::TAU;

use super::by_energy::{ByEnergy, Seen, beside_one_mean, by_energy};
use super::drift::drift;
use super::found::{Found, Measured, Moved};
use super::is_alike;
use super::stretches::{Told, stretches};
use crate::runs::Runs;

/// Stretches of a run, at least, if it has as many rows.
const STRETCHES: usize = 100;

/// The mean frequency.
pub struct Frequency {
    /// Hz.
    pub mean: Measured,
    /// By how much it moves beyond noise, rms, Hz: with the energy, or from row to row; none where it does by chance.
    pub moves: Option<f64>,
    /// What it is above that at rest.
    pub by_energy: ByEnergy,
    /// How fast it moves in each run, Hz/s.
    pub drifts: Vec<Measured>,
}

/// The mean frequency, of which each stretch of rows tells as much as its deviation says; wider where stretches differ by more than that, and
/// by all that it moves with the energy, or alike in stretches that follow each other.
///
/// A row has the frequency along its pattern: what the splits make of that is taken off, where they are told. With quadrature a pattern that
/// turns looks like another frequency, and a row takes it to turn as the rows before do: what that has changed by adds to its deviation.
pub fn frequency(rows: &Runs, found: &Found) -> Frequency {
    let mut all = rows.runs.iter().flat_map(|run| &run.rows);
    let is_told = all.all(|row| row.frequency_deviation.is_finite());
    let mut moved = found.frequency_moved(&rows.runs).into_iter();
    // From one of them on, for the digits.
    let from = rows.runs[0].rows[0].frequency;
    let (mut of_rows, mut mean_by) = (0.0, [0.0; 4]);
    let mut tell = |row, moved: &Moved| {
        let told = Told {
            row,
            by_splits: found.splits(&moved.by_splits).0 / TAU,
            by_splits_since: found.splits(&moved.by_splits_since).0 / TAU,
            weight: if is_told {
                row.frequency_deviation.hypot(moved.change / TAU).powi(-2)
            } else {
                1.0
            },
        };
        of_rows += told.weight;
        for (sum, by) in mean_by.iter_mut().zip(moved.by_splits) {
            *sum += told.weight * by;
        }
        told
    };
    let runs = rows.runs.iter().map(|run| {
        let pairs = run.rows.iter().zip(&mut moved);
        let told: Vec<_> = pairs.map(|(row, moved)| tell(row, &moved)).collect();
        let most = if is_told {
            told.len().div_ceil(STRETCHES)
        } else {
            1
        };
        stretches(&told, most, from)
    });
    let runs: Vec<Vec<Seen>> = runs.collect();
    let all = || runs.iter().flatten();
    let weights: f64 = all().map(|seen| seen.weight).sum();
    let mean = all().map(|seen| seen.weight * seen.beyond).sum::<f64>() / weights;
    let (mut squares, mut neighbours, mut before) = (0.0, 0.0, 0.0);
    for seen in all() {
        let rest = seen.weight.sqrt() * (seen.beyond - mean);
        squares += rest * rest;
        neighbours += rest * std::mem::replace(&mut before, rest);
    }
    let count = all().count() as f64;
    let scatter = squares / (count - 1.0);
    let widened = if is_told { scatter.max(1.0) } else { scatter };
    let beside = beside_one_mean(&runs);
    let alone = beside.0;
    let is_along = alone.is_seen(widened);
    let is_alike = is_told && is_alike(neighbours / squares, count);
    let moved_alike = if is_alike {
        (widened - 1.0) * count
    } else {
        0.0
    };
    let drifts: Vec<_> = runs.iter().map(|run| drift(run, is_told)).collect();
    let drifted: f64 = drifts.iter().map(|drift| drift.squares).sum();
    let is_moving = is_along || is_alike || drifted > 0.0;
    let moved = alone.along().max(moved_alike).max(drifted);
    let moves = is_moving.then(|| (moved / weights).sqrt());
    // What is not known of the splits is not known of what they make either.
    let (_, of_splits) = found.splits(&mean_by.map(|sum| sum / of_rows / TAU));
    let std = (widened / weights).sqrt().hypot(of_splits);
    Frequency {
        mean: (from + mean, std.hypot(moves.unwrap_or(0.0))),
        moves,
        drifts: drifts.iter().map(|drift| drift.slope).collect(),
        by_energy: if is_along {
            // θ turns by −γ a_A a_B, and the frequency rises by 3γ (a_A² + a_B²) rad/s.
            // Flaws of pick-offs look like it, and differ from the motion beyond noise.
            let by_turning = found.turning_by_amplitudes();
            let by_turning = by_turning.filter(|_| !found.is_beyond_noise());
            let by_turning =
                by_turning.map(|(turning, std)| (-3.0 * turning / TAU, 3.0 * std / TAU));
            by_energy(&runs, beside, is_told, by_turning)
        } else {
            ByEnergy::Chance
        },
    }
}

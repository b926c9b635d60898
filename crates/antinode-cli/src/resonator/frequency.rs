//! The mean frequency of both modes.

use std::f64::consts::TAU;

use super::found::{Found, Measured};
use crate::runs::{Row, Runs};

/// The mean frequency, of which each row tells as much as its deviation says; wider where rows differ by more than that.
///
/// A row has the frequency along its pattern: what the splits make of that is taken off, where they are told.
pub fn frequency(rows: &Runs, found: &Found) -> Measured {
    let all = || rows.runs.iter().flat_map(|run| &run.rows);
    let is_told = all().all(|row| row.frequency_deviation.is_finite());
    let weight = |row: &Row| {
        if is_told {
            row.frequency_deviation.powi(-2)
        } else {
            1.0
        }
    };
    let by_splits = found.frequency_by_splits(&rows.runs);
    // From one of them on, for the digits.
    let from = rows.runs[0].rows[0].frequency;
    let beyond = |row: &Row, by: &[f64; 4]| row.frequency - from - found.splits(by).0 / TAU;
    let (mut weights, mut mean, mut mean_by) = (0.0, 0.0, [0.0; 4]);
    for (row, by) in all().zip(&by_splits) {
        weights += weight(row);
        mean += weight(row) * beyond(row, by);
        for (sum, by) in mean_by.iter_mut().zip(by) {
            *sum += weight(row) * by;
        }
    }
    mean /= weights;
    let squares: f64 = all()
        .zip(&by_splits)
        .map(|(row, by)| weight(row) * (beyond(row, by) - mean).powi(2))
        .sum();
    let scatter = squares / (rows.used() - 1) as f64;
    let widened = if is_told { scatter.max(1.0) } else { scatter };
    // What is not known of the splits is not known of what they make either.
    let (_, of_splits) = found.splits(&mean_by.map(|sum| sum / weights / TAU));
    (from + mean, (widened / weights).sqrt().hypot(of_splits))
}

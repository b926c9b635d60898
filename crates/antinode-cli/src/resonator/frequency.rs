//! The mean frequency of both modes.

use std::f64::consts::TAU;

use super::found::{Found, Measured};
use super::{ALIKE_SEEN, is_alike};
use crate::runs::Runs;

/// The mean frequency.
pub struct Frequency {
    /// Hz.
    pub mean: Measured,
    /// By how much it moves beyond noise, rms, Hz: with the energy, or from row to row; none where it does by chance.
    pub moves: Option<f64>,
    /// What it is above that at rest, Hz, at an energy a_A² + a_B² of one input unit squared; none where it moves so by chance.
    pub by_energy: Option<Measured>,
}

/// The mean frequency, of which each row tells as much as its deviation says; wider where rows differ by more than that, and by all that it
/// moves with the energy, or alike in rows that follow each other.
///
/// A row has the frequency along its pattern: what the splits make of that is taken off, where they are told. With quadrature a pattern that
/// turns looks like another frequency, and a row takes it to turn as the rows before do: what that has changed by adds to its deviation.
pub fn frequency(rows: &Runs, found: &Found) -> Frequency {
    let all = || rows.runs.iter().flat_map(|run| &run.rows);
    let is_told = all().all(|row| row.frequency_deviation.is_finite());
    let moved = found.frequency_moved(&rows.runs);
    // From one of them on, for the digits.
    let from = rows.runs[0].rows[0].frequency;
    let (mut weights, mut mean, mut mean_by) = (0.0, 0.0, [0.0; 4]);
    let mut seen = Vec::new();
    for (row, moved) in all().zip(&moved) {
        let weight = if is_told {
            row.frequency_deviation.hypot(moved.change / TAU).powi(-2)
        } else {
            1.0
        };
        let beyond = row.frequency - from - found.splits(&moved.by_splits).0 / TAU;
        weights += weight;
        mean += weight * beyond;
        for (sum, by) in mean_by.iter_mut().zip(moved.by_splits) {
            *sum += weight * by;
        }
        seen.push((weight, row.main.powi(2) + row.quadrature.powi(2), beyond));
    }
    mean /= weights;
    let energies: f64 = seen.iter().map(|(weight, energy, _)| weight * energy).sum();
    let (mut squares, mut neighbours, mut before) = (0.0, 0.0, 0.0);
    let (mut of_energy, mut product) = (0.0, 0.0);
    for (weight, energy, beyond) in &seen {
        let (energy, rest) = (energy - energies / weights, beyond - mean);
        squares += weight * rest * rest;
        neighbours += weight.sqrt() * rest * std::mem::replace(&mut before, weight.sqrt() * rest);
        of_energy += weight * energy * energy;
        product += weight * energy * rest;
    }
    let count = seen.len() as f64;
    let scatter = squares / (count - 1.0);
    let widened = if is_told { scatter.max(1.0) } else { scatter };
    // The square of what goes with the energy, as the rest is weighted.
    let along = product * product / of_energy;
    let is_along = along > ALIKE_SEEN * ALIKE_SEEN * widened;
    let is_alike = is_told && is_alike(neighbours / squares, count);
    let moved_alike = if is_alike {
        (widened - 1.0) * count
    } else {
        0.0
    };
    let moves = (is_along || is_alike).then(|| (along.max(moved_alike) / weights).sqrt());
    // What is not known of the splits is not known of what they make either.
    let (_, of_splits) = found.splits(&mean_by.map(|sum| sum / weights / TAU));
    let std = (widened / weights).sqrt().hypot(of_splits);
    let by_energy = (product / of_energy, (widened / of_energy).sqrt());
    Frequency {
        mean: (from + mean, std.hypot(moves.unwrap_or(0.0))),
        moves,
        by_energy: is_along.then_some(by_energy),
    }
}

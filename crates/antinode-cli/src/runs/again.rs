//! Whether a recording comes twice, as in windows of two lengths: its noise would seem to be less than it is.

use std::f64::consts::{PI, TAU};

use super::{Row, Run, turn};

/// Rows of a run that are looked at, spread evenly.
const LOOKED_AT: usize = 12;
/// Deviations by which windows of one recording that end apart may differ.
const SIGMAS: f64 = 5.0;
/// Beyond those, of a_A, and in rad: what a wave does between rows.
const BETWEEN: f64 = 1e-3;
/// The same of the phase, which another ring-down has by chance only, rad.
const PHASE: f64 = 0.1;

impl Run {
    /// True when both have the same rows, as far as the shorter one goes.
    pub fn is_copy(&self, other: &Self) -> bool {
        let numbers = |row: &Row| [row.time, row.main, row.quadrature, row.angle];
        let mut pairs = self.rows.iter().zip(&other.rows);
        pairs.all(|(one, other)| numbers(one) == numbers(other))
    }

    /// True where rows of the same recording at the same time show the same wave. A name alone, as of standard input, says little.
    pub fn is_again(&self, other: &Self) -> bool {
        if self.file.is_empty() || self.file != other.file {
            return false;
        }
        let every = self.rows.len().div_ceil(LOOKED_AT);
        let pairs = self.rows.iter().step_by(every).filter_map(|row| {
            let after = other.rows.partition_point(|other| other.time <= row.time);
            let before = after.checked_sub(1)?;
            Some((row, &other.rows[before], other.rows.get(after)?))
        });
        let mut alike = pairs.map(|(row, before, after)| is_alike(row, before, after));
        alike.next() == Some(true) && alike.all(|alike| alike)
    }
}

/// True where a row shows the wave that the rows before and after it show.
fn is_alike(row: &Row, before: &Row, after: &Row) -> bool {
    let later = row.time - before.time;
    let share = later / (after.time - before.time);
    let differences = [
        row.main - before.main - share * (after.main - before.main),
        row.quadrature - before.quadrature - share * (after.quadrature - before.quadrature),
        turn(row.angle - before.angle - share * turn(after.angle - before.angle)),
    ];
    let is_wave = (0..3).all(|i| {
        let noise = row.deviations[i].hypot(before.deviations[i].max(after.deviations[i]));
        let between = if i < 2 { BETWEEN * row.main } else { BETWEEN };
        differences[i].abs() < SIGMAS * noise + between
    });
    let run_on = row.phase.zip(before.phase).map_or(0.0, |(now, before_it)| {
        now - before_it + TAU * before.frequency * later
    });
    // A pattern that has turned by a quarter turn bears the other sign.
    is_wave && (run_on - PI * (run_on / PI).round()).abs() < PHASE
}

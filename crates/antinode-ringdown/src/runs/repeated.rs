//! Detection of a recording that is given twice, as in windows of two lengths: its noise would seem to be less than it is.

use std::f64::consts::{PI, TAU};

use super::{Row, Run, turn};

/// Rows of a run that are compared, spread evenly.
const COMPARED_ROWS: usize = 12;
/// Deviations by which windows of one recording may differ if they are not the same.
const SIGMAS: f64 = 5.0;
/// Further difference allowed for what the wave does between rows, as a share of a_A, and in rad.
const BETWEEN: f64 = 1e-3;
/// Difference of phase allowed, rad: another ring-down has the same phase by chance only.
const PHASE: f64 = 0.1;

impl Run {
    /// True if both have the same rows, as far as the shorter one goes.
    pub fn is_copy(&self, other: &Self) -> bool {
        let numbers = |row: &Row| [row.time, row.main, row.quadrature, row.angle];
        let mut pairs = self.rows.iter().zip(&other.rows);
        pairs.all(|(one, other)| numbers(one) == numbers(other))
    }

    /// True if rows of the same recording show the same wave at the same times. The name alone, as of standard input, says little.
    pub fn repeats(&self, other: &Self) -> bool {
        // Of thousands of runs, most pairs differ in this, which is soonest seen.
        if !self.is_beside(other) || self.file.is_empty() || self.file != other.file {
            return false;
        }
        let every = self.rows.len().div_ceil(COMPARED_ROWS);
        let pairs = self.rows.iter().step_by(every).filter_map(|row| {
            let after = other.rows.partition_point(|other| other.time <= row.time);
            let before = after.checked_sub(1)?;
            Some((row, &other.rows[before], other.rows.get(after)?))
        });
        let mut alike = pairs.map(|(row, before, after)| is_alike(row, before, after));
        alike.next() == Some(true) && alike.all(|alike| alike)
    }

    /// True if some of the time that both span is the same.
    fn is_beside(&self, other: &Self) -> bool {
        let end = |run: &Self| run.rows[run.rows.len() - 1].time;
        self.rows[0].time <= end(other) && other.rows[0].time <= end(self)
    }
}

/// True if a row shows the same wave as the rows of another run before and after it.
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
    // A pattern that has turned by a quarter turn has the opposite sign.
    is_wave && (run_on - PI * (run_on / PI).round()).abs() < PHASE
}

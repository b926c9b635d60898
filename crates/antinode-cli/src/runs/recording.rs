//! Groups the rows of one recording into runs, whatever rows of others lie between them.

use antinode::Flags;

use super::jump::jumps;
use super::row::Row;
use super::step::steps;
use super::way::bow;
use super::{MIN_ROWS, Run, turn};

/// Ratio of deviations from which on a row is known less well than another.
const MIN_WORSE: f64 = 2.0;
/// Consecutive rows known less well that may be due to a fault, at most.
const MAX_VAGUE: usize = 20;

/// A recording whose rows are being read.
#[derive(Default)]
pub(super) struct Recording {
    /// Its name, as in its rows.
    pub file: String,
    /// The runs that have ended.
    pub runs: Vec<Run>,
    /// Times at which runs ended at a step between clean rows, s.
    pub steps: Vec<f64>,
    /// Rows left out because their windows overlap the one before.
    pub overlapping: usize,
    /// Rows that are not later than the one before.
    pub backward: usize,
    /// The run that has not ended.
    run: Run,
    /// Number of rows before some that are missing, or left out for more than a circle, until a row after these is known as well.
    torn: Option<usize>,
    /// Numbers of rows before circular ones that were left out.
    circles: Vec<usize>,
    /// Times and angles of rows left out after the last one; `None` for one that does not show the pattern.
    between: Vec<Option<[f64; 2]>>,
}

impl Recording {
    pub fn new(file: &str) -> Self {
        Self {
            file: file.to_owned(),
            ..Self::default()
        }
    }

    /// Leaves out a row with these flags, time and angle; a flag of `breaks` ends the run.
    pub fn leave_out(&mut self, flags: Flags, breaks: Flags, way: Option<[f64; 2]>) {
        if flags.intersects(breaks) {
            self.end();
        }
        self.between.push(way.filter(|_| flags == Flags::MISFIT));
        if flags == Flags::CIRCULAR {
            self.circles.push(self.run.rows.len());
        } else {
            self.torn.get_or_insert(self.run.rows.len());
        }
    }

    /// Takes the next row, unless it overlaps the last; the run ends if the row is not later than that, or if the pattern has turned by
    /// more than `max_turn` rad since.
    pub fn take(&mut self, mut row: Row, max_turn: f64) {
        if let Some(last) = self.run.rows.last() {
            let is_backward = row.time <= last.time;
            if !is_backward && self.run.overlaps(&row) {
                self.overlapping += 1;
                return;
            }
            self.backward += usize::from(is_backward);
            let is_turned = turn(row.angle - last.angle).abs() > max_turn;
            // A report that was lost may have told of a fault.
            if self.between.is_empty() && self.run.misses_rows_before(&row) {
                self.torn.get_or_insert(self.run.rows.len());
            }
            let before = self
                .torn
                .filter(|&torn| jumps(&self.run.rows[..torn], &row));
            if let Some(before) = before {
                // Rows in between may belong to either side.
                self.run.rows.truncate(before);
            }
            if is_backward || before.is_some() || is_turned {
                self.end();
            }
        }
        self.torn = self.torn.filter(|&torn| self.is_vague(torn, &row));
        let between: Option<Vec<_>> = std::mem::take(&mut self.between).into_iter().collect();
        if let (Some(last), Some(between)) = (self.run.rows.last(), between) {
            row.bow = bow(last, &row, &between);
        }
        self.run.rows.push(row);
    }

    /// True if a row is known too little to tell whether the wave is still that of the first `torn` rows; false after many such rows.
    fn is_vague(&self, torn: usize, row: &Row) -> bool {
        let rows = &self.run.rows;
        let last = rows.get(torn.wrapping_sub(1));
        last.is_some_and(|last| {
            let worse = |i: usize| row.deviations[i] > MIN_WORSE * last.deviations[i];
            rows.len() < torn + MAX_VAGUE && (0..3).any(worse)
        })
    }

    /// Ends the run: keeps it, or its parts between steps, if they are long enough.
    pub fn end(&mut self) {
        self.torn = None;
        let rows = std::mem::take(&mut self.run.rows);
        let mut from = 0;
        let steps = steps(&rows, &std::mem::take(&mut self.circles));
        self.steps.extend(steps.iter().map(|&step| rows[step].time));
        for until in steps.into_iter().chain([rows.len()]) {
            if until - from >= MIN_ROWS {
                let file = self.file.clone();
                let rows = rows[from..until].to_vec();
                self.runs.push(Run { rows, file });
            }
            // The row at the step may hold some of both.
            from = until + 1;
        }
    }
}

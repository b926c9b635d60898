//! Groups the windows of one recording into runs, whatever windows of others lie between them.

use antinode::{Estimate, Flags};

use super::jump::jumps;
use super::row::{Row, Window};
use super::step::steps;
use super::way::bow;
use super::{MIN_ROWS, Run, turn};

/// Ratio of deviations from which on a row is known less well than another.
const MIN_WORSE: f64 = 2.0;
/// Consecutive rows known less well that may be due to a fault, at most.
const MAX_VAGUE: usize = 20;

/// The runs of a recording, and what was left out.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Runs {
    /// Name of the recording.
    pub name: String,
    /// Its runs, of [`MIN_ROWS`] rows or more each.
    pub runs: Vec<Run>,
    /// Times at which runs ended at a step between clean rows, s.
    pub steps: Vec<f64>,
    /// Clean windows left out because they overlap the one before, whose noise they would count again.
    pub overlapping: usize,
    /// Clean windows that are not later than the one before.
    pub backward: usize,
}

/// A recording whose windows are taken one by one, in the order of their times.
#[derive(Debug)]
pub struct Recording {
    /// The runs that have ended.
    ended: Runs,
    /// Turn of the pattern from row to row, at most, rad.
    max_turn: f64,
    /// Flags of a window that end a run.
    breaks: Flags,
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
    /// No windows yet, of the recording of this name.
    ///
    /// A run ends if the pattern turns by more than `max_turn` rad, up to π/4, from row to row, if the wave jumps across windows left out
    /// or missing or steps between clean ones, and at a window with a flag of `breaks`.
    pub fn new(name: &str, max_turn: f64, breaks: Flags) -> Self {
        Self {
            ended: Runs {
                name: name.to_owned(),
                ..Runs::default()
            },
            max_turn,
            breaks,
            run: Run::default(),
            torn: None,
            circles: Vec::new(),
            between: Vec::new(),
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.ended.name
    }

    /// Takes the next estimate of a stream, or leaves it out if it is flagged.
    pub fn see(&mut self, estimate: &Estimate) {
        if estimate.flags.is_empty() {
            self.take(&estimate.into());
        } else {
            self.leave_out(estimate.flags, Some([estimate.time, estimate.angle]));
        }
    }

    /// Leaves out a window with these flags; its time, s, and angle, rad, if they are known, may show where the pattern went.
    pub fn leave_out(&mut self, flags: Flags, way: Option<[f64; 2]>) {
        if flags.intersects(self.breaks) {
            self.end_run();
        }
        self.between.push(way.filter(|_| flags == Flags::MISFIT));
        if flags == Flags::CIRCULAR {
            self.circles.push(self.run.rows.len());
        } else {
            self.torn.get_or_insert(self.run.rows.len());
        }
    }

    /// Takes the next clean window, unless it overlaps the last; the run ends if it is not later than that.
    pub fn take(&mut self, window: &Window) {
        let mut row = Row::from(window);
        if let Some(last) = self.run.rows.last() {
            let is_backward = row.time <= last.time;
            if !is_backward && self.run.overlaps(&row) {
                self.ended.overlapping += 1;
                return;
            }
            self.ended.backward += usize::from(is_backward);
            let is_turned = turn(row.angle - last.angle).abs() > self.max_turn;
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
                self.end_run();
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

    /// The runs of the windows that were taken.
    pub fn end(mut self) -> Runs {
        self.end_run();
        self.ended
    }

    /// Ends the run: keeps it, or its parts between steps, if they are long enough.
    fn end_run(&mut self) {
        self.torn = None;
        let rows = std::mem::take(&mut self.run.rows);
        let mut from = 0;
        let steps = steps(&rows, &std::mem::take(&mut self.circles));
        self.ended
            .steps
            .extend(steps.iter().map(|&step| rows[step].time));
        for until in steps.into_iter().chain([rows.len()]) {
            if until - from >= MIN_ROWS {
                let file = self.ended.name.clone();
                let rows = rows[from..until].to_vec();
                self.ended.runs.push(Run { rows, file });
            }
            // The row at the step may hold some of both.
            from = until + 1;
        }
    }
}

#[cfg(test)]
mod tests;

//! The rows of one recording become its runs, whatever rows of others stand between them.

use antinode::Flags;

use super::jump::jumps;
use super::row::Row;
use super::step::steps;
use super::way::bow;
use super::{LEAST_ROWS, Run, turn};

/// A row whose deviations are so many times those of another is known worse.
const WORSE: f64 = 2.0;
/// Such rows in a row are no fault's any more.
const VAGUE: usize = 20;

/// A recording whose rows are read.
pub(super) struct Recording {
    /// As its rows name it.
    pub file: String,
    /// The runs that have ended.
    pub runs: Vec<Run>,
    /// When runs ended at a step between clean rows, s.
    pub steps: Vec<f64>,
    /// The one that has not.
    run: Run,
    /// Rows of the run before others that were left out and hold more than a circle, until one behind these is known as well.
    torn: Option<usize>,
    /// Rows of the run before circles that were left out.
    circles: Vec<usize>,
    /// Times and angles of rows that were left out behind the last one; none of one that does not show the pattern.
    between: Vec<Option<[f64; 2]>>,
}

/// What becomes of a row.
#[derive(PartialEq, Eq)]
pub(super) enum Taken {
    /// It goes on with the run, or begins another.
    Kept,
    /// It is left out, for its window overlaps the one before.
    Overlaps,
    /// It begins another run, for it is not later than the one before.
    Backward,
}

impl Recording {
    pub fn new(file: &str) -> Self {
        Self {
            file: file.to_owned(),
            runs: Vec::new(),
            steps: Vec::new(),
            run: Run::default(),
            torn: None,
            circles: Vec::new(),
            between: Vec::new(),
        }
    }

    /// Leaves out a row with flags, of which these end a run, and such a time and angle.
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

    /// Takes the next row; a run ends where the pattern turns by more than so much, rad.
    pub fn take(&mut self, mut row: Row, most_turn: f64) -> Taken {
        let mut taken = Taken::Kept;
        if let Some(last) = self.run.rows.last() {
            if row.time <= last.time {
                taken = Taken::Backward;
            } else if self.run.overlaps(&row) {
                return Taken::Overlaps;
            }
            let is_turned = turn(row.angle - last.angle).abs() > most_turn;
            let before = self
                .torn
                .filter(|&torn| jumps(&self.run.rows[..torn], &row));
            if let Some(before) = before {
                // Rows between may be of either side.
                self.run.rows.truncate(before);
            }
            if taken == Taken::Backward || before.is_some() || is_turned {
                self.end();
            }
        }
        self.torn = self.torn.filter(|&torn| self.is_vague(torn, &row));
        let between: Option<Vec<_>> = std::mem::take(&mut self.between).into_iter().collect();
        if let (Some(last), Some(between)) = (self.run.rows.last(), between) {
            row.bow = bow(last, &row, &between);
        }
        self.run.rows.push(row);
        taken
    }

    /// True where a row does not tell whether the wave behind so many rows is still the same, for it is known worse than these; not for long.
    fn is_vague(&self, torn: usize, row: &Row) -> bool {
        let rows = &self.run.rows;
        let last = rows.get(torn.wrapping_sub(1));
        last.is_some_and(|last| {
            let worse = |i: usize| row.deviations[i] > WORSE * last.deviations[i];
            rows.len() < torn + VAGUE && (0..3).any(worse)
        })
    }

    /// Keeps the run, or what is between steps of it, if it is long enough, and begins another.
    pub fn end(&mut self) {
        self.torn = None;
        let rows = std::mem::take(&mut self.run.rows);
        let mut from = 0;
        let steps = steps(&rows, &std::mem::take(&mut self.circles));
        self.steps.extend(steps.iter().map(|&step| rows[step].time));
        for until in steps.into_iter().chain([rows.len()]) {
            if until - from >= LEAST_ROWS {
                let file = self.file.clone();
                let rows = rows[from..until].to_vec();
                self.runs.push(Run { rows, file });
            }
            // The row about which it steps may hold both.
            from = until + 1;
        }
    }
}

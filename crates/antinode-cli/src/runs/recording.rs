//! The rows of one recording become its runs, whatever rows of others stand between them.

use antinode::Flags;

use super::jump::jumps;
use super::row::Row;
use super::{LEAST_ROWS, Run, turn};

/// A recording whose rows are read.
pub(super) struct Recording {
    /// As its rows name it.
    pub file: String,
    /// The runs that have ended.
    pub runs: Vec<Run>,
    /// The one that has not.
    run: Run,
    /// True where rows were left out that hold more than a circle.
    is_torn: bool,
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
            run: Run::default(),
            is_torn: false,
        }
    }

    /// Leaves out a row with flags, of which these end a run.
    pub fn leave_out(&mut self, flags: Flags, breaks: Flags) {
        if flags.intersects(breaks) {
            self.end();
        }
        self.is_torn |= flags != Flags::CIRCULAR;
    }

    /// Takes the next row; a run ends where the pattern turns by more than so much, rad.
    pub fn take(&mut self, row: Row, most_turn: f64) -> Taken {
        let mut taken = Taken::Kept;
        if let Some(last) = self.run.rows.last() {
            if row.time <= last.time {
                taken = Taken::Backward;
            } else if self.run.overlaps(&row) {
                return Taken::Overlaps;
            }
            let is_moved = self.is_torn && jumps(&self.run.rows, &row);
            let is_turned = turn(row.angle - last.angle).abs() > most_turn;
            if taken == Taken::Backward || is_moved || is_turned {
                self.end();
            }
        }
        self.is_torn = false;
        self.run.rows.push(row);
        taken
    }

    /// Keeps the run if it is long enough, and begins another.
    pub fn end(&mut self) {
        let rows = std::mem::take(&mut self.run.rows);
        if rows.len() >= LEAST_ROWS {
            let file = self.file.clone();
            self.runs.push(Run { rows, file });
        }
    }
}

//! A run of rows, and how its pattern turns.

use super::{Row, turn};

/// Distance of windows, as a share of their length, below which they overlap: the length is known to a few per cent.
const MIN_DISTANCE: f64 = 0.97;
/// Distance of rows, as a multiple of that before, from which on a row is missing in between.
const MIN_GAP: f64 = 1.5;

/// A span of rows without a break; what follows from them is stated for runs that are not empty.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Run {
    /// The rows, in the order of their times.
    pub rows: Vec<Row>,
    /// Name of the recording.
    pub file: String,
}

impl Run {
    /// A run of these rows, of the same recording.
    pub(crate) fn with(&self, rows: Vec<Row>) -> Self {
        let file = self.file.clone();
        Self { rows, file }
    }

    /// Time from the first row to the last, s.
    pub fn seconds(&self) -> f64 {
        self.rows[self.rows.len() - 1].time - self.rows[0].time
    }

    /// The rows between gaps of so many mean distances of rows and more.
    pub(crate) fn pieces(&self, gap: f64) -> impl Iterator<Item = &[Row]> {
        let gap = gap * self.seconds() / self.rows.len() as f64;
        self.rows
            .chunk_by(move |row, next| next.time - row.time < gap)
    }

    /// Turns of the pattern from row to row, rad.
    fn steps(&self) -> impl Iterator<Item = f64> {
        let pairs = self.rows.windows(2);
        pairs.map(|pair| turn(pair[1].angle - pair[0].angle))
    }

    /// Turn of the pattern from the first row to the last, rad.
    pub fn turned(&self) -> f64 {
        self.steps().sum()
    }

    /// Largest turns of the pattern from any row to any later one, rad: backwards, at most 0, and forwards, at least 0.
    pub fn turns(&self) -> [f64; 2] {
        let (mut angle, mut turns) = (0.0, [0f64; 2]);
        let (mut min, mut max) = (0f64, 0f64);
        for step in self.steps() {
            angle += step;
            (min, max) = (min.min(angle), max.max(angle));
            turns = [turns[0].min(angle - max), turns[1].max(angle - min)];
        }
        turns
    }

    /// True if rows are missing between the last one, if any, and this.
    pub(super) fn misses_rows_before(&self, row: &Row) -> bool {
        let [.., before, last] = self.rows.as_slice() else {
            return false;
        };
        row.time - last.time > MIN_GAP * (last.time - before.time)
    }

    /// True if the window of the last row, if any, shares samples with that of this one.
    pub(super) fn overlaps(&self, row: &Row) -> bool {
        let apart = 0.5 * MIN_DISTANCE * row.seconds;
        let last = self.rows.last();
        last.is_some_and(|last| row.time - last.time < 0.5 * MIN_DISTANCE * last.seconds + apart)
    }
}

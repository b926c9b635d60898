//! Groups rows that `antinode identify` printed into runs: spans of time in which the pattern moves without a break.

mod columns;

use std::io::{self, Write};
use std::ops::Range;

use antinode::Flags;
use antinode_ringdown::{MIN_ROWS, Recording, Run};

use crate::digits::counted;
use crate::failure::Failure;
use crate::given_rows::{GivenRows, none_within, recording_of, told_apart};
use crate::row_file::{self, RowFile};
use columns::Places;

/// Driven runs that are named, at most.
const MAX_NAMED: usize = 5;

/// The runs of all rows, and what was left out.
#[derive(Debug, Default)]
pub struct Runs {
    pub runs: Vec<Run>,
    /// Rows read within the times asked for, including flagged ones.
    pub rows: usize,
    /// The recordings that the rows are of, in the order of `runs`: the file of the rows, its own name, and the number of its runs.
    recordings: Vec<((String, String), usize)>,
    /// The first and the last time in the rows, s, and the times asked for.
    span: Option<[f64; 2]>,
    asked: Range<f64>,
    /// Clean rows left out because their windows overlap the one before, whose noise they would count again.
    pub overlapping: usize,
    /// Clean rows of a recording that are not later than the one before.
    backward: usize,
    /// Recordings and times, s, at which a step between clean rows ends a run.
    steps: Vec<(String, f64)>,
    /// Turn of the pattern from row to row, at most, rad.
    max_turn: f64,
    /// Flags of a row that end a run.
    breaks: Flags,
}

impl Runs {
    /// Reads the rows given, and returns their runs and the names of their files. A run ends if the pattern turns by more than `max_turn`
    /// rad from row to row, if the wave jumps across rows left out or missing or steps between clean ones, and at a row with a flag of
    /// `breaks`.
    pub fn open(
        given: &GivenRows,
        max_turn: f64,
        breaks: Flags,
    ) -> Result<(Self, String), Failure> {
        let paths = &given.rows;
        let mut runs = Self::new(given.times()?, max_turn, breaks);
        let mut names = Vec::new();
        for (index, path) in paths.iter().enumerate() {
            if paths[..index].contains(path) {
                return Err(given_twice(&path.display().to_string()));
            }
            let file = RowFile::open(path)?;
            names.push(file.name().to_owned());
            runs.read(file)?;
        }
        let names = names.join(", ");
        if let Some(fault) = runs.fault(&names) {
            return Err(fault);
        }
        Ok((runs, names))
    }

    fn new(asked: Range<f64>, max_turn: f64, breaks: Flags) -> Self {
        Self {
            asked,
            max_turn,
            breaks,
            ..Self::default()
        }
    }

    /// The reason why the rows are of no use, if they are not.
    fn fault(&self, name: &str) -> Option<Failure> {
        let fault = |why: String| Some(Failure::Fault(format!("{name}: {why}")));
        if self.runs.is_empty() {
            if let (0, Some(span)) = (self.rows, self.span) {
                return Some(none_within(name, span));
            }
            // Rows out of order would otherwise be reported as runs that are too short.
            if 3 * self.backward > self.rows {
                return fault(format!(
                    "time does not increase from row to row, {} times in {} rows; give each recording's rows once, in order of time",
                    self.backward, self.rows
                ));
            }
            if self.rows < MIN_ROWS {
                let only = match self.rows {
                    0 => "there are no rows".to_owned(),
                    1 => "there is only 1 row".to_owned(),
                    rows => format!("there are only {rows} rows"),
                };
                return fault(format!(
                    "no run of {MIN_ROWS} clean rows, as {only}; shorten the windows, or record longer"
                ));
            }
            return fault(format!(
                "no run of {MIN_ROWS} clean rows in which the pattern turns by less than {:.1}° from row to row; see the rows' flags, and \
                 shorten the windows if it turns faster",
                self.max_turn.to_degrees()
            ));
        }
        // A copy under another name.
        let same = self.runs.iter().enumerate().find_map(|(index, run)| {
            let mut before = self.runs[..index].iter();
            Some((run, before.find(|other| run.is_copy(other))?))
        });
        same.map(|(run, other)| {
            let of = match (other.file.as_str(), run.file.as_str()) {
                ("", "") => String::new(),
                (one, other) if one == other => format!(" of {one}"),
                (one, other) => format!(" of {one} and of {other}"),
            };
            given_twice(&format!(
                "{name}: a run{of}, {:.1} s with {} rows from {} s on,",
                run.seconds(),
                run.rows.len(),
                run.rows[0].time
            ))
        })
    }

    /// The runs of each recording, which may be none, by its name, without the notes on all of them.
    pub fn by_recording(self) -> Vec<(String, Self)> {
        let (names, counts): (Vec<_>, Vec<_>) = self.recordings.into_iter().unzip();
        let mut runs = self.runs.into_iter();
        let each = told_apart(&names).into_iter().zip(counts);
        let each = each.map(|(name, count)| {
            let runs = runs.by_ref().take(count).collect();
            (
                name,
                Self {
                    runs,
                    ..Self::default()
                },
            )
        });
        each.collect()
    }

    /// Writes which rows were left out, where runs end at a step, and what is given twice in the runs that are used.
    pub fn write_notes(&self, used: &[Run], out: &mut impl Write) -> io::Result<()> {
        if self.overlapping > 0 {
            writeln!(
                out,
                "{} rows are left out because their windows overlap the one before and share its noise",
                self.overlapping
            )?;
        }
        if let Some((file, time)) = self.steps.first() {
            let of = if file.is_empty() {
                String::new()
            } else {
                format!(" of {file}")
            };
            let more = match self.steps.len() - 1 {
                0 => String::new(),
                more => format!(", and at {} more", counted(more as u64, "place")),
            };
            writeln!(
                out,
                "a gain or the wave steps at {time:.2} s{of}{more}: a run ends there, and another begins"
            )?;
        }
        let repeated = used.iter().enumerate().find(|(index, run)| {
            let mut before = used[..*index].iter();
            before.any(|other| run.repeats(other) || other.repeats(run))
        });
        if let Some((_, run)) = repeated {
            writeln!(
                out,
                "warning: rows of {} cover the same time twice, perhaps in other windows: their noise is counted twice, and every deviation \
                 is too small by a factor of up to √2; give each recording's rows once",
                run.file
            )?;
        }
        Ok(())
    }

    /// Adds the rows of a file.
    fn read(&mut self, mut rows: RowFile) -> Result<(), Failure> {
        let places = Places::of(&rows)?;
        let flags = rows.needed("flags")?;
        let file = rows.place("file");
        let mut recordings: Vec<Recording> = Vec::new();
        let mut current = 0;
        while rows.advance()? {
            let record = rows.record();
            // The row of a lost wave may lack a time; it is then counted in any case.
            if let Some(time) = places.time(record) {
                let [first, last] = self.span.unwrap_or([time; 2]);
                self.span = Some([first.min(time), last.max(time)]);
                if !self.asked.contains(&time) {
                    continue;
                }
            }
            self.rows += 1;
            let from = file.map_or("", |file| &record[file]);
            let is_its = |one: &Recording| one.name() == from;
            let new = || Recording::new(from, self.max_turn, self.breaks);
            current = recording_of(&mut recordings, current, is_its, new);
            let flags = row_file::flags(record, flags).map_err(|told| rows.unusable(told))?;
            if !flags.is_empty() {
                recordings[current].leave_out(flags, places.way(record));
                continue;
            }
            // Not before: a flagged row need not have numbers.
            let window = places.window(record).map_err(|told| rows.unusable(told))?;
            recordings[current].take(&window);
        }
        for recording in recordings {
            let mut its = recording.end();
            let steps = its.steps.iter().map(|&time| (its.name.clone(), time));
            self.steps.extend(steps);
            self.overlapping += its.overlapping;
            self.backward += its.backward;
            let file = rows.name().to_owned();
            self.recordings.push(((file, its.name), its.runs.len()));
            self.runs.append(&mut its.runs);
        }
        Ok(())
    }
}

/// The failure for rows that are given twice.
fn given_twice(what: &str) -> Failure {
    Failure::Fault(format!(
        "{what} is given twice, which would make deviations too small; give it once"
    ))
}

/// Number of rows in runs.
pub fn rows_in(runs: &[Run]) -> usize {
    runs.iter().map(|run| run.rows.len()).sum()
}

/// A run's recording, length and beginning, in words.
pub fn named(run: &Run) -> String {
    let file = match run.file.as_str() {
        "" => String::new(),
        file => format!("{file}, "),
    };
    let (seconds, from) = (run.seconds(), run.rows[0].time);
    format!("{file}{seconds:.1} s from {from:.1} s on")
}

/// Warns of runs that were left out because something drives them.
pub fn warn_of_driven(out: &mut impl Write, driven: &[Run]) -> io::Result<()> {
    if driven.is_empty() {
        return Ok(());
    }
    let mut names: Vec<_> = driven.iter().take(MAX_NAMED).map(named).collect();
    if driven.len() > MAX_NAMED {
        names.push(format!("and {} more", driven.len() - MAX_NAMED));
    }
    writeln!(
        out,
        "warning: left out: {} in which something drives the wave, as it does not decay there but does in others: {}",
        counted(driven.len() as u64, "run"),
        names.join("; ")
    )
}

#[cfg(test)]
mod tests;

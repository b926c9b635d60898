//! One resonator for each recording: a line for each, as for the gyros of a batch.

use std::f64::consts::PI;
use std::io::{self, Write};

use antinode_ringdown::resonator::Measured;
use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};

use super::quantities::{Row, quantities};
use super::{Results, results};
use crate::digits::{fixed, significant, with_small_std};
use crate::failure::Failure;
use crate::options::Format;
use crate::result_file::ResultFile;
use crate::runs::{Runs, rows_in};
use crate::serialized;

/// What `--help` says of the columns.
pub const HELP: &str = "\
With --each, CSV and JSON lines have one row for each recording: `file`; the number of its `rows` used and of its `runs`; the quantities \
of its resonator by the names above, each with its deviation, as `decay_time_s` and `decay_time_std_s`; `residual_over_noise`; and the \
number of `warnings`. Where the rows do not determine the splits, these are empty, and decay time and quality factor are those of the \
longest run. Of a recording that no resonator explains only the file and the warning are given.";

/// The columns of each quantity: its name among the quantities, and that of its deviation.
const COLUMNS: [[&str; 2]; 9] = [
    ["frequency_hz", "frequency_std_hz"],
    DECAY_TIME,
    QUALITY_FACTOR,
    ["damping_split_s", "damping_split_std_s"],
    ["most_damped_at_rad", "most_damped_at_std_rad"],
    [
        "most_damped_quality_factor",
        "most_damped_quality_factor_std",
    ],
    [
        "least_damped_quality_factor",
        "least_damped_quality_factor_std",
    ],
    ["frequency_split_hz", "frequency_split_std_hz"],
    ["highest_at_rad", "highest_at_std_rad"],
];
/// Those that the longest run has if the resonator is not determined.
const DECAY_TIME: [&str; 2] = ["decay_time_s", "decay_time_std_s"];
const QUALITY_FACTOR: [&str; 2] = ["quality_factor", "quality_factor_std"];

const DEGREES: f64 = 180.0 / PI;
/// What the table shows: heads, and the quantities with the factors from their units.
const SHOWN: [(&str, &str, f64); 7] = [
    ("frequency, Hz", "frequency_hz", 1.0),
    ("decay time, s", "decay_time_s", 1.0),
    ("quality factor", "quality_factor", 1.0),
    ("damping split, 1/s", "damping_split_s", 1.0),
    ("at, °", "most_damped_at_rad", DEGREES),
    ("frequency split, Hz", "frequency_split_hz", 1.0),
    ("at, °", "highest_at_rad", DEGREES),
];

/// A recording's resonator.
#[derive(Default)]
struct Line {
    file: String,
    rows: usize,
    runs: usize,
    /// The value and the deviation in each of [`COLUMNS`], if the rows determine them.
    quantities: [Option<Measured>; COLUMNS.len()],
    residual_over_noise: Option<f64>,
    warnings: usize,
}

impl Serialize for Line {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut line = serializer.serialize_struct("Line", 2 * COLUMNS.len() + 5)?;
        line.serialize_field("file", &self.file)?;
        line.serialize_field("rows", &self.rows)?;
        line.serialize_field("runs", &self.runs)?;
        for ([value, std], measured) in COLUMNS.iter().zip(&self.quantities) {
            line.serialize_field(value, &measured.map(|(value, _)| value))?;
            line.serialize_field(std, &measured.map(|(_, std)| std))?;
        }
        line.serialize_field("residual_over_noise", &self.residual_over_noise)?;
        line.serialize_field("warnings", &self.warnings)?;
        line.end()
    }
}

/// Prints a line for each recording, and the warnings for each. An error if no resonator explains the rows of one, with all others printed.
pub fn run(rows: Runs, format: Format, file: &ResultFile) -> Result<(), Failure> {
    let mut told = Vec::new();
    rows.write_notes(&rows.runs, &mut told)?;
    let mut lines = Vec::new();
    let mut unexplained = None;
    for (name, rows) in rows.by_recording() {
        let count = rows_in(&rows.runs);
        let line = match results(rows, &name) {
            Ok(found) => {
                let mut notes = Vec::new();
                super::write_notes(&mut notes, &found)?;
                let notes = String::from_utf8_lossy(&notes);
                for note in notes.lines() {
                    writeln!(told, "{name}: {note}")?;
                }
                let warnings = notes.lines().filter(|note| note.starts_with("warning"));
                Line {
                    warnings: warnings.count(),
                    ..line(name, &found)
                }
            }
            Err(fault) => {
                if let Some(before) = unexplained.replace(fault) {
                    writeln!(told, "error: {before}")?;
                }
                Line {
                    file: name,
                    rows: count,
                    warnings: 1,
                    ..Line::default()
                }
            }
        };
        lines.push(line);
    }
    let mut out = Vec::new();
    match format {
        Format::Table => table(&mut out, &lines)?,
        Format::Csv => serialized::csv(&mut out, lines.iter())?,
        Format::Jsonl => serialized::jsonl(&mut out, lines.iter())?,
    }
    file.write(&out)?;
    // The result is printed already: standard error may be closed.
    let _ = io::stderr().lock().write_all(&told);
    unexplained.map_or(Ok(()), Err)
}

/// The line of a recording that a resonator explains.
fn line(file: String, results: &Results) -> Line {
    let quantities = quantities(results);
    let rows: Vec<_> = quantities
        .iter()
        .map(|one| Row::new(one, results))
        .collect();
    let of = |run: Option<usize>, name: &str| {
        let row = rows
            .iter()
            .find(|row| row.run == run && row.quantity == name)?;
        Some((row.value, row.std?))
    };
    let runs = results.listed().enumerate();
    let longest = runs.max_by_key(|(_, run)| run.rows.len());
    let longest = longest.map(|(run, _)| run + 1);
    let is_of_run = |column: [&str; 2]| [DECAY_TIME, QUALITY_FACTOR].contains(&column);
    Line {
        file,
        rows: rows_in(&results.resonance.runs),
        runs: results.resonance.runs.len(),
        quantities: COLUMNS.map(|column| {
            let [name, _] = column;
            of(None, name).or_else(|| of(longest, name).filter(|_| is_of_run(column)))
        }),
        residual_over_noise: Some(significant(results.resonance.found.residual, 6)),
        warnings: 0,
    }
}

/// Prints the lines in aligned columns, with angles in degrees.
fn table(out: &mut impl Write, lines: &[Line]) -> io::Result<()> {
    let none = || "–".to_owned();
    let measured = |line: &Line, name: &str, units: f64| {
        let column = COLUMNS.iter().position(|[value, _]| *value == name)?;
        let (value, std) = line.quantities[column]?;
        Some(with_small_std(value * units, std * units).trim().to_owned())
    };
    let cells = lines.iter().map(|line| {
        let mut cells = vec![line.file.clone()];
        let shown = SHOWN.iter();
        cells.extend(
            shown.map(|(_, name, units)| measured(line, name, *units).unwrap_or_else(none)),
        );
        let residual = line.residual_over_noise;
        cells.push(residual.map_or_else(none, |residual| fixed(2, residual)));
        cells
    });
    let heads = SHOWN.iter().map(|(head, ..)| *head);
    let heads = ["recording"].into_iter().chain(heads).chain(["residual"]);
    let heads = heads.map(str::to_owned).collect();
    let cells: Vec<Vec<String>> = std::iter::once(heads).chain(cells).collect();
    let widths: Vec<_> = (0..cells[0].len())
        .map(|column| {
            let widths = cells.iter().map(|line| line[column].chars().count());
            widths.max().unwrap_or(0)
        })
        .collect();
    for line in &cells {
        let mut text = String::new();
        for (cell, width) in line.iter().zip(&widths) {
            text += &format!("{cell:<width$}  ");
        }
        writeln!(out, "{}", text.trim_end())?;
    }
    Ok(())
}

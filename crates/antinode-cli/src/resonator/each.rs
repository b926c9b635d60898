//! One resonator for each recording: a line for each, as for the gyros of a batch.

use std::f64::consts::{PI, TAU};
use std::io::{self, Write};

use serde::Serialize;

use super::found::Measured;
use super::{Results, SPLIT_SEEN, results};
use crate::digits::{fixed, significant, significant_or_known, with_small_std};
use crate::failure::Failure;
use crate::options::Format;
use crate::result_file::ResultFile;
use crate::runs::{Runs, driven};
use crate::serialized;

/// What `--help` says of the columns.
pub const HELP: &str = "\
With --each, CSV and JSON lines have one row for each recording: `file`; the number of its `rows` used and of its `runs`; the quantities \
of its resonator by the names above, each with its deviation, as `decay_time_s` and `decay_time_std_s`; `residual_over_noise`; and the \
number of `warnings`. Where the rows do not determine the splits, these are empty, and decay time and quality factor are those of the \
longest run. Of a recording that no resonator explains only the file and the warning are given.";

/// A recording's resonator.
#[derive(Serialize, Default)]
struct Line {
    file: String,
    rows: usize,
    runs: usize,
    frequency_hz: Option<f64>,
    frequency_std_hz: Option<f64>,
    decay_time_s: Option<f64>,
    decay_time_std_s: Option<f64>,
    quality_factor: Option<f64>,
    quality_factor_std: Option<f64>,
    damping_split_s: Option<f64>,
    damping_split_std_s: Option<f64>,
    most_damped_at_rad: Option<f64>,
    most_damped_at_std_rad: Option<f64>,
    most_damped_quality_factor: Option<f64>,
    most_damped_quality_factor_std: Option<f64>,
    least_damped_quality_factor: Option<f64>,
    least_damped_quality_factor_std: Option<f64>,
    frequency_split_hz: Option<f64>,
    frequency_split_std_hz: Option<f64>,
    highest_at_rad: Option<f64>,
    highest_at_std_rad: Option<f64>,
    residual_over_noise: Option<f64>,
    warnings: usize,
}

/// Prints a line for each recording, and the warnings for each. An error if no resonator explains the rows of one, with all others printed.
pub fn run(rows: Runs, format: Format, file: &ResultFile) -> Result<(), Failure> {
    let mut told = Vec::new();
    rows.write_notes(&mut told)?;
    let mut lines = Vec::new();
    let mut unexplained = None;
    for (name, rows) in rows.by_recording() {
        let count = rows.used();
        let line = match results(rows, &name) {
            Ok((found, left_out)) => {
                let mut notes = Vec::new();
                driven::warn(&mut notes, &left_out)?;
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
    let Results {
        found, frequency, ..
    } = results;
    let (mean, _) = frequency.mean;
    let resonator = found.resonator();
    let longest = || {
        let runs = results.rows.runs.iter().enumerate();
        let longest = runs.max_by_key(|(_, run)| run.rows.len());
        found.decay_of_run(longest.map_or(0, |(run, _)| run))
    };
    let decay = resonator
        .as_ref()
        .map_or_else(longest, |resonator| resonator.decay);
    let time = |(rate, std): Measured| (1.0 / rate, std / (rate * rate));
    let quality = |decay: Measured| {
        let (time, std) = time(decay);
        (PI * mean * time, PI * mean * std)
    };
    let is_seen = |[(split, std), _]: &[Measured; 2]| *split > SPLIT_SEEN * std;
    let damping = resonator.as_ref().map(|found| found.damping_split);
    let tuning = resonator.as_ref().map(|found| found.frequency_split);
    let seen = damping.filter(is_seen);
    let of_modes = resonator
        .as_ref()
        .filter(|_| seen.is_some())
        .map(|resonator| resonator.decays.map(quality));
    let [frequency_hz, frequency_std_hz] = rounded(Some(frequency.mean));
    let [decay_time_s, decay_time_std_s] = rounded(Some(time(decay)));
    let [quality_factor, quality_factor_std] = rounded(Some(quality(decay)));
    let [damping_split_s, damping_split_std_s] = rounded(damping.map(|[split, _]| split));
    let [most_damped_at_rad, most_damped_at_std_rad] = rounded(seen.map(|[_, at]| at));
    let [most_damped_quality_factor, most_damped_quality_factor_std] =
        rounded(of_modes.map(|[most, _]| most));
    let [least_damped_quality_factor, least_damped_quality_factor_std] =
        rounded(of_modes.map(|[_, least]| least));
    let in_hertz = |(split, std): Measured| (split / TAU, std / TAU);
    let [frequency_split_hz, frequency_split_std_hz] =
        rounded(tuning.map(|[split, _]| in_hertz(split)));
    let [highest_at_rad, highest_at_std_rad] = rounded(tuning.filter(is_seen).map(|[_, at]| at));
    Line {
        file,
        rows: results.rows.used(),
        runs: results.rows.runs.len(),
        frequency_hz,
        frequency_std_hz,
        decay_time_s,
        decay_time_std_s,
        quality_factor,
        quality_factor_std,
        damping_split_s,
        damping_split_std_s,
        most_damped_at_rad,
        most_damped_at_std_rad,
        most_damped_quality_factor,
        most_damped_quality_factor_std,
        least_damped_quality_factor,
        least_damped_quality_factor_std,
        frequency_split_hz,
        frequency_split_std_hz,
        highest_at_rad,
        highest_at_std_rad,
        residual_over_noise: Some(significant(found.residual, 6)),
        warnings: 0,
    }
}

/// A value and its deviation without digits that mean nothing.
fn rounded(measured: Option<Measured>) -> [Option<f64>; 2] {
    let digits = |(value, std)| [significant_or_known(value, 12, std), significant(std, 6)];
    measured
        .map(digits)
        .map_or([None; 2], |both| both.map(Some))
}

/// Prints the lines in aligned columns, with angles in degrees.
fn table(out: &mut impl Write, lines: &[Line]) -> io::Result<()> {
    let heads = [
        "recording",
        "frequency, Hz",
        "decay time, s",
        "quality factor",
        "damping split, 1/s",
        "at, °",
        "frequency split, Hz",
        "at, °",
        "residual",
    ];
    let measured = |value: Option<f64>, std: Option<f64>, units: f64| match (value, std) {
        (Some(value), Some(std)) => with_small_std(value * units, std * units).trim().to_owned(),
        _ => "–".to_owned(),
    };
    let degrees = 180.0 / PI;
    let cells = lines.iter().map(|line| {
        [
            line.file.clone(),
            measured(line.frequency_hz, line.frequency_std_hz, 1.0),
            measured(line.decay_time_s, line.decay_time_std_s, 1.0),
            measured(line.quality_factor, line.quality_factor_std, 1.0),
            measured(line.damping_split_s, line.damping_split_std_s, 1.0),
            measured(
                line.most_damped_at_rad,
                line.most_damped_at_std_rad,
                degrees,
            ),
            measured(line.frequency_split_hz, line.frequency_split_std_hz, 1.0),
            measured(line.highest_at_rad, line.highest_at_std_rad, degrees),
            line.residual_over_noise
                .map_or("–".to_owned(), |residual| fixed(2, residual)),
        ]
    });
    let cells: Vec<_> = std::iter::once(heads.map(str::to_owned))
        .chain(cells)
        .collect();
    let width = |column: usize| {
        let widths = cells.iter().map(|line| line[column].chars().count());
        widths.max().unwrap_or(0)
    };
    let widths: [usize; 9] = std::array::from_fn(width);
    for line in &cells {
        let mut text = String::new();
        for (cell, width) in line.iter().zip(widths) {
            text += &format!("{cell:<width$}  ");
        }
        writeln!(out, "{}", text.trim_end())?;
    }
    Ok(())
}

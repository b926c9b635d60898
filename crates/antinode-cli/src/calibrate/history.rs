//! Rows become runs: spans of time in which the pattern turns without a break.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::io::Read;

use csv::StringRecord;
use nalgebra::Complex;

use super::solve::{Fault, Found, PickOffs, solve};
use crate::failure::Failure;

/// The least rows of a run: four unknowns are its own.
const LEAST_ROWS: usize = 12;
/// The pattern turns by no more than this from row to row, rad: the sums over time are then good to 2 %.
const MOST_TURN: f64 = 0.1;
/// Columns that are read.
const COLUMNS: [&str; 6] = [
    "time_s",
    "main_amplitude",
    "quadrature_amplitude",
    "angle_rad",
    "frequency_hz",
    "main_amplitude_std",
];

/// A window's wave as the pick-offs show it.
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    /// Time, s.
    pub time: f64,
    /// Phasors of both pick-offs, in the samples' unit; their common phase is anything.
    pub raw: [Complex<f64>; 2],
    /// 2πf, rad/s.
    pub omega: f64,
    /// Standard deviation of an amplitude, in the samples' unit.
    pub deviation: f64,
}

/// A span of rows without a break.
#[derive(Debug, Clone, Default)]
pub struct Run {
    pub moments: Vec<Moment>,
    /// By how much the pattern turns, rad.
    pub turned: f64,
}

/// All that the rows tell.
#[derive(Debug)]
pub struct History {
    runs: Vec<Run>,
    /// Rows read, flagged ones among them.
    pub rows: usize,
    corrected: PickOffs,
}

impl History {
    /// Nothing yet; the rows to come were identified with this calibration.
    pub fn new(corrected: PickOffs) -> Self {
        Self {
            runs: Vec::new(),
            rows: 0,
            corrected,
        }
    }

    /// Adds the rows of a file.
    pub fn read(&mut self, name: &str, source: impl Read) -> Result<(), Failure> {
        let mut reader = csv::Reader::from_reader(source);
        let unreadable = |error: csv::Error| {
            Failure::Recording(format!(
                "{name}: {error}; give rows as `antinode identify --output csv` prints them"
            ))
        };
        let header = reader.headers().map_err(unreadable)?.clone();
        let place = |column: &str| header.iter().position(|name| name == column);
        let missing = |column: &str| {
            Failure::Recording(format!(
                "{name}: no column {column} in its first line; give rows as `antinode identify --output csv` prints them"
            ))
        };
        let mut places = [0; COLUMNS.len()];
        for (to, column) in places.iter_mut().zip(COLUMNS) {
            *to = place(column).ok_or_else(|| missing(column))?;
        }
        let flags = place("flags").ok_or_else(|| missing("flags"))?;
        let file = place("file");

        let mut present: Option<(String, f64)> = None;
        let mut run = Run::default();
        for record in reader.records() {
            let record = record.map_err(unreadable)?;
            self.rows += 1;
            let row = Row::parse(&record, places).ok_or_else(|| {
                let line = record.position().map_or(0, csv::Position::line);
                Failure::Recording(format!(
                    "{name}, line {line}: a time, amplitude, angle, frequency or deviation is no number, or an amplitude or a deviation not above 0; leave the line out"
                ))
            })?;
            if !record[flags].is_empty() {
                // What was lost may come back anywhere: the next row does not continue the last.
                if record[flags].contains("reacquired") {
                    self.end(&mut run);
                    present = None;
                }
                continue;
            }
            let from = file.map_or("", |file| &record[file]);
            let turn = match &present {
                Some((before, angle)) if before == from && run.is_before(row.time) => {
                    turn(row.angle - angle)
                }
                _ => f64::INFINITY,
            };
            if turn.abs() > MOST_TURN {
                self.end(&mut run);
            } else {
                run.turned += turn;
            }
            run.moments.push(row.moment(&self.corrected));
            present = Some((from.to_owned(), row.angle));
        }
        self.end(&mut run);
        Ok(())
    }

    /// Keeps a run that is long enough, and begins another.
    fn end(&mut self, run: &mut Run) {
        let run = std::mem::take(run);
        if run.moments.len() >= LEAST_ROWS {
            self.runs.push(run);
        }
    }

    /// Solves for the calibration.
    pub fn solve(&self) -> Result<Found, Fault> {
        solve(&self.runs, self.corrected)
    }
}

impl Run {
    /// True when the last row, if any, is earlier.
    fn is_before(&self, time: f64) -> bool {
        self.moments.last().is_none_or(|last| last.time < time)
    }
}

/// An angle's change, known modulo π/2: −π/4 to π/4.
fn turn(change: f64) -> f64 {
    change - FRAC_PI_2 * (change / FRAC_PI_2).round()
}

/// What is used of a row.
struct Row {
    time: f64,
    main: f64,
    quadrature: f64,
    angle: f64,
    frequency: f64,
    deviation: f64,
}

impl Row {
    /// None where a number is missing or not finite.
    fn parse(record: &StringRecord, places: [usize; COLUMNS.len()]) -> Option<Self> {
        let mut numbers = [0f64; COLUMNS.len()];
        for (number, place) in numbers.iter_mut().zip(places) {
            *number = record.get(place)?.parse().ok()?;
        }
        let [time, main, quadrature, angle, frequency, deviation] = numbers;
        let usable = numbers.iter().all(|number| number.is_finite()) && main > 0.0;
        (usable && deviation > 0.0).then_some(Self {
            time,
            main,
            quadrature,
            angle,
            frequency,
            deviation,
        })
    }

    /// The phasors of (1) to (3), as pick-offs of this calibration show them.
    fn moment(&self, corrected: &PickOffs) -> Moment {
        let (sine, cosine) = (2.0 * self.angle).sin_cos();
        let ideal = [
            Complex::new(self.main * cosine, self.quadrature * sine),
            Complex::new(self.main * sine, -self.quadrature * cosine),
        ];
        let omega = TAU * self.frequency;
        Moment {
            time: self.time,
            raw: corrected.distort(ideal, omega),
            omega,
            deviation: self.deviation,
        }
    }
}

#[cfg(test)]
mod tests;

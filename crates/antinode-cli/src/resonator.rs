//! `antinode resonator`: rows of ring-downs in, quality factor and splits out.

mod fit;
mod found;
mod frequency;
mod model;
mod motion;
mod start;

use std::f64::consts::{PI, TAU};
use std::io::{self, Write};
use std::path::PathBuf;

use antinode::Flags;
use clap::Args;
use serde::Serialize;

use crate::digits::{significant, with_std};
use crate::failure::Failure;
use crate::options::Format;
use crate::runs::{BEYOND_NOISE, Run, Runs};
use fit::fit;
use found::{Found, Measured};
use frequency::{Frequency, frequency};

/// The pattern turns by no more than this from row to row, rad: half of what leaves it known.
const MOST_TURN: f64 = PI / 8.0;
/// Flags of rows after which the pattern, or the time since the last row, is another: excited anew, or samples are missing.
const BREAKS: Flags = Flags::REACQUIRED.with(Flags::PHASE_JUMP).with(Flags::STEP);
/// A split of fewer deviations than this has no angle.
const SPLIT_SEEN: f64 = 3.0;
/// A decay of fewer deviations than this is none.
const DECAY_SEEN: f64 = 3.0;
/// A pattern that turns by more than this in a run, rad, shows flaws of the pick-offs as splits.
const TURNS: f64 = PI / 8.0;
/// Runs that stand still tell the splits without them, from two on.
const ENOUGH_STILL: usize = 2;
/// Residuals of neighbouring rows correlate by up to this where windows overlap by a tenth unseen, and by so many deviations more by chance.
const ALIKE: f64 = 0.1;
const ALIKE_SEEN: f64 = 5.0;

/// True where so many residuals that follow each other correlate by this, and not by chance.
fn is_alike(correlation: f64, count: f64) -> bool {
    correlation > ALIKE + ALIKE_SEEN / count.sqrt()
}

/// `antinode resonator`.
#[derive(Debug, Args)]
pub struct Resonator {
    /// Rows that `antinode identify` or `antinode monitor` printed with --output csv; `-` is standard input.
    #[arg(required = true, value_name = "ROWS")]
    pub rows: Vec<PathBuf>,
    /// How the quantities are printed: a table in degrees, or CSV or JSON lines in radians.
    #[arg(long, visible_alias = "format", value_enum, default_value_t = Format::Table, value_name = "FORMAT")]
    pub output: Format,
}

/// A kind of quantity: its name where angles are in radians, and where it is to be read, in units of which this many are one.
struct Kind {
    name: &'static str,
    label: &'static str,
    units: f64,
}

const fn kind(name: &'static str, label: &'static str, units: f64) -> Kind {
    Kind { name, label, units }
}

const DEGREES: f64 = 180.0 / PI;
const DECAY_TIME: Kind = kind("decay_time_s", "decay time, s", 1.0);
const QUALITY_FACTOR: Kind = kind("quality_factor", "quality factor", 1.0);
const ROTATION: Kind = kind("rotation_rad_s", "turned by rotation, °/s", DEGREES);
const FREQUENCY: Kind = kind("frequency_hz", "mean frequency, Hz", 1.0);
/// Both at one input unit squared.
const BY_ENERGY: Kind = kind("frequency_by_energy_hz", "by a_A² + a_B², Hz", 1.0);
const BY_AMPLITUDES: Kind = kind(
    "turning_by_amplitudes_rad_s",
    "turned by a_A·a_B, °/s",
    DEGREES,
);
/// Of the rows over their own deviations: 1 where there is nothing but noise.
const RESIDUAL: Kind = kind("residual_over_noise", "residual over noise", 1.0);
const DAMPING_SPLIT: Kind = kind("damping_split_s", "damping split, 1/s", 1.0);
const MOST_DAMPED: Kind = kind("most_damped_at_rad", "most damped at, °", DEGREES);
const FREQUENCY_SPLIT: Kind = kind("frequency_split_hz", "frequency split, Hz", 1.0);
const HIGHEST: Kind = kind("highest_at_rad", "highest at, °", DEGREES);

/// A quantity of the resonator, or of one run.
struct Quantity {
    /// The run, from 0; none where it is the resonator's.
    run: Option<usize>,
    kind: Kind,
    value: f64,
    /// One standard deviation; 0 where there is none.
    std: f64,
}

/// A quantity as CSV and JSON lines have it; the names are the columns.
#[derive(Serialize)]
struct Row {
    /// From 1.
    run: Option<usize>,
    quantity: &'static str,
    value: f64,
    std: Option<f64>,
}

impl From<&Quantity> for Row {
    fn from(quantity: &Quantity) -> Self {
        Self {
            run: quantity.run.map(|run| run + 1),
            quantity: quantity.kind.name,
            // More would be digits of nothing.
            value: significant(quantity.value, 12),
            std: (quantity.std > 0.0).then(|| significant(quantity.std, 6)),
        }
    }
}

/// Finds the resonator and prints it.
pub fn run(options: &Resonator) -> Result<(), Failure> {
    let (rows, name) = Runs::open(&options.rows, MOST_TURN, BREAKS)?;
    let found = fit(&rows.runs).map_err(|_| {
        Failure::Recording(format!(
            "{name}: no resonator explains the rows: see that nothing drives the gyro while it rings down, \
             and leave out rows that lie far off all others"
        ))
    })?;
    let frequency = frequency(&rows, &found);
    let quantities = quantities(&rows, &found, &frequency);
    let mut out = io::stdout().lock();
    match options.output {
        Format::Table => table(&mut out, &name, &rows, &quantities)?,
        Format::Csv => {
            let mut writer = csv::Writer::from_writer(&mut out);
            for quantity in &quantities {
                writer
                    .serialize(Row::from(quantity))
                    .map_err(io::Error::from)?;
            }
            writer.flush()?;
        }
        Format::Jsonl => {
            for quantity in &quantities {
                serde_json::to_writer(&mut out, &Row::from(quantity)).map_err(io::Error::from)?;
                writeln!(out)?;
            }
        }
    }
    // The result is printed: standard error may be closed.
    let _ = tell(&mut io::stderr().lock(), &rows, &found, &frequency);
    Ok(())
}

/// All that was found, run by run and then of the resonator.
fn quantities(rows: &Runs, found: &Found, frequency: &Frequency) -> Vec<Quantity> {
    let mut list = Vec::new();
    let mut add = |run, kind, (value, std): Measured| {
        list.push(Quantity {
            run,
            kind,
            value,
            std,
        });
    };
    let (mean_frequency, _) = frequency.mean;
    let resonator = found.resonator();
    for index in 0..rows.runs.len() {
        let run = Some(index);
        let decay_time = time(found.decay_of_run(index));
        add(run, DECAY_TIME, decay_time);
        add(run, QUALITY_FACTOR, scaled(decay_time, PI * mean_frequency));
        if let Some(resonator) = &resonator {
            add(run, ROTATION, resonator.rotations[index]);
        }
    }
    add(None, FREQUENCY, frequency.mean);
    if let Some(by_energy) = frequency.by_energy {
        add(None, BY_ENERGY, by_energy);
    }
    let of_residual = found.residual / (6.0 * rows.used() as f64).sqrt();
    add(None, RESIDUAL, (found.residual, of_residual));
    let Some(resonator) = resonator else {
        return list;
    };
    let decay_time = time(resonator.decay);
    add(None, DECAY_TIME, decay_time);
    add(
        None,
        QUALITY_FACTOR,
        scaled(decay_time, PI * mean_frequency),
    );
    for ([split, angle], size, at, unit) in [
        (resonator.damping_split, DAMPING_SPLIT, MOST_DAMPED, 1.0),
        (
            resonator.frequency_split,
            FREQUENCY_SPLIT,
            HIGHEST,
            1.0 / TAU,
        ),
    ] {
        add(None, size, scaled(split, unit));
        if split.0 > SPLIT_SEEN * split.1 {
            add(None, at, angle);
        }
    }
    if let Some(turning) = resonator.turning_by_amplitudes {
        add(None, BY_AMPLITUDES, turning);
    }
    list
}

/// The inverse of a rate.
fn time((rate, std): Measured) -> Measured {
    (1.0 / rate, std / (rate * rate))
}

fn scaled((value, std): Measured, by: f64) -> Measured {
    (value * by, std * by)
}

/// Prints quantities to be read, with angles in degrees.
fn table(out: &mut impl Write, name: &str, rows: &Runs, quantities: &[Quantity]) -> io::Result<()> {
    writeln!(out, "{name}: {} of {} rows", rows.used(), rows.rows)?;
    for of in quantities.chunk_by(|one, next| one.run == next.run) {
        match of[0].run {
            Some(index) => {
                let run = &rows.runs[index];
                writeln!(
                    out,
                    "run {}: {:.1} s, the pattern at {:.1}° turns by {:+.1}°",
                    index + 1,
                    run.seconds(),
                    run.rows[0].angle.to_degrees(),
                    run.turned.to_degrees()
                )?;
            }
            None => writeln!(out, "resonator")?,
        }
        for Quantity {
            kind, value, std, ..
        } in of
        {
            let text = with_std(value * kind.units, std * kind.units);
            writeln!(out, "  {:<24} {}", kind.label, text.trim_end())?;
        }
    }
    Ok(())
}

/// How fast the patterns turn, rad/s, where all that turn do so one way, and too few stand still.
fn one_way(rows: &Runs) -> Option<f64> {
    let (turning, still): (Vec<&Run>, Vec<&Run>) =
        rows.runs.iter().partition(|run| run.turned.abs() > TURNS);
    let way = turning.first()?.turned.signum();
    let is_one_way = turning.iter().all(|run| run.turned.signum() == way);
    let turned: f64 = turning.iter().map(|run| run.turned.abs()).sum();
    let seconds: f64 = turning.iter().map(|run| run.seconds()).sum();
    (is_one_way && still.len() < ENOUGH_STILL).then(|| turned / seconds)
}

/// Tells what the numbers leave open.
fn tell(out: &mut impl Write, rows: &Runs, found: &Found, frequency: &Frequency) -> io::Result<()> {
    rows.tell_overlaps(out)?;
    for run in 0..rows.runs.len() {
        let (decay, std) = found.decay_of_run(run);
        let what = if decay < -DECAY_SEEN * std {
            "grows: something drives it; its decay time and quality factor mean nothing"
        } else if decay < DECAY_SEEN * std {
            "does not decay beyond its noise: its decay time and quality factor mean nothing; record longer"
        } else {
            continue;
        };
        writeln!(out, "warning: the wave of run {} {what}", run + 1)?;
    }
    if found.resonator().is_none() {
        writeln!(
            out,
            "the rows do not tell the splits of damping and frequency: give ring-downs at pattern angles of 0°, 22.5° and 45°, or of a \
             pattern that turns by 45° and more; the mean frequency is that along the patterns, which a split moves"
        )?;
    } else if let Some(rate) = one_way(rows) {
        let (frequency, _) = frequency.mean;
        writeln!(
            out,
            "warning: the pattern turns one way only, and what is left of the pick-offs' flaws looks like splits then: a gain ratio that is 0.1 % \
             off like {:.1e} 1/s of damping, a skew 10 ns off like {:.1e} Hz; give rows of a pattern that turns the other way too",
            4e-3 * rate,
            4e-8 * rate * frequency
        )?;
    }
    if let Some(moves) = frequency.moves {
        writeln!(
            out,
            "warning: the frequency moves by {moves:.2e} Hz, rms, beyond noise: with the amplitude, or the temperature; the deviation of \
             the mean frequency is wider by that"
        )?;
    }
    let why = "the rotation or the damping changes meanwhile, or with the amplitude, or the pick-offs are not calibrated";
    if found.residual > BEYOND_NOISE {
        writeln!(
            out,
            "warning: rows differ from the resonator's motion by {:.1} times their noise: {why}; the deviations above are wider by that, and the \
             values may be further off than these",
            found.residual
        )?;
    } else if is_alike(found.alike, 3.0 * rows.used() as f64) {
        writeln!(
            out,
            "warning: rows that follow each other differ from the resonator's motion alike, which noise does not: {why}; the values may be \
             further off than the deviations above"
        )?;
    }
    Ok(())
}

//! `antinode resonator`: rows of ring-downs in, quality factor and splits out.

mod by_energy;
mod changing;
mod chords;
mod curve;
mod drift;
mod each;
mod fit;
mod found;
mod frequency;
mod gaps;
mod informing;
mod joined;
mod model;
pub mod motion;
mod normal;
mod notes;
mod quantities;
mod rests;
mod start;
mod stretches;

use std::f64::consts::PI;
use std::io;
use std::path::PathBuf;

use antinode::Flags;
use clap::Args;

use crate::failure::Failure;
use crate::given_rows::GivenRows;
use crate::options::Format;
use crate::result_file::{self, ResultFile};
use crate::runs::driven::{self, undriven};
use crate::runs::{BEYOND_NOISE, MIN_ROWS, Run, Runs};
use crate::serialized;
use fit::fit;
use found::Found;
use frequency::{Frequency, frequency};
use informing::informing;
use notes::write_notes;
use quantities::{HELP, Row, quantities, table};
use rests::rests;

/// Turn of the pattern from row to row, at most, rad: half of that up to which the angle is unambiguous.
const MAX_TURN: f64 = PI / 8.0;
/// Flags of rows that end a run: the wave was excited anew, or samples are missing.
const BREAKS: Flags = Flags::REACQUIRED.with(Flags::PHASE_JUMP).with(Flags::STEP);
/// Deviations below which a decay is not significant.
const DECAY_SEEN: f64 = 3.0;
/// Relative change of an amplitude per radian that the pattern turns, which is no drive: a gain ratio that is 30 % off causes it.
const BY_FLAWS: f64 = 0.6;
/// Rows that may be driven are left out if the residual of the others is that of noise, or below this share of that of all.
const MAX_RESIDUAL_SHARE: f64 = 0.05;
/// Correlation of consecutive residuals that an unnoticed overlap of windows may cause, and the deviations that chance may add.
const MAX_CORRELATION: f64 = 0.03;
const SIGNIFICANT: f64 = 5.0;

/// True if a correlation of consecutive residuals, of which there are `count`, is not due to chance.
fn is_alike(correlation: f64, count: f64) -> bool {
    correlation > MAX_CORRELATION + SIGNIFICANT / count.sqrt()
}

/// `antinode resonator`.
#[derive(Debug, Args)]
#[command(after_long_help = format!("{HELP}\n\n{}", each::HELP), allow_negative_numbers = true)]
pub struct Resonator {
    #[command(flatten)]
    pub given: GivenRows,
    /// How the quantities are printed: a table in degrees, or CSV or JSON lines in radians [default: as the name of --out ends, or else a
    /// table].
    #[arg(long, visible_alias = "format", value_enum, value_name = "FORMAT")]
    pub output: Option<Format>,
    #[command(flatten)]
    pub file: ResultFile,
    /// Find a resonator for each recording, as for the gyros of a batch, instead of one for all.
    #[arg(long)]
    pub each: bool,
    /// Write what the resonator's motion leaves of each row to this CSV file: its time, run, and how far a_A, a_B and θ lie from the motion,
    /// in their standard deviations. It shows where and when the rows are not explained.
    #[arg(long, value_name = "FILE", conflicts_with = "each")]
    pub residual: Option<PathBuf>,
}

impl Resonator {
    /// Rejects files to be written that are one, or are read, or cannot be written.
    fn check_files(&self) -> Result<(), Failure> {
        self.file.check(&self.given.rows)?;
        let Some(residual) = &self.residual else {
            return Ok(());
        };
        result_file::check_residual(residual, self.file.file())?;
        result_file::check("--residual", residual, &self.given.rows)
    }
}

/// What the rows show.
struct Results {
    rows: Runs,
    /// Indices of the runs that are listed, as they are informative by themselves.
    listed: Vec<usize>,
    found: Found,
    frequency: Frequency,
}

impl Results {
    /// The runs that are listed.
    fn listed(&self) -> impl Iterator<Item = &Run> {
        self.listed.iter().map(|&run| &self.rows.runs[run])
    }
}

/// The fit to the rows in which nothing drives the wave, with their runs and the driven ones.
///
/// What flaws of pick-offs may add to a wave's energy while its pattern turns hides that it is held. So if more than noise is left, driven
/// rows are sought as if there were no flaws, and left out if the others then agree far better.
fn decaying(runs: &[Run]) -> (Option<Found>, [Vec<Run>; 2]) {
    let energies: Vec<_> = runs.iter().map(Run::energies).collect();
    let parts = undriven(runs, &energies, BY_FLAWS);
    let found = fit(&parts[0]);
    let residual = found.as_ref().map_or(f64::INFINITY, |found| found.residual);
    if residual < BEYOND_NOISE {
        return (found, parts);
    }
    let fewer = undriven(runs, &energies, 0.0);
    if fewer[0].is_empty() || fewer[1].len() == parts[1].len() {
        return (found, parts);
    }
    // A damping that changes explains what flaws leave of fewer rows too.
    let better = fit(&fewer[0]).filter(|better| {
        better.is_damping_steady()
            && better.residual < BEYOND_NOISE.max(MAX_RESIDUAL_SHARE * residual)
    });
    match better {
        Some(better) => (Some(better), fewer),
        None => (found, parts),
    }
}

/// Finds the resonator and prints it.
pub fn run(options: &Resonator) -> Result<(), Failure> {
    let format = options.output.map_or_else(|| options.file.format(), Ok)?;
    options.check_files()?;
    let (rows, name) = Runs::open(&options.given, MAX_TURN, BREAKS)?;
    if options.each {
        return each::run(rows, format, &options.file);
    }
    let (results, driven) = results(rows, &name)?;
    let quantities = quantities(&results);
    let mut out = Vec::new();
    let rows_of = || quantities.iter().map(|one| Row::new(one, &results));
    match format {
        Format::Table => table(&mut out, &name, &results, &quantities)?,
        Format::Csv => serialized::csv(&mut out, rows_of())?,
        Format::Jsonl => serialized::jsonl(&mut out, rows_of())?,
    }
    options.file.write(&out)?;
    if let Some(path) = &options.residual {
        let mut left = Vec::new();
        serialized::csv(&mut left, rests(&results).iter())?;
        result_file::write(path, &left)?;
    }
    // The result is printed already: standard error may be closed.
    let mut err = io::stderr().lock();
    let _ = driven::warn(&mut err, &driven).and_then(|()| write_notes(&mut err, &results));
    Ok(())
}

/// What the rows show, and the runs left out because something drives the wave.
fn results(mut rows: Runs, name: &str) -> Result<(Results, Vec<Run>), Failure> {
    if rows.runs.is_empty() {
        return Err(Failure::Fault(format!(
            "{name}: no run of {MIN_ROWS} clean rows; see the rows' flags, shorten the windows, or record longer"
        )));
    }
    let (found, [runs, driven]) = decaying(&rows.runs);
    rows.runs = runs;
    let found = found.ok_or_else(|| {
        Failure::Fault(format!(
            "{name}: no resonator explains the rows: check that nothing drives the gyro while it rings down, and leave out outlying rows (see \
             --from and --to)"
        ))
    })?;
    let results = Results {
        listed: informing(&rows.runs, &found),
        frequency: frequency(&mut rows, &found),
        rows,
        found,
    };
    Ok((results, driven))
}

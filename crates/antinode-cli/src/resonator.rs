//! `antinode resonator`: rows of ring-downs in, quality factor and splits out.

mod each;
mod notes;
mod quantities;
mod rests;

use std::io;
use std::path::PathBuf;

use antinode_ringdown::resonator::{BREAKS, MAX_TURN, Resonance};
use antinode_ringdown::{MIN_ROWS, Run};
use clap::Args;

use crate::failure::Failure;
use crate::given_rows::GivenRows;
use crate::options::Format;
use crate::result_file::{self, ResultFile};
use crate::runs::Runs;
use crate::serialized;
use notes::write_notes;
use quantities::{HELP, Row, quantities, table};
use rests::rests;

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
    /// What was read, without its runs.
    rows: Runs,
    resonance: Resonance,
    /// Indices of the runs that are listed, as they are informative by themselves.
    listed: Vec<usize>,
}

impl Results {
    /// The runs that are listed.
    fn listed(&self) -> impl Iterator<Item = &Run> {
        self.listed.iter().map(|&run| &self.resonance.runs[run])
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
    let results = results(rows, &name)?;
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
    let _ = write_notes(&mut err, &results);
    Ok(())
}

/// What the rows show.
fn results(mut rows: Runs, name: &str) -> Result<Results, Failure> {
    let runs = std::mem::take(&mut rows.runs);
    if runs.is_empty() {
        return Err(Failure::Fault(format!(
            "{name}: no run of {MIN_ROWS} clean rows; see the rows' flags, shorten the windows, or record longer"
        )));
    }
    let resonance = Resonance::of(&runs).ok_or_else(|| {
        Failure::Fault(format!(
            "{name}: no resonator explains the rows: check that nothing drives the gyro while it rings down, and leave out outlying rows (see \
             --from and --to)"
        ))
    })?;
    Ok(Results {
        listed: resonance.informing(),
        rows,
        resonance,
    })
}

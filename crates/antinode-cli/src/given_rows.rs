//! Which rows a command is given.

use std::ops::Range;
use std::path::PathBuf;

use clap::Args;

use crate::failure::Failure;
use crate::ranges::{self, in_order};

/// The rows that a command is given.
#[derive(Debug, Args)]
pub struct GivenRows {
    /// Rows that `antinode identify` or `antinode monitor` printed with --output csv or jsonl; `-` is standard input.
    #[arg(required = true, value_name = "ROWS")]
    pub rows: Vec<PathBuf>,
    /// Use only rows from this time on, s, by their `time_s`.
    #[arg(long, value_name = "S", value_parser = ranges::time)]
    pub from: Option<f64>,
    /// Use only rows before this time, s.
    #[arg(long, value_name = "S", value_parser = ranges::time)]
    pub to: Option<f64>,
}

impl GivenRows {
    /// The times asked for, s.
    pub fn times(&self) -> Result<Range<f64>, Failure> {
        in_order(self.from, self.to)?;
        Ok(self.from.unwrap_or(f64::NEG_INFINITY)..self.to.unwrap_or(f64::INFINITY))
    }
}

/// The failure if no row lies within the times asked for; the rows' own times go from `first` to `last`, s.
pub fn none_within(names: &str, [first, last]: [f64; 2]) -> Failure {
    Failure::Fault(format!(
        "{names}: no row lies between --from and --to: the rows' times go from {first} s to {last} s"
    ))
}

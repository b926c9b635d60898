//! Which rows a fit is given.

use std::path::PathBuf;

use clap::Args;

use crate::ranges;

/// The rows that a fit is given.
#[derive(Debug, Args)]
pub struct Given {
    /// Rows that `antinode identify` or `antinode monitor` printed with --output csv; `-` is standard input.
    #[arg(required = true, value_name = "ROWS")]
    pub rows: Vec<PathBuf>,
    /// Only rows from this time on, s, as in their `time_s`: leave out what comes before the drive ends.
    #[arg(long, value_name = "S", value_parser = ranges::time)]
    pub from: Option<f64>,
    /// Only rows before this time, s.
    #[arg(long, value_name = "S", value_parser = ranges::time)]
    pub to: Option<f64>,
}

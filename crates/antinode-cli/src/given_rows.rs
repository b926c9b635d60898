//! Which rows a command is given.

use std::collections::HashMap;
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

/// The index of the recording of the next row, which `is_its` recognises; it is added as `new` if it is missing. Rows of several
/// recordings may be interleaved in the order of their times, but most follow one of the recording at `current`.
pub fn recording_of<T>(
    recordings: &mut Vec<T>,
    current: usize,
    is_its: impl Fn(&T) -> bool,
    new: impl FnOnce() -> T,
) -> usize {
    if recordings.get(current).is_some_and(&is_its) {
        return current;
    }
    recordings.iter().position(is_its).unwrap_or_else(|| {
        recordings.push(new());
        recordings.len() - 1
    })
}

/// The names of recordings, each given by the file of its rows and its own name: those of the same name are distinguished by these files.
pub fn told_apart(recordings: &[(String, String)]) -> Vec<String> {
    let mut count = HashMap::new();
    for (_, name) in recordings {
        *count.entry(name).or_insert(0) += 1;
    }
    let names = recordings.iter().map(|(input, name)| match count[name] {
        1 => name.clone(),
        _ => format!("{input}: {name}"),
    });
    names.collect()
}

/// The failure if no row lies within the times asked for; the rows' own times go from `first` to `last`, s.
pub fn none_within(names: &str, [first, last]: [f64; 2]) -> Failure {
    Failure::Fault(format!(
        "{names}: no row lies between --from and --to: the rows' times go from {first} s to {last} s"
    ))
}

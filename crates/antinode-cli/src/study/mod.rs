//! `antinode study`: the paper's comparison of its methods, computed anew, as figures and tables, with its conclusions checked.

mod conclusions;
mod draw;
mod evaluate;
mod figure;
mod noise_free;
mod noisy;
mod period;
mod samples;
mod table;
#[cfg(test)]
mod tests;

use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;

use antinode_sim::Wave;
use clap::Args;

use crate::failure::Failure;
use crate::recording::OutputError;

/// Under the help of the study.
const FILES: &str = "\
Files in the folder:
  figure-1a.svg, .png ...  1: against periods, 2: against samples a period, 3: against noise
  figure-1.csv ...         every point of every curve; value_is and x_is give the units";

/// `antinode study`.
#[derive(Debug, Args)]
#[command(after_help = FILES)]
pub struct Study {
    /// The folder for figures and tables; it is created if missing. Files of an earlier study are overwritten.
    #[arg(long, default_value = "study", value_name = "DIR")]
    out: PathBuf,
    /// Runs for each point of figure 3, at least 1.
    #[arg(long, default_value_t = 10_000, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    runs: u32,
    /// Seed of all noise.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Sample rate of figures 1 and 3, and a step of figure 2's, Hz.
const RATE: f64 = 100_000.0;

/// Computes, draws, and tells what is confirmed.
pub fn run(options: &Study) -> Result<(), Failure> {
    // Before the work, not after it.
    fs::create_dir_all(&options.out).map_err(|error| {
        Failure::Fault(format!(
            "{}: this folder cannot be made: {error}; give another --out",
            options.out.display()
        ))
    })?;
    let wave = Wave::default();
    let first = noise_free::against_periods(&wave);
    let second = noise_free::against_samples(&wave);
    let third = noisy::against_noise(&wave, options.runs, options.seed);

    for figure in [&first, &second, &third] {
        let path = options.out.join(format!("figure-{}.csv", figure.number));
        table::write(&path, figure)
            .map_err(|error| OutputError::io(&path.display().to_string(), error.into()))?;
        for panel in &figure.panels {
            let path = options
                .out
                .join(format!("figure-{}{}", figure.number, panel.letter));
            draw::write(&path, figure, panel)?;
        }
    }

    let mut out = io::stdout().lock();
    let panels: usize = [&first, &second, &third]
        .iter()
        .map(|figure| figure.panels.len())
        .sum();
    writeln!(
        out,
        "{panels} panels as SVG and PNG, and 3 tables as CSV, are in {}; {} runs a point in figure 3, seed {}.\n",
        options.out.display(),
        options.runs,
        options.seed,
    )?;
    for conclusion in conclusions::check(&wave, &first, &second, &third, options) {
        let verdict = conclusion.verdict.text();
        writeln!(out, "{verdict:>13}  {}", conclusion.claim)?;
        for line in conclusion.found.lines() {
            writeln!(out, "{:15}{line}", "")?;
        }
    }
    Ok(())
}

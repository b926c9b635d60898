//! `antinode study`: the paper's comparison of its methods, computed anew, as figures and tables, with its conclusions checked.

mod conclusions;
mod draw;
mod evaluate;
mod figure;
mod noise_free;
mod noisy;
mod period;
mod samples;
mod simulated;
mod table;
#[cfg(test)]
mod tests;

use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;

use clap::Args;

use crate::failure::{Failure, unwritable};
use crate::ranges;
use simulated::Simulated;

/// Text after the help of the study.
const FILES: &str = "\
Files in the folder:
  figure-1a.svg, .png ...  1: over periods, 2: over samples a period, 3: noise
  figure-1.csv ...         every point of every curve, and what was simulated;
                           value_is and x_is give the units

By default the wave, the rate, and the noise and windows of figure 3 are the paper's; only then are its \
conclusions checked. The same options give the same numbers.";

/// `antinode study`.
#[derive(Debug, Args)]
#[command(after_help = FILES)]
pub struct Study {
    /// The folder for figures and tables; it is created if missing. Files of an earlier study are overwritten.
    #[arg(short = 'o', long, default_value = "study", value_name = "DIR")]
    out: PathBuf,
    /// Runs for each point of figure 3, at least 1.
    #[arg(long, default_value_t = 10_000, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    runs: u32,
    /// Seed of all noise.
    #[arg(long, default_value_t = 1, value_name = "SEED", value_parser = ranges::seed)]
    seed: u64,

    #[command(flatten)]
    simulated: Simulated,
}

/// The paper's sample rate, Hz, at which its conclusions are checked.
const RATE: f64 = Simulated::PAPER.rate;

/// Computes and draws the figures, and prints which conclusions are confirmed.
pub fn run(options: &Study) -> Result<(), Failure> {
    // Before the computation, so that a failure shows at once.
    fs::create_dir_all(&options.out).map_err(|error| {
        Failure::Fault(format!(
            "{}: this folder cannot be made: {error}; give another --out",
            options.out.display()
        ))
    })?;
    let simulated = &options.simulated;
    let figures = [
        noise_free::against_periods(simulated),
        noise_free::against_samples(simulated),
        noisy::against_noise(simulated, options.runs, options.seed),
    ];
    for figure in &figures {
        let path = options.out.join(format!("figure-{}.csv", figure.number));
        table::write(&path, figure, &simulated.wave())
            .map_err(|error| unwritable(&path.display().to_string(), &error.into()))?;
        for panel in &figure.panels {
            let path = options
                .out
                .join(format!("figure-{}{}", figure.number, panel.letter));
            draw::write(&path, figure, panel)?;
        }
    }

    let mut out = io::stdout().lock();
    let panels: usize = figures.iter().map(|figure| figure.panels.len()).sum();
    writeln!(
        out,
        "{panels} panels as SVG and PNG, and 3 tables as CSV, are in {}; {} runs a point in figure 3, seed {}.\n{simulated}\n",
        options.out.display(),
        options.runs,
        options.seed,
    )?;
    if *simulated != Simulated::PAPER {
        writeln!(
            out,
            "The paper's conclusions are not checked: they are about what it simulated, without options."
        )?;
        return Ok(());
    }
    for conclusion in conclusions::check(&simulated.wave(), &figures, options) {
        let verdict = conclusion.verdict.text();
        writeln!(out, "{verdict:>13}  {}", conclusion.claim)?;
        for line in conclusion.found.lines() {
            writeln!(out, "{:15}{line}", "")?;
        }
    }
    Ok(())
}

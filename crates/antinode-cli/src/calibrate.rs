//! `antinode calibrate`: rows of a pattern that turned in, the pick-offs' calibration out.

mod history;
mod solve;

use std::fs::File;
use std::io::{self, IsTerminal, Read, Write};
use std::path::{Path, PathBuf};

use clap::Args;

use crate::failure::Failure;
use crate::fixed::with_std;
use crate::options::Corrected;
use history::History;
use solve::{Found, PickOffs};

/// The residual over its stated noise from which on it is told that something else moves.
const BEYOND_NOISE: f64 = 2.0;

/// `antinode calibrate`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Calibrate {
    /// Rows of `antinode identify --output csv` or `antinode monitor --format csv`; `-` is standard input.
    #[arg(required = true, value_name = "ROWS")]
    pub rows: Vec<PathBuf>,
    // What the rows were identified with.
    #[command(flatten)]
    pub corrected: Corrected,
}

/// Finds the calibration and prints it as options.
pub fn run(options: &Calibrate) -> Result<(), Failure> {
    let mut history = History::new(PickOffs::from(&options.corrected));
    let mut names = Vec::new();
    for path in &options.rows {
        let (name, source) = open(path)?;
        history.read(&name, source)?;
        names.push(name);
    }
    let name = names.join(", ");
    let found = history.solve().map_err(|fault| fault.of(&name))?;
    let mut report = io::stderr().lock();
    // Nobody need see the report: the result is on the other stream.
    let _ = tell(&mut report, &name, &history, &found);
    let PickOffs {
        gain_ratio,
        skew,
        angle,
    } = found.pick_offs;
    let [gain_std, skew_std, angle_std] = found.deviations;
    writeln!(
        io::stdout(),
        "--gain-ratio {} --skew-ns {} --pick-off-angle {}",
        rounded(gain_ratio, gain_std),
        rounded(skew * 1e9, skew_std * 1e9),
        rounded(angle, angle_std)
    )?;
    Ok(())
}

/// The rows' name and bytes.
fn open(path: &Path) -> Result<(String, Box<dyn Read>), Failure> {
    if path == Path::new("-") {
        if io::stdin().is_terminal() {
            eprintln!("reading rows from standard input; Ctrl-D ends them");
        }
        return Ok(("standard input".to_owned(), Box::new(io::stdin())));
    }
    let name = path.display().to_string();
    match File::open(path) {
        Ok(file) => Ok((name, Box::new(file))),
        Err(error) => Err(Failure::Recording(format!(
            "{name}: {error}; give the CSV file of rows that `antinode identify --output csv` printed"
        ))),
    }
}

/// Tells what was found, and how well.
fn tell(out: &mut impl Write, name: &str, history: &History, found: &Found) -> io::Result<()> {
    let [gain, skew, angle] = found.deviations;
    let PickOffs {
        gain_ratio,
        skew: late,
        angle: turned,
    } = found.pick_offs;
    let turns = found
        .turned
        .iter()
        .rev()
        .filter(|turned| turned.abs() > 0.0);
    let turns: Vec<_> = turns
        .map(|turned| format!("{:+.0}°", turned.to_degrees()))
        .collect();
    writeln!(
        out,
        "{name}: {} of {} rows; the pattern turns by {}",
        found.rows,
        history.rows,
        turns.join(" and ")
    )?;
    writeln!(out, "gain ratio           {}", with_std(gain_ratio, gain))?;
    writeln!(
        out,
        "skew, ns             {}",
        with_std(late * 1e9, skew * 1e9)
    )?;
    writeln!(out, "pick-off angle, rad  {}", with_std(turned, angle))?;
    if !found.knows_splits {
        writeln!(
            out,
            "warning: the pattern turns one way only: a resonator whose damping or frequency depends on the angle looks like a calibration then; \
             let it turn the other way in a second recording, and give the rows of both"
        )?;
    }
    if found.residual > BEYOND_NOISE {
        writeln!(
            out,
            "warning: rows differ from the calibrated wave by {:.1} times their noise: something else moves with the angle; the deviations \
             above are wider by that",
            found.residual
        )?;
    }
    Ok(())
}

/// A number to the digits that its deviation leaves, and one more.
fn rounded(value: f64, deviation: f64) -> String {
    let decimals = (2.0 - deviation.log10()).ceil().clamp(0.0, 9.0) as usize;
    format!("{value:.decimals$}")
}

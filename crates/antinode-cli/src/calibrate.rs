//! `antinode calibrate`: rows of a pattern that turned in, the pick-offs' calibration out.

mod moments;
mod solve;

use std::io::{self, Write};

use antinode::Flags;
use clap::Args;

use crate::digits::{decimals, with_std};
use crate::failure::Failure;
use crate::given::Given;
use crate::options::Corrected;
use crate::runs::{BEYOND_NOISE, Runs};
use moments::Run;
use solve::{Found, PickOffs, solve};

/// The pattern turns by no more than this from row to row, rad: the sums over time are then good to 2 %.
const MOST_TURN: f64 = 0.1;

/// `antinode calibrate`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Calibrate {
    #[command(flatten)]
    pub given: Given,
    // What the rows were identified with.
    #[command(flatten)]
    pub corrected: Corrected,
}

/// Finds the calibration and prints it as options.
pub fn run(options: &Calibrate) -> Result<(), Failure> {
    let corrected = PickOffs::from(&options.corrected);
    let (rows, name) = Runs::open(&options.given, MOST_TURN, Flags::REACQUIRED)?;
    let runs: Vec<_> = rows
        .runs
        .iter()
        .map(|run| Run::new(run, &corrected))
        .collect();
    let found = solve(&runs, corrected).map_err(|fault| fault.of(&name))?;
    let PickOffs {
        gain_ratio,
        skew,
        angle,
    } = found.pick_offs;
    let [of_gain, of_skew, of_angle] = found.deviations;
    let quantities = [
        ("gain ratio", "--gain-ratio", gain_ratio, of_gain),
        ("skew, ns", "--skew-ns", skew * 1e9, of_skew * 1e9),
        ("pick-off angle, rad", "--pick-off-angle", angle, of_angle),
    ];
    let mut report = io::stderr().lock();
    // The result goes to the other stream: standard error may be closed.
    let _ = tell(&mut report, &name, &rows, &found, &quantities);
    // One digit more than the report's two of the deviation.
    let options = quantities.map(|(_, option, value, deviation)| {
        let decimals = decimals(deviation) + 1;
        format!("{option} {value:.decimals$}")
    });
    writeln!(io::stdout(), "{}", options.join(" "))?;
    Ok(())
}

/// A quantity's name, its option, its value and its standard deviation.
type Quantity = (&'static str, &'static str, f64, f64);

/// Tells what was found, and how well.
fn tell(
    out: &mut impl Write,
    name: &str,
    rows: &Runs,
    found: &Found,
    quantities: &[Quantity],
) -> io::Result<()> {
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
        rows.used(),
        rows.rows,
        turns.join(" and ")
    )?;
    rows.tell_overlaps(out)?;
    for &(quantity, _, value, deviation) in quantities {
        let text = with_std(value, deviation);
        writeln!(out, "{quantity:<20} {}", text.trim_end())?;
    }
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
            "warning: rows differ from the calibrated wave by {:.1} times their noise: the wave is still driven in some rows (see --from), something \
             else moves with the angle, or a pick-off or the converter is nonlinear; the deviations above are wider by that, and the values may \
             be further off than these",
            found.residual
        )?;
    }
    Ok(())
}

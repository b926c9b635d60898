//! `antinode calibrate`: rows of a pattern that turned in, the pick-offs' calibration out.

use std::io::{self, Write};

use antinode::Flags;
use antinode_ringdown::calibration::{
    Calibration, Decay, Found, MAX_TURN, MIN_TURN_BACK, PickOffs,
};
use antinode_ringdown::{BEYOND_NOISE, Run};
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::digits::{decimals, fixed, significant, with_std};
use crate::failure::Failure;
use crate::given_rows::GivenRows;
use crate::options::{Corrected, Format};
use crate::result_file::ResultFile;
use crate::runs::{Runs, rows_in, warn_of_driven};
use crate::serialized;

/// Deviations below which a flaw is not significant.
const SIGNIFICANT: f64 = 3.0;

/// `antinode calibrate`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Calibrate {
    #[command(flatten)]
    pub given: GivenRows,
    /// How the calibration is printed [default: as the name of --out ends, or else options].
    #[arg(long, visible_alias = "format", value_enum, value_name = "FORMAT")]
    pub output: Option<Printed>,
    #[command(flatten)]
    pub file: ResultFile,
    // The calibration that the rows were identified with. It is last, as what follows would appear under its heading.
    #[command(flatten)]
    pub corrected: Corrected,
}

/// How a calibration is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Printed {
    /// Options of `antinode identify`, in one line.
    Options,
    /// Comma-separated values with a header: quantity, value and deviation.
    Csv,
    /// One JSON object per quantity.
    Jsonl,
}

/// A quantity; the fields that are not skipped are the columns of CSV and JSON lines.
#[derive(Clone, Copy, Serialize)]
struct Quantity {
    /// Its name in the report.
    #[serde(skip)]
    label: &'static str,
    /// The option of `antinode identify`.
    #[serde(skip)]
    option: &'static str,
    quantity: &'static str,
    value: f64,
    std: f64,
}

/// Finds the calibration and prints it.
pub fn run(options: &Calibrate) -> Result<(), Failure> {
    let format = match options.output {
        Some(printed) => printed,
        None => match options.file.format()? {
            Format::Table => Printed::Options,
            Format::Csv => Printed::Csv,
            Format::Jsonl => Printed::Jsonl,
        },
    };
    options.file.check(&options.given.rows)?;
    let corrected = PickOffs::from(&options.corrected);
    let (rows, name) = Runs::open(&options.given, MAX_TURN, Flags::REACQUIRED)?;
    let calibration = Calibration::of(&rows.runs, corrected)
        .map_err(|told| Failure::Fault(format!("{name}: {told}")))?;
    let Calibration {
        runs,
        driven,
        found,
    } = calibration;
    let quantities = quantities(&found);
    let mut report = io::stderr().lock();
    // The result goes to standard output: standard error may be closed.
    let _ = warn_of_driven(&mut report, &driven)
        .and_then(|()| write_report(&mut report, &name, (&rows, &runs), &found, &quantities));
    let apart = found.deviations.map(|std| SIGNIFICANT * std);
    if corrected == PickOffs::IDEAL {
        // Deviations that an unexplained residual has widened cover any flaws.
        let look = if !found.is_beyond_noise() && found.pick_offs.are_ideal_to(apart) {
            "the pick-offs look ideal: "
        } else {
            ""
        };
        let _ = writeln!(
            report,
            "{look}if the rows were identified with a calibration, give it here too: the printed options replace it"
        );
    }
    let mut out = Vec::new();
    print(&mut out, format, &quantities)?;
    options.file.write(&out)
}

impl From<&Corrected> for PickOffs {
    fn from(corrected: &Corrected) -> Self {
        Self {
            gain_ratio: corrected.gain_ratio.into(),
            skew: f64::from(corrected.skew_ns) * 1e-9,
            angle: corrected.pick_off_angle.into(),
        }
    }
}

/// The quantities of a calibration.
fn quantities(found: &Found) -> [Quantity; 3] {
    let of = |names: [&'static str; 3], value, std| {
        let [label, option, quantity] = names;
        Quantity {
            label,
            option,
            quantity,
            value,
            std,
        }
    };
    let gain_ratio = ["gain ratio", "--gain-ratio", "gain_ratio"];
    let skew = ["skew, ns", "--skew-ns", "skew_ns"];
    let angle = [
        "pick-off angle, rad",
        "--pick-off-angle",
        "pick_off_angle_rad",
    ];
    let (pick_offs, [of_gain, of_skew, of_angle]) = (found.pick_offs, found.deviations);
    [
        of(gain_ratio, pick_offs.gain_ratio, of_gain),
        of(skew, pick_offs.skew * 1e9, of_skew * 1e9),
        of(angle, pick_offs.angle, of_angle),
    ]
}

/// Prints the quantities.
fn print(out: &mut impl Write, how: Printed, quantities: &[Quantity]) -> io::Result<()> {
    let rows = quantities.iter().map(|one| Quantity {
        // More digits would mean nothing.
        value: significant(one.value, 12),
        std: significant(one.std, 6),
        ..*one
    });
    match how {
        Printed::Options => {
            // One more digit than the report, which shows two of the deviation.
            let options = quantities.iter().map(|one| {
                let decimals = decimals(one.std) + 1;
                format!("{} {}", one.option, fixed(decimals, one.value))
            });
            let options: Vec<_> = options.collect();
            writeln!(out, "{}", options.join(" "))
        }
        Printed::Csv => serialized::csv(out, rows),
        Printed::Jsonl => serialized::jsonl(out, rows),
    }
}

/// Writes the result and its quality.
fn write_report(
    out: &mut impl Write,
    name: &str,
    (rows, used): (&Runs, &[Run]),
    found: &Found,
    quantities: &[Quantity],
) -> io::Result<()> {
    let turns = found
        .turned
        .iter()
        .rev()
        .filter(|turned| turned.to_degrees().abs() >= 0.5);
    let turns: Vec<_> = turns
        .map(|turned| format!("{:+.0}°", turned.to_degrees()))
        .collect();
    writeln!(
        out,
        "{name}: {} of {} rows; the pattern turns by {}",
        rows_in(used),
        rows.rows,
        turns.join(" and ")
    )?;
    rows.write_notes(used, out)?;
    for one in quantities {
        let text = with_std(one.value, one.std);
        writeln!(out, "{:<20} {}", one.label, text.trim_end())?;
    }
    if !found.knows_splits {
        writeln!(
            out,
            "warning: the pattern turns only one way, or the other by less than {:.1}°, and a resonator's splits of damping and frequency \
             then look like flaws of the pick-offs; let it turn the other way in a second recording, and give the rows of both",
            MIN_TURN_BACK.to_degrees()
        )?;
    }
    if found.decay == Decay::Bent && !found.is_alike() {
        writeln!(
            out,
            "the damping changes while the wave rings down, or a gain of both pick-offs does: this is allowed for"
        )?;
    }
    let why = "the wave is still driven in some rows (identify each ring-down by itself with --from and --to), the damping changes in other \
               ways than are allowed for, a tone at the wave's frequency is always present (as from a drive's feed-through), a gain or the \
               wave jumped by too little to be flagged, something else changes with the angle, or a pick-off or the converter is nonlinear";
    if found.residual > BEYOND_NOISE {
        writeln!(
            out,
            "warning: rows differ from the calibrated wave by {:.1} times their noise: {why}; the deviations above include this factor, but \
             the values may be further off",
            found.residual
        )?;
    } else if found.is_alike() {
        writeln!(
            out,
            "warning: consecutive rows differ from the calibrated wave in the same way, which noise does not do: {why}; the values may be \
             further off than the deviations above"
        )?;
    }
    Ok(())
}

//! The quantities of a resonator and of its runs, and how they are printed.

use std::f64::consts::{PI, TAU};
use std::io::{self, Write};

use antinode_ringdown::resonator::{Measured, Resonance};
use serde::Serialize;

use super::Results;
use crate::digits::{fixed, significant, significant_or_known, with_small_std};
use crate::runs::{named, rows_in};

/// Deviations below which a split has no angle.
const SPLIT_SEEN: f64 = 3.0;

/// A kind of quantity: its name in CSV and JSON lines, its label in the table, and the factor from the unit of the former to the latter's.
struct Kind {
    name: &'static str,
    label: &'static str,
    units: f64,
}

const fn kind(name: &'static str, label: &'static str, units: f64) -> Kind {
    Kind { name, label, units }
}

const DEGREES: f64 = 180.0 / PI;
const DECAY_TIME: Kind = kind("decay_time_s", "decay time, s", 1.0);
const QUALITY_FACTOR: Kind = kind("quality_factor", "quality factor", 1.0);
const ROTATION: Kind = kind("rotation_rad_s", "turned by rotation, °/s", DEGREES);
const DECAY_DRIFT: Kind = kind("decay_rate_drift_s2", "decay rate drift, 1/s²", 1.0);
/// At one input unit squared, like that of the frequency below.
const DECAY_BY_ENERGY: Kind = kind(
    "decay_rate_by_energy_s",
    "1/τ with a_A² + a_B², 1/s/unit²",
    1.0,
);
const FREQUENCY: Kind = kind("frequency_hz", "mean frequency, Hz", 1.0);
const DRIFT: Kind = kind("frequency_drift_hz_s", "frequency drift, Hz/s", 1.0);
/// Both at one input unit squared.
const BY_ENERGY: Kind = kind(
    "frequency_by_energy_hz",
    "rise with a_A² + a_B², Hz/unit²",
    1.0,
);
const BY_AMPLITUDES: Kind = kind(
    "turning_by_amplitudes_rad_s",
    "turned by a_A·a_B, °/s per unit²",
    DEGREES,
);
/// Residual of the rows over their own deviations: 1 in noise alone.
const RESIDUAL: Kind = kind("residual_over_noise", "residual over noise", 1.0);
const DAMPING_SPLIT: Kind = kind("damping_split_s", "damping split, 1/s", 1.0);
const MOST_DAMPED: Kind = kind("most_damped_at_rad", "most damped at, °", DEGREES);
const FREQUENCY_SPLIT: Kind = kind("frequency_split_hz", "frequency split, Hz", 1.0);
const HIGHEST: Kind = kind("highest_at_rad", "highest at, °", DEGREES);
/// Decay time and quality factor of the mode that is damped most, and of the other, if the damping is split.
const OF_MODES: [[Kind; 2]; 2] = [
    [
        kind("most_damped_decay_time_s", "decay time there, s", 1.0),
        kind("most_damped_quality_factor", "quality factor there", 1.0),
    ],
    [
        kind(
            "least_damped_decay_time_s",
            "decay time 45° from there, s",
            1.0,
        ),
        kind(
            "least_damped_quality_factor",
            "quality factor 45° from there",
            1.0,
        ),
    ],
];
/// Of the mode whose frequency is highest, and of the other, if they are split.
const OF_BOTH: [Kind; 2] = [
    kind("highest_frequency_hz", "frequency there, Hz", 1.0),
    kind("lowest_frequency_hz", "frequency 45° from there, Hz", 1.0),
];

/// What `--help` says of the quantities.
pub const HELP: &str = "\
Quantities of CSV and JSON lines, their units, and those of their deviations:
  decay_time_s                 s      of amplitudes, to 1/e
  quality_factor               none
  decay_rate_drift_s2          1/s², of 1/τ with time, if it changes
  decay_rate_by_energy_s       1/s, at a_A² + a_B² of one input unit squared, if 1/τ depends on it
  rotation_rad_s               rad/s
  frequency_drift_hz_s         Hz/s, of a straight line through the frequencies
  frequency_hz                 Hz
  frequency_by_energy_hz       Hz, at a_A² + a_B² of one input unit squared
  residual_over_noise          none
  damping_split_s              1/s, like decay_rate_s of the rows; not a time
  most_damped_at_rad           rad    modulo π/2, from −π/4 to π/4, like that below
  most_damped_decay_time_s     s      of a pattern there
  most_damped_quality_factor   none
  least_damped_decay_time_s    s      of a pattern π/4 from there
  least_damped_quality_factor  none
  frequency_split_hz           Hz
  highest_at_rad               rad
  highest_frequency_hz         Hz
  lowest_frequency_hz          Hz
  turning_by_amplitudes_rad_s  rad/s, at a_A·a_B of one input unit squared

Quantities of one run have its number in `run`, its recording in `file`, and the times of its rows in `from_s` and `to_s`. Residuals \
near 1 (1.01 in windows of ten periods, whose deviations are estimates too) are noise; if one is larger, something else moves in that run.";

/// A quantity of the resonator, or of one run.
pub struct Quantity {
    /// Index of the run among those listed; `None` for the resonator.
    run: Option<usize>,
    kind: Kind,
    value: f64,
    /// One standard deviation; 0 if there is none.
    std: f64,
}

/// A quantity as CSV and JSON lines have it; the names are the columns.
#[derive(Serialize)]
pub struct Row<'a> {
    /// Number of the run, from 1.
    pub run: Option<usize>,
    pub quantity: &'static str,
    pub value: f64,
    pub std: Option<f64>,
    /// The run's recording, and the times of its first row and its last.
    file: Option<&'a str>,
    from_s: Option<f64>,
    to_s: Option<f64>,
}

impl<'a> Row<'a> {
    /// The row of a quantity.
    pub fn new(quantity: &Quantity, results: &'a Results) -> Self {
        let run = quantity.run.and_then(|run| results.listed().nth(run));
        Self {
            run: quantity.run.map(|run| run + 1),
            quantity: quantity.kind.name,
            // More digits would mean nothing.
            value: significant_or_known(quantity.value, 12, quantity.std),
            std: (quantity.std > 0.0).then(|| significant(quantity.std, 6)),
            file: run.map(|run| run.file.as_str()),
            from_s: run.map(|run| run.rows[0].time),
            to_s: run.map(|run| run.rows[run.rows.len() - 1].time),
        }
    }
}

/// All quantities, of each run listed and then of the resonator.
pub fn quantities(results: &Results) -> Vec<Quantity> {
    let Resonance {
        runs,
        found,
        frequency,
        ..
    } = &results.resonance;
    let mut list = Vec::new();
    let mut add = |run, kind, (value, std): Measured| {
        list.push(Quantity {
            run,
            kind,
            value,
            std,
        });
    };
    let (mean_frequency, _) = frequency.mean;
    let resonator = found.resonator();
    for (index, &place) in results.listed.iter().enumerate() {
        let run = Some(index);
        let of_run = frequency.means[place];
        for (kind, value) in of_decay(found.decay_of_run(place), of_run.0) {
            add(run, kind, value);
        }
        add(run, FREQUENCY, of_run);
        let seconds = runs[place].seconds();
        if let Some(drift) = found.decay_drift(place, seconds) {
            add(run, DECAY_DRIFT, drift);
        }
        if let Some(resonator) = &resonator {
            add(run, ROTATION, resonator.rotations[place]);
        }
        add(run, DRIFT, frequency.drifts[place]);
        let count = runs[place].rows.len();
        add(run, RESIDUAL, found.residual_of_run(place, count));
    }
    add(None, FREQUENCY, frequency.mean);
    if let Some(by_energy) = frequency.by_energy.value() {
        add(None, BY_ENERGY, by_energy);
    }
    if let Some(by_energy) = found.decay_by_energy() {
        add(None, DECAY_BY_ENERGY, by_energy);
    }
    let of_residual = found.residual / (2.0 * found.count).sqrt();
    add(None, RESIDUAL, (found.residual, of_residual));
    let Some(resonator) = resonator else {
        return list;
    };
    for (kind, value) in of_decay(resonator.decay, mean_frequency) {
        add(None, kind, value);
    }
    let [split, angle] = resonator.damping_split;
    add(None, DAMPING_SPLIT, split);
    if split.0 > SPLIT_SEEN * split.1 {
        add(None, MOST_DAMPED, angle);
        for (kinds, decay) in OF_MODES.into_iter().zip(resonator.decays) {
            let values = of_decay(decay, mean_frequency).map(|(_, value)| value);
            for (kind, value) in kinds.into_iter().zip(values) {
                add(None, kind, value);
            }
        }
    }
    let [split, angle] = resonator.frequency_split;
    let split = scaled(split, 1.0 / TAU);
    add(None, FREQUENCY_SPLIT, split);
    if split.0 > SPLIT_SEEN * split.1 {
        add(None, HIGHEST, angle);
        for (kind, sign) in OF_BOTH.into_iter().zip([0.5, -0.5]) {
            let (mean, std) = frequency.mean;
            add(
                None,
                kind,
                (mean + sign * split.0, std.hypot(0.5 * split.1)),
            );
        }
    }
    if let Some(turning) = resonator.turning_by_amplitudes {
        add(None, BY_AMPLITUDES, turning);
    }
    list
}

/// Decay time and quality factor at a decay rate, 1/s, and a frequency, Hz.
fn of_decay((rate, std): Measured, frequency: f64) -> [(Kind, Measured); 2] {
    let time = (1.0 / rate, std / (rate * rate));
    let quality_factor = scaled(time, PI * frequency);
    [(DECAY_TIME, time), (QUALITY_FACTOR, quality_factor)]
}

fn scaled((value, std): Measured, by: f64) -> Measured {
    (value * by, std * by)
}

/// Prints quantities as a table, with angles in degrees.
pub fn table(
    out: &mut impl Write,
    name: &str,
    results: &Results,
    quantities: &[Quantity],
) -> io::Result<()> {
    let Results {
        rows,
        resonance,
        listed,
    } = results;
    writeln!(
        out,
        "{name}: {} of {} rows",
        rows_in(&resonance.runs),
        rows.rows
    )?;
    for of in quantities.chunk_by(|one, next| one.run == next.run) {
        match of[0].run {
            Some(index) => {
                let run = &resonance.runs[listed[index]];
                let turned = fixed(1, run.turned().to_degrees());
                writeln!(
                    out,
                    "run {}: {}, the pattern at {}° turns by {}{turned}°",
                    index + 1,
                    named(run),
                    fixed(1, run.rows[0].angle.to_degrees()),
                    if turned.starts_with('-') { "" } else { "+" },
                )?;
            }
            None => writeln!(out, "resonator")?,
        }
        for Quantity {
            kind, value, std, ..
        } in of
        {
            let text = with_small_std(value * kind.units, std * kind.units);
            writeln!(out, "  {:<32} {}", kind.label, text.trim_end())?;
        }
    }
    writeln!(
        out,
        "deviations cover noise only, not a nonlinear pick-off or converter"
    )
}

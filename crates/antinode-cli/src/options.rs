//! The command line.

use antinode::Calibration;
use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::calibrate::Calibrate;
use crate::completions::Completions;
use crate::device::{command, monitor};
use crate::identify::Identify;
use crate::plot::Plot;
use crate::ranges;
use crate::resonator::Resonator;
use crate::simulate::Simulate;
use crate::study::Study;

/// Text below the main help: lists fit 80 columns, and each paragraph is one line, which clap wraps to the terminal's width.
const EXAMPLES: &str = "\
Examples:
  antinode                                              the demonstration
  antinode identify recording.wav                       a table to read
  antinode identify --output csv a.wav b.csv > rows.csv
  antinode identify --rate 100000 --columns t,C,D log.csv
  recorder | antinode identify --raw i16 --rate 100000 -
  antinode identify --output csv cw.wav ccw.wav | antinode calibrate -
  antinode identify --output csv --periods 1000 long.wav | antinode resonator -
  antinode plot rows.csv -o ring.svg
  antinode simulate -o ring.wav --noise 0.005 --decay-rate 0.5
  antinode monitor /dev/ttyACM0 --output csv > rows.csv
  antinode command /dev/ttyACM0 window 20

The exit code is 0 if all went well, 1 if something is wrong with a file, a port or the system, 2 if something is wrong with the \
command line, and 130 after Ctrl-C.";

/// Identifies the standing wave of a hemispherical resonator gyro, window by window, in recordings of its two pick-offs.
///
/// Without a command: simulates a ring-down, streams it through the identification, and prints the results beside the true values.
#[derive(Debug, Parser)]
#[command(name = "antinode", version, max_term_width = 100, after_help = EXAMPLES)]
pub struct Options {
    /// What to do; without it, a demonstration.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// What the command can do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Identifies the wave in recordings, one row per window.
    ///
    /// A row's time is the middle of its window, in s from the first sample, plus the first value of the recording's time column, if it
    /// has one. If --rate is given, a column that increases by 1 per line is an index, not a time.
    ///
    /// Rows go to standard output; messages, such as how many rows are flagged and why, go to standard error. The exit code is 0 if all was
    /// read, flagged or not, 1 if something is wrong with a recording, 2 if something is wrong with the command line, and 130 after Ctrl-C.
    Identify(Box<Identify>),
    /// Finds the calibration of the pick-offs from rows of a gyro whose pattern turned, and prints it as options.
    ///
    /// Let the gyro ring down on a turning table until the pattern has turned by 90° or more, and repeat with the table turning the other
    /// way; identify both recordings in windows that do not overlap. Energy and quadrature then depend on the angle only through the flaws
    /// of the pick-offs. Only the options go to standard output; their deviations go to standard error.
    ///
    /// If the rows were identified with a calibration, give it here too; the printed one replaces it.
    Calibrate(Calibrate),
    /// Finds the resonator's quality factor and the splits of its damping and frequency from rows of ring-downs.
    ///
    /// Calibrate the pick-offs first, and identify in windows that do not overlap; in a recording of hours, windows may be long, provided
    /// that the pattern turns by less than 22.5° within one. A pattern at rest gives the decay time at its own angle only. Ring-downs at
    /// pattern angles of 0°, 22.5° and 45°, or of a pattern that turns, also give both splits, which are the differences between the decay
    /// rates and between the frequencies of the two modes, the pattern angles at which damping and frequency are greatest, and how fast
    /// rotation turns each run's pattern. Give ring-downs that turn both ways: if all turn one way, flaws that a calibration leaves look
    /// like splits.
    ///
    /// If a shell's stiffness depends on the amplitude, its pattern turns in proportion to a_A·a_B and its frequency moves with a_A² +
    /// a_B². Both effects are printed, per input unit squared, if they exceed their noise, the turning by three deviations. The deviation
    /// of the frequency's part allows for a drift with time, as with temperature, unless none is seen and the turning agrees; if that part
    /// may be a drift, a line says so instead.
    ///
    /// Deviations are those due to noise. They do not include nonlinearity of pick-offs or converter, which looks like damping that depends
    /// on the amplitude: a cubic part of 1e-4 S³ shortens the decay time found for a wave of a_A = 0.8 by 2e-5 of itself in a recording of
    /// four decay times, and by 5e-5 in one of a third of a decay time.
    ///
    /// A run ends where the wave is lost or jumps: so one recording may hold several ring-downs, and missing samples do not bias the rates.
    /// Runs in which the wave grows or is held, while it decays in others, are left out, and a message says so.
    Resonator(Resonator),
    /// Draws rows over time: both amplitudes, pattern angle, frequency and residual, with their deviations and flags.
    ///
    /// Bands extend one standard deviation to either side; red marks at the bottom of a panel are flagged rows. A line ends where rows are
    /// missing or flagged `lost`. Axes fit the unflagged rows with at most three times the median deviation; if such rows are few, axes fit
    /// flagged ones too, except the outermost. An arrow at a panel's edge marks rows that lie far beyond, such as the last ones of a
    /// ring-down. With more than six recordings, colours follow the order of the recordings.
    Plot(Plot),
    /// Writes a simulated recording, and its true values beside it as JSON.
    Simulate(Box<Simulate>),
    /// Recomputes the paper's comparison of its four methods: figures, tables, and a check of its conclusions.
    Study(Study),
    /// Shows what a device reports over its serial port, live: estimates as rows, everything else on standard error.
    ///
    /// Damaged and missing reports are counted, and the counts are printed at the end. A device on a port is first asked for its
    /// configuration. Ctrl-C ends the command, a second one at once.
    Monitor(monitor::Monitor),
    /// Sends a command to a device over its serial port, and waits for its acknowledgement.
    ///
    /// What is changed lasts until the device is reset; `firmware/src/settings.rs` has what it starts with.
    #[command(name = "command")]
    Send(command::Options),
    /// Prints a script that lets a shell complete the command line.
    ///
    /// bash: `antinode completions bash > ~/.local/share/bash-completion/completions/antinode`; zsh: into a file `_antinode` in a directory
    /// of $fpath; fish: into ~/.config/fish/completions/antinode.fish.
    Completions(Completions),
}

/// How the pick-offs differ from ideal ones.
#[derive(Debug, Clone, Copy, Args)]
#[command(allow_negative_numbers = true, next_help_heading = "Pick-offs")]
pub struct Corrected {
    /// Gain of pick-off D over that of C, 0.1 to 10.
    #[arg(long, default_value_t = 1.0, value_name = "RATIO", value_parser = ranges::gain_ratio)]
    pub gain_ratio: f32,
    /// How much later pick-off D is sampled than C, ns, within ±1000000.
    #[arg(long, default_value_t = 0.0, value_name = "NS", value_parser = ranges::skew_ns)]
    pub skew_ns: f32,
    /// Pick-off D stands at 45° plus this angle from C, rad, within ±0.3.
    #[arg(long, default_value_t = 0.0, value_name = "RAD", value_parser = ranges::pick_off_angle)]
    pub pick_off_angle: f32,
}

/// How rows are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Aligned columns, for reading.
    Table,
    /// Comma-separated values with a header.
    Csv,
    /// One JSON object per line.
    Jsonl,
}

/// Converts a skew from ns to the core's unit, s.
pub fn seconds(skew_ns: f32) -> f32 {
    // Computed in f64, so that 1000000 ns gives exactly the core's limit of 1 ms.
    (f64::from(skew_ns) * 1e-9) as f32
}

impl Corrected {
    /// The calibration in the core's units.
    pub fn calibration(&self) -> Calibration {
        Calibration {
            gain_ratio: self.gain_ratio,
            skew: seconds(self.skew_ns),
            pick_off_angle: self.pick_off_angle,
        }
    }
}

#[cfg(test)]
mod tests;

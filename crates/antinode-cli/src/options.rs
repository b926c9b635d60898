//! The command line.

use std::path::PathBuf;

use antinode::{Calibration, Detection, Settings};
use clap::{Args, Parser, Subcommand, ValueEnum, value_parser};

use crate::calibrate::Calibrate;
use crate::plot::Plot;
use crate::ranges;
use crate::recording::{Columns, RawFormat};
use crate::resonator::Resonator;

/// Under the help of the whole.
const EXAMPLES: &str = "\
Examples:
  antinode                                              the demonstration
  antinode identify recording.wav                       a table to read
  antinode identify --output csv a.wav b.npy > rows.csv
  antinode identify --rate 100000 --columns t,C,D log.csv
  recorder | antinode identify --raw i16 --rate 100000 -
  antinode identify --output csv one_way.wav other_way.wav | antinode calibrate -
  antinode identify --output csv --periods 1000 long.wav | antinode resonator -
  antinode plot rows.csv -o ring.svg
  antinode simulate -o ring.wav --noise 0.005 --decay-rate 0.5
  antinode monitor /dev/ttyACM0 --format csv > rows.csv
  antinode command /dev/ttyACM0 window 20";

/// The most periods a window may have; the ring of blocks holds two more.
pub const MOST_PERIODS: u16 = 1022;

/// Identifies the standing wave of a hemispherical resonator gyro, window by window, in recordings of its two pick-offs.
///
/// With no command: simulates a ring-down, streams it through the identification, and shows what it found beside the truth.
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
    /// Identifies the wave in recordings, one row a window.
    ///
    /// A row's time is the middle of its window, counted from the first sample. The first value of the recording's time column is
    /// added, unless that column is an index: it goes up by 1 a line, and --rate is given.
    Identify(Box<Identify>),
    /// Finds the calibration of the pick-offs from rows of a gyro whose pattern turned, and prints it as options.
    ///
    /// Let the gyro ring down on a table that turns until the pattern has turned by 90° or more, and once more the other way around;
    /// identify both recordings in windows that do not overlap. Energy and quadrature then depend on the angle only by the flaws of
    /// the pick-offs. The options alone go to standard output, their deviations to standard error.
    ///
    /// If the rows were identified with a calibration, give it here too; what is printed replaces it.
    Calibrate(Calibrate),
    /// Finds the resonator's quality factor and the splits of its damping and frequency from rows of ring-downs.
    ///
    /// Calibrate the pick-offs first, and identify in windows that do not overlap; for a record of hours they may be long, provided that
    /// the pattern turns by less than 22.5° within one. A pattern at rest gives the decay time at its own angle only. Ring-downs at
    /// pattern angles of 0°, 22.5° and 45°, or of a pattern that turns, give both splits too: how far the decay rates and the
    /// frequencies of the two modes are apart, and the pattern angle at which each is greatest; and how fast rotation turns each run's
    /// pattern.
    ///
    /// A run ends where the wave is lost or jumps: one recording may hold several ring-downs, and missing samples do not falsify the
    /// rates.
    Resonator(Resonator),
    /// Draws rows over time: both amplitudes, pattern angle, frequency and residual, with their deviations and flags.
    ///
    /// Bands are one standard deviation wide to either side; red marks at a panel's foot are flagged rows. A line ends where rows are missing or
    /// flagged `lost`. Axes fit the rows without a flag: a flagged value far beyond them is held at the panel's edge.
    Plot(Plot),
    /// Writes a simulated recording, and the truth beside it as JSON.
    Simulate(Box<super::simulate::Simulate>),
    /// Computes the paper's comparison of its four methods anew: figures, tables, and its conclusions checked.
    Study(super::study::Study),
    /// Shows what a device reports over its serial port, live: estimates as rows, all else on standard error.
    ///
    /// Damaged and missing reports are counted, and the counts are told at the end. A device on a port is first asked for its configuration.
    /// Ctrl-C ends the command.
    Monitor(super::device::monitor::Monitor),
    /// Sends a command to a device over its serial port, and waits for its acknowledgement.
    #[command(name = "command")]
    Send(super::device::command::Options),
}

/// `antinode identify`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Identify {
    /// Recordings: WAV (left S_C, right S_D), CSV, NPY, told apart by their content; `-` is standard input.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Periods a window, 2 to 1022.
    #[arg(long, default_value_t = 10, value_name = "N", value_parser = value_parser!(u16).range(2..=i64::from(MOST_PERIODS)))]
    pub periods: u16,
    /// Blocks from the start of one window to the start of the next [default: those of one window].
    ///
    /// With --hop a block is a period, or a tenth of the window where that has fewer than ten periods.
    /// Fewer blocks than a window has make windows overlap, more leave gaps.
    #[arg(long, value_name = "BLOCKS", value_parser = value_parser!(u16).range(1..))]
    pub hop: Option<u16>,
    /// Sample rate, Hz, 1 to 1e10 [default: the recording's own].
    #[arg(long, value_name = "HZ", value_parser = ranges::rate)]
    pub rate: Option<f64>,
    /// Only samples from this time on, s, as in the rows: by the recording's time column, or else from the first sample.
    #[arg(long, value_name = "S", value_parser = ranges::time)]
    pub from: Option<f64>,
    /// Only samples before this time, s.
    #[arg(long, value_name = "S", value_parser = ranges::time)]
    pub to: Option<f64>,
    /// How rows are printed.
    #[arg(long, visible_alias = "format", value_enum, default_value_t = Format::Table, value_name = "FORMAT")]
    pub output: Format,
    /// Which methods a row shows.
    ///
    /// With `all`, columns method1_… to method4_… follow in CSV and JSON lines; those that end in off_sigma are differences from the
    /// exact solution in its standard deviations. Windows without a wave have none.
    #[arg(long, value_enum, default_value_t = Methods::Exact)]
    pub methods: Methods,
    /// Format of raw samples, for what is neither WAV nor NPY, nor text by its extension: little-endian, S_C and S_D in turn.
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub raw: Option<RawFormat>,
    /// Columns of a text recording by name or by number from 1, as C,D or TIME,C,D; channels of a WAV or NPY recording by number, as C,D
    /// [default: told by their names, or how many there are].
    ///
    /// With --columns, what is neither WAV nor NPY is read as text, unless --raw is given; without, text is known by its first line.
    /// Where only two columns are named, the recording's own time is ignored, and --rate gives the rate. Lines that begin with #, % or // are comments,
    /// and settings above the samples are skipped; a line of units may follow the header, and a time in ms, us or ns is understood.
    #[arg(long, value_name = "COLUMNS")]
    pub columns: Option<Columns>,
    /// The wave's frequency, Hz, if it is known within 5 %: it is then not searched for, and the first window begins with the first
    /// sample.
    ///
    /// For noise or tones in which the search finds no period, for recordings of a few periods, and for 2.5 to 1024 samples a period, where
    /// the search needs 4 to 200.
    #[arg(long, value_name = "HZ", value_parser = ranges::positive, conflicts_with = "detector")]
    pub frequency: Option<f32>,
    /// How the period is searched for: where one way finds none, as a second tone may hide it, try the other.
    #[arg(long, value_enum, default_value_t = Detector::Difference)]
    pub detector: Detector,
    /// The signals carry mains hum, or an offset that wanders: it is then taken neither for noise nor for a fault.
    ///
    /// Each block, of a period or two, gets an offset of its own. Windows must have 5 periods or more, or 10 where --hop is given.
    #[arg(long)]
    pub hum: bool,
    /// Where the pattern stands at first, to within π/4, as the angle is known modulo π/2 only; rad, within ±10000 [default: π/4, so that
    /// the first window's angle lies in 0…π/2].
    #[arg(long, value_name = "RAD", value_parser = ranges::start_angle)]
    pub start_angle: Option<f32>,

    #[command(flatten)]
    pub corrected: Corrected,
    /// |sample| at which the converter is at its rail, above 0 [default: known for integers, none for others].
    #[arg(long, value_name = "LEVEL", value_parser = ranges::positive, help_heading = "Calibration")]
    pub full_scale: Option<f32>,
    /// Step between two codes of the converter, above 0, in the unit of the samples [default: found in the first samples].
    ///
    /// It is found where the first samples are all multiples of one step; integers are looked through too, as they may come from a
    /// converter of fewer bits. A file may begin with up to 250 000 pairs of silence. In a pipe it is found only for text with a time
    /// column; integers then have the step of all their bits.
    #[arg(long, value_name = "STEP", value_parser = ranges::positive, help_heading = "Calibration")]
    pub resolution: Option<f32>,
}

/// How the pick-offs differ from ideal ones.
#[derive(Debug, Clone, Copy, Args)]
#[command(allow_negative_numbers = true, next_help_heading = "Calibration")]
pub struct Corrected {
    /// Gain of pick-off D over that of C, 0.1 to 10.
    #[arg(
        long,
        default_value_t = 1.0,
        value_name = "RATIO",
        value_parser = ranges::gain_ratio
    )]
    pub gain_ratio: f32,
    /// How much later than C pick-off D is sampled, ns, within ±1000000.
    #[arg(
        long,
        default_value_t = 0.0,
        value_name = "NS",
        value_parser = ranges::skew_ns
    )]
    pub skew_ns: f32,
    /// Pick-off D stands at 45° plus this angle from C, rad, within ±0.3.
    #[arg(
        long,
        default_value_t = 0.0,
        value_name = "RAD",
        value_parser = ranges::pick_off_angle
    )]
    pub pick_off_angle: f32,
}

/// Which methods a row shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Methods {
    /// The exact solution alone.
    Exact,
    /// The paper's four methods beside it, ranked, with a warning where they disagree beyond noise.
    All,
}

/// How rows are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Aligned columns, for reading.
    Table,
    /// Comma-separated values with a header.
    Csv,
    /// One JSON object a line.
    Jsonl,
}

/// Formulas for the period.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Detector {
    /// Formula (10), the squared difference: finds a period sooner, and in more noise.
    Difference,
    /// Formula (9), the return of the running sum: for little noise, and where a second tone hides the period.
    MeanReturn,
}

/// A skew in the core's unit.
pub fn seconds(skew_ns: f32) -> f32 {
    // By way of f64: the limit of 1 ms stays what it is.
    (f64::from(skew_ns) * 1e-9) as f32
}

impl Corrected {
    /// The same in the core's units.
    pub fn calibration(&self) -> Calibration {
        Calibration {
            gain_ratio: self.gain_ratio,
            skew: seconds(self.skew_ns),
            pick_off_angle: self.pick_off_angle,
        }
    }
}

impl Identify {
    /// The core's settings for a recording of this sample rate, full scale and resolution.
    pub fn settings(
        &self,
        sample_rate: f64,
        full_scale: Option<f32>,
        resolution: Option<f32>,
    ) -> Settings {
        let plain = Settings::new(sample_rate);
        Settings {
            periods: self.periods,
            hop: self.hop,
            start_angle: self.start_angle.unwrap_or(plain.start_angle),
            rails: self.full_scale.or(full_scale).map(|full| [-full, full]),
            resolution: self.resolution.or(resolution),
            frequency: self.frequency,
            detection: match self.detector {
                Detector::Difference => Detection::Difference,
                Detector::MeanReturn => Detection::MeanReturn,
            },
            hum: self.hum,
            calibration: self.corrected.calibration(),
            ..plain
        }
    }
}

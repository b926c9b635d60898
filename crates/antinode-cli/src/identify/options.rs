//! The command line of `antinode identify`.

use std::path::PathBuf;

use antinode::{Detection, Settings};
use clap::{Args, ValueEnum, value_parser};

use crate::options::{Corrected, Format};
use crate::ranges;
use crate::recording::{Columns, RawFormat};

/// The most periods a window may have; the ring of blocks holds two more.
pub const MOST_PERIODS: u16 = 1022;

/// More channels than any recorder takes in turn.
const MOST_CHANNELS: u8 = 64;

/// `antinode identify`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Identify {
    /// Recordings: WAV (left S_C, right S_D), CSV, NPY, told apart by their content; `-` is standard input.
    ///
    /// Integers are scaled so that full scale is 1, and unsigned ones so that mid-scale is 0: 12-bit codes from 0 to 4095 in 16 bits are a
    /// wave about an offset, which does no harm, but that a wave of less than 60 codes is found in signed integers only.
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
    /// exact solution in its standard deviations. They are empty in windows without a wave, or with less than a quarter of a period of
    /// samples before them.
    #[arg(long, value_enum, default_value_t = Methods::Exact)]
    pub methods: Methods,
    /// Format of raw samples, for what is neither WAV nor NPY nor text, whatever its extension: little-endian, S_C and S_D in turn,
    /// or among --channels.
    ///
    /// Beside it, text is what has .csv, .tsv, .txt or .lvm behind its name and lines of numbers in it.
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub raw: Option<RawFormat>,
    /// Channels of raw samples that come in turn, 2 to 64, of which --columns picks those of S_C and S_D [default: 2].
    #[arg(long, value_name = "N", requires = "raw", value_parser = value_parser!(u8).range(2..=i64::from(MOST_CHANNELS)))]
    pub channels: Option<u8>,
    /// Columns of a text recording by name or by number from 1, as C,D or TIME,C,D; channels of a WAV, NPY or raw recording by number, as
    /// C,D [default: told by their names, or how many there are].
    ///
    /// With --columns, what is neither WAV nor NPY is read as text, unless --raw is given; without, text is known by its first line.
    /// Where only two columns are named, the recording's own time is ignored, and --rate gives the rate. Lines that begin with #, % or //
    /// are comments, and settings above the samples are skipped; a line of units may follow the header, and a time in ms, us or ns is
    /// understood.
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
    /// The noise is not white, as behind a tuned front end, or a filter that cuts off below three times the frequency.
    ///
    /// Less of it at three times the frequency is then no fault. In windows of 5 periods or more (10 with --hop) what it has
    /// at low frequencies does not count, as with --hum. A second tone that is there all along counts as noise.
    #[arg(long)]
    pub coloured: bool,
    /// Where the pattern stands at first, to within π/4, as the angle is known modulo π/2 only; rad, within ±10000 [default: π/4, so that
    /// the first window's angle lies in 0…π/2].
    #[arg(long, value_name = "RAD", value_parser = ranges::start_angle)]
    pub start_angle: Option<f32>,

    #[command(flatten)]
    pub corrected: Corrected,
    /// Samples at which the converter is at its rails: ±LEVEL, or LOW and HIGH, as 0,4095 [default: known for integers, none for others].
    ///
    /// They are in the unit of the samples; integers of WAV, NPY and raw samples are scaled so that full scale is 1.
    #[arg(long, value_name = "LEVEL|LOW,HIGH", value_parser = ranges::rails, allow_hyphen_values = true, help_heading = "Calibration")]
    pub full_scale: Option<[f32; 2]>,
    /// Step between two codes of the converter, above 0, in the unit of the samples [default: found in the first samples].
    ///
    /// It is found where the first samples are all multiples of one step; integers are looked through too, as they may come from a
    /// converter of fewer bits. A file may begin with up to 250 000 pairs of silence. In a pipe it is found only for text with a time
    /// column; integers in a pipe have the step of all their bits.
    #[arg(long, value_name = "STEP", value_parser = ranges::positive, help_heading = "Calibration")]
    pub resolution: Option<f32>,
}

/// Which methods a row shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Methods {
    /// The exact solution alone.
    Exact,
    /// The paper's four methods beside it, ranked, with a warning where they disagree beyond noise.
    All,
}

/// Formulas for the period.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Detector {
    /// Formula (10), the squared difference: finds a period sooner, and in more noise.
    Difference,
    /// Formula (9), the return of the running sum: for little noise, and where a second tone hides the period.
    MeanReturn,
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
            rails: self.full_scale.or(full_scale.map(|full| [-full, full])),
            resolution: self.resolution.or(resolution),
            frequency: self.frequency,
            detection: match self.detector {
                Detector::Difference => Detection::Difference,
                Detector::MeanReturn => Detection::MeanReturn,
            },
            hum: self.hum,
            coloured: self.coloured,
            calibration: self.corrected.calibration(),
            ..plain
        }
    }
}

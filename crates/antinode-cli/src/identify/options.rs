//! The command line of `antinode identify`.

use std::path::{Path, PathBuf};

use antinode::{Detection, Settings};
use clap::{Args, ValueEnum, value_parser};

use super::format::FormatParser;
use crate::failure::Failure;
use crate::options::{Corrected, Format};
use crate::ranges;
use crate::recording::{Columns, Kind};
use crate::result_file::{check_residual, file_of, format_of};

/// Periods in a window, at most; the ring of blocks holds two more.
pub const MAX_PERIODS: u16 = 1022;

/// Channels of raw samples, at most: more than any recorder interleaves.
const MAX_CHANNELS: u8 = 64;

/// `antinode identify`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Identify {
    /// Recordings: WAV (left S_C, right S_D), CSV, NPY, told apart by their content; `-` is standard input.
    ///
    /// Integers are scaled so that full scale is 1; mid-scale of unsigned ones is 0. Codes from 0 to 4095 in 16 bits are then a wave about
    /// an offset, which does no harm, unless the wave is smaller than 70 codes and so may not be found: store such codes as signed integers.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Sample rate, Hz, 0.001 to 1e12 [default: the recording's own].
    #[arg(long, value_name = "HZ", value_parser = ranges::rate, help_heading = "Recording")]
    pub rate: Option<f64>,
    /// Identify only samples from this time on, s, on the scale of `time_s`: the recording's time column, or else the time since the first
    /// sample.
    #[arg(long, value_name = "S", value_parser = ranges::time, help_heading = "Recording")]
    pub from: Option<f64>,
    /// Identify only samples before this time, s, on the same scale.
    #[arg(long, value_name = "S", value_parser = ranges::time, help_heading = "Recording")]
    pub to: Option<f64>,
    /// Sample format of recordings without a header: little-endian and interleaved, S_C and S_D alone or among --channels.
    /// WAV and NPY are still read as such, and so are lines of numbers in a file named .csv, .tsv, .txt or .lvm.
    #[arg(long, value_enum, value_name = "FORMAT", help_heading = "Recording")]
    pub raw: Option<Kind>,
    /// How many channels raw samples have, 2 to 64; if more than two, --columns picks S_C and S_D [default: 2].
    #[arg(long, value_name = "N", value_parser = value_parser!(u8).range(2..=i64::from(MAX_CHANNELS)), help_heading = "Recording")]
    pub channels: Option<u8>,
    /// Where S_C and S_D are: columns of text by name or number from 1, as C,D or TIME,C,D; channels of WAV, NPY and raw samples by number,
    /// as C,D [default: by the names of columns, or all where there are two or three].
    ///
    /// If only two columns of text are named, the file's own time is ignored, and --rate gives the rate. With --columns, anything but WAV
    /// and NPY is read as text, unless --raw is given. Lines that begin with #, % or // are comments, and settings above the samples are
    /// skipped; a line of units may follow the header. A time in ms, us or ns is understood, and so is that of a clock,
    /// 2026-11-28T13:45:01.5, 28.11.2026 1:45:01.5 PM or 13:45:01.5, which counts from 1970 or, without a date, from midnight.
    #[arg(long, value_name = "COLUMNS", help_heading = "Recording")]
    pub columns: Option<Columns>,
    /// The converter's rails, at which samples are flagged `clipped`: ±LEVEL, or LOW,HIGH, such as 0,4095 [default: known for integers,
    /// none for others].
    ///
    /// They are in the unit of the samples; integers of WAV, NPY and raw samples are scaled so that full scale is 1.
    #[arg(long, value_name = "LEVEL|LOW,HIGH", value_parser = ranges::rails, allow_hyphen_values = true, help_heading = "Recording")]
    pub full_scale: Option<[f32; 2]>,
    /// The converter's step from code to code, above 0, in the unit of the samples [default: found in the first samples].
    ///
    /// Deviations are right only with it if noise is less than half a step. It is found if the first samples are all multiples of one step,
    /// even in integers, which may come from a converter with fewer bits; a file may begin with up to 250 000 pairs of silence. From a pipe
    /// it is found only in text with a time column; integers from a pipe are taken to use all their bits. A warning says if all integers of
    /// a recording turn out to be multiples of a coarser step.
    #[arg(long, value_name = "STEP", value_parser = ranges::positive, help_heading = "Recording")]
    pub resolution: Option<f32>,
    /// Periods per window, 2 to 1022.
    #[arg(long, default_value_t = 10, value_name = "N", value_parser = |text: &str| ranges::whole(text, 2, MAX_PERIODS), help_heading = "Windows")]
    pub periods: u16,
    /// Blocks from the start of one window to the start of the next [default: a window begins where the last one ends].
    ///
    /// With --hop a block is a period, or a tenth of the window if that has fewer than ten periods. Fewer blocks than a window has make
    /// windows overlap, more leave gaps between them.
    #[arg(long, value_name = "BLOCKS", value_parser = |text: &str| ranges::whole(text, 1, u16::MAX), help_heading = "Windows")]
    pub hop: Option<u16>,
    /// The wave's frequency, Hz, if it is known within 5 %: it is then not searched for, and the first window begins with the first
    /// sample.
    ///
    /// Use it if noise or tones hide the period from the search, for recordings of a few periods, and for 2.5 to 1024 samples a period; the
    /// search needs 4 to 200.
    #[arg(long, value_name = "HZ", value_parser = ranges::positive, conflicts_with = "detector", help_heading = "Windows")]
    pub frequency: Option<f32>,
    /// How the period is searched for. If one detector finds none, because a second tone may hide it, try the other.
    #[arg(long, value_enum, default_value_t = Detector::Difference, help_heading = "Windows")]
    pub detector: Detector,
    /// The pattern angle at the start, rad, known to π/4, because samples give it only modulo π/2; within ±10000 [default: π/4, so that the
    /// first window's angle lies in 0…π/2].
    #[arg(long, value_name = "RAD", value_parser = |text: &str| ranges::within(text, -1e4, 1e4, " rad").map(|angle| angle as f32), help_heading = "Windows")]
    pub start_angle: Option<f32>,
    /// Remove mains hum or a wandering offset, which otherwise counts as noise or is flagged `misfit`.
    ///
    /// Each block, of a period or two, gets an offset of its own. Windows must have 5 periods or more, or 10 where --hop is given.
    #[arg(long, help_heading = "Noise")]
    pub hum: bool,
    /// Allow for noise that is not white, such as behind a tuned front end or a filter that cuts off below three times the frequency.
    ///
    /// Less noise at three times the frequency is then not taken for a fault. In windows of 5 periods or more (10 with --hop) noise at low
    /// frequencies is removed, as with --hum. A second tone that is always present counts as noise.
    #[arg(long, help_heading = "Noise")]
    pub coloured: bool,
    #[command(flatten)]
    pub corrected: Corrected,
    /// How rows are printed [default: as the name of --out ends, or else a table].
    #[arg(long, visible_alias = "format", value_parser = FormatParser, value_name = "FORMAT", help_heading = "Output")]
    pub output: Option<Format>,
    /// Write rows to this file instead of standard output, `-`: CSV if it ends in .csv, JSON lines if in .jsonl, unless --output says
    /// otherwise.
    #[arg(short = 'o', long, value_name = "FILE", help_heading = "Output")]
    pub out: Option<PathBuf>,
    /// Write what the waves leave of the samples to this .wav, .npy or .csv file.
    ///
    /// That is each window's samples less its wave, and less the offsets of the first, in the unit of the rows. The file has a pair for each
    /// pair identified or lost: 0 outside windows, and where the wave is lost. Of windows that overlap, the first that has a pair counts.
    /// It shows what makes rows `misfit`, and whether `residual_rms` is noise. Only for one recording at a time.
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub residual: Option<PathBuf>,
    /// Which methods' results to show.
    ///
    /// With `all`, columns method1_… to method4_… follow in CSV and JSON lines; those that end in off_sigma are differences from the
    /// exact solution in its standard deviations. They are empty in windows without a wave, or with less than a quarter of a period of
    /// samples before them. It takes some 16 times as long.
    #[arg(long, value_enum, default_value_t = Shown::Exact, help_heading = "Output")]
    pub methods: Shown,
}

/// Which methods a row shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Shown {
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
    /// The file that rows are written to; `None` for standard output.
    pub fn file(&self) -> Option<&Path> {
        file_of(self.out.as_deref())
    }

    /// Rejects `--channels` without `--raw`, as nothing else is read by it.
    pub fn check_channels(&self) -> Result<(), Failure> {
        if self.channels.is_some() && self.raw.is_none() {
            return Err(Failure::Usage(
                "--channels is only for raw samples, with --raw FORMAT; choose the channels of WAV, NPY and text by --columns".to_owned(),
            ));
        }
        Ok(())
    }

    /// Rejects `--residual` for several recordings, which would each need a file, and for the file of the rows.
    pub fn check_residual(&self) -> Result<(), Failure> {
        let Some(residual) = &self.residual else {
            return Ok(());
        };
        if self.files.len() > 1 {
            return Err(Failure::Usage(
                "--residual is for one recording; identify each by itself".to_owned(),
            ));
        }
        check_residual(residual, self.file())
    }

    /// The format of the rows: `--output`, or else what the ending of `--out` names, or else a table.
    pub fn format(&self) -> Result<Format, Failure> {
        self.output
            .map_or_else(|| format_of(self.out.as_deref()), Ok)
    }

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

//! The command line of `antinode simulate`.

use std::any::TypeId;
use std::f64::consts::FRAC_PI_6;
use std::path::PathBuf;

use antinode_sim::{ClipSpan, Dropout, Flaws, Loss, Wave};
use clap::{Arg, Args};

use super::fields;
use crate::failure::Failure;
use crate::ranges;
use crate::recording::SampleFormat;

/// Sample pairs of a recording, at most: no disk holds more.
const MAX_PAIRS: f64 = 1e12;

/// `antinode simulate`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, mut_args = with_number_parser)]
pub struct Simulate {
    /// The recording to write: .wav, .csv or .npy. The true values go beside it, with .json appended to the name.
    #[arg(short = 'o', long, value_name = "FILE")]
    pub out: PathBuf,
    /// Length, s.
    #[arg(long, default_value_t = 1.0, value_name = "S")]
    pub seconds: f64,
    /// Sample rate, Hz.
    #[arg(long, default_value_t = 100_000.0, value_name = "HZ")]
    pub rate: f64,
    /// Seed of all noise.
    #[arg(long, default_value_t = 1, value_name = "SEED", value_parser = ranges::seed)]
    pub seed: u64,
    /// How samples are stored.
    #[arg(long, value_enum, default_value_t = SampleFormat::I16, value_name = "FORMAT")]
    pub sample: SampleFormat,

    #[command(flatten)]
    wave: WaveOptions,
    #[command(flatten)]
    flaws: FlawOptions,
}

/// The wave at the first sample, and its rates.
#[derive(Debug, Args)]
#[command(next_help_heading = "Wave")]
struct WaveOptions {
    /// Main amplitude at the start. Integer samples saturate at 1.
    #[arg(long, default_value_t = 0.5, value_name = "LEVEL")]
    main_amplitude: f64,
    /// Quadrature amplitude at the start, signed.
    #[arg(long, default_value_t = 0.025, value_name = "LEVEL")]
    quadrature_amplitude: f64,
    /// Pattern angle at the start, rad [default: π/6].
    #[arg(long, default_value_t = FRAC_PI_6, hide_default_value = true, value_name = "RAD")]
    angle: f64,
    /// Phase at the start, rad [default: π/6].
    #[arg(long, default_value_t = FRAC_PI_6, hide_default_value = true, value_name = "RAD")]
    phase: f64,
    /// Frequency at the start, Hz, below half of the rate.
    #[arg(long, default_value_t = 5332.0, value_name = "HZ")]
    frequency: f64,
    /// Drift of the frequency, Hz/s.
    #[arg(long, default_value_t = 0.0, value_name = "HZ/S")]
    frequency_rate: f64,
    /// Precession by rotation, rad/s.
    ///
    /// Without a split the pattern turns and decays exactly as the rates say. On a resonator, rotation and damping also act together within
    /// a period: a split of any size, such as --frequency-split 1e-9, adds that.
    #[arg(long, default_value_t = 0.0, value_name = "RAD/S")]
    angle_rate: f64,
    /// Decay of the amplitudes, 1/s; with a split, the mean of both modes.
    #[arg(long, default_value_t = 0.0, value_name = "1/S")]
    decay_rate: f64,
    /// Difference between the decay rates of the two modes, 1/s.
    #[arg(long, default_value_t = 0.0, value_name = "1/S")]
    damping_split: f64,
    /// Pattern angle at which damping is greatest, rad.
    #[arg(long, default_value_t = 0.0, value_name = "RAD")]
    damping_angle: f64,
    /// Difference between the frequencies of the two modes, Hz; --frequency is their mean.
    #[arg(long, default_value_t = 0.0, value_name = "HZ")]
    frequency_split: f64,
    /// Pattern angle at which the frequency is highest, rad.
    #[arg(long, default_value_t = 0.0, value_name = "RAD")]
    frequency_angle: f64,
}

/// The flaws between the wave and the file.
#[derive(Debug, Args)]
#[command(next_help_heading = "Flaws")]
struct FlawOptions {
    /// White noise, rms per sample and channel, in the units of the amplitudes.
    #[arg(long, default_value_t = 0.0, value_name = "RMS")]
    noise: f64,
    /// Additional noise behind a first-order low-pass, rms per sample and channel, in the units of the amplitudes.
    #[arg(long, default_value_t = 0.0, value_name = "RMS")]
    coloured_noise: f64,
    /// Corner of the low-pass of --coloured-noise, Hz: below it the noise is white, above it its power falls as 1/f². Some Hz imitate an
    /// offset that wanders, some kHz a front end.
    #[arg(long, default_value_t = 1000.0, value_name = "HZ")]
    coloured_corner: f64,
    /// Offset of S_C, in the units of the amplitudes.
    #[arg(long, default_value_t = 0.0, value_name = "LEVEL")]
    offset_c: f64,
    /// Offset of S_D, in the units of the amplitudes.
    #[arg(long, default_value_t = 0.0, value_name = "LEVEL")]
    offset_d: f64,
    /// Amplitude of the mains hum on both pick-offs, in the units of the amplitudes.
    #[arg(long, default_value_t = 0.0, value_name = "LEVEL")]
    hum: f64,
    /// Frequency of the hum, Hz.
    #[arg(long, default_value_t = 50.0, value_name = "HZ")]
    hum_frequency: f64,
    /// Gain of pick-off D over that of C.
    #[arg(long, default_value_t = 1.0, value_name = "RATIO")]
    gain_ratio: f64,
    /// How much later pick-off D is sampled than C, ns.
    #[arg(long, default_value_t = 0.0, value_name = "NS")]
    skew_ns: f64,
    /// Pick-off D stands at 45° plus this angle from C, rad.
    #[arg(long, default_value_t = 0.0, value_name = "RAD")]
    pick_off_angle: f64,
    /// Cubic nonlinearity: S becomes S + C·S³/a², a the main amplitude at the start.
    #[arg(long, default_value_t = 0.0, value_name = "C")]
    cubic: f64,
    /// Level at which |S| is clipped.
    #[arg(long, value_name = "LEVEL")]
    clip: Option<f64>,
    /// Level at which |S| is clipped between two times, s; may be repeated.
    #[arg(long, value_name = "FROM:TO:LEVEL", value_parser = fields::clip_span)]
    clip_span: Vec<ClipSpan>,
    /// Bits of the converter, 2 to 32 [default: no converter; only the file's own steps].
    #[arg(long, value_name = "BITS")]
    bits: Option<u32>,
    /// Full scale of the converter set by --bits.
    #[arg(long, default_value_t = 1.0, value_name = "LEVEL", requires = "bits")]
    full_scale: f64,
    /// Jitter of the sampling instants, rms, ns.
    #[arg(long, default_value_t = 0.0, value_name = "NS")]
    jitter_ns: f64,
    /// Lost sample pairs: COUNT of them from INDEX on, which counts from 0; may be repeated.
    #[arg(long, value_name = "INDEX:COUNT", value_parser = fields::loss)]
    lost: Vec<Loss>,
    /// A dropout between two times, s; may be repeated.
    ///
    /// KIND is zero, hold (the last sample) or noise (no wave); CHANNEL is c or d, or both if not given.
    #[arg(long, value_name = "FROM:TO:KIND[:CHANNEL]", value_parser = fields::dropout)]
    dropout: Vec<Dropout>,
}

/// Gives an option that is a number a parser with a readable message; clap's own prints that of Rust's parser.
fn with_number_parser(option: Arg) -> Arg {
    if option.get_value_parser().type_id() == TypeId::of::<f64>() {
        option.value_parser(ranges::number)
    } else {
        option
    }
}

impl Simulate {
    /// The wave at the first sample.
    pub fn wave(&self) -> Wave {
        Wave {
            main_amplitude: self.wave.main_amplitude,
            quadrature_amplitude: self.wave.quadrature_amplitude,
            angle: self.wave.angle,
            phase: self.wave.phase,
            frequency: self.wave.frequency,
            frequency_rate: self.wave.frequency_rate,
            angle_rate: self.wave.angle_rate,
            decay_rate: self.wave.decay_rate,
            damping_split: self.wave.damping_split,
            damping_angle: self.wave.damping_angle,
            frequency_split: self.wave.frequency_split,
            frequency_angle: self.wave.frequency_angle,
        }
    }

    /// Sample pairs of the recording; rejects 0, and more than a disk holds.
    pub fn pairs(&self) -> Result<u64, Failure> {
        let pairs = (self.seconds * self.rate).round();
        if (1.0..=MAX_PAIRS).contains(&pairs) {
            return Ok(pairs as u64);
        }
        Err(Failure::Usage(format!(
            "--seconds: {} s at {} Hz; a recording must have 1 to {MAX_PAIRS:e} sample pairs",
            self.seconds, self.rate
        )))
    }

    /// Rejects a frequency whose samples would be those of another one, and one that drifts to zero.
    pub fn check_frequency(&self) -> Result<(), Failure> {
        let (first, half) = (self.wave.frequency, 0.5 * self.rate);
        let last = first + self.wave.frequency_rate * self.seconds;
        let [lowest, highest] = [first.min(last), first.max(last)];
        if lowest <= 0.0 {
            return Err(Failure::Usage(format!(
                "--frequency-rate: {first} Hz drifts to {last} Hz, but must stay above 0; give a smaller rate, or fewer --seconds"
            )));
        }
        if highest < half {
            return Ok(());
        }
        let drift = if first == last {
            String::new()
        } else {
            format!(" drifts to {last} Hz, but")
        };
        Err(Failure::Usage(format!(
            "--frequency: {first} Hz{drift} must stay below half of --rate, {half} Hz: its samples would be those of another \
             frequency; lower it, or raise --rate"
        )))
    }

    /// Rejects a flaw that would begin only after the last sample.
    pub fn check_places(&self, pairs: u64) -> Result<(), Failure> {
        let flaws = self.flaws();
        // Lost samples take their time too.
        let end = |index: u64| {
            let before = flaws.lost.iter().filter(|loss| loss.at < index);
            (pairs + before.map(|loss| loss.count).sum::<u64>()) as f64 / self.rate
        };
        let last = end(u64::MAX);
        let clips = flaws
            .clip_spans
            .iter()
            .map(|span| ("--clip-span", span.from, last));
        let dropouts = flaws
            .dropouts
            .iter()
            .map(|span| ("--dropout", span.from, last));
        let losses = flaws
            .lost
            .iter()
            .map(|loss| ("--lost", loss.at as f64 / self.rate, end(loss.at)));
        let mut places = clips.chain(dropouts).chain(losses);
        match places.find(|&(_, from, end)| from >= end) {
            Some((option, from, end)) => Err(Failure::Usage(format!(
                "{option}: it begins at {from} s, but the recording ends at {end} s; give more --seconds"
            ))),
            None => Ok(()),
        }
    }

    /// The flaws between the wave and the file.
    pub fn flaws(&self) -> Flaws {
        Flaws {
            noise: self.flaws.noise,
            coloured_noise: self.flaws.coloured_noise,
            coloured_corner: self.flaws.coloured_corner,
            offset_c: self.flaws.offset_c,
            offset_d: self.flaws.offset_d,
            hum: self.flaws.hum,
            hum_frequency: self.flaws.hum_frequency,
            gain_ratio: self.flaws.gain_ratio,
            skew: self.flaws.skew_ns * 1e-9,
            pick_off_angle: self.flaws.pick_off_angle,
            cubic: self.flaws.cubic,
            clip: self.flaws.clip,
            clip_spans: self.flaws.clip_span.clone(),
            bits: self.flaws.bits,
            full_scale: self.flaws.full_scale,
            jitter: self.flaws.jitter_ns * 1e-9,
            lost: self.flaws.lost.clone(),
            dropouts: self.flaws.dropout.clone(),
        }
    }
}

//! `antinode simulate`: a recording of a synthetic gyro, and the truth beside it.

use std::fs;
use std::path::PathBuf;
use std::str::FromStr;

use antinode_sim::{Channel, ClipSpan, Dropout, DropoutKind, Flaws, Gyro, Loss, Wave};
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::failure::Failure;
use crate::recording::{RecordingWriter, WavSample};

/// `antinode simulate`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Simulate {
    /// The recording to write: .wav, .csv or .npy. The truth goes beside it, under the same name with .json.
    #[arg(short = 'o', long = "to", value_name = "FILE")]
    to: PathBuf,
    /// Length, s.
    #[arg(long, default_value_t = 1.0, value_name = "S")]
    seconds: f64,
    /// Sample rate, Hz.
    #[arg(long, default_value_t = 100_000.0, value_name = "HZ")]
    rate: f64,
    /// Seed of all noise.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How samples are stored.
    #[arg(long, value_enum, default_value_t = Sample::I16)]
    sample: Sample,

    /// Main amplitude; full scale of integer samples is 1.
    #[arg(long, default_value_t = 0.5, help_heading = "Wave")]
    main_amplitude: f64,
    /// Quadrature amplitude, signed.
    #[arg(long, default_value_t = 0.025, help_heading = "Wave")]
    quadrature_amplitude: f64,
    /// Pattern angle at the start, rad.
    #[arg(long, default_value_t = std::f64::consts::FRAC_PI_6, help_heading = "Wave", value_name = "RAD")]
    angle: f64,
    /// Phase at the start, rad.
    #[arg(long, default_value_t = std::f64::consts::FRAC_PI_6, help_heading = "Wave", value_name = "RAD")]
    phase: f64,
    /// Frequency at the start, Hz.
    #[arg(long, default_value_t = 5332.0, help_heading = "Wave", value_name = "HZ")]
    frequency: f64,
    /// Drift of the frequency, Hz/s.
    #[arg(long, default_value_t = 0.0, help_heading = "Wave")]
    frequency_rate: f64,
    /// Precession, rad/s.
    #[arg(long, default_value_t = 0.0, help_heading = "Wave")]
    angle_rate: f64,
    /// Decay of the amplitudes, 1/s.
    #[arg(long, default_value_t = 0.0, help_heading = "Wave")]
    decay_rate: f64,

    /// White noise, rms a sample and channel.
    #[arg(long, default_value_t = 0.0, help_heading = "Flaws", value_name = "RMS")]
    noise: f64,
    /// Offset of S_C.
    #[arg(long, default_value_t = 0.0, help_heading = "Flaws")]
    offset_c: f64,
    /// Offset of S_D.
    #[arg(long, default_value_t = 0.0, help_heading = "Flaws")]
    offset_d: f64,
    /// Gain of pick-off D over that of C.
    #[arg(long, default_value_t = 1.0, help_heading = "Flaws")]
    gain_ratio: f64,
    /// How much later than C pick-off D is sampled, ns.
    #[arg(long, default_value_t = 0.0, help_heading = "Flaws")]
    skew_ns: f64,
    /// Pick-off D stands at 45° plus this angle from C, rad.
    #[arg(long, default_value_t = 0.0, help_heading = "Flaws", value_name = "RAD")]
    pick_off_angle: f64,
    /// Cubic nonlinearity: S + c·S³/a².
    #[arg(long, default_value_t = 0.0, help_heading = "Flaws", value_name = "C")]
    cubic: f64,
    /// Limit of |S|.
    #[arg(long, help_heading = "Flaws", value_name = "LEVEL")]
    clip: Option<f64>,
    /// Limit of |S| between two times, s; may be given again.
    #[arg(long, help_heading = "Flaws", value_name = "FROM:TO:LEVEL")]
    clip_span: Vec<Parsed<ClipSpan>>,
    /// Bits of the converter.
    #[arg(long, help_heading = "Flaws")]
    bits: Option<u32>,
    /// Full scale of the converter.
    #[arg(long, default_value_t = 1.0, help_heading = "Flaws", value_name = "LEVEL")]
    full_scale: f64,
    /// Jitter of the sampling instants, rms, ns.
    #[arg(long, default_value_t = 0.0, help_heading = "Flaws")]
    jitter_ns: f64,
    /// Sample pairs lost from an index on; may be given again.
    #[arg(long, help_heading = "Flaws", value_name = "INDEX:COUNT")]
    lost: Vec<Parsed<Loss>>,
    /// A dropout between two times, s, of both channels or of c or d: zero, hold or noise; may be given again.
    #[arg(long, help_heading = "Flaws", value_name = "FROM:TO:KIND[:CHANNEL]")]
    dropout: Vec<Parsed<Dropout>>,
}

/// How samples are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Sample {
    /// 16-bit integers in WAV; 32-bit floating point elsewhere.
    I16,
    /// 24-bit integers in WAV; 32-bit floating point elsewhere.
    I24,
    /// 32-bit integers in WAV; 32-bit floating point elsewhere.
    I32,
    /// 32-bit floating point.
    F32,
    /// 64-bit floating point; not in WAV.
    F64,
}

impl From<Sample> for WavSample {
    fn from(sample: Sample) -> Self {
        match sample {
            Sample::I16 => Self::I16,
            Sample::I24 => Self::I24,
            Sample::I32 => Self::I32,
            Sample::F32 => Self::F32,
            Sample::F64 => Self::F64,
        }
    }
}

/// What was written, as JSON.
#[derive(Debug, Serialize)]
struct Truth<'a> {
    sample_rate_hz: f64,
    sample_pairs: u64,
    seed: u64,
    /// At the first sample, with its rates.
    wave: &'a Wave,
    flaws: &'a Flaws,
}

impl Simulate {
    fn wave(&self) -> Wave {
        Wave {
            main_amplitude: self.main_amplitude,
            quadrature_amplitude: self.quadrature_amplitude,
            angle: self.angle,
            phase: self.phase,
            frequency: self.frequency,
            frequency_rate: self.frequency_rate,
            angle_rate: self.angle_rate,
            decay_rate: self.decay_rate,
        }
    }

    fn flaws(&self) -> Flaws {
        Flaws {
            noise: self.noise,
            offset_c: self.offset_c,
            offset_d: self.offset_d,
            gain_ratio: self.gain_ratio,
            skew: self.skew_ns * 1e-9,
            pick_off_error: self.pick_off_angle,
            cubic: self.cubic,
            clip: self.clip,
            clip_spans: self.clip_span.iter().map(|span| span.0).collect(),
            bits: self.bits,
            full_scale: self.full_scale,
            jitter: self.jitter_ns * 1e-9,
            lost: self.lost.iter().map(|loss| loss.0).collect(),
            dropouts: self.dropout.iter().map(|dropout| dropout.0).collect(),
        }
    }
}

/// Writes the recording and its truth.
pub fn run(options: &Simulate) -> Result<(), Failure> {
    let (wave, flaws) = (options.wave(), options.flaws());
    let usage = |error: antinode_sim::Error| Failure::Usage(error.to_string());
    let gyro = Gyro::new(wave, flaws.clone(), options.rate, options.seed).map_err(usage)?;
    let pairs = options.seconds * options.rate;
    if !(1.0..1e12).contains(&pairs) {
        return Err(Failure::Usage(format!("{} s at {} Hz is no length of a recording", options.seconds, options.rate)));
    }
    let pairs = pairs.round() as u64;
    let mut writer = RecordingWriter::create(&options.to, options.rate, options.sample.into())?;
    let mut beyond = 0u64;
    for pair in gyro.take(pairs as usize) {
        beyond += u64::from(pair.c.abs() > 1.0 || pair.d.abs() > 1.0);
        writer.write([pair.c, pair.d])?;
    }
    writer.finish()?;
    let beside = options.to.with_extension("json");
    let truth = Truth { sample_rate_hz: options.rate, sample_pairs: pairs, seed: options.seed, wave: &wave, flaws: &flaws };
    let text = serde_json::to_string_pretty(&truth).map_err(std::io::Error::from)?;
    fs::write(&beside, text + "\n")
        .map_err(|error| Failure::Recording(format!("{}: cannot be written: {error}", beside.display())))?;
    let wav = options.to.extension().is_some_and(|e| e.eq_ignore_ascii_case("wav"));
    if wav && beyond > 0 && !matches!(options.sample, Sample::F32 | Sample::F64) {
        eprintln!("warning: {beyond} of {pairs} sample pairs lay beyond the file's full scale of 1 and were limited to it");
    }
    Ok(())
}

/// A value written as fields between colons.
#[derive(Debug, Clone, Copy)]
struct Parsed<T>(T);

/// The fields of a value, at least as many as named.
fn fields<'a>(text: &'a str, form: &str, least: usize, most: usize) -> Result<Vec<&'a str>, String> {
    let fields: Vec<&str> = text.split(':').collect();
    if (least..=most).contains(&fields.len()) { Ok(fields) } else { Err(format!("it must be {form}")) }
}

fn number<T: FromStr>(text: &str) -> Result<T, String> {
    text.parse().map_err(|_| format!("“{text}” is not a number"))
}

impl FromStr for Parsed<ClipSpan> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let f = fields(text, "FROM:TO:LEVEL", 3, 3)?;
        Ok(Self(ClipSpan { from: number(f[0])?, to: number(f[1])?, level: number(f[2])? }))
    }
}

impl FromStr for Parsed<Loss> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let f = fields(text, "INDEX:COUNT", 2, 2)?;
        Ok(Self(Loss { at: number(f[0])?, count: number(f[1])? }))
    }
}

impl FromStr for Parsed<Dropout> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let f = fields(text, "FROM:TO:KIND or FROM:TO:KIND:CHANNEL", 3, 4)?;
        let kind = match f[2] {
            "zero" => DropoutKind::Zero,
            "hold" => DropoutKind::Hold,
            "noise" => DropoutKind::NoiseOnly,
            other => return Err(format!("“{other}” is no kind of dropout: zero, hold or noise")),
        };
        let channel = match f.get(3).copied() {
            None => None,
            Some("c" | "C") => Some(Channel::C),
            Some("d" | "D") => Some(Channel::D),
            Some(other) => return Err(format!("“{other}” is no channel: c or d")),
        };
        Ok(Self(Dropout { from: number(f[0])?, to: number(f[1])?, kind, channel }))
    }
}

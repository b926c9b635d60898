//! How the core's types are written: the core itself needs no serde.

use antinode::{Calibration, Detection, Estimate, Flags, Settings, SettingsError};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(remote = "Flags")]
pub struct FlagsBits {
    #[serde(getter = "bits")]
    bits: u16,
}

fn bits(flags: &Flags) -> u16 {
    flags.bits()
}

impl From<FlagsBits> for Flags {
    fn from(flags: FlagsBits) -> Self {
        Self::from_bits_truncate(flags.bits)
    }
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Estimate")]
pub struct EstimateFields {
    start: u64,
    samples: u32,
    time: f64,
    main_amplitude: f32,
    quadrature_amplitude: f32,
    angle: f64,
    phase: f32,
    frequency: f64,
    angle_rate: f32,
    decay_rate: f32,
    offsets: [f32; 2],
    main_amplitude_std: f32,
    quadrature_amplitude_std: f32,
    angle_std: f32,
    phase_std: f32,
    frequency_std: f32,
    angle_rate_std: f32,
    decay_rate_std: f32,
    residual_rms: f32,
    #[serde(with = "FlagsBits")]
    flags: Flags,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Calibration")]
pub struct CalibrationFields {
    gain_ratio: f32,
    skew: f32,
    pick_off_angle: f32,
}

/// Both detectors, whether or not the core was built with both.
#[derive(Serialize, Deserialize)]
enum DetectionNames {
    Difference,
    MeanReturn,
}

/// [`Detection`] by its name.
mod detection {
    use antinode::Detection;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::DetectionNames;

    pub fn serialize<S: Serializer>(detection: &Detection, to: S) -> Result<S::Ok, S::Error> {
        let name = if *detection == Detection::Difference {
            DetectionNames::Difference
        } else {
            DetectionNames::MeanReturn
        };
        name.serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Detection, D::Error> {
        match DetectionNames::deserialize(from)? {
            DetectionNames::Difference => Ok(Detection::Difference),
            #[cfg(feature = "mean-return")]
            DetectionNames::MeanReturn => Ok(Detection::MeanReturn),
            #[cfg(not(feature = "mean-return"))]
            DetectionNames::MeanReturn => {
                Err(serde::de::Error::custom("built without this detector"))
            }
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Settings")]
pub struct SettingsFields {
    sample_rate: f64,
    periods: u16,
    hop: Option<u16>,
    start_angle: f32,
    rails: Option<[f32; 2]>,
    resolution: Option<f32>,
    frequency: Option<f32>,
    #[serde(with = "detection")]
    detection: Detection,
    watch: bool,
    hum: bool,
    coloured: bool,
    #[serde(with = "CalibrationFields")]
    calibration: Calibration,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "SettingsError")]
#[non_exhaustive]
pub enum SettingsErrorNames {
    SampleRate(f64),
    PeriodsTooFew(u16),
    PeriodsTooMany { periods: u16, most: u16 },
    Hop,
    StartAngle(f32),
    Rails([f32; 2]),
    Resolution(f32),
    Frequency(f32),
    GainRatio(f32),
    Skew(f32),
    PickOffAngle(f32),
}

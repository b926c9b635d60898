//! Flags in `serde`: in readable formats their names, as [`Display`](core::fmt::Display) gives them, in others their bits. And defaults of
//! settings.

use core::fmt;

use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::calibration::Calibration;
use crate::estimate::Flags;
use crate::settings::Settings;

impl Serialize for Flags {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if serializer.is_human_readable() {
            serializer.collect_str(self)
        } else {
            serializer.serialize_u16(self.bits())
        }
    }
}

impl<'de> Deserialize<'de> for Flags {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            deserializer.deserialize_str(Names)
        } else {
            let bits = u16::deserialize(deserializer)?;
            let flags = Self::from_bits_truncate(bits);
            if flags.bits() != bits {
                return Err(D::Error::invalid_value(
                    Unexpected::Unsigned(bits.into()),
                    &"bits of flags",
                ));
            }
            Ok(flags)
        }
    }
}

/// Defaults of the fields that stored settings may lack, as [`Settings::new`] sets them.
const DEFAULTS: Settings = Settings::new(1.0);

pub(crate) fn periods() -> u16 {
    DEFAULTS.periods
}

pub(crate) fn start_angle() -> f32 {
    DEFAULTS.start_angle
}

pub(crate) fn watch() -> bool {
    DEFAULTS.watch
}

pub(crate) fn calibration() -> Calibration {
    DEFAULTS.calibration
}

/// Reads names joined by `+`.
struct Names;

impl Visitor<'_> for Names {
    type Value = Flags;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("names of flags joined by `+`")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Flags, E> {
        let mut names = text.split('+').filter(|name| !name.is_empty());
        names.try_fold(Flags::empty(), |flags, name| {
            let flag = Flags::from_name(name);
            flag.map(|flag| flags.with(flag))
                .ok_or_else(|| E::invalid_value(Unexpected::Str(name), &self))
        })
    }
}

#[cfg(test)]
mod tests {
    use std::format;

    use super::*;
    use crate::Estimate;

    #[test]
    fn flags_are_read_by_their_names() {
        for bits in 0..1 << 9 {
            let flags = Flags::from_bits_truncate(bits);
            let text = serde_json::to_string(&flags).unwrap();
            assert_eq!(text, format!("\"{flags}\""));
            assert_eq!(serde_json::from_str::<Flags>(&text).unwrap(), flags);
        }
        let fault = serde_json::from_str::<Flags>("\"clipped+spilt\"").unwrap_err();
        assert!(
            format!("{fault}")
                .starts_with("invalid value: string \"spilt\", expected names of flags")
        );
    }

    #[test]
    fn settings_and_estimates_come_back_as_they_were() {
        let settings = Settings {
            hop: Some(3),
            rails: Some([-1.0, 1.0]),
            ..Settings::new(1e5)
        };
        let text = serde_json::to_string(&settings).unwrap();
        assert_eq!(serde_json::from_str::<Settings>(&text).unwrap(), settings);
        let defaults: Settings = serde_json::from_str("{\"sample_rate\": 1e5}").unwrap();
        assert_eq!(defaults, Settings::new(1e5));
        for misspelt in ["\"hopp\": 5", "\"calibration\": {\"skw\": 1e-7}"] {
            let text = format!("{{\"sample_rate\": 1e5, {misspelt}}}");
            let fault = serde_json::from_str::<Settings>(&text).unwrap_err();
            assert!(fault.is_data(), "{fault}");
        }
        let skewed = "{\"sample_rate\": 1e5, \"calibration\": {\"skew\": 1e-7}}";
        let skewed: Settings = serde_json::from_str(skewed).unwrap();
        let calibration = Calibration {
            skew: 1e-7,
            ..Calibration::IDEAL
        };
        assert_eq!(
            skewed,
            Settings {
                calibration,
                ..defaults
            }
        );
        assert!(serde_json::from_str::<Settings>("{\"periods\": 5}").is_err());
        let mut identifier = crate::Identifier::<f32, 200, 16>::new(Settings {
            frequency: Some(5000.0),
            ..Settings::new(1e5)
        })
        .unwrap();
        let estimate = (0..1000).find_map(|k| {
            let phase = crate::phase::PhaseStep::from_period(20.0).after_half_samples(2 * k);
            identifier.push([phase.unit().re, phase.unit().im])
        });
        let text = serde_json::to_string(&estimate.unwrap()).unwrap();
        let back: Estimate = serde_json::from_str(&text).unwrap();
        assert_eq!(serde_json::to_string(&back).unwrap(), text);
        assert_eq!(back.flags, estimate.unwrap().flags);
    }
}

//! Parsers of options that are numbers: each checks the range, in the unit in which the option is given.

use std::ops::RangeInclusive;

use crate::failure::Failure;

/// Sample rates that the core takes, Hz.
pub const RATES: RangeInclusive<f64> = 1e-3..=1e12;

/// The number in `text`, if it lies within these limits; `unit`, if not empty, begins with a blank or a comma.
pub fn within(text: &str, min: f64, max: f64, unit: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if (min..=max).contains(&number) => Ok(number),
        _ => Err(format!("it must be {min} to {max}{unit}")),
    }
}

/// The whole number in `text`, if it lies within these limits; it may have an exponent, as `1e3`.
pub fn whole(text: &str, min: u16, max: u16) -> Result<u16, String> {
    let limits = f64::from(min)..=f64::from(max);
    match text.parse::<f64>() {
        Ok(number) if limits.contains(&number) && number.fract() == 0.0 => Ok(number as u16),
        _ => Err(format!("it must be a whole number from {min} to {max}")),
    }
}

/// Any number.
pub fn number(text: &str) -> Result<f64, String> {
    text.parse()
        .map_err(|_| "it must be a number, without its unit".to_owned())
}

/// The seed of noise.
pub fn seed(text: &str) -> Result<u64, String> {
    text.parse()
        .map_err(|_| "it must be a whole number from 0 on".to_owned())
}

/// A sample rate, Hz.
pub fn rate(text: &str) -> Result<f64, String> {
    within(
        text,
        *RATES.start(),
        *RATES.end(),
        " Hz, 100000 for 100 kS/s",
    )
}

/// An angle or a phase, rad.
pub fn angle(text: &str) -> Result<f64, String> {
    within(text, -10.0, 10.0, " rad")
}

/// A time in a recording, s.
pub fn time(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err("it must be a number of seconds".to_owned()),
    }
}

/// Rejects an end of a span that is not later than its beginning.
pub fn in_order(from: Option<f64>, to: Option<f64>) -> Result<(), Failure> {
    match (from, to) {
        (Some(from), Some(to)) if to <= from => Err(Failure::Usage(format!(
            "--to: {to} s must be later than --from, {from} s"
        ))),
        _ => Ok(()),
    }
}

/// A gain ratio.
pub fn gain_ratio(text: &str) -> Result<f32, String> {
    within(text, 0.1, 10.0, "").map(|ratio| ratio as f32)
}

/// A skew, ns.
pub fn skew_ns(text: &str) -> Result<f32, String> {
    within(text, -1e6, 1e6, " ns").map(|skew| skew as f32)
}

/// The difference of the pick-offs' angle from 45°, rad.
pub fn pick_off_angle(text: &str) -> Result<f32, String> {
    within(text, -0.3, 0.3, " rad").map(|angle| angle as f32)
}

/// A level or a step, in the input's unit.
pub fn positive(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(number) if number >= f32::MIN_POSITIVE && number.is_finite() => Ok(number),
        _ => Err("it must be a number above 0".to_owned()),
    }
}

/// The converter's rails, in the input's unit: ±LEVEL, or LOW,HIGH.
pub fn rails(text: &str) -> Result<[f32; 2], String> {
    let Some((low, high)) = text.split_once(',') else {
        let level = positive(text).map_err(|error| error + ", or two numbers as LOW,HIGH")?;
        return Ok([-level, level]);
    };
    match [low, high].map(|level| level.trim().parse::<f32>()) {
        [Ok(low), Ok(high)] if !(low.is_finite() && high.is_finite()) => {
            Err("LOW and HIGH must be finite".to_owned())
        }
        [Ok(low), Ok(high)] if low < high => Ok([low, high]),
        [Ok(_), Ok(_)] => Err("LOW must lie below HIGH".to_owned()),
        _ => Err("LOW and HIGH must be numbers, with one comma between them".to_owned()),
    }
}

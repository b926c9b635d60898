//! The sample rate that a comment, a title or a setting above the samples states: `; Samplerate: 100 kHz`, `Time interval :,10.00uS`.

use super::time::roundest;
use super::units::time_exponent;

/// Names of a sample rate, and of the time from one sample to the next, in lower case and letters only.
const RATES: [&str; 8] = [
    "samplerate",
    "samplingrate",
    "samplefrequency",
    "samplingfrequency",
    "samplefreq",
    "samplingfreq",
    "samplespersecond",
    "abtastrate",
];
const INTERVALS: [&str; 7] = [
    "sampleinterval",
    "samplinginterval",
    "sampleperiod",
    "samplingperiod",
    "timeinterval",
    "timeincrement",
    "tinc",
];

/// Units of a rate, and their powers of ten. None is in mHz.
const RATE_UNITS: [(&str, i32); 17] = [
    ("hz", 0),
    ("khz", 3),
    ("mhz", 6),
    ("ghz", 9),
    ("s/s", 0),
    ("ks/s", 3),
    ("ms/s", 6),
    ("gs/s", 9),
    ("sa/s", 0),
    ("ksa/s", 3),
    ("msa/s", 6),
    ("gsa/s", 9),
    ("sps", 0),
    ("ksps", 3),
    ("msps", 6),
    ("gsps", 9),
    ("", 0),
];
/// Rates that can be meant, Hz: slower ones may be in another unit.
const POSSIBLE: std::ops::RangeInclusive<f64> = 1.0..=1e12;
/// Relative difference of two statements of the same rate.
const SAME: f64 = 1e-6;

/// A stated sample rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stated {
    /// The rate, Hz.
    pub rate: f64,
    /// The line, from 1.
    pub line: usize,
}

impl Stated {
    /// The rate that these lines, the first of a text, state; none if they state several.
    pub fn above(text: &[u8]) -> Option<Self> {
        let text = String::from_utf8_lossy(text);
        let lines = (1..).zip(text.lines());
        let mut found = lines.flat_map(|(line, text)| {
            of_line(text)
                .into_iter()
                .map(move |rate| Self { rate, line })
        });
        let first = found.next()?;
        let is_same = |other: Self| (other.rate / first.rate - 1.0).abs() < SAME;
        found.all(is_same).then_some(first)
    }
}

/// The rates that a line states, Hz.
fn of_line(line: &str) -> Vec<f64> {
    let (mut rest, mut name, mut rates) = (line, String::new(), Vec::new());
    while let Some(letter) = rest.chars().next() {
        if let Some((number, behind)) = number(rest) {
            let unit = unit(behind);
            let rate = rate(&name, number, unit).filter(|rate| POSSIBLE.contains(rate));
            rates.extend(rate);
            name.clear();
            rest = behind.strip_prefix(unit).unwrap_or(behind);
        } else {
            name.extend(
                letter
                    .to_lowercase()
                    .filter(|letter| letter.is_alphabetic() || *letter == '/'),
            );
            rest = &rest[letter.len_utf8()..];
        }
    }
    rates
}

/// The number at the beginning of a text, and what follows it.
fn number(text: &str) -> Option<(f64, &str)> {
    let is_of_number = |letter: char| letter.is_ascii_digit() || "+-.eE".contains(letter);
    let end = text
        .find(|letter| !is_of_number(letter))
        .unwrap_or(text.len());
    let begins = text.starts_with(|letter: char| letter.is_ascii_digit() || "+-.".contains(letter));
    let mut ends = (1..=end).rev().filter(|_| begins);
    ends.find_map(|end| Some((text[..end].parse().ok()?, &text[end..])))
}

/// What stands behind a number up to the end of its field or sentence.
fn unit(behind: &str) -> &str {
    let end = behind.find([',', ';', '\t', '"', ')', ']', '.']);
    &behind[..end.unwrap_or(behind.len())]
}

/// The rate, Hz, that a number behind this name gives; none if the name is another or the unit is not known.
fn rate(name: &str, number: f64, unit: &str) -> Option<f64> {
    let told = |names: &[&str], power: &dyn Fn(&str) -> Option<i32>| {
        let behind = names
            .iter()
            .find_map(|known| Some(name.rsplit_once(known)?.1))?;
        let bare = unit.trim().to_lowercase();
        // The unit may stand behind the name, or behind the number.
        let unit = if bare.is_empty() { behind } else { &bare };
        let is_bare = behind.is_empty() || bare.is_empty() || behind == bare;
        let power = power(unit).filter(|_| is_bare)?;
        Some(number * 10f64.powi(power))
    };
    let of_rate = |unit: &str| {
        let found = RATE_UNITS.iter().find(|(known, _)| *known == unit);
        found.map(|(_, power)| *power)
    };
    let of_time = |unit: &str| match unit {
        "" => Some(0),
        unit => time_exponent(unit)?,
    };
    let interval = || told(&INTERVALS, &of_time).map(f64::recip);
    told(&RATES, &of_rate)
        .or_else(interval)
        .map(|rate| roundest(rate, 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_read_however_they_are_stated() {
        for line in [
            "; Samplerate: 100 kHz",
            "Sample Rate: 100000 Hz.  Sample values on linear scale.",
            "Time interval\t\t  :,10.00uS,10.00uS",
            "Sample Interval,1e-05,",
            "\"SampleRate\",1.000000E+05,1.000000E+05",
            "# sampling_frequency=1e5",
            "Sample rate [kHz],100",
            "Sampling Rate (Hz): 100000",
            "sampling period = 10 µs",
            "Sampling rate 0.1 MSa/s",
            "Sample rate: 0.0001 GS/s",
            "// Abtastrate 100 kHz",
            "CH1V,CH2V,t0 = -1e-3, tInc = 1e-5",
        ] {
            let [first, rest @ ..] = &of_line(line)[..] else {
                panic!("{line}");
            };
            assert!((first - 1e5).abs() < 1e-3, "{line}: {first}");
            assert!(rest.iter().all(|rate| rate == first), "{line}: {rest:?}");
        }
        for line in [
            "Samples: 100000",
            "Record Length,100000",
            "Sample rate: 5 days",
            "Sample rate: high",
            "samplerate=100000 channels=2",
            "Sample rate,0",
            "Sample Interval,-1e-05",
            "Sample rate (kHz): 100 Hz",
            "oversampling rate ratio 16",
            "0.1,0.2",
        ] {
            assert!(of_line(line).is_empty(), "{line}");
        }
    }

    #[test]
    fn contradictory_rates_are_not_used() {
        let stated = |text: &str| Stated::above(text.as_bytes());
        let found = Stated { rate: 1e5, line: 2 };
        assert_eq!(
            stated("Model,X\nSample rate,1e5\nSample interval,1e-5\n"),
            Some(found)
        );
        assert_eq!(stated("Sample rate,1e5\nSample interval,1e-6\n"), None);
        assert_eq!(stated(""), None);
    }
}

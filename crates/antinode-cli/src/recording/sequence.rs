//! Times of samples that are counted from a start in equal steps, both given by the header, `X,CH1,CH2,Start,Increment`, with or without
//! the column `X` that counts the lines, or `CH1V,CH2V,t0 = -1e-3, tInc = 1e-5`; or both given by settings.

use super::number::number;

/// The settings of LabVIEW and of Yokogawa: names of the start, of the step and of their quantity or unit, and its value for a time in s.
const SETTINGS: [[&str; 4]; 2] = [
    ["X0", "Delta_X", "X_Dimension", "Time"],
    ["HOffset", "HResolution", "HUnit", "s"],
];

/// The times of samples that are counted from a start in equal steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sequence {
    /// The time of the sample numbered 0, s.
    pub start: f64,
    /// From one sample to the next, s.
    pub step: f64,
    /// Whether the first column has the samples' numbers; otherwise their order counts.
    pub is_counted: bool,
}

/// The columns under a header whose last two names are those of a start and an increment, or give them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Counted {
    /// The number of columns before these two.
    pub columns: usize,
    /// Whether the first has the samples' numbers.
    pub has_numbers: bool,
    /// The times, if the names themselves give start and increment, and not the line below.
    pub sequence: Option<Sequence>,
}

/// Looks for a start and an increment, or their values, in the last two of these names; none without these.
pub(super) fn counted(names: &[String]) -> Option<Counted> {
    let names: Vec<String> = names.iter().map(|name| name.to_lowercase()).collect();
    match names.as_slice() {
        [first, samples @ .., start, increment] if start == "start" && increment == "increment" => {
            Some(Counted {
                columns: 1 + samples.len(),
                has_numbers: first == "x",
                sequence: None,
            })
        }
        [samples @ .., start, increment] => {
            let sequence = Sequence {
                start: named(start, "t0")?,
                step: named(increment, "tinc")?,
                is_counted: false,
            };
            sequence.is_good().then_some(Counted {
                columns: samples.len(),
                has_numbers: false,
                sequence: Some(sequence),
            })
        }
        _ => None,
    }
}

/// The value in s behind this label: `t0 =-1.0e-03` or `t0 = -0.001s`.
fn named(name: &str, label: &str) -> Option<f64> {
    let value = name.strip_prefix(label)?.trim_start().strip_prefix('=')?;
    let seconds = value.trim().trim_end_matches('s').trim_end();
    number(seconds.as_bytes(), b',')
}

impl Sequence {
    /// Reads start and step from the line of units below these names; none if the first column holds times.
    pub fn read(units: &[String], names: Counted, separator: u8) -> Option<Self> {
        let told = |place: usize| number::<f64>(units.get(place)?.as_bytes(), separator);
        let sequence = Self {
            start: told(names.columns)?,
            step: told(names.columns + 1)?,
            is_counted: names.has_numbers,
        };
        let is_sequence = !names.has_numbers || units.first()?.eq_ignore_ascii_case("sequence");
        (is_sequence && sequence.is_good()).then_some(sequence)
    }

    fn is_good(self) -> bool {
        self.start.is_finite() && self.step > 0.0 && self.step.is_finite()
    }

    /// Reads start and step of samples without a time column from settings, each the fields of a line.
    pub fn of_settings(settings: &[&[&[u8]]], separator: u8) -> Option<Self> {
        // A setting has one value for each channel, and all must be the same.
        let told = |label: &str| {
            let mut lines = settings.iter();
            let line = lines.find(|line| line.first() == Some(&label.as_bytes()))?;
            let mut values = line[1..].iter().filter(|value| !value.is_empty());
            let value = values.next()?;
            values.all(|other| other == value).then_some(*value)
        };
        if told("X_Columns").is_some_and(|columns| columns != b"No") {
            return None;
        }
        SETTINGS.iter().find_map(|[start, step, unit, seconds]| {
            let number = |label| number::<f64>(told(label)?, separator).filter(|x| x.is_finite());
            let is_time = told(unit)?.eq_ignore_ascii_case(seconds.as_bytes());
            let step = number(step).filter(|&step| step > 0.0)?;
            is_time.then_some(Self {
                start: number(start)?,
                step,
                is_counted: false,
            })
        })
    }

    /// The time of the sample of this number, s.
    pub fn seconds(self, number: f64) -> f64 {
        self.start + number * self.step
    }
}

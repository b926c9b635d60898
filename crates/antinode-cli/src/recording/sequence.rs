//! Recordings whose lines are counted, and whose header tells the time of the first and the step: `X,CH1,CH2,Start,Increment`.

use super::text::number;

/// The times of samples that are counted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sequence {
    /// The time of the sample numbered 0, s.
    pub start: f64,
    /// From one sample to the next, s.
    pub step: f64,
}

/// How many columns the lines have, where names of the start and the increment stand behind theirs.
pub(super) fn names_end(names: &[String]) -> Option<usize> {
    let names: Vec<String> = names.iter().map(|name| name.to_lowercase()).collect();
    match names.as_slice() {
        [x, samples @ .., start, increment]
            if x == "x" && start == "start" && increment == "increment" =>
        {
            Some(1 + samples.len())
        }
        _ => None,
    }
}

impl Sequence {
    /// What the line of units tells, whose names end at `end`; none where the first column holds times.
    pub fn read(units: &[String], end: usize, separator: u8) -> Option<Self> {
        let told = |place: usize| number::<f64>(units.get(place)?.as_bytes(), separator);
        let sequence = Self {
            start: told(end)?,
            step: told(end + 1)?,
        };
        let is_counted = units.first()?.eq_ignore_ascii_case("sequence");
        let is_good =
            sequence.start.is_finite() && sequence.step > 0.0 && sequence.step.is_finite();
        (is_counted && is_good).then_some(sequence)
    }

    /// The time of the sample of this number, s.
    pub fn seconds(self, number: f64) -> f64 {
        self.start + number * self.step
    }
}

//! Recordings whose header tells the time of the first sample and the step: `X,CH1,CH2,Start,Increment`, with or without the column `X` that
//! counts the lines.

use super::text::number;

/// The times of samples that are counted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sequence {
    /// The time of the sample numbered 0, s.
    pub start: f64,
    /// From one sample to the next, s.
    pub step: f64,
    /// Whether the first column has the samples' numbers, and not only their places.
    pub is_counted: bool,
}

/// The columns of lines whose header tells a start and an increment behind their names.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Counted {
    /// How many they are.
    pub columns: usize,
    /// Whether the first has the samples' numbers.
    pub has_numbers: bool,
}

/// What these names tell, where the last are those of the start and the increment.
pub(super) fn counted(names: &[String]) -> Option<Counted> {
    let names: Vec<String> = names.iter().map(|name| name.to_lowercase()).collect();
    match names.as_slice() {
        [first, samples @ .., start, increment] if start == "start" && increment == "increment" => {
            Some(Counted {
                columns: 1 + samples.len(),
                has_numbers: first == "x",
            })
        }
        _ => None,
    }
}

impl Sequence {
    /// What the line of units below these names tells; none where the first column holds times.
    pub fn read(units: &[String], names: Counted, separator: u8) -> Option<Self> {
        let told = |place: usize| number::<f64>(units.get(place)?.as_bytes(), separator);
        let sequence = Self {
            start: told(names.columns)?,
            step: told(names.columns + 1)?,
            is_counted: names.has_numbers,
        };
        let is_sequence = !names.has_numbers || units.first()?.eq_ignore_ascii_case("sequence");
        let is_good =
            sequence.start.is_finite() && sequence.step > 0.0 && sequence.step.is_finite();
        (is_sequence && is_good).then_some(sequence)
    }

    /// The time of the sample of this number, s.
    pub fn seconds(self, number: f64) -> f64 {
        self.start + number * self.step
    }
}

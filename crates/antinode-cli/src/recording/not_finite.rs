//! Samples that are not finite numbers: they are delivered as they are, and reported at the end.

use super::error::Place;
use super::sample::channel_at;

/// A fault that costs no more than a pair, or a line of text.
#[derive(Debug, Clone)]
pub(super) struct Flaw {
    /// The number of pairs before it.
    pub pair: u64,
    /// The place in text, if known.
    pub place: Option<Place>,
    /// A description of it.
    pub description: String,
}

/// The samples seen so far that are not finite numbers.
#[derive(Debug, Default)]
pub(super) struct NotFinite {
    pub first: Option<Flaw>,
    /// The number of samples, not of pairs.
    pub count: u64,
}

impl NotFinite {
    /// Looks through the next `pairs`, which begin at pair `before` of the recording.
    pub fn look(&mut self, before: u64, pairs: &[[f32; 2]]) {
        let values = pairs.as_flattened();
        // Counted without a branch: this form is compiled to vector instructions.
        let count: u32 = values
            .iter()
            .map(|value| u32::from(!value.is_finite()))
            .sum();
        if count == 0 {
            return;
        }
        self.count += u64::from(count);
        let index = values.iter().position(|value| !value.is_finite());
        if let (None, Some(index)) = (&self.first, index) {
            let (channel, value) = (channel_at(index), values[index]);
            self.first = Some(Flaw {
                pair: before + index as u64 / 2,
                place: None,
                description: format!("{channel}: the value is {value}, not a finite number"),
            });
        }
    }
}

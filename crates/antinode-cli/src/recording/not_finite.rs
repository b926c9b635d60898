//! Samples that are not finite numbers: they are delivered as they are, and reported at the end.

use super::error::{Channel, Place};
use super::sample::channel_at;

/// The first sample that is not a finite number.
#[derive(Debug, Clone, Copy)]
pub(super) struct First {
    pub pair: u64,
    pub channel: Channel,
    pub value: f32,
}

impl First {
    /// A description of it.
    pub fn describe(self) -> String {
        format!(
            "{}: the value is {}, not a finite number",
            self.channel, self.value
        )
    }
}

/// A fault of a line of text that costs no more than the line or its pair.
#[derive(Debug, Clone)]
pub(super) struct Written {
    /// The number of pairs before it.
    pub pair: u64,
    pub place: Place,
    /// A description of it.
    pub description: String,
}

/// The samples seen so far that are not finite numbers.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct NotFinite {
    pub first: Option<First>,
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
        if let (None, Some(index)) = (self.first, index) {
            self.first = Some(First {
                pair: before + index as u64 / 2,
                channel: channel_at(index),
                value: values[index],
            });
        }
    }
}

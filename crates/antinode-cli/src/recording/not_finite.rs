//! Samples that are not finite numbers: they are passed on, and told at the end.

use super::error::{Channel, Place};
use super::sample::channel_at;

/// The first of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct First {
    pub pair: u64,
    pub channel: Channel,
    pub value: f32,
}

impl First {
    /// What it is, in words.
    pub fn told(self) -> String {
        format!(
            "{}: the value is {}, not a finite number",
            self.channel, self.value
        )
    }
}

/// What is wrong with a line of text that costs no more than itself.
#[derive(Debug, Clone)]
pub(super) struct Written {
    /// The pairs before it.
    pub pair: u64,
    pub place: Place,
    /// What it is, in words.
    pub told: String,
}

/// What was seen of them so far.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct NotFinite {
    pub first: Option<First>,
    /// Samples, not pairs.
    pub count: u64,
}

impl NotFinite {
    /// Looks through the next `pairs`, before which the recording had so many.
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

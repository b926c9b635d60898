//! An axis, with its title and range, and the scale of its numbers.

use std::ops::Range;

use super::values::Values;

/// An axis: its title, and the range of its numbers, or of their decimal logarithms.
#[derive(Debug)]
pub struct Axis {
    pub title: String,
    pub range: Range<f64>,
    is_log: bool,
}

impl Axis {
    /// The axis to be drawn, with at most `max` numbers.
    pub fn values(&self, max: usize) -> Values {
        if self.is_log {
            Values::logarithmic(&self.range)
        } else {
            Values::linear(&self.range, max)
        }
    }
}

/// The conversion of values to an axis's numbers.
#[derive(Debug, Clone, Copy)]
pub enum Scale {
    /// Decimal logarithms.
    Logarithmic,
    /// Values less `less`, multiplied by `times`.
    Linear { less: f64, times: f64 },
}

impl Scale {
    /// The axis's number of a value.
    pub fn of(self, number: f64) -> f64 {
        match self {
            // Of 0 and negative values: minus infinity.
            Self::Logarithmic => number.max(0.0).log10(),
            Self::Linear { less, times } => (number - less) * times,
        }
    }

    /// The axis for values in this range.
    pub fn axis(self, title: String, range: &Range<f64>) -> Axis {
        Axis {
            title,
            range: self.of(range.start)..self.of(range.end),
            is_log: matches!(self, Self::Logarithmic),
        }
    }
}

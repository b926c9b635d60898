//! An axis: its title and its range, and what numbers become on it.

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
    /// What is drawn of it, with no more numbers than `most`.
    pub fn values(&self, most: usize) -> Values {
        if self.is_log {
            Values::logarithmic(&self.range)
        } else {
            Values::linear(&self.range, most)
        }
    }
}

/// What numbers become on an axis.
#[derive(Debug, Clone, Copy)]
pub struct Scale {
    less: f64,
    times: f64,
    is_log: bool,
}

impl Scale {
    /// Decimal logarithms.
    pub const LOG: Self = Self {
        less: 0.0,
        times: 1.0,
        is_log: true,
    };

    /// Numbers less this one, times that.
    pub fn linear(less: f64, times: f64) -> Self {
        Self {
            less,
            times,
            is_log: false,
        }
    }

    /// What a number becomes.
    pub fn of(self, number: f64) -> f64 {
        let scaled = (number - self.less) * self.times;
        match self.is_log {
            // 0 and less is as far below as can be.
            true => scaled.max(0.0).log10(),
            false => scaled,
        }
    }

    /// The axis of numbers of this range.
    pub fn axis(self, title: String, range: &Range<f64>) -> Axis {
        Axis {
            title,
            range: self.of(range.start)..self.of(range.end),
            is_log: self.is_log,
        }
    }
}

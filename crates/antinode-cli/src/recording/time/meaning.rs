//! What the time column may be, if not times.

use super::super::printed::Printed;
use super::{SAME_RATE, TimeAxis};

/// The meaning of a time column in view of the rate asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) enum Meaning {
    /// The samples' times.
    Time,
    /// Seconds, or the numbers of the lines.
    PerhapsIndex,
    /// The numbers of the lines.
    Index,
    /// Times of another rate than the one asked for; both in Hz.
    OtherRate { own: f64, asked: f64 },
}

impl Meaning {
    /// The meaning of times with their `own` rate if a rate is `asked` for, both in Hz.
    pub fn of_rate(own: f64, asked: Option<f64>) -> Self {
        match asked {
            Some(asked) if (asked / own - 1.0).abs() > SAME_RATE => Self::OtherRate { own, asked },
            _ => Self::Time,
        }
    }
}

impl TimeAxis {
    /// The meaning of the column if the rate `asked` is asked for, Hz.
    pub fn meaning(&self, printed: Printed, asked: Option<f64>) -> Meaning {
        let meaning = Meaning::of_rate(self.rate, asked);
        // An index goes up by one whole a line; so may seconds.
        let is_like_index = self.is_count(printed);
        match (asked, meaning) {
            (None, _) if is_like_index => Meaning::PerhapsIndex,
            (Some(_), Meaning::OtherRate { .. }) if is_like_index => Meaning::Index,
            _ => meaning,
        }
    }
}

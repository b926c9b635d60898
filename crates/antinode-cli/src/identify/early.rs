//! When to tell of a pipe what else is told at its end, which may never come.

use std::ops::RangeInclusive;

/// So long a beginning is no chance, s.
const LONG: f64 = 1.0;
/// Pairs that are few, and those that are enough however short they last.
const PAIRS: RangeInclusive<f64> = 64.0..=1e6;

/// Whether the time has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Early {
    /// From this pair on it is to be told.
    From(u64),
    /// It is told, if there was anything to tell.
    Passed,
    /// A file ends soon enough.
    Never,
}

impl Early {
    /// Of a pipe or a file of this sample rate.
    pub fn new(is_pipe: bool, rate: f64) -> Self {
        let pairs = (LONG * rate).clamp(*PAIRS.start(), *PAIRS.end());
        if is_pipe {
            Self::From(pairs as u64)
        } else {
            Self::Never
        }
    }

    /// True once, when so many pairs are there.
    pub fn is_due(&mut self, pairs: u64) -> bool {
        let is_due = matches!(self, Self::From(enough) if pairs >= *enough);
        if is_due {
            *self = Self::Passed;
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pipe_is_told_of_once() {
        for (rate, enough) in [(1.0, 64), (1e5, 100_000), (1e10, 1_000_000)] {
            let mut early = Early::new(true, rate);
            let due = [0, 63, enough - 1, enough, enough + 1, 2 * enough];
            let due = due.map(|pairs| early.is_due(pairs));
            assert_eq!(due, [false, false, false, true, false, false], "{rate}");
            assert_eq!(early, Early::Passed);
        }
        let mut early = Early::new(false, 1e5);
        assert!(!early.is_due(u64::MAX) && early == Early::Never);
    }
}

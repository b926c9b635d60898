//! Samples that a recording's own time shows to be missing: they are left out of the rows, and told at the end.

use std::collections::VecDeque;

use super::error::TimeFault;

/// Samples that are missing between two pairs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gap {
    /// The pairs of the recording before it.
    pub before: u64,
    /// The pairs that are missing.
    pub lost: u64,
}

/// The gaps found so far.
#[derive(Debug, Default)]
pub(super) struct Gaps {
    /// Those among pairs that are still to be delivered.
    ahead: VecDeque<Found>,
    /// The first of those to be told.
    first: Option<Found>,
    count: u64,
    /// The pairs missing in all of them.
    lost: u64,
}

/// A gap, and its times.
#[derive(Debug, Clone, Copy)]
struct Found {
    gap: Gap,
    line: u64,
    from: f64,
    to: f64,
}

impl Gaps {
    /// Takes one that was found before this line, between these times.
    pub fn add(&mut self, gap: Gap, line: u64, [from, to]: [f64; 2]) {
        let found = Found {
            gap,
            line,
            from,
            to,
        };
        self.ahead.push_back(found);
    }

    /// The next one.
    pub fn next(&self) -> Option<Gap> {
        self.ahead.front().map(|found| found.gap)
    }

    /// Passes the next one; it `is_told` at the end, or not.
    pub fn pass(&mut self, is_told: bool) {
        if let Some(found) = self.ahead.pop_front().filter(|_| is_told) {
            self.count += 1;
            self.lost += found.gap.lost;
            self.first.get_or_insert(found);
        }
    }

    /// The line of the first one, and what is to be told of all.
    pub fn fault(&self) -> Option<(u64, TimeFault)> {
        let first = self.first?;
        let fault = TimeFault::Gap {
            lost: first.gap.lost,
            from: first.from,
            to: first.to,
            gaps: self.count,
            all: self.lost,
        };
        Some((first.line, fault))
    }
}

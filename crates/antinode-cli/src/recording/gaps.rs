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
    ahead: VecDeque<Gap>,
    first: Option<First>,
    count: u64,
    /// The pairs missing in all of them.
    lost: u64,
}

/// The first gap, by its times.
#[derive(Debug, Clone, Copy)]
struct First {
    line: u64,
    lost: u64,
    from: f64,
    to: f64,
}

impl Gaps {
    /// Takes one that was found before this line, between these times.
    pub fn add(&mut self, gap: Gap, line: u64, [from, to]: [f64; 2]) {
        self.first.get_or_insert(First {
            line,
            lost: gap.lost,
            from,
            to,
        });
        self.count += 1;
        self.lost += gap.lost;
        self.ahead.push_back(gap);
    }

    /// The next one.
    pub fn next(&self) -> Option<Gap> {
        self.ahead.front().copied()
    }

    /// Goes on to the one behind it.
    pub fn pass(&mut self) {
        self.ahead.pop_front();
    }

    /// The line of the first one, and what is to be told of all.
    pub fn fault(&self) -> Option<(u64, TimeFault)> {
        let first = self.first?;
        let fault = TimeFault::Gap {
            lost: first.lost,
            from: first.from,
            to: first.to,
            gaps: self.count,
            all: self.lost,
        };
        Some((first.line, fault))
    }
}

//! Samples that a recording's own time shows to be missing: they are left out of the rows, and told at the end.

use std::collections::VecDeque;
use std::num::NonZeroU32;

use super::error::TimeFault;

/// Gaps as far apart from each other as the next are no chance, if they are so many.
const REGULAR: u32 = 5;

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
    count: u32,
    /// The pairs missing in all of them.
    lost: u64,
    /// Pairs before the last one, and from each to the next where these are as many for all of them.
    last: u64,
    every: Option<NonZeroU32>,
}

/// A gap, and its times.
#[derive(Debug, Clone, Copy)]
struct Found {
    gap: Gap,
    line: u64,
    from: f64,
    to: f64,
    /// Whether lines that were left out had its samples.
    is_explained: bool,
}

impl Gaps {
    /// Takes one that was found before this line, between these times; it may be told otherwise.
    pub fn add(&mut self, gap: Gap, line: u64, [from, to]: [f64; 2], is_explained: bool) {
        let found = Found {
            gap,
            line,
            from,
            to,
            is_explained,
        };
        self.ahead.push_back(found);
    }

    /// The next one.
    pub fn next(&self) -> Option<Gap> {
        self.ahead.front().map(|found| found.gap)
    }

    /// Passes the next one; it `is_told` at the end, or not.
    pub fn pass(&mut self, is_told: bool) {
        let passed = self.ahead.pop_front();
        if let Some(found) = passed.filter(|found| is_told && !found.is_explained) {
            let since = found.gap.before - self.last;
            match self.count {
                0 => {}
                1 => self.every = u32::try_from(since).ok().and_then(NonZeroU32::new),
                _ => self.every = self.every.filter(|every| u64::from(every.get()) == since),
            }
            self.last = found.gap.before;
            self.count = self.count.saturating_add(1);
            self.lost += found.gap.lost;
            self.first.get_or_insert(found);
        }
    }

    /// The line of the first one, and how many samples are lost in all.
    pub fn told(&self) -> Option<(u64, u64)> {
        Some((self.first?.line, self.lost))
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
            every: self.every.filter(|_| self.count >= REGULAR),
        };
        Some((first.line, fault))
    }
}

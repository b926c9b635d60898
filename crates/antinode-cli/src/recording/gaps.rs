//! Gaps: samples that a recording's own time shows to be missing. No row spans one, and they are reported at the end.

use std::collections::VecDeque;
use std::num::NonZeroU32;

use crate::digits::counted;

/// Number of gaps from which on equal distances between them are no chance.
const MIN_REGULAR: u32 = 5;

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
    /// Gaps that are not yet passed.
    ahead: VecDeque<Found>,
    /// The first gap to be reported.
    first: Option<Found>,
    /// The number of gaps to be reported.
    count: u32,
    /// The pairs missing in all of them.
    lost: u64,
    /// Pairs before the last gap, and from each gap to the next if these are always as many.
    last: u64,
    every: Option<NonZeroU32>,
}

/// A gap that was found before a line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    pub gap: Gap,
    pub line: u64,
    /// The times before and behind it.
    pub times: [f64; 2],
    /// Whether its samples were in lines that were left out, which are reported themselves.
    pub is_explained: bool,
}

impl Gaps {
    /// Adds a gap.
    pub fn add(&mut self, found: Found) {
        self.ahead.push_back(found);
    }

    /// The next gap that is not yet passed.
    pub fn next(&self) -> Option<Gap> {
        self.ahead.front().map(|found| found.gap)
    }

    /// Passes the next gap, which `is_reported` at the end or not.
    pub fn pass(&mut self, is_reported: bool) {
        let passed = self.ahead.pop_front();
        if let Some(found) = passed.filter(|found| is_reported && !found.is_explained) {
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

    /// The line of the first gap to be reported, and the number of samples lost in all.
    pub fn reported(&self) -> Option<(u64, u64)> {
        Some((self.first?.line, self.lost))
    }

    /// The line of the first gap to be reported, and the fault that reports all; times are counts of samples if they `are_counts`.
    pub fn fault(&self, are_counts: bool) -> Option<(u64, String)> {
        let first = self.first?;
        let [from, to] = first.times;
        let of_all = match self.count {
            1 => String::new(),
            gaps => format!(", the first of {gaps} gaps with {} samples", self.lost),
        };
        let every = self.every.filter(|_| self.count >= MIN_REGULAR);
        let every = every.map_or(String::new(), |every| {
            format!(
                ", one every {every} samples, as if packets had their own time stamps and nothing were lost"
            )
        });
        let of_times = if are_counts {
            format!("the count of samples goes from {from} to {to}")
        } else {
            format!("time goes from {from} s to {to} s")
        };
        let told = format!(
            "{} before this line ({of_times}){of_all}{every}; rows whose window spans a gap are \
             missing, all others are good; record it again without loss",
            are_lost(first.gap.lost)
        );
        Some((first.line, told))
    }
}

/// The words for so many samples that are lost.
pub(super) fn are_lost(count: u64) -> String {
    let verb = if count == 1 { "is" } else { "are" };
    format!("{} {verb} lost", counted(count, "sample"))
}

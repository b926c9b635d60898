//! Lines of a text recording that are left out because their time is not known; they are reported at the end.

use std::collections::VecDeque;

use super::not_finite::Flaw;

/// Most runs of lines kept: fewer pairs than this are read before they are looked at or passed.
const MAX_AHEAD: usize = 1 << 19;

/// The lines left out so far.
#[derive(Debug, Default)]
pub(super) struct LeftOut {
    /// Lines behind pairs that are still to be looked at.
    ahead: VecDeque<Run>,
    /// The first line to be reported, and how many there are.
    first: Option<Flaw>,
    count: u64,
    /// The number of pairs up to the last one looked at.
    looked: u64,
}

/// Lines behind the same pair.
#[derive(Debug)]
struct Run {
    first: Flaw,
    count: u64,
}

impl LeftOut {
    /// Adds a line.
    pub fn add(&mut self, line: Flaw) {
        match self.ahead.back_mut() {
            Some(run) if run.first.pair == line.pair => run.count += 1,
            _ => self.ahead.push_back(Run {
                first: line,
                count: 1,
            }),
        }
        // Before the first pair that is asked for, none is looked at: lines there must not fill the memory.
        if self.ahead.len() > MAX_AHEAD {
            self.ahead.pop_front();
        }
    }

    /// Notes that the pairs from `start` up to `end` are looked at: lines among them are reported, earlier ones are not asked for.
    pub fn look(&mut self, start: u64, end: u64) {
        let passed = self.ahead.partition_point(|run| run.first.pair < end);
        for run in self.ahead.drain(..passed) {
            if run.first.pair >= start {
                self.count += run.count;
                self.first.get_or_insert(run.first);
            }
        }
        self.looked = end;
    }

    /// The first line to be reported, and how many there are, with those just behind the last pair looked at.
    pub fn reported(&self) -> Option<(&Flaw, u64)> {
        let behind = self.ahead.front();
        let behind = behind.filter(|run| run.first.pair == self.looked);
        let first = self.first.as_ref().or(behind.map(|run| &run.first))?;
        Some((first, self.count + behind.map_or(0, |run| run.count)))
    }

    /// Forgets all lines: another error reports them.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

//! What the numbers of reports tell of those that are missing, and of the device's starts.

use crate::frame::ReportFrame;
use crate::report::{Report, State};

/// Reports back, up to which a report is one that comes again rather than one behind a long gap.
const MAX_REPEATED: u16 = 256;

/// Where a report stands among those before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// The device has started. Since then so many are missing; those missing just before are not known.
    Start(u16),
    /// So many are missing between the latest report and this, modulo 65 536.
    Next(u16),
    /// It comes again, as on a line with an echo: it has the number of the report so far behind the next, 1 to 256.
    Again(u16),
}

/// The numbers of the reports so far.
#[derive(Debug, Clone, Default)]
pub struct Numbers {
    /// The number expected of the next report.
    next: Option<u16>,
    /// The number expected if the Hello just taken came again.
    again: Option<u16>,
}

impl Numbers {
    /// Those before the first report, whose place is [`Place::Next`] unless it tells a start.
    pub const fn new() -> Self {
        Self {
            next: None,
            again: None,
        }
    }

    /// Takes a report; gives its place. After one that comes again the same number is expected as before.
    ///
    /// The first two reports of a start, Hello as number 0 and Started, are known to come again only where Started follows itself, or a lone
    /// Hello is followed by the number expected before it; elsewhere they are a start.
    pub fn take(&mut self, frame: &ReportFrame) -> Place {
        let number = frame.number;
        let again = self.again.take();
        let is_start = match frame.report {
            Report::Hello(_) => number == 0 && self.next != Some(0),
            // One just behind itself comes again.
            Report::State(State::Started(_)) => {
                let known = [number, number.wrapping_add(1)].map(Some);
                !known.contains(&self.next)
            }
            _ => false,
        };
        if is_start {
            let before = self.next;
            self.go_on_behind(number);
            self.again = again
                .or(before)
                .filter(|&next| number == 0 && next <= MAX_REPEATED);
            return Place::Start(before.map_or(0, |_| number));
        }
        let next = again.filter(|&again| again == number).or(self.next);
        let missing = next.map_or(0, |next| number.wrapping_sub(next));
        if missing > u16::MAX - MAX_REPEATED {
            return Place::Again(missing.wrapping_neg());
        }
        self.go_on_behind(number);
        Place::Next(missing)
    }

    /// Expects the number behind this one next, as if the report just taken were new although its number has come before.
    pub fn go_on_behind(&mut self, number: u16) {
        self.next = Some(number.wrapping_add(1));
    }
}

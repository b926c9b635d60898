//! Both ends of the reports' way: one numbers them, the other misses numbers.

use crate::decoder::{Damage, Decoder};
use crate::frame::{BufferTooSmall, Frame, ReportFrame, frame_of};
use crate::report::{Report, State};

/// Numbers the device's reports.
#[derive(Debug, Clone, Default)]
pub struct Reporter {
    next: u16,
}

impl Reporter {
    /// The next report is number 0.
    pub const fn new() -> Self {
        Self { next: 0 }
    }

    /// Spends the next report's number on one that finds no room to be sent: so the PC learns of it.
    pub fn skip(&mut self) {
        self.next = self.next.wrapping_add(1);
    }

    /// Writes the next report as a frame into the start of `buffer`; gives the bytes to send.
    ///
    /// Its number is spent even where the frame then finds no room to be sent: so the PC learns of it.
    ///
    /// # Errors
    ///
    /// [`BufferTooSmall`]: never with [`MAX_FRAME`](crate::MAX_FRAME) bytes.
    pub fn frame<'a>(
        &mut self,
        report: &Report,
        buffer: &'a mut [u8],
    ) -> Result<&'a [u8], BufferTooSmall> {
        let number = self.next;
        self.next = number.wrapping_add(1);
        // As a `ReportFrame`, but for a copy of the report.
        frame_of(&(ReportFrame::HEADER, number, report), buffer)
    }
}

/// Takes the device's bytes as they come; gives reports, and counts what did not arrive.
#[derive(Debug, Default)]
pub struct Receiver {
    decoder: Decoder<ReportFrame>,
    /// The number that the next report should have.
    next: Option<u16>,
    reports: u64,
    lost: u64,
    damaged: u64,
}

impl Receiver {
    /// A receiver that has seen nothing.
    pub const fn new() -> Self {
        Self {
            decoder: Decoder::new(),
            next: None,
            reports: 0,
            lost: 0,
            damaged: 0,
        }
    }

    /// Takes one byte; gives the report that it completes, or the damage that it ends.
    pub fn push(&mut self, byte: u8) -> Option<Result<Report, Damage>> {
        let result = self.decoder.push(byte)?;
        Some(match result {
            Ok(ReportFrame { number, report }) => {
                let next = match report {
                    // A device that has just started says Hello as number 0, then why it has started.
                    Report::Hello(_) if number == 0 => Some(0),
                    Report::State(State::Started(_)) if self.next != Some(number) => {
                        self.next.map(|_| 0)
                    }
                    _ => self.next,
                };
                if let Some(next) = next {
                    self.lost += u64::from(number.wrapping_sub(next));
                }
                self.next = Some(number.wrapping_add(1));
                self.reports += 1;
                Ok(report)
            }
            Err(damage) => {
                self.damaged += 1;
                Err(damage)
            }
        })
    }

    /// Ends a stream; gives the damage where it ends within a frame.
    pub fn finish(&mut self) -> Option<Damage> {
        let damage = self.decoder.finish()?;
        self.damaged += 1;
        Some(damage)
    }

    /// Reports given.
    pub fn reports(&self) -> u64 {
        self.reports
    }

    /// Reports whose numbers are missing: those that were damaged on the line, and those that the device had no room to send.
    /// Of more than 65 535 in a row the multiple of 65 536 is not seen, and none of those before a restart of the device.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Runs of bytes between delimiters that were no sound report: damaged frames, and noise.
    pub fn damaged(&self) -> u64 {
        self.damaged
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cause, Configuration, FrontEnd, Hello, MAX_FRAME};
    use antinode::Settings;

    #[test]
    fn missing_numbers_are_counted_across_the_wrap() {
        let mut reporter = Reporter { next: 65_530 };
        let mut receiver = Receiver::new();
        let mut buffer = [0; MAX_FRAME];
        for i in 0..20 {
            let bytes = reporter
                .frame(&Report::State(State::Tracking), &mut buffer)
                .expect("room");
            if ![3, 5, 6].contains(&i) {
                for &byte in bytes {
                    receiver.push(byte);
                }
            }
        }
        assert_eq!((receiver.reports(), receiver.lost()), (17, 3));
    }

    #[test]
    fn of_a_restart_only_what_is_missing_since_is_lost() {
        let started = Report::State(State::Started(Cause::Watchdog));
        let configuration = Configuration::new(Settings::new(1e5), FrontEnd::Synthetic);
        let hello = Report::Hello(Hello::new("1", configuration));
        for (has_hello, lost) in [(true, 0), (false, 1)] {
            let mut receiver = Receiver::new();
            let mut buffer = [0; MAX_FRAME];
            let mut send = |reporter: &mut Reporter, report, arrives: bool| {
                let bytes = reporter.frame(report, &mut buffer).expect("room");
                bytes.iter().filter(|_| arrives).for_each(|&byte| {
                    receiver.push(byte);
                });
            };
            let tracking = Report::State(State::Tracking);
            let mut reporter = Reporter { next: 50_000 };
            send(&mut reporter, &tracking, true);
            let mut reporter = Reporter::new();
            send(&mut reporter, &hello, has_hello);
            send(&mut reporter, &started, true);
            send(&mut reporter, &tracking, true);
            assert_eq!(receiver.lost(), lost);
        }
        // What was before the first report is not known.
        let mut receiver = Receiver::new();
        let mut buffer = [0; MAX_FRAME];
        let mut reporter = Reporter { next: 1 };
        for &byte in reporter.frame(&started, &mut buffer).expect("room") {
            receiver.push(byte);
        }
        assert_eq!((receiver.reports(), receiver.lost()), (1, 0));
    }
}

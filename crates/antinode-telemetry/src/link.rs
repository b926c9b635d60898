//! Both ends of the reports' path: one numbers them, the other detects missing numbers.

use crate::decoder::{Damage, Decoder};
use crate::frame::{BufferTooSmall, Frame, ReportFrame, frame_of};
use crate::numbers::{Numbers, Place};
use crate::report::Report;

/// The device's end: it numbers and frames reports.
#[derive(Debug, Clone, Default)]
pub struct Reporter {
    next: u16,
}

impl Reporter {
    /// A reporter whose first report is number 0.
    pub const fn new() -> Self {
        Self { next: 0 }
    }

    /// Uses up a number for a report that is dropped for lack of room, so that the PC notices the loss.
    pub fn skip(&mut self) {
        self.next = self.next.wrapping_add(1);
    }

    /// Writes the next report as a frame into the start of `buffer`; gives the bytes to send.
    ///
    /// Its number is used up even if there is then no room to send the frame, so that the PC notices the loss.
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
        // Serialised like a `ReportFrame`, which would need a copy of the report.
        frame_of(&(ReportFrame::HEADER, number, report), buffer)
    }
}

/// The PC's end: it takes the device's bytes as they arrive, gives reports, and counts those that are lost.
#[derive(Debug, Default)]
pub struct Receiver {
    decoder: Decoder<ReportFrame>,
    numbers: Numbers,
    reports: u64,
    lost: u64,
    damaged: u64,
}

impl Receiver {
    /// A receiver that has taken no bytes.
    pub const fn new() -> Self {
        Self {
            decoder: Decoder::new(),
            numbers: Numbers::new(),
            reports: 0,
            lost: 0,
            damaged: 0,
        }
    }

    /// Takes one byte; gives the report that it completes, or the damage to a frame that it ends.
    pub fn push(&mut self, byte: u8) -> Option<Result<Report, Damage>> {
        let result = self.decoder.push(byte)?;
        Some(match result {
            Ok(frame) => {
                self.reports += 1;
                if let Place::Start(missing) | Place::Next(missing) = self.numbers.take(&frame) {
                    self.lost += u64::from(missing);
                }
                Ok(frame.report)
            }
            Err(damage) => {
                self.damaged += 1;
                Err(damage)
            }
        })
    }

    /// Ends a stream; gives the damage if it ends within a frame.
    pub fn finish(&mut self) -> Option<Damage> {
        let damage = self.decoder.finish()?;
        self.damaged += 1;
        Some(damage)
    }

    /// Count of reports given.
    pub fn reports(&self) -> u64 {
        self.reports
    }

    /// Count of missing report numbers: reports damaged on the line, and those that the device had no room to send. Numbers are modulo
    /// 65 536, so that multiples of 65 536 missing in a row, and up to 256 less, are not counted; nor are those just before a restart of the
    /// device, unless both of its first reports are missing too: then the numbers seem to go on. [`Numbers`] tells which reports come again.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Count of runs of bytes between delimiters that were no intact report: damaged frames, and noise.
    pub fn damaged(&self) -> u64 {
        self.damaged
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cause, Configuration, FrontEnd, Hello, MAX_FRAME, State};
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
    fn reports_that_come_again_are_not_lost() {
        let mut reporter = Reporter { next: 65_500 };
        let mut receiver = Receiver::new();
        let mut sent: [([u8; MAX_FRAME], usize); 300] = [([0; MAX_FRAME], 0); 300];
        for (buffer, length) in &mut sent {
            let bytes = reporter.frame(&Report::State(State::Tracking), buffer);
            *length = bytes.expect("room").len();
        }
        // An echo, a block sent twice, and a report missing behind it.
        let order = (0..290).chain([289]).chain(40..290).chain([291, 292]);
        for index in order {
            let (buffer, length) = &sent[index];
            for &byte in &buffer[..*length] {
                receiver.push(byte);
            }
        }
        assert_eq!((receiver.reports(), receiver.lost()), (543, 1));
    }

    #[test]
    fn after_a_restart_only_reports_missing_since_then_are_lost() {
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
        // Losses before the first report received are not known.
        let mut receiver = Receiver::new();
        let mut buffer = [0; MAX_FRAME];
        let mut reporter = Reporter { next: 1 };
        for &byte in reporter.frame(&started, &mut buffer).expect("room") {
            receiver.push(byte);
        }
        assert_eq!((receiver.reports(), receiver.lost()), (1, 0));
    }

    #[test]
    fn a_start_that_comes_again_is_no_restart() {
        const TRACKING: Report = Report::State(State::Tracking);
        let started = Report::State(State::Started(Cause::Watchdog));
        let configuration = Configuration::new(Settings::new(1e5), FrontEnd::Synthetic);
        let hello = Report::Hello(Hello::new("1", configuration));
        for (numbers, lost) in [
            (&[0, 1, 1, 2, 3][..], 0),
            (&[0, 0, 1, 1, 2, 2, 3, 3], 0),
            (&[0, 1, 2, 0, 3], 0),
            (&[0, 1, 2, 0, 0, 3, 5], 1),
            (&[0, 1, 2, 3, 0, 1, 2, 3, 4], 0),
            // A restart, in which numbers are missing.
            (&[0, 1, 2, 3, 0, 2, 3], 1),
            (&[0, 1, 2, 3, 0, 1, 3, 4], 1),
            (&[600, 0, 601], 600),
            // Taken for a restart whose Hello is missing.
            (&[0, 1, 2, 3, 1, 2, 3, 4], 1),
        ] {
            let mut receiver = Receiver::new();
            for &number in numbers {
                let report = match number {
                    0 => &hello,
                    1 => &started,
                    _ => &TRACKING,
                };
                let mut buffer = [0; MAX_FRAME];
                let bytes = Reporter { next: number }.frame(report, &mut buffer);
                for &byte in bytes.expect("room") {
                    receiver.push(byte);
                }
            }
            assert_eq!(receiver.lost(), lost, "{numbers:?}");
        }
    }
}

//! What `antinode monitor` shows: rows of estimates, and messages about all else.

use std::io::Write;
use std::mem;
use std::time::{Duration, Instant};

use antinode_telemetry::{Damage, Receiver, Report};

use super::describe;
use crate::failure::Failure;
use crate::rows::Rows;
use crate::tell::tell;

/// The id of the Get that greets a device.
pub const GREETING: u16 = 0;

/// Shortest time between messages about damage, of which a noisy line has much, and about reports lost on a slow line.
const MESSAGE_INTERVAL: Duration = Duration::from_secs(1);

/// The output for the user: rows on standard output, all else on standard error.
pub struct Screen<W: Write> {
    rows: Rows<W>,
    /// What the source is called.
    pub name: String,
    receiver: Receiver,
    estimates: u64,
    /// Bytes taken.
    pub bytes: u64,
    /// True until the first frame ends, if the bytes may begin in the middle of one.
    is_within_frame: bool,
    /// Damage that is not counted: the frame in whose middle the bytes began.
    excused: u64,
    /// Damage that is not yet reported: how often, and the last.
    damage: Option<(u64, Damage)>,
    /// When damage was last reported.
    damage_told: Option<Instant>,
    /// The number of lost reports that are not yet reported.
    lost: u64,
    /// When lost reports were last reported.
    lost_told: Option<Instant>,
}

impl<W: Write> Screen<W> {
    /// Output of what is called `name`, whose bytes may begin within a frame.
    pub fn new(rows: Rows<W>, name: &str, is_within_frame: bool) -> Self {
        Self {
            rows,
            name: name.to_owned(),
            receiver: Receiver::new(),
            estimates: 0,
            bytes: 0,
            is_within_frame,
            excused: 0,
            damage: None,
            damage_told: None,
            lost: 0,
            lost_told: None,
        }
    }

    /// Count of intact reports.
    pub fn reports(&self) -> u64 {
        self.receiver.reports()
    }

    /// Shows what some bytes complete.
    pub fn take(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        self.bytes += bytes.len() as u64;
        for &byte in bytes {
            let lost = self.receiver.lost();
            let Some(result) = self.receiver.push(byte) else {
                continue;
            };
            let is_within_frame = mem::take(&mut self.is_within_frame);
            match result {
                Err(_) if is_within_frame => self.excused = 1,
                Err(damage) => {
                    self.damaged(damage);
                    self.tell_due();
                }
                Ok(report) => {
                    self.lost += self.receiver.lost() - lost;
                    self.tell_due();
                    self.show(report)?;
                }
            }
        }
        Ok(())
    }

    fn show(&mut self, report: Report) -> Result<(), Failure> {
        match report {
            Report::Estimate(estimate) => {
                self.estimates += 1;
                self.rows.print(&self.name, &estimate, None)?;
                self.rows.flush()?;
            }
            // Other formats have rows for estimates alone.
            Report::Methods(methods) => {
                self.rows.under(&describe::methods(&methods))?;
                self.rows.flush()?;
            }
            Report::Hello(hello) => tell(format_args!("device: {}", describe::hello(&hello))),
            Report::State(state) => tell(format_args!("state: {state}")),
            Report::Counters(counters) => {
                tell(format_args!("counters: {}", describe::counters(&counters)))
            }
            Report::Acknowledgement(answer) if answer.id == GREETING => {}
            Report::Acknowledgement(answer) => match answer.result {
                Ok(()) => tell(format_args!("command {}: done", answer.id)),
                Err(error) => tell(format_args!("command {}: refused: {error}", answer.id)),
            },
            _ => tell(format_args!(
                "report: of an unknown kind; use firmware and command of the same release"
            )),
        }
        Ok(())
    }

    /// Reports damage and losses, unless the last message about them was just before.
    fn tell_due(&mut self) {
        let is_due =
            |told: Option<Instant>| told.is_none_or(|told| told.elapsed() >= MESSAGE_INTERVAL);
        if is_due(self.damage_told) {
            self.tell_damage();
        }
        if is_due(self.lost_told) {
            self.tell_lost();
        }
    }

    fn damaged(&mut self, damage: Damage) {
        let before = self.damage.map_or(0, |(count, _)| count);
        self.damage = Some((before + 1, damage));
    }

    fn tell_damage(&mut self) {
        match self.damage.take() {
            None => return,
            Some((1, damage)) => tell(format_args!("damaged: {damage}")),
            Some((count, damage)) => {
                tell(format_args!("damaged: {count} times, the last: {damage}"))
            }
        }
        self.damage_told = Some(Instant::now());
    }

    fn tell_lost(&mut self) {
        let lost = mem::take(&mut self.lost);
        if lost > 0 {
            tell(format_args!("lost: {lost} before the next report"));
            self.lost_told = Some(Instant::now());
        }
    }

    /// Ends the bytes: an unfinished frame is damaged.
    pub fn finish(&mut self) {
        if let Some(damage) = self.receiver.finish() {
            self.damaged(damage);
        }
    }

    /// Reports what is not yet reported, and the totals.
    pub fn end(&mut self, time: Duration) {
        if self.lost > 0 {
            tell(format_args!("lost: {} more", self.lost));
        }
        self.tell_damage();
        let reports = self.receiver.reports();
        tell(format_args!(
            "{}: {} estimates and {} other reports; {} lost, {} damaged; {} bytes in {:.1} s",
            self.name,
            self.estimates,
            reports - self.estimates,
            self.receiver.lost(),
            self.receiver.damaged() - self.excused,
            self.bytes,
            time.as_secs_f64()
        ));
    }
}

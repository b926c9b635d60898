//! What `antinode monitor` shows: rows of estimates, and messages about all else.

use std::io::Write;
use std::mem;
use std::time::{Duration, Instant};

use antinode_telemetry::{Damage, Decoder, Hello, Report, ReportFrame, State};

use super::course::{Course, Event};
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
    decoder: Decoder<ReportFrame>,
    course: Course,
    /// The last version and configuration, and whether the device has restarted since.
    hello: Option<Hello>,
    is_restarted: bool,
    estimates: u64,
    /// Intact reports.
    pub reports: u64,
    /// Bytes taken.
    pub bytes: u64,
    /// True until the first frame ends, if the bytes may begin in the middle of one.
    is_within_frame: bool,
    /// Damaged frames, and noise, but for the frame in whose middle the bytes began.
    damaged: u64,
    /// Damage that is not yet reported: how often, and the last.
    damage: Option<(u64, Damage)>,
    /// When damage was last reported.
    damage_told: Option<Instant>,
    /// Reports lost, and how many of these are not yet reported.
    lost: u64,
    untold: u64,
    /// True if more may be lost: a hole was too long to count.
    is_more: bool,
    /// When lost reports were last reported.
    lost_told: Option<Instant>,
}

impl<W: Write> Screen<W> {
    /// Output of what is called `name`, whose bytes may begin within a frame.
    pub fn new(rows: Rows<W>, name: &str, is_within_frame: bool) -> Self {
        Self {
            rows,
            name: name.to_owned(),
            decoder: Decoder::new(),
            course: Course::default(),
            hello: None,
            is_restarted: false,
            estimates: 0,
            reports: 0,
            bytes: 0,
            is_within_frame,
            damaged: 0,
            damage: None,
            damage_told: None,
            lost: 0,
            untold: 0,
            is_more: false,
            lost_told: None,
        }
    }

    /// Shows what some bytes complete.
    pub fn take(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        self.bytes += bytes.len() as u64;
        for &byte in bytes {
            let Some(result) = self.decoder.push(byte) else {
                continue;
            };
            let is_within_frame = mem::take(&mut self.is_within_frame);
            match result {
                Err(_) if is_within_frame => {}
                Err(damage) => {
                    self.damaged(damage);
                    self.tell_due();
                }
                Ok(frame) => {
                    self.reports += 1;
                    let event = self.course.take(&frame);
                    self.follow(event);
                    self.tell_due();
                    self.show(frame.report)?;
                }
            }
        }
        Ok(())
    }

    /// Counts and tells what the course shows.
    fn follow(&mut self, event: Option<Event>) {
        match event {
            None => {}
            Some(Event::Started) => self.is_restarted = true,
            Some(Event::Lost(count)) => {
                self.lost += count;
                self.untold += count;
            }
            Some(Event::Uncounted(count, Some(seconds))) => {
                self.lost += count;
                self.is_more = true;
                tell(format_args!(
                    "lost: {count} in {seconds:.0} s, or more by a multiple of 65536, as the reports' numbers begin anew there"
                ));
            }
            Some(Event::Uncounted(count, None)) => {
                self.is_more = true;
                tell(format_args!(
                    "lost: {count} by the reports' numbers, but none of them tells the time: the device may have restarted"
                ));
            }
            Some(Event::Restarted) => {
                self.is_restarted = true;
                tell(
                    "restarted: by its reports' numbers and times the device has begun anew, but its start was not received; reports lost about it are \
                 not counted",
                );
                self.tell_unknown();
            }
        }
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
            Report::Hello(hello) => {
                tell(format_args!("device: {}", describe::hello(&hello)));
                self.compare(hello);
            }
            Report::State(state) => {
                tell(format_args!("state: {state}"));
                if let State::Started(_) = state {
                    self.tell_unknown();
                }
            }
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

    /// Warns of settings that are not those before a restart.
    fn compare(&mut self, hello: Hello) {
        let is_restarted = mem::take(&mut self.is_restarted);
        if let Some(before) = self.hello.replace(hello.clone()).filter(|_| is_restarted)
            && let Some(differences) = describe::differences(&hello, &before)
        {
            tell(format_args!(
                "warning: since its restart the device has other settings: {differences}; commands last until a reset only: send them again, \
                 and do not use rows before and after it together"
            ));
        }
    }

    /// Warns of a restart behind which no settings came.
    fn tell_unknown(&self) {
        if self.is_restarted && self.hello.is_some() {
            tell(
                "warning: the settings since the restart of the device were not received: what commands had changed before is gone",
            );
        }
    }

    fn damaged(&mut self, damage: Damage) {
        self.damaged += 1;
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
        let lost = mem::take(&mut self.untold);
        if lost > 0 {
            tell(format_args!("lost: {lost} before the next report"));
            self.lost_told = Some(Instant::now());
        }
    }

    /// Ends the bytes: an unfinished frame is damaged.
    pub fn finish(&mut self) {
        if let Some(damage) = self.decoder.finish() {
            self.damaged(damage);
        }
    }

    /// Reports what is not yet reported, and the totals.
    pub fn end(&mut self, time: Duration) {
        let event = self.course.finish();
        self.follow(event);
        if self.untold > 0 {
            let more = self.lost_told.map_or("", |_| " more");
            tell(format_args!("lost: {}{more}", self.untold));
        }
        self.tell_damage();
        tell(format_args!(
            "{}: {} estimates and {} other reports; {}{} lost, {} damaged; {} bytes in {:.1} s",
            self.name,
            self.estimates,
            self.reports - self.estimates,
            if self.is_more { "at least " } else { "" },
            self.lost,
            self.damaged,
            self.bytes,
            time.as_secs_f64()
        ));
    }
}

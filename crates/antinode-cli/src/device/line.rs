//! The serial line to a device: sends a command, again if no answer comes, and waits for its answer.

use std::io;
use std::path::Path;
use std::process;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use antinode_telemetry::{
    Cause, Command, CommandError, CommandFrame, Damage, Hello, MAX_FRAME, Receiver, Report, State,
    frame,
};
use serialport::SerialPort;

use super::port;
use crate::failure::Failure;

/// How often an unanswered command is sent, unless sending it again would act again.
const SENDS: u32 = 3;

/// The line to a device.
pub struct Line {
    name: String,
    port: Box<dyn SerialPort>,
    /// How long an answer is waited for.
    patience: Duration,
    baud: u32,
    receiver: Receiver,
    bytes: u64,
    /// An intact frame of another protocol version, or an echo, if one came.
    foreign: Option<Damage>,
}

/// What the device answered to a command.
#[derive(Default)]
struct Heard {
    hello: Option<Hello>,
    /// True once the command is acknowledged.
    is_done: bool,
}

impl Heard {
    /// Takes a report that came after this command was sent.
    fn take(&mut self, report: Report, asked: CommandFrame) -> Result<(), CommandError> {
        match report {
            Report::Hello(told) => self.hello = Some(told),
            Report::Acknowledgement(answer) if answer.id == asked.id => {
                answer.result?;
                self.is_done = true;
            }
            // The acknowledgement was damaged, or a slow line had no time for it.
            Report::State(State::Started(Cause::Command)) if asked.command == Command::Restart => {
                self.is_done = true;
            }
            _ => {}
        }
        Ok(())
    }
}

impl Line {
    /// Opens the port; `patience` is how long an answer is waited for.
    pub fn open(path: &Path, baud: u32, patience: Duration) -> Result<Self, Failure> {
        Ok(Self {
            name: path.display().to_string(),
            port: port::open(path, baud)?,
            patience,
            baud,
            receiver: Receiver::new(),
            bytes: 0,
            foreign: None,
        })
    }

    /// Asks for the device's version and configuration.
    pub fn hello(&mut self) -> Result<Hello, Failure> {
        self.ask(Command::Get, true)?.ok_or_else(|| {
            Failure::Fault(format!(
                "{}: the device acknowledged, but its configuration did not arrive; try again",
                self.name
            ))
        })
    }

    /// Sends a command and waits for its acknowledgement; gives the Hello that came meanwhile, and if one is `wanted`, waits for it too.
    pub fn ask(&mut self, command: Command, wanted: bool) -> Result<Option<Hello>, Failure> {
        // The same id every time: a late answer to the first sending is good for all.
        let asked = CommandFrame {
            id: fresh_id(),
            command,
        };
        let mut buffer = [0; MAX_FRAME];
        let request = frame(&asked, &mut buffer)
            .map_err(|error| Failure::Fault(format!("{}: {error}", self.name)))?;
        let sends = if command == Command::Restart {
            1
        } else {
            SENDS
        };
        let mut heard = Heard::default();
        for send in 1..=sends {
            self.port
                .write_all(request)
                .map_err(|error| port::gone(&self.name, &error))?;
            let end = Instant::now() + self.patience;
            while Instant::now() < end {
                for report in self.read()? {
                    match heard.take(report, asked) {
                        Ok(()) => {}
                        // The device may be busy with this very command, sent before.
                        Err(CommandError::Busy) if send < sends => {}
                        Err(error) => return Err(self.refused(error)),
                    }
                }
                if heard.is_done && (heard.hello.is_some() || !wanted) {
                    return Ok(heard.hello);
                }
            }
        }
        if heard.is_done {
            Ok(None)
        } else {
            Err(self.silent(sends))
        }
    }

    fn refused(&self, error: CommandError) -> Failure {
        Failure::Fault(format!("{}: refused: {error}", self.name))
    }

    /// The reports that have come; waits a little if none have.
    fn read(&mut self) -> Result<Vec<Report>, Failure> {
        let mut buffer = [0; 4096];
        match self.port.read(&mut buffer) {
            Ok(length) => {
                self.bytes += length as u64;
                let mut reports = Vec::new();
                for &byte in &buffer[..length] {
                    match self.receiver.push(byte) {
                        Some(Ok(report)) => reports.push(report),
                        Some(Err(damage @ Damage::Header(_))) => self.foreign = Some(damage),
                        Some(Err(_)) | None => {}
                    }
                }
                Ok(reports)
            }
            Err(error) => match error.kind() {
                io::ErrorKind::TimedOut | io::ErrorKind::Interrupted => Ok(Vec::new()),
                _ => Err(port::gone(&self.name, &error)),
            },
        }
    }

    /// The failure if no acknowledgement came, with the likely cause by what did come.
    fn silent(&self, sends: u32) -> Failure {
        let (reports, bytes) = (self.receiver.reports(), self.bytes);
        let why = if bytes == 0 {
            "nothing was received: check that the device runs, and its wiring".to_owned()
        } else if let (0, Some(foreign)) = (reports, self.foreign) {
            format!("what was received is {foreign}")
        } else if reports == 0 {
            format!(
                "{bytes} bytes were received, but no telemetry: check --baud (it was {}), and that firmware and command use the same \
                 protocol version",
                self.baud
            )
        } else {
            format!(
                "{reports} reports were received: check the line from this computer to the device, or wait longer with --timeout"
            )
        };
        Failure::Fault(format!(
            "{}: no acknowledgement within {} s{}; {why}",
            self.name,
            self.patience.as_secs_f64(),
            if sends > 1 {
                format!(", sent {sends} times")
            } else {
                String::new()
            }
        ))
    }
}

/// An id, 1 to 65535, that the command before did not have, by the clock and the process; 0 is the monitor's.
fn fresh_id() -> u16 {
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let nanoseconds = now.map_or(0, |time| time.subsec_nanos());
    (nanoseconds.wrapping_add(process::id()) % 65_535) as u16 + 1
}

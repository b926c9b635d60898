//! `antinode command`: one command to a device, and its answer.

use std::fmt;
use std::io;
use std::path::PathBuf;
use std::process;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use antinode::Calibration;
use antinode_telemetry::{
    Command, CommandError, CommandFrame, Hello, MAX_FRAME, Receiver, Report, frame,
};
use clap::{Args, Subcommand, ValueEnum, value_parser};
use serialport::SerialPort;

use super::{BAUD, port, told};
use crate::failure::Failure;
use crate::{options, ranges};

/// `antinode command`.
#[derive(Debug, Args)]
pub struct Options {
    /// The device's serial port. No other program may have it open, `antinode monitor` included.
    #[arg(value_name = "PORT")]
    pub port: PathBuf,
    /// Speed of the port, baud (bits a second; 8N1).
    #[arg(long, global = true, default_value_t = BAUD, value_name = "BAUD", value_parser = value_parser!(u32).range(1..))]
    pub baud: u32,
    /// How long to wait for an answer, s; 0.01 to 3600. Unanswered commands are sent again, three times in all; `restart` is sent once.
    #[arg(long, global = true, default_value_t = 2.0, value_name = "SECONDS", value_parser = ranges::seconds)]
    pub timeout: f64,
    /// What the device is to do.
    #[command(subcommand)]
    pub ask: Ask,
}

/// How often a command is sent that changes no more the second time than the first.
const SENDS: u32 = 3;

/// What can be asked of a device.
#[derive(Debug, Subcommand)]
pub enum Ask {
    /// Prints the device's version and configuration.
    Get,
    /// Changes the length of a window.
    Window {
        /// Periods a window, 2 or more; the device knows the most.
        #[arg(value_name = "PERIODS", value_parser = value_parser!(u16).range(2..))]
        periods: u16,
    },
    /// Changes the step from the start of one window to the start of the next.
    Hop {
        /// Blocks, 1 or more; `none`: windows follow each other without gap or overlap.
        #[arg(value_name = "BLOCKS|none", value_parser = blocks)]
        blocks: Blocks,
    },
    /// Changes the correction of the pick-offs; what is not given stays as it is.
    #[command(allow_negative_numbers = true, arg_required_else_help = true)]
    Calibration {
        /// Gain of pick-off D over that of C, 0.1 to 10.
        #[arg(long, value_name = "RATIO", value_parser = ranges::gain_ratio)]
        gain_ratio: Option<f32>,
        /// How much later than C pick-off D is sampled, ns, within ±1000000.
        #[arg(long, value_name = "NS", value_parser = ranges::skew_ns)]
        skew_ns: Option<f32>,
        /// Pick-off D stands at 45° plus this angle from C, rad, within ±0.3.
        #[arg(long, value_name = "RAD", value_parser = ranges::pick_off_angle)]
        pick_off_angle: Option<f32>,
    },
    /// Switches the report of the paper's four methods beside every estimate on or off.
    Methods {
        /// Whether they are reported.
        #[arg(value_enum)]
        switch: Switch,
    },
    /// Resets the device.
    Restart,
}

/// A hop, or none.
#[derive(Debug, Clone, Copy)]
pub struct Blocks(Option<u16>);

/// On or off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Switch {
    /// They are reported.
    On,
    /// They are not.
    Off,
}

fn blocks(text: &str) -> Result<Blocks, String> {
    if text == "none" {
        return Ok(Blocks(None));
    }
    match text.parse() {
        Ok(blocks @ 1..) => Ok(Blocks(Some(blocks))),
        _ => Err("it must be 1 to 65535 blocks, or none".to_owned()),
    }
}

/// Sends a command and prints the answer.
pub fn run(options: &Options) -> Result<(), Failure> {
    let mut line = Line {
        name: options.port.display().to_string(),
        port: port::open(&options.port, options.baud)?,
        patience: Duration::from_secs_f64(options.timeout),
        baud: options.baud,
        receiver: Receiver::new(),
        bytes: 0,
    };
    let command = match options.ask {
        Ask::Get => {
            println!("{}", told::hello(&line.hello()?));
            return Ok(());
        }
        Ask::Window { periods } => Command::SetWindow { periods },
        Ask::Hop {
            blocks: Blocks(blocks),
        } => Command::SetHop { blocks },
        Ask::Calibration {
            gain_ratio,
            skew_ns,
            pick_off_angle,
        } => {
            let present = line.hello()?.configuration.settings.calibration;
            Command::SetCalibration(Calibration {
                gain_ratio: gain_ratio.unwrap_or(present.gain_ratio),
                skew: skew_ns.map_or(present.skew, options::seconds),
                pick_off_angle: pick_off_angle.unwrap_or(present.pick_off_angle),
            })
        }
        Ask::Methods { switch } => Command::SetMethods {
            on: switch == Switch::On,
        },
        Ask::Restart => Command::Restart,
    };
    line.ask(command, false)?;
    println!("{}: done", Words(&command));
    Ok(())
}

/// A command as the user would name it.
struct Words<'a>(&'a Command);

impl fmt::Display for Words<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Command::Get => write!(f, "get"),
            Command::SetWindow { periods } => write!(f, "window of {periods} periods"),
            Command::SetHop { blocks: None } => write!(f, "no hop"),
            Command::SetHop {
                blocks: Some(blocks),
            } => write!(f, "hop of {blocks} blocks"),
            Command::SetCalibration(c) => write!(
                f,
                "calibration: gain ratio {}, skew {} ns, pick-off angle {} rad",
                c.gain_ratio,
                c.skew * 1e9,
                c.pick_off_angle
            ),
            Command::SetMethods { on: true } => write!(f, "methods on"),
            Command::SetMethods { on: false } => write!(f, "methods off"),
            Command::Restart => write!(f, "restart"),
        }
    }
}

/// The line to a device.
struct Line {
    name: String,
    port: Box<dyn SerialPort>,
    patience: Duration,
    baud: u32,
    receiver: Receiver,
    bytes: u64,
}

/// What came of a command.
#[derive(Default)]
struct Heard {
    hello: Option<Hello>,
    /// True when it was acknowledged.
    is_done: bool,
}

impl Heard {
    /// Takes a report after the command of this id was sent.
    fn take(&mut self, report: Report, id: u16) -> Result<(), CommandError> {
        match report {
            Report::Hello(told) => self.hello = Some(told),
            Report::Acknowledgement(answer) if answer.id == id => {
                answer.result?;
                self.is_done = true;
            }
            _ => {}
        }
        Ok(())
    }
}

impl Line {
    /// Who the device is.
    fn hello(&mut self) -> Result<Hello, Failure> {
        self.ask(Command::Get, true)?.ok_or_else(|| {
            Failure::Recording(format!(
                "{}: the device acknowledged, but its configuration did not arrive; try again",
                self.name
            ))
        })
    }

    /// Sends a command and waits for its answer; gives the Hello that came on the way, and waits for one where it is wanted.
    fn ask(&mut self, command: Command, wanted: bool) -> Result<Option<Hello>, Failure> {
        // One id for all: a late answer to the first is good for the others.
        let id = fresh_id();
        let mut buffer = [0; MAX_FRAME];
        let request = frame(&CommandFrame { id, command }, &mut buffer)
            .map_err(|error| Failure::Recording(format!("{}: {error}", self.name)))?;
        let sends = if command == Command::Restart {
            1
        } else {
            SENDS
        };
        let mut heard = Heard::default();
        for send in 1..=sends {
            self.port
                .write_all(request)
                .map_err(|error| self.gone(&error))?;
            let end = Instant::now() + self.patience;
            while Instant::now() < end {
                for report in self.read()? {
                    match heard.take(report, id) {
                        Ok(()) => {}
                        // It may be busy with the same command, whose answer was lost.
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
        Failure::Recording(format!("{}: refused: {error}", self.name))
    }

    /// The reports that have come, after waiting a little where none have.
    fn read(&mut self) -> Result<Vec<Report>, Failure> {
        let mut buffer = [0; 4096];
        match self.port.read(&mut buffer) {
            Ok(length) => {
                self.bytes += length as u64;
                let bytes = &buffer[..length];
                let receiver = &mut self.receiver;
                Ok(bytes
                    .iter()
                    .filter_map(|&byte| receiver.push(byte)?.ok())
                    .collect())
            }
            Err(error) => match error.kind() {
                io::ErrorKind::TimedOut | io::ErrorKind::Interrupted => Ok(Vec::new()),
                _ => Err(self.gone(&error)),
            },
        }
    }

    fn gone(&self, error: &io::Error) -> Failure {
        Failure::Recording(format!(
            "{}: the port fails: {error}; check that the device is plugged in",
            self.name
        ))
    }

    /// Nothing was acknowledged: what did come tells why.
    fn silent(&self, sends: u32) -> Failure {
        let (reports, bytes) = (self.receiver.reports(), self.bytes);
        let why = if bytes == 0 {
            "nothing came at all: check that the device runs, and the wiring".to_owned()
        } else if reports == 0 {
            format!(
                "{bytes} bytes came, and no telemetry: check --baud (it was {}) and the protocol version",
                self.baud
            )
        } else {
            format!(
                "{reports} reports came: check the line from this computer to the device, or wait longer with --timeout"
            )
        };
        Failure::Recording(format!(
            "{}: no acknowledgement within {} s{}; {why}",
            self.name,
            self.patience.as_secs_f64(),
            if sends > 1 {
                format!(", asked {sends} times")
            } else {
                String::new()
            }
        ))
    }
}

/// An id that the command before did not have: 1 to 65535, as 0 is the monitor's.
fn fresh_id() -> u16 {
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let nanoseconds = now.map_or(0, |time| time.subsec_nanos());
    (nanoseconds.wrapping_add(process::id()) % 65_535) as u16 + 1
}

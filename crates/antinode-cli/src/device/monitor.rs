//! `antinode monitor`: prints what a device reports, as it comes.

use std::io::{self, BufWriter, Write};
use std::mem;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use antinode_telemetry::{Command, CommandFrame, Damage, MAX_FRAME, Receiver, Report, frame};
use clap::Args;

use super::source::{Input, Source};
use super::{BAUD, describe, port};
use crate::failure::Failure;
use crate::options::Format;
use crate::recording::unreadable;
use crate::rows::Rows;
use crate::tell::tell;

/// `antinode monitor`.
#[derive(Debug, Args)]
pub struct Monitor {
    /// A serial port, a file of bytes recorded from one, or `-` for standard input.
    #[arg(value_name = "PORT|FILE|-")]
    pub source: PathBuf,
    /// How estimates are printed; the columns are those of `identify`. Only a table shows the paper's methods, under their window's row.
    #[arg(long, visible_alias = "format", value_enum, default_value_t = Format::Table, value_name = "FORMAT")]
    pub output: Format,
    /// Speed of the port, baud (bits a second; 8N1). Files and standard input have none.
    #[arg(long, default_value_t = BAUD, value_name = "BAUD", value_parser = clap::value_parser!(u32).range(1..))]
    pub baud: u32,
}

/// The id of the Get that greets a device.
const GREETING: u16 = 0;

/// Shortest time between messages about damage, which is all that comes at a wrong baud rate, and about reports lost on a slow line.
const MESSAGE_INTERVAL: Duration = Duration::from_secs(1);

/// Silence of a port, from its opening on, after which a message says so.
const SILENCE: Duration = Duration::from_secs(3);

/// Prints what a device reports until its bytes end or the user interrupts.
pub fn run(options: &Monitor) -> Result<(), Failure> {
    let mut greeting = [0; MAX_FRAME];
    let get = CommandFrame {
        id: GREETING,
        command: Command::Get,
    };
    let greeting = frame(&get, &mut greeting).unwrap_or(&[]);
    let source = Source::open(&options.source, options.baud, greeting)?;
    let out = BufWriter::new(io::stdout().lock());
    let mut screen = Screen {
        rows: Rows::new(out, options.output, false),
        name: source.name.clone(),
        receiver: Receiver::new(),
        estimates: 0,
        bytes: 0,
        // A port may be opened in the middle of a frame; a file is taken to begin with one.
        is_within_frame: source.is_port,
        excused: 0,
        damage: None,
        told: Instant::now(),
        lost: 0,
        lost_told: None,
    };
    let begin = Instant::now();
    let result = follow(&source, &mut screen);
    screen.end(begin.elapsed());
    result?;
    if screen.receiver.reports() > 0 {
        return Ok(());
    }
    let Screen { name, bytes, .. } = screen;
    if bytes == 0 {
        return Err(Failure::Fault(format!(
            "{name}: no bytes were received; check that the device runs and is wired, or that its bytes were saved or sent"
        )));
    }
    let remedy = if source.is_port {
        format!("check --baud (it was {}), the wiring", options.baud)
    } else {
        "check that the bytes are a device's telemetry (samples are for `antinode identify`), that they were received at the device's baud \
         rate (--baud applies to ports only)"
            .to_owned()
    };
    Err(Failure::Fault(format!(
        "{name}: no telemetry in {bytes} bytes; {remedy}, and that firmware and command use the same protocol version"
    )))
}

/// Takes input until it ends.
fn follow(source: &Source, screen: &mut Screen<impl Write>) -> Result<(), Failure> {
    let first = source.is_port.then(|| first(source)).flatten();
    for input in first.into_iter().chain(&source.input) {
        match input {
            Input::Bytes(bytes) => screen.take(&bytes)?,
            Input::End => {
                screen.finish();
                break;
            }
            // An unfinished frame is no damage here: it would have gone on.
            Input::Interrupted => break,
            Input::Fault(error) => {
                screen.finish();
                let name = &screen.name;
                return Err(if source.is_port {
                    port::gone(name, &error)
                } else {
                    unreadable(name, error)
                });
            }
        }
    }
    Ok(())
}

/// The first input from a port within [`SILENCE`]; `None`, and a message, if there is none.
fn first(source: &Source) -> Option<Input> {
    match source.input.recv_timeout(SILENCE) {
        Ok(input) => Some(input),
        Err(_) => {
            tell(format_args!(
                "silent: nothing was received from {} yet; check that the device runs, its wiring, and that this is its port",
                source.name
            ));
            None
        }
    }
}

/// The output for the user: rows on standard output, all else on standard error.
struct Screen<W: Write> {
    rows: Rows<W>,
    name: String,
    receiver: Receiver,
    estimates: u64,
    bytes: u64,
    /// True until the first frame ends, if the bytes may begin in the middle of one.
    is_within_frame: bool,
    /// Damage that is not counted: the frame in whose middle the bytes began.
    excused: u64,
    /// Damage that is not yet reported: how often, and the last.
    damage: Option<(u64, Damage)>,
    /// When damage was last reported.
    told: Instant,
    /// The number of lost reports that are not yet reported.
    lost: u64,
    /// When lost reports were last reported.
    lost_told: Option<Instant>,
}

impl<W: Write> Screen<W> {
    fn take(&mut self, bytes: &[u8]) -> Result<(), Failure> {
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
                    if self.told.elapsed() >= MESSAGE_INTERVAL {
                        self.tell_damage();
                    }
                }
                Ok(report) => {
                    self.tell_damage();
                    self.lost += self.receiver.lost() - lost;
                    if self
                        .lost_told
                        .is_none_or(|told| told.elapsed() >= MESSAGE_INTERVAL)
                    {
                        self.tell_lost();
                    }
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
        self.told = Instant::now();
    }

    fn tell_lost(&mut self) {
        let lost = mem::take(&mut self.lost);
        if lost > 0 {
            tell(format_args!("lost: {lost} before the next report"));
            self.lost_told = Some(Instant::now());
        }
    }

    /// Ends the bytes: an unfinished frame is damaged.
    fn finish(&mut self) {
        if let Some(damage) = self.receiver.finish() {
            self.damaged(damage);
        }
    }

    /// Reports what is not yet reported, and the totals.
    fn end(&mut self, time: Duration) {
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

//! `antinode monitor`: prints what a device reports, as it comes.

use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::sync::mpsc::RecvTimeoutError;
use std::time::{Duration, Instant};

use antinode_telemetry::{Command, CommandFrame, MAX_FRAME, frame};
use clap::Args;

use super::screen::{GREETING, Screen};
use super::source::{Input, Source};
use super::{BAUD, port};
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

/// Silence of a port, from its opening on, after which a message says so.
const FIRST_SILENCE: Duration = Duration::from_secs(3);

/// The same once something has come: a device sends counters each second.
const SILENCE: Duration = Duration::from_secs(10);

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
    // A port may be opened in the middle of a frame; a file is taken to begin with one.
    let rows = Rows::new(out, options.output, false);
    let mut screen = Screen::new(rows, &source.name, source.is_port);
    let begin = Instant::now();
    let result = follow(&source, &mut screen);
    screen.end(begin.elapsed());
    result?;
    if screen.reports > 0 {
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
    let mut quiet = Quiet::default();
    loop {
        let input = if source.is_port {
            quiet.next(source)
        } else {
            source.input.recv().ok()
        };
        let Some(input) = input else {
            break;
        };
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

/// How a port is listened to: its silence is told of once, and so is that silence's end.
#[derive(Default)]
struct Quiet {
    /// When the last input came.
    last: Option<Instant>,
}

impl Quiet {
    /// The next input from a port; `None` if none can come any more.
    fn next(&mut self, source: &Source) -> Option<Input> {
        let name = &source.name;
        let patience = self.last.map_or(FIRST_SILENCE, |_| SILENCE);
        let input = match source.input.recv_timeout(patience) {
            Err(RecvTimeoutError::Timeout) => {
                tell(match self.last {
                    None => format!(
                        "silent: nothing was received from {name} yet; check that the device runs, its wiring, and that this is its port"
                    ),
                    Some(_) => format!(
                        "silent: nothing was received from {name} for {} s; check that the device still runs, and its wiring",
                        SILENCE.as_secs()
                    ),
                });
                let input = source.input.recv().ok()?;
                if let (Some(last), Input::Bytes(_)) = (self.last, &input) {
                    let silence = last.elapsed().as_secs();
                    tell(format_args!("silent: no longer, after {silence} s"));
                }
                input
            }
            input => input.ok()?,
        };
        self.last = Some(Instant::now());
        Some(input)
    }
}

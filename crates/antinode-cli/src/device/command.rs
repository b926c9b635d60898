//! `antinode command`: one command to a device, and its answer.

use std::io::{self, Write};
use std::path::PathBuf;
use std::time::Duration;

use antinode::Calibration;
use antinode_telemetry::Command;
use clap::{Args, Subcommand, ValueEnum, value_parser};

use super::line::Line;
use super::{BAUD, describe};
use crate::digits::counted;
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
    #[arg(long, global = true, default_value_t = 2.0, value_name = "SECONDS", value_parser = |text: &str| ranges::within(text, 0.01, 3600.0, " s"))]
    pub timeout: f64,
    /// What the device is to do.
    #[command(subcommand)]
    pub ask: Ask,
}

/// What can be asked of a device.
#[derive(Debug, Subcommand)]
pub enum Ask {
    /// Prints the device's version and configuration.
    Get,
    /// Changes the length of a window.
    #[command(allow_negative_numbers = true)]
    Window {
        /// Periods per window, 2 or more; the device refuses too many.
        #[arg(value_name = "PERIODS", value_parser = value_parser!(u16).range(2..))]
        periods: u16,
    },
    /// Changes the step from the start of one window to the start of the next.
    #[command(allow_negative_numbers = true)]
    Hop {
        /// Blocks, 1 or more; `none`: windows follow each other without gap or overlap.
        #[arg(id = "blocks", value_name = "BLOCKS|none", value_parser = hop)]
        command: Command,
    },
    /// Changes the calibration of the pick-offs; what is not given stays as it is.
    #[command(allow_negative_numbers = true, arg_required_else_help = true)]
    Calibration {
        /// Gain of pick-off D over that of C, 0.1 to 10.
        #[arg(long, value_name = "RATIO", value_parser = ranges::gain_ratio)]
        gain_ratio: Option<f32>,
        /// How much later pick-off D is sampled than C, ns, within ±1000000.
        #[arg(long, value_name = "NS", value_parser = ranges::skew_ns)]
        skew_ns: Option<f32>,
        /// Pick-off D stands at 45° plus this angle from C, rad, within ±0.3.
        #[arg(long, value_name = "RAD", value_parser = ranges::pick_off_angle)]
        pick_off_angle: Option<f32>,
    },
    /// Changes what is known of the wave's frequency.
    #[command(allow_negative_numbers = true)]
    Frequency {
        /// The frequency, Hz, if it is known within 5 %; `search`: it is searched for.
        #[arg(id = "hertz", value_name = "HZ|search", value_parser = frequency)]
        command: Command,
    },
    /// Turns the allowance for mains hum or a wandering offset on or off.
    Hum {
        /// Whether it is allowed for.
        #[arg(value_enum)]
        switch: Switch,
    },
    /// Turns the allowance for noise that is not white, as behind a tuned front end, on or off.
    Coloured {
        /// Whether it is allowed for.
        #[arg(value_enum)]
        switch: Switch,
    },
    /// Turns reports of the paper's four methods, beside every estimate, on or off.
    Methods {
        /// Whether the methods are reported.
        #[arg(value_enum)]
        switch: Switch,
    },
    /// Resets the device.
    Restart,
}

/// On or off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Switch {
    /// It is.
    On,
    /// It is not.
    Off,
}

impl Switch {
    fn is_on(self) -> bool {
        self == Self::On
    }
}

fn hop(text: &str) -> Result<Command, String> {
    let blocks = match (text, text.parse()) {
        ("none", _) => None,
        (_, Ok(blocks @ 1..)) => Some(blocks),
        _ => return Err("it must be 1 to 65535 blocks, or none".to_owned()),
    };
    Ok(Command::SetHop { blocks })
}

fn frequency(text: &str) -> Result<Command, String> {
    let hertz = match text {
        "search" => None,
        _ => Some(ranges::positive(text).map_err(|error| format!("{error}, or search"))?),
    };
    Ok(Command::SetFrequency { hertz })
}

/// Sends a command and prints the answer.
pub fn run(options: &Options) -> Result<(), Failure> {
    let patience = Duration::from_secs_f64(options.timeout);
    let mut line = Line::open(&options.port, options.baud, patience)?;
    let command = match options.ask {
        Ask::Get => {
            let hello = describe::hello(&line.hello()?);
            return Ok(writeln!(io::stdout(), "{hello}")?);
        }
        Ask::Window { periods } => Command::SetWindow { periods },
        Ask::Hop { command } | Ask::Frequency { command } => command,
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
        Ask::Hum { switch } => Command::SetHum { on: switch.is_on() },
        Ask::Coloured { switch } => Command::SetColoured { on: switch.is_on() },
        Ask::Methods { switch } => Command::SetMethods { on: switch.is_on() },
        Ask::Restart => Command::Restart,
    };
    line.ask(command, false)?;
    Ok(writeln!(io::stdout(), "{}: done", words(&command))?)
}

/// A command as the user would name it.
fn words(command: &Command) -> String {
    let switched = |name: &str, on: bool| format!("{name} {}", if on { "on" } else { "off" });
    match command {
        Command::Get => "get".to_owned(),
        Command::SetWindow { periods } => format!("window of {periods} periods"),
        Command::SetHop { blocks: None } => "no hop".to_owned(),
        Command::SetHop {
            blocks: Some(blocks),
        } => format!("hop of {}", counted((*blocks).into(), "block")),
        Command::SetCalibration(c) => format!(
            "calibration: gain ratio {}, skew {} ns, pick-off angle {} rad",
            c.gain_ratio,
            describe::nanoseconds(c.skew),
            c.pick_off_angle
        ),
        Command::SetFrequency { hertz: None } => "search for the frequency".to_owned(),
        Command::SetFrequency { hertz: Some(hertz) } => format!("frequency {hertz} Hz"),
        Command::SetHum { on } => switched("hum", *on),
        Command::SetColoured { on } => switched("coloured noise", *on),
        Command::SetMethods { on } => switched("methods", *on),
        Command::Restart => "restart".to_owned(),
    }
}

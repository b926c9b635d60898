//! The `antinode` command.

// They panic if their stream is closed or full.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod arguments;
mod calibrate;
mod canvas;
mod completions;
mod demonstration;
mod device;
mod digits;
mod failure;
mod given_rows;
mod identify;
mod interrupt;
mod median;
mod methods;
mod options;
mod plot;
mod progress;
mod ranges;
mod recording;
mod resonator;
mod result_file;
mod row_file;
mod rows;
mod runs;
mod serialized;
mod simulate;
mod stream_file;
mod study;
mod tell;
mod whole_file;

use std::env;
use std::process::ExitCode;

use clap::Parser;
use failure::Failure;
use options::{Command, Options};
use tell::tell;

fn main() -> ExitCode {
    let arguments = env::args_os().flat_map(|argument| {
        // A Windows shell does not expand `*.wav`: the program must.
        if cfg!(windows) {
            arguments::matches(argument)
        } else {
            vec![argument]
        }
    });
    let arguments = arguments.map(arguments::written_out);
    let result = match Options::try_parse_from(arguments) {
        Ok(options) => run(options.command),
        Err(error) if error.use_stderr() => error.exit(),
        // Clap's own way of printing it loses that nothing could be written.
        Err(help) => help.print().map_err(Failure::from),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            let message = failure.to_string();
            if !message.is_empty() {
                tell(format_args!("error: {message}"));
            }
            ExitCode::from(failure.code())
        }
    }
}

/// Runs a subcommand; without one, the demonstration.
fn run(command: Option<Command>) -> Result<(), Failure> {
    match command {
        None => demonstration::run(),
        Some(Command::Identify(options)) => identify::run(&options),
        Some(Command::Calibrate(options)) => calibrate::run(&options),
        Some(Command::Resonator(options)) => resonator::run(&options),
        Some(Command::Plot(options)) => plot::run(&options),
        Some(Command::Simulate(options)) => simulate::run(&options),
        Some(Command::Study(options)) => study::run(&options),
        Some(Command::Monitor(options)) => device::monitor::run(&options),
        Some(Command::Send(options)) => device::command::run(&options),
        Some(Command::Completions(options)) => completions::run(&options),
    }
}

//! `antinode completions`: what a shell needs to complete the command line.

use std::io::{self, Write};

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use crate::failure::Failure;
use crate::options::Options;

/// Which shell.
#[derive(Debug, Args)]
pub struct Completions {
    /// The shell.
    #[arg(value_enum)]
    pub shell: Shell,
}

/// Prints the shell's script.
pub fn run(options: &Completions) -> Result<(), Failure> {
    // By way of memory: a pipe that closes is no panic.
    let mut script = Vec::new();
    clap_complete::generate(
        options.shell,
        &mut Options::command(),
        "antinode",
        &mut script,
    );
    Ok(io::stdout().write_all(&script)?)
}

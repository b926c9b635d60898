//! The antinode command.

#[allow(
    dead_code,
    unused_imports,
    reason = "the command that uses it is yet to come"
)]
mod recording;

fn main() {}

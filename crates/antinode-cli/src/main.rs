//! The antinode command.
fn main() {}

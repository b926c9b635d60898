//! The protocol as both of its ends use it. One program, as each would take as long to build as to run.

mod any;
mod messages;
mod noise;
mod numbers;
mod wire;

//! A gyro controller at the other end of a serial line.

pub mod command;
mod course;
mod describe;
mod line;
pub mod monitor;
mod port;
mod screen;
mod source;

/// Default speed of a port, baud: ST-LINK's virtual port and every USB bridge have it, and it carries 800 estimates a second.
const BAUD: u32 = 921_600;

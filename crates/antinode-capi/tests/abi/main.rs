//! What the header says of each function, in both arithmetics, with the core's rows beside it.

mod calibration;
mod core_rows;
mod gyro;
mod limits;
mod mistakes;
mod search;
mod settings;
mod skip;
mod states;
mod two_sides;
mod ways;

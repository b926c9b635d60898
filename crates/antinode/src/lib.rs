//! Streaming identification of the standing wave of a hemispherical resonator gyro.
#![no_std]
#[cfg(test)]
extern crate std;
pub mod algorithm4;
pub mod block;
pub mod calibration;
pub mod estimate;
pub mod front;
pub mod identifier;
pub mod period;
pub mod phase;
pub mod settings;
pub mod tracker;
mod wave;
mod window;

//! Streaming identification of the standing wave of a hemispherical resonator gyro, or any two-mode Coriolis vibratory gyro.
#![no_std]

#[cfg(test)]
extern crate std;

pub mod algorithm4;
pub mod block;
pub mod period;
pub mod phase;

mod calibration;
mod estimate;
mod front;
mod identifier;
mod settings;
mod tracker;
mod wave;
mod window;

pub use block::{Block, Pair};
pub use calibration::Calibration;
pub use estimate::{Estimate, Flags};
pub use front::Front;
pub use identifier::Identifier;
pub use settings::{Detection, Settings, SettingsError};
pub use tracker::Tracker;

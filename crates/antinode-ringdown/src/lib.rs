//! What identified ring-downs say of the gyro: quality factor and splits of its resonator, and the calibration of its pick-offs.
//!
//! While a wave rings down, the core gives one estimate after another. Here they are grouped into [runs](Run), in which the pattern moves
//! without a break, and a model of the whole motion is fitted to all of them by least squares, weighted by the estimates' own deviations:
//!
//! * [`resonator::Resonance`]: decay time and quality factor, the splits of damping and frequency with their angles, rotation, the mean
//!   frequency, and how damping and frequency change with time or amplitude.
//! * [`calibration::Calibration`]: gain ratio, skew and angle of pick-offs that are not ideal, from a pattern that turned.
//!
//! Every result has its standard deviation, which the tests compare with rms errors over seeded random noise. `antinode resonator` and
//! `antinode calibrate` are these two at the command line.
//!
//! # Example
//! ```
//! use antinode::{Identifier, Settings};
//! use antinode_ringdown::Recording;
//! use antinode_ringdown::resonator::{BREAKS, MAX_TURN, Resonance};
//! use antinode_sim::{Flaws, Gyro, Wave};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A ring-down of 10 s, whose pattern the gyro's rotation turns.
//! let wave = Wave { angle_rate: 0.2, decay_rate: 0.5, damping_split: 0.02, ..Wave::default() };
//! let gyro = Gyro::new(wave, Flaws { noise: 0.01, ..Flaws::default() }, 100_000.0, 1)?;
//!
//! let mut identifier = Identifier::<f32, 200, 16>::new(Settings::new(100_000.0))?;
//! let mut recording = Recording::new("gyro 7", MAX_TURN, BREAKS);
//! for pair in gyro.take(1_000_000) {
//!     if let Some(estimate) = identifier.push(pair.map(|sample| sample as f32)) {
//!         recording.see(&estimate);
//!     }
//! }
//! let recorded = recording.end();
//!
//! let resonance = Resonance::of(&recorded.runs).ok_or("no resonator explains the rows")?;
//! let resonator = resonance.found.resonator().ok_or("the splits are not determined")?;
//! let (decay_rate, std) = resonator.decay;
//! println!("decay time {} s ± {}", 1.0 / decay_rate, std / (decay_rate * decay_rate));
//! assert!((decay_rate - 0.5).abs() < 5.0 * std);
//! let [(split, std), _] = resonator.damping_split;
//! assert!((split - 0.02).abs() < 5.0 * std);
//! # Ok(())
//! # }
//! ```

mod line;
mod normal;
mod runs;

pub mod calibration;
pub mod resonator;

pub use runs::{BEYOND_NOISE, MIN_ROWS, Recording, Row, Run, Runs, Window, turn};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

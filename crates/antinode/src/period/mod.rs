//! Detectors of a wave's period from cold, formulas (9) and (10): a [`Front`](crate::Front) searches with them; they also work alone.
//!
//! # Example
//!
//! ```
//! use antinode::period::DifferenceDetector;
//!
//! let mut detector = DifferenceDetector::<f32>::new();
//! let signal = |k: u32| (core::f32::consts::TAU / 18.75 * k as f32).sin();
//! let period = (0..200).find_map(|k| detector.push([signal(k), 0.5 * signal(k)]));
//! assert!((period.unwrap() - 18.75).abs() < 0.1);
//! ```

mod attempt;
mod difference;
#[cfg(feature = "mean-return")]
mod mean_return;
mod octave;
mod rests;
mod trial;

pub use difference::DifferenceDetector;
#[cfg(feature = "mean-return")]
pub use mean_return::MeanReturnDetector;
pub(crate) use octave::{FRAME, LAGS, Lags};

/// Periods that a detector accepts, in samples: 4 to 200 with a little margin.
const PERIODS: core::ops::RangeInclusive<f32> = 3.9..=210.0;

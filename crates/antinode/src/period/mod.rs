//! The period of a wave from cold, formulas (9) and (10).

mod attempt;
mod confirm;
mod difference;
#[cfg(feature = "mean-return")]
mod mean_return;
mod octave;

pub use difference::DifferenceDetector;
#[cfg(feature = "mean-return")]
pub use mean_return::MeanReturnDetector;
pub(crate) use octave::{FRAME, LAGS, Lags};

/// Periods found, in samples: 4 to 200 and a little more.
const PERIODS: core::ops::RangeInclusive<f32> = 3.9..=210.0;

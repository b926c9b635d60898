//! The period of a wave from cold, formulas (9) and (10).

mod attempt;
mod confirm;
mod difference;
#[cfg(feature = "mean-return")]
mod mean_return;

pub use difference::DifferenceDetector;
pub(crate) use difference::{FRAME, LAGS, Lags};
#[cfg(feature = "mean-return")]
pub use mean_return::MeanReturnDetector;

/// Periods found, in samples: 4 to 200 and a little more.
const PERIODS: core::ops::RangeInclusive<f32> = 3.9..=210.0;

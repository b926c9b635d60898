//! Block sums become a window's waves.

mod examine;
mod fit;
mod model;
mod normal;
mod response;
mod seen;
mod waves;

pub(crate) use fit::{Blocks, CARRIER_REACH, Fit, Last, Start, solve};
pub(crate) use model::Model;
pub(crate) use normal::Normal;
pub(crate) use seen::{Extremes, Seen};

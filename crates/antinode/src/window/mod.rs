//! Turns the block sums of a window into its waves.

mod course;
mod examine;
mod fit;
mod gathered;
mod gradient;
mod hum;
mod image;
mod model;
mod normal;
mod prediction;
mod response;
mod seen;
mod third;
mod waves;

pub(crate) use examine::Remains;
pub(crate) use fit::{Fit, solve};
pub(crate) use gathered::Gathered;
pub(crate) use model::Model;
pub(crate) use normal::Covariance;
pub(crate) use seen::Seen;

//! Block sums become a window's estimate.

mod fit;
mod normal;
mod response;

pub(crate) use fit::{Fit, Model, solve};
pub(crate) use normal::Normal;

//! Rows of one recording, grouped into runs: spans of time in which the pattern moves without a break.

pub(crate) mod driven;
mod jump;
mod recording;
mod repeated;
mod row;
mod run;
mod step;
pub(crate) mod way;

use std::borrow::Cow;
use std::f64::consts::FRAC_PI_2;

pub use recording::{Recording, Runs};
pub(crate) use row::BOWS;
pub use row::{Row, Window};
pub use run::Run;

/// Rms residual over the rows' own deviations, from which on there should be a warning that it is more than noise.
pub const BEYOND_NOISE: f64 = 2.0;
/// The same from which on a fit does not explain the rows.
pub(crate) const EXPLAINED: f64 = 1.5;
/// Correlation of consecutive residuals that an unnoticed overlap of windows may cause, and the deviations that chance may add.
const MAX_CORRELATION: f64 = 0.03;
const CHANCE: f64 = 5.0;
/// Fewest rows of a run, which has four unknowns of its own.
pub const MIN_ROWS: usize = 12;

/// True if a correlation of consecutive residuals, of which there are `count`, is not due to chance.
pub(crate) fn is_alike(correlation: f64, count: f64) -> bool {
    correlation > MAX_CORRELATION + CHANCE / count.sqrt()
}

/// The runs of [`MIN_ROWS`] rows or more.
pub(crate) fn long_enough(runs: &[Run]) -> Cow<'_, [Run]> {
    let is_long = |run: &&Run| run.rows.len() >= MIN_ROWS;
    if runs.iter().all(|run| is_long(&run)) {
        runs.into()
    } else {
        runs.iter().filter(is_long).cloned().collect()
    }
}

/// Change of an angle that is known modulo π/2, rad, reduced to −π/4 to π/4.
pub fn turn(change: f64) -> f64 {
    change - FRAC_PI_2 * (change / FRAC_PI_2).round()
}

/// One over 2πf, s/rad; 0, as if periods were infinitely short, where this is no frequency of a wave but stands for one unknown.
pub(crate) fn per_radian(omega: f64) -> f64 {
    if omega.abs() < 1.0 { 0.0 } else { 1.0 / omega }
}

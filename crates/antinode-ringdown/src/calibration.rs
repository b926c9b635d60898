//! The calibration of pick-offs, from rows of a pattern that turned.

mod equations;
mod moments;
mod pick_offs;
mod shares;
mod solve;
mod undriven;
mod within_period;

use crate::runs::{BEYOND_NOISE, Run, long_enough};
pub use pick_offs::PickOffs;
use solve::solve;
pub use solve::{Decay, Error, Found, MIN_TURN_BACK};
use undriven::{moments, without_driven};

/// Turn of the pattern from row to row, at most, rad: sums over time then agree with integrals to 2 %.
pub const MAX_TURN: f64 = 0.1;

/// What runs show of the pick-offs.
#[derive(Debug)]
pub struct Calibration {
    /// The runs, or their parts, in which nothing drives the wave.
    pub runs: Vec<Run>,
    /// The others, which are left out.
    pub driven: Vec<Run>,
    /// The pick-offs.
    pub found: Found,
}

impl Calibration {
    /// Finds the pick-offs with which energy and quadrature of these runs run evenly. Their rows were identified with the calibration
    /// `corrected`, and the pattern turns by [`MAX_TURN`] or less from row to row. Runs of fewer than [`MIN_ROWS`](crate::MIN_ROWS) rows are
    /// ignored.
    ///
    /// # Errors
    /// If the pattern turns too little in every run, and if no pick-offs explain the rows.
    pub fn of(runs: &[Run], corrected: PickOffs) -> Result<Self, Error> {
        let runs = long_enough(runs);
        let every = moments(&runs, &corrected);
        let all = solve(&every, corrected);
        let (start, residual) = match &all {
            Ok(found) => (found.pick_offs, found.residual),
            // Driven rows may spoil it so far that there is none.
            Err(_) => (corrected, f64::INFINITY),
        };
        if residual > BEYOND_NOISE
            && let Some((found, [runs, driven])) =
                without_driven(&runs, &every, &corrected, (start, residual))
        {
            return Ok(Self {
                runs,
                driven,
                found,
            });
        }
        Ok(Self {
            runs: runs.into_owned(),
            driven: Vec::new(),
            found: all?,
        })
    }
}

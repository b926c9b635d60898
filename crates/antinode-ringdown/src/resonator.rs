//! The resonator that runs share: its quality factor, its splits of damping and frequency, and its mean frequency.

mod by_energy;
mod changing;
mod chords;
mod curve;
mod drift;
mod fit;
mod found;
mod frequency;
mod gaps;
mod informing;
mod joined;
mod model;
pub(crate) mod motion;
mod normal;
mod rests;
mod start;
mod stretches;

use std::f64::consts::FRAC_PI_8;

use antinode::Flags;

use crate::runs::driven::undriven;
use crate::runs::{BEYOND_NOISE, Run, long_enough};
pub use by_energy::ByEnergy;
use fit::fit;
pub use found::{Found, Measured, Resonator};
pub use frequency::Frequency;
use frequency::frequency;
pub use informing::DECAY_SEEN;
pub use model::Damping;

/// Turn of the pattern from row to row, at most, rad: half of that up to which the angle is unambiguous.
pub const MAX_TURN: f64 = FRAC_PI_8;
/// Flags of rows that end a run: the wave was excited anew, or samples are missing.
pub const BREAKS: Flags = Flags::REACQUIRED.with(Flags::PHASE_JUMP).with(Flags::STEP);
/// Relative change of an amplitude per radian that the pattern turns, which is no drive: a gain ratio that is 30 % off causes it.
const BY_FLAWS: f64 = 0.6;
/// Rows that may be driven are left out if the residual of the others is that of noise, or below this share of that of all.
const MAX_RESIDUAL_SHARE: f64 = 0.05;
/// Deviations from which on a change is not due to chance.
const SIGNIFICANT: f64 = 5.0;

/// What runs of one resonator show.
#[derive(Debug)]
pub struct Resonance {
    /// The runs, or their parts, in which nothing drives the wave; never none.
    pub runs: Vec<Run>,
    /// The others, which are left out.
    pub driven: Vec<Run>,
    /// Damping and splits.
    pub found: Found,
    /// The mean frequency.
    pub frequency: Frequency,
}

impl Resonance {
    /// Finds the resonator whose waves come nearest to the rows of these runs, in which the pattern turns by [`MAX_TURN`] or less from row
    /// to row. Runs of fewer than [`MIN_ROWS`](crate::MIN_ROWS) rows are ignored; `None` without others, and if no resonator explains them.
    pub fn of(runs: &[Run]) -> Option<Self> {
        let runs = long_enough(runs);
        if runs.is_empty() {
            return None;
        }
        let (found, [mut runs, driven]) = decaying(&runs);
        let found = found?;
        Some(Self {
            frequency: frequency(&mut runs, &found),
            runs,
            driven,
            found,
        })
    }
}

/// The fit to the rows in which nothing drives the wave, with their runs and the driven ones.
///
/// What flaws of pick-offs may add to a wave's energy while its pattern turns hides that it is held. So if more than noise is left, driven
/// rows are sought as if there were no flaws, and left out if the others then agree far better.
fn decaying(runs: &[Run]) -> (Option<Found>, [Vec<Run>; 2]) {
    let energies: Vec<_> = runs.iter().map(Run::energies).collect();
    let parts = undriven(runs, &energies, BY_FLAWS);
    let found = fit(&parts[0]);
    let residual = found.as_ref().map_or(f64::INFINITY, |found| found.residual);
    if residual < BEYOND_NOISE {
        return (found, parts);
    }
    let fewer = undriven(runs, &energies, 0.0);
    if fewer[0].is_empty() || fewer[1].len() == parts[1].len() {
        return (found, parts);
    }
    // A damping that changes explains what flaws leave of fewer rows too.
    let better = fit(&fewer[0]).filter(|better| {
        better.is_damping_steady()
            && better.residual < BEYOND_NOISE.max(MAX_RESIDUAL_SHARE * residual)
    });
    match better {
        Some(better) => (Some(better), fewer),
        None => (found, parts),
    }
}

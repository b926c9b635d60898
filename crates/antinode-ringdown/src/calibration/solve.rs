//! Fits a calibration to runs, by least squares.
//!
//! While a pattern turns and decays, its energy E = a_A² + a_B² decays evenly and its quadrature Q = 2 a_A a_B keeps its share of it,
//! wherever the pattern stands. What flawed pick-offs show swings with the angle instead: with R = (a_A² − a_B²) cos 4θ and
//! S = (a_A² − a_B²) sin 4θ, a gain of D moves ln E by −R/E, a turned pick-off by −2S/E, and a skew moves Q/E by S/E.
//!
//! A resonator whose damping or frequency differs along two axes has a similar effect, but by the integrals of R/E and S/E over time, which
//! change sign with the direction of turning: turned both ways, the two are distinguishable.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_8};

use nalgebra::DVector;

use super::equations::{Equation, by_integrals, equations};
use super::moments::Run;
use super::pick_offs::PickOffs;
use crate::normal::{Equations, Factors};
use crate::runs::{BEYOND_NOISE, EXPLAINED, is_alike};

/// Unknowns of the pick-offs: ln g, 2πf·Δ and ε.
pub const FLAWS: usize = 3;
/// Unknowns of the resonator: its splits of damping and of frequency, each along two axes.
pub const SPLITS: usize = 4;
/// Unknowns of a run: ln E and Q/E at its middle, and their slopes.
const OWN: usize = 4;
/// Deviations from which on a damping that changes is significant.
const SEEN: f64 = 5.0;
/// Turn that is needed, at least, rad: 4θ goes around once.
const MIN_TURN: f64 = FRAC_PI_2;
/// Turn the other way, at least, rad, with which splits are distinguishable from flaws: a quarter turn of 4θ.
pub const MIN_TURN_BACK: f64 = FRAC_PI_8;
/// Steps, at most; four are enough if the pick-offs are nearly ideal.
const STEPS: usize = 50;
/// Length of a step, at most, in ln g and rad: the way from an ideal pick-off to one with a tenth of its gain is not straight.
const MAX_STEP: f64 = 0.3;
/// Step below which the search has converged, whatever the noise.
const SETTLED: f64 = 1e-10;

/// How ln E falls in a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decay {
    /// Along a straight line: the damping is steady.
    Straight,
    /// Along a parabola, as the damping changes steadily; its bend is the last unknown of the run.
    Bent,
}

impl Decay {
    /// Number of unknowns of a run.
    pub(super) fn own(self) -> usize {
        OWN + usize::from(self == Self::Bent)
    }

    /// The place of a run's bend, if it is an unknown, for that of its first unknown.
    pub(super) fn bend_at(self, own: usize) -> Option<usize> {
        (self == Self::Bent).then_some(own + OWN)
    }
}

/// The result of the fit.
#[derive(Debug)]
pub struct Found {
    /// The pick-offs.
    pub pick_offs: PickOffs,
    /// One standard deviation each of gain ratio, skew and angle.
    pub deviations: [f64; 3],
    /// The rms residual over the rows' own deviations: 1 in noise alone.
    pub residual: f64,
    /// Correlation of consecutive rows' residuals, and the number of these.
    alike: f64,
    count: f64,
    /// How ln E falls, and the deviations by which it is bent in a run, at most.
    pub decay: Decay,
    bent: f64,
    /// True if the resonator's splits are among the unknowns.
    pub knows_splits: bool,
    /// Largest turns within a run, rad: backwards, at most 0, and forwards, at least 0.
    pub turned: [f64; 2],
}

impl Found {
    /// True if residuals of consecutive rows are correlated beyond chance.
    pub fn is_alike(&self) -> bool {
        is_alike(self.alike, self.count)
    }

    /// True if so much more than noise is left that there should be a warning.
    pub fn is_beyond_noise(&self) -> bool {
        self.residual > BEYOND_NOISE || self.is_alike()
    }
}

/// Why there is no calibration.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The pattern turns too little.
    #[error(
        "the pattern turns by only {:.1}°, but must turn by 90° or more: turn the gyro while it rings down; if it did turn that far, shorten \
         the windows, as the pattern must turn by less than {:.1}° from row to row",
        turned.to_degrees(), super::MAX_TURN.to_degrees()
    )]
    TurnsTooLittle {
        /// Largest turn within a run, rad.
        turned: f64,
    },
    /// The steps do not converge.
    #[error(
        "no calibration explains the rows: check that S_C and S_D are the pick-offs, and that only the gyro's rotation moves the pattern"
    )]
    Unsettled,
}

/// Finds the calibration with which energy and quadrature run evenly; the search begins at `start`. If the damping is seen to change, this
/// is allowed for: flaws of pick-offs would look like it. Fails with what is wrong with the rows.
pub fn solve(runs: &[Run], start: PickOffs) -> Result<Found, Error> {
    let straight = search(runs, Decay::Straight, start)?;
    let bent = search(runs, Decay::Bent, straight.pick_offs);
    let is_seen = |found: &Found| found.bent > SEEN && found.residual < EXPLAINED;
    Ok(bent.ok().filter(is_seen).unwrap_or(straight))
}

/// The same if ln E falls like this.
fn search(runs: &[Run], decay: Decay, start: PickOffs) -> Result<Found, Error> {
    let turned = runs.iter().fold([0f64; 2], |[back, forth], run| {
        [back.min(run.turns[0]), forth.max(run.turns[1])]
    });
    let [back, forth] = turned.map(f64::abs);
    if back.max(forth) < MIN_TURN {
        return Err(Error::TurnsTooLittle {
            turned: back.max(forth),
        });
    }
    let knows_splits = back.min(forth) >= MIN_TURN_BACK;
    let rows: usize = runs.iter().map(|run| run.moments.len()).sum();
    let count = (2 * rows) as f64;
    let mut pick_offs = start;
    let mut splits = knows_splits.then_some([0.0; SPLITS]);
    for _ in 0..STEPS {
        let normal = Normal::of(runs, &pick_offs, decay, splits);
        let unknowns = normal.equations.unknowns();
        let Some(factors) = normal.equations.factors(0.0) else {
            return Err(Error::Unsettled);
        };
        let step = factors.solve(normal.equations.right());
        let omega = normal.omega;
        let part = (MAX_STEP / step.rows(0, FLAWS).amax()).min(1.0);
        if let Some(splits) = &mut splits {
            splits.copy_from_slice(step.rows(FLAWS, SPLITS).as_slice());
        }
        pick_offs.gain_ratio *= (part * step[0]).exp();
        pick_offs.skew += part * step[1] / omega;
        pick_offs.angle += part * step[2];
        let is_plausible = pick_offs.gain_ratio.is_finite() && pick_offs.angle.abs() < 0.7;
        if !is_plausible {
            return Err(Error::Unsettled);
        }
        if (0..FLAWS).all(|i| step[i].abs() < SETTLED) {
            // Residual after the step, per degree of freedom.
            let residual_squares = (normal.squares - normal.equations.right().dot(&step)).max(0.0);
            let residual = (residual_squares / (count - unknowns as f64)).sqrt();
            let neighbours = neighbours(runs, &pick_offs, decay, splits, &step);
            let variances =
                variances_of_flaws(runs, &pick_offs, decay, (&factors, unknowns), splits);
            let widening = residual.max(1.0);
            let deviation = |i: usize| variances[i].sqrt() * widening;
            let bent =
                |at: usize| step[at].abs() / (factors.variance(&[(at, 1.0)]).sqrt() * widening);
            let own = decay.own();
            let firsts = (unknowns - own * runs.len()..unknowns).step_by(own);
            let bends = firsts.filter_map(|first| decay.bend_at(first));
            return Ok(Found {
                pick_offs,
                deviations: [
                    pick_offs.gain_ratio * deviation(0),
                    deviation(1) / omega,
                    deviation(2),
                ],
                residual,
                // Correlation of residuals far below the rows' own deviations does no harm.
                alike: neighbours / residual_squares.max(count),
                count,
                decay,
                bent: bends.map(bent).fold(0.0, f64::max),
                knows_splits,
                turned,
            });
        }
    }
    Err(Error::Unsettled)
}

/// Variances of the flaws if the splits are these, noise in the integrals included.
fn variances_of_flaws(
    runs: &[Run],
    pick_offs: &PickOffs,
    decay: Decay,
    (factors, unknowns): (&Factors, usize),
    splits: Option<[f64; SPLITS]>,
) -> [f64; FLAWS] {
    let mut variances = [0, 1, 2].map(|flaw| factors.variance(&[(flaw, 1.0)]));
    if let Some(splits) = splits {
        let unit = |flaw| DVector::from_fn(unknowns, |at, _| f64::from(u8::from(at == flaw)));
        let of_flaws = [0, 1, 2].map(|flaw| factors.solve(&unit(flaw)));
        let longest = longest(runs);
        for run in runs.iter().enumerate() {
            let shared = FLAWS + SPLITS;
            let moments = equations(run, pick_offs, decay, shared, splits, longest);
            let more = by_integrals(moments, splits, &of_flaws);
            for (variance, more) in variances.iter_mut().zip(more) {
                *variance += more;
            }
        }
    }
    variances
}

/// Length of the longest run, s.
fn longest(runs: &[Run]) -> f64 {
    let span = |run: &Run| run.moments[run.moments.len() - 1].time - run.moments[0].time;
    runs.iter().map(span).fold(0.0, f64::max)
}

/// The normal equations of all runs, about a calibration.
struct Normal {
    equations: Equations,
    /// Weighted sum of the squares of the values to be explained.
    squares: f64,
    /// Mean of 2πf, rad/s.
    omega: f64,
}

impl Normal {
    fn of(runs: &[Run], pick_offs: &PickOffs, decay: Decay, splits: Option<[f64; SPLITS]>) -> Self {
        let shared = FLAWS + splits.map_or(0, |splits| splits.len());
        let mut equations = Equations::new(shared, decay.own(), runs.len());
        let mut squares = 0.0;
        for (run, both) in in_turn(runs, pick_offs, decay, splits) {
            for Equation {
                entries,
                seen,
                weight,
            } in both
            {
                equations.add_equation(run, &entries, seen, weight);
                squares += weight * seen * seen;
            }
        }
        let omegas = runs.iter().flat_map(|run| &run.moments);
        let (count, sum) = omegas.fold((0.0, 0.0), |(count, sum), moment| {
            (count + 1.0, sum + moment.omega)
        });
        Self {
            equations,
            squares,
            omega: sum / count,
        }
    }
}

/// The equations of ln E and of Q/E of all moments, about a calibration, each with the index of its run.
fn in_turn<'a>(
    runs: &'a [Run],
    pick_offs: &'a PickOffs,
    decay: Decay,
    splits: Option<[f64; SPLITS]>,
) -> impl Iterator<Item = (usize, [Equation; 2])> + 'a {
    let shared = FLAWS + splits.map_or(0, |splits| splits.len());
    let (splits, longest) = (splits.unwrap_or_default(), longest(runs));
    runs.iter().enumerate().flat_map(move |(index, run)| {
        let moments = equations((index, run), pick_offs, decay, shared, splits, longest);
        moments.map(move |moment| (index, [moment.energy, moment.quadrature]))
    })
}

/// Sum of the products of consecutive moments' residuals, in deviations, with these values of the unknowns.
fn neighbours(
    runs: &[Run],
    pick_offs: &PickOffs,
    decay: Decay,
    splits: Option<[f64; SPLITS]>,
    unknowns: &DVector<f64>,
) -> f64 {
    let (mut sum, mut before) = (0.0, [0.0; 2]);
    for (_, both) in in_turn(runs, pick_offs, decay, splits) {
        for (equation, before) in both.iter().zip(&mut before) {
            let each = equation.entries.iter();
            let explained: f64 = each.map(|&(at, by)| by * unknowns[at]).sum();
            let rest = (equation.seen - explained) * equation.weight.sqrt();
            sum += rest * std::mem::replace(before, rest);
        }
    }
    sum
}

#[cfg(test)]
mod tests;

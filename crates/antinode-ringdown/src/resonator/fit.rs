//! Fits a resonator to runs, by least squares.
//!
//! Every row is a measurement of a_A, a_B and θ, or near a circle of both travelling waves. First each run gets a decay, a rotation and a
//! growth of quadrature of its own, which any run determines. A resonator that the runs share replaces these if they determine it: a
//! pattern at rest shows only one component of each split. If no steady rotation explains the rows, their angles are taken as they are:
//! they say where the splits act, and only the amplitudes are explained. The steps are those of Levenberg and Marquardt.

use nalgebra::DVector;
use num_complex::Complex;

use super::changing::changing;
use super::chords;
use super::found::Found;
use super::gaps;
use super::joined::joined;
use super::model::{Kind, Model};
use super::normal::Normal;
use super::start::start;
use crate::runs::{EXPLAINED, Run};

/// Spread below which all patterns count as one, and apparent differences as noise: 3° between two runs, 5° of one that turns.
const MIN_SPREAD: f64 = 0.005;
/// Steps, at most; ten are usual.
const STEPS: usize = 100;
/// The same with the turning by amplitudes: where that explains the rows, ten are enough.
const NONLINEAR_STEPS: usize = 30;
/// Reduction of the squared residual, in squares of the stated deviations, below which a step is the last: it moves by less than a
/// hundredth of one.
const SETTLED: f64 = 1e-4;
/// The same if no step reduces the residual any more, as the derivatives leave out the averaging by windows: a fifth of a deviation.
const SETTLED_WITHOUT_STEP: f64 = 4e-2;
/// Damping below which a step is as without any: from less it would take many steps to have an effect again.
const MIN_DAMPING: f64 = 1e-10;
/// Damping beyond which a step leads nowhere.
const MAX_DAMPING: f64 = 1e3;
/// Deviations of the splits of damping and of frequency below which they are determined, as shares of the damping.
const KNOWN: [f64; 2] = [0.2, 1.0];
/// The same for the split of frequency, as a share of what is seen of it.
const KNOWN_REL: f64 = 0.1;

/// Finds the resonator whose waves come nearest to the rows; `None` if the steps do not converge. Which model explains many rows, their
/// means tell.
pub fn fit(runs: &[Run]) -> Option<Found> {
    let rough = joined(runs).and_then(|joined| fit_all(&joined));
    rough
        .and_then(|rough| settled(runs, rough))
        .or_else(|| fit_all(runs))
}

/// A fit to the means of rows, settled in the rows themselves; `None` if it explains the means only.
fn settled(runs: &[Run], rough: Found) -> Option<Found> {
    let straightened = rough.model.is_unsteady().then(|| chords::through(runs));
    let runs = straightened.as_deref().unwrap_or(runs);
    let is_explained = rough.is_explained();
    let found = Found {
        unseen_turning: rough.unseen_turning,
        ..settle(runs, rough.model, rough.values)?
    };
    (found.is_explained() || !is_explained).then_some(found)
}

/// Finds the resonator with a fit to all rows.
fn fit_all(runs: &[Run]) -> Option<Found> {
    let steady = steady(runs).map(|found| changing(runs, found));
    if steady.as_ref().is_some_and(Found::is_explained) {
        return steady;
    }
    // As for a table that speeds up, ripples or goes to and fro.
    let unsteady = unsteady(runs);
    match (steady, unsteady) {
        (Some(steady), Some(unsteady)) if unsteady.explains_more(&steady) => Some(unsteady),
        (steady, unsteady) => steady.or(unsteady),
    }
}

/// The fit if only the resonator and a steady rotation turn the patterns.
fn steady(runs: &[Run]) -> Option<Found> {
    let found = |kind| found(runs, Model::steady(kind));
    let each = found(Kind::Each);
    // With a residual beyond noise, even one pattern that hardly moves shows how the splits move it.
    let is_enough = |each: &Found| {
        each.residual < EXPLAINED && (spread(runs) < MIN_SPREAD || !may_know(runs, each))
    };
    if each.as_ref().is_some_and(is_enough) {
        return each;
    }
    let known = |found: Option<Found>| found.filter(|found| found.is_known(each.as_ref()));
    let linear = known(found(Kind::Shared));
    // If γ is 0, it is no unknown: it would make all others less certain, above all rotation, which it resembles if quadrature stays. Where
    // a fit without it explains the rows, a single step shows that.
    let explained = linear.as_ref().filter(|linear| linear.is_explained());
    let stepped = explained.and_then(|linear| known(turned(runs, linear)));
    let nonlinear = if explained.is_none() || stepped.as_ref().is_some_and(Found::is_nonlinear) {
        known(found(Kind::Nonlinear))
    } else {
        stepped
    };
    let unseen_turning = nonlinear.as_ref().and_then(Found::turning_by_amplitudes);
    let linear = linear.map(|linear| Found {
        unseen_turning,
        ..linear
    });
    let nonlinear = nonlinear.filter(Found::is_nonlinear);
    nonlinear.or(linear).or(each)
}

/// A fit moved by a step in which patterns are also turned by their amplitudes.
fn turned(runs: &[Run], linear: &Found) -> Option<Found> {
    let model = Model::steady(Kind::Nonlinear);
    let values = model.values_from(linear.model, &linear.values, runs.len());
    let normal = Normal::of(runs, model, &values);
    let moved = values + normal.step(0.0)?;
    normal.conclude(model, moved)
}

/// The fit if patterns are turned unsteadily.
fn unsteady(runs: &[Run]) -> Option<Found> {
    let runs = &chords::through(runs);
    let found = |kind| found(runs, Model::steady(kind));
    let each = found(Kind::EachUnsteady);
    let shared = found(Kind::SharedUnsteady).filter(|shared| shared.is_known(each.as_ref()));
    shared.or(each).map(|found| changing(runs, found))
}

/// The fit of a model, if need be across long gaps.
pub fn found(runs: &[Run], model: Model) -> Option<Found> {
    let found = searched(runs, model);
    if !model.is_shared() || model.is_unsteady() || found.as_ref().is_some_and(Found::is_explained)
    {
        return found;
    }
    let residual = found.as_ref().map_or(f64::INFINITY, |found| found.residual);
    let across = gaps::across(runs, model).filter(|across| across.residual < residual);
    across.or(found)
}

/// The same, starting from the values that the integrals give.
pub fn searched(runs: &[Run], model: Model) -> Option<Found> {
    settle(runs, model, start(runs, model)?)
}

/// True if such runs determine splits that are small: if nothing does, a fit may find large ones, which seem to be determined.
fn may_know(runs: &[Run], each: &Found) -> bool {
    let model = Model::steady(Kind::Shared);
    let mut values = DVector::zeros(model.unknowns(runs.len()));
    for run in 0..runs.len() {
        values[model.decay_at(run)] += each.values[each.model.decay_at(run)] / runs.len() as f64;
        let from = each.values.rows(each.model.own_at(run), 4);
        values.rows_mut(model.own_at(run), 4).copy_from(&from);
    }
    let rough = Normal::of(runs, model, &values).equations.factors(0.0);
    rough.is_some_and(|rough| is_known(model, |at| rough.variance(&[(at, 1.0)]), each, Some(each)))
}

/// Spread of the rows' pattern angles, up to 1: the circular variance of 4θ, less the contribution of noise.
fn spread(runs: &[Run]) -> f64 {
    let (mut sum, mut noise, mut count) = (Complex::new(0.0, 0.0), 0.0, 0.0);
    for row in runs.iter().flat_map(|run| &run.rows) {
        sum += Complex::from_polar(1.0, 4.0 * row.angle);
        noise += 8.0 * row.deviations[2] * row.deviations[2];
        count += 1.0;
    }
    1.0 - (sum.norm() + noise) / count
}

/// True if the rows determine both splits, where `variance` is that of the unknown at a place. The decays along the patterns, in `found`,
/// are known wherever these stand.
pub(super) fn is_known(
    model: Model,
    variance: impl Fn(usize) -> f64,
    found: &Found,
    each: Option<&Found>,
) -> bool {
    let runs = found.of_runs.len();
    let decays = (0..runs).map(|run| found.decay_of_run(run).0.abs());
    let decay = decays.sum::<f64>() / runs as f64;
    let growths = each
        .iter()
        .flat_map(|each| (0..runs).map(move |run| each.values[each.model.decay_at(run) + 1].abs()));
    let growth = growths.fold(0.0, f64::max);
    let knows = |at: usize, max: f64| (at..at + 2).all(|i| variance(i) < max * max);
    let [damping, frequency] = model.splits_at();
    knows(damping, KNOWN[0] * decay) && knows(frequency, (KNOWN[1] * decay).max(KNOWN_REL * growth))
}

/// Minimises the squares of the residual, from these values on.
pub fn settle(runs: &[Run], model: Model, values: DVector<f64>) -> Option<Found> {
    let normal = Normal::of(runs, model, &values);
    settle_from(runs, model, values, normal)
}

/// The same, with the normal equations about these values.
pub fn settle_from(
    runs: &[Run],
    model: Model,
    mut values: DVector<f64>,
    mut normal: Normal,
) -> Option<Found> {
    let mut damping = 1e-4;
    let mut limit = SETTLED;
    let most = if model.kind == Kind::Nonlinear {
        NONLINEAR_STEPS
    } else {
        STEPS
    };
    for _ in 0..most {
        let whole = normal.step(0.0)?;
        if normal.equations.right().dot(&whole) < limit * normal.widening(&values) {
            let values = values + whole;
            return Normal::of(runs, model, &values).conclude(model, values);
        }
        let moved = &values + normal.step(damping)?;
        let next = Normal::of(runs, model, &moved);
        // False if it is not a number.
        if next.squares < normal.squares {
            (values, normal) = (moved, next);
            damping = (0.1 * damping).max(MIN_DAMPING);
            limit = SETTLED;
        } else {
            damping *= 10.0;
            if damping > MAX_DAMPING {
                limit = SETTLED_WITHOUT_STEP;
            }
        }
    }
    None
}

#[cfg(test)]
mod tests;

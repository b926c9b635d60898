//! Whether the damping changes from run to run, or while waves ring down, by temperature or by amplitude.

use nalgebra::DVector;

use super::SIGNIFICANT;
use super::curve::MAX_IN_TIME;
use super::fit::settle_from;
use super::found::Found;
use super::model::{Damping, Model};
use super::normal::Normal;
use crate::runs::Run;

/// Deviations from which on curves beyond the first are used: a higher limit would leave more than it spares.
const USED: f64 = 2.0;

/// This fit, or the same with a damping that changes, if that is significant, explains the rows and leaves the splits determined.
///
/// A change that takes more than a parabola in each run is taken to depend on the amplitude if that explains as much. Otherwise nothing
/// tells the two apart, and the decay of small waves would be far off.
pub fn changing(runs: &[Run], found: Found) -> Found {
    // Runs of different decay times that do not change meanwhile need no curves.
    let mut in_time = if runs.len() > 1 && found.model.is_shared() {
        changed(runs, &found, Damping::InTime(0), SIGNIFICANT).map(|(found, _)| found)
    } else {
        None
    };
    let mut is_parabola = true;
    for curves in 1..=MAX_IN_TIME {
        let from = in_time.as_ref().unwrap_or(&found);
        let least = if curves == 1 { SIGNIFICANT } else { USED };
        let Some((next, seen)) = changed(runs, from, Damping::InTime(curves), least) else {
            break;
        };
        is_parabola &= curves == 1 || seen < SIGNIFICANT;
        in_time = Some(next);
    }
    let by_energy = if is_parabola {
        None
    } else {
        changed(runs, &found, Damping::ByEnergy, SIGNIFICANT).map(|(found, _)| found)
    };
    let changed = match (in_time, by_energy) {
        (Some(in_time), Some(by_energy)) if explains_more(&in_time, &by_energy) => Some(in_time),
        (in_time, by_energy) => by_energy.or(in_time),
    };
    // If it leaves more than noise, the cause may be another: flaws of pick-offs look like damping that changes while a pattern turns.
    let is_cause = |changed: &Found| {
        changed.is_explained() && (!changed.model.is_shared() || changed.is_known(None))
    };
    changed.filter(is_cause).unwrap_or(found)
}

/// True if curves over time explain more than the energy does, beyond what chance adds with their number.
fn explains_more(in_time: &Found, by_energy: &Found) -> bool {
    let more = (in_time.values.len() - by_energy.values.len()) as f64;
    by_energy.squares() - in_time.squares() > more + SIGNIFICANT * (2.0 * more).sqrt()
}

/// A fit with this damping, starting from another, and the deviations that show it; `None` if these are not so many.
fn changed(runs: &[Run], from: &Found, damping: Damping, least: f64) -> Option<(Found, f64)> {
    let model = Model {
        damping,
        ..from.model
    };
    let values = model.values_from(from.model, &from.values, runs.len());
    let normal = Normal::of(runs, model, &values);
    let seen = seen(&normal, (model, runs.len()), &values)?;
    if seen < least {
        return None;
    }
    let found = Found {
        unseen_turning: from.unseen_turning,
        ..settle_from(runs, model, values, normal)?
    };
    Some((found, seen))
}

/// Deviations by which a step from these values moves the last unknown of a damping, at most in any run; or those of chance by which it
/// reduces the squared residual, if each run gets a decay of its own and nothing else.
fn seen(normal: &Normal, (model, runs): (Model, usize), values: &DVector<f64>) -> Option<f64> {
    let factors = normal.equations.factors(0.0)?;
    let step = factors.solve(normal.equations.right());
    let widening = normal.widening(values);
    let seen = |place: usize| {
        let variance = widening * factors.variance(&[(place, 1.0)]);
        step[place].abs() / variance.sqrt()
    };
    match model.damping {
        Damping::Steady => None,
        Damping::ByEnergy => Some(seen(model.by_energy_at())),
        Damping::InTime(0) => {
            let more = runs as f64 - 1.0;
            let less = step.dot(normal.equations.right()) / widening;
            // The cube root of χ² is nearly normal (Wilson and Hilferty, 1931), also of few unknowns.
            let spread = 2.0 / (9.0 * more);
            Some(((less / more).cbrt() - 1.0 + spread) / spread.sqrt())
        }
        Damping::InTime(curves) => {
            let last = |run| model.curves_at(run) + curves - 1;
            (0..runs).map(|run| seen(last(run))).reduce(f64::max)
        }
    }
}

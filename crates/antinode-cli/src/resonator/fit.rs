//! Runs become a resonator, by least squares.
//!
//! Every row is a measurement of a_A, a_B and θ, or near a circle of both travelling waves. First each run gets a decay, a rotation and a
//! growth of its quadrature of its own, which any run tells. The resonator that the runs share takes their place where they tell it: a
//! pattern that stands still sees one side of each split alone. Where no steady rotation explains the rows, their angles are taken as they
//! are: they tell where the splits act, and only the amplitudes are explained. The steps are those of Levenberg and Marquardt.

use nalgebra::{Complex, DVector, RowSVector, SMatrix, SVector};

use super::chords;
use super::found::{Found, OfRun, TOGETHER};
use super::gaps;
use super::model::{Model, Term};
use super::motion::PARAMETERS;
use super::start::start;
use crate::normal::Equations;
use crate::runs::Run;

/// Below this all patterns are one, and what seems to tell them apart is noise: 3° between two runs, 5° of one that turns.
const LEAST_SPREAD: f64 = 0.005;
/// Steps at most; ten do.
const STEPS: usize = 100;
/// A step that takes less than this off the squares of the residual, in squares of the stated deviations, is the last: it moves by less
/// than a hundredth of one.
const SETTLED: f64 = 1e-4;
/// The same where no step leads down any more, as the derivatives leave out what a window averages.
const SETTLED_AT_FOOT: f64 = 1e-2;
/// With more damping than this, a step leads nowhere.
const FOOT: f64 = 1e3;
/// The splits of damping and of frequency are told where their deviations are below these shares of the damping.
const TOLD: [f64; 2] = [0.2, 1.0];
/// That of frequency also where its deviation is below this share of what is seen of it.
const TOLD_SHARE: f64 = 0.1;

/// The steps do not settle.
#[derive(Debug, PartialEq)]
pub struct Unsettled;

/// Finds the resonator whose waves come nearest to the rows.
pub fn fit(runs: &[Run]) -> Result<Found, Unsettled> {
    let steady = steady(runs);
    if steady.as_ref().is_ok_and(Found::is_explained) {
        return steady;
    }
    // As a table turns that speeds up, ripples or goes to and fro.
    let turned = turned(runs);
    match (steady, turned) {
        (Ok(steady), Ok(turned)) if turned.explains_more(&steady) => Ok(turned),
        (Err(_), turned) => turned,
        (steady, _) => steady,
    }
}

/// Where nothing but the resonator and a steady rotation turns the patterns.
fn steady(runs: &[Run]) -> Result<Found, Unsettled> {
    let found = |model| found(runs, model);
    let each = found(Model::Each);
    // Beyond noise even one pattern that hardly moves shows how the splits move it.
    let is_enough = |each: &Found| {
        each.residual < TOGETHER && (spread(runs) < LEAST_SPREAD || !may_tell(runs, each))
    };
    if each.as_ref().is_ok_and(is_enough) {
        return each;
    }
    let told = |model| {
        let shared = found(model).ok()?;
        is_told(|at| shared.variance(at), &shared, each.as_ref().ok()).then_some(shared)
    };
    // As an unknown that is nothing it would leave less known of all others: of rotation above all, which quadrature that stays is like.
    let nonlinear = told(Model::Nonlinear);
    let turning = nonlinear.as_ref().and_then(Found::turning_by_amplitudes);
    let linear = || {
        let shared = told(Model::Shared)?;
        Some(Found {
            unseen_turning: turning,
            ..shared
        })
    };
    let nonlinear = nonlinear.filter(Found::is_nonlinear);
    nonlinear.or_else(linear).map_or(each, Ok)
}

/// Where patterns are turned as it happens.
fn turned(runs: &[Run]) -> Result<Found, Unsettled> {
    let runs = &chords::through(runs);
    let each = found(runs, Model::EachTurned);
    let shared = found(runs, Model::SharedTurned);
    match shared {
        Ok(shared) if is_told(|at| shared.variance(at), &shared, each.as_ref().ok()) => Ok(shared),
        _ => each,
    }
}

/// What a model finds.
pub fn found(runs: &[Run], model: Model) -> Result<Found, Unsettled> {
    let found = searched(runs, model);
    if !model.is_shared() || model.is_turned() || found.as_ref().is_ok_and(Found::is_explained) {
        return found;
    }
    let most = found.as_ref().map_or(f64::INFINITY, |found| found.residual);
    let across = gaps::across(runs, model).filter(|across| across.residual < most);
    across.map_or(found, Ok)
}

/// The same from where the integrals lead.
pub fn searched(runs: &[Run], model: Model) -> Result<Found, Unsettled> {
    let values = start(runs, model).ok_or(Unsettled)?;
    settle(runs, model, values)
}

/// True where rows of such runs tell the splits, if these are small: where nothing tells them a fit may find great ones, which seem told.
fn may_tell(runs: &[Run], each: &Found) -> bool {
    let model = Model::Shared;
    let mut values = DVector::zeros(model.unknowns(runs.len()));
    for run in 0..runs.len() {
        values[model.decay_at(run)] += each.values[each.model.decay_at(run)] / runs.len() as f64;
        let from = each.values.rows(each.model.own_at(run), 4);
        values.rows_mut(model.own_at(run), 4).copy_from(&from);
    }
    let rough = Normal::of(runs, model, &values).equations.factors(0.0);
    rough.is_some_and(|rough| is_told(|at| rough.variance(&[(at, 1.0)]), each, Some(each)))
}

/// How far the rows' patterns stand apart, up to 1: the circular variance of 4θ, less what noise makes of it.
fn spread(runs: &[Run]) -> f64 {
    let (mut sum, mut noise, mut count) = (Complex::new(0.0, 0.0), 0.0, 0.0);
    for row in runs.iter().flat_map(|run| &run.rows) {
        sum += Complex::from_polar(1.0, 4.0 * row.angle);
        noise += 8.0 * row.deviations[2] * row.deviations[2];
        count += 1.0;
    }
    1.0 - (sum.norm() + noise) / count
}

/// True where the rows tell both splits, whose unknowns have these variances by their places; what `found` says of the decays along the
/// patterns is known wherever these stand.
fn is_told(variance: impl Fn(usize) -> f64, found: &Found, each: Option<&Found>) -> bool {
    let runs = found.of_runs.len();
    let decays = (0..runs).map(|run| found.decay_of_run(run).0.abs());
    let decay = decays.sum::<f64>() / runs as f64;
    let growths = each
        .iter()
        .flat_map(|each| (0..runs).map(move |run| each.values[each.model.decay_at(run) + 1].abs()));
    let growth = growths.fold(0.0, f64::max);
    let knows = |at: usize, most: f64| (at..at + 2).all(|i| variance(i) < most * most);
    knows(Model::DAMPING, TOLD[0] * decay)
        && knows(Model::FREQUENCY, (TOLD[1] * decay).max(TOLD_SHARE * growth))
}

/// Moves the values to where the squares of the residual are least.
pub fn settle(runs: &[Run], model: Model, mut values: DVector<f64>) -> Result<Found, Unsettled> {
    let mut normal = Normal::of(runs, model, &values);
    let mut damping = 1e-3;
    let mut most = SETTLED;
    for _ in 0..STEPS {
        let whole = normal.step(0.0).ok_or(Unsettled)?;
        if normal.equations.right().dot(&whole) < most * normal.widening(&values) {
            let values = values + whole;
            return Normal::of(runs, model, &values).conclude(model, values);
        }
        let moved = &values + normal.step(damping).ok_or(Unsettled)?;
        let next = Normal::of(runs, model, &moved);
        // Not a number is no less.
        if next.squares < normal.squares {
            (values, normal) = (moved, next);
            damping *= 0.1;
            most = SETTLED;
        } else {
            damping *= 10.0;
            if damping > FOOT {
                most = SETTLED_AT_FOOT;
            }
        }
    }
    Err(Unsettled)
}

/// The normal equations of all runs about some values.
struct Normal {
    equations: Equations,
    /// What is left, in squares of deviations.
    squares: f64,
    /// Sum of the products of what is left of rows that follow each other.
    neighbours: f64,
    of_runs: Vec<OfRun>,
    /// Numbers of the rows that are explained.
    count: f64,
}

impl Normal {
    fn of(runs: &[Run], model: Model, values: &DVector<f64>) -> Self {
        let mut normal = Self {
            equations: Equations::new(model.shared(), model.own(), runs.len()),
            squares: 0.0,
            neighbours: 0.0,
            of_runs: Vec::with_capacity(runs.len()),
            count: 0.0,
        };
        for (index, run) in runs.iter().enumerate() {
            normal.add((index, run), model, &model.terms(index, run), values);
        }
        normal
    }

    /// Adds the rows of a run.
    fn add(
        &mut self,
        (index, run): (usize, &Run),
        model: Model,
        terms: &[Term],
        values: &DVector<f64>,
    ) {
        let mut motion = model.motion(run, terms, values);
        let mut before = [0.0; 3];
        let mut last = &run.rows[0];
        let mut shares = [0.0; 2];
        let mut squares = 0.0;
        // By how much it was turned otherwise than by rotation.
        let (mut otherwise, mut of_otherwise) = (0.0, RowSVector::zeros());
        // The run's own equations, for the parameters of its motion.
        let mut matrix = SMatrix::<f64, PARAMETERS, PARAMETERS>::zeros();
        let mut right = SVector::<f64, PARAMETERS>::zeros();
        for row in &run.rows {
            let (beyond, derivatives) = model.advance(&mut motion, last, row);
            last = row;
            otherwise += beyond;
            of_otherwise += derivatives;
            // What a window averages changes the derivatives by too little to matter.
            let (rest, derivatives) = motion.rest(row);
            for (index, (rest, deviation)) in rest.iter().zip(row.deviations).enumerate() {
                let (rest, line) = (*rest / deviation, derivatives.row(index) / deviation);
                squares += rest * rest;
                self.neighbours += rest * std::mem::replace(&mut before[index], rest);
                right += line.transpose() * rest;
                matrix += line.transpose() * line;
            }
            for (sum, share) in shares.iter_mut().zip(motion.shares()) {
                *sum += share / run.rows.len() as f64;
            }
        }
        for &(place, direction) in terms {
            let direction = SVector::from(direction);
            self.equations.add_right(place, right.dot(&direction));
            let along = matrix * direction;
            for &(other, direction) in terms {
                let more = along.dot(&SVector::from(direction));
                self.equations.add(index, [place, other], more);
            }
        }
        self.squares += squares;
        self.count += (model.explained() * run.rows.len()) as f64;
        let seconds = run.seconds();
        let along = |direction| of_otherwise.transpose().dot(&SVector::from(direction)) / seconds;
        self.of_runs.push(OfRun {
            shares,
            residual: (squares / (model.explained() * run.rows.len() - 4) as f64).sqrt(),
            rotation: (run.turned() - otherwise) / seconds,
            of_rotation: terms
                .iter()
                .map(|&(place, by)| (place, -along(by)))
                .collect(),
            rotation_noise: run.rows[0].deviations[2].hypot(last.deviations[2]) / seconds,
        });
    }

    /// The step that a damping leaves.
    fn step(&self, damping: f64) -> Option<DVector<f64>> {
        let factors = self.equations.factors(damping)?;
        Some(factors.solve(self.equations.right()))
    }

    /// The rms residual over the rows' own deviations.
    fn residual(&self, values: &DVector<f64>) -> f64 {
        (self.squares / (self.count - values.len() as f64)).sqrt()
    }

    /// What variances are multiplied by where the residual is beyond the rows' own.
    fn widening(&self, values: &DVector<f64>) -> f64 {
        self.residual(values).max(1.0).powi(2)
    }

    fn conclude(self, model: Model, values: DVector<f64>) -> Result<Found, Unsettled> {
        Ok(Found {
            model,
            factors: self.equations.factors(0.0).ok_or(Unsettled)?,
            widening: self.widening(&values),
            residual: self.residual(&values),
            // What is far below the rows' own deviations does no harm.
            alike: self.neighbours / self.squares.max(self.count),
            values,
            count: self.count,
            of_runs: self.of_runs,
            unseen_turning: None,
        })
    }
}

#[cfg(test)]
mod tests;

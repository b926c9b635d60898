//! What the rows say of the unknowns near some values of these: the normal equations of a fit.

use nalgebra::{DVector, SMatrix, SVector};

use super::curve::{CURVES, curves, undamped};
use super::found::{Found, RunResult};
use super::model::{ALL, Damping, Model, Term};
use super::motion::PARAMETERS;
use crate::normal::Equations;
use crate::runs::Run;

/// The normal equations of all runs about some values.
pub struct Normal {
    pub equations: Equations,
    /// Sum of squared residuals, in deviations.
    pub squares: f64,
    /// Sum of the products of consecutive rows' residuals.
    neighbours: f64,
    of_runs: Vec<RunResult>,
    /// Number of values in the rows that are explained.
    count: f64,
}

impl Normal {
    /// The equations about these values.
    pub fn of(runs: &[Run], model: Model, values: &DVector<f64>) -> Self {
        let mut normal = Self {
            equations: Equations::new(model.shared(), model.own(), runs.len()),
            squares: 0.0,
            neighbours: 0.0,
            of_runs: Vec::with_capacity(runs.len()),
            count: 0.0,
        };
        for (index, run) in runs.iter().enumerate() {
            let terms = model.terms(index, run);
            match model.damping {
                // In half the time.
                Damping::Steady | Damping::InTime(0) => {
                    normal.add::<PARAMETERS>((index, run), model, &terms, values, None);
                }
                Damping::ByEnergy | Damping::InTime(_) => {
                    let curves = curves(run);
                    normal.add::<ALL>((index, run), model, &terms, values, Some(&curves));
                }
            }
        }
        normal
    }

    /// Adds the rows of a run, with the first `N` parameters.
    fn add<const N: usize>(
        &mut self,
        (index, run): (usize, &Run),
        model: Model,
        terms: &[Term],
        values: &DVector<f64>,
        curves: Option<&[[f64; CURVES]]>,
    ) {
        let parameters = Model::parameters(terms, values);
        let mut motion = model.motion(run, &parameters);
        let of_curves: [f64; CURVES] = std::array::from_fn(|i| parameters[PARAMETERS + i]);
        let mut before = [0.0; 3];
        let mut last = &run.rows[0];
        let mut shares = [0.0; 2];
        let mut squares = 0.0;
        // Turn of the pattern that is not due to rotation.
        let (mut extra, mut of_extra) = (0.0, SVector::zeros());
        // The run's own equations, for the parameters of its motion and the curves of its damping.
        let mut matrix = SMatrix::<f64, N, N>::zeros();
        let mut right = SVector::<f64, N>::zeros();
        for (index, row) in run.rows.iter().enumerate() {
            let curve = curves.map_or([0.0; CURVES], |curves| curves[index]);
            let (beyond, derivatives) = model.advance(&mut motion, last, row);
            last = row;
            extra += beyond;
            of_extra += derivatives;
            let row = undamped(row, &curve, &of_curves);
            // The averaging by windows changes the derivatives by too little to matter.
            let (rests, derivatives) = motion.residuals(&row);
            let larger = [row.main - rests[0], row.quadrature - rests[1], -rests[2]];
            for (index, deviation) in row.deviations.into_iter().enumerate() {
                let rest = rests[index] / deviation;
                let of_motion = derivatives.row(index) / deviation;
                let larger = larger[index] / deviation;
                let line = SVector::<f64, N>::from_fn(|i, _| match i.checked_sub(PARAMETERS) {
                    None => of_motion[i],
                    Some(i) => -larger * curve[i],
                });
                squares += rest * rest;
                self.neighbours += rest * std::mem::replace(&mut before[index], rest);
                right.axpy(rest, &line, 1.0);
                matrix.ger(1.0, &line, &line, 1.0);
            }
            for (sum, share) in shares.iter_mut().zip(motion.shares()) {
                *sum += share / run.rows.len() as f64;
            }
        }
        for &(place, direction) in terms {
            let of = |direction: [f64; ALL]| SVector::<f64, N>::from_fn(|i, _| direction[i]);
            self.equations.add_right(place, right.dot(&of(direction)));
            let along = matrix * of(direction);
            for &(other, direction) in terms {
                let more = along.dot(&of(direction));
                self.equations.add(index, [place, other], more);
            }
        }
        self.squares += squares;
        self.count += (model.explained() * run.rows.len()) as f64;
        let seconds = run.seconds();
        let along = |direction: [f64; ALL]| {
            let by = of_extra.iter().zip(direction).map(|(of, by)| of * by);
            by.sum::<f64>() / seconds
        };
        self.of_runs.push(RunResult {
            shares,
            residual: (squares / (model.explained() * run.rows.len() - 4) as f64).sqrt(),
            rotation: (run.turned() - extra) / seconds,
            of_rotation: terms
                .iter()
                .map(|&(place, by)| (place, -along(by)))
                .collect(),
            rotation_noise: run.rows[0].deviations[2].hypot(last.deviations[2]) / seconds,
        });
    }

    /// The step with this damping.
    pub fn step(&self, damping: f64) -> Option<DVector<f64>> {
        let factors = self.equations.factors(damping)?;
        Some(factors.solve(self.equations.right()))
    }

    /// The rms residual over the rows' own deviations.
    fn residual(&self, values: &DVector<f64>) -> f64 {
        (self.squares / (self.count - values.len() as f64)).sqrt()
    }

    /// Factor by which variances are widened if the residual exceeds the rows' own deviations.
    pub fn widening(&self, values: &DVector<f64>) -> f64 {
        self.residual(values).max(1.0).powi(2)
    }

    /// The fit, if these equations determine all unknowns.
    pub fn conclude(self, model: Model, values: DVector<f64>) -> Option<Found> {
        Some(Found {
            model,
            factors: self.equations.factors(0.0)?,
            widening: self.widening(&values),
            residual: self.residual(&values),
            // Correlation of residuals far below the rows' own deviations does no harm.
            alike: self.neighbours / self.squares.max(self.count),
            values,
            count: self.count,
            of_runs: self.of_runs,
            unseen_turning: None,
        })
    }
}

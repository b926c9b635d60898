//! Values from which the search begins.
//!
//! The motion is linear in the rates, so that E, R, S and Q are their initial values plus integrals over time of each rate's effect:
//! linear least squares gives the rates, wherever the pattern stands and however it moves, but for noise in the integrals.

use nalgebra::{DVector, Matrix4, SVector, Vector4};

use super::model::{Model, Term};
use super::motion::{RATES, by_rates, state};
use crate::normal::Equations;
use crate::runs::Run;

/// Share of each unknown's own weight that is added to it, so that unknowns that the rows do not determine stay near 0.
const RIDGE: f64 = 1e-10;

/// The unknowns of a model from the integrals; `None` if they are not numbers.
pub fn start(runs: &[Run], model: Model) -> Option<DVector<f64>> {
    // At first E, R and S take the places of a_A, a_B and θ, and Q follows the run's own; or E and Q take those of a_A and a_B.
    let (shared, own) = (model.shared(), model.own());
    let each = own + usize::from(!model.is_unsteady());
    let mut equations = Equations::new(shared, each, runs.len());
    let from = |run: usize| shared + each * run;
    for (index, run) in runs.iter().enumerate() {
        let begin = from(index);
        let begins: &[_] = if model.is_unsteady() {
            &[(0, 0), (3, 1)]
        } else {
            &[(0, 1), (1, 2), (2, 3), (3, own)]
        };
        let begins: Vec<_> = begins.iter().map(|&(of, at)| (of, begin + at)).collect();
        let mut terms = model.terms(index, run);
        for (place, _) in &mut terms {
            if *place >= shared {
                *place = *place - model.own_at(index) + begin;
            }
        }
        add(&mut equations, (index, run), &terms, &begins);
    }
    let found = equations.factors(RIDGE)?.solve(equations.right());
    let mut values = DVector::zeros(model.unknowns(runs.len()));
    values.rows_mut(0, shared).copy_from(&found.rows(0, shared));
    for (index, run) in runs.iter().enumerate() {
        let found = found.rows(from(index), each);
        let mut values = values.rows_mut(model.own_at(index), own);
        values.copy_from(&found.rows(0, own));
        // The amplitudes and the angle from E, R, S and Q.
        if model.is_unsteady() {
            let [e, q] = [found[0], found[1]];
            let main = (0.5 * (e + (e * e - q * q).max(0.0).sqrt())).sqrt();
            (values[0], values[1]) = (main, 0.5 * q / main);
        } else {
            let [r, s, q] = [found[2], found[3], found[own]];
            let apart = r.hypot(s);
            let main = (0.5 * (apart.hypot(q) + apart)).sqrt();
            values[0] -= 2.0 * run.turned() / run.seconds();
            (values[1], values[2]) = (main, 0.5 * q / main);
            values[3] = 0.25 * s.atan2(r);
        }
    }
    Some(values)
}

/// Adds the rows of a run; `begins` lists which of E, R, S and Q are used, by number, and the places of their initial values.
///
/// In a frame that turns at the pattern's mean rate nothing moves far from row to row, so that sums serve as integrals; κ is then
/// relative to that rate.
fn add(
    equations: &mut Equations,
    (index, run): (usize, &Run),
    terms: &[Term],
    begins: &[(usize, usize)],
) {
    // Of each unknown that moves the state: its place, its rates, their effect now and its integral.
    let mut moves = Vec::new();
    for (place, direction) in terms {
        let rates = SVector::<f64, RATES>::from_column_slice(&direction[..RATES]);
        if rates.norm() > 0.0 {
            moves.push((*place, rates, Vector4::zeros(), Vector4::zeros()));
        }
    }
    let rate = run.turned() / run.seconds();
    let mut before = run.rows[0].time;
    let mut entries = Vec::with_capacity(1 + moves.len());
    for row in &run.rows {
        let back = turned(-rate * (row.time - run.rows[0].time));
        let state = state(row.main, row.quadrature, row.angle);
        let by_rates = back * by_rates(&state);
        let half = 0.5 * (row.time - before);
        before = row.time;
        for (_, rates, last, integral) in &mut moves {
            let slope = by_rates * *rates;
            // Of the first row, the time is 0.
            *integral += (*last + slope) * half;
            *last = slope;
        }
        let weight = 1.0 / (state[0] * row.deviations[0].powi(2));
        let turned = back * state;
        for &(equation, place) in begins {
            entries.clear();
            entries.push((place, 1.0));
            entries.extend(
                moves
                    .iter()
                    .map(|(place, .., integral)| (*place, integral[equation])),
            );
            equations.add_equation(index, &entries, turned[equation], weight);
        }
    }
}

/// Turns the state E, R, S, Q of a pattern by an angle, rad.
fn turned(angle: f64) -> Matrix4<f64> {
    let (sine, cosine) = (4.0 * angle).sin_cos();
    let mut matrix = Matrix4::identity();
    (matrix[(1, 1)], matrix[(1, 2)]) = (cosine, -sine);
    (matrix[(2, 1)], matrix[(2, 2)]) = (sine, cosine);
    matrix
}

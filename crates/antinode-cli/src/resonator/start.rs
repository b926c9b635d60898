//! Values from which the search begins.
//!
//! The motion is linear in the rates, so that E, R, S and Q are their initial values plus integrals over time of each rate's effect:
//! linear least squares gives the rates, wherever the pattern stands and however it moves, but for noise in the integrals.

use nalgebra::{DVector, Matrix4, SVector, Vector4};

use super::model::{Model, Term};
use super::motion::{RATES, by_rates};
use crate::normal::Equations;
use crate::runs::{Row, Run};

/// Share of each unknown's own weight that is added to it, so that unknowns that the rows do not determine stay near 0.
const RIDGE: f64 = 1e-10;

/// The unknowns of a model from the integrals; `None` if they are not finite.
pub fn start(runs: &[Run], model: Model) -> Option<DVector<f64>> {
    // At first E, R and S take the places of a_A, a_B and θ, and Q follows the run's own; or E and Q take those of a_A and a_B.
    let (shared, own) = (model.shared(), model.own());
    let each = own + usize::from(!model.is_unsteady());
    let mut equations = Equations::new(shared, each, runs.len());
    let from = |run: usize| shared + each * run;
    for (index, run) in runs.iter().enumerate() {
        let begin = from(index);
        let begins = if model.is_unsteady() {
            vec![(0, begin), (3, begin + 1)]
        } else {
            vec![
                (0, begin + 1),
                (1, begin + 2),
                (2, begin + 3),
                (3, begin + own),
            ]
        };
        let terms = model
            .terms(index, run)
            .into_iter()
            .map(|(place, direction)| {
                let place = if place < shared {
                    place
                } else {
                    place - model.own_at(index) + begin
                };
                (place, direction)
            });
        add(
            &mut equations,
            (index, run),
            &terms.collect::<Vec<_>>(),
            &begins,
        );
    }
    let found = equations.factors(RIDGE)?.solve(equations.right());
    let mut values = DVector::zeros(model.unknowns(runs.len()));
    values.rows_mut(0, shared).copy_from(&found.rows(0, shared));
    for (index, run) in runs.iter().enumerate() {
        let found = found.rows(from(index), each);
        let mut values = values.rows_mut(model.own_at(index), own);
        values.copy_from(&found.rows(0, own));
        if model.is_unsteady() {
            let [e, q] = [found[0], found[1]];
            let main = (0.5 * (e + (e * e - q * q).max(0.0).sqrt())).sqrt();
            values[0] = main;
            values[1] = 0.5 * q / main;
            continue;
        }
        let [r, s, q] = [found[2], found[3], found[own]];
        let apart = r.hypot(s);
        let main = (0.5 * (apart.hypot(q) + apart)).sqrt();
        values[0] -= 2.0 * run.turned() / run.seconds();
        values[1] = main;
        values[2] = 0.5 * q / main;
        values[3] = 0.25 * s.atan2(r);
    }
    let is_sound = values.iter().all(|value| value.is_finite());
    is_sound.then_some(values)
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
    let mut places: Vec<usize> = begins.iter().map(|&(_, place)| place).collect();
    let mut moves = Vec::new();
    for (place, direction) in terms {
        let rates = SVector::<f64, RATES>::from_column_slice(&direction[..RATES]);
        if rates.norm() > 0.0 {
            places.push(*place);
            moves.push(rates);
        }
    }
    let rate = run.turned() / run.seconds();
    let mut integrals = vec![Vector4::zeros(); moves.len()];
    let mut before: Option<(f64, Vec<Vector4<f64>>)> = None;
    for row in &run.rows {
        let back = turned(-rate * (row.time - run.rows[0].time));
        let state = state(row);
        let by_rates = back * by_rates(&state);
        let slopes: Vec<_> = moves.iter().map(|rates| by_rates * rates).collect();
        if let Some((time, last)) = before {
            let half = 0.5 * (row.time - time);
            for ((integral, last), slope) in integrals.iter_mut().zip(last).zip(&slopes) {
                *integral += (last + slope) * half;
            }
        }
        before = Some((row.time, slopes));
        let weight = 1.0 / (state[0] * row.deviations[0].powi(2));
        let turned = back * state;
        for (begin, &(equation, _)) in begins.iter().enumerate() {
            let seen = turned[equation];
            let mut entries = vec![0.0; begins.len()];
            entries[begin] = 1.0;
            entries.extend(integrals.iter().map(|integral| integral[equation]));
            for (&place, left) in places.iter().zip(&entries) {
                equations.add_right(place, weight * left * seen);
                for (&other, right) in places.iter().zip(&entries) {
                    equations.add(index, [place, other], weight * left * right);
                }
            }
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

/// E, R, S and Q of a row.
fn state(row: &Row) -> Vector4<f64> {
    let [main, quadrature] = [row.main, row.quadrature].map(|size| size * size);
    let (sine, cosine) = (4.0 * row.angle).sin_cos();
    let apart = main - quadrature;
    Vector4::new(
        main + quadrature,
        apart * cosine,
        apart * sine,
        2.0 * row.main * row.quadrature,
    )
}

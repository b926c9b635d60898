//! Where the search begins.
//!
//! The motion is linear in the rates, so that E, R, S and Q are what they began with plus integrals over time of what each rate does to them:
//! by linear least squares the rates follow, wherever the pattern stands and however it moves, but for noise in the integrals.

use nalgebra::{Cholesky, DMatrix, DVector, Matrix4, SVector, Vector4};

use super::model::{Model, Term};
use super::motion::{RATES, by_rates};
use crate::runs::{Row, Run};

/// The share of each unknown's own weight that is added to it: what the rows do not tell then stays next to nothing.
const RIDGE: f64 = 1e-10;

/// The unknowns of a model, as the integrals tell them; none where they are no numbers.
pub fn start(runs: &[Run], model: Model) -> Option<DVector<f64>> {
    let unknowns = model.unknowns(runs.len());
    let mut normal = Normal {
        // E, R and S at first stand where a_A, a_B and θ will, and Q behind all; or E and Q where a_A and a_B will.
        matrix: DMatrix::zeros(unknowns + runs.len(), unknowns + runs.len()),
        right: DVector::zeros(unknowns + runs.len()),
    };
    for (index, run) in runs.iter().enumerate() {
        let own = model.own_at(index);
        let begins = if model.is_turned() {
            vec![(0, own), (3, own + 1)]
        } else {
            vec![
                (0, own + 1),
                (1, own + 2),
                (2, own + 3),
                (3, unknowns + index),
            ]
        };
        normal.add(run, &model.terms(index, run), &begins);
    }
    if model.is_turned() {
        normal
            .matrix
            .view_mut((unknowns, unknowns), (runs.len(), runs.len()))
            .fill_diagonal(1.0);
    }
    for index in 0..normal.matrix.nrows() {
        normal.matrix[(index, index)] *= 1.0 + RIDGE;
    }
    let found = Cholesky::new(normal.matrix)?.solve(&normal.right);
    let mut values = found.rows(0, unknowns).into_owned();
    for (index, run) in runs.iter().enumerate() {
        let own = model.own_at(index);
        if model.is_turned() {
            let [e, q] = [found[own], found[own + 1]];
            let main = (0.5 * (e + (e * e - q * q).max(0.0).sqrt())).sqrt();
            values[own] = main;
            values[own + 1] = 0.5 * q / main;
            continue;
        }
        let [r, s, q] = [found[own + 2], found[own + 3], found[unknowns + index]];
        let apart = r.hypot(s);
        let main = (0.5 * (apart.hypot(q) + apart)).sqrt();
        values[own] -= 2.0 * run.turned() / run.seconds();
        values[own + 1] = main;
        values[own + 2] = 0.5 * q / main;
        values[own + 3] = 0.25 * s.atan2(r);
    }
    let is_sound = values.iter().all(|value| value.is_finite());
    is_sound.then_some(values)
}

/// The normal equations of all runs.
struct Normal {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
}

impl Normal {
    /// Adds the rows of a run, of whose E, R, S and Q these, by number, begin with unknowns at these places.
    ///
    /// Seen from a frame that turns with the pattern's mean rate nothing moves far from row to row, and sums do for integrals; its κ is
    /// what is beyond that rate.
    fn add(&mut self, run: &Run, terms: &[Term], begins: &[(usize, usize)]) {
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
                    self.right[place] += weight * left * seen;
                    for (&other, right) in places.iter().zip(&entries) {
                        self.matrix[(place, other)] += weight * left * right;
                    }
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

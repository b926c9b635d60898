//! The Taylor series of a motion over time.
//!
//! The slope is linear in the state, but for γ, which multiplies it with Q. So the coefficients follow from one another: that of each order
//! is the slope of the one before, with the products taken term by term, over the order.

use nalgebra::{Matrix4, RowVector4, SMatrix, Vector4};

use super::rates::{GAMMA, RATES, by_rates};

/// Fastest rate times a step, at most: the coefficients then fall fast.
const STEP: f64 = 0.5;
/// Bound of a coefficient, as a share of the state, below which it is the last.
const LAST: f64 = 1e-12;
/// The same for derivatives: they only say where to seek.
const LAST_OF_DERIVATIVES: f64 = 1e-8;
/// Fastest rate times the time, at most: with more, the pattern turns by more than a radian, or the wave is gone, and no rows fit.
const LONGEST: f64 = 10.0;

/// What moves a state.
#[derive(Debug, Clone)]
pub struct Series {
    /// The matrix by which all moves but that of γ.
    linear: Matrix4<f64>,
    /// γ; `None` if it is 0, and derivatives by it are not wanted.
    pub gamma: Option<f64>,
    /// The fastest rate without γ, 1/s.
    fastest: f64,
}

impl Series {
    /// What moves a state by this matrix and by γ.
    pub fn new(linear: Matrix4<f64>, gamma: Option<f64>) -> Self {
        Self {
            linear,
            gamma,
            fastest: linear.norm(),
        }
    }

    /// These columns after this time, s, which may be negative. The first is the state; its derivatives by the rates follow, if any.
    pub fn moved<const N: usize>(
        &self,
        columns: SMatrix<f64, 4, N>,
        seconds: f64,
    ) -> SMatrix<f64, 4, N> {
        let mut fastest = self.fastest;
        if let Some(gamma) = self.gamma {
            let [energy, quadrature] = [0, 3].map(|row| columns[(row, 0)]);
            // What Q may become meanwhile.
            let gained = self.linear.fixed_view::<1, 2>(3, 1).norm() * energy * seconds;
            fastest += 4.0 * gamma.abs() * (quadrature.abs() + gained.abs());
        }
        let span = fastest * seconds.abs();
        if span.is_nan() || span > LONGEST {
            return columns * f64::NAN;
        }
        let steps = (span / STEP).ceil().max(1.0);
        let step = seconds / steps;
        // E, R, S and Q each with its derivatives in one piece: sums over them take half as long.
        let mut moved = columns.transpose();
        let mut terms = Vec::with_capacity(if self.gamma.is_some() { 16 } else { 1 });
        let last = if N > 1 { LAST_OF_DERIVATIVES } else { LAST };
        for _ in 0..steps as u64 {
            terms.clear();
            terms.push(moved);
            let (mut order, mut bound) = (0.0, 1.0);
            while bound > last {
                order += 1.0;
                bound *= span / steps / order;
                let term = self.next(&terms) * (step / order);
                moved += term;
                // Only γ's products take all terms.
                if self.gamma.is_none() {
                    terms.clear();
                }
                terms.push(term);
            }
        }
        let mut moved = moved.transpose();
        // The state, which is what rows are compared with, to its own bound.
        if N > 1 {
            let state = self.moved(columns.column(0).into_owned(), seconds);
            moved.set_column(0, &state);
        }
        moved
    }

    /// The slope of a state.
    pub fn slope(&self, state: &Vector4<f64>) -> Vector4<f64> {
        self.next(&[state.transpose()]).transpose()
    }

    /// The slope of the last of these terms of a series, whose products take all of them.
    fn next<const N: usize>(&self, terms: &[SMatrix<f64, N, 4>]) -> SMatrix<f64, N, 4> {
        let last = &terms[terms.len() - 1];
        let mut slope = last * self.linear.transpose();
        let has_derivatives = N > 1;
        let products = || terms.iter().zip(terms.iter().rev());
        // By which γ moves the state: 2QS and −2QR.
        let turning: RowVector4<f64> = match self.gamma {
            Some(_) => products()
                .map(|(a, b)| RowVector4::new(0.0, b[(0, 2)], -b[(0, 1)], 0.0) * (2.0 * a[(0, 3)]))
                .sum(),
            None => RowVector4::zeros(),
        };
        if has_derivatives {
            // The effects within a period change these by too little to matter.
            let mut by_rates = by_rates(&last.row(0).transpose());
            by_rates.set_column(GAMMA, &turning.transpose());
            let mut of_rates = slope.rows_mut(1, RATES);
            of_rates += by_rates.transpose();
        }
        if let Some(gamma) = self.gamma.filter(|&gamma| gamma != 0.0) {
            let mut of_products = SMatrix::<f64, N, 2>::zeros();
            for (a, b) in products() {
                for (i, mut sum) in of_products.column_iter_mut().enumerate() {
                    sum.axpy(2.0 * a[(0, 3)], &b.column(1 + i), 1.0);
                    sum.axpy(2.0 * b[(0, 1 + i)], &a.column(3), 1.0);
                }
            }
            slope.column_mut(1).axpy(gamma, &of_products.column(1), 1.0);
            slope
                .column_mut(2)
                .axpy(-gamma, &of_products.column(0), 1.0);
            // A derivative of a product has two terms, the state itself one.
            let mut state = slope.row_mut(0);
            state -= turning * gamma;
        }
        slope
    }
}

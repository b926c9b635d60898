//! The Taylor series of a motion over time.
//!
//! The slope is linear in the state, but for γ, which multiplies it with Q. So the coefficients follow from one another: that of each order
//! is the slope of the one before, with the products taken term by term, over the order.

use nalgebra::{Matrix4, SMatrix, Vector4};

use super::rates::{GAMMA, PARAMETERS, RATES, by_rates};

/// The derivatives of E, R, S and Q by all parameters: a column each, as sums over a column take half as long.
pub type Derivatives = SMatrix<f64, PARAMETERS, 4>;

/// Fastest rate times a step, at most: the coefficients then fall fast.
const STEP: f64 = 0.5;
/// Bound of a coefficient, as a share of the state, below which it is the last.
const LAST: f64 = 1e-12;
/// The same for derivatives: they only say where to seek.
const LAST_OF_DERIVATIVES: f64 = 1e-8;
/// Fastest rate times the time, at most: with more, the pattern turns by more than a radian, or the wave is gone, and no rows fit.
const LONGEST: f64 = 10.0;
/// Terms of a state's series, usually at most: 0.5¹²/12! is below `LAST`.
const TERMS: usize = 13;

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

/// A time in steps.
struct Steps {
    count: u64,
    /// Length of each, s.
    seconds: f64,
    /// Fastest rate times that.
    span: f64,
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

    /// A state after this time, s, which may be negative; NaN if it is beyond [`LONGEST`].
    pub fn moved(&self, mut state: Vector4<f64>, seconds: f64) -> Vector4<f64> {
        let Some(steps) = self.steps(&state, seconds) else {
            return Vector4::repeat(f64::NAN);
        };
        for _ in 0..steps.count {
            state = self.terms(state, &steps).iter().sum();
        }
        state
    }

    /// Moves a state and its derivatives on by this time, s; they are NaN if that is beyond [`LONGEST`].
    pub fn advance(&self, state: &mut Vector4<f64>, derivatives: &mut Derivatives, seconds: f64) {
        let Some(steps) = self.steps(state, seconds) else {
            state.fill(f64::NAN);
            derivatives.fill(f64::NAN);
            return;
        };
        for _ in 0..steps.count {
            let terms = self.terms(*state, &steps);
            *state = terms.iter().sum();
            *derivatives = self.derivatives(*derivatives, &terms, &steps);
        }
    }

    /// The slope of a state.
    pub fn slope(&self, state: &Vector4<f64>) -> Vector4<f64> {
        self.slope_of_last(&[*state])
    }

    /// The steps in which a state moves by this time, s; `None` if that is too long.
    fn steps(&self, state: &Vector4<f64>, seconds: f64) -> Option<Steps> {
        let mut fastest = self.fastest;
        if let Some(gamma) = self.gamma {
            // What Q may become meanwhile.
            let gained = self.linear.fixed_view::<1, 2>(3, 1).norm() * state[0] * seconds;
            fastest += 4.0 * gamma.abs() * (state[3].abs() + gained.abs());
        }
        let span = fastest * seconds.abs();
        // False if it is not a number.
        let is_within = span <= LONGEST;
        is_within.then(|| {
            let count = (span / STEP).ceil().max(1.0);
            Steps {
                count: count as u64,
                seconds: seconds / count,
                span: span / count,
            }
        })
    }

    /// The terms of a state's series over a step, from the state itself on.
    fn terms(&self, state: Vector4<f64>, steps: &Steps) -> Vec<Vector4<f64>> {
        let mut terms = Vec::with_capacity(TERMS);
        terms.push(state);
        let mut bound = 1.0;
        while bound > LAST {
            let order = terms.len() as f64;
            bound *= steps.span / order;
            terms.push(self.slope_of_last(&terms) * (steps.seconds / order));
        }
        terms
    }

    /// The slope of the last of these terms of a state's series, of which γ's products take all.
    fn slope_of_last(&self, terms: &[Vector4<f64>]) -> Vector4<f64> {
        let linear = self.linear * terms[terms.len() - 1];
        match self.gamma {
            Some(gamma) => linear + turning(terms) * gamma,
            None => linear,
        }
    }

    /// The derivatives after a step, over which the state's series has these terms.
    fn derivatives(&self, now: Derivatives, states: &[Vector4<f64>], steps: &Steps) -> Derivatives {
        let (mut moved, mut last) = (now, now);
        // Only γ's products take all terms.
        let mut terms = Vec::with_capacity(if self.gamma.is_some() { TERMS } else { 0 });
        let (mut order, mut bound) = (0, 1.0);
        while bound > LAST_OF_DERIVATIVES {
            let mut slope = last * self.linear.transpose();
            // The effects within a period change these by too little to matter.
            let mut by_rates = by_rates(&states[order]);
            order += 1;
            if let Some(gamma) = self.gamma {
                by_rates.set_column(GAMMA, &turning(&states[..order]));
                terms.push(last);
                for (state, term) in states[..order].iter().rev().zip(&terms) {
                    // Of Q's products with S and with R.
                    for (to, by, times) in [(1, 2, 2.0 * gamma), (2, 1, -2.0 * gamma)] {
                        let mut sum = slope.column_mut(to);
                        sum.axpy(times * state[3], &term.column(by), 1.0);
                        sum.axpy(times * state[by], &term.column(3), 1.0);
                    }
                }
            }
            let mut of_rates = slope.fixed_rows_mut::<RATES>(0);
            of_rates += by_rates.transpose();
            bound *= steps.span / order as f64;
            last = slope * (steps.seconds / order as f64);
            moved += last;
        }
        moved
    }
}

/// By which γ moves a state, 2QS and −2QR, in the order of the last of these terms of its series.
fn turning(terms: &[Vector4<f64>]) -> Vector4<f64> {
    let products = terms.iter().zip(terms.iter().rev());
    products
        .map(|(a, b)| Vector4::new(0.0, b[2], -b[1], 0.0) * (2.0 * a[3]))
        .sum()
}

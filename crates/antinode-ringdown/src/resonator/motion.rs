//! How the standing wave of a resonator moves while it rings down, averaged over its periods.
//!
//! With E = a_A² + a_B², D = a_A² − a_B², R = D cos 4θ, S = D sin 4θ and Q = 2 a_A a_B the motion is linear (D. D. Lynch, *Vibratory gyro
//! analysis by the method of averaging*, 1995):
//!
//! ```text
//! Ė = −2E/τ − δ(c_τ R + s_τ S)              Ṙ = −2R/τ − δ c_τ E + 2κS + Δω s_ω Q
//! Q̇ = −2Q/τ − Δω(s_ω R − c_ω S)             Ṡ = −2S/τ − δ s_τ E − 2κR − Δω c_ω Q
//! ```
//!
//! where 1/τ is the mean of the damping of both modes and δ its split, Δω the split of the frequencies in rad/s, c and s the cosine and sine
//! of four times the angle at which the damping, or the frequency, is greatest, and −κ/2 the rate at which rotation turns the pattern.
//!
//! Within a period κ also acts together with 1/τ and Δω. To the second order in rates over the frequency 2πf = ω this adds
//!
//! ```text
//! Ė:  (κ/ω)(2Q/τ + Δω(s_ω R − c_ω S))        Ṙ:  (κ/ω) Δω s_ω E
//! Q̇:  (κ/ω) 2E/τ                             Ṡ: −(κ/ω) Δω c_ω E
//! ```
//!
//! Both modes obey ü + 2Mu̇ + (ω² + ωN)u = 0, with u the travelling waves z₊ and z₋, so that u̇ = (jω + A)u with
//! A = −M + jN/2 − j(M² + N²/4)/2ω − (MN − NM)/4ω. The other terms of the second order are constants: they are part of f, Δω and κ.
//!
//! A shell whose stiffness depends on its deflection turns a pattern that has quadrature: κ then has a part γQ. For a stiffness of
//! ω²(1 + βr²), with r the deflection of both pick-offs' modes together, γ is βω/8, and the frequency also rises by 3γE rad/s.

mod rates;
mod series;

use nalgebra::{Matrix3x4, Matrix4, RowVector4, SMatrix, SVector, Vector3, Vector4};
use num_complex::Complex;
use series::{Derivatives, Series};

use crate::runs::{Row, per_radian, turn};
pub use rates::{GAMMA, KAPPA, PARAMETERS, RATES, by_rates, state};

/// Squared relative change of a wave in half a window, with half its growth's square added, up to which the core takes it to grow and turn
/// evenly.
const MAX_CHANGE: f64 = 1.95;

/// The state E, R, S, Q, and its derivatives by the rates and by the wave at the start.
#[derive(Debug, Clone)]
pub struct Motion {
    state: Vector4<f64>,
    derivatives: Derivatives,
    rates: SVector<f64, RATES>,
    /// The matrix by which all rates but γ and κ move the state.
    matrix: Matrix4<f64>,
    /// The matrix by which κ moves it within a period, per unit of κ.
    within_period: Matrix4<f64>,
    /// What moves the state now.
    series: Series,
}

impl Motion {
    /// The motion with these parameters, at its start.
    pub fn new(&[rates @ .., main, quadrature, angle]: &[f64; PARAMETERS]) -> Self {
        let (sine, cosine) = (4.0 * angle).sin_cos();
        let state = state(main, quadrature, angle);
        let by_start = Matrix3x4::new(
            main,
            main * cosine,
            main * sine,
            quadrature,
            quadrature,
            -quadrature * cosine,
            -quadrature * sine,
            main,
            0.0,
            -2.0 * state[2],
            2.0 * state[1],
            0.0,
        ) * 2.0;
        let mut derivatives = Derivatives::zeros();
        derivatives.fixed_rows_mut::<3>(RATES).copy_from(&by_start);
        let rates = SVector::from(rates);
        let mut still = rates;
        still[KAPPA] = 0.0;
        // γ does not act on unit states: it needs both Q and R or S.
        let units = Matrix4::identity();
        let moved = units
            .column_iter()
            .map(|unit| by_rates(&unit.into_owned()) * still);
        let matrix = Matrix4::from_columns(&moved.collect::<Vec<_>>());
        let mut motion = Self {
            state,
            derivatives,
            rates,
            matrix,
            within_period: Matrix4::zeros(),
            series: Series::new(matrix, Some(rates[GAMMA])),
        };
        motion.renew();
        motion
    }

    /// The same for a wave of this 2πf, rad/s: without it, periods are taken to be infinitely short.
    pub fn of_frequency(mut self, omega: f64) -> Self {
        let [decay, _, _, wc, ws, _, _]: [f64; RATES] = self.rates.into();
        let [decay, wc, ws] = [2.0 * decay, wc, ws].map(|rate| rate * per_radian(omega));
        self.within_period = Matrix4::new(
            0.0, ws, -wc, decay, //
            ws, 0.0, 0.0, 0.0, //
            -wc, 0.0, 0.0, 0.0, //
            decay, 0.0, 0.0, 0.0,
        );
        self.renew();
        self
    }

    /// The same if γ is 0, and derivatives by it are not wanted.
    pub fn without_gamma(mut self) -> Self {
        self.series.gamma = None;
        self
    }

    /// Sets the rate at which rotation turns the pattern from now on, rad/s; the splits turn it further.
    pub fn steer(&mut self, rate: f64) {
        self.rates[KAPPA] = -2.0 * rate;
        self.renew();
    }

    /// Has the series follow the rates.
    fn renew(&mut self) {
        let kappa = self.rates[KAPPA];
        let mut linear = self.matrix + self.within_period * kappa;
        linear[(1, 2)] += 2.0 * kappa;
        linear[(2, 1)] -= 2.0 * kappa;
        self.series = Series::new(linear, self.series.gamma);
    }

    /// The pattern angle that the motion reaches in this time, s.
    pub fn angle_after(&self, seconds: f64) -> f64 {
        let then = self.state_after(seconds);
        0.25 * then[2].atan2(then[1])
    }

    /// Sets the pattern to an angle that no parameter changes; returns by how much it stood beyond that, and the derivatives of this.
    pub fn turn_to(&mut self, angle: f64) -> (f64, SVector<f64, PARAMETERS>) {
        let (r, s) = (self.state[1], self.state[2]);
        let apart = r.hypot(s).max(f64::MIN_POSITIVE);
        let [by_r, by_s] = [1, 2].map(|column| self.derivatives.column(column).into_owned());
        let along = (by_r * r + by_s * s) / apart;
        let across = (by_s * r - by_r * s) * (0.25 / (apart * apart));
        let (sine, cosine) = (4.0 * angle).sin_cos();
        // Not `apart` itself, which is never NaN.
        let size = (r * r + s * s) / apart;
        (self.state[1], self.state[2]) = (size * cosine, size * sine);
        self.derivatives.set_column(1, &(along * cosine));
        self.derivatives.set_column(2, &(along * sine));
        let beyond = turn(0.25 * s.atan2(r) - angle);
        (beyond, across)
    }

    /// The state after this time, s, which may be negative.
    fn state_after(&self, seconds: f64) -> Vector4<f64> {
        self.series.moved(self.state, seconds)
    }

    /// Moves on by this time, s.
    pub fn advance(&mut self, seconds: f64) {
        let (state, derivatives) = (&mut self.state, &mut self.derivatives);
        self.series.advance(state, derivatives, seconds);
    }

    /// The travelling waves of a state, of which that of `sign` is the greater: its size, and the lesser one, whose phase against it is 4θ.
    pub fn travelling(state: &Vector4<f64>, sign: f64) -> (f64, Complex<f64>) {
        let [e, r, s, q] = (*state).into();
        // A wave of amplitude 0 must not be divided by.
        let greater = (e + sign * q).max(f64::MIN_POSITIVE).sqrt();
        (greater, Complex::new(r, s) / greater)
    }

    /// The travelling waves that a window of this length, s, about now states for its middle.
    ///
    /// As in the core, each is taken to grow and to turn evenly within a window, or to change along a straight line if it changes by more
    /// than its size. Any departure from that is averaged: the result is the mean of its logarithm, or of itself, by Simpson's rule.
    fn averaged(&self, seconds: f64, sign: f64) -> (f64, Complex<f64>) {
        let at = |by: f64| Self::travelling(&self.state_after(by), sign);
        let (greater, lesser) = Self::travelling(&self.state, sign);
        let [before, after] = [at(-0.5 * seconds), at(0.5 * seconds)];
        let grown = (before.0 * after.0 / (greater * greater)).powf(1.0 / 6.0);
        let change = 0.5 * (after.1 - before.1) / lesser;
        let mean = if change.norm_sqr() + 0.5 * change.re * change.re < MAX_CHANGE {
            let bent = (before.1 / lesser).ln() + (after.1 / lesser).ln();
            lesser * (bent / 6.0).exp()
        } else {
            (before.1 + lesser * 4.0 + after.1) / 6.0
        };
        (greater * grown, mean)
    }

    /// R/E and S/E now.
    pub fn shares(&self) -> [f64; 2] {
        let [e, r, s, _] = self.state.into();
        [r / e, s / e]
    }

    /// Contributions to the frequency, after this time, s, of one rad/s each of δ c_τ, δ s_τ, Δω c_ω and Δω s_ω, rad/s:
    /// together they are ½ Δω cos 4(θ−θ_ω) E/D − ½ δ sin 4(θ−θ_τ) Q/D.
    pub fn frequency_by_splits(&self, seconds: f64) -> [f64; 4] {
        let [e, r, s, q] = self.state_after(seconds).into();
        let apart = r * r + s * s;
        [-q * s, q * r, e * r, e * s]
            .map(|product: f64| 0.5 * product / apart.max(f64::MIN_POSITIVE))
    }

    /// Contribution of the pattern's turning now to the frequency, relative to the mean of both travelling waves weighted by their
    /// energies, rad/s: 2 θ̇ Q/E.
    pub fn frequency_by_turning(&self) -> f64 {
        let [e, r, s, q] = self.state.into();
        let slope = self.series.slope(&self.state);
        let turning = 0.25 * (r * slope[2] - s * slope[1]) / (r * r + s * s).max(f64::MIN_POSITIVE);
        2.0 * turning * q / e
    }

    /// Residuals: a_A, a_B and θ of a row less those of the wave now, and the derivatives of the latter by all parameters.
    ///
    /// Near a circle these three are not smooth, nor is noise in them symmetric. So the residuals are formed from the size of the greater
    /// travelling wave, and from the components of the lesser one along that of the row and across it, which elsewhere is equivalent.
    pub fn residuals(&self, row: &Row) -> (Vector3<f64>, SMatrix<f64, 3, PARAMETERS>) {
        let sign = 1f64.copysign(row.quadrature);
        let (now, lesser) = Self::travelling(&self.state, sign);
        let back = Complex::from_polar(1.0, -4.0 * row.angle);
        let [along, across] = [lesser * back, back * Complex::i()];
        // Derivatives by E, R, S and Q of the greater wave, and of the lesser along that of the row and across it.
        let of_greater = RowVector4::new(0.5, 0.0, 0.0, 0.5 * sign) / now;
        let of_along =
            RowVector4::new(0.0, back.re, across.re, 0.0) / now - of_greater * (along.re / now);
        let of_across =
            RowVector4::new(0.0, back.im, across.im, 0.0) / now - of_greater * (along.im / now);

        let size = row.main - row.quadrature.abs();
        // Below its noise a wave has no direction.
        let per_turn = 0.25 / size.max(row.deviations[0]);
        let (greater, lesser) = self.averaged(row.seconds, sign);
        let of_row = lesser * back;
        let (greater, along) = (row.main + row.quadrature.abs() - greater, size - of_row.re);
        let by_state = Matrix3x4::from_rows(&[
            (of_greater + of_along) * 0.5,
            (of_greater - of_along) * (0.5 * sign),
            of_across * per_turn,
        ]);
        (
            Vector3::new(
                0.5 * (greater + along),
                0.5 * sign * (greater - along),
                -of_row.im * per_turn,
            ),
            by_state * self.derivatives.transpose(),
        )
    }
}

#[cfg(test)]
mod tests;

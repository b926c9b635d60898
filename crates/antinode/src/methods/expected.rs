//! Expected sums of a window from a wave in white noise, in closed form.
//!
//! They predict each method's own leakage and bias, so that these are not taken for a fault.

use super::delayed::Delayed;
use super::moments::Moments;
use super::products::{Means, Products, mean_harmonic};
use super::reference::Noise;
use super::wave::Wave;

impl Moments {
    /// Expected moments of `wave` at `omega` rad a sample over `count` pairs, in `noise`, while the pattern turns by `turn` rad from the
    /// first sample to the last: turning blurs the angle.
    pub fn expected(wave: &Wave, omega: f64, count: u32, noise: &Noise, turn: f64) -> Self {
        let means = Means::new(omega, count);
        let (u, v) = wave.quadratures();
        let n = f64::from(count);
        let [cc, dd] = [0, 1].map(|i: usize| means.product(u[i], v[i], u[i], v[i]));
        let cd = means.product(u[0], v[0], u[1], v[1]);
        // 4θ sweeps ±2 turn, which shortens the mean of its unit vector to sin x/x.
        let x = 2.0 * turn;
        let blur = if x.abs() < 1e-4 {
            1.0 - x * x / 6.0
        } else {
            libm::sin(x) / x
        };
        let (half, difference) = (0.5 * (cc + dd), 0.5 * (cc - dd) * blur);
        Self {
            count,
            cc: n * (half + difference + noise.moments[0]),
            dd: n * (half - difference + noise.moments[1]),
            cd: n * (cd * blur + noise.moments[2]),
        }
    }
}

impl Products {
    /// Expected products of `wave` at its own frequency over `count` pairs.
    pub fn expected(wave: &Wave, omega: f64, count: u32) -> Self {
        let means = Means::new(omega, count);
        let first = mean_harmonic(1, omega, count);
        let (u, v) = wave.quadratures();
        Self {
            count,
            omega,
            cosine: [0, 1].map(|i: usize| means.product(u[i], v[i], 1.0, 0.0)),
            sine: [0, 1].map(|i: usize| means.product(u[i], v[i], 0.0, 1.0)),
            mean: [0, 1].map(|i: usize| u[i] * first.re - v[i] * first.im),
        }
    }
}

impl Delayed {
    /// Expected products of `wave` over `count` pairs in `noise` at a delay of `lag` samples, with the samples before the window.
    pub fn expected(wave: &Wave, omega: f64, count: u32, noise: &Noise, lag: u16) -> Self {
        let means = Means::new(omega, count);
        let (u, v) = wave.quadratures();
        // u cos ω(t − t₃) + v sin ω(t − t₃) as x cos ωt + y sin ωt.
        let (s, c) = libm::sincos(omega * f64::from(lag));
        let x = [0, 1].map(|i: usize| u[i] * c - v[i] * s);
        let y = [0, 1].map(|i: usize| u[i] * s + v[i] * c);
        let n = f64::from(count);
        let product = |i: usize, j: usize| n * means.product(u[i], v[i], x[j], y[j]);
        Self {
            lag,
            count,
            cd: product(0, 1),
            own: product(0, 0) + product(1, 1) + n * noise.delayed,
        }
    }
}

//! How badly a wave explains a window: the functionals (6), (18), (23), and (15).

use super::moments::Moments;
use super::products::{Means, Products};
use super::wave::Wave;
use crate::block::Pair;

/// J of (6), input units squared: the mean over samples of the squared residuals of both pick-offs. (14), (18) and (23) are this one.
///
/// From sums alone, and exact for any window. With noise of σ a sample a perfect wave has 2σ².
pub fn squares(wave: &Wave, moments: &Moments, products: &Products) -> f64 {
    let (u, v) = wave.quadratures();
    let means = Means::new(products.omega, products.count);
    let mut j = moments.power();
    for i in 0..2 {
        j -= 2.0 * (u[i] * products.cosine[i] + v[i] * products.sine[i]);
        j += means.product(u[i], v[i], u[i], v[i]);
    }
    j
}

/// Zero for negative values, which are due to rounding; NaN stays NaN.
pub(super) fn above_zero(squares: f64) -> f64 {
    if squares < 0.0 { 0.0 } else { squares }
}

/// The root of [`above_zero`].
pub(super) fn root(squares: f64) -> f64 {
    libm::sqrt(above_zero(squares))
}

/// (15), input units: the mean over samples of the absolute residuals of both pick-offs, at `omega` rad a sample. `pairs` are centred.
///
/// The paper has it for algorithm 1; here it serves any wave.
pub fn absolutes(wave: &Wave, pairs: &[Pair], omega: f64) -> f64 {
    let (u, v) = wave.quadratures();
    let (step_sine, step_cosine) = libm::sincos(omega);
    let (mut sine, mut cosine) = (0.0, 1.0);
    let mut sum = 0.0;
    for pair in pairs {
        for i in 0..2 {
            sum += (f64::from(pair[i]) - u[i] * cosine - v[i] * sine).abs();
        }
        (sine, cosine) = (
            sine * step_cosine + cosine * step_sine,
            cosine * step_cosine - sine * step_sine,
        );
    }
    sum / pairs.len() as f64
}

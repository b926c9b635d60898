//! The exact solution of (6) over a window, without (8): least squares in a_A, a_B, θ, α, ω and both offsets.
//!
//! At one ω the rest is linear, and its sums are closed forms: with X = Σ S e^{−jωt}, Y = Σ S, G_m = Σ e^{−jmωt} over n samples,
//! p = n/2 − |G₁|²/2n, q = G₂/2 − G₁²/2n and X′ = X − (Y/n)G₁ give z = (p X′ − q X′*)/(p² − |q|²) for ANY n > 3. ω is then J → min(ω).
//! The [`Tracker`](crate::Tracker) does this over blocks, with rates, deviations and checks; this is the plain form, for study.

use num_complex::Complex64;

use super::algorithm4;
use super::frequency;
use super::functional;
use super::moments::Moments;
use super::products::{Products, mean_harmonic};
use super::wave::Wave;
use crate::block::Pair;

/// Least-squares wave and offsets of a window at one frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solution {
    /// The wave; its phase stands at the window's first sample.
    pub wave: Wave,
    /// Offsets of S_C and S_D, input units.
    pub offsets: [f64; 2],
    /// ω, rad a sample.
    pub omega: f64,
    /// J, the mean squared residual of both pick-offs, input units squared.
    pub residual: f64,
}

/// The least-squares wave and offsets at the frequency of `products`, with `moments` of the same samples, of which there are more than 3.
pub fn at(products: &Products, moments: &Moments) -> Solution {
    let (omega, count) = (products.omega, products.count);
    let g1 = mean_harmonic(1, omega, count);
    let g2 = mean_harmonic(2, omega, count);
    // All sums are divided by n, and so are p and q.
    let p = 0.5 * (1.0 - g1.norm_sqr());
    let q = (g2 - g1 * g1) * 0.5;
    let scale = 1.0 / (p * p - q.norm_sqr());
    let mut fitted = *products;
    let mut offsets = [0.0; 2];
    let mut residual = moments.power();
    for (i, offset) in offsets.iter_mut().enumerate() {
        let x = Complex64::new(products.cosine[i], -products.sine[i]);
        let x = x - g1 * products.mean[i];
        let z = (x * p - q * x.conj()) * scale;
        *offset = products.mean[i] - (z * g1.conj()).re;
        residual -= products.mean[i] * products.mean[i] + (z * x.conj()).re;
        // (25) then gives the wave of phasor z, as z = 2⟨S e^{−jωt}⟩ in a window that fits the period.
        fitted.cosine[i] = 0.5 * z.re;
        fitted.sine[i] = -0.5 * z.im;
    }
    Solution {
        wave: algorithm4::wave(&fitted),
        offsets,
        omega,
        residual: functional::above_zero(residual),
    }
}

/// The least-squares solution of a window of n sample pairs. The search begins at `start`, rad a sample, within a third of 2π/n of the
/// truth.
pub fn solve(pairs: &[Pair], start: f64) -> Solution {
    let moments = Moments::of(pairs);
    let solution = |omega: f64| at(&Products::of(pairs, omega), &moments);
    let n = pairs.len() as u32;
    let step = core::f64::consts::TAU / (200.0 * f64::from(n.max(1)));
    let j = |omega: f64| solution(omega).residual;
    let rough = frequency::on_grid(start, step, 100, j);
    solution(frequency::exact(rough, n, j))
}

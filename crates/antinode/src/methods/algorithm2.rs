//! Algorithm 2: the phase shift between the pick-offs, formulas (16), (17) and (20).
//!
//! q = ⟨S_C(t) S_D(t − t₃)⟩ at a delay of a quarter period. A whole-sample delay misses the quarter by up to half a sample, and a_B is
//! then off by about a_A·(ωΔt₃)/2·sin 4θ; [`Delayed::quarter`] removes that error once per window.

use super::delayed::Delayed;
use super::functional::root;
use super::moments::Moments;
use super::wave::Shape;
use crate::block::Pair;

/// a_A, a_B and θ by (16) with a_B = (F − E)/2, an erratum. `q` is that of [`Delayed::q`], at the whole-sample lag as printed, or that of
/// [`Delayed::quarter`], at the fractional delay.
pub fn shape(moments: &Moments, q: f64) -> Shape {
    let (cc, dd, cd) = moments.means();
    let power = 2.0 * (cc + dd);
    let e = root(power + 4.0 * q);
    let f = root(power - 4.0 * q);
    Shape {
        main_amplitude: 0.5 * (e + f),
        quadrature_amplitude: 0.5 * (f - e),
        angle: 0.25 * libm::atan2(2.0 * cd, cc - dd),
    }
}

/// The quarter of a `period` in samples, to the nearest whole sample, at least 1.
pub fn quarter_lag(period: f32) -> u16 {
    libm::roundf(0.25 * period).clamp(1.0, 16_384.0) as u16
}

/// The lag by (17): of `near` − 1, `near` and `near` + 1 the one whose ⟨S(t) S(t − t₃)⟩ over both pick-offs is nearest to zero.
///
/// `pairs` are centred. Sums begin at index `start`, or later if there is no pair one lag before it.
pub fn choose_lag(pairs: &[Pair], start: usize, near: u16) -> u16 {
    let mut best = (f64::INFINITY, near.max(1));
    for lag in near.saturating_sub(1).max(1)..=near.saturating_add(1) {
        let delayed = Delayed::of(pairs, start, lag);
        let size = (delayed.own / f64::from(delayed.count)).abs();
        if size < best.0 {
            best = (size, lag);
        }
    }
    best.1
}

/// The monitor (20): Δφ_CD = φ_C − φ_D in rad, (−π, π], from tg Δφ_CD = q/⟨S_C S_D⟩, with S_C ∝ cos(ωt − φ_C) and S_D ∝ cos(ωt − φ_D).
///
/// Without quadrature it is 0, or π if S_C and S_D have opposite signs; with it, ±π/2 as the main wave passes a pick-off's axis.
pub fn phase_difference(moments: &Moments, q: f64) -> f64 {
    let (_, _, cd) = moments.means();
    libm::atan2(q, cd)
}

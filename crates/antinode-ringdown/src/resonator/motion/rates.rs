//! The state of a standing wave, and the rates that move it.

use nalgebra::{SMatrix, Vector4};

/// Number of rates that move a wave: 1/τ, δ c_τ, δ s_τ, Δω c_ω, Δω s_ω, γ, κ.
pub const RATES: usize = 7;
/// Number of parameters: the rates, and the wave at the start, a_A, a_B, θ.
pub const PARAMETERS: usize = RATES + 3;
/// The place of γ among them.
pub const GAMMA: usize = 5;
/// The place of κ.
pub const KAPPA: usize = 6;

/// The state E, R, S, Q of a wave with these a_A, a_B and θ.
pub fn state(main: f64, quadrature: f64, angle: f64) -> Vector4<f64> {
    let (sine, cosine) = (4.0 * angle).sin_cos();
    let apart = main * main - quadrature * quadrature;
    Vector4::new(
        main * main + quadrature * quadrature,
        apart * cosine,
        apart * sine,
        2.0 * main * quadrature,
    )
}

/// Slopes of the state E, R, S, Q per unit of each rate.
pub fn by_rates(state: &Vector4<f64>) -> SMatrix<f64, 4, RATES> {
    let [e, r, s, q] = (*state).into();
    let turning = Vector4::new(0.0, 2.0 * s, -2.0 * r, 0.0);
    SMatrix::from_columns(&[
        state * -2.0,
        Vector4::new(-r, -e, 0.0, 0.0),
        Vector4::new(-s, 0.0, -e, 0.0),
        Vector4::new(0.0, 0.0, -q, s),
        Vector4::new(0.0, q, 0.0, -r),
        turning * q,
        turning,
    ])
}

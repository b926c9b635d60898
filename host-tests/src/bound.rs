//! The Cramér–Rao bound of the seven-parameter problem, by inverting the Fisher matrix over a window's samples.

use antinode_sim::Wave;
use nalgebra::SMatrix;

/// Least standard deviations for white noise of one a sample and channel.
#[derive(Debug, Clone, Copy)]
pub struct Bound {
    /// Of a_A.
    pub main: f64,
    /// Of a_B.
    pub quadrature: f64,
    /// Of θ_A, rad.
    pub angle: f64,
    /// Of f, Hz.
    pub frequency: f64,
}

/// The bound for `wave` over `samples` about the time `middle` (s), with a_A, a_B, θ, ω, α and both offsets unknown.
pub fn bound(wave: &Wave, samples: u32, middle: f64, sample_rate: f64) -> Bound {
    let truth = wave.at(middle);
    let omega = std::f64::consts::TAU * truth.frequency / sample_rate;
    let (a, b) = (truth.main_amplitude, truth.quadrature_amplitude);
    let (s2, c2) = (2.0 * truth.angle).sin_cos();
    let mut fisher = SMatrix::<f64, 7, 7>::zeros();
    for k in 0..samples {
        let t = f64::from(k) - 0.5 * f64::from(samples - 1);
        let (s, c) = (omega * t - truth.phase).sin_cos();
        // (1)–(3) and their derivatives: with respect to τ, then to each parameter.
        let c_tau = -a * s * c2 - b * c * s2;
        let d_tau = -a * s * s2 + b * c * c2;
        let c_angle = -2.0 * (a * c * s2 + b * s * c2);
        let d_angle = 2.0 * (a * c * c2 - b * s * s2);
        for row in [
            [c * c2, -s * s2, c_angle, t * c_tau, -c_tau, 1.0, 0.0],
            [c * s2, s * c2, d_angle, t * d_tau, -d_tau, 0.0, 1.0],
        ] {
            let row = SMatrix::<f64, 1, 7>::from_row_slice(&row);
            fisher += row.transpose() * row;
        }
    }
    let covariance = fisher
        .try_inverse()
        .expect("a window of two periods or more determines the wave");
    let deviation = |i: usize| covariance[(i, i)].sqrt();
    Bound {
        main: deviation(0),
        quadrature: deviation(1),
        angle: deviation(2),
        frequency: deviation(3) * sample_rate / std::f64::consts::TAU,
    }
}

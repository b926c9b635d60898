//! The Cramér–Rao bounds of a window: the Fisher matrix over its samples inverted.

use std::f64::consts::TAU;

use antinode_sim::Wave;
use nalgebra::SMatrix;

/// Least standard deviations of a_A, a_B, θ (degrees) and f (Hz) over `count` sample pairs from t = 0, for noise of one a sample.
///
/// Unknown are a_A, a_B, θ, ω, α and both offsets. NaN where the window does not determine them. No unbiased estimate is better; a
/// biased one may be, as those of the four algorithms are on one period.
pub fn bound(wave: &Wave, count: usize, rate: f64) -> [f64; 4] {
    deviations(fisher(wave, count, rate).try_inverse(), rate)
}

/// The same for centred signals, with five unknowns.
pub fn centred_bound(wave: &Wave, count: usize, rate: f64) -> [f64; 4] {
    deviations(
        fisher(wave, count, rate)
            .fixed_resize::<5, 5>(0.0)
            .try_inverse(),
        rate,
    )
}

fn deviations<const N: usize>(covariance: Option<SMatrix<f64, N, N>>, rate: f64) -> [f64; 4] {
    let Some(covariance) = covariance else {
        return [f64::NAN; 4];
    };
    let deviation = |i: usize| covariance[(i, i)].sqrt();
    [
        deviation(0),
        deviation(1),
        deviation(2).to_degrees(),
        deviation(3) * rate / TAU,
    ]
}

/// The Fisher matrix for noise of one a sample: a_A, a_B, θ, ω, α at the middle, offsets.
fn fisher(wave: &Wave, count: usize, rate: f64) -> SMatrix<f64, 7, 7> {
    let omega = TAU * wave.frequency / rate;
    let (a, b) = (wave.main_amplitude, wave.quadrature_amplitude);
    let (s2, c2) = (2.0 * wave.angle).sin_cos();
    let middle = 0.5 * (count as f64 - 1.0);
    let mut fisher = SMatrix::<f64, 7, 7>::zeros();
    for k in 0..count {
        let t = k as f64;
        let (s, c) = (omega * t - wave.phase).sin_cos();
        // Derivatives of (1)–(3): with respect to τ and θ, then to each unknown.
        let tau = [-a * s * c2 - b * c * s2, -a * s * s2 + b * c * c2];
        let angle = [
            -2.0 * (a * c * s2 + b * s * c2),
            2.0 * (a * c * c2 - b * s * s2),
        ];
        for row in [
            [
                c * c2,
                -s * s2,
                angle[0],
                (t - middle) * tau[0],
                -tau[0],
                1.0,
                0.0,
            ],
            [
                c * s2,
                s * c2,
                angle[1],
                (t - middle) * tau[1],
                -tau[1],
                0.0,
                1.0,
            ],
        ] {
            let row = SMatrix::<f64, 1, 7>::from_row_slice(&row);
            fisher += row.transpose() * row;
        }
    }
    fisher
}

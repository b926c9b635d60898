//! The Cramér-Rao bound on unbiased identification of a window.

use std::f64::consts::TAU;

use libm::{sincos, sqrt};
use nalgebra::{SMatrix, SVector};

use crate::wave::Wave;

/// Smallest standard deviations of an unbiased estimate from one window, in white noise of rms 1 per sample and channel.
///
/// They are proportional to the noise: for noise of sigma rms, multiply each by sigma. The Fisher information of (1)-(3) is summed over the
/// window's samples and inverted, so that the bound holds for any window, short ones too. An estimate with a bias may scatter less.
///
/// ```
/// use antinode_sim::{Bound, Wave};
///
/// // Ten periods of the paper's wave at 100 kS/s: sqrt(2/n) for the amplitudes.
/// let wave = Wave::default();
/// let bound = Bound::new(&wave, 188, 0.1, 100_000.0).expect("ten periods determine a wave");
/// assert!((bound.main_amplitude / (2.0f64 / 188.0).sqrt() - 1.0).abs() < 0.01);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// Standard deviation of a_A, in units of the noise.
    pub main_amplitude: f64,
    /// Standard deviation of a_B, in units of the noise.
    pub quadrature_amplitude: f64,
    /// Standard deviation of theta, rad for noise of 1.
    pub angle: f64,
    /// Standard deviation of f, Hz for noise of 1.
    pub frequency: f64,
}

impl Bound {
    /// The bound for `samples` sample pairs at `sample_rate` Hz about the time `middle` (s). The unknowns are a_A, a_B, theta, omega, alpha
    /// and the offsets of both channels, constant over the window with the values that `wave` has at `middle`.
    ///
    /// `None` if the samples do not determine all seven: fewer than four, or a_A = |a_B|. Rounding hides what they determine in windows of
    /// less than 3 % of a period, where there may be `None` too.
    pub fn new(wave: &Wave, samples: u32, middle: f64, sample_rate: f64) -> Option<Self> {
        Self::of(
            fisher(wave, samples, middle, sample_rate),
            samples,
            sample_rate,
        )
    }

    /// The same for centred signals, (4): no offsets, five unknowns, and three samples determine them.
    pub fn centred(wave: &Wave, samples: u32, middle: f64, sample_rate: f64) -> Option<Self> {
        let fisher = fisher(wave, samples, middle, sample_rate).fixed_resize::<5, 5>(0.0);
        Self::of(fisher, samples, sample_rate)
    }

    fn of<const N: usize>(
        fisher: SMatrix<f64, N, N>,
        samples: u32,
        sample_rate: f64,
    ) -> Option<Self> {
        let factor = fisher.cholesky()?;
        // A pivot within the rounding of its diagonal: two unknowns that the window cannot tell apart.
        let determined = |i: usize| factor.l_dirty()[(i, i)].powi(2) > 1e-12 * fisher[(i, i)];
        if !(0..N).all(determined) {
            return None;
        }
        let covariance = factor.inverse();
        let deviation = |i: usize| sqrt(covariance[(i, i)]);
        Some(Self {
            main_amplitude: deviation(0),
            quadrature_amplitude: deviation(1),
            angle: deviation(2),
            frequency: deviation(3) * sample_rate / (TAU * f64::from(samples)),
        })
    }
}

/// The Fisher matrix for noise of rms 1: a_A, a_B, theta, omega (rad a window), alpha at the middle, both offsets.
fn fisher(wave: &Wave, samples: u32, middle: f64, sample_rate: f64) -> SMatrix<f64, 7, 7> {
    let truth = wave.at(middle);
    let omega = TAU * truth.frequency / sample_rate;
    let (a, b) = (truth.main_amplitude, truth.quadrature_amplitude);
    let (s2, c2) = sincos(2.0 * truth.angle);
    let n = f64::from(samples);
    // Derivatives of (1)-(3) by each unknown are sums of these five, with factors that are the same at all samples. Time in window lengths
    // keeps the matrix well scaled.
    let mut sums = SMatrix::<f64, 5, 5>::zeros();
    let (mut s, mut c) = sincos(-0.5 * omega * (n - 1.0) - truth.phase);
    let (sin_step, cos_step) = sincos(omega);
    for k in 0..samples {
        let share = (f64::from(k) - 0.5 * (n - 1.0)) / n;
        let parts = SVector::from([c, s, share * c, share * s, 1.0]);
        sums += parts * parts.transpose();
        (s, c) = (s * cos_step + c * sin_step, c * cos_step - s * sin_step);
    }
    // Along the pattern and across it: that both channels show these turned by two thetas matters to their offsets only.
    let along = SMatrix::<f64, 5, 7>::from_columns(&[
        [1.0, 0.0, 0.0, 0.0, 0.0].into(),
        SVector::zeros(),
        [0.0, -2.0 * b, 0.0, 0.0, 0.0].into(),
        [0.0, 0.0, 0.0, -a, 0.0].into(),
        [0.0, a, 0.0, 0.0, 0.0].into(),
        [0.0, 0.0, 0.0, 0.0, c2].into(),
        [0.0, 0.0, 0.0, 0.0, s2].into(),
    ]);
    let across = SMatrix::<f64, 5, 7>::from_columns(&[
        SVector::zeros(),
        [0.0, 1.0, 0.0, 0.0, 0.0].into(),
        [2.0 * a, 0.0, 0.0, 0.0, 0.0].into(),
        [0.0, 0.0, b, 0.0, 0.0].into(),
        [-b, 0.0, 0.0, 0.0, 0.0].into(),
        [0.0, 0.0, 0.0, 0.0, -s2].into(),
        [0.0, 0.0, 0.0, 0.0, c2].into(),
    ]);
    along.transpose() * sums * along + across.transpose() * sums * across
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fisher_matrix_is_that_of_numerical_derivatives() {
        // In windows of less than a period, and with much quadrature, every term counts.
        let wave = Wave {
            main_amplitude: 1.3,
            quadrature_amplitude: -0.7,
            angle: 0.4,
            phase: 2.1,
            ..Wave::default()
        };
        let (n, middle, rate) = (13, 0.1, 100_000.0);
        let signals = |[a, b, theta, omega, alpha, c0, d0]: [f64; 7]| {
            let each = (0..n).flat_map(move |k| {
                let tau = omega * ((f64::from(k) + 0.5) / f64::from(n) - 0.5) - alpha;
                let (x, y) = (a * tau.cos(), b * tau.sin());
                let (s2, c2) = sincos(2.0 * theta);
                [x * c2 - y * s2 + c0, x * s2 + y * c2 + d0]
            });
            each.collect::<Vec<_>>()
        };
        let truth = wave.at(middle);
        let values = [
            truth.main_amplitude,
            truth.quadrature_amplitude,
            truth.angle,
            TAU * truth.frequency / rate * f64::from(n),
            truth.phase,
            0.0,
            0.0,
        ];
        let derivatives: Vec<Vec<f64>> = (0..7)
            .map(|unknown| {
                let moved = |by: f64| {
                    let mut values = values;
                    values[unknown] += by;
                    signals(values)
                };
                let (before, after) = (moved(-1e-5), moved(1e-5));
                let pairs = before.iter().zip(after);
                pairs
                    .map(|(before, after)| (after - before) / 2e-5)
                    .collect()
            })
            .collect();
        let expected = SMatrix::<f64, 7, 7>::from_fn(|i, j| {
            let pairs = derivatives[i].iter().zip(&derivatives[j]);
            pairs.map(|(one, other)| one * other).sum()
        });
        let found = fisher(&wave, n, middle, rate);
        assert!((found - expected).amax() < 1e-7, "{found} {expected}");
    }

    #[test]
    fn in_long_windows_the_bound_equals_the_closed_forms() {
        let wave = Wave::default();
        let (n, rate) = (18_755, 100_000.0);
        let samples = f64::from(n);
        let power = wave.main_amplitude.powi(2) + wave.quadrature_amplitude.powi(2);
        let difference = wave.main_amplitude.powi(2) - wave.quadrature_amplitude.powi(2);
        let closed = [
            (2.0 / samples).sqrt(),
            (2.0 / samples).sqrt(),
            (power / (2.0 * samples)).sqrt() / difference,
            (24.0 / (power * samples)).sqrt() * rate / (TAU * samples),
        ];
        for bound in [Bound::new, Bound::centred] {
            let bound = bound(&wave, n, 0.7, rate).expect("a thousand periods determine it");
            let found = [
                bound.main_amplitude,
                bound.quadrature_amplitude,
                bound.angle,
                bound.frequency,
            ];
            for (found, closed) in found.iter().zip(closed) {
                assert!((found / closed - 1.0).abs() < 2e-3, "{found} {closed}");
            }
        }
    }

    #[test]
    fn unknown_offsets_raise_the_bound_in_short_windows_only() {
        let wave = Wave::default();
        let ratio = |n| {
            let [full, centred] = [Bound::new, Bound::centred].map(|bound| {
                bound(&wave, n, 0.0, 100_000.0)
                    .expect("determined")
                    .frequency
            });
            full / centred
        };
        assert!(ratio(19) > 1.2 && ratio(188) < 1.02 && ratio(188) >= 1.0);
    }

    #[test]
    fn a_window_that_does_not_determine_the_wave_has_no_bound() {
        let wave = Wave::default();
        // A fifth of a period and less.
        for samples in 0..5 {
            let [full, centred] =
                [Bound::new, Bound::centred].map(|bound| bound(&wave, samples, 0.0, 100_000.0));
            assert_eq!(full.is_some(), samples >= 4, "{samples}");
            assert_eq!(centred.is_some(), samples >= 3, "{samples}");
        }
        let circular = Wave {
            quadrature_amplitude: 2.0,
            ..wave
        };
        assert_eq!(Bound::new(&circular, 188, 0.0, 100_000.0), None);
    }
}

//! The exact solution that the methods are compared with, and its residual noise.

use super::wave::{Shape, Wave};
use crate::estimate::Estimate;

/// White noise in the sums of a window, input units squared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// ⟨n_C²⟩, ⟨n_D²⟩ and ⟨n_C n_D⟩.
    pub moments: [f64; 3],
    /// ⟨n_D(t) n_D(t − t₃)⟩: 0, unless S_D was computed from samples t₃ apart.
    pub delayed: f64,
}

impl Noise {
    /// Noise of equal variance in both pick-offs, independent from sample to sample, as a converter gives it.
    pub fn alike(variance: f64) -> Self {
        Self {
            moments: [variance, variance, 0.0],
            delayed: 0.0,
        }
    }
}

/// The exact solution that the methods are compared with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// The wave, with its phase at the window's first sample.
    pub wave: Wave,
    /// Standard deviations of a_A and a_B, input units, and θ, rad; all > 0.
    pub deviations: [f64; 3],
    /// Noise of the samples that went into the sums.
    pub noise: Noise,
    /// Standard deviation of a noise variance, relative to it.
    pub noise_uncertainty: f64,
    /// Turn of the pattern within the window, rad; 0 if it is lost in noise.
    pub turn: f64,
    /// Share of its amplitude that the wave loses within the window; 0 if it is lost in noise.
    pub decay: f64,
    /// Standard deviations of `turn` and `decay`.
    pub change_deviations: [f64; 2],
}

impl Reference {
    /// Reference of an estimate, at a sample rate in Hz, for sums of uncalibrated samples: a calibration that mixes or scales samples
    /// changes [`Noise`] too.
    pub fn of(estimate: &Estimate, sample_rate: f64) -> Self {
        let omega = core::f64::consts::TAU * estimate.frequency / sample_rate;
        let samples = f64::from(estimate.samples);
        let seconds = samples / sample_rate;
        // A rate below three deviations counts as none.
        let change = |rate: f32, deviation: f32| {
            let significant = rate.abs() > 3.0 * deviation;
            f64::from(if significant { rate } else { 0.0 }) * seconds
        };
        let deviations = [
            estimate.main_amplitude_std,
            estimate.quadrature_amplitude_std,
            estimate.angle_std,
        ];
        let noise = f64::from(estimate.residual_rms);
        // The core estimates noise from three sums per block and pick-off, less ten unknowns. Without a hop, a block has two periods, and a
        // window five blocks or more; with one it may have twice as many, and the deviation here is too large by up to √2.
        let blocks = (0.5 * samples * omega / core::f64::consts::TAU).max(5.0);
        Self {
            wave: Wave {
                shape: Shape {
                    main_amplitude: estimate.main_amplitude.into(),
                    quadrature_amplitude: estimate.quadrature_amplitude.into(),
                    angle: estimate.angle,
                },
                // The estimate's phase is that at the middle of the window.
                phase: f64::from(estimate.phase) + 0.5 * omega * (samples - 1.0),
            }
            // Reduced to half a turn.
            .near(estimate.angle),
            deviations: deviations.map(|x| f64::from(x.max(f32::MIN_POSITIVE))),
            noise: Noise::alike(noise * noise),
            noise_uncertainty: libm::sqrt(2.0 / (6.0 * blocks - 10.0)),
            turn: change(estimate.angle_rate, estimate.angle_rate_std),
            decay: change(estimate.decay_rate, estimate.decay_rate_std),
            change_deviations: [estimate.angle_rate_std, estimate.decay_rate_std]
                .map(|deviation| f64::from(deviation) * seconds),
        }
    }
}

//! Root mean squares of errors, relative to the bound and to the stated deviations.

use std::ops::Range;

use antinode::Estimate;
use antinode_sim::{Bound, Wave};

use crate::{RATE, angle_error};

/// Names of the four quantities, in the order of all arrays here.
pub const NAMES: [&str; 4] = [
    "main amplitude",
    "quadrature amplitude",
    "angle",
    "frequency",
];

/// Squared errors and stated deviations over the bound, summed over many windows.
#[derive(Debug, Clone, Copy, Default)]
pub struct Score {
    windows: f64,
    error: [f64; 4],
    stated: [f64; 4],
}

impl Score {
    /// Adds a window of a wave in white noise of `noise` rms a sample and channel.
    pub fn add(&mut self, estimate: &Estimate, wave: &Wave, noise: f64) {
        let bound = Bound::new(wave, estimate.samples, estimate.time, RATE)
            .expect("a window of two periods or more determines the wave");
        let bounds = [
            bound.main_amplitude,
            bound.quadrature_amplitude,
            bound.angle,
            bound.frequency,
        ];
        let stated = stated(estimate);
        self.windows += 1.0;
        for (i, error) in errors(estimate, wave).into_iter().enumerate() {
            let bound = bounds[i] * noise;
            self.error[i] += (error / bound).powi(2);
            self.stated[i] += (stated[i] / bound).powi(2);
        }
    }

    /// Count of windows added.
    pub fn windows(&self) -> usize {
        self.windows as usize
    }

    /// Rms error over the bound.
    pub fn error(&self) -> [f64; 4] {
        self.error.map(|sum| (sum / self.windows).sqrt())
    }

    /// Rms of the stated standard deviations over the bound.
    pub fn stated(&self) -> [f64; 4] {
        self.stated.map(|sum| (sum / self.windows).sqrt())
    }

    /// Prints both, and asserts that errors over the bound and stated deviations over errors are within these ranges.
    pub fn check(&self, label: &str, of_errors: Range<f64>, of_stated: Range<f64>) {
        let (error, stated) = (self.error(), self.stated());
        println!(
            "{label}: {} windows, rms error/bound {error:.3?}, stated/bound {stated:.3?}",
            self.windows()
        );
        for i in 0..4 {
            let (name, error, ratio) = (NAMES[i], error[i], stated[i] / error[i]);
            assert!(
                of_errors.contains(&error),
                "{label}: {name} at {error:.3} of the bound"
            );
            assert!(
                of_stated.contains(&ratio),
                "{label}: stated {name} is {ratio:.3} of the scatter"
            );
        }
    }
}

/// Squared errors over stated deviations, summed over many windows.
#[derive(Debug, Clone, Copy, Default)]
pub struct StatedRatio {
    windows: f64,
    squares: [f64; 4],
}

impl StatedRatio {
    /// Adds a window of a wave.
    pub fn add(&mut self, estimate: &Estimate, wave: &Wave) {
        let stated = stated(estimate);
        self.windows += 1.0;
        for (i, error) in errors(estimate, wave).into_iter().enumerate() {
            self.squares[i] += (error / stated[i]).powi(2);
        }
    }

    /// Adds the windows of a wave that have no flag; returns the count of the others.
    pub fn add_clean(&mut self, found: &[Estimate], wave: &Wave) -> usize {
        let is_clean = |estimate: &&Estimate| estimate.flags.is_empty();
        let (clean, flagged): (Vec<_>, Vec<_>) = found.iter().partition(is_clean);
        clean
            .into_iter()
            .for_each(|estimate| self.add(estimate, wave));
        flagged.len()
    }

    /// Rms error over the stated standard deviation.
    pub fn ratios(&self) -> [f64; 4] {
        self.squares.map(|sum| (sum / self.windows).sqrt())
    }
}

/// Errors of a_A, a_B (input units), θ (rad) and f (Hz) of an estimate, at its time.
pub fn errors(estimate: &Estimate, wave: &Wave) -> [f64; 4] {
    let truth = wave.at(estimate.time);
    [
        f64::from(estimate.main_amplitude) - truth.main_amplitude,
        f64::from(estimate.quadrature_amplitude) - truth.quadrature_amplitude,
        angle_error(estimate.angle, truth.angle),
        estimate.frequency - truth.frequency,
    ]
}

/// Standard deviations of a_A, a_B, θ and f that an estimate states.
pub fn stated(estimate: &Estimate) -> [f64; 4] {
    [
        estimate.main_amplitude_std,
        estimate.quadrature_amplitude_std,
        estimate.angle_std,
        estimate.frequency_std,
    ]
    .map(f64::from)
}

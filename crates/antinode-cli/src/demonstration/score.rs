//! Errors over all windows, against the least that any unbiased identification could have.

use std::f64::consts::TAU;
use std::io::{self, Write};

use antinode::Estimate;
use antinode_sim::Truth;

/// What is scored.
const NAMES: [&str; 4] = ["main amplitude", "quadrature", "angle, °", "frequency, Hz"];

/// Sums of squared errors and of squared Cramér–Rao bounds.
pub struct Score {
    noise: f64,
    sample_rate: f64,
    windows: u32,
    errors: [f64; 4],
    bounds: [f64; 4],
}

impl Score {
    /// Nothing yet, of samples with this noise, rms a sample and channel.
    pub fn new(noise: f64, sample_rate: f64) -> Self {
        Self {
            noise,
            sample_rate,
            windows: 0,
            errors: [0.0; 4],
            bounds: [0.0; 4],
        }
    }

    /// Takes one window and its truth.
    pub fn add(&mut self, e: &Estimate, truth: &Truth) {
        self.windows += 1;
        let errors = [
            f64::from(e.main_amplitude) - truth.main_amplitude,
            f64::from(e.quadrature_amplitude) - truth.quadrature_amplitude,
            (e.angle - truth.angle).to_degrees(),
            e.frequency - truth.frequency,
        ];
        let n = f64::from(e.samples);
        let (main, quadrature) = (
            truth.main_amplitude.powi(2),
            truth.quadrature_amplitude.powi(2),
        );
        let power = main + quadrature;
        let amplitude = self.noise * (2.0 / n).sqrt();
        let angle = self.noise * (power / (2.0 * n)).sqrt() / (main - quadrature);
        let duration = n / self.sample_rate;
        let frequency = self.noise * (24.0 / (power * n)).sqrt() / (TAU * duration);
        let bounds = [amplitude, amplitude, angle.to_degrees(), frequency];
        for i in 0..NAMES.len() {
            self.errors[i] += errors[i].powi(2);
            self.bounds[i] += bounds[i].powi(2);
        }
    }

    /// A table of the root mean squares.
    pub fn print(&self, out: &mut impl Write) -> io::Result<()> {
        writeln!(
            out,
            "\n{:<18} {:>12} {:>18} {:>8}",
            "over all windows", "rms error", "Cramér–Rao bound", "ratio"
        )?;
        for ((name, errors), bounds) in NAMES.iter().zip(self.errors).zip(self.bounds) {
            let [error, bound] = [errors, bounds].map(|sum| (sum / f64::from(self.windows)).sqrt());
            writeln!(
                out,
                "{name:<18} {error:>12.5} {bound:>18.5} {:>8.3}",
                error / bound
            )?;
        }
        Ok(())
    }
}

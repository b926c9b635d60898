//! Errors over all windows, beside the smallest that an unbiased identification can have.

use std::io::{self, Write};

use antinode::Estimate;
use antinode_sim::{Bound, Wave};

/// The quantities that are scored.
pub const NAMES: [&str; 4] = ["main amplitude", "quadrature", "angle, °", "frequency, Hz"];

/// Sums of squared errors and of squared Cramér–Rao bounds.
#[derive(Default)]
pub struct Score {
    noise: f64,
    sample_rate: f64,
    windows: u32,
    errors: [f64; 4],
    bounds: [f64; 4],
}

impl Score {
    /// No windows yet, of samples with this noise, rms a sample and channel.
    pub fn new(noise: f64, sample_rate: f64) -> Self {
        Self {
            noise,
            sample_rate,
            ..Self::default()
        }
    }

    /// Adds one window of a wave.
    pub fn add(&mut self, e: &Estimate, wave: &Wave) {
        let Some(bound) = Bound::new(wave, e.samples, e.time, self.sample_rate) else {
            return;
        };
        let truth = wave.at(e.time);
        let errors = [
            f64::from(e.main_amplitude) - truth.main_amplitude,
            f64::from(e.quadrature_amplitude) - truth.quadrature_amplitude,
            (e.angle - truth.angle).to_degrees(),
            e.frequency - truth.frequency,
        ];
        let bounds = [
            bound.main_amplitude,
            bound.quadrature_amplitude,
            bound.angle.to_degrees(),
            bound.frequency,
        ];
        self.windows += 1;
        for i in 0..NAMES.len() {
            self.errors[i] += errors[i].powi(2);
            self.bounds[i] += (self.noise * bounds[i]).powi(2);
        }
    }

    /// Prints a table of the root mean squares.
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

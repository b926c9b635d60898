//! The conditions that a study simulates: the paper's wave, rate, noise and windows, or others.

use std::f64::consts::FRAC_PI_6;
use std::fmt;

use antinode_sim::Wave;
use clap::Args;

use crate::ranges::{self, within};

/// Steps of figure 3's noise, from 0 to the greatest.
pub const STEPS: u32 = 20;

/// The conditions that are simulated. Frequency and main amplitude are always the paper's: all else is relative to them.
#[derive(Debug, Clone, Copy, PartialEq, Args)]
#[command(next_help_heading = "What is simulated", allow_negative_numbers = true)]
pub struct Simulated {
    /// Quadrature amplitude, signed, for a main amplitude of 2.
    #[arg(long, default_value_t = Self::PAPER.quadrature_amplitude, value_name = "LEVEL", value_parser = |text: &str| within(text, -1.9, 1.9, ", less than the main amplitude of 2"))]
    pub quadrature_amplitude: f64,
    /// Pattern angle, rad [default: π/6].
    #[arg(long, default_value_t = Self::PAPER.angle, hide_default_value = true, value_name = "RAD", value_parser = ranges::angle)]
    pub angle: f64,
    /// Phase at the first sample of a window, rad [default: π/6].
    #[arg(long, default_value_t = Self::PAPER.phase, hide_default_value = true, value_name = "RAD", value_parser = ranges::angle)]
    pub phase: f64,
    // 5 to 190 samples a period.
    /// Sample rate, Hz, for a frequency of 5332 Hz; figure 2 has 1 to 10 times this rate.
    #[arg(long, default_value_t = Self::PAPER.rate, value_name = "HZ", value_parser = |text: &str| within(text, 27_000.0, 1e6, " Hz"))]
    pub rate: f64,
    /// Periods in a window of figure 3, 1 to 100.
    #[arg(long, default_value_t = Self::PAPER.periods, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100))]
    pub periods: u32,
    /// Greatest noise of figure 3, % of the main amplitude, rms per sample and channel.
    #[arg(long, default_value_t = Self::PAPER.noise, value_name = "PERCENT", value_parser = |text: &str| within(text, 1e-3, 100.0, " %"))]
    pub noise: f64,
}

impl Simulated {
    /// The paper's conditions.
    pub const PAPER: Self = Self {
        quadrature_amplitude: 0.1,
        angle: FRAC_PI_6,
        phase: FRAC_PI_6,
        rate: 100_000.0,
        periods: 1,
        noise: 20.0,
    };

    /// The wave.
    pub fn wave(&self) -> Wave {
        Wave {
            quadrature_amplitude: self.quadrature_amplitude,
            angle: self.angle,
            phase: self.phase,
            ..Wave::default()
        }
    }

    /// Figure 3's noise at a step, % of a_A.
    pub fn percent(&self, step: u32) -> f64 {
        self.noise * f64::from(step) / f64::from(STEPS)
    }

    /// Length of a window of figure 3, in words.
    pub fn window(&self) -> String {
        match self.periods {
            1 => "one period".to_owned(),
            periods => format!("{periods} periods"),
        }
    }
}

impl fmt::Display for Simulated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Wave {
            main_amplitude,
            quadrature_amplitude,
            angle,
            phase,
            frequency,
            ..
        } = self.wave();
        write!(
            f,
            "a_A = {main_amplitude}, a_B = {quadrature_amplitude}, angle {angle:.4} rad, phase {phase:.4} rad at the first sample, \
             {frequency} Hz sampled at {} Hz.\nFigure 3: windows of {}, white noise of 0 to {} % of a_A.",
            self.rate,
            self.window(),
            self.noise,
        )
    }
}

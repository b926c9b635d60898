//! `antinode` alone: a simulated ring-down through the core, beside the truth.

use std::io::{self, Write};

use antinode::{Estimate, Identifier, Settings};
use antinode_sim::{Flaws, Gyro, Wave};

use crate::failure::Failure;
use crate::rows::with_std;

/// Sample rate, Hz.
const RATE: f64 = 100_000.0;
/// Length, s.
const SECONDS: f64 = 2.0;
/// Rows shown.
const SHOWN: usize = 8;

/// Shows what the core finds of a gyro that turns, decays and drifts in noise.
pub fn run() -> Result<(), Failure> {
    let wave = Wave {
        main_amplitude: 1.0,
        quadrature_amplitude: 0.05,
        angle: 30f64.to_radians(),
        phase: 30f64.to_radians(),
        frequency: 5332.0,
        frequency_rate: 0.05,
        angle_rate: 10f64.to_radians(),
        decay_rate: 0.5,
    };
    let flaws = Flaws { noise: 0.01, offset_c: 0.1, offset_d: -0.05, ..Flaws::default() };
    let usage = |error: antinode_sim::Error| Failure::Usage(error.to_string());
    let gyro = Gyro::new(wave, flaws.clone(), RATE, 1).map_err(usage)?;
    let mut core = Box::new(Identifier::<256, 256>::new(Settings::new(RATE))?);
    let pairs = gyro.take((SECONDS * RATE) as usize);
    let estimates: Vec<Estimate> = pairs.filter_map(|p| core.push([p.c as f32, p.d as f32])).collect();

    let mut out = io::stdout().lock();
    writeln!(
        out,
        "A gyro rings down for {SECONDS} s: two pick-offs at 100 kS/s, noise {} and offsets {} and {} of its first amplitude.\n\
         Windows of 10 periods, {} of them; above what was identified ± its stated deviation, below the truth.\n",
        flaws.noise, flaws.offset_c, flaws.offset_d, estimates.len(),
    )?;
    writeln!(out, "{:>8} {:>18} {:>18} {:>18} {:>18}", "time s", "main amplitude", "quadrature", "angle deg", "frequency Hz")?;
    for estimate in estimates.iter().step_by(estimates.len() / SHOWN + 1) {
        let truth = wave.at(estimate.time);
        writeln!(
            out,
            "{:>8.3} {:>18} {:>18} {:>18} {:>18}  {}",
            estimate.time,
            with_std(estimate.main_amplitude.into(), estimate.main_amplitude_std.into()),
            with_std(estimate.quadrature_amplitude.into(), estimate.quadrature_amplitude_std.into()),
            with_std(estimate.angle.to_degrees(), f64::from(estimate.angle_std).to_degrees()),
            with_std(estimate.frequency, estimate.frequency_std.into()),
            estimate.flags,
        )?;
        writeln!(
            out,
            "{:>8} {:<18} {:<18} {:<18} {:<18}",
            "truth",
            format!("{:>11.4}", truth.main_amplitude),
            format!("{:>11.4}", truth.quadrature_amplitude),
            format!("{:>11.3}", truth.angle.to_degrees()),
            format!("{:>11.2}", truth.frequency),
        )?;
    }
    let mut squares = [[0f64; 2]; 4];
    for e in &estimates {
        let truth = wave.at(e.time);
        let a = f64::from(e.main_amplitude) - truth.main_amplitude;
        let b = f64::from(e.quadrature_amplitude) - truth.quadrature_amplitude;
        let errors = [a, b, (e.angle - truth.angle).to_degrees(), e.frequency - truth.frequency];
        // The closed-form Cramér–Rao bounds.
        let (n, noise) = (f64::from(e.samples), flaws.noise);
        let (main, quadrature) = (truth.main_amplitude.powi(2), truth.quadrature_amplitude.powi(2));
        let power = main + quadrature;
        let amplitude = noise * (2.0 / n).sqrt();
        let angle = noise * (power / (2.0 * n)).sqrt() / (main - quadrature);
        let frequency = noise * (24.0 / (power * n)).sqrt() / (std::f64::consts::TAU * n / RATE);
        for (i, bound) in [amplitude, amplitude, angle.to_degrees(), frequency].into_iter().enumerate() {
            squares[i][0] += errors[i] * errors[i];
            squares[i][1] += bound * bound;
        }
    }
    writeln!(out, "\n{:28} {:>18} {:>18} {:>18}", "over all windows", "rms error", "Cramér–Rao bound", "ratio")?;
    let names = ["main amplitude", "quadrature amplitude", "angle, deg", "frequency, Hz"];
    for (name, square) in names.iter().zip(squares) {
        let [error, bound] = square.map(|sum| (sum / estimates.len() as f64).sqrt());
        writeln!(out, "{name:28} {error:>18.2e} {bound:>18.2e} {:>18.3}", error / bound)?;
    }
    writeln!(out, "\n`antinode identify FILE` does this with a recording, `antinode simulate -o FILE` writes one, `antinode --help` tells more.")?;
    Ok(())
}

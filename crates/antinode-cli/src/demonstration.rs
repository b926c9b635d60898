//! `antinode` without a command: a simulated ring-down identified by the core, beside the truth.

mod score;

use std::io::{self, Write};

use antinode::{Estimate, Identifier, Settings};
use antinode_sim::{Flaws, Gyro, Truth, Wave};

use crate::digits::{heading, with_std_to, without_std};
use crate::failure::Failure;
use score::{NAMES, Score};

/// Sample rate, Hz.
const RATE: f64 = 100_000.0;
/// Length, s.
const SECONDS: f64 = 2.0;
/// Windows shown.
const SHOWN: usize = 6;

/// Shows what the core identifies of a gyro that turns, decays and drifts in noise.
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
        ..Wave::default()
    };
    let flaws = Flaws {
        noise: 0.01,
        offset_c: 0.1,
        offset_d: -0.05,
        ..Flaws::default()
    };
    let noise = flaws.noise;
    let gyro = Gyro::new(wave, flaws, RATE, 1)?;
    let mut core = Box::new(Identifier::<f32, 256, 16>::new(Settings::new(RATE))?);
    let pairs = gyro.take((SECONDS * RATE) as usize);
    let estimates: Vec<Estimate> = pairs
        .filter_map(|pair| core.push(pair.map(|x| x as f32)))
        .collect();

    let mut out = io::stdout().lock();
    writeln!(
        out,
        "A simulated gyro rings down for {SECONDS} s, precesses at 10°/s, and its frequency drifts by 0.05 Hz/s.\nTwo pick-offs at 100 kS/s \
         with noise of 1 % and offsets of 10 % and -5 % of the initial amplitude.\n{} windows of 10 periods, {SHOWN} of them shown: \
         identified ± standard deviation, and the truth below.\n",
        estimates.len(),
    )?;
    let names = NAMES.map(heading).join(" ");
    writeln!(out, "{:>9} {names}", "time, s")?;
    for estimate in estimates.iter().step_by(estimates.len() / SHOWN + 1) {
        show(&mut out, estimate, &wave.at(estimate.time))?;
    }
    let mut score = Score::new(noise, RATE);
    for estimate in &estimates {
        score.add(estimate, &wave);
    }
    score.print(&mut out)?;
    writeln!(
        out,
        "\n`antinode identify FILE` does this with a recording; `antinode simulate -o FILE` makes one."
    )?;
    Ok(())
}

/// Prints one window, and the truth on a line of its own.
fn show(out: &mut impl Write, estimate: &Estimate, truth: &Truth) -> io::Result<()> {
    let found = [
        with_std_to(
            4,
            estimate.main_amplitude.into(),
            estimate.main_amplitude_std.into(),
        ),
        with_std_to(
            4,
            estimate.quadrature_amplitude.into(),
            estimate.quadrature_amplitude_std.into(),
        ),
        with_std_to(
            3,
            estimate.angle.to_degrees(),
            estimate.angle_std.to_degrees().into(),
        ),
        with_std_to(2, estimate.frequency, estimate.frequency_std.into()),
    ];
    let line = format!(
        "{:>9.3} {} {}",
        estimate.time,
        found.join(" "),
        estimate.flags
    );
    writeln!(out, "{}", line.trim_end())?;
    let right = [
        without_std(4, truth.main_amplitude),
        without_std(4, truth.quadrature_amplitude),
        without_std(3, truth.angle.to_degrees()),
        without_std(2, truth.frequency),
    ];
    let line = format!("{:>9} {}", "truth", right.join(" "));
    writeln!(out, "{}", line.trim_end())
}

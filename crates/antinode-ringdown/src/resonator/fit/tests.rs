//! Tests with rows from the averaged equations of a resonator, with noise.

mod damping;
mod frequency;
mod gaps;
mod joined;
mod known;
mod stiffness;
mod unsteady;

use std::f64::consts::TAU;

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::super::motion::Motion;
use super::*;
use crate::runs::{MIN_ROWS, Row};
use antinode_sim::Deviates;

/// 1/τ, δ c_τ, δ s_τ, Δω c_ω, Δω s_ω, γ.
const RESONATOR: [f64; 6] = [0.05, 0.006, -0.008, 0.03, 0.04, 0.0];
/// A resonator without splits.
const ROUND: [f64; 6] = [0.05, 0.0, 0.0, 0.0, 0.0, 0.0];
/// A row's standard deviation of an amplitude.
const NOISE: f64 = 1e-4;

/// A run of `count` rows, `step` s apart.
fn run(
    resonator: &[f64; 6],
    kappa: f64,
    start: [f64; 3],
    count: usize,
    step: f64,
    noise: f64,
    seed: u64,
) -> Run {
    run_turned(resonator, |_| -0.5 * kappa, start, count, step, noise, seed)
}

/// The same for a pattern that is turned at these rates, rad/s.
fn run_turned(
    resonator: &[f64; 6],
    rate: impl Fn(f64) -> f64,
    start: [f64; 3],
    count: usize,
    step: f64,
    noise: f64,
    seed: u64,
) -> Run {
    /// Number of rates from row to row.
    const PARTS: usize = 2;
    let mut random = Deviates::new(seed);
    let [decay, dc, ds, wc, ws, gamma] = *resonator;
    let [main, quadrature, angle] = start;
    let kappa = -2.0 * rate(0.0);
    let parameters = [decay, dc, ds, wc, ws, gamma, kappa, main, quadrature, angle];
    let mut motion = Motion::new(&parameters).of_frequency(TAU * 5332.0);
    let rows = (0..count)
        .map(|index| {
            let part = step / PARTS as f64;
            for k in 0..if index > 0 { PARTS } else { 0 } {
                motion.steer(rate(step * (index - 1) as f64 + part * (k as f64 + 0.5)));
                motion.move_state(part);
            }
            let wave = motion.wave();
            // Noise is equal in all components of both travelling waves, z₊ and z₋.
            let mut travelling = |sign: f64| {
                let size = wave[0] + sign * wave[1];
                let mut part = |of: f64| size * of + 2f64.sqrt() * noise * random.draw();
                let (sine, cosine) = (2.0 * wave[2]).sin_cos();
                Complex::new(part(cosine), part(sign * sine))
            };
            let (plus, minus) = (travelling(1.0), travelling(-1.0));
            let main = 0.5 * (plus.norm() + minus.norm());
            let quadrature = 0.5 * (plus.norm() - minus.norm());
            // The bounds of a window: θ: σ√(E/2n)/|D|, amplitudes: σ√(2/n).
            let of_angle = 0.5 * noise * main.hypot(quadrature) / (plus.norm() * minus.norm());
            let angle = 0.25 * (plus * minus.conj()).arg();
            let deviations = [noise, noise, of_angle].map(|std| std.max(1e-9));
            let time = 7.0 + step * index as f64;
            Row::of(time, [main, quadrature, angle], deviations)
        })
        .collect();
    Run {
        rows,
        file: String::new(),
    }
}

/// The rms of each of several errors over trials.
fn rms<const N: usize>(trials: &[[f64; N]]) -> [f64; N] {
    std::array::from_fn(|i| {
        let squares = trials.iter().map(|errors| errors[i] * errors[i]);
        (squares.sum::<f64>() / trials.len() as f64).sqrt()
    })
}

/// Ring-downs at three angles 22.5° apart on a table at rest, where the Earth turns the patterns.
fn at_three_angles(noise: f64, seed: u64) -> Vec<Run> {
    [0.2, 0.59, 0.98]
        .into_iter()
        .enumerate()
        .map(|(index, angle)| {
            run(
                &RESONATOR,
                4e-5,
                [1.0, 0.02, angle],
                400,
                0.1,
                noise,
                3 * seed + index as u64,
            )
        })
        .collect()
}

#[test]
fn without_noise_the_resonator_is_found() {
    for runs in [
        at_three_angles(0.0, 1),
        // One that turns by half a circle and more.
        vec![run(&RESONATOR, 0.2, [1.0, -0.05, 0.4], 400, 0.1, 0.0, 1)],
        // Rows so far apart that splits and rotation move much between them.
        vec![
            run(&RESONATOR, 0.03, [0.5, 0.1, 0.4], 30, 5.0, 0.0, 1),
            run(&RESONATOR, -0.03, [0.5, 0.1, 0.4], 30, 5.0, 0.0, 1),
        ],
    ] {
        let found = fit(&runs).unwrap();
        let resonator = found.resonator().unwrap();
        for (value, truth) in found.values.iter().zip(&RESONATOR[..5]) {
            assert!((value - truth).abs() < 1e-7, "{value} {truth}");
        }
        for (index, run) in runs.iter().enumerate() {
            let along = run.rows.iter().map(|row| {
                let (sine, cosine) = (4.0 * row.angle).sin_cos();
                let [main, quadrature] = [row.main * row.main, row.quadrature * row.quadrature];
                let share = (main - quadrature) / (main + quadrature);
                RESONATOR[0] + 0.5 * share * (RESONATOR[1] * cosine + RESONATOR[2] * sine)
            });
            let mean = along.sum::<f64>() / run.rows.len() as f64;
            assert!((found.decay_of_run(index).0 - mean).abs() < 1e-7);
        }
        let [(damping, _), (damped_at, _)] = resonator.damping_split;
        assert!((damping - 0.01).abs() < 1e-7);
        assert!((damped_at - 0.25 * (-0.8f64).atan2(0.6)).abs() < 1e-5);
        let [(split, _), (highest_at, _)] = resonator.frequency_split;
        assert!((split - 0.05).abs() < 1e-7);
        assert!((highest_at - 0.25 * 0.8f64.atan2(0.6)).abs() < 1e-5);
    }
}

#[test]
fn stated_deviations_are_the_rms_errors() {
    let mut squares = [0.0; 5 + 3 + 4];
    let mut residuals = 0.0;
    let trials = 100;
    for seed in 0..trials {
        let found = fit(&at_three_angles(NOISE, seed)).unwrap();
        let resonator = found.resonator().unwrap();
        let mut errors: Vec<_> = (0..5)
            .map(|i| (found.values[i] - RESONATOR[i]) / found.variance(i).sqrt())
            .collect();
        for run in 0..3 {
            let (rotation, deviation) = resonator.rotations[run];
            errors.push((rotation + 2e-5) / deviation);
        }
        // Splits of 0.01 and 0.05, by 3-4-5 triangles.
        for (split, size, angle) in [
            (resonator.damping_split, 0.01, 0.25 * (-0.8f64).atan2(0.6)),
            (resonator.frequency_split, 0.05, 0.25 * 0.8f64.atan2(0.6)),
        ] {
            let truth = [size, angle];
            let measured = split.into_iter().zip(truth);
            errors.extend(measured.map(|((value, deviation), truth)| (value - truth) / deviation));
        }
        for (sum, error) in squares.iter_mut().zip(errors) {
            *sum += error * error / trials as f64;
        }
        residuals += found.residual / trials as f64;
    }
    // Of 100 trials the rms scatters by 7 %.
    for square in squares {
        assert!((0.79..1.21).contains(&square.sqrt()), "{squares:?}");
    }
    assert!((residuals - 1.0).abs() < 0.01, "{residuals}");
}

#[test]
fn a_pattern_that_becomes_a_circle_determines_the_same() {
    // Between the axes of frequency a split makes a circle of a line, and back, twice in 60 s; others begin as circles.
    let highest = 0.25 * 0.8f64.atan2(0.6);
    let between = highest + std::f64::consts::FRAC_PI_8;
    for starts in [
        [[1.0, 0.0, between]; 2],
        [[1.0, 0.02, between], [1.0, -0.1, between + 0.01]],
        [[0.7, 0.699, 0.2], [0.7, -0.65, 0.9]],
        [[0.7, 0.7, 0.2], [0.7, -0.7, 0.9]],
    ] {
        let mut squares = [0.0; 5];
        let trials = 40;
        for seed in 0..trials {
            let runs = [0.0, 0.1].map(|kappa| {
                let start = starts[usize::from(kappa > 0.0)];
                let mut run = run(&RESONATOR, kappa, start, 600, 0.1, 10.0 * NOISE, 2 * seed);
                // Without the circular rows that the core flags.
                run.rows.retain(|row| {
                    row.main - row.quadrature.abs() > 6.0 * 10.0 * NOISE * 2f64.sqrt()
                });
                run
            });
            let found = fit(&runs).unwrap();
            assert!(found.resonator().is_some());
            assert!((found.residual - 1.0).abs() < 0.06, "{}", found.residual);
            for (i, (square, truth)) in squares.iter_mut().zip(RESONATOR).enumerate() {
                let error = (found.values[i] - truth) / found.variance(i).sqrt();
                assert!(error.abs() < 5.0, "{starts:?}, {i}: {error}");
                *square += error * error / trials as f64;
            }
        }
        // Of 40 trials the rms scatters by 11 %.
        for square in squares {
            assert!(
                (0.67..1.33).contains(&square.sqrt()),
                "{starts:?}: {squares:?}"
            );
        }
    }
}

#[test]
fn the_decay_along_a_pattern_at_rest_reaches_the_bound() {
    let [mut errors, mut deviations] = [0.0; 2];
    let trials = 100;
    for seed in 0..trials {
        // 6 decay times.
        let runs = [run(&ROUND, 0.0, [1.0, 0.01, 0.2], 1200, 0.1, NOISE, seed)];
        let found = fit(&runs).unwrap();
        assert!(found.resonator().is_none());
        let (decay, deviation) = found.decay_of_run(0);
        // σ_Q/Q = 4σ/(√E₀·√(fs τ)); a row of n samples has an amplitude to σ√(2/n), so that this is 2√2 of it times √(Δt/τ).
        let bound = 2.0 * 2f64.sqrt() * NOISE * (ROUND[0] * 0.1).sqrt();
        errors += ((decay / ROUND[0] - 1.0) / bound).powi(2) / trials as f64;
        deviations += deviation / ROUND[0] / bound / trials as f64;
    }
    assert!((0.99..1.02).contains(&deviations), "{deviations}");
    // Of 100 trials the rms scatters by 7 %.
    assert!((0.8..1.2).contains(&errors.sqrt()), "{errors}");
}

#[test]
fn a_residual_beyond_noise_widens_the_deviations() {
    let honest = at_three_angles(NOISE, 1);
    let [honest, boastful, modest] = [1.0, 0.1, 1.3].map(|by| {
        let mut runs = honest.clone();
        for row in runs.iter_mut().flat_map(|run| &mut run.rows) {
            row.deviations = row.deviations.map(|deviation| by * deviation);
        }
        fit(&runs).unwrap()
    });
    assert!(modest.is_below_noise() && !honest.is_below_noise() && !boastful.is_below_noise());
    assert!((boastful.residual / honest.residual - 10.0).abs() < 1e-3);
    for i in 0..5 {
        let ratio = (boastful.variance(i) / honest.variance(i)).sqrt();
        assert!(
            (ratio / honest.residual.min(1.0) - 1.0).abs() < 0.05,
            "{i}: {ratio}"
        );
    }
}

#[test]
fn steps_converge_if_windows_turn_far_and_rows_are_not_quite_a_decay() {
    let small = [0.1, -0.005, 0.0109, 0.0091, -0.0234, 0.0];
    (0..6).into_par_iter().for_each(|seed| {
        let step = 0.009377;
        let mut run = run(&small, -60.0, [1.0, 0.04, 0.05], 639, step, 3e-4, seed);
        for row in &mut run.rows {
            row.seconds = step;
            // Quadrature that grows by itself.
            row.quadrature += 1e-3 * (row.time - 7.0);
        }
        let found = fit(&[run]).unwrap();
        assert!(found.resonator().is_some(), "{seed}");
    });
}

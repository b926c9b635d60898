//! The core against an independent batch fit of the seven parameters to the same samples in f64.

use antinode_sim::{Flaws, Gyro, random_wave};
use host_tests::oracle::{Oracle, fit};
use host_tests::{RATE, angle_error, identify, phase_error, windows};

#[test]
fn core_and_oracle_agree() {
    let names = ["a_A", "a_B", "θ", "α", "f"];
    let (mut squares, mut rows) = ([0.0; 5], 0.0);
    for seed in 0..60 {
        let period = 5.0 + 40.0 * (seed as f64 * 0.618_034).fract();
        let wave = random_wave(seed, RATE / period, 0.3);
        let a = wave.main_amplitude;
        let noise = [0.0, 1e-3, 0.02][(seed % 3) as usize];
        let flaws = Flaws {
            noise: noise * a,
            offset_c: 0.4 * a,
            offset_d: -0.2 * a,
            ..Flaws::default()
        };
        let samples = (period * 80.0) as usize;
        let estimates = identify(wave, &flaws, windows(10), samples, seed);
        let gyro = Gyro::new(wave, flaws, RATE, seed).unwrap();
        let pairs: Vec<[f64; 2]> = gyro.take(samples).collect();
        assert!(estimates.len() >= 5);
        for estimate in &estimates {
            let truth = wave.at(estimate.time);
            let window = &pairs[estimate.start as usize..][..estimate.samples as usize];
            let oracle = fit(
                window,
                Oracle {
                    main: truth.main_amplitude,
                    quadrature: truth.quadrature_amplitude,
                    angle: truth.angle,
                    omega: std::f64::consts::TAU * truth.frequency / RATE,
                    phase: truth.phase,
                    offsets: [0.4 * a, -0.2 * a],
                },
            );
            let frequency = oracle.omega * RATE / std::f64::consts::TAU;
            let errors = [
                f64::from(estimate.main_amplitude) - oracle.main,
                f64::from(estimate.quadrature_amplitude) - oracle.quadrature,
                angle_error(estimate.angle, oracle.angle),
                phase_error(f64::from(estimate.phase), oracle.phase),
                estimate.frequency - frequency,
            ];
            let stds = [
                estimate.main_amplitude_std,
                estimate.quadrature_amplitude_std,
                estimate.angle_std,
                estimate.phase_std,
                estimate.frequency_std,
            ];
            let rounding = [1e-6, 1e-6, 1e-6, 2e-6, 1e-7 * frequency];
            // Both are unbiased and efficient: they may differ by a part of the noise's effect, and by rounding. Five blocks determine the
            // frequency slightly less well than all their samples.
            let parts = [0.2, 0.2, 0.2, 0.2, 1.5];
            for i in 0..5 {
                let (error, std) = (errors[i], f64::from(stds[i]));
                let limit = parts[i] * std + rounding[i];
                assert!(
                    error.abs() < limit,
                    "seed {seed}: {} off by {error:e}, {limit:e} allowed",
                    names[i]
                );
                squares[i] += if noise > 0.0 {
                    (error / std).powi(2)
                } else {
                    0.0
                };
            }
            rows += if noise > 0.0 { 1.0 } else { 0.0 };
        }
    }
    for ((name, square), limit) in names
        .iter()
        .zip(squares)
        .zip([0.05, 0.05, 0.05, 0.05, 0.26])
    {
        let rms = f64::sqrt(square / rows);
        println!("{name}: core and oracle differ by {rms:.3} of a deviation");
        assert!(rms < limit, "{name}: {rms}");
    }
}

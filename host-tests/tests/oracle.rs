//! The core against an independent batch fit of the seven parameters to the same samples in f64.

use antinode_sim::{Flaws, Gyro, random_wave};
use host_tests::oracle::{Oracle, fit};
use host_tests::{RATE, angle_error, identify, phase_error, windows};

#[test]
fn core_and_oracle_agree() {
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
        let pairs: Vec<[f64; 2]> = gyro.take(samples).map(|pair| [pair.c, pair.d]).collect();
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
            // Both are unbiased and efficient: they may differ by a part of the noise's own effect, and by rounding.
            let near = |name, error: f64, std: f32, rounding: f64| {
                let limit = 1.0 * f64::from(std) + rounding;
                assert!(
                    error.abs() < limit,
                    "seed {seed}: {name} off by {error:e}, {limit:e} allowed"
                );
            };
            near(
                "a_A",
                f64::from(estimate.main_amplitude) - oracle.main,
                estimate.main_amplitude_std,
                1e-6,
            );
            near(
                "a_B",
                f64::from(estimate.quadrature_amplitude) - oracle.quadrature,
                estimate.quadrature_amplitude_std,
                1e-6,
            );
            near(
                "θ",
                angle_error(estimate.angle, oracle.angle),
                estimate.angle_std,
                1e-6,
            );
            near(
                "α",
                phase_error(f64::from(estimate.phase), oracle.phase),
                estimate.phase_std,
                2e-6,
            );
            near(
                "f",
                estimate.frequency - frequency,
                1.5 * estimate.frequency_std,
                1e-7 * frequency,
            );
        }
    }
}

//! Noise-free waves: errors are those of rounding, for any window, offset and samples a period.

use antinode::Settings;
use antinode::methods::{Products, algorithm4};
use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::score::errors;
use host_tests::{RATE, calibrated, identify, windows};

/// The number `seed` of a sequence that is spread evenly over 0…1.
fn even(seed: u64, step: f64) -> f64 {
    (seed as f64 * step).fract()
}

/// The largest errors of a_A, a_B and f, relative, and of θ, and the largest residual and deviation of a_A, relative to it, of 600 waves
/// with |a_B| up to `share` of a_A and offsets up to a_A, in windows of 2 to 100 periods at 4.3 to 190 samples a period, both spaced evenly
/// in their logarithm. `at_corner` |a_B| and offsets are as large as that, and periods whole numbers, with which rounding repeats.
fn worst(share: f64, at_corner: bool, hop: Option<u16>) -> [f64; 6] {
    let mut worst = [0f64; 6];
    for seed in 0..600 {
        let mut period = 4.3 * (190.0f64 / 4.3).powf(even(seed, 0.618_034));
        if at_corner {
            period = period.ceil();
        }
        let periods = (2.0 * 50f64.powf(even(seed, 0.754_878))).round() as u16;
        let mut wave = random_wave(seed, RATE / period, share);
        let a = wave.main_amplitude;
        let mut offsets = [0.569_84, 0.414_21].map(|step| a * (2.0 * even(seed, step) - 1.0));
        if at_corner {
            wave.quadrature_amplitude = (share * a).copysign(wave.quadrature_amplitude);
            offsets = offsets.map(|offset| a.copysign(offset));
        }
        let flaws = Flaws {
            offset_c: offsets[0],
            offset_d: offsets[1],
            ..Flaws::default()
        };
        let samples = (period * (f64::from(periods) * 3.2 + 10.0)) as usize;
        let settings = Settings {
            hop,
            ..windows(periods)
        };
        let estimates = identify(wave, &flaws, settings, samples, seed);
        assert!(
            estimates.len() >= 3,
            "seed {seed}: {} windows",
            estimates.len()
        );
        for estimate in estimates {
            assert!(estimate.flags.is_empty(), "seed {seed}: {}", estimate.flags);
            let [main, quadrature, angle, frequency] = errors(&estimate, &wave);
            let [residual, deviation] =
                [estimate.residual_rms, estimate.main_amplitude_std].map(f64::from);
            let relative = [
                main / a,
                quadrature / a,
                angle,
                frequency / wave.frequency,
                residual / a,
                deviation / a,
            ];
            for (worst, error) in worst.iter_mut().zip(relative) {
                *worst = worst.max(error.abs());
            }
            for (i, offset) in offsets.into_iter().enumerate() {
                let error = (f64::from(estimate.offsets[i]) - offset).abs() / a;
                assert!(error < 2e-6, "seed {seed}: offset {error:e}");
            }
        }
    }
    worst
}

#[test]
fn errors_are_below_rounding_in_any_window_at_any_offset_and_rate() {
    for (share, at_corner, hop, of_angle, of_frequency) in [
        (0.5, false, None, 1e-6, 2e-7),
        (0.5, false, Some(1), 1e-6, 2e-7),
        (0.5, true, None, 1e-6, 2e-7),
        (0.9, false, None, 1e-6, 6e-7),
        (0.9, false, Some(1), 1e-6, 6e-7),
        (0.9, true, None, 3e-6, 6e-7),
        (0.9, true, Some(1), 3e-6, 6e-7),
    ] {
        let worst = worst(share, at_corner, hop);
        println!(
            "|a_B| up to {share} a_A, at the corner: {at_corner}, hop {hop:?}: a_A {:.1e}, a_B {:.1e} of a_A, θ {:.1e} rad, f {:.1e} of f; residual {:.1e}, deviation {:.1e} of a_A",
            worst[0], worst[1], worst[2], worst[3], worst[4], worst[5]
        );
        assert!(worst[0] < 1e-6 && worst[1] < 1e-6, "{worst:?}");
        assert!(worst[2] < of_angle, "{worst:?}");
        assert!(worst[3] < of_frequency, "{worst:?}");
        // What rounding leaves, and what the stated deviations allow for it: more where offsets make samples larger.
        let more = if at_corner { 2.0 } else { 1.0 };
        assert!(
            worst[4] < more * 1e-5 && worst[5] < more * 1e-6,
            "{worst:?}"
        );
    }
}

#[test]
fn algorithm_4_as_printed_leaks_while_the_core_does_not() {
    let wave = Wave::default();
    println!("periods   algorithm 4: a_A, a_B, θ       core: a_A, a_B, θ");
    for periods in [2u16, 3, 4, 5, 8, 10] {
        let samples = (f64::from(periods) * RATE / wave.frequency).round() as usize;
        let pairs: Vec<[f32; 2]> = (0..samples)
            .map(|k| {
                let [c, d] = wave.pick_offs(k as f64 / RATE);
                [c as f32, d as f32]
            })
            .collect();
        let omega = std::f64::consts::TAU * wave.frequency / RATE;
        let found = algorithm4::wave(&Products::of(&pairs, omega)).shape;
        let printed = [
            found.main_amplitude - wave.main_amplitude,
            found.quadrature_amplitude - wave.quadrature_amplitude,
            found.angle - wave.angle,
        ]
        .map(f64::abs);
        let run = identify(wave, &Flaws::default(), windows(periods), 500, 0);
        let core = errors(&run[0], &wave).map(f64::abs);
        println!(
            "{periods:7}   {:.1e} {:.1e} {:.1e}        {:.1e} {:.1e} {:.1e}",
            printed[0], printed[1], printed[2], core[0], core[1], core[2]
        );
        assert!(core[0] < 2e-6 && core[1] < 2e-6 && core[2] < 1e-6);
        // It is best at 4 and 8 periods, which fit the sampling grid, and still far above rounding.
        assert!(
            printed[0] > 50.0 * core[0].max(1e-7),
            "{periods}: {printed:?}"
        );
    }
}

#[test]
fn phase_and_time_reproduce_the_samples() {
    let wave = Wave {
        main_amplitude: 1.0,
        quadrature_amplitude: -0.2,
        angle: 0.9,
        ..Wave::default()
    };
    let found = identify(wave, &Flaws::default(), windows(7), 4000, 0);
    assert!(found.len() > 25, "{}", found.len());
    for estimate in found {
        let t = estimate.time + 1.234e-4;
        let tau = std::f64::consts::TAU * estimate.frequency * (t - estimate.time)
            - f64::from(estimate.phase);
        let main = f64::from(estimate.main_amplitude) * tau.cos();
        let quadrature = f64::from(estimate.quadrature_amplitude) * tau.sin();
        let (s2, c2) = (2.0 * estimate.angle).sin_cos();
        let [c, d] = wave.pick_offs(t);
        assert!((main * c2 - quadrature * s2 - c).abs() < 3e-6);
        assert!((main * s2 + quadrature * c2 - d).abs() < 3e-6);
    }
}

#[test]
fn a_wave_that_decays_and_turns_fast_is_exact_too() {
    // Within a window the amplitude falls by a fifth and the pattern turns by a degree: they change within blocks,
    // and between the sampling of both pick-offs, a tenth of a period apart.
    let mut worst = 0f64;
    for seed in 0..30 {
        let wave = Wave {
            decay_rate: 300.0,
            angle_rate: 20.0,
            ..random_wave(seed, 5332.0, 0.3)
        };
        let flaws = Flaws {
            skew: [0.0, 2e-5, -2e-5][seed as usize % 3],
            ..Flaws::default()
        };
        let found = identify(wave, &flaws, calibrated(&flaws, 4), 900, 0);
        assert!(found.len() > 8, "{}", found.len());
        for estimate in found {
            let a = wave.at(estimate.time).main_amplitude;
            let [main, quadrature, angle, frequency] = errors(&estimate, &wave);
            for error in [main / a, quadrature / a, angle, frequency / wave.frequency] {
                assert!(error.abs() < 2e-6, "{error:e}");
                worst = worst.max(error.abs());
            }
        }
    }
    println!("worst relative error {worst:.1e}");
    assert!(worst < 2e-6, "{worst:e}");
}

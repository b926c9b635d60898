//! Faults of the electronics in a window by itself: flattened crests, harmonics, tones, and dead pick-offs.

use antinode::{Calibration, Estimate, Flags, Settings};
use antinode_sim::{Flaws, Gyro, Wave};
use host_tests::{
    Core, RATE, calibrated, changed, gyro, identify, identify_changed, no_wave, touched, windows,
};

#[test]
fn flattened_crests_are_flagged_in_noise_without_a_known_rail() {
    for seed in 0..10 {
        let (wave, _) = gyro(seed);
        let (s2, c2) = (2.0 * wave.at(0.5).angle).sin_cos();
        let level = 0.75 * wave.at(0.5).main_amplitude * s2.abs().max(c2.abs());
        let estimates = changed(seed, 0.1, 10, 90_000, |k, pair| {
            if (40_000..60_000).contains(&k) {
                pair.map(|s| s.clamp(-level, level))
            } else {
                pair
            }
        });
        let touched = touched(&estimates, 40_200, 59_800);
        assert!(touched.len() > 100, "{}", touched.len());
        for estimate in touched {
            assert!(
                estimate.flags.contains(Flags::CLIPPED),
                "seed {seed}: {estimate:?}"
            );
        }
    }
}

#[test]
fn a_limit_below_the_known_rails_is_flagged_too() {
    for seed in 0..10 {
        let (wave, flaws) = gyro(seed);
        let wave = Wave {
            angle: 0.02,
            angle_rate: 0.0,
            decay_rate: 0.0,
            ..wave
        };
        let flaws = Flaws {
            noise: 0.1 * wave.main_amplitude,
            ..flaws
        };
        let level = 0.85 * wave.main_amplitude;
        let settings = Settings {
            rails: Some([-100.0, 100.0]),
            ..windows(10)
        };
        let found = identify_changed(wave, &flaws, settings, 20_000, seed, |_, pair| {
            pair.map(|s| s.clamp(-level, level))
        });
        let clipped = |e: &&Estimate| e.flags.contains(Flags::CLIPPED);
        let count = found.iter().filter(clipped).count();
        assert!(count > 95, "seed {seed}: {count} of {}", found.len());
    }
}

#[test]
fn a_limiter_before_the_noise_is_flagged_by_its_harmonic() {
    for seed in 0..10 {
        let wave = Wave {
            angle_rate: 0.0,
            ..gyro(seed).0
        };
        let a = wave.main_amplitude;
        let (s2, c2) = (2.0 * wave.at(0.3).angle).sin_cos();
        let level = 0.9 * a * s2.abs().max(c2.abs());
        let mut state = 77 + seed;
        let mut noise = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            0.01 * a * ((state >> 11) as f64 / (1u64 << 53) as f64 - 0.5)
        };
        // Amplifiers that limit, before a noisy converter: no two samples are equal.
        let mut core = Core::new(windows(10)).unwrap();
        let gyro = Gyro::new(wave, Flaws::default(), RATE, seed).unwrap();
        let mut estimates = Vec::new();
        for (k, pair) in gyro.take(60_000).enumerate() {
            let limit = if k < 30_000 { f64::INFINITY } else { level };
            let [c, d] = pair.map(|s| (s.clamp(-limit, limit) + noise()) as f32);
            estimates.extend(core.push([c, d]));
        }
        let limited = estimates.iter().filter(|e| e.start >= 30_000).count();
        assert!(limited > 150 && estimates.len() > 300, "{limited}");
        for estimate in &estimates {
            if estimate.start >= 30_000 {
                assert!(
                    estimate.flags.contains(Flags::CLIPPED),
                    "seed {seed}: {estimate:?}"
                );
            } else if estimate.end() < 30_000 {
                assert!(estimate.flags.is_empty(), "seed {seed}: {}", estimate.flags);
            }
        }
    }
}

#[test]
fn a_limiter_is_flagged_where_a_harmonic_folds_onto_the_third() {
    for period in [5.5, 5.7, 5.9, 6.1, 6.3, 6.5, 7.9, 8.1, 8.2] {
        for (periods, least) in [(5, 0.8), (10, 0.95), (20, 0.95)] {
            for cubic in [-0.4, 0.0] {
                let wave = Wave {
                    main_amplitude: 0.5,
                    quadrature_amplitude: 0.05,
                    angle: 0.1,
                    frequency: RATE / period,
                    ..Wave::default()
                };
                // The noise is not limited: crests are not flat.
                let flaws = Flaws {
                    cubic,
                    noise: 1e-3,
                    ..Flaws::default()
                };
                let samples = (300.0 * period * f64::from(periods)) as usize;
                let found = identify(wave, &flaws, windows(periods), samples, u64::from(periods));
                assert!(found.len() > 250, "{}", found.len());
                let clipped = |e: &&Estimate| e.flags.contains(Flags::CLIPPED);
                let share = found.iter().filter(clipped).count() as f64 / found.len() as f64;
                let label = format!("{period} samples a period, {periods} periods, {cubic}");
                if cubic < 0.0 {
                    assert!(share > least, "{label}: {share}");
                } else {
                    assert!(found.iter().all(|e| e.flags.is_empty()), "{label}");
                }
            }
        }
    }
}

#[test]
fn a_pick_off_that_was_dead_from_the_start_is_flagged() {
    for value in [0.0, 0.3] {
        let estimates = changed(4, 0.01, 10, 20_000, |_, [c, _]| [c, value]);
        assert!(estimates.len() > 90);
        assert!(
            estimates
                .iter()
                .all(|e| e.flags.contains(Flags::DEAD_CHANNEL))
        );
    }
}

#[test]
fn a_tone_that_sums_of_whole_blocks_hide_is_flagged() {
    // Tones at 3/2, 2 and 5/2 of the wave's frequency, which the sums of blocks of two periods hide.
    for multiple in [1.5, 2.0, 2.5] {
        for seed in 0..5 {
            let (wave, _) = gyro(seed);
            let size = 0.1 * wave.main_amplitude;
            let estimates = changed(seed, 0.001, 10, 20_000, |k, [c, d]| {
                let advance = multiple * std::f64::consts::TAU * wave.frequency / RATE;
                let tone = size * (advance * k as f64 + 0.7).cos();
                [c + tone, d - 0.5 * tone]
            });
            assert!(estimates.len() > 90);
            let unseen = estimates
                .iter()
                .filter(|e| !e.flags.contains(Flags::MISFIT));
            // A tone at twice the frequency may have a phase at which it hardly raises the crests.
            let unseen = unseen.count();
            assert!(unseen < 20, "{multiple}, seed {seed}: {unseen}");
        }
    }
}

#[test]
fn a_pick_off_that_dies_is_flagged_whatever_its_calibration_and_a_wave_that_ends_is_no_dead_pick_off()
 {
    // With an angle other than 45°, calibration adds a part of the other pick-off.
    let cases = [
        (0.1, 0.0),
        (1.0, 0.0),
        (10.0, 0.0),
        (1.0, 0.02),
        (2.0, -0.3),
    ];
    let cases = cases.map(|case| [(case, false), (case, true)]);
    for ((gain_ratio, pick_off_angle), is_end) in cases.into_iter().flatten() {
        let (wave, _) = gyro(3);
        let wave = Wave { angle: 0.3, ..wave };
        let flaws = Flaws {
            gain_ratio,
            pick_off_angle,
            noise: 0.005 * wave.main_amplitude,
            ..Flaws::default()
        };
        let case = format!("gain {gain_ratio}, angle {pick_off_angle}");
        let settings = calibrated(&flaws, 10);
        let silence = Flaws::white(flaws.noise);
        let still = no_wave();
        let gyro = Gyro::new(wave, flaws, RATE, 1).unwrap();
        let dead = Gyro::new(still, silence, RATE, 2).unwrap();
        let mut core = Core::new(settings).unwrap();
        let pairs = gyro.zip(dead).take(40_000).enumerate();
        let estimates = pairs.filter_map(|(k, (pair, dead))| {
            let c = if k < 20_000 || !is_end {
                pair[0]
            } else {
                dead[0]
            };
            let d = if k < 20_000 { pair[1] } else { dead[1] };
            core.push([c as f32, d as f32])
        });
        let estimates: Vec<Estimate> = estimates.collect();
        let told = |e: &&Estimate| e.flags.contains(Flags::DEAD_CHANNEL);
        if is_end {
            let is_lost = |e: &Estimate| e.flags.contains(Flags::LOST);
            assert!(estimates.iter().any(is_lost), "{case}");
            assert_eq!(estimates.iter().find(told), None, "{case}");
            continue;
        }
        let after = estimates.iter().filter(|e| e.start > 20_200);
        assert!(after.clone().count() > 90);
        assert_eq!(after.clone().find(|e| !told(e)), None, "{case}");
    }
}

#[test]
fn a_calibrated_gain_neither_makes_a_harmonic_nor_hides_one() {
    for (gain, cubic) in [(3.0, 0.0), (0.3, 0.0), (0.3, 0.03), (3.0, 0.03)] {
        let (mut clipped, mut rows) = (0, 0);
        for seed in 0..4 {
            let (mut wave, _) = gyro(seed);
            wave.angle = std::f64::consts::FRAC_PI_4;
            let flaws = Flaws::white(if cubic == 0.0 { 0.1 } else { 5e-4 } * wave.main_amplitude);
            let settings = Settings {
                calibration: Calibration {
                    gain_ratio: gain as f32,
                    ..Calibration::IDEAL
                },
                ..windows(10)
            };
            let main = wave.main_amplitude;
            let found = identify_changed(wave, &flaws, settings, 100_000, seed, |_, [c, d]| {
                [c, gain * (d + cubic * main * (d / main).powi(3))]
            });
            rows += found.len();
            clipped += found
                .iter()
                .filter(|e| e.flags.contains(Flags::CLIPPED))
                .count();
        }
        println!("gain {gain}, cubic {cubic}: {clipped} of {rows} clipped");
        assert!(rows > 2000, "{rows}");
        let expected = if cubic == 0.0 { 0 } else { rows };
        assert_eq!(clipped, expected, "gain {gain}, cubic {cubic}");
    }
}

#[test]
fn clipping_of_one_end_of_one_pick_off_is_flagged() {
    // Both pick-offs have an amplitude of 1.41, and one of them an offset towards one end.
    let wave = Wave {
        angle: std::f64::consts::PI / 8.0,
        quadrature_amplitude: 0.0,
        ..Wave::default()
    };
    // Without known rails the crests must be flat; the noise hides their harmonic.
    for (is_known, level, noise) in [(false, 1.5, 0.1), (true, 1.65, 0.005)] {
        let flaws = Flaws::white(noise);
        for (channel, side) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
            for is_cut in [false, true] {
                let level = if is_cut { level } else { 3.0 };
                let settings = Settings {
                    rails: is_known.then_some([-level as f32, level as f32]),
                    ..windows(10)
                };
                let found = identify_changed(wave, &flaws, settings, 10_000, 2, |_, mut pair| {
                    pair[channel] += 0.3 * side;
                    pair[channel] = pair[channel].clamp(-level, level);
                    pair
                });
                assert!(found.len() > 45);
                let clipped = found.iter().filter(|e| e.flags.contains(Flags::CLIPPED));
                assert_eq!(
                    clipped.count(),
                    if is_cut { found.len() } else { 0 },
                    "channel {channel}, side {side}, known rails {is_known}, cut {is_cut}"
                );
            }
        }
    }
}

#[test]
fn a_pick_off_in_a_node_is_not_dead_by_a_fault_of_the_other() {
    let wave = Wave {
        angle: 0.0,
        quadrature_amplitude: 0.0,
        ..Wave::default()
    };
    let flaws = Flaws::white(0.01);
    // A spike every third window, in the pick-off that has the wave.
    let found = identify_changed(wave, &flaws, windows(10), 200_000, 1, |k, [c, d]| {
        let is_spike = k > 20_000 && k % 570 == 100;
        [if is_spike { c + 1.0 } else { c }, d]
    });
    let told = found.iter().filter(|e| e.flags.contains(Flags::MISFIT));
    assert!(told.count() > 300);
    for estimate in &found {
        assert!(
            !estimate.flags.contains(Flags::DEAD_CHANNEL),
            "{estimate:?}"
        );
    }
}

#[test]
fn a_small_harmonic_is_not_taken_for_a_limiter_where_its_image_lies_beside_it() {
    // 0.085 % of a_A, of the 0.1 % that are flagged, in a steady wave and in one that rings down.
    for period in [5.97, 6.02, 6.05, 7.96, 8.03] {
        for decay_rate in [0.0, 30.0] {
            let wave = Wave {
                main_amplitude: 1.0,
                quadrature_amplitude: 0.1,
                angle: 0.1,
                frequency: RATE / period,
                decay_rate,
                ..Wave::default()
            };
            let flaws = Flaws::white(1e-5);
            let found = identify_changed(wave, &flaws, windows(50), 3000, 1, |_, pair| {
                pair.map(|x| x - 3.4e-3 * x * x * x)
            });
            assert!(found.len() > 4);
            for estimate in found {
                let clipped = estimate.flags.contains(Flags::CLIPPED);
                assert!(!clipped, "{period}, {decay_rate}: {estimate:?}");
            }
        }
    }
}

//! A pick-off that dies is flagged, however small its part of the wave was; a pattern that turns to the other one's axis is not.

use std::f64::consts::FRAC_PI_4;

use antinode::{Flags, Settings};
use antinode_sim::{Flaws, Gyro, Wave, random_wave};
use host_tests::codes::{self, codes, identify};
use host_tests::{Core, RATE, stream, windows};

/// Share of a_A that a pick-off's wave must exceed for its loss to be flagged.
const FLOOR: f64 = 0.004;

fn settings() -> Settings {
    Settings {
        frequency: Some(5332.0),
        ..Settings::new(RATE)
    }
}

/// Share of windows after the death of S_C that are flagged `dead_channel`, if its wave exceeded the floor by `deviations` deviations, in
/// this noise, and it dies `depth` pairs after the start of a window.
fn told(deviations: f64, noise: f64, depth: usize) -> f64 {
    let flaws = Flaws::white(noise);
    // In windows of ten periods an amplitude has a tenth of the noise.
    let size = FLOOR + 0.1 * noise * deviations;
    let (mut dead, mut count) = (0, 0);
    for seed in 0..60 {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 0.0,
            angle: 0.5 * size.acos(),
            phase: 0.1 * seed as f64,
            ..Wave::default()
        };
        let at = 30 * 190 + depth;
        let mut pairs = stream(wave, flaws.clone(), 45 * 190, seed);
        let silence = Wave {
            main_amplitude: 1e-9,
            ..wave
        };
        let noise = Gyro::new(silence, flaws.clone(), RATE, seed + 1000).unwrap();
        for (pair, [c, _]) in pairs[at..].iter_mut().zip(noise.skip(at)) {
            pair[0] = c as f32;
        }
        let mut core = Core::new(settings()).unwrap();
        core.extend(&pairs, |estimate| {
            if estimate.start as usize >= at {
                count += 1;
                dead += usize::from(estimate.flags.contains(Flags::DEAD_CHANNEL));
            }
        });
    }
    dead as f64 / f64::from(count)
}

#[test]
fn a_pick_off_that_dies_between_windows_is_flagged_from_the_stated_sizes_on() {
    for noise in [1e-3, 0.01, 0.1] {
        let [none, half, all] = [0.0, 20.0, 30.0].map(|size| told(size, noise, 0));
        println!(
            "noise {noise}: {none:.2} of the floor, {half:.2} of 20 deviations, {all:.2} of 30"
        );
        assert!(
            none < 0.02 && (0.25..0.85).contains(&half) && all > 0.98,
            "noise {noise}: {none} {half} {all}"
        );
    }
}

#[test]
fn a_pick_off_that_dies_within_a_window_is_flagged_from_the_stated_sizes_on() {
    // At a window's ends a loss is harder to see than in its middle.
    let depths = [19, 57, 95, 133, 171];
    for noise in [1e-3, 0.01, 0.1] {
        let mut half = 0.0;
        for depth in depths {
            let [some, all] = [30.0, 55.0].map(|size| told(size, noise, depth));
            println!("noise {noise}, at {depth}: {some:.2} of 30 deviations, {all:.2} of 55");
            assert!(all > 0.98, "noise {noise}, at {depth}: {all}");
            half += some / depths.len() as f64;
        }
        // In little noise the floor alone is well seen.
        let most = if noise < 0.01 { 1.01 } else { 0.85 };
        assert!((0.25..most).contains(&half), "noise {noise}: {half}");
    }
}

#[test]
fn either_pick_off_that_is_constant_from_the_start_is_flagged_in_every_row() {
    for seed in 0..40 {
        let wave = random_wave(seed, 5332.0, 0.2);
        let flaws = Flaws::white(1e-3 * wave.main_amplitude);
        let mut pairs = stream(wave, flaws, 2000, seed);
        let (of, level) = (seed as usize % 2, 0.1 * (seed as f32 - 20.0));
        for pair in &mut pairs {
            pair[of] = level;
        }
        let mut core = Core::new(settings()).unwrap();
        let mut rows = 0;
        core.extend(&pairs, |estimate| {
            assert!(
                estimate.flags.contains(Flags::DEAD_CHANNEL),
                "{of}: {estimate:?}"
            );
            rows += 1;
        });
        assert!(rows > 5, "seed {seed}: {rows}");
    }
}

#[test]
fn patterns_that_turn_past_the_axes_are_no_dead_pick_offs() {
    let mut count = 0;
    for (seed, angle_rate) in (0..40).zip([0.3, 1.0, -5.0, 20.0, -30.0].into_iter().cycle()) {
        for noise in [1e-4, 0.01, 0.1] {
            let wave = Wave {
                main_amplitude: 1.0,
                quadrature_amplitude: 0.05,
                angle: 0.1 * seed as f64,
                angle_rate,
                ..Wave::default()
            };
            let flaws = Flaws::white(noise);
            let pairs = stream(wave, flaws, 60_000, seed);
            let mut core = Core::new(windows(10)).unwrap();
            core.extend(&pairs, |estimate| {
                count += 1;
                assert!(
                    !estimate.flags.contains(Flags::DEAD_CHANNEL),
                    "{angle_rate} rad/s, {noise}, seed {seed}, at {}",
                    estimate.time
                );
            });
        }
    }
    assert!(count > 30_000);
}

#[test]
fn a_pattern_that_stays_on_an_axis_is_no_dead_pick_off_in_coarse_codes() {
    // For a second or more one pick-off's wave is below half a step, and its noise hardly ever crosses one: constant codes.
    let (mut constant, mut rows) = (0, 0);
    for seed in 0..8 {
        let axis = if seed % 2 == 0 { 0.0 } else { FRAC_PI_4 };
        let wave = Wave {
            main_amplitude: 1500.0,
            quadrature_amplitude: 0.05,
            angle: axis - 0.002,
            angle_rate: 1e-3,
            ..Wave::default()
        };
        let flaws = Flaws {
            noise: 0.1,
            offset_c: 0.1 - 0.02 * seed as f64,
            offset_d: 0.05,
            bits: Some(12),
            full_scale: 2048.0,
            ..Flaws::default()
        };
        let pairs = codes(wave, &flaws, 400_000, seed);
        for window in pairs.chunks(188) {
            let is_constant = |i: usize| window.iter().all(|pair| pair[i] == window[0][i]);
            constant += u32::from(is_constant(0) || is_constant(1));
        }
        for estimate in identify(&pairs, codes::settings(12, 10), |code| code as i16) {
            let told = estimate.flags;
            rows += 1;
            assert!(!told.contains(Flags::DEAD_CHANNEL), "{seed}: {estimate:?}");
        }
        // The same wire, cut while it has a wave of two codes and more.
        let mut cut = pairs;
        let silent = usize::from(seed % 2 == 0);
        for pair in &mut cut[40_000..] {
            pair[silent] = 0;
        }
        let found = identify(&cut, codes::settings(12, 10), |code| code as i16);
        let after = found.iter().filter(|e| e.start >= 40_000);
        assert!(after.clone().count() > 1500);
        for estimate in after {
            let told = estimate.flags;
            assert!(told.contains(Flags::DEAD_CHANNEL), "{seed}: {told}");
        }
    }
    assert!(constant > 600 && rows > 15_000, "{constant} of {rows}");
}

#[test]
fn a_wave_that_ends_in_a_constant_code_leaves_numbers() {
    let mut lost = 0;
    for code in 1..2048 {
        let settings = Settings {
            resolution: Some(1.0),
            ..windows(10)
        };
        let mut core = antinode::Identifier::<i16, 200, 16>::new(settings).unwrap();
        let pairs = (0..2000).map(|k: i16| {
            let wave = if k < 1000 {
                1500.0 * (0.335 * f64::from(k)).cos()
            } else {
                0.0
            };
            [code + wave as i16, code + (0.6 * wave) as i16]
        });
        let pairs: Vec<_> = pairs.collect();
        core.extend(&pairs, |estimate| {
            assert!(
                estimate.main_amplitude.is_finite() && estimate.residual_rms.is_finite(),
                "{code}: {estimate:?}"
            );
            lost += u32::from(estimate.flags.contains(Flags::LOST));
        });
    }
    assert!(lost > 2000, "{lost}");
}

#[test]
fn a_pick_off_that_had_nearly_all_of_the_wave_stays_flagged_when_it_dies() {
    for seed in 0..20 {
        // What D keeps is a fifth of a_A: little of the wave, but no reason to search for another.
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 0.0,
            angle: 0.5 * 0.2f64.asin(),
            phase: 0.3 * seed as f64,
            ..Wave::default()
        };
        let silence = Wave {
            main_amplitude: 1e-9,
            ..wave
        };
        let flaws = Flaws::white(1e-3);
        let at = 30 * 190 + 9 * seed as usize;
        let mut pairs = stream(wave, flaws.clone(), 90 * 190, seed);
        let silent = stream(silence, flaws, 90 * 190, seed + 1000);
        for (pair, [c, _]) in pairs.iter_mut().zip(silent).skip(at) {
            pair[0] = c;
        }
        let mut core = Core::new(Settings::new(RATE)).unwrap();
        let mut dead = 0;
        core.extend(&pairs, |estimate| {
            if estimate.start as usize >= at {
                dead += 1;
                assert!(estimate.flags.contains(Flags::DEAD_CHANNEL), "{estimate:?}");
            }
        });
        assert!(dead > 50, "{dead}");
    }
}

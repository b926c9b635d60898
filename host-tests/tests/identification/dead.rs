//! A pick-off that dies is flagged, however small its part of the wave was; a pattern that turns to the other one's axis is not.

use antinode::{Flags, Settings};
use antinode_sim::{Flaws, Wave};
use host_tests::{Core, RATE, stream, windows};

/// Noise as a share of a_A, and the deviation of an amplitude in windows of ten periods.
const NOISE: f64 = 0.01;
const DEVIATION: f64 = 0.001;

fn flaws() -> Flaws {
    Flaws {
        noise: NOISE,
        ..Flaws::default()
    }
}

fn settings() -> Settings {
    Settings {
        frequency: Some(5332.0),
        ..Settings::new(RATE)
    }
}

/// Share of windows after the death of S_C that are flagged `dead_channel`, if it showed `deviations` deviations of the wave and dies
/// `depth` pairs after the start of a window.
fn told(deviations: f64, depth: usize) -> f64 {
    let (mut dead, mut count) = (0, 0);
    for seed in 0..60 {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 0.0,
            angle: 0.5 * (deviations * DEVIATION).acos(),
            phase: 0.1 * seed as f64,
            ..Wave::default()
        };
        let at = 30 * 190 + depth;
        let mut pairs = stream(wave, flaws(), 45 * 190, seed);
        let silence = Wave {
            main_amplitude: 1e-9,
            ..wave
        };
        let noise = stream(silence, flaws(), 45 * 190, seed + 1000);
        for (pair, noise) in pairs.iter_mut().zip(noise).skip(at) {
            pair[0] = noise[0];
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
fn a_pick_off_that_dies_is_flagged_from_the_stated_sizes_on() {
    // Between two windows, and in the middle of one.
    for depth in [0, 95] {
        let [half, all] = [25.0, 35.0].map(|deviations| told(deviations, depth));
        println!("at {depth}: {half:.2} of 25 deviations, {all:.2} of 35");
        assert!((0.25..0.85).contains(&half) && all > 0.98, "at {depth}");
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
            let flaws = Flaws {
                noise,
                ..Flaws::default()
            };
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

//! Each check of a window by itself, on a fault that hardly any other check detects.

use antinode::{Estimate, Flags, Identifier, Settings};
use antinode_sim::{Flaws, Loss, Wave, random_wave};
use host_tests::{
    Core, RATE, changed, gyro, identify, identify_changed, no_wave, stream, touched, windows,
};

#[test]
fn a_sample_lost_between_two_windows_is_flagged() {
    // Of the places within one window's length, one falls between two windows.
    let (wave, mut flaws) = gyro(1);
    for at in 50_000..50_190 {
        flaws.lost = vec![Loss { at, count: 1 }];
        let estimates = identify(wave, &flaws, windows(10), 53_000, 1);
        // A window with only its last few samples after the loss may be right: then the next one is flagged.
        let near = estimates
            .iter()
            .filter(|e| e.end() >= at && e.start <= at + 19);
        assert!(
            near.clone().any(|e| !e.flags.is_empty()),
            "{at}: {near:?}",
            near = near.collect::<Vec<_>>()
        );
        if let Some(after) = estimates.iter().find(|e| e.start == at) {
            assert!(
                after.flags.contains(Flags::PHASE_JUMP),
                "{at}: {}",
                after.flags
            );
        }
    }
}

#[test]
fn a_loss_is_told_from_a_spike() {
    let (mut losses, mut spikes) = (0, 0);
    for seed in 0..40 {
        let (wave, mut flaws) = gyro(seed);
        flaws.noise = 2e-3 * wave.main_amplitude;
        let at = 30_000 + 97 * seed;
        flaws.lost = vec![Loss {
            at,
            count: 1 + seed % 3,
        }];
        let lost = identify(wave, &flaws, windows(10), 40_000, seed);
        let spiked = changed(seed, 2e-3, 10, 40_000, |k, [c, d]| {
            let spike = if k as u64 == at {
                wave.main_amplitude
            } else {
                0.0
            };
            [c + spike, d + spike]
        });
        let jumps = |estimates: &[Estimate]| {
            let jumps = estimates
                .iter()
                .filter(|e| e.flags.contains(Flags::PHASE_JUMP));
            jumps.filter(|e| !e.flags.contains(Flags::MISFIT)).count()
        };
        losses += jumps(&lost);
        spikes += jumps(&spiked);
        assert!(spiked.iter().any(|e| e.flags.contains(Flags::MISFIT)));
    }
    assert_eq!((losses, spikes), (40, 0));
}

#[test]
fn a_burst_of_noise_is_flagged() {
    for seed in 0..40 {
        let (wave, _) = gyro(seed);
        let mut state: u64 = seed * 2 + 1;
        let noise: Vec<f64> = (0..2000)
            .map(|_| {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                // Uniform noise: together with the wave's own it is 3.3 times as much as before.
                0.055 * wave.main_amplitude * ((state >> 11) as f64 / (1u64 << 53) as f64 - 0.5)
            })
            .collect();
        let estimates = changed(seed, 0.005, 10, 60_000, |k, [c, d]| {
            match k.checked_sub(30_000) {
                Some(i) if i < 500 => [c + noise[i], d + noise[1000 + i]],
                _ => [c, d],
            }
        });
        let inside = estimates
            .iter()
            .filter(|e| e.start >= 30_000 && e.start + 190 <= 30_500);
        assert!(inside.clone().count() >= 1);
        assert!(
            inside.clone().all(|e| e.flags.contains(Flags::MISFIT)),
            "seed {seed}"
        );
        let near = |e: &Estimate| e.start < 30_700 && e.start > 29_700;
        assert!(
            estimates.iter().all(|e| e.flags.is_empty() || near(e)),
            "seed {seed}"
        );
    }
}

#[test]
fn a_second_tone_is_flagged_from_the_first_window_on() {
    for seed in 0..10 {
        let estimates = changed(seed, 0.001, 10, 20_000, |k, [c, d]| {
            let tone = 0.05 * (std::f64::consts::TAU * 5800.0 * k as f64 / RATE).sin();
            [c + tone, d - 0.5 * tone]
        });
        assert!(estimates.len() > 90);
        assert!(
            estimates.iter().all(|e| e.flags.contains(Flags::MISFIT)),
            "seed {seed}"
        );
    }
}

#[test]
fn a_spike_in_a_long_window_is_flagged() {
    let mut seen = 0;
    for seed in 0..10 {
        let (wave, _) = gyro(seed);
        let at = 60_000 + 17 * seed as usize;
        let estimates = changed(seed, 0.02, 50, 120_000, |k, [c, d]| {
            [
                c,
                if k == at {
                    d + 0.9 * wave.main_amplitude
                } else {
                    d
                },
            ]
        });
        for estimate in touched(&estimates, at, at + 1) {
            seen += 1;
            assert!(
                estimate.flags.contains(Flags::MISFIT),
                "seed {seed}: {estimate:?}"
            );
        }
    }
    assert!(seen >= 8, "{seen}");
}

#[test]
fn a_small_step_within_a_window_is_flagged() {
    // A tenth of the amplitude in 2 % noise hardly raises the residual as a whole, but it has the shape of a step. Where noise hides
    // that, the window grows although the one before did not.
    let mut hits = 0;
    for seed in 0..400 {
        let at = 40_000 + 43 * (seed / 10) + 2 * (seed % 10);
        let estimates = changed(seed / 10, 0.02, 10, 50_000, |k, [c, d]| {
            let gain = if k as u64 >= at { 1.1 } else { 1.0 };
            [gain * c, gain * d]
        });
        if let Some(estimate) = estimates
            .iter()
            .find(|e| (e.start + 57..e.start + 133).contains(&at))
        {
            assert!(
                estimate.flags.contains(Flags::MISFIT),
                "seed {seed}: {estimate:?}"
            );
            hits += 1;
        }
    }
    assert!(hits > 100, "{hits}");
}

#[test]
fn a_fast_ring_down_is_no_fault() {
    for seed in 0..8 {
        for decay_rate in [1.0, 10.0, 50.0] {
            for periods in [10, 50] {
                let (mut wave, mut flaws) = gyro(seed);
                wave.decay_rate = decay_rate;
                flaws.noise = 1e-4 * wave.main_amplitude;
                // The wave falls to a twentieth, at the fastest by half of itself within a window of 50 periods.
                let samples = (3.0 / decay_rate * RATE) as usize;
                let estimates =
                    identify(wave, &flaws, windows(periods), samples.min(100_000), seed);
                assert!(estimates.len() > 5);
                for estimate in &estimates {
                    assert!(
                        estimate.flags.is_empty(),
                        "seed {seed}, {decay_rate} 1/s, {periods} periods: {estimate:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn white_noise_is_no_fault_at_few_samples_a_period() {
    // Windows of nine samples, in blocks of one: the sums about the third harmonic contain nothing that the others do not.
    for seed in 0..20 {
        let wave = random_wave(seed, RATE / 4.3, 0.2);
        let flaws = Flaws::white(0.02 * wave.main_amplitude);
        let estimates = identify(wave, &flaws, windows(2), 90_000, seed);
        assert!(estimates.len() > 9_900);
        for estimate in &estimates {
            assert!(estimate.flags.is_empty(), "seed {seed}: {estimate:?}");
        }
    }
}

#[test]
fn rounding_is_no_fault_in_long_windows_of_long_periods() {
    let mut rows = 0;
    for seed in 0..12 {
        let period = 440.0 + 12.3 * seed as f64;
        let wave = Wave {
            angle_rate: if seed % 2 == 0 { 0.0 } else { -0.13 },
            ..random_wave(seed, RATE / period, 0.5)
        };
        let flaws = Flaws {
            offset_c: 1.5 * wave.main_amplitude,
            offset_d: -1.4 * wave.main_amplitude,
            ..Flaws::default()
        };
        let settings = Settings {
            frequency: Some(wave.frequency as f32),
            ..windows(141)
        };
        let mut core = Identifier::<f32, 1024, 256>::new(settings).unwrap();
        core.extend(&stream(wave, flaws, 300_000, seed), |estimate| {
            assert!(estimate.flags.is_empty(), "seed {seed}: {estimate:?}");
            rows += 1;
        });
    }
    assert!(rows > 40, "{rows}");
}

#[test]
fn noise_is_no_fault_in_windows_of_very_many_samples() {
    let mut rows = 0;
    for seed in 0..4 {
        let wave = Wave {
            angle_rate: 0.05,
            decay_rate: 0.0,
            ..random_wave(seed, RATE / 175.7, 0.3)
        };
        let flaws = Flaws::white(2e-4 * wave.main_amplitude);
        let mut core = Identifier::<f32, 400, 1002>::new(windows(1000)).unwrap();
        core.extend(&stream(wave, flaws, 900_000, seed), |estimate| {
            assert!(estimate.flags.is_empty(), "seed {seed}: {estimate:?}");
            rows += 1;
        });
    }
    assert_eq!(rows, 20);
}

#[test]
fn a_lasting_rise_of_noise_becomes_the_new_level() {
    let rises = |seed, factor: f64| {
        let (wave, _) = gyro(seed);
        let noise = Flaws::white(0.002 * factor * wave.main_amplitude);
        let still = no_wave();
        let more = antinode_sim::Gyro::new(still, noise, RATE, seed + 50).unwrap();
        let more: Vec<_> = more.take(60_000).collect();
        changed(seed, 0.002, 10, 60_000, |k, [c, d]| {
            if k < 20_000 {
                [c, d]
            } else {
                [c + more[k][0], d + more[k][1]]
            }
        })
    };
    for factor in [3.0, 5.0, 10.0] {
        for seed in 0..10 {
            let estimates = rises(seed, factor);
            assert!(estimates.len() > 300, "{}", estimates.len());
            let flagged = |e: &&Estimate| !e.flags.is_empty();
            let count = estimates.iter().filter(flagged).count();
            assert!(count < 8, "{factor} times, seed {seed}: {count} flagged");
            let late = estimates.iter().filter(|e| e.start > 40_000);
            assert_eq!(
                late.filter(flagged).count(),
                0,
                "{factor} times, seed {seed}"
            );
        }
    }
}

#[test]
fn a_first_window_with_a_nan_gives_no_row() {
    let (wave, flaws) = gyro(3);
    let settings = Settings {
        frequency: Some(5332.0),
        ..windows(10)
    };
    let found = identify_changed(wave, &flaws, settings, 5000, 3, |k, [c, d]| {
        [if k == 50 { f64::NAN } else { c }, d]
    });
    assert!(found.len() > 20 && found[0].start > 50);
    assert!(found.iter().all(|e| e.flags.is_empty()));
}

#[test]
fn a_rise_of_noise_flags_three_windows_however_far_apart_they_are() {
    for hop in [10, 60] {
        let settings = Settings {
            hop: Some(hop),
            ..windows(10)
        };
        let (wave, mut flaws) = gyro(3);
        flaws.noise = 0.0;
        let noise = [1e-3, 1e-2].map(Flaws::white);
        let still = no_wave();
        let [quiet, loud] = noise.map(|noise| stream(still, noise, 60_000, 4));
        let found = identify_changed(wave, &flaws, settings, 60_000, 3, |k, [c, d]| {
            let [more_c, more_d] = if k < 20_000 { quiet[k] } else { loud[k] };
            [c + f64::from(more_c), d + f64::from(more_d)]
        });
        let flagged = found.iter().filter(|e| !e.flags.is_empty()).count();
        assert!((3..=4).contains(&flagged), "{hop}: {flagged}");
    }
}

#[test]
fn a_fault_in_overlapping_windows_is_no_new_level_of_noise() {
    let mut broken = 0;
    for seed in 0..20 {
        let (wave, mut flaws) = gyro(seed);
        flaws.noise = 1e-3 * wave.main_amplitude;
        let settings = Settings {
            hop: Some(1),
            ..windows(5)
        };
        let length = 94;
        let (from, to) = (10_000, 10_000 + length * 5 / 4);
        let mut core = Core::new(settings).unwrap();
        let mut pairs = stream(wave, flaws, 13_000, seed);
        // One pick-off holds its value.
        let held = pairs[from][0];
        pairs[from..to].iter_mut().for_each(|pair| pair[0] = held);
        core.extend(&pairs, |e| {
            let (start, end) = (e.start as usize, e.start as usize + e.samples as usize);
            let within = end.min(to).saturating_sub(start.max(from));
            if within > length / 4 {
                broken += 1;
                assert!(!e.flags.is_empty(), "seed {seed}, {within}: {e:?}");
            }
        });
    }
    assert!(broken > 100, "{broken}");
}

#[test]
fn a_step_of_the_offset_alone_is_a_step() {
    for seed in 0..10 {
        let (wave, _) = gyro(seed);
        let windows = changed(seed, 0.002, 10, 30_000, |_, pair| pair);
        // At the end of one window and the start of the next.
        let at = windows[80].start as usize;
        let estimates = changed(seed, 0.002, 10, 30_000, |k, [c, d]| {
            let step = if k < at {
                0.0
            } else {
                0.05 * wave.main_amplitude
            };
            [c + step, d]
        });
        assert!(
            estimates[80].flags.contains(Flags::STEP),
            "seed {seed}: {}",
            estimates[80].flags
        );
        assert!(!estimates[79].flags.contains(Flags::STEP));
    }
}

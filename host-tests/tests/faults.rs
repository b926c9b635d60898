//! Faults in a 4 s stream: every window that they touch is flagged, no other is, and the wave is tracked again soon.

use antinode::{Estimate, Flags, Settings};
use antinode_sim::{Channel, ClipSpan, Dropout, DropoutKind, Flaws, Loss, Wave, random_wave};
use host_tests::score::errors;
use host_tests::{Core, RATE, identify, windows};

/// Length of the streams, sample pairs.
const STREAM: usize = 400_000;

/// A gyro that turns and decays, in 0.5 % noise.
fn gyro(seed: u64) -> (Wave, Flaws) {
    let wave = Wave {
        angle_rate: 0.3,
        decay_rate: 0.05,
        ..random_wave(seed, 5332.0, 0.2)
    };
    let a = wave.main_amplitude;
    (
        wave,
        Flaws {
            noise: 0.005 * a,
            offset_c: 0.05 * a,
            offset_d: -0.02 * a,
            ..Flaws::default()
        },
    )
}

/// Asserts what is asked of a fault between two times (s) of the recording.
fn check(estimates: &[Estimate], from: f64, to: f64, name: &str) {
    let window = 10.0 / 5332.0;
    let span = |e: &Estimate| {
        (
            e.start as f64 / RATE,
            (e.start + u64::from(e.samples)) as f64 / RATE,
        )
    };
    for estimate in estimates {
        let (begin, end) = span(estimate);
        if begin < to && end > from {
            assert!(
                !estimate.flags.is_empty(),
                "{name}: window {begin}…{end} s is touched and not flagged"
            );
        } else if end <= from || begin > to + 3.0 * window {
            assert!(
                estimate.flags.is_empty(),
                "{name}: {} at {begin} s, fault {from}…{to} s",
                estimate.flags
            );
        }
    }
    let again = estimates
        .iter()
        .find(|e| span(e).0 >= to && e.flags.is_empty());
    let (begin, _) = span(again.unwrap_or_else(|| panic!("{name}: not tracked again")));
    assert!(
        begin - to < 3.0 * window,
        "{name}: tracked again after {:.1} windows",
        (begin - to) / window
    );
}

#[test]
fn a_clean_stream_is_never_flagged() {
    for seed in 0..12 {
        let (wave, mut flaws) = gyro(seed);
        let periods = [2, 5, 10, 50][(seed % 4) as usize];
        flaws.noise = [0.0, 1e-4, 5e-3, 0.05][(seed / 3) as usize] * wave.main_amplitude;
        let mut squares = [0f64; 4];
        let estimates = identify(wave, &flaws, windows(periods), STREAM, seed);
        assert!(estimates.len() > 400);
        for estimate in &estimates {
            assert!(
                estimate.flags.is_empty(),
                "seed {seed}: {} at {} s",
                estimate.flags,
                estimate.time
            );
            let stds = [
                estimate.main_amplitude_std,
                estimate.quadrature_amplitude_std,
                estimate.angle_std,
                estimate.frequency_std,
            ];
            for (i, error) in errors(estimate, &wave).into_iter().enumerate() {
                squares[i] += (error / (f64::from(stds[i]) + 1e-7)).powi(2);
            }
        }
        for square in squares {
            let ratio = (square / estimates.len() as f64).sqrt();
            assert!(
                ratio < 1.15,
                "seed {seed}: scatter {ratio:.2} of what is stated"
            );
        }
    }
}

#[test]
fn lost_samples_are_flagged() {
    for seed in 0..20 {
        for count in [1, 3, 100] {
            let (wave, mut flaws) = gyro(seed);
            let at = 200_000 + 37 * seed;
            flaws.lost = vec![Loss { at, count }];
            let estimates = identify(wave, &flaws, windows(10), STREAM, seed);
            // In the recording the gap has no length: it lies between two samples.
            let gap = at as f64 / RATE;
            check(
                &estimates,
                gap - 0.5 / RATE,
                gap + 0.5 / RATE,
                &format!("{count} samples lost, seed {seed}"),
            );
        }
    }
}

#[test]
fn clipping_is_flagged() {
    for seed in 0..20 {
        let (mut wave, mut flaws) = gyro(seed);
        wave.angle_rate = 0.0;
        let (from, to) = (1.7 + 1e-5 * seed as f64, 2.3);
        // The larger pick-off loses a tenth of its amplitude or more.
        let (s2, c2) = (2.0 * wave.at(from).angle).sin_cos();
        let level = 0.88 * wave.at(to).main_amplitude * s2.abs().max(c2.abs());
        flaws.clip_spans = vec![ClipSpan { from, to, level }];
        let estimates = identify(wave, &flaws, windows(10), STREAM, seed);
        // A crest must lie within the span for a sample to be cut: half a period from its ends.
        let crest = 1.0 / 5332.0;
        for estimate in &estimates {
            let begin = estimate.start as f64 / RATE;
            let end = begin + f64::from(estimate.samples) / RATE;
            if begin < to - crest && end > from + crest && !estimate.flags.contains(Flags::CLIPPED)
            {
                assert!(
                    estimate.flags.intersects(Flags::MISFIT),
                    "seed {seed}: window at {begin} s: {}",
                    estimate.flags
                );
            }
        }
        check(
            &estimates,
            from + crest,
            to - crest,
            &format!("clipping, seed {seed}"),
        );
    }
}

#[test]
fn the_converters_rail_is_flagged_at_the_first_sample() {
    for seed in 0..10 {
        let (wave, mut flaws) = gyro(seed);
        let full = 1.2 * wave.main_amplitude;
        (flaws.bits, flaws.full_scale) = (Some(12), full);
        flaws.dropouts = Vec::new();
        flaws.offset_c = 0.0;
        let settings = Settings {
            full_scale: Some((full * 2047.0 / 2048.0) as f32),
            ..windows(10)
        };
        let clean = identify(wave, &flaws, settings, 50_000, seed);
        assert!(clean.iter().all(|e| e.flags.is_empty()));
        flaws.offset_c = 0.5 * wave.main_amplitude;
        flaws.offset_d = 0.5 * wave.main_amplitude;
        let railed = identify(wave, &flaws, settings, 50_000, seed);
        assert!(!railed.is_empty() && railed.iter().all(|e| e.flags.contains(Flags::CLIPPED)));
    }
}

#[test]
fn dropouts_are_flagged() {
    for seed in 0..20 {
        for kind in [DropoutKind::Zero, DropoutKind::Hold, DropoutKind::NoiseOnly] {
            for channel in [None, Some(Channel::C), Some(Channel::D)] {
                for length in [0.0007, 0.004, 0.5] {
                    let (wave, mut flaws) = gyro(seed);
                    // A pick-off on a node has no wave to lose.
                    let (s2, c2) = (2.0 * wave.at(2.0).angle).sin_cos();
                    if s2.abs().min(c2.abs()) < 0.15 && channel.is_some() {
                        continue;
                    }
                    let (from, to) = (2.0 + 1e-4 * seed as f64, 2.0 + 1e-4 * seed as f64 + length);
                    flaws.dropouts = vec![Dropout {
                        from,
                        to,
                        kind,
                        channel,
                    }];
                    let estimates = identify(wave, &flaws, windows(10), STREAM, seed);
                    let name = format!("{kind:?} of {channel:?} for {length} s, seed {seed}");
                    check(&estimates, from + 2e-5, to - 2e-5, &name);
                }
            }
        }
    }
}

#[test]
fn a_circular_pattern_has_no_angle() {
    for sign in [1.0, -1.0] {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 0.9999 * sign,
            ..Wave::default()
        };
        let flaws = Flaws {
            noise: 0.002,
            ..Flaws::default()
        };
        let estimates = identify(wave, &flaws, windows(10), 50_000, 1);
        assert!(estimates.len() > 200);
        for estimate in estimates {
            assert_eq!(estimate.flags, Flags::CIRCULAR, "{}", estimate.time);
            assert!((estimate.main_amplitude - 1.0).abs() < 0.002);
            assert!((f64::from(estimate.quadrature_amplitude) - 0.9999 * sign).abs() < 0.002);
            assert!((estimate.frequency - 5332.0).abs() < 1.0);
        }
    }
}

#[test]
fn numbers_that_are_none_cost_one_window() {
    let (wave, flaws) = gyro(3);
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut core = Core::new(windows(10)).unwrap();
        let gyro = antinode_sim::Gyro::new(wave, flaws.clone(), RATE, 3).unwrap();
        let mut flagged = Vec::new();
        for (k, pair) in gyro.take(60_000).enumerate() {
            let c = if k == 30_000 { value } else { pair.c as f32 };
            flagged.extend(
                core.push([c, pair.d as f32])
                    .filter(|estimate| !estimate.flags.is_empty()),
            );
        }
        assert!((1..=2).contains(&flagged.len()), "{value}: {flagged:?}");
        assert!(flagged[0].flags.contains(Flags::NOT_FINITE));
    }
}

#[test]
fn a_step_between_or_within_windows_is_flagged() {
    for seed in 0..20 {
        for kind in ["gain", "offset", "angle", "spike"] {
            let (wave, flaws) = gyro(seed);
            let a = wave.main_amplitude;
            let mut core = Core::new(windows(10)).unwrap();
            let at = 30_000 + 11 * seed as usize;
            let gyro = antinode_sim::Gyro::new(wave, flaws, RATE, seed).unwrap();
            let mut estimates = Vec::new();
            for (k, pair) in gyro.take(60_000).enumerate() {
                let (mut c, mut d) = (pair.c, pair.d);
                match kind {
                    "gain" if k >= at => (c, d) = (1.1 * c, 1.1 * d),
                    "offset" if k >= at => c += 0.2 * a,
                    "angle" if k >= at => {
                        let (sine, cosine) = 0.15f64.sin_cos();
                        (c, d) = (c * cosine - d * sine, c * sine + d * cosine);
                    }
                    "spike" if k == at => c += 2.0 * a,
                    _ => {}
                }
                estimates.extend(core.push([c as f32, d as f32]));
            }
            // Where the step leaves less than a block of a window on one side, the window beside it may be the one that shows it.
            let within =
                |e: &&Estimate| (e.start..e.start + u64::from(e.samples)).contains(&(at as u64));
            let window = estimates.iter().find(within).unwrap();
            let depth = (at as u64 - window.start)
                .min(window.start + u64::from(window.samples) - at as u64);
            let reach = if depth < 19 { 19.0 } else { 0.0 };
            let time = at as f64 / RATE;
            let touched: Vec<_> = estimates
                .iter()
                .filter(|e| {
                    let begin = e.start as f64;
                    begin < at as f64 + 0.5 + reach
                        && begin + f64::from(e.samples) > at as f64 - 0.5 - reach
                })
                .collect();
            assert!(
                touched.iter().any(|e| !e.flags.is_empty()),
                "{kind}, seed {seed}: {touched:?}"
            );
            if depth >= 19 {
                check(
                    &estimates,
                    time - 0.5 / RATE,
                    time + 0.5 / RATE,
                    &format!("{kind}, seed {seed}"),
                );
            }
        }
    }
}

/// Runs a gyro through the core with `change` applied to every pair; gives the estimates.
fn changed(
    seed: u64,
    noise: f64,
    periods: u16,
    samples: usize,
    change: impl Fn(usize, [f64; 2]) -> [f64; 2],
) -> Vec<Estimate> {
    let (wave, mut flaws) = gyro(seed);
    flaws.noise = noise * wave.main_amplitude;
    let mut core = Core::new(windows(periods)).unwrap();
    let gyro = antinode_sim::Gyro::new(wave, flaws, RATE, seed).unwrap();
    let pairs = gyro
        .take(samples)
        .enumerate()
        .map(|(k, pair)| change(k, [pair.c, pair.d]));
    pairs
        .filter_map(|[c, d]| core.push([c as f32, d as f32]))
        .collect()
}

/// The windows that a stretch of samples touches by at least a block, and the flags of all others.
fn touched(estimates: &[Estimate], from: usize, to: usize) -> Vec<&Estimate> {
    let block = 19;
    estimates
        .iter()
        .filter(|e| {
            e.start + block < to as u64 && e.start + u64::from(e.samples) > from as u64 + block
        })
        .collect()
}

#[test]
fn a_sample_lost_between_two_windows_is_flagged() {
    // Over one window's length of places, one falls between two windows.
    let (wave, mut flaws) = gyro(1);
    for at in 50_000..50_190 {
        flaws.lost = vec![Loss { at, count: 1 }];
        let estimates = identify(wave, &flaws, windows(10), 53_000, 1);
        let end = |e: &Estimate| e.start + u64::from(e.samples);
        let near = estimates.iter().filter(|e| end(e) >= at && e.start <= at);
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
fn a_burst_of_noise_is_flagged() {
    for seed in 0..40 {
        let (wave, _) = gyro(seed);
        let mut state: u64 = seed * 2 + 1;
        let noise: Vec<f64> = (0..2000)
            .map(|_| {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                // Uniform: with the wave's own noise 3.3 times as much as before.
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
            assert!(
                estimate.flags.contains(Flags::MISFIT),
                "seed {seed}: {estimate:?}"
            );
        }
    }
}

#[test]
fn a_small_step_within_a_window_is_flagged() {
    // A tenth of the amplitude in 2 % noise: the residual as a whole hardly rises, but it has the shape of a step.
    let mut hits = 0;
    for seed in 0..40 {
        let at = 40_000 + 43 * seed;
        let estimates = changed(seed, 0.02, 10, 50_000, |k, [c, d]| {
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
    assert!(hits > 10, "{hits}");
}

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
        for estimate in touched(&estimates, 40_200, 59_800) {
            assert!(
                estimate.flags.contains(Flags::CLIPPED),
                "seed {seed}: {estimate:?}"
            );
        }
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
        // Limited amplifiers ahead of a noisy converter: no two samples are equal.
        let mut core = Core::new(windows(10)).unwrap();
        let gyro = antinode_sim::Gyro::new(wave, Flaws::default(), RATE, seed).unwrap();
        let mut estimates = Vec::new();
        for (k, pair) in gyro.take(60_000).enumerate() {
            let limit = if k < 30_000 { f64::INFINITY } else { level };
            let [c, d] = [pair.c, pair.d].map(|s| (s.clamp(-limit, limit) + noise()) as f32);
            estimates.extend(core.push([c, d]));
        }
        for estimate in &estimates {
            if estimate.start >= 30_000 {
                assert!(
                    estimate.flags.contains(Flags::CLIPPED),
                    "seed {seed}: {estimate:?}"
                );
            } else if estimate.start + u64::from(estimate.samples) < 30_000 {
                assert!(estimate.flags.is_empty(), "seed {seed}: {}", estimate.flags);
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

//! Mains hum: with the setting for it the bound is reached, faults are still flagged, and a ring-down is tracked to its end.

use antinode::{Estimate, Flags, Settings};
use antinode_sim::{Flaws, Loss, Wave, random_wave};
use host_tests::score::{NAMES, Score};
use host_tests::{RATE, identify_changed, windows};

/// Hum of 50 Hz on both pick-offs, of this amplitude, and a third of that at 150 Hz.
fn hum(k: usize, size: f64) -> [f64; 2] {
    let phase = std::f64::consts::TAU * 50.0 * k as f64 / RATE;
    let tone = |phase: f64| size * (phase.sin() + (3.0 * phase).cos() / 3.0);
    [tone(phase), 0.8 * tone(phase + 0.5)]
}

fn identified(
    wave: Wave,
    flaws: Flaws,
    size: f64,
    samples: usize,
    settings: Settings,
    seed: u64,
) -> Vec<Estimate> {
    identify_changed(wave, &flaws, settings, samples, seed, |k, pair| {
        let [c, d] = hum(k, size);
        [pair[0] + c, pair[1] + d]
    })
}

fn settings(periods: u16, hum: bool) -> Settings {
    Settings {
        hum,
        ..windows(periods)
    }
}

#[test]
fn slow_waves_in_much_hum_are_not_clipped() {
    for (period, periods) in [(100.0, 5), (60.0, 5), (60.0, 10), (18.75, 10)] {
        // On both pick-offs, or on one of them only.
        for (size, [on_c, on_d]) in [0.1, 0.3, 1.0]
            .into_iter()
            .flat_map(|size| [[1.0, 0.8], [1.0, 0.0], [0.0, 1.0]].map(|on| (size, on)))
        {
            let wave = random_wave(27, RATE / period, 0.5);
            let size = size * wave.main_amplitude;
            let flaws = Flaws::white(size / 50.0);
            let samples = (period * f64::from(periods) * 200.0) as usize;
            let settings = settings(periods, true);
            let found = identify_changed(wave, &flaws, settings, samples, 27, |k, [c, d]| {
                let tone = size * (std::f64::consts::TAU * 50.0 * k as f64 / RATE).cos();
                [c + on_c * tone, d + on_d * tone]
            });
            assert!(found.len() > 190, "{}", found.len());
            for estimate in &found {
                let label = format!(
                    "{period} samples a period, {periods} periods, {size} on [{on_c}, {on_d}]"
                );
                assert!(estimate.flags.is_empty(), "{label}: {}", estimate.flags);
            }
        }
    }
}

#[test]
fn hum_is_no_fault_at_any_period() {
    // Whole blocks of five periods come no nearer than a tenth to a window if they have a period or more each: 6.5 samples and others.
    for periods in [5, 6, 7] {
        for period in [2.7, 3.58, 4.5, 5.4, 6.5, 7.4, 8.5, 10.5, 12.5, 18.9] {
            let wave = random_wave(3, RATE / period, 0.5);
            let noise = 1e-3 * wave.main_amplitude;
            let samples = (period * f64::from(periods) * 100.0) as usize;
            let size = 0.3 * wave.main_amplitude;
            let settings = Settings {
                frequency: Some(wave.frequency as f32),
                ..settings(periods, true)
            };
            let found = identified(wave, Flaws::white(noise), size, samples, settings, 3);
            assert!(found.len() > 85, "{}", found.len());
            for estimate in &found {
                let label = format!("{period} samples a period, {periods} periods");
                assert!(estimate.flags.is_empty(), "{label}: {}", estimate.flags);
                let residual = f64::from(estimate.residual_rms) / noise;
                assert!(residual < 2.0, "{label}: {residual} of the noise");
            }
        }
    }
}

#[test]
fn the_bound_is_reached_in_hum() {
    // Offsets are fitted to runs of five blocks: with 12 and 22 periods the last block is alone in its run. Blocks of a slower wave are
    // longer, and hum moves further in each.
    for (frequency, size, periods) in [0.0, 1e-3, 0.01]
        .into_iter()
        .flat_map(|size| [5, 10, 12, 22, 50].map(|periods| (5332.0, size, periods)))
        .chain([(4000.0, 0.01, 10), (4000.0, 0.01, 22)])
    {
        let (mut score, mut flagged, mut rows) = (Score::default(), 0, 0);
        for seed in 0..40 {
            let wave = random_wave(seed, frequency, 0.5);
            let noise = 2e-4 * wave.main_amplitude;
            let flaws = Flaws {
                noise,
                offset_c: 0.2,
                ..Flaws::default()
            };
            let size = size * wave.main_amplitude;
            let samples = (RATE / frequency * f64::from(periods.max(10)) * 41.0) as usize;
            for estimate in identified(wave, flaws, size, samples, settings(periods, true), seed) {
                score.add(&estimate, &wave, noise);
                rows += 1;
                flagged += usize::from(!estimate.flags.is_empty());
            }
        }
        let (error, stated) = (score.error(), score.stated());
        println!(
            "hum of {size} a_A, {periods} periods, {frequency} Hz: {rows} windows, rms error/bound {error:.3?}, stated/bound {stated:.3?}"
        );
        assert!(flagged * 1000 <= rows, "{flagged} of {rows} flagged");
        for i in 0..4 {
            let limit = if frequency > 5000.0 { 1.1 } else { 1.15 };
            assert!(error[i] < limit, "{} at {:.3}", NAMES[i], error[i]);
            let ratio = stated[i] / error[i];
            assert!((0.85..1.15).contains(&ratio), "{}: {ratio:.3}", NAMES[i]);
        }
    }
}

#[test]
fn slow_hum_does_not_bend_blocks() {
    // 50 Hz alone, a tenth of the wave and 500 times the noise or more: its curvature within blocks would then be visible.
    for noise in [2e-4, 3e-5] {
        let mut score = Score::default();
        for seed in 0..20 {
            let wave = random_wave(seed, 5332.0, 0.5);
            let noise = noise * wave.main_amplitude;
            let flaws = Flaws::white(noise);
            let size = 0.1 * wave.main_amplitude;
            let found = identify_changed(
                wave,
                &flaws,
                settings(10, true),
                40_000,
                seed,
                |k, [c, d]| {
                    let tone = size * (std::f64::consts::TAU * 50.0 * k as f64 / RATE).sin();
                    [c + tone, d + 0.8 * tone]
                },
            );
            for estimate in &found {
                score.add(estimate, &wave, noise);
            }
        }
        let error = score.error();
        println!("50 Hz of 0.1 a_A, noise of {noise} a_A: rms error/bound {error:.3?}");
        for (name, error) in NAMES.iter().zip(error) {
            assert!(error < 1.5, "{name} at {error:.3}");
        }
    }
}

#[test]
fn hum_alone_is_no_fault_over_gaps_and_at_its_crests() {
    for (size, periods, hop) in [
        (0.01, 10, Some(20)),
        (0.003, 10, Some(40)),
        (0.1, 40, None),
        (0.01, 10, Some(7)),
    ] {
        for seed in 0..4 {
            let wave = random_wave(seed, 5332.0, 0.5);
            let flaws = Flaws::white(2e-4 * wave.main_amplitude);
            let settings = Settings {
                hop,
                ..settings(periods, true)
            };
            let size = size * wave.main_amplitude;
            let found = identified(wave, flaws, size, 100_000, settings, seed);
            assert!(found.len() > 100, "{}", found.len());
            let flagged = found.iter().find(|e| !e.flags.is_empty());
            assert_eq!(flagged, None, "{periods} periods, hop {hop:?}");
        }
    }
}

#[test]
fn the_shortest_windows_that_allow_the_setting_use_it() {
    for (periods, hop) in [(5, None), (10, Some(5))] {
        let wave = random_wave(1, 5332.0, 0.5);
        let flaws = Flaws::white(2e-4);
        let [with, without] = [true, false].map(|hum| {
            let settings = Settings {
                hop,
                ..settings(periods, hum)
            };
            identified(wave, flaws.clone(), 0.01, 20_000, settings, 1)
        });
        assert_ne!(with, without, "{periods} periods, hop {hop:?}");
    }
}

#[test]
fn faults_are_flagged_in_hum() {
    for seed in 0..20 {
        let wave = Wave {
            main_amplitude: 1.0,
            ..random_wave(seed, 5332.0, 0.1)
        };
        let wave = Wave {
            quadrature_amplitude: 0.05,
            ..wave
        };
        let at = 30_000 + 97 * seed;
        let flaws = Flaws {
            noise: 1e-3,
            lost: vec![Loss { at, count: 1 }],
            ..Flaws::default()
        };
        let found = identified(wave, flaws, 0.01, 60_000, settings(10, true), seed);
        let told = |e: &&Estimate| !e.flags.is_empty();
        let near = |e: &&Estimate| e.start + 400 > at && e.start < at + 400;
        assert!(found.iter().filter(near).any(|e| told(&e)), "seed {seed}");
        assert!(found.iter().any(|e| e.flags.contains(Flags::PHASE_JUMP)));
        assert!(
            !found.iter().filter(|e| !near(e)).any(|e| told(&e)),
            "seed {seed}"
        );
    }
}

#[test]
fn a_bad_block_is_flagged_if_blocks_have_their_own_offsets() {
    // A burst in one block of a window that holds the energy of 70 noise variances: of four sums a block this is beyond chance more often
    // than not, of six it would be so in half of them.
    let (length, window) = (38, 25 * 38);
    let (mut told, mut rows) = (0, 0);
    for seed in 0..60 {
        let wave = random_wave(seed, 5332.0, 0.3);
        let noise = 0.002 * wave.main_amplitude;
        let size = noise * f64::sqrt(2.0 * 70.0 / f64::from(length as u32));
        let flaws = Flaws::white(noise);
        let settings = Settings {
            frequency: Some(5332.0),
            ..settings(50, true)
        };
        let has_burst = |index: usize| index > 16 && index.is_multiple_of(2);
        let found = identify_changed(wave, &flaws, settings, 51 * window, seed, |k, [c, d]| {
            let (index, at) = (k / window, k % window);
            if has_burst(index) && at / length == 9 + index % 7 {
                let phase = std::f64::consts::TAU * 5332.0 * k as f64 / RATE + index as f64;
                [c + size * phase.cos(), d]
            } else {
                [c, d]
            }
        });
        for (index, estimate) in found.iter().enumerate() {
            assert_eq!(estimate.start as usize, index * window);
            if has_burst(index) {
                rows += 1;
                told += usize::from(estimate.flags.contains(Flags::MISFIT));
            } else {
                assert!(estimate.flags.is_empty(), "{estimate:?}");
            }
        }
    }
    let share = f64::from(told as u32) / f64::from(rows as u32);
    println!("bursts in one block: {told} of {rows} are told");
    assert!(rows > 1000 && (0.61..0.75).contains(&share), "{share}");
}

#[test]
fn a_tone_that_no_block_shows_is_flagged_in_hum() {
    // The sums of blocks of two periods do not show it, but samples deviate from the wave by more than hum explains.
    for (hum_size, tone_size) in [(0.05, 0.2), (0.1, 0.3), (0.2, 0.7)] {
        for (tone_size, is_told) in [(tone_size, true), (0.0, false)] {
            for seed in 0..10 {
                let wave = random_wave(seed, 5000.0, 0.3);
                let a = wave.main_amplitude;
                let flaws = Flaws::white(0.002 * a);
                let settings = Settings {
                    frequency: Some(5000.0),
                    ..settings(40, true)
                };
                let found = identify_changed(wave, &flaws, settings, 10_000, seed, |k, [c, d]| {
                    let second = std::f64::consts::TAU * k as f64 / RATE;
                    let hum = hum_size * (50.0 * second).sin();
                    let tone = tone_size * (10_000.0 * second + seed as f64).sin();
                    [c + a * (hum + tone), d + a * (hum + tone)]
                });
                assert!(found.len() > 9);
                for estimate in &found {
                    assert_eq!(
                        estimate.flags.contains(Flags::MISFIT),
                        is_told,
                        "hum {hum_size}, tone {tone_size}, seed {seed}: {estimate:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_ring_down_is_tracked_below_its_hum() {
    let wave = Wave {
        main_amplitude: 0.9,
        quadrature_amplitude: 0.01,
        decay_rate: 1.0,
        ..Wave::default()
    };
    let flaws = Flaws::white(1e-4);
    // At the end the hum is three times the wave.
    let samples = 800_000;
    let with = identified(wave, flaws.clone(), 1e-3, samples, settings(10, true), 1);
    let without = identified(wave, flaws, 1e-3, samples, settings(10, false), 1);
    let clean = |rows: &[Estimate]| rows.iter().filter(|e| e.flags.is_empty()).count();
    println!(
        "of {} windows {} are clean, {} without the setting",
        samples / 190,
        clean(&with),
        clean(&without)
    );
    assert!(with.len() > 4100 && clean(&with) > 4100);
    assert!(clean(&without) < 3500);
}

#[test]
fn waves_of_any_valid_size_are_found_with_the_setting_too() {
    for scale in [1e-15, 1e-14, 1.0, 1e14, 9e16] {
        let wave = Wave {
            main_amplitude: scale,
            quadrature_amplitude: 0.1 * scale,
            ..Wave::default()
        };
        let flaws = Flaws::white(1e-3 * scale);
        let settings = Settings {
            hop: Some(10),
            ..settings(10, true)
        };
        let found = identified(wave, flaws, 0.0, 20_000, settings, 1);
        let clean = found.iter().filter(|e| e.flags.is_empty()).count();
        assert!(clean > 95 && clean == found.len(), "{scale:e}: {clean}");
    }
}

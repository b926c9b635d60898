//! The first window of a wave, for which no earlier noise is known.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use antinode::{Estimate, Flags, Settings};
use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::score::{StatedRatio, errors, stated};
use host_tests::{RATE, identify, identify_changed, identify_parts, stream, windows};

#[test]
fn a_spike_or_a_small_step_in_the_first_window_is_flagged() {
    // An outlier is excluded from the noise that it is compared with: among fifty or a hundred numbers it would hide itself.
    for (periods, spike, step, least) in [
        (20, 0.16, 0.0, 98),
        (50, 0.08, 0.0, 88),
        (20, 0.0, 0.016, 90),
    ] {
        // Of codes a floor of noise is known, which must not hide faults while no noise has been seen.
        for codes in [Some(500.0), None] {
            let mut told = 0;
            for seed in 0..100 {
                let wave = random_wave(seed, 5332.0, 0.3);
                let scale = codes.map_or(1.0, |codes| codes / wave.main_amplitude);
                let wave = Wave {
                    main_amplitude: scale * wave.main_amplitude,
                    quadrature_amplitude: scale * wave.quadrature_amplitude,
                    ..wave
                };
                let a = wave.main_amplitude;
                let flaws = Flaws::white(0.002 * a);
                let settings = Settings {
                    frequency: Some(5332.0),
                    resolution: codes.map(|_| 1.0),
                    ..windows(periods)
                };
                let window = 19 * usize::from(periods);
                // Anywhere except in the first and the last block.
                let at =
                    window / 5 + (0.6 * window as f64 * (0.618 * seed as f64).fract()) as usize;
                let found =
                    identify_changed(wave, &flaws, settings, window + 30, seed, |k, [c, d]| {
                        let gain = if k < at { 1.0 } else { 1.0 + step };
                        let pair = [gain * c + if k == at { spike * a } else { 0.0 }, gain * d];
                        pair.map(|x| if codes.is_some() { x.round() } else { x })
                    });
                told += usize::from(found[0].flags.contains(Flags::MISFIT));
            }
            let label =
                format!("{periods} periods, spike of {spike}, step of {step}, codes {codes:?}");
            println!("{label}: {told} of 100 told");
            assert!(told >= least, "{label}: {told}");
        }
    }
}

#[test]
fn a_step_within_a_long_first_window_is_flagged() {
    for (periods, noise) in [(50, 0.002), (50, 0.02)] {
        for seed in 0..10 {
            let wave = random_wave(seed, 5332.0, 0.3);
            let flaws = Flaws::white(noise * wave.main_amplitude);
            let louder = Wave {
                main_amplitude: 1.5 * wave.main_amplitude,
                quadrature_amplitude: 1.5 * wave.quadrature_amplitude,
                ..wave
            };
            let turned = Wave {
                angle: wave.angle + 0.3,
                ..wave
            };
            let window = 19 * usize::from(periods);
            for (to, name) in [(louder, "louder"), (turned, "turned")] {
                for part in [3, 5, 7] {
                    let at = 50 + window * part / 10;
                    let one = stream(wave, flaws.clone(), at, seed);
                    let two = stream(to, flaws.clone(), 4 * window, seed);
                    let found = identify_parts(&[&one, &two[at..]], windows(periods));
                    let first = &found[0];
                    assert!(first.start < 70);
                    assert!(
                        first.flags.contains(Flags::MISFIT),
                        "{periods} periods, noise {noise}, {name} at {part}, seed {seed}: {}",
                        first.flags
                    );
                }
            }
        }
    }
}

#[test]
fn a_burst_in_the_first_window_is_flagged_or_within_deviations() {
    // A wave half as large again for two periods; from some places on it looks like noise.
    for (from, least) in [(14, 20), (21, 130), (56, 200), (75, 200), (140, 120)] {
        for noise in [0.002, 0.02] {
            let (mut told, mut worst) = (0, 0f64);
            for seed in 0..200 {
                let wave = random_wave(seed, 5332.0, 0.3);
                let flaws = Flaws::white(noise * wave.main_amplitude);
                let settings = Settings {
                    frequency: Some(5332.0),
                    ..windows(10)
                };
                let found = identify_changed(wave, &flaws, settings, 220, seed, |k, pair| {
                    let gain = if (from..from + 39).contains(&k) {
                        1.5
                    } else {
                        1.0
                    };
                    pair.map(|value| gain * value)
                });
                let first = &found[0];
                if first.flags.is_empty() {
                    worst = worst.max(errors(first, &wave)[0].abs() / stated(first)[0]);
                } else {
                    told += 1;
                }
            }
            let label = format!("burst from {from}, noise {noise}");
            println!("{label}: {told} of 200 told, {worst:.1} sigma");
            assert!(
                told >= least && worst < 8.5,
                "{label}: {told} told, {worst} sigma"
            );
        }
    }
}

#[test]
fn a_step_within_the_first_window_is_flagged() {
    for periods in [10, 20] {
        for (noise, factor) in [
            (1e-4, 0.9),
            (0.002, 0.9),
            (0.002, 0.5),
            (0.02, 0.5),
            (0.002, 0.0),
        ] {
            let mut rows = 0;
            for seed in 0..100u64 {
                let wave = random_wave(seed, 5332.0, 0.3);
                let flaws = Flaws::white(noise * wave.main_amplitude);
                let settings = Settings {
                    frequency: Some(5332.0),
                    ..windows(periods)
                };
                let length = (RATE / 5332.0 * f64::from(periods)) as usize;
                // Anywhere except in the first and the last block, for which the others may make up.
                let at =
                    length / 5 + (0.6 * length as f64 * (0.618 * seed as f64).fract()) as usize;
                let found =
                    identify_changed(wave, &flaws, settings, length + 20, seed, |k, pair| {
                        if k < at {
                            pair
                        } else {
                            pair.map(|value| factor * value)
                        }
                    });
                // If too little of the wave is left there is no window.
                rows += found.len();
                for estimate in found {
                    assert!(
                        estimate.flags.contains(Flags::MISFIT),
                        "{periods} periods, noise {noise}, {factor} times the wave from pair {at} on: {}",
                        estimate.flags
                    );
                }
            }
            let least = if factor > 0.0 { 100 } else { 40 };
            assert!(
                rows >= least,
                "{periods} periods, {factor} times the wave: {rows}"
            );
        }
    }
}

#[test]
fn no_first_window_of_a_steady_wave_is_flagged() {
    for periods in [2, 4, 10, 50] {
        for seed in 0..4000 {
            let wave = random_wave(seed, 5332.0, 0.3);
            let noise = [1e-4, 0.002, 0.02, 0.1][seed as usize % 4];
            let flaws = Flaws {
                noise: noise * wave.main_amplitude,
                offset_c: 0.2 * wave.main_amplitude,
                ..Flaws::default()
            };
            let length = (RATE / 5332.0 * (f64::from(periods) + 8.0)) as usize;
            let found =
                identify_changed(wave, &flaws, windows(periods), length, seed, |_, pair| pair);
            assert!(!found.is_empty());
            // In noise of ten per cent, two periods may look like a circle.
            let fault = found[0].flags.without(Flags::CIRCULAR);
            assert!(
                fault.is_empty(),
                "{periods} periods, noise {noise}: {fault}"
            );
        }
    }
}

#[test]
fn a_tone_of_twice_the_frequency_is_flagged_in_the_first_window_though_it_looks_like_noise() {
    // With an odd number of half samples a period, blocks of whole periods show as much of it as of noise.
    let (mut told, mut runs) = (0, 0);
    for (period, periods) in [(10.5, 10), (12.5, 10), (8.5, 50)] {
        for seed in 0..20 {
            let wave = random_wave(seed, RATE / period, 0.3);
            let a = wave.main_amplitude;
            let flaws = Flaws::white(1e-3 * a);
            let settings = Settings {
                frequency: Some(wave.frequency as f32),
                ..windows(periods)
            };
            let samples = (1.2 * period * f64::from(periods)) as usize;
            let found = identify_changed(wave, &flaws, settings, samples, seed, |k, [c, d]| {
                let phase = std::f64::consts::TAU * 2.0 * k as f64 / period + seed as f64;
                let tone = |phase: f64| 0.95 * a * phase.cos();
                [c + tone(phase), d + tone(phase + 1.1 + seed as f64)]
            });
            runs += found.len();
            told += found.iter().filter(|e| !e.flags.is_empty()).count();
        }
    }
    println!("a tone of twice the frequency: {told} of {runs} first windows flagged");
    assert!(runs == 60 && told > 40, "{told} of {runs}");
}

#[test]
fn the_frequency_of_a_first_window_at_rest_is_better_than_stated_as_documented() {
    for (periods, noise) in [(4, 0.02), (10, 0.002), (50, 0.002)] {
        for (quadrature, documented) in [(0.5, 0.8), (0.65, 0.6), (0.85, 0.4), (0.93, 0.3)] {
            let mut ratio = StatedRatio::default();
            for seed in 0..2000 {
                let wave = random_wave(seed, 5332.0, 0.5);
                let a = wave.main_amplitude;
                let wave = Wave {
                    quadrature_amplitude: (quadrature * a).copysign(wave.quadrature_amplitude),
                    ..wave
                };
                let flaws = Flaws::white(noise * a);
                let samples = (RATE / 5332.0 * (f64::from(periods) + 6.0)) as usize;
                let found = identify(wave, &flaws, windows(periods), samples, seed);
                ratio.add(&found[0], &wave);
            }
            let [.., frequency] = ratio.ratios();
            println!(
                "{periods} periods, quadrature {quadrature}: error of f over stated {frequency:.2}"
            );
            assert!((frequency - documented).abs() < 0.09, "{frequency}");
        }
    }
}

#[test]
fn no_first_window_of_seven_or_ten_pairs_is_clipped_by_noise() {
    // The wave leaves four or ten degrees of freedom: as often as in one window in twenty most of that is along a third harmonic.
    for (period, periods, pairs) in [(3.4, 2, 7), (3.3, 3, 10)] {
        let mut first = 0;
        for seed in 0..1000 {
            let wave = random_wave(seed, RATE / period, 0.3);
            let flaws = Flaws::white(0.013 * wave.main_amplitude);
            let settings = Settings {
                frequency: Some(wave.frequency as f32),
                ..windows(periods)
            };
            for estimate in identify_changed(wave, &flaws, settings, pairs, seed, |_, pair| pair) {
                first += 1;
                assert!(
                    !estimate.flags.contains(Flags::CLIPPED),
                    "{pairs} pairs, seed {seed}: {}",
                    estimate.flags
                );
            }
        }
        assert_eq!(first, 1000);
    }
}

#[test]
fn the_shortest_first_windows_exceed_their_deviations_as_documented() {
    for (period, periods, pairs, most) in [
        (3.4, 2, 7, 1.45),
        (2.6, 3, 8, 1.3),
        (3.0, 3, 9, 1.2),
        (3.4, 3, 10, 1.2),
        (4.0, 3, 12, 1.14),
        (6.1, 3, 18, 1.12),
        (18.75, 2, 36, 1.12),
    ] {
        let mut ratio = StatedRatio::default();
        for seed in 0..3000 {
            let wave = random_wave(seed, RATE / period, 0.5);
            let flaws = Flaws::white(0.01 * wave.main_amplitude);
            let settings = Settings {
                frequency: Some(wave.frequency as f32),
                ..windows(periods)
            };
            for row in identify(wave, &flaws, settings, pairs, seed) {
                assert_eq!(row.samples as usize, pairs);
                ratio.add(&row, &wave);
            }
        }
        let ratios = ratio.ratios();
        println!("first windows of {pairs} pairs: error over stated {ratios:.3?}");
        assert!(ratios.iter().all(|&ratio| ratio < most), "{pairs} pairs");
    }
}

#[test]
fn misfits_before_the_first_clean_window_do_not_change_the_angle_with_which_the_wave_starts() {
    // The pattern turns by 1.5 rad in eight windows with a spike each: the first angle without a flag is the one next to the start angle.
    let wave = Wave {
        main_amplitude: 1.0,
        angle_rate: 100.0,
        ..Wave::default()
    };
    let settings = Settings {
        frequency: Some(wave.frequency as f32),
        ..windows(10)
    };
    for seed in 0..10 {
        let flaws = Flaws::white(1e-3);
        let found = identify_changed(wave, &flaws, settings, 3000, seed, |k, [c, d]| {
            let is_spike = k < 8 * 190 && k % 190 == 100;
            [c + if is_spike { 0.3 } else { 0.0 }, d]
        });
        let is_misfit = |e: &&Estimate| e.flags.contains(Flags::MISFIT);
        assert_eq!(found.iter().take_while(is_misfit).count(), 8);
        let turned = wave.at(found[8].time).angle;
        let wanted = turned - FRAC_PI_2;
        assert!(found[8].flags.is_empty() && wanted.abs() < FRAC_PI_4);
        let angle = found[8].angle;
        assert!(
            (angle - wanted).abs() < 0.01,
            "{angle} where {wanted} is next to 0"
        );
    }
}

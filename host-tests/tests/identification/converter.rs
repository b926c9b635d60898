//! Signals through a converter: its steps are part of the stated deviations, and never cause a flag on a clean signal.

use antinode::{Estimate, Flags, Settings};
use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::score::{errors, stated};
use host_tests::{RATE, identify, identify_changed, windows};

#[test]
fn errors_from_converter_steps_are_stated() {
    // From no noise at all, where the errors repeat with the signal, to noise that breaks up this pattern.
    for noise in [0.0, 0.3, 2.0] {
        let (mut sums, mut count) = ([0.0; 4], 0.0);
        for bits in [10u32, 12, 16] {
            for scale in [0.9, 0.3] {
                for period in [4.3, 18.75, 20.0, 60.0] {
                    for periods in [2, 10, 50] {
                        let ratios = check(bits, scale, period, noise, periods);
                        for (sum, ratio) in sums.iter_mut().zip(ratios) {
                            *sum += ratio;
                        }
                        count += 1.0;
                    }
                }
            }
        }
        let means = sums.map(|sum| sum / count);
        println!("noise of {noise} steps: errors {means:.2?} of what is stated");
        // The frequency's errors are far smaller if they are the same in every period.
        assert!(means[..3].iter().all(|mean| (0.75..1.1).contains(mean)));
    }
}

#[test]
fn the_same_few_codes_in_every_period_are_no_misfit() {
    // Four or six samples a period, exactly: a window's errors are all alike, and another window may have none.
    for noise in [0.15, 0.2, 0.25, 0.3, 0.35, 0.4] {
        for (bits, scale, period) in [
            (10, 0.9, 4.0),
            (10, 0.3, 4.0),
            (12, 0.9, 4.0),
            (12, 0.3, 4.0),
            (10, 0.9, 6.0),
        ] {
            for periods in [3, 10] {
                check(bits, scale, period, noise, periods);
            }
        }
    }
}

/// Runs one combination; gives errors over stated deviations. `scale` is the amplitude over full scale, `noise` is in steps.
fn check(bits: u32, scale: f64, period: f64, noise: f64, periods: u16) -> [f64; 4] {
    let label = format!(
        "{bits} bits, {scale} of full scale, {period} a period, noise {noise} steps, {periods} periods"
    );
    let (mut squares, mut rows, mut flagged) = ([0f64; 4], 0.0, 0);
    for seed in 0..5 {
        let wave = Wave {
            decay_rate: 0.1,
            angle_rate: 0.05,
            ..random_wave(seed, RATE / period, 0.3)
        };
        let full_scale = wave.main_amplitude / scale;
        let step = full_scale / 2f64.powi(bits as i32 - 1);
        let flaws = Flaws {
            noise: noise * step,
            bits: Some(bits),
            full_scale,
            ..Flaws::default()
        };
        let settings = Settings {
            resolution: Some(step as f32),
            rails: Some([-1.0, 1.0].map(|side| (side * (full_scale - step)) as f32)),
            ..windows(periods)
        };
        let samples = (period * f64::from(periods) * 30.0) as usize;
        for estimate in identify(wave, &flaws, settings, samples, seed) {
            rows += 1.0;
            flagged += usize::from(!estimate.flags.is_empty());
            let stds = stated(&estimate);
            for (i, error) in errors(&estimate, &wave).into_iter().enumerate() {
                squares[i] += (error / stds[i]).powi(2);
            }
        }
    }
    assert!(rows > 100.0, "{label}: {rows} rows");
    assert_eq!(flagged, 0, "{label}");
    let ratios = squares.map(|square| (square / rows).sqrt());
    for ratio in ratios {
        assert!(ratio < 1.5, "{label}: {ratio:.2} of what is stated");
    }
    ratios
}

#[test]
fn the_residual_is_that_of_the_samples_whatever_the_window() {
    for periods in [10u16, 100] {
        let wave = Wave::default();
        let step = wave.main_amplitude / 0.9 / 2048.0;
        let flaws = Flaws {
            noise: 0.05 * step,
            bits: Some(12),
            full_scale: wave.main_amplitude / 0.9,
            ..Flaws::default()
        };
        let settings = Settings {
            resolution: Some(step as f32),
            ..windows(periods)
        };
        let estimates = identify(wave, &flaws, settings, 60_000, 1);
        let square = |e: &Estimate| f64::from(e.residual_rms).powi(2);
        let mean = estimates.iter().map(square).sum::<f64>() / estimates.len() as f64;
        let ratio = mean.sqrt() / step / f64::sqrt(0.05f64.powi(2) + 1.0 / 12.0);
        assert!((0.9..1.1).contains(&ratio), "{periods} periods: {ratio}");
    }
}

/// Estimates of a wave in steps of `step`, in noise of `noise` steps and limited to `most`, with the step known to the core or not.
fn in_steps(
    wave: Wave,
    step: f64,
    noise: f64,
    is_known: bool,
    (samples, seed): (usize, u64),
    most: f64,
) -> Vec<Estimate> {
    let flaws = Flaws::white(noise * step);
    let settings = Settings {
        resolution: is_known.then_some(step as f32),
        ..windows(10)
    };
    identify_changed(wave, &flaws, settings, samples, seed, |_, pair| {
        pair.map(|s| (s.min(most) / step).round() * step)
    })
}

#[test]
fn crests_in_noise_of_some_steps_are_not_clipped_and_limited_ones_are() {
    // Of a hundred steps and more: three samples of a crest have the same code by chance.
    for (steps, noise) in [(110.0, 3.0), (110.0, 4.5), (250.0, 9.0)] {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 0.1,
            angle: 0.4,
            ..Wave::default()
        };
        let clipped = |most: f64, samples| {
            let found = in_steps(wave, 1.0 / steps, noise, true, (samples, 5), most);
            let clipped = found.iter().filter(|e| e.flags.contains(Flags::CLIPPED));
            (clipped.count(), found.len())
        };
        let (count, rows) = clipped(f64::INFINITY, 4_000_000);
        println!("{steps} steps, noise of {noise}: {count} of {rows} clipped");
        assert!(
            count == 0 && rows > 20_000,
            "{steps} steps, noise of {noise}: {count} of {rows}"
        );
        let (count, rows) = clipped(0.6, 40_000);
        assert!(
            count == rows && rows > 200,
            "{steps} steps, noise of {noise}: {count} of {rows}"
        );
    }
}

#[test]
fn crests_of_few_steps_are_not_clipped() {
    // A slow wave of 30 steps, with one code in all of a crest; a pick-off in a node, with a few codes in all; and a wave of eight bits, in
    // the crests of which three or four samples have one code, or with noise more of them by chance.
    for (period, steps, angle, is_known) in [
        (120.0, 30.0, 0.3, true),
        (18.75, 1000.0, 1e-3, false),
        (47.3, 110.0, 0.3, true),
        (31.7, 127.0, 0.2, false),
        (64.0, 127.0, 0.2, true),
    ] {
        for noise in [0.0, 0.3, 0.6, 1.2] {
            let wave = Wave {
                main_amplitude: 1.0,
                quadrature_amplitude: 1e-3,
                angle,
                frequency: RATE / period,
                ..Wave::default()
            };
            let samples = (period * 400.0) as usize;
            let found = in_steps(
                wave,
                1.0 / steps,
                noise,
                is_known,
                (samples, 1),
                f64::INFINITY,
            );
            assert!(found.len() > 30);
            for estimate in &found {
                assert!(
                    !estimate.flags.contains(Flags::CLIPPED),
                    "{period} samples a period, {steps} steps, noise of {noise}: {estimate:?}"
                );
            }
        }
    }
}

#[test]
fn steps_of_the_weaker_pick_off_are_stated_whichever_it_is() {
    for period in [18.75, 20.0, 37.5] {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 0.01,
            angle: 0.03,
            frequency: RATE / period,
            ..Wave::default()
        };
        let step = 0.02;
        let settings = Settings {
            resolution: Some(step as f32),
            ..windows(50)
        };
        let flaws = Flaws::white(1e-4);
        let [first, second] = [false, true].map(|is_swapped| {
            let found = identify_changed(wave, &flaws, settings, 10_000, 1, |_, pair| {
                let [c, d] = pair.map(|x| (x / step).round() * step);
                if is_swapped { [d, c] } else { [c, d] }
            });
            found.last().unwrap().main_amplitude_std
        });
        let ratio = first / second;
        println!("period {period}: {first:.2e} and {second:.2e}");
        assert!((0.95..1.05).contains(&ratio), "{period}: {ratio}");
    }
}

#[test]
fn a_step_that_is_not_known_shows_only_in_noise_below_0_4_of_it() {
    // The largest of the errors of a_A, a_B and angle over their deviations, rms, and the share of windows flagged.
    let seen = |period: f64, noise: f64, is_known: bool| {
        let (mut squares, mut rows, mut flagged) = ([0f64; 3], 0.0, 0.0);
        for seed in 0..60 {
            let wave = Wave {
                decay_rate: 0.1,
                angle_rate: 0.05,
                ..random_wave(seed, RATE / period, 0.3)
            };
            let step = wave.main_amplitude / 100.0;
            let samples = (60.0 * period) as usize;
            for estimate in in_steps(wave, step, noise, is_known, (samples, seed), f64::INFINITY) {
                rows += 1.0;
                flagged += f64::from(u8::from(!estimate.flags.is_empty()));
                let (errors, stds) = (errors(&estimate, &wave), stated(&estimate));
                for (i, square) in squares.iter_mut().enumerate() {
                    *square += (errors[i] / stds[i]).powi(2);
                }
            }
        }
        let largest = squares.into_iter().fold(0f64, f64::max);
        ((largest / rows).sqrt(), flagged / rows)
    };
    for (period, noise, errors) in [
        (20.0, 0.4, 0.9..1.15),
        (20.0, 0.3, 0.95..1.25),
        (20.0, 0.2, 1.5..2.2),
        (18.7531, 0.2, 0.9..1.2),
    ] {
        let (unknown, flagged) = seen(period, noise, false);
        let (known, flagged_if_known) = seen(period, noise, true);
        println!(
            "{period} samples a period, noise of {noise} steps: {unknown:.2}, {known:.2} if known"
        );
        assert!(errors.contains(&unknown), "{period}, {noise}: {unknown}");
        assert!(known < 1.2, "{period}, {noise}: {known}");
        assert!(flagged < 0.01 && flagged_if_known == 0.0, "{flagged}");
    }
    let (_, flagged) = seen(20.0, 0.0, false);
    println!("without noise {flagged:.2} of the windows flagged");
    assert!((0.5..0.95).contains(&flagged), "{flagged}");
    assert_eq!(seen(20.0, 0.0, true).1, 0.0);
}

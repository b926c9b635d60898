//! Stated values beside the four main quantities: phase, rates and offsets, against the truth and their own deviations.

use std::f64::consts::FRAC_PI_2;

use antinode::{Estimate, Flags, Settings};
use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::score::StatedRatio;
use host_tests::{
    angle_error, calibrated, identify, identify_changed, identify_parts, stream, windows,
};

/// The error of α, which depends on the choice of the angle, rad.
fn error_of_phase(estimate: &Estimate, wave: &Wave) -> f64 {
    let truth = wave.at(estimate.time);
    let quarters = ((estimate.angle - truth.angle) / FRAC_PI_2).round();
    let shift = std::f64::consts::PI * quarters.rem_euclid(2.0);
    let error = f64::from(estimate.phase) - truth.phase - shift;
    assert!(angle_error(estimate.angle, truth.angle).abs() < 0.5);
    error - (error / std::f64::consts::TAU).round() * std::f64::consts::TAU
}

#[test]
fn phases_scatter_as_stated() {
    for (periods, quadrature) in [(2, 0.1), (10, 0.1), (10, 0.7), (50, 0.4)] {
        let (mut square, mut rows) = (0.0, 0.0);
        for seed in 0..200 {
            let wave = random_wave(seed, 5332.0, 0.1);
            let wave = Wave {
                quadrature_amplitude: quadrature * wave.main_amplitude,
                ..wave
            };
            let flaws = Flaws::white(0.01 * wave.main_amplitude);
            let samples = 19 * usize::from(periods) * 8 + 300;
            for estimate in identify(wave, &flaws, windows(periods), samples, seed) {
                let error = error_of_phase(&estimate, &wave);
                square += (error / f64::from(estimate.phase_std)).powi(2);
                rows += 1.0;
            }
        }
        let ratio = f64::sqrt(square / rows);
        println!("{periods} periods, a_B of {quadrature} a_A: phase error over stated {ratio:.3}");
        assert!(
            rows > 1000.0 && (0.93..1.07).contains(&ratio),
            "{periods} periods, {quadrature}: {ratio}"
        );
    }
}

#[test]
fn offsets_scatter_by_the_residual_over_the_root_of_the_samples() {
    for (periods, hum, most) in [
        (2, false, 1.2),
        (10, false, 1.1),
        (50, false, 1.05),
        (10, true, 1.15),
    ] {
        let (mut square, mut rows) = (0.0, 0.0);
        for seed in 0..200 {
            let wave = random_wave(seed, 5332.0, 0.1);
            let flaws = Flaws {
                noise: 0.01 * wave.main_amplitude,
                offset_c: 0.3 * wave.main_amplitude,
                ..Flaws::default()
            };
            let settings = Settings {
                hum,
                ..windows(periods)
            };
            let samples = 19 * usize::from(periods) * 8 + 300;
            for estimate in identify(wave, &flaws, settings, samples, seed) {
                let stated = f64::from(estimate.residual_rms) / f64::from(estimate.samples).sqrt();
                for (offset, truth) in estimate.offsets.into_iter().zip([flaws.offset_c, 0.0]) {
                    square += ((f64::from(offset) - truth) / stated).powi(2);
                    rows += 1.0;
                }
            }
        }
        let ratio = f64::sqrt(square / rows);
        println!("{periods} periods, hum {hum}: offset's error over residual/√samples {ratio:.3}");
        assert!(
            rows > 2000.0 && (0.97..most).contains(&ratio),
            "{periods} periods, hum {hum}: {ratio}"
        );
    }
}

#[test]
fn phases_scatter_as_stated_with_calibrated_pick_offs() {
    for (gain_ratio, pick_off_angle) in [(1.0, 0.3), (1.0, -0.3), (2.0, 0.0), (0.5, 0.2)] {
        for angle in [0.0, 0.4, 0.8] {
            let (mut square, mut rows) = (0.0, 0.0);
            for seed in 0..100 {
                let wave = Wave {
                    angle,
                    main_amplitude: 1.0,
                    quadrature_amplitude: 0.3,
                    phase: 0.1 * seed as f64,
                    ..Wave::default()
                };
                let flaws = Flaws {
                    noise: 0.01,
                    gain_ratio,
                    pick_off_angle,
                    ..Flaws::default()
                };
                let settings = calibrated(&flaws, 10);
                for estimate in identify(wave, &flaws, settings, 2000, seed) {
                    let error = error_of_phase(&estimate, &wave);
                    square += (error / f64::from(estimate.phase_std)).powi(2);
                    rows += 1.0;
                }
            }
            let ratio = f64::sqrt(square / rows);
            assert!(
                rows > 900.0 && (0.9..1.1).contains(&ratio),
                "gain {gain_ratio}, {pick_off_angle} rad, angle {angle}: {ratio}"
            );
        }
    }
}

#[test]
fn deviations_hold_in_first_windows_with_more_noise() {
    let mut honesty = StatedRatio::default();
    for seed in 0..400 {
        let wave = random_wave(seed, 5332.0, 0.3);
        let flaws = |share: f64| Flaws::white(share * wave.main_amplitude);
        let quiet = stream(wave, flaws(0.002), 5000, seed);
        let loud = stream(wave, flaws(0.02), 6000, seed);
        let found = identify_parts(&[&quiet, &loud[5000..]], windows(10));
        for estimate in found.iter().filter(|e| e.start >= 5000).take(2) {
            honesty.add(estimate, &wave);
        }
    }
    let ratios = honesty.ratios();
    println!("ten times the noise: errors over stated {ratios:.2?}");
    assert!(ratios.iter().all(|ratio| (0.9..1.15).contains(ratio)));
}

#[test]
fn a_bad_first_window_does_not_spoil_later_ones() {
    // The wave is found while it is still driven and grows by half in the first window; or that window has ten times the noise, which
    // nothing before shows to be unusual.
    for (gain, noise) in [(0.7, 1.0), (1.0, 10.0)] {
        let mut honesty = StatedRatio::default();
        for seed in 0..40 {
            let wave = random_wave(seed, 5332.0, 0.3);
            let a = wave.main_amplitude;
            let flaws = |noise: f64| Flaws::white(0.002 * noise * a);
            let loud = stream(wave, flaws(noise), 190, seed);
            let settings = Settings {
                frequency: Some(5332.0),
                ..windows(10)
            };
            let found = identify_changed(wave, &flaws(1.0), settings, 8000, seed, |k, [c, d]| {
                let gain = if k < 150 { gain } else { 1.0 };
                // A spike in every third window, after the first.
                let spike = if k > 4000 && k % 570 == 0 { 0.3 } else { 0.0 };
                match loud.get(k).filter(|_| noise > 1.0) {
                    Some(pair) => pair.map(f64::from),
                    None => [gain * c + spike * a, gain * d],
                }
            });
            for estimate in &found[2..] {
                let spikes = (estimate.start..estimate.end()).filter(|k| *k > 4000 && k % 570 == 0);
                if spikes.count() > 0 {
                    assert!(estimate.flags.contains(Flags::MISFIT), "{estimate:?}");
                    continue;
                }
                assert!(estimate.flags.is_empty(), "{estimate:?}");
                honesty.add(estimate, &wave);
            }
        }
        let ratios = honesty.ratios();
        println!(
            "after a first window of {gain} the wave, {noise} times the noise: errors over stated {ratios:.2?}"
        );
        assert!(ratios.iter().all(|ratio| (0.85..1.15).contains(ratio)));
    }
}

#[test]
fn rates_are_exact_without_noise() {
    for (periods, angle_rate, decay_rate) in
        [(10, 5.0, 20.0), (10, -20.0, 100.0), (50, -5.0, -10.0)]
    {
        for seed in 0..5 {
            let wave = Wave {
                angle_rate,
                decay_rate,
                ..random_wave(seed, 5332.0, 0.5)
            };
            let found = identify(wave, &Flaws::default(), windows(periods), 8000, seed);
            assert!(found.len() > 5);
            for estimate in &found {
                let turning = f64::from(estimate.angle_rate) - angle_rate;
                let decay = f64::from(estimate.decay_rate) - decay_rate;
                assert!(
                    turning.abs() < 5e-3 && decay.abs() < 2e-2,
                    "{turning} {decay} {estimate:?}"
                );
            }
        }
    }
}

#[test]
fn rows_of_waves_with_splits_agree_with_their_truth() {
    let (mut honesty, mut squares, mut rows) = (StatedRatio::default(), [0.0; 3], 0.0);
    for seed in 0..60 {
        // Each rate is many of its deviations.
        let wave = Wave {
            angle_rate: 0.5,
            decay_rate: 2.0,
            damping_split: 3.0,
            damping_angle: 0.1 * seed as f64,
            frequency_split: 0.5,
            frequency_angle: 0.17 * seed as f64,
            ..random_wave(seed, 5332.0, 0.5)
        };
        let flaws = Flaws::white(2e-4 * wave.main_amplitude);
        let estimates = identify(wave, &flaws, windows(10), 8000, seed);
        // The first window assumes a pattern at rest.
        for estimate in estimates.iter().skip(1) {
            let truth = wave.at(estimate.time);
            // Near a circle deviations are no longer small.
            if truth.quadrature_amplitude.abs() > 0.6 * truth.main_amplitude {
                continue;
            }
            assert_eq!(estimate.flags, Flags::empty());
            honesty.add(estimate, &wave);
            let turn = f64::from(estimate.angle_rate) - truth.angle_rate;
            let decay = f64::from(estimate.decay_rate) - truth.decay_rate;
            for (square, (error, std)) in squares.iter_mut().zip([
                (error_of_phase(estimate, &wave), estimate.phase_std),
                (turn, estimate.angle_rate_std),
                (decay, estimate.decay_rate_std),
            ]) {
                *square += (error / f64::from(std)).powi(2);
            }
            rows += 1.0;
        }
    }
    let others = squares.map(|square| f64::sqrt(square / rows));
    let ratios = honesty.ratios();
    println!("{rows} rows: {ratios:.3?}; phase and rates {others:.3?}");
    assert!(rows > 1500.0);
    let honest = |ratio: &f64| (0.9..1.1).contains(ratio);
    assert!(ratios.iter().chain(&others).all(honest));
}

#[test]
fn deviations_follow_unflagged_changes_of_noise() {
    // Windows after the change that are scored together, and the limits of their errors over deviations: less noise is believed later.
    let spans = [(0..2, 0.65..1.12), (2..5, 0.85..1.1), (5..16, 0.95..1.1)];
    for factor in [1.2, 1.5, 1.7, 0.8, 0.6, 0.3] {
        for periods in [2, 10] {
            let mut honesty = [StatedRatio::default(); 3];
            for seed in 0..300 {
                let wave = random_wave(seed, 5332.0, 0.3);
                let change = 19 * 20 * usize::from(periods) + 100;
                let flaws = |share: f64| Flaws::white(share * wave.main_amplitude);
                let mut pairs = stream(wave, flaws(0.005), 2 * change, seed);
                let changed = stream(wave, flaws(0.005 * factor), 2 * change, seed);
                pairs[change..].copy_from_slice(&changed[change..]);
                let found = identify_parts(&[&pairs], windows(periods));
                let since = found.iter().filter(|e| e.start >= change as u64);
                for (index, estimate) in since.enumerate() {
                    for ((span, _), honesty) in spans.iter().zip(&mut honesty) {
                        if span.contains(&index) {
                            honesty.add(estimate, &wave);
                        }
                    }
                }
                // With nearly twice the noise, single windows are misfits by chance.
                let flagged = found.iter().filter(|e| !e.flags.is_empty()).count();
                assert!(flagged <= 3, "{factor} times the noise: {flagged} flagged");
            }
            let ratios = honesty.map(|honesty| honesty.ratios());
            println!("{factor} times the noise, {periods} periods: {ratios:.2?}");
            for ((_, limits), ratios) in spans.iter().zip(&ratios) {
                assert!(ratios.iter().all(|ratio| limits.contains(ratio)));
            }
        }
    }
}

//! Accuracy with next to no noise is limited by rounding, which the deviations include.

use antinode::{Flags, Identifier};
use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::codes::{self, converted};
use host_tests::score::{StatedRatio, errors, stated};
use host_tests::{RATE, identify, stream, windows};

#[test]
fn stated_deviations_hold_if_there_is_only_rounding() {
    let (mut worst, mut most) = ([0f64; 4], 0f64);
    for seed in 0..60 {
        for periods in [2, 10, 100] {
            let wave = random_wave(seed, 5332.0, 0.3);
            let flaws = Flaws {
                offset_c: wave.main_amplitude,
                ..Flaws::default()
            };
            let found = identify(
                wave,
                &flaws,
                windows(periods),
                19 * usize::from(periods) * 4 + 300,
                seed,
            );
            assert!(found.len() >= 3, "{}", found.len());
            for estimate in found {
                let (errors, stated) = (errors(&estimate, &wave), stated(&estimate));
                for i in 0..4 {
                    assert!(errors[i].abs() < 3.0 * stated[i], "{estimate:?}");
                    worst[i] = worst[i].max(errors[i].abs() / stated[i]);
                }
                most = most.max(stated[0] / wave.main_amplitude);
            }
        }
    }
    println!("errors over stated {worst:.2?}, stated at most {most:e} of a_A");
    assert!(worst.iter().all(|&worst| worst < 3.0) && most < 1e-6);
}

#[test]
fn an_offset_of_ten_waves_does_not_raise_the_deviations_of_codes() {
    // The rounding of the offset in the f32 solution counts in short windows without noise, and hardly in long ones with some.
    let offset = 10.0;
    for (periods, noise, trials, within) in [
        (2, 0.0, 100, 0.05..1.2),
        (10, 0.0, 60, 0.05..1.2),
        (250, 3e-5, 30, 0.9..1.1),
    ] {
        let [mut square, mut rows] = [0.0; 2];
        for seed in 0..trials {
            let (wave, flaws) = converted(
                &random_wave(seed, 5332.0, 0.3),
                &Flaws::default(),
                32,
                0.9 / (offset + 1.5),
            );
            let flaws = Flaws {
                noise: noise * wave.main_amplitude,
                offset_c: offset * wave.main_amplitude,
                offset_d: -offset * wave.main_amplitude,
                ..flaws
            };
            let samples = 19 * usize::from(periods) * 8 + 300;
            let codes = codes::codes(wave, &flaws, samples, seed);
            let settings = codes::settings(32, periods);
            for estimate in codes::identify(&codes, settings, |code| code) {
                assert_eq!(estimate.flags, Flags::empty());
                for (error, stated) in errors(&estimate, &wave).iter().zip(stated(&estimate)) {
                    square += (error / stated).powi(2);
                    rows += 1.0;
                }
            }
        }
        let ratio = f64::sqrt(square / rows);
        println!("{periods} periods, noise {noise}: error over stated {ratio:.3}");
        assert!(
            within.contains(&ratio) && rows > 100.0,
            "{periods}: {ratio}"
        );
    }
}

#[test]
fn deviations_of_f32_exceed_the_errors_by_no_more_than_rounding_of_an_offset_needs() {
    // In long windows, sums round alike in all blocks: the residual shows less of it than there is.
    for (frequency, periods, offset, noise, seeds, within) in [
        (600.0, 4, 40.0, 0.0, 40, 0.1..1.0),
        (5332.0, 10, 40.0, 0.0, 60, 0.15..1.0),
        (13_333.0, 1000, 90.0, 0.0, 60, 0.15..1.0),
        (5332.0, 10, 10.0, 2e-5, 60, 0.95..1.1),
        (5332.0, 10, 40.0, 2e-5, 60, 0.7..1.0),
        (5332.0, 100, 40.0, 1e-4, 60, 0.95..1.1),
    ] {
        let (mut score, mut rows) = (StatedRatio::default(), 0);
        for seed in 0..seeds {
            let wave = random_wave(seed, frequency, 0.3);
            let flaws = Flaws {
                noise: noise * wave.main_amplitude,
                offset_c: offset * wave.main_amplitude,
                offset_d: -offset * wave.main_amplitude,
                ..Flaws::default()
            };
            let samples = (f64::from(periods) * 4.5 * RATE / frequency) as usize + 800;
            let pairs = stream(wave, flaws, samples, seed);
            let mut core = Identifier::<f32, 256, 1024>::new(windows(periods)).unwrap();
            core.extend(&pairs, |estimate| {
                assert_eq!(estimate.flags, Flags::empty());
                rows += 1;
                score.add(&estimate, &wave);
            });
        }
        let ratios = score.ratios();
        println!("{frequency} Hz, {periods} periods, {offset} a_A, noise {noise}: {ratios:.3?}");
        let most = ratios.into_iter().fold(0.0, f64::max);
        assert!(within.contains(&most) && rows > 150, "{most}, {rows}");
    }
}

#[test]
fn deviations_of_the_smallest_waves_are_finite() {
    for power in 12..20 {
        let main_amplitude = 10f64.powi(-power);
        let wave = Wave {
            main_amplitude,
            quadrature_amplitude: 0.2 * main_amplitude,
            ..Wave::default()
        };
        let estimates = identify(wave, &Flaws::default(), windows(10), 1500, 1);
        // Of 10⁻¹⁹ even the wave's square underflows.
        assert!(estimates.len() >= 4 || power > 18, "1e-{power}");
        let clean = estimates.iter().filter(|one| one.flags.is_empty());
        assert!(clean.clone().count() >= 4 || power > 18, "1e-{power}");
        for estimate in clean {
            let stated = stated(estimate);
            let are_told = stated
                .iter()
                .all(|stated| stated.is_finite() && *stated > 0.0);
            assert!(are_told, "1e-{power}: {stated:?}");
            assert!((estimate.main_amplitude as f64 / main_amplitude - 1.0).abs() < 1e-3);
        }
    }
}

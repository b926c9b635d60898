//! Behaviour that users rely on: results do not depend on how a stream is cut; calibration and both detectors work; settings that cannot
//! work are refused.

use antinode::{Detection, Estimate, Flags, Settings, SettingsError, Tracker};
use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::score::{StatedRatio, errors};
use host_tests::{Core, calibrated, identify, stream, windows};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn results_do_not_depend_on_how_the_stream_is_cut(seed in 0u64..1000, cuts in prop::collection::vec(1usize..700, 1..40)) {
        let wave = random_wave(seed, 5332.0, 0.5);
        let pairs = stream(wave, Flaws { noise: 0.01, ..Flaws::default() }, 6000, seed);
        let mut single = Core::new(windows(5)).unwrap();
        let one_by_one: Vec<Estimate> = pairs.iter().filter_map(|&pair| single.push(pair)).collect();
        let mut sliced = Core::new(windows(5)).unwrap();
        let mut separate = Core::new(windows(5)).unwrap();
        let (mut by_slices, mut by_two_slices) = (Vec::new(), Vec::new());
        let mut rest = pairs.as_slice();
        for cut in cuts.iter().cycle() {
            if rest.is_empty() {
                break;
            }
            let (slice, after) = rest.split_at((*cut).min(rest.len()));
            sliced.extend(slice, |estimate| by_slices.push(estimate));
            let [c, mut d] = [0, 1].map(|i| slice.iter().map(|pair| pair[i]).collect::<Vec<_>>());
            // Samples that the longer slice has in excess form no pair.
            d.push(f32::NAN);
            separate.extend_separate(&c, &d, |estimate| by_two_slices.push(estimate));
            rest = after;
        }
        prop_assert!(one_by_one.len() > 40);
        prop_assert_eq!(&one_by_one, &by_slices);
        prop_assert_eq!(one_by_one, by_two_slices);
    }

    #[test]
    fn no_input_panics_or_hangs(samples in prop::collection::vec((prop::num::f32::ANY, prop::num::f32::ANY), 0..3000), periods in 2u16..30, hop in 1u16..40, frequency in prop::option::of(391f32..40_000.0)) {
        let settings = Settings { hop: Some(hop), frequency, rails: Some([-1.0, 1.0]), resolution: Some(1e-3), ..windows(periods) };
        let mut core = Core::new(settings).unwrap();
        for (c, d) in samples {
            let _ = core.push([c, d]);
        }
    }
}

#[test]
fn a_lost_wave_is_searched_again_at_once_however_the_stream_is_cut() {
    for seed in 0..8 {
        let flaws = Flaws::white(0.01);
        // Another wave follows, at a frequency that the windows of the first do not reach.
        let mut pairs = stream(random_wave(seed, 5332.0, 0.5), flaws.clone(), 3000, seed);
        pairs.extend(stream(random_wave(seed, 3100.0, 0.5), flaws, 6000, seed));
        let mut single = Core::new(windows(5)).unwrap();
        let one_by_one: Vec<Estimate> =
            pairs.iter().filter_map(|&pair| single.push(pair)).collect();
        let mut sliced = Core::new(windows(5)).unwrap();
        let mut by_slices = Vec::new();
        let mut rest = pairs.as_slice();
        while !rest.is_empty() {
            let (taken, estimate) = sliced.push_slice(rest);
            rest = &rest[taken..];
            by_slices.extend(estimate);
        }
        let last = one_by_one.last().unwrap();
        assert!((last.frequency - 3100.0).abs() < 20.0, "{last:?}");
        assert_eq!(one_by_one, by_slices);
    }
}

#[test]
fn stated_deviations_hold_for_pick_offs_that_are_corrected() {
    for (gain_ratio, pick_off_angle) in [(1.0, 0.3), (1.5, -0.2), (0.5, 0.0)] {
        let wave = Wave {
            angle: 0.4,
            ..random_wave(1, 5332.0, 0.3)
        };
        let flaws = Flaws {
            gain_ratio,
            pick_off_angle,
            noise: 0.004 * wave.main_amplitude,
            ..Flaws::default()
        };
        let settings = calibrated(&flaws, 10);
        let mut honesty = StatedRatio::default();
        for estimate in identify(wave, &flaws, settings, 500_000, 7) {
            honesty.add(&estimate, &wave);
        }
        let ratios = honesty.ratios();
        println!("gain {gain_ratio}, {pick_off_angle} rad: error over stated {ratios:.3?}");
        assert!(ratios.iter().all(|ratio| (0.94..1.06).contains(ratio)));
    }
}

#[test]
fn calibration_undoes_the_pick_offs() {
    for seed in 0..12 {
        let wave = Wave {
            angle_rate: 3.0,
            ..random_wave(seed, 5332.0, 0.3)
        };
        let a = wave.main_amplitude;
        let (gain_ratio, skew, pick_off_angle) = (1.07, 0.8e-6, -0.03);
        let flaws = Flaws {
            gain_ratio,
            skew,
            pick_off_angle,
            ..Flaws::default()
        };
        let calibration = calibrated(&flaws, 10).calibration;
        let raw = identify(wave, &flaws, windows(10), 4000, 0);
        let mut worst = 0f64;
        for estimate in &raw {
            worst = worst.max(errors(estimate, &wave)[1].abs() / a);
        }
        let settings = Settings {
            calibration,
            ..windows(10)
        };
        for estimate in identify(wave, &flaws, settings, 4000, 0) {
            assert!(estimate.flags.is_empty());
            let [main, quadrature, angle, frequency] = errors(&estimate, &wave);
            assert!(
                main.abs() < 2e-6 * a && quadrature.abs() < 2e-6 * a,
                "seed {seed}: {main:e} {quadrature:e}"
            );
            assert!(
                angle.abs() < 2e-6 && frequency.abs() < 2e-3,
                "seed {seed}: {angle:e} {frequency:e}"
            );
        }
        // Without calibration a microsecond of skew alone is a false quadrature of per cents, except at nodes and antinodes.
        if (4.0 * wave.angle).sin().abs() > 0.3 {
            assert!(worst > 1e-3, "seed {seed}: {worst:e}");
        }
    }
}

#[test]
fn the_mean_return_detector_starts_the_same_identification() {
    let wave = Wave::default();
    let settings = Settings {
        detection: Detection::MeanReturn,
        ..windows(10)
    };
    let estimates = identify(wave, &Flaws::white(0.01), settings, 3000, 6);
    assert!(estimates.len() > 10);
    assert!(
        estimates
            .iter()
            .all(|e| e.flags.is_empty() && (e.frequency - 5332.0).abs() < 1.0)
    );
}

#[test]
fn settings_that_cannot_work_are_refused() {
    let refused = |change: fn(&mut Settings)| {
        let mut settings = windows(10);
        change(&mut settings);
        Core::new(settings).err()
    };
    assert_eq!(refused(|_| ()), None);
    assert_eq!(
        refused(|s| s.sample_rate = 0.0),
        Some(SettingsError::SampleRate(0.0))
    );
    assert!(matches!(
        refused(|s| s.sample_rate = f64::NAN),
        Some(SettingsError::SampleRate(_))
    ));
    assert_eq!(
        refused(|s| s.periods = 1),
        Some(SettingsError::PeriodsTooFew(1))
    );
    let too_short = |periods, least| Some(SettingsError::HumPeriods { periods, least });
    assert_eq!(refused(|s| (s.periods, s.hum) = (4, true)), too_short(4, 5));
    assert_eq!(
        refused(|s| (s.periods, s.hop, s.hum) = (9, Some(1), true)),
        too_short(9, 10)
    );
    assert_eq!(refused(|s| (s.periods, s.hum) = (5, true)), None);
    assert_eq!(
        refused(|s| (s.periods, s.hop, s.hum) = (10, Some(1), true)),
        None
    );
    assert_eq!(refused(|s| (s.periods, s.coloured) = (2, true)), None);
    assert_eq!(
        refused(|s| s.periods = 255),
        Some(SettingsError::PeriodsTooMany {
            periods: 255,
            most: 254
        })
    );
    assert_eq!(refused(|s| s.hop = Some(0)), Some(SettingsError::Hop));
    assert_eq!(
        refused(|s| s.start_angle = 1e9),
        Some(SettingsError::StartAngle(1e9))
    );
    assert_eq!(
        refused(|s| s.rails = Some([1.0, -1.0])),
        Some(SettingsError::Rails([1.0, -1.0]))
    );
    assert_eq!(
        refused(|s| s.resolution = Some(0.0)),
        Some(SettingsError::Resolution(0.0))
    );
    assert_eq!(
        refused(|s| s.calibration.gain_ratio = 0.0),
        Some(SettingsError::GainRatio(0.0))
    );
    assert_eq!(
        refused(|s| s.calibration.skew = 1.0),
        Some(SettingsError::Skew(1.0))
    );
    assert_eq!(
        refused(|s| s.calibration.pick_off_angle = 1.0),
        Some(SettingsError::PickOffAngle(1.0))
    );
    let error = Tracker::<16>::new(windows(20)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "20 periods a window: the ring of blocks holds at most 14"
    );
    // The rate is checked before the settings that depend on it, and nothing is changed.
    let wrong = Settings {
        sample_rate: 0.0,
        frequency: Some(5332.0),
        ..windows(10)
    };
    let mut core = Core::new(windows(10)).unwrap();
    let error = Some(SettingsError::SampleRate(0.0));
    assert_eq!(Core::new(wrong).err(), error);
    assert_eq!(core.configure(wrong).err(), error);
    assert_eq!(core.change(wrong).err(), error);
    assert_eq!(*core.settings(), windows(10));
}

#[test]
fn a_nearly_circular_pattern_states_its_frequencys_deviation_rightly() {
    for (share, turning) in [
        (0.9999, 0.0),
        (0.998, 0.0),
        (0.997, 1.0),
        (0.996, 0.0),
        (0.996, 1.0),
        (0.98, 1.0),
    ] {
        let wave = Wave {
            quadrature_amplitude: 0.5 * share,
            main_amplitude: 0.5,
            angle_rate: turning,
            ..Wave::default()
        };
        let flaws = Flaws::white(0.002);
        let (mut squares, mut rows) = (0.0, 0.0);
        let found = identify(wave, &flaws, windows(10), 600_000, 1);
        assert!(found.len() > 3000, "{share}: {} windows", found.len());
        for estimate in found {
            assert!(estimate.frequency_std > 0.0, "{share}: {estimate:?}");
            // A circle does not show whether it turns: its frequency is computed as that of a pattern at rest.
            if Flags::REACQUIRED.contains(estimate.flags) || turning == 0.0 {
                let error = estimate.frequency - wave.frequency;
                squares += (error / f64::from(estimate.frequency_std)).powi(2);
                rows += 1.0;
            }
        }
        let ratio = f64::sqrt(squares / rows);
        println!(
            "a_B of {share} a_A at {turning} rad/s: {rows} rows, error over stated {ratio:.2}"
        );
        assert!(
            (0.9..1.15).contains(&ratio) || rows < 30.0,
            "{share}: {ratio}"
        );
    }
}

//! What users lean on: the same results however a stream is cut, calibration, continuity of the angle, gaps, overlap, settings.

use antinode::{Calibration, Detection, Estimate, Front, Settings, SettingsError, Tracker};
use antinode_sim::{Flaws, Gyro, Wave, random_wave};
use host_tests::score::{errors, stated};
use host_tests::{Core, RATE, angle_error, identify, windows};
use proptest::prelude::*;

fn stream(wave: Wave, flaws: Flaws, samples: usize, seed: u64) -> Vec<[f32; 2]> {
    let gyro = Gyro::new(wave, flaws, RATE, seed).unwrap();
    gyro.take(samples)
        .map(|pair| [pair.c as f32, pair.d as f32])
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn results_do_not_depend_on_how_the_stream_is_cut(seed in 0u64..1000, cuts in prop::collection::vec(1usize..700, 1..40)) {
        let wave = random_wave(seed, 5332.0, 0.5);
        let pairs = stream(wave, Flaws { noise: 0.01, ..Flaws::default() }, 6000, seed);
        let mut single = Core::new(windows(5)).unwrap();
        let one_by_one: Vec<Estimate> = pairs.iter().filter_map(|&pair| single.push(pair)).collect();
        let mut sliced = Core::new(windows(5)).unwrap();
        let mut by_slices = Vec::new();
        let mut rest = pairs.as_slice();
        for cut in cuts.iter().cycle() {
            if rest.is_empty() {
                break;
            }
            let (slice, after) = rest.split_at((*cut).min(rest.len()));
            sliced.extend(slice, |estimate| by_slices.push(estimate));
            rest = after;
        }
        prop_assert!(one_by_one.len() > 40);
        prop_assert_eq!(one_by_one, by_slices);
    }

    #[test]
    fn no_input_panics_or_hangs(samples in prop::collection::vec((any::<f32>(), any::<f32>()), 0..3000), periods in 2u16..30, hop in 1u16..40) {
        let settings = Settings { hop: Some(hop), rails: Some([-1.0, 1.0]), resolution: Some(1e-3), ..windows(periods) };
        let mut core = Core::new(settings).unwrap();
        for (c, d) in samples {
            core.push([c, d]);
        }
    }
}

#[test]
fn stated_deviations_hold_for_pick_offs_that_are_corrected() {
    for (gain_ratio, pick_off_error) in [(1.0, 0.3), (1.5, -0.2), (0.5, 0.0)] {
        let wave = Wave {
            angle: 0.4,
            ..random_wave(1, 5332.0, 0.3)
        };
        let flaws = Flaws {
            gain_ratio,
            pick_off_error,
            noise: 0.004 * wave.main_amplitude,
            ..Flaws::default()
        };
        let settings = Settings {
            calibration: Calibration {
                gain_ratio: gain_ratio as f32,
                pick_off_angle: pick_off_error as f32,
                ..Calibration::IDEAL
            },
            ..windows(10)
        };
        let (mut squares, mut rows) = ([0.0; 4], 0.0);
        for estimate in identify(wave, &flaws, settings, 500_000, 7) {
            let found = errors(&estimate, &wave).into_iter().zip(stated(&estimate));
            for (square, (error, deviation)) in squares.iter_mut().zip(found) {
                *square += (error / deviation).powi(2);
            }
            rows += 1.0;
        }
        let ratios = squares.map(|square| f64::sqrt(square / rows));
        println!("gain {gain_ratio}, {pick_off_error} rad: error over stated {ratios:.3?}");
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
        let (gain_ratio, skew, pick_off_error) = (1.07, 0.8e-6, -0.03);
        let flaws = Flaws {
            gain_ratio,
            skew,
            pick_off_error,
            ..Flaws::default()
        };
        let calibration = Calibration {
            gain_ratio: gain_ratio as f32,
            skew: skew as f32,
            pick_off_angle: pick_off_error as f32,
        };
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
        // Without it a microsecond of skew alone is a false quadrature of percents, but for nodes and antinodes.
        if (4.0 * wave.angle).sin().abs() > 0.3 {
            assert!(worst > 1e-3, "seed {seed}: {worst:e}");
        }
    }
}

#[test]
fn the_angle_runs_on_over_many_turns() {
    for rate in [5.0, -5.0] {
        let wave = Wave {
            angle_rate: rate,
            ..Wave::default()
        };
        let flaws = Flaws {
            noise: 0.02,
            ..Flaws::default()
        };
        let estimates = identify(wave, &flaws, windows(10), 300_000, 4);
        let offset = ((estimates[0].angle - wave.at(estimates[0].time).angle)
            / std::f64::consts::FRAC_PI_2)
            .round();
        for estimate in &estimates {
            let truth = wave.at(estimate.time);
            let expected = truth.angle + offset * std::f64::consts::FRAC_PI_2;
            assert!(
                (estimate.angle - expected).abs() < 0.02,
                "{} {expected}",
                estimate.angle
            );
            assert!((f64::from(estimate.quadrature_amplitude) - 0.1).abs() < 0.02);
            // α goes with the angle's choice: an odd number of quarter turns adds π.
            let shift = if offset.rem_euclid(2.0) == 1.0 {
                std::f64::consts::PI
            } else {
                0.0
            };
            let error =
                (f64::from(estimate.phase) - truth.phase - shift).rem_euclid(std::f64::consts::TAU);
            assert!(error.min(std::f64::consts::TAU - error) < 0.02, "{error}");
        }
        assert!((estimates.last().unwrap().angle - estimates[0].angle).abs() > 14.0);
    }
}

#[test]
fn the_angle_starts_where_it_is_told() {
    let wave = Wave {
        angle: 0.3,
        ..Wave::default()
    };
    for start in [-3.0f32, 0.0, 0.3, 2.0, 9.0] {
        let settings = Settings {
            start_angle: start,
            ..windows(10)
        };
        let estimates = identify(wave, &Flaws::default(), settings, 1000, 0);
        let found = estimates[0].angle;
        assert!(
            (found - f64::from(start)).abs() <= std::f64::consts::FRAC_PI_4 + 1e-5,
            "{start}: {found}"
        );
        assert!(angle_error(found, 0.3).abs() < 1e-5);
    }
}

#[test]
fn windows_may_overlap_or_leave_gaps() {
    let wave = Wave {
        angle_rate: 1.0,
        decay_rate: 2.0,
        ..Wave::default()
    };
    let flaws = Flaws {
        noise: 0.01,
        ..Flaws::default()
    };
    for hop in [1, 3, 10, 25] {
        let settings = Settings {
            hop: Some(hop),
            ..windows(10)
        };
        let (mut squares, mut count) = ([0f64; 4], 0.0);
        for seed in 0..4 {
            let estimates = identify(wave, &flaws, settings, 100_000, seed);
            for pair in estimates.windows(2) {
                assert_eq!(pair[1].start - pair[0].start, u64::from(hop) * 19);
            }
            for estimate in &estimates {
                assert!(estimate.flags.is_empty(), "hop {hop}: {}", estimate.flags);
                let stds = stated(estimate);
                for (i, error) in errors(estimate, &wave).into_iter().enumerate() {
                    squares[i] += (error / stds[i]).powi(2);
                }
                count += 1.0;
            }
        }
        for square in squares {
            let ratio = (square / count).sqrt();
            assert!((0.85..1.15).contains(&ratio), "hop {hop}: {ratio}");
        }
    }
}

#[test]
fn a_gap_that_is_told_costs_nothing_but_its_window() {
    let wave = Wave {
        angle_rate: 0.5,
        ..Wave::default()
    };
    let pairs = stream(
        wave,
        Flaws {
            noise: 0.01,
            ..Flaws::default()
        },
        40_000,
        5,
    );
    let mut core = Core::new(windows(10)).unwrap();
    let mut estimates = Vec::new();
    core.extend(&pairs[..20_100], |e| estimates.push(e));
    core.skip(900);
    core.extend(&pairs[21_000..], |e| estimates.push(e));
    assert_eq!(core.index(), 40_000);
    for estimate in &estimates {
        assert!(
            estimate.flags.is_empty(),
            "{} at {}",
            estimate.flags,
            estimate.time
        );
        for (error, limit) in errors(estimate, &wave)
            .into_iter()
            .zip([0.01, 0.01, 0.005, 1.5])
        {
            assert!(error.abs() < limit, "{error} at {}", estimate.time);
        }
    }
    assert!(
        estimates
            .iter()
            .any(|e| e.start >= 21_000 && e.start < 21_020)
    );
}

#[test]
fn the_mean_return_detector_starts_the_same_identification() {
    let wave = Wave::default();
    let settings = Settings {
        detection: Detection::MeanReturn,
        ..windows(10)
    };
    let estimates = identify(
        wave,
        &Flaws {
            noise: 0.01,
            ..Flaws::default()
        },
        settings,
        3000,
        6,
    );
    assert!(estimates.len() > 10);
    assert!(
        estimates
            .iter()
            .all(|e| e.flags.is_empty() && (e.frequency - 5332.0).abs() < 1.0)
    );
}

#[test]
fn a_slow_drift_is_followed_for_minutes() {
    // 2 Hz/s for 20 s: 40 Hz from where the blocks' reference was set.
    let wave = Wave {
        frequency_rate: 2.0,
        ..Wave::default()
    };
    let flaws = Flaws {
        noise: 0.01,
        ..Flaws::default()
    };
    let estimates = identify(wave, &flaws, windows(10), 2_000_000, 8);
    let last = estimates.last().unwrap();
    assert!(last.frequency > 5371.0);
    assert!(estimates.iter().all(|e| e.flags.is_empty()));
    let tail = &estimates[estimates.len() - 2000..];
    let square: f64 = tail
        .iter()
        .map(|e| (errors(e, &wave)[3] / f64::from(e.frequency_std)).powi(2))
        .sum();
    let ratio = (square / 2000.0).sqrt();
    assert!((0.9..1.1).contains(&ratio), "{ratio}");
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
}

#[test]
fn the_angle_runs_on_over_gaps_in_which_it_turns_far() {
    // A window every 0.19 s: the pattern turns by 0.95 rad meanwhile, more than the ambiguity allows without its rate.
    let wave = Wave {
        angle_rate: 5.0,
        ..Wave::default()
    };
    let settings = Settings {
        hop: Some(1000),
        ..windows(10)
    };
    let flaws = Flaws {
        noise: 0.002,
        ..Flaws::default()
    };
    let estimates = identify(wave, &flaws, settings, 300_000, 3);
    assert!(estimates.len() > 12);
    for pair in estimates.windows(2) {
        let turned = pair[1].angle - pair[0].angle;
        let expected = 5.0 * (pair[1].time - pair[0].time);
        assert!((turned - expected).abs() < 0.01, "{turned} {expected}");
    }
}

#[test]
fn other_settings_in_place_do_what_a_new_start_does() {
    let wave = random_wave(7, 5332.0, 0.4);
    let flaws = Flaws {
        noise: 0.01,
        ..Flaws::default()
    };
    let pairs = stream(wave, flaws, 8000, 7);
    let run = |front: &mut Front<f32, 200>, tracker: &mut Tracker<40>| {
        let mut rest = pairs.as_slice();
        let mut found = Vec::new();
        while !rest.is_empty() {
            let (taken, block) = front.push_slice(rest);
            rest = &rest[taken..];
            let estimate = block.and_then(|block| tracker.push(block));
            found.extend(estimate.map(|e| (e.main_amplitude, e.angle, e.frequency, e.flags)));
        }
        found
    };
    let second = Settings {
        hop: Some(3),
        watch: false,
        detection: Detection::MeanReturn,
        start_angle: 3.0,
        ..windows(12)
    };
    let (mut front, mut tracker) = (
        Front::new(windows(5)).unwrap(),
        Tracker::new(windows(5)).unwrap(),
    );
    let first = run(&mut front, &mut tracker);
    assert!(front.configure(windows(1)).is_err() && tracker.configure(windows(1)).is_err());
    front.configure(second).unwrap();
    tracker.configure(second).unwrap();
    let changed = run(&mut front, &mut tracker);
    assert_eq!(front.index(), 16_000);
    let (mut front, mut tracker) = (Front::new(second).unwrap(), Tracker::new(second).unwrap());
    assert_eq!(run(&mut front, &mut tracker), changed);
    assert!(first.len() > 60 && changed.len() > 100);
}

#[test]
fn a_long_gap_leaves_no_angle_that_is_wrong_and_clean() {
    // Lost pairs, and whether every first window after them must be one that knows its angle modulo π/2 only.
    for (lost, unknown) in [
        (1000u64, Some(false)),
        (200_000, None),
        (2_000_000, Some(true)),
    ] {
        for seed in 0..20 {
            let wave = Wave {
                angle_rate: 0.0,
                ..random_wave(seed, 5332.0, 0.2)
            };
            let flaws = Flaws {
                noise: 0.005 * wave.main_amplitude,
                ..Flaws::default()
            };
            let mut gyro = Gyro::new(wave, flaws, RATE, seed).unwrap();
            let mut core = Core::new(windows(10)).unwrap();
            let push = |gyro: &mut Gyro, core: &mut Core, count| -> Vec<Estimate> {
                let pairs = gyro.by_ref().take(count);
                pairs
                    .filter_map(|pair| core.push([pair.c as f32, pair.d as f32]))
                    .collect()
            };
            let before = push(&mut gyro, &mut core, 5000);
            let angle = before.last().unwrap().angle;
            gyro.nth(lost as usize - 1);
            core.skip(lost);
            let after = push(&mut gyro, &mut core, 3000);
            let is_unknown = after[0].flags.contains(antinode::Flags::REACQUIRED);
            if let Some(unknown) = unknown {
                assert_eq!(
                    is_unknown, unknown,
                    "{lost} lost, seed {seed}: {:?}",
                    after[0]
                );
            }
            let apart = |estimate: &Estimate| (estimate.angle - angle).abs() > 0.5;
            assert!(
                is_unknown || !after.iter().any(apart),
                "{lost} lost, seed {seed}: {angle} {:?}",
                after[0]
            );
            assert!(after[1..].iter().all(|estimate| estimate.flags.is_empty()));
        }
    }
}

#[test]
fn a_nearly_circular_pattern_has_an_honest_frequency() {
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
        let flaws = Flaws {
            noise: 0.002,
            ..Flaws::default()
        };
        let (mut squares, mut rows) = (0.0, 0.0);
        for estimate in identify(wave, &flaws, windows(10), 600_000, 1) {
            assert!(estimate.frequency_std > 0.0, "{share}: {estimate:?}");
            // A circle does not show whether it turns: its frequency is that of a pattern that stands still.
            if estimate.flags.is_empty() || turning == 0.0 {
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

#[test]
fn windows_far_apart_state_their_frequency_as_well() {
    for hop in [20u16, 1000] {
        let wave = Wave {
            angle: 0.3,
            quadrature_amplitude: 0.5,
            angle_rate: 0.02,
            ..Wave::default()
        };
        let flaws = Flaws {
            noise: 1e-4,
            ..Flaws::default()
        };
        let settings = Settings {
            hop: Some(hop),
            ..windows(10)
        };
        let (mut squares, mut sum, mut rows) = (0.0, 0.0, 0.0);
        for seed in 0..10 {
            let estimates = identify(wave, &flaws, settings, 40 * 19 * usize::from(hop), seed);
            for estimate in &estimates[7..] {
                let error = errors(estimate, &wave)[3] / stated(estimate)[3];
                squares += error * error;
                sum += error;
                rows += 1.0;
            }
        }
        let (scatter, bias) = (f64::sqrt(squares / rows), sum / rows);
        println!("hop {hop}: {rows} rows, error over stated {scatter:.2}, bias {bias:.2}");
        assert!(
            (0.85..1.15).contains(&scatter) && bias.abs() < 0.25,
            "{hop}: {scatter} {bias}"
        );
    }
}

#[test]
fn no_pairs_lost_is_no_loss() {
    let pairs = stream(Wave::default(), Flaws::default(), 6000, 1);
    let mut plain = Core::new(windows(5)).unwrap();
    let wanted: Vec<_> = pairs.iter().filter_map(|&pair| plain.push(pair)).collect();
    let mut told = Core::new(windows(5)).unwrap();
    let found: Vec<_> = pairs
        .iter()
        .filter_map(|&pair| {
            told.skip(0);
            told.push(pair)
        })
        .collect();
    assert!(wanted.len() > 40);
    assert_eq!(found, wanted);
}

//! Continuity from window to window: the angle over turns and overlap, and waves tracked for minutes.

use antinode::{Flags, Settings, SettingsError, Tracker};
use antinode_sim::{Flaws, Wave};
use host_tests::score::{errors, stated};
use host_tests::{
    Core, RATE, angle_error, identify, identify_changed, identify_signal, stream, windows,
};

#[test]
fn the_angle_is_continued_over_many_turns() {
    for rate in [5.0, -5.0] {
        let wave = Wave {
            angle_rate: rate,
            ..Wave::default()
        };
        let flaws = Flaws::white(0.02);
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
            // α depends on the choice of the angle: an odd number of quarter turns adds π.
            let shift = if offset.rem_euclid(2.0) == 1.0 {
                std::f64::consts::PI
            } else {
                0.0
            };
            let error =
                (f64::from(estimate.phase) - truth.phase - shift).rem_euclid(std::f64::consts::TAU);
            assert!(error.min(std::f64::consts::TAU - error) < 0.02, "{error}");
            let half = std::f32::consts::PI;
            assert!(-half < estimate.phase && estimate.phase <= half);
        }
        assert!((estimates.last().unwrap().angle - estimates[0].angle).abs() > 14.0);
    }
}

#[test]
fn the_angle_starts_near_the_start_angle() {
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
fn a_change_of_settings_leaves_the_start_angle() {
    let old = Settings {
        start_angle: 3.0,
        ..windows(10)
    };
    let mut tracker = Tracker::<16>::new(old).unwrap();
    let new = Settings {
        start_angle: 9.0,
        ..windows(5)
    };
    tracker.change(new).unwrap();
    let found = tracker.settings();
    assert_eq!((found.start_angle, found.periods), (3.0, 5));
}

#[test]
fn a_slow_drift_is_tracked_for_minutes() {
    // 2 Hz/s for 20 s: 40 Hz from the blocks' reference.
    let wave = Wave {
        frequency_rate: 2.0,
        ..Wave::default()
    };
    let flaws = Flaws::white(0.01);
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
fn windows_may_overlap_or_leave_gaps() {
    let wave = Wave {
        angle_rate: 1.0,
        decay_rate: 2.0,
        ..Wave::default()
    };
    let flaws = Flaws::white(0.01);
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
fn the_angle_does_not_slip_at_the_end_of_a_ring_down() {
    // Noise of 1.1 a_A: a window knows the angle to 0.06 rad, but the rate only to 0.2 rad a window.
    for seed in 0..10 {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 0.05,
            angle: 0.3,
            ..Wave::default()
        };
        let flaws = Flaws::white(1.1);
        let settings = Settings {
            start_angle: 0.3,
            ..windows(10)
        };
        // The wave is found while it is large; after 13 s nothing of that is left.
        let found = identify_changed(wave, &flaws, settings, 3_000_000, seed, |k, [c, d]| {
            if k > 1_300_000 {
                return [c, d];
            }
            let more = 5.0 * (-(k as f64) / 30_000.0).exp();
            let clean = wave.pick_offs(k as f64 / RATE);
            [c + more * clean[0], d + more * clean[1]]
        });
        let slips = found.iter().filter(|e| (e.angle - 0.3).abs() > 0.8);
        let (rows, slipped) = (found.len(), slips.count());
        println!("seed {seed}: {rows} windows, {slipped} off by a quarter turn");
        assert!(rows > 3_000 && slipped == 0);
    }
}

#[test]
fn a_search_or_a_change_of_settings_continues_the_angle() {
    let wave = Wave {
        angle_rate: 20.0,
        ..Wave::default()
    };
    let flaws = Flaws::white(0.01);
    let pairs = stream(wave, flaws, 60_000, 2);
    let mut core = Core::new(windows(10)).unwrap();
    let refused = core.change(windows(1));
    assert_eq!(refused, Err(SettingsError::PeriodsTooFew(1)));
    let mut found = Vec::new();
    for (part, half_buffer) in pairs.chunks(20_000).enumerate() {
        match part {
            1 => core.search(),
            2 => core.change(windows(20)).unwrap(),
            _ => {}
        }
        // A search may find that the wave has gone.
        assert!(!core.has_wave() && core.is_searching(), "part {part}");
        core.extend(half_buffer, |estimate| found.push((part, estimate)));
        assert!(core.has_wave() && !core.is_searching());
    }
    // Measured from the angle of the first window.
    let start = found[0].1.angle - wave.at(found[0].1.time).angle;
    for (part, estimate) in &found {
        assert_eq!(estimate.samples, if *part < 2 { 190 } else { 380 });
        let off = estimate.angle - wave.at(estimate.time).angle - start;
        assert!(off.abs() < 0.02, "part {part}: {off} in {estimate:?}");
    }
    let first = found
        .chunk_by(|(a, _), (b, _)| a == b)
        .map(|part| part[0].1.flags);
    assert!(first.eq([Flags::empty(), Flags::REACQUIRED, Flags::REACQUIRED]));
    let told = found
        .iter()
        .filter(|(_, estimate)| !estimate.flags.is_empty());
    assert_eq!(told.count(), 2);
}

#[test]
fn the_angle_is_tracked_through_misfits_while_the_rate_changes() {
    let mut reacquired = 0;
    for (seed, (before, after, seconds)) in [
        (4.0, -4.0, 0.4),
        (4.0, 0.0, 0.4),
        (0.0, 4.0, 0.6),
        (10.0, -10.0, 0.15),
        (1.0, -1.0, 1.5),
        (4.0, 4.0, 0.4),
    ]
    .into_iter()
    .enumerate()
    {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 0.1,
            ..Wave::default()
        };
        let (from, middle, to) = (0.3, 0.3 + 0.5 * seconds, 0.3 + seconds);
        let angle = |t: f64| 0.7 + before * t.min(middle) + after * (t - middle).max(0.0);
        let count = ((to + 0.3) * RATE) as usize;
        let found = identify_signal(1e-3, windows(10), count, seed as u64, |t| {
            let turned = Wave {
                angle: angle(t),
                ..wave
            };
            let hum = if (from..to).contains(&t) {
                0.1 * (314.0 * t).sin()
            } else {
                0.0
            };
            let [c, d] = turned.pick_offs(t);
            [c + hum, d + hum]
        });
        let clean: Vec<_> = found.iter().filter(|e| e.flags.is_empty()).collect();
        let misfits = found.iter().filter(|e| e.flags.contains(Flags::MISFIT));
        assert!(clean.len() > 250 && misfits.count() > 70);
        for estimate in clean {
            let off = estimate.angle - angle(estimate.time);
            assert!(off.abs() < 0.01, "{before} to {after} rad/s: {estimate:?}");
        }
        let is_told = found.iter().any(|e| e.flags == Flags::REACQUIRED);
        // With a constant rate the prediction is right.
        assert!(before != after || !is_told);
        reacquired += u32::from(is_told);
    }
    assert!(reacquired >= 4, "{reacquired}");
}

#[test]
fn an_angle_that_was_tracked_to_another_quarter_than_predicted_is_reacquired() {
    // The pattern turns, stands still in hum, and turns on: by its rate it would be a quarter turn ahead.
    let (from, to, rate) = (0.1, 0.5, 4.0);
    let still = |t: f64| (t - from).clamp(0.0, to - from);
    let settings = windows(10);
    let found = identify_signal(1e-4, settings, 70_000, 1, |t| {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 0.1,
            angle: 0.1 + rate * (t - still(t)),
            ..Wave::default()
        };
        let [c, d] = wave.pick_offs(t);
        let hum = if (from..to).contains(&t) {
            0.1 * (314.0 * t).sin()
        } else {
            0.0
        };
        [c + hum, d + hum]
    });
    let first = found
        .iter()
        .find(|e| e.start as f64 >= to * RATE && !e.flags.contains(Flags::MISFIT))
        .unwrap();
    let turned = rate * (first.time - (to - from));
    assert_eq!(first.flags, Flags::REACQUIRED);
    assert!((first.angle - found[0].angle - turned).abs() < 0.05);
    assert!(found.iter().rev().take(20).all(|e| e.flags.is_empty()));
}

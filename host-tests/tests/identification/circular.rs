//! Patterns near a circle: when they are flagged, and how the angle continues after them.

use antinode::{Calibration, Estimate, Flags, Settings};
use antinode_sim::{Flaws, Wave};
use host_tests::{Core, RATE, calibrated, identify, identify_changed, identify_signal, windows};

#[test]
fn a_pattern_is_circular_where_noise_or_rounding_hides_its_angle() {
    // Cases of |a_B|/a_A and noise.
    for (share, noise, is_circular) in [
        (0.98, 0.05, true),
        (-0.98, 0.05, true),
        (0.98, 0.001, false),
        (-0.98, 0.001, false),
        (0.9985, 0.0, true),
        (-0.9985, 0.0, true),
        (0.99, 0.0, false),
    ] {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: share,
            ..Wave::default()
        };
        let flaws = Flaws::white(noise);
        let found = identify(wave, &flaws, windows(10), 40_000, 2);
        assert!(found.len() > 200);
        let wanted = Flags::empty();
        let wanted = if is_circular { Flags::CIRCULAR } else { wanted };
        for estimate in &found {
            assert_eq!(
                estimate.flags, wanted,
                "{share}, noise {noise}: {estimate:?}"
            );
        }
    }
}

#[test]
fn noise_that_hides_the_lesser_wave_is_no_misfit() {
    // Cases of a_B, noise, periods, gain of D and misfits at most. What noise makes of the lesser wave's course must not keep the fit from
    // settling; in noise of 20 % and windows of 22 pairs, a_A may seem to change by itself.
    for (share, noise, periods, gain_ratio, most) in [
        (0.92, 0.1, 2, 1.0, 0),
        (0.92, 0.15, 2, 1.0, 0),
        (0.5, 0.2, 2, 1.0, 2),
        (-0.7, 0.2, 3, 1.0, 0),
        (0.92, 0.1, 5, 1.0, 0),
        (-0.92, 0.2, 10, 1.0, 0),
        (0.88, 0.06, 3, 0.35, 0),
    ] {
        let flaws = Flaws {
            gain_ratio,
            ..Flaws::white(noise)
        };
        let settings = calibrated(&flaws, periods);
        let mut misfits = 0;
        for seed in 0..8 {
            let wave = Wave {
                main_amplitude: 1.0,
                quadrature_amplitude: share,
                frequency: 9000.0,
                angle: 0.4 * seed as f64,
                ..Wave::default()
            };
            let found = identify(wave, &flaws, settings, 100_000, seed);
            let circular = found.iter().filter(|e| e.flags.contains(Flags::CIRCULAR));
            assert!(circular.count() > found.len() / 3);
            let is_misfit = |e: &&Estimate| e.flags.contains(Flags::MISFIT);
            misfits += found.iter().filter(is_misfit).count();
            // The wave is never given up.
            let samples = found.iter().map(|e| e.samples).sum::<u32>();
            assert!(samples > 99_000, "{share}, {noise}: {samples}");
            let frequency = found.iter().map(|e| e.frequency).sum::<f64>() / found.len() as f64;
            assert!(
                (frequency - 9000.0).abs() < 20.0,
                "{share}, {noise}: {frequency}"
            );
        }
        println!("{share}, noise {noise}, {periods} periods: {misfits} misfits");
        assert!(misfits <= most, "{share}, {noise}: {misfits} misfits");
    }
}

#[test]
fn the_angle_is_continued_over_a_circular_stretch() {
    for seed in 0..5 {
        for side in [1.0, -1.0] {
            let wave = Wave {
                main_amplitude: 1.0,
                quadrature_amplitude: 0.0,
                angle: 0.3 * seed as f64,
                ..Wave::default()
            };
            let flaws = Flaws::white(0.002);
            let settings = Settings {
                start_angle: 5.0,
                ..windows(10)
            };
            // The quadrature grows until it equals the main amplitude, stays, and shrinks again.
            let full = Wave {
                quadrature_amplitude: side,
                ..wave
            };
            let found = identify_changed(wave, &flaws, settings, 200_000, seed, |k, [c, d]| {
                let time = k as f64 / RATE;
                let share = (2.0 - (2.0 * time - 2.0).abs() * 2.0).clamp(0.0, 1.0);
                let (one, none) = (full.pick_offs(time), wave.pick_offs(time));
                [
                    c + share * (one[0] - none[0]),
                    d + share * (one[1] - none[1]),
                ]
            });
            let circular = found.iter().filter(|e| e.flags == Flags::CIRCULAR).count();
            assert!(circular > 200, "{circular}");
            // Whether the pattern turned meanwhile is unknown.
            let seen = Flags::CIRCULAR.with(Flags::REACQUIRED);
            let again = found.iter().filter(|e| e.flags == Flags::REACQUIRED);
            assert!((1..5).contains(&again.count()));
            for estimate in &found {
                assert!(
                    seen.contains(estimate.flags) && estimate.flags != seen,
                    "seed {seed}, side {side}: {} at {} s",
                    estimate.flags,
                    estimate.time
                );
                let error = estimate.frequency - wave.frequency;
                assert!(error.abs() < 7.0 * f64::from(estimate.frequency_std));
            }
            let (first, last) = (&found[0], &found[found.len() - 1]);
            assert!(last.flags.is_empty() && (last.angle - first.angle).abs() < 0.01);
        }
    }
}

#[test]
fn passing_a_circle_is_neither_a_step_nor_a_jump() {
    let mut circular = 0;
    for seed in 0..20 {
        for noise in [1e-5, 2e-4] {
            let wave = Wave {
                main_amplitude: 1.0,
                quadrature_amplitude: 0.0,
                angle: 0.3 * seed as f64,
                angle_rate: 0.1 * seed as f64,
                ..Wave::default()
            };
            let full = Wave {
                quadrature_amplitude: 1.0,
                ..wave
            };
            let flaws = Flaws::white(noise);
            // The quadrature outgrows the main wave and comes back: beyond the circle the angle is another one.
            let found = identify_changed(wave, &flaws, windows(10), 70_000, seed, |k, [c, d]| {
                let time = k as f64 / RATE;
                let share = 0.8 + 0.4 * (5.0 * time).sin();
                let (one, none) = (full.pick_offs(time), wave.pick_offs(time));
                [
                    c + share * (one[0] - none[0]),
                    d + share * (one[1] - none[1]),
                ]
            });
            for estimate in &found {
                assert!(
                    Flags::CIRCULAR.contains(estimate.flags),
                    "seed {seed}, noise {noise}: {} at {} s",
                    estimate.flags,
                    estimate.time
                );
                circular += usize::from(!estimate.flags.is_empty());
            }
        }
    }
    assert!(circular > 40, "{circular}");
}

#[test]
fn the_first_angle_after_a_circle_that_began_without_an_angle_is_reacquired() {
    let wave = Wave {
        main_amplitude: 1.0,
        quadrature_amplitude: 0.04,
        angle_rate: 5.0,
        ..Wave::default()
    };
    let full = Wave {
        quadrature_amplitude: 1.0,
        ..wave
    };
    let flaws = Flaws::white(0.002);
    // Circular from the start, or searched anew or calibrated while circular; with or without a gap before the circle ends.
    for before in ["nothing", "a search", "a calibration"] {
        for gap in [0, 50_000, 100_000] {
            let mut core = Core::new(windows(10)).unwrap();
            let mut found = Vec::new();
            for k in 0..40_000 {
                let is_circular = (if before == "nothing" { 0 } else { 5000 }..25_000).contains(&k);
                match (k, before) {
                    (10_000, "a search") => core.search(),
                    (10_000, "a calibration") => core.calibrate(Calibration::IDEAL).unwrap(),
                    (25_000, _) => core.skip(gap),
                    _ => {}
                }
                let at = if k < 25_000 { k } else { k + gap };
                let time = at as f64 / RATE;
                let [c, d] = (if is_circular { full } else { wave }).pick_offs(time);
                let noise =
                    flaws.noise * f64::from((k as u32).wrapping_mul(0x9e37_79b9)) / 2f64.powi(31);
                found.extend(core.push([(c + noise) as f32, (d - noise) as f32]));
            }
            let circles = found
                .iter()
                .rposition(|e| e.flags.contains(Flags::CIRCULAR))
                .unwrap();
            // A window in which the circle ends is a misfit; one right after it may have the step.
            let is_misfit = |e: &&antinode::Estimate| e.flags.contains(Flags::MISFIT);
            let mut after = found[circles + 1..].iter().skip_while(is_misfit);
            let first = after.next().unwrap().flags;
            let label = format!("{before}, a gap of {gap}");
            assert_eq!(first.without(Flags::STEP), Flags::REACQUIRED, "{label}");
            assert!(after.all(|e| e.flags.is_empty()), "{label}");
        }
    }
}

#[test]
fn an_exact_circle_has_a_frequency() {
    let settings = Settings {
        frequency: Some(25_000.0),
        ..windows(10)
    };
    // One of the two travelling waves is zero to the last digit.
    let circle = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let mut core = Core::new(settings).unwrap();
    let found = (0..4000).filter_map(|k| core.push(circle[k % 4]));
    let found: Vec<_> = found.collect();
    assert!(found.len() > 90);
    for estimate in found {
        assert_eq!(estimate.flags, Flags::CIRCULAR);
        let error = (estimate.frequency - 25_000.0).abs();
        assert!(error < 5e-3, "{error} Hz");
        assert!((1e-5..1e-3).contains(&estimate.frequency_std));
    }
}

#[test]
fn a_misfit_after_a_circle_does_not_change_the_angle_with_which_the_wave_starts() {
    for (start_angle, wanted) in [(core::f32::consts::FRAC_PI_4, 0.9), (100.0, 99.860)] {
        let circle = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 1.0,
            angle: 0.9,
            ..Wave::default()
        };
        let flat = Wave {
            quadrature_amplitude: 0.2,
            ..circle
        };
        let settings = Settings {
            start_angle,
            frequency: Some(5332.0),
            ..windows(10)
        };
        let found = identify_signal(1e-3, settings, 4000, 1, |t| {
            let wave = if t < 900.0 / RATE { circle } else { flat };
            wave.pick_offs(t)
        });
        assert!(found[..4].iter().all(|e| e.flags.contains(Flags::CIRCULAR)));
        let last = found.last().unwrap();
        assert!(
            last.flags.is_empty() && (last.angle - wanted).abs() < 0.01,
            "{last:?}"
        );
    }
}

#[test]
fn the_first_angle_after_a_single_circular_window_is_reacquired() {
    let full = Wave {
        main_amplitude: 1.0,
        quadrature_amplitude: 1.0,
        ..Wave::default()
    };
    let settings = Settings {
        frequency: Some(full.frequency as f32),
        ..windows(10)
    };
    let circle = identify_signal(0.002, settings, 2000, 1, |t| full.pick_offs(t));
    let end = circle[1].start;
    let wave = Wave {
        quadrature_amplitude: 0.04,
        ..full
    };
    let found = identify_signal(0.002, settings, 4000, 1, |t| {
        let wave = if t < end as f64 / RATE { full } else { wave };
        wave.pick_offs(t)
    });
    let first = found.iter().find(|e| e.start == end).unwrap();
    assert_eq!(found[0].flags, Flags::CIRCULAR);
    assert_eq!(first.flags.without(Flags::STEP), Flags::REACQUIRED);
    assert!(found[2..].iter().all(|e| e.flags.is_empty()));
}

#[test]
fn a_pattern_that_a_split_turns_past_a_circle_is_not_lost() {
    // There one of its waves nearly vanishes, and turns fast: only the mean frequency weighted by power stays.
    for noise in [1e-5, 1e-3] {
        let (mut circular, mut rows) = (0, 0);
        for seed in 0..10 {
            let wave = Wave {
                main_amplitude: 1.0,
                quadrature_amplitude: 0.998,
                angle: 0.15 * seed as f64,
                frequency_split: 2.0,
                ..Wave::default()
            };
            for estimate in identify(wave, &Flaws::white(noise), windows(10), 150_000, seed) {
                let flags = estimate.flags;
                assert!(
                    !flags.contains(Flags::LOST),
                    "noise {noise}, seed {seed}: {flags} at {} s",
                    estimate.time
                );
                rows += 1;
                if flags.contains(Flags::CIRCULAR) {
                    circular += 1;
                    let error = (estimate.frequency - wave.frequency).abs();
                    let room = 0.1 + 5.0 * f64::from(estimate.frequency_std);
                    assert!(error < room, "{error} Hz: {estimate:?}");
                }
            }
        }
        println!("noise {noise}: {circular} of {rows} windows are circular");
        assert!(circular > 3 && rows > 7_500, "{circular} of {rows}");
    }
}

#[test]
fn misfits_of_a_circle_do_not_change_the_angle_of_the_wave_behind_it() {
    let flat = Wave {
        main_amplitude: 1.0,
        quadrature_amplitude: 0.3,
        angle: 0.2,
        ..Wave::default()
    };
    let settings = Settings {
        frequency: Some(flat.frequency as f32),
        ..windows(10)
    };
    // Without noise what is left of a circle's angle is followed well: it turns by 2 rad, with a spike in every window.
    let circle = 4000.0 / RATE..8000.0 / RATE;
    let found = identify_signal(0.0, settings, 12_000, 1, |time| {
        if !circle.contains(&time) {
            return flat.pick_offs(time);
        }
        let turned = Wave {
            quadrature_amplitude: 0.9985,
            angle: flat.angle + 50.0 * (time - circle.start),
            ..flat
        };
        let [c, d] = turned.pick_offs(time);
        let is_spike = (time * RATE).round() as u32 % 190 == 100;
        [c + if is_spike { 0.01 } else { 0.0 }, d]
    });
    let both = Flags::CIRCULAR.with(Flags::MISFIT);
    assert!(found.iter().filter(|e| e.flags.contains(both)).count() > 15);
    let mut rows = 0;
    for estimate in found.iter().filter(|e| e.flags.is_empty()) {
        assert!((estimate.angle - flat.angle).abs() < 0.01, "{estimate:?}");
        rows += 1;
    }
    assert!(rows > 35, "{rows}");
}

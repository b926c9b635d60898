//! Faults in streams of seconds: every window that they touch is flagged, no other one is, and the wave is soon tracked again.

use antinode::{Estimate, Flags, Settings};
use antinode_sim::{Channel, ClipSpan, Dropout, DropoutKind, Flaws, Loss, Wave};
use host_tests::score::{errors, stated};
use host_tests::{
    Core, RATE, gyro, identify, identify_changed, identify_parts, stream, stream_part, windows,
};

/// Length of the streams, sample pairs.
const STREAM: usize = 400_000;
/// Pairs after a fault that may not be flagged any more: 500 windows.
const AFTER: usize = 95_000;

/// Asserts that the windows of a fault between two times, s, are flagged, others are not, and that a clean one follows soon.
fn check(estimates: &[Estimate], from: f64, to: f64, name: &str) {
    let window = 10.0 / 5332.0;
    let span = |e: &Estimate| (e.start as f64 / RATE, e.end() as f64 / RATE);
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
            let stds = stated(estimate);
            for (i, error) in errors(estimate, &wave).into_iter().enumerate() {
                squares[i] += (error / (stds[i] + 1e-7)).powi(2);
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
        let (wave, mut flaws) = gyro(seed);
        let at = 200_000 + 37 * seed;
        for count in [1, 3, 100] {
            flaws.lost = vec![Loss { at, count }];
            let estimates = identify(wave, &flaws, windows(10), at as usize + AFTER, seed);
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
        // The stronger pick-off loses a tenth of its amplitude or more.
        let (s2, c2) = (2.0 * wave.at(from).angle).sin_cos();
        let level = 0.88 * wave.at(to).main_amplitude * s2.abs().max(c2.abs());
        flaws.clip_spans = vec![ClipSpan { from, to, level }];
        let estimates = identify(wave, &flaws, windows(10), STREAM, seed);
        // For a sample to be cut, a crest must lie within the span: half a period from its ends.
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
            rails: Some([-1.0, 1.0].map(|side| (side * full * 2047.0 / 2048.0) as f32)),
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

fn dropouts_are_flagged(kind: DropoutKind) {
    // Until shortly before the fault all streams of a seed are the same.
    let before = 199_000;
    for seed in 0..20 {
        let (wave, flaws) = gyro(seed);
        let mut steady = Core::new(windows(10)).unwrap();
        let mut clean = Vec::new();
        steady.extend(&stream(wave, flaws.clone(), before, seed), |e| {
            clean.push(e)
        });
        for channel in [None, Some(Channel::C), Some(Channel::D)] {
            // A pick-off in a node has no wave to lose.
            let (s2, c2) = (2.0 * wave.at(2.0).angle).sin_cos();
            if s2.abs().min(c2.abs()) < 0.15 && channel.is_some() {
                continue;
            }
            for length in [0.0007, 0.004, 0.5] {
                let from = 2.0 + 1e-4 * seed as f64;
                let to = from + length;
                let dropout = Dropout {
                    from,
                    to,
                    kind,
                    channel,
                };
                let flaws = Flaws {
                    dropouts: vec![dropout],
                    ..flaws.clone()
                };
                let rest = before..(to * RATE) as usize + AFTER;
                let rest = stream_part(wave, flaws, rest, seed);
                let (mut core, mut found) = (steady.clone(), clean.clone());
                core.extend(&rest, |estimate| found.push(estimate));
                let name = format!("{kind:?} of {channel:?} for {length} s, seed {seed}");
                check(&found, from + 2e-5, to - 2e-5, &name);
            }
        }
    }
}

#[test]
fn dropouts_to_zero_are_flagged() {
    dropouts_are_flagged(DropoutKind::Zero);
}

#[test]
fn dropouts_that_hold_a_value_are_flagged() {
    dropouts_are_flagged(DropoutKind::Hold);
}

#[test]
fn dropouts_to_noise_are_flagged() {
    dropouts_are_flagged(DropoutKind::NoiseOnly);
}

#[test]
fn a_circular_pattern_has_no_angle() {
    for sign in [1.0, -1.0] {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 0.9999 * sign,
            ..Wave::default()
        };
        let flaws = Flaws::white(0.002);
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
fn samples_that_are_not_finite_cost_one_window() {
    let (wave, flaws) = gyro(3);
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let spoil = |k, [c, d]: [f64; 2]| [if k == 30_000 { value } else { c }, d];
        let found = identify_changed(wave, &flaws, windows(10), 60_000, 3, spoil);
        let flagged: Vec<_> = found.iter().filter(|e| !e.flags.is_empty()).collect();
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
            let at = 30_000 + 11 * seed as usize;
            let step = |k, [mut c, mut d]: [f64; 2]| {
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
                [c, d]
            };
            let estimates = identify_changed(wave, &flaws, windows(10), 60_000, seed, step);
            // If the step leaves less than a block of a window on one side, the next window may be the flagged one.
            let within = |e: &&Estimate| (e.start..e.end()).contains(&(at as u64));
            let window = estimates.iter().find(within).unwrap();
            let depth = (at as u64 - window.start).min(window.end() - at as u64);
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

#[test]
fn a_wave_of_another_frequency_in_place_of_the_wave_is_found() {
    // At half and double the frequency and anything between, whatever the sums at the old frequency show of it.
    for noise in [0.0, 1e-3, 0.02] {
        for (from, to) in [
            (5332.0, 8000.0),
            (5332.0, 10_664.0),
            (10_664.0, 5332.0),
            (20_000.0, 10_000.0),
            (18_000.0, 9100.0),
            (25_000.0, 13_350.0),
            (24_000.0, 12_000.0),
            (1000.0, 5332.0),
        ] {
            for periods in [2, 10, 50] {
                let wave = |frequency| Wave {
                    main_amplitude: 1.0,
                    quadrature_amplitude: 0.1,
                    frequency,
                    ..Wave::default()
                };
                let flaws = Flaws::white(noise);
                let one = stream(wave(from), flaws.clone(), 20_000, 1);
                let two = stream(wave(to), flaws, 40_000, 2);
                let mut after = identify_parts(&[&one, &two], windows(periods));
                after.retain(|estimate| estimate.start >= 20_000);
                let faults = after.iter().take_while(|row| !is_of(row, to)).count();
                assert!(
                    faults <= 10 && after.len() > faults + 4,
                    "{from} to {to} Hz, noise {noise}, {periods} periods: {faults} of {}",
                    after.len()
                );
                for row in &after[..faults] {
                    assert!(!row.flags.is_empty(), "{from} to {to} Hz: {row:?}");
                }
                for row in &after[faults..] {
                    assert!(is_of(row, to), "{from} to {to} Hz: {row:?}");
                }
            }
        }
    }
}

/// True if the row is of a wave at this frequency and has no flag, except that of a new wave.
fn is_of(row: &Estimate, frequency: f64) -> bool {
    row.flags.without(Flags::REACQUIRED).is_empty()
        && (row.frequency - frequency).abs() < 0.01 * frequency
}

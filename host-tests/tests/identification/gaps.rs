//! Over gaps between windows, chosen or met: the angle runs on or says that it may not, and nothing else is a fault.

use antinode::{Estimate, Flags, Settings};
use antinode_sim::{Flaws, Gyro, Wave, random_wave};
use host_tests::score::{errors, stated};
use host_tests::{Core, RATE, identify, no_wave, stream, windows};

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
fn angles_of_long_ago_say_nothing_of_the_present_rate() {
    // So little noise that the angle is certain after minutes. Much quadrature: a rate that is wrong moves the frequency.
    let (mut all, mut shares) = (Vec::new(), Vec::new());
    for seed in 0..20 {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 0.6,
            ..random_wave(seed, 5000.0, 0.5)
        };
        let flaws = Flaws {
            noise: 3e-6,
            ..Flaws::default()
        };
        let pairs = stream(wave, flaws, 6_000, seed);
        let mut core = Core::new(windows(10)).unwrap();
        let mut found = Vec::new();
        core.extend(&pairs[..3_000], |e| found.push(e));
        // Whole periods, which need not be simulated.
        core.skip(20 * (200_000 + 100_000 * seed));
        core.extend(&pairs[3_000..], |e| found.push(e));
        let before = found
            .iter()
            .rfind(|e| e.start < 3_000)
            .unwrap()
            .frequency_std;
        let after = found.iter().filter(|e| e.start >= 3_000);
        for (index, estimate) in after.enumerate() {
            assert!(estimate.flags.is_empty(), "{}", estimate.flags);
            // The first two know no rate yet.
            if (2..5).contains(&index) {
                shares.push(estimate.frequency_std / before);
            }
            all.push((estimate.frequency - 5000.0) / f64::from(estimate.frequency_std));
        }
    }
    assert!(all.len() > 250, "{}", all.len());
    // As well known as before.
    let share = shares.iter().sum::<f32>() / shares.len() as f32;
    assert!(share < 1.2, "{share}");
    let rms = (all.iter().map(|x| x * x).sum::<f64>() / all.len() as f64).sqrt();
    assert!((0.8..1.2).contains(&rms), "{rms}");
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
            let is_unknown = after[0].flags.contains(Flags::REACQUIRED);
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

#[test]
fn gaps_in_which_the_pattern_turns_unseen_leave_no_angle_that_is_wrong_and_clean() {
    // A window every 0.95 s, each of which knows the rate to 0.5 rad/s: the quarter turn that the angle lies in is not known.
    let settings = Settings {
        hop: Some(5000),
        ..windows(10)
    };
    for (seed, angle_rate) in [0.0, 0.5, 1.0, 1.5, 2.0, 3.0].into_iter().enumerate() {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 0.3,
            angle_rate,
            ..Wave::default()
        };
        let flaws = Flaws {
            noise: 0.005,
            ..Flaws::default()
        };
        let estimates = identify(wave, &flaws, settings, 4_000_000, seed as u64);
        assert!(estimates.len() > 40);
        let quarter = std::f64::consts::FRAC_PI_2;
        let mut square = 0.0;
        for pair in estimates.windows(2) {
            let turned = pair[1].angle - pair[0].angle;
            let expected = angle_rate * (pair[1].time - pair[0].time);
            let is_right = ((turned - expected) / quarter).round() == 0.0;
            let flags = pair[1].flags;
            assert!(
                is_right || flags.contains(Flags::REACQUIRED),
                "{angle_rate} rad/s: turned by {turned}, not {expected}: {flags}"
            );
            // Nor is anything missing.
            assert!(
                !flags.intersects(Flags::PHASE_JUMP.with(Flags::STEP)),
                "{angle_rate} rad/s: {flags}"
            );
            square += (errors(&pair[1], &wave)[3] / stated(&pair[1])[3]).powi(2);
        }
        let ratio = (square / (estimates.len() - 1) as f64).sqrt();
        assert!(ratio < 1.4, "{angle_rate} rad/s: frequency {ratio:.2}");
    }
}

#[test]
fn noise_is_no_step_over_a_gap() {
    // In 5 % noise a window knows how fast the wave decays to 10 1/s, and the next one comes 0.38 s later.
    let settings = Settings {
        hop: Some(2000),
        ..windows(10)
    };
    for seed in 0..4 {
        let flaws = Flaws {
            noise: 0.05,
            ..Flaws::default()
        };
        let wave = Wave {
            main_amplitude: 1.0,
            ..Wave::default()
        };
        let estimates = identify(wave, &flaws, settings, 3_000_000, seed);
        assert!(estimates.len() > 70);
        for estimate in &estimates {
            assert!(
                !estimate.flags.contains(Flags::STEP),
                "seed {seed}: {} at {} s",
                estimate.flags,
                estimate.time
            );
        }
    }
}

#[test]
fn the_rate_is_learnt_over_gaps() {
    // Each window knows the rate to 0.8 rad/s: too little to follow the angle over 0.19 s, and enough after a few.
    let settings = Settings {
        hop: Some(1000),
        ..windows(10)
    };
    for (seed, angle_rate) in [0.0, 0.0, 1.0, -2.0, 3.0].into_iter().enumerate() {
        let wave = Wave {
            main_amplitude: 0.5,
            quadrature_amplitude: 0.05,
            angle_rate,
            ..Wave::default()
        };
        let flaws = Flaws {
            noise: 0.005,
            ..Flaws::default()
        };
        let estimates = identify(wave, &flaws, settings, 2_000_000, seed as u64);
        assert!(estimates.len() > 90);
        for (index, pair) in estimates.windows(2).enumerate() {
            let turned = pair[1].angle - pair[0].angle;
            let expected = angle_rate * (pair[1].time - pair[0].time);
            let flags = pair[1].flags;
            let is_new = index < 8 && flags == Flags::REACQUIRED;
            assert!(
                is_new || flags.is_empty() && (turned - expected).abs() < 0.1,
                "{angle_rate} rad/s, window {index}: turned by {turned}, not {expected}: {flags}"
            );
        }
    }
}

#[test]
fn a_rate_that_changes_between_windows_far_apart_is_learnt_anew() {
    let settings = Settings {
        hop: Some(1000),
        ..windows(10)
    };
    // The last differ by a quarter turn from window to window.
    let alias = std::f64::consts::FRAC_PI_2 / 0.19;
    let rates = [
        [0.0, 6.0],
        [0.0, -8.0],
        [3.0, -4.0],
        [-2.0, 5.0],
        [1.0, 1.0 + alias],
    ];
    for (seed, [first, second]) in rates.into_iter().enumerate() {
        let flaws = Flaws {
            noise: 0.005,
            ..Flaws::default()
        };
        // After 10 s the wave is at the phase it began with.
        let wave = Wave {
            main_amplitude: 0.5,
            quadrature_amplitude: 0.05,
            frequency: 5332.0,
            angle_rate: first,
            ..Wave::default()
        };
        let before = stream(wave, flaws.clone(), 1_000_000, seed as u64);
        let then = Wave {
            angle: wave.angle + 10.0 * first,
            angle_rate: second,
            ..wave
        };
        let after = stream(then, flaws, 2_000_000, 100 + seed as u64);
        for lost in [0, 5_000_000] {
            let mut core = Core::new(settings).unwrap();
            let mut estimates = Vec::new();
            core.extend(&before, |estimate| estimates.push(estimate));
            let changed = estimates.len();
            core.skip(lost);
            core.extend(&after, |estimate| estimates.push(estimate));
            assert!(
                estimates.len() > changed + 90,
                "{changed}, {}",
                estimates.len()
            );
            for (index, pair) in estimates.windows(2).enumerate().skip(changed) {
                let turned = pair[1].angle - pair[0].angle;
                let expected = second * (pair[1].time - pair[0].time);
                let flags = pair[1].flags;
                let is_new = index < changed + 8 && !flags.is_empty();
                assert!(
                    is_new || flags.is_empty() && (turned - expected).abs() < 0.1,
                    "from {first} to {second} rad/s, window {index} after {changed}: turned by {turned}, not {expected}: {flags}"
                );
            }
        }
    }
}

#[test]
fn a_rate_that_changes_in_a_gap_leaves_no_angle_that_is_wrong_and_unflagged() {
    // Turning before and after, rad/s, and how long nothing is seen: by more than π/4 otherwise than promised, and by less.
    for (before, after, gap, is_told) in [
        (0.0, 6.0, 0.3, true),
        (6.0, -6.0, 0.3, true),
        (0.0, 2.0, 1.0, true),
        (0.0, 30.0, 0.05, true),
        (6.0, 6.0, 0.3, false),
        (0.0, 1.0, 0.3, false),
    ] {
        let still = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 0.1,
            ..Wave::default()
        };
        let from = 20_000;
        let to = from + (gap * RATE) as usize;
        let flaws = Flaws {
            noise: 1e-3,
            ..Flaws::default()
        };
        let mut pairs = stream(no_wave(), flaws, to + 20_000, 1);
        for (k, pair) in pairs.iter_mut().enumerate() {
            let t = k as f64 / RATE;
            let change = from as f64 / RATE;
            let angle = before * t.min(change) + after * (t - change).max(0.0);
            let turned = Wave {
                angle: still.angle + angle,
                ..still
            };
            let (c, d) = turned.pick_offs(t);
            pair[0] += c as f32;
            pair[1] += d as f32;
        }
        let mut core = Core::new(windows(10)).unwrap();
        core.extend(&pairs[..from], |estimate| {
            assert!(estimate.flags.is_empty(), "{estimate:?}");
        });
        core.skip((to - from) as u64);
        let mut first = None;
        core.extend(&pairs[to..], |estimate| {
            first.get_or_insert(estimate);
        });
        let flags = first.unwrap().flags;
        assert_eq!(
            flags.contains(Flags::REACQUIRED),
            is_told,
            "{before} to {after} rad/s in {gap} s: {flags}"
        );
    }
}

#[test]
fn a_quarter_turn_that_began_in_a_gap_is_no_jump_of_the_phase() {
    for seed in 0..20 {
        let (at, gap, rate) = (5000, 4000, 30.0);
        let wave = random_wave(seed, 5332.0, 0.1);
        // It goes on to turn as fast as it must have done in the gap.
        let end = (at + gap) as f64 / RATE;
        let turned = Wave {
            angle: wave.angle + std::f64::consts::FRAC_PI_2 - rate * end,
            angle_rate: rate,
            ..wave
        };
        let flaws = Flaws {
            noise: 1e-3 * wave.main_amplitude,
            ..Flaws::default()
        };
        let [before, after] =
            [wave, turned].map(|wave| stream(wave, flaws.clone(), at + gap + 1000, seed));
        let mut core = Core::new(windows(10)).unwrap();
        core.extend(&before[..at], |_| {});
        core.skip(gap as u64);
        let mut first = None;
        core.extend(&after[at + gap..], |estimate| {
            first.get_or_insert(estimate.flags);
        });
        assert_eq!(first, Some(Flags::REACQUIRED), "seed {seed}");
    }
}

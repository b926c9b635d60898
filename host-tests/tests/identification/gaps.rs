//! Gaps between windows, intended or not: the angle is continued or flagged, and nothing else is a fault.

use antinode::{Estimate, Flags, Settings};
use antinode_sim::{Flaws, Gyro, Wave, random_wave};
use host_tests::score::{errors, stated};
use host_tests::{Core, RATE, identify, stream, windows};

#[test]
fn a_reported_gap_costs_only_its_window() {
    let wave = Wave {
        angle_rate: 0.5,
        ..Wave::default()
    };
    let pairs = stream(wave, Flaws::white(0.01), 40_000, 5);
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
fn the_angle_is_continued_over_gaps_in_which_it_turns_far() {
    // A window every 0.19 s: the pattern turns by 0.95 rad meanwhile, more than the ambiguity allows without a known rate.
    let wave = Wave {
        angle_rate: 5.0,
        ..Wave::default()
    };
    let settings = Settings {
        hop: Some(1000),
        ..windows(10)
    };
    let flaws = Flaws::white(0.002);
    let estimates = identify(wave, &flaws, settings, 300_000, 3);
    assert!(estimates.len() > 12);
    for pair in estimates.windows(2) {
        let turned = pair[1].angle - pair[0].angle;
        let expected = 5.0 * (pair[1].time - pair[0].time);
        assert!((turned - expected).abs() < 0.01, "{turned} {expected}");
    }
}

#[test]
fn a_long_gap_leaves_no_wrong_angle_unflagged() {
    // Lost pairs, and whether every first window after them must have its angle modulo π/2 only.
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
            let flaws = Flaws::white(0.005 * wave.main_amplitude);
            let mut gyro = Gyro::new(wave, flaws, RATE, seed).unwrap();
            let mut core = Core::new(windows(10)).unwrap();
            let push = |gyro: &mut Gyro, core: &mut Core, count| -> Vec<Estimate> {
                let pairs = gyro.by_ref().take(count);
                pairs
                    .filter_map(|pair| core.push(pair.map(|x| x as f32)))
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
fn distant_windows_state_their_frequencys_deviation_as_well() {
    for hop in [20u16, 1000] {
        let wave = Wave {
            angle: 0.3,
            quadrature_amplitude: 0.5,
            angle_rate: 0.02,
            ..Wave::default()
        };
        let flaws = Flaws::white(1e-4);
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
fn a_loss_of_no_pairs_changes_nothing() {
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
fn gaps_in_which_the_pattern_turns_unseen_leave_no_wrong_angle_unflagged() {
    // A window every 0.95 s, each of which knows the rate to 0.5 rad/s: the quarter turn of the angle is not determined.
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
        let flaws = Flaws::white(0.005);
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
            // Nor is a sample missing.
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
fn noise_is_no_step_across_a_gap() {
    // In 5 % noise a window knows the decay rate to 10 1/s, and the next one comes 0.38 s later.
    let settings = Settings {
        hop: Some(2000),
        ..windows(10)
    };
    for seed in 0..4 {
        let flaws = Flaws::white(0.05);
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
fn a_quarter_turn_that_began_in_a_gap_is_no_phase_jump() {
    for seed in 0..20 {
        let (at, gap, rate) = (5000, 4000, 30.0);
        let wave = random_wave(seed, 5332.0, 0.1);
        // The pattern goes on turning at the rate that it must have had in the gap.
        let end = (at + gap) as f64 / RATE;
        let turned = Wave {
            angle: wave.angle + std::f64::consts::FRAC_PI_2 - rate * end,
            angle_rate: rate,
            ..wave
        };
        let flaws = Flaws::white(1e-3 * wave.main_amplitude);
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

//! The rate at which a pattern turns, learnt from windows with gaps between them.

use antinode::{Flags, Settings};
use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::{Core, RATE, identify, no_wave, stream, windows};

#[test]
fn old_angles_are_not_used_for_the_present_rate() {
    // With so little noise the angle is certain after minutes. With much quadrature a wrong rate moves the frequency.
    let (mut all, mut shares) = (Vec::new(), Vec::new());
    for seed in 0..20 {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 0.6,
            ..random_wave(seed, 5000.0, 0.5)
        };
        let flaws = Flaws::white(3e-6);
        let pairs = stream(wave, flaws, 6_000, seed);
        let mut core = Core::new(windows(10)).unwrap();
        let mut found = Vec::new();
        core.extend(&pairs[..3_000], |e| found.push(e));
        // Whole periods need not be simulated.
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
            // The first two windows know no rate yet.
            if (2..5).contains(&index) {
                shares.push(estimate.frequency_std / before);
            }
            all.push((estimate.frequency - 5000.0) / f64::from(estimate.frequency_std));
        }
    }
    assert!(all.len() > 250, "{}", all.len());
    // The frequency is known as well as before.
    let share = shares.iter().sum::<f32>() / shares.len() as f32;
    assert!(share < 1.2, "{share}");
    let rms = (all.iter().map(|x| x * x).sum::<f64>() / all.len() as f64).sqrt();
    assert!((0.8..1.2).contains(&rms), "{rms}");
}

#[test]
fn the_rate_is_learnt_over_gaps() {
    // Each window knows the rate to 0.8 rad/s: too little to track the angle over 0.19 s, but enough after a few windows.
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
        let flaws = Flaws::white(0.005);
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
fn a_rate_that_changes_between_distant_windows_is_learnt_anew() {
    let settings = Settings {
        hop: Some(1000),
        ..windows(10)
    };
    // The last rates differ by a quarter turn from window to window.
    let alias = std::f64::consts::FRAC_PI_2 / 0.19;
    let rates = [
        [0.0, 6.0],
        [0.0, -8.0],
        [3.0, -4.0],
        [-2.0, 5.0],
        [1.0, 1.0 + alias],
    ];
    for (seed, [first, second]) in rates.into_iter().enumerate() {
        let flaws = Flaws::white(0.005);
        // After 10 s the wave has its initial phase again.
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
fn a_rate_that_changes_in_a_gap_leaves_no_wrong_angle_unflagged() {
    // Rates before and after, rad/s, and the length of the gap: with turns that differ from the predicted by more than π/4, and by less.
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
        let flaws = Flaws::white(1e-3);
        let mut pairs = stream(no_wave(), flaws, to + 20_000, 1);
        for (k, pair) in pairs.iter_mut().enumerate() {
            let t = k as f64 / RATE;
            let change = from as f64 / RATE;
            let angle = before * t.min(change) + after * (t - change).max(0.0);
            let turned = Wave {
                angle: still.angle + angle,
                ..still
            };
            let [c, d] = turned.pick_offs(t);
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

//! The windows after a fault: a leap of the frequency, the end of a wave, a spike while a wave grows, a broken wire.

use std::f64::consts::TAU;

use antinode::{Estimate, Flags, Settings};
use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::{
    RATE, identify_changed, identify_parts, identify_signal, no_wave, stream, windows,
};

fn noisy(wave: &Wave, noise: f64) -> Flaws {
    Flaws::white(noise * wave.main_amplitude)
}

#[test]
fn a_small_leap_of_the_frequency_needs_no_search() {
    // From the last frequency alone a fit of 50 periods finds no wave more than half a per cent off.
    for leap in [0.01, 0.02, 0.03, 0.045, 0.06, -0.03] {
        for seed in 0..6 {
            let wave = random_wave(seed, 5332.0, 0.3);
            let frequency = 5332.0 * (1.0 + leap);
            let to = Wave { frequency, ..wave };
            let (one, two) = (
                stream(wave, noisy(&wave, 0.005), 10_000, seed),
                stream(to, noisy(&wave, 0.005), 20_000, seed),
            );
            let found = identify_parts(&[&one, &two[10_000..]], windows(50));
            let after: Vec<_> = found.iter().filter(|e| e.start >= 10_000).collect();
            assert!(after.len() >= 9, "{}", after.len());
            for estimate in &after[1..] {
                assert!(
                    estimate.flags.is_empty() && (estimate.frequency - frequency).abs() < 5.0,
                    "leap of {leap}, seed {seed}: {estimate:?}"
                );
            }
        }
    }
}

#[test]
fn a_wave_that_ends_with_a_window_is_lost_and_nothing_else() {
    for seed in 0..40 {
        let wave = random_wave(seed, 5332.0, 0.3);
        let flaws = noisy(&wave, 0.002);
        let silent = no_wave();
        let (one, two) = (
            stream(wave, flaws.clone(), 10_000, seed),
            stream(silent, flaws, 11_000, seed),
        );
        let clean = identify_parts(&[&one], windows(10));
        let at = clean[40].start as usize;
        let found = identify_parts(&[&one[..at], &two[at..]], windows(10));
        // The difference between its numbers and those of the wave is no step.
        let told = found[40].flags;
        assert!(
            told.contains(Flags::LOST) && !told.intersects(Flags::STEP.with(Flags::PHASE_JUMP)),
            "seed {seed}: {told}"
        );
    }
}

#[test]
fn missing_samples_next_to_a_nan_are_reported_by_the_next_window() {
    for seed in 0..20 {
        let wave = random_wave(seed, 5332.0, 0.5);
        let mut pairs = stream(wave, noisy(&wave, 0.002), 8_000, seed);
        let clean = identify_parts(&[&pairs], windows(10));
        let at = clean[20].start as usize + 40 + 5 * seed as usize;
        pairs[at] = [f32::NAN; 2];
        // A sixth of a period is missing.
        pairs.drain(at + 1..at + 4);
        let found = identify_parts(&[&pairs], windows(10));
        assert!(found.len() >= 40, "{}", found.len());
        for (index, estimate) in found.iter().enumerate() {
            let expected = match index {
                20 => Flags::NOT_FINITE.with(Flags::LOST),
                21 => Flags::PHASE_JUMP,
                _ => Flags::empty(),
            };
            assert!(
                estimate.flags.contains(expected) && (index == 20 || estimate.flags == expected),
                "seed {seed}, window {index}: {}",
                estimate.flags
            );
        }
    }
}

#[test]
fn half_a_period_missing_anywhere_is_a_jump_of_the_phase() {
    // The halves of a window with such a gap in its middle cancel, so that it shows no wave, a circle, or a dead pick-off.
    let mut lost = 0;
    for (periods, spread) in [(10, 188), (50, 938)] {
        for seed in 0..80 {
            let wave = Wave {
                angle_rate: 0.2,
                ..random_wave(seed, 5332.0, 0.2)
            };
            let mut pairs = stream(wave, noisy(&wave, 0.002), 15_000, seed);
            let at = 8_000 + (seed as usize * 61) % spread;
            // Some 0.43, 0.48, 0.53 and 0.59 of a period.
            pairs.drain(at..at + 8 + seed as usize % 4);
            let found = identify_parts(&[&pairs], windows(periods));
            let end = |e: &Estimate| (e.start + u64::from(e.samples)) as usize;
            let first = found.iter().position(|e| end(e) > at).expect("one has it");
            lost += usize::from(found[first].flags.contains(Flags::LOST));
            let told = |e: &Estimate| e.flags.contains(Flags::PHASE_JUMP);
            assert!(
                found[first..first + 2].iter().any(told),
                "{periods} periods, seed {seed}, {} and {}",
                found[first].flags,
                found[first + 1].flags
            );
            for estimate in &found[first + 2..] {
                assert!(estimate.flags.is_empty(), "seed {seed}: {estimate:?}");
            }
        }
    }
    assert!(lost > 40, "{lost} windows showed no wave");
}

#[test]
fn a_dropout_of_a_window_is_no_jump_of_the_phase() {
    let mut lost = 0;
    for seed in 0..40 {
        let wave = Wave {
            angle_rate: 0.2,
            ..random_wave(seed, 5332.0, 0.2)
        };
        let mut pairs = stream(wave, noisy(&wave, 0.002), 12_000, seed);
        let at = 6_000 + 17 * seed as usize;
        pairs[at..at + 250].fill([0.0; 2]);
        let found = identify_parts(&[&pairs], windows(10));
        lost += usize::from(found.iter().any(|e| e.flags.contains(Flags::LOST)));
        for estimate in found {
            let told = estimate.flags;
            assert!(!told.contains(Flags::PHASE_JUMP), "seed {seed}: {told}");
            // After two windows without the wave it is searched for.
            let rest = told.without(Flags::REACQUIRED);
            assert!(estimate.start as usize <= at + 250 || rest.is_empty());
        }
    }
    assert!(lost > 20, "{lost} waves");
}

#[test]
fn a_pick_off_that_is_dead_for_a_while_is_no_jump_of_the_phase() {
    for seed in 0..40 {
        let mut wave = random_wave(seed, 5332.0, 0.2);
        // Without the other pick-off the quadrature wave moves the phase by up to 0.2 rad.
        wave.quadrature_amplitude = 0.2 * wave.main_amplitude;
        wave.angle = 0.3 + 0.01 * seed as f64;
        let dead = 5_000 + 17 * seed as usize..8_000;
        let mut pairs = stream(wave, noisy(&wave, 0.002), 12_000, seed);
        for pair in &mut pairs[dead.clone()] {
            pair[1] = 0.0;
        }
        let found = identify_parts(&[&pairs], windows(10));
        let mut silent = 0;
        for estimate in found {
            let told = estimate.flags;
            let begin = estimate.start as usize;
            silent += usize::from(told.contains(Flags::DEAD_CHANNEL));
            if begin >= dead.start {
                assert!(!told.contains(Flags::PHASE_JUMP), "seed {seed}: {told}");
            }
            assert!(begin < 8_000 || told.is_empty(), "seed {seed}: {told}");
        }
        assert!(silent > 9, "{silent}");
    }
}

#[test]
fn a_wave_that_grew_before_a_fault_may_decay_after_it() {
    let settings = Settings {
        hop: Some(5),
        ..windows(10)
    };
    for seed in 0..40 {
        let wave = random_wave(seed, 5332.0, 0.3);
        let at = 8_000 + 17 * seed as usize;
        let kick = 0.7 * wave.main_amplitude;
        let flaws = noisy(&wave, 1e-3);
        let found = identify_changed(wave, &flaws, settings, 11_000, seed, |k, [c, d]| {
            let time = (k as f64 - at as f64) / host_tests::RATE;
            let gain = (-20.0 * time.abs()).exp();
            let kick = if (at..at + 30).contains(&k) {
                kick
            } else {
                0.0
            };
            [gain * c + kick, gain * d]
        });
        let end = (at + 30) as u64;
        assert!(found.iter().any(|e| e.flags.contains(Flags::MISFIT)));
        let after = found.iter().filter(|e| e.start >= end);
        assert!(after.clone().count() > 15);
        for estimate in after {
            assert!(estimate.flags.is_empty(), "seed {seed}: {estimate:?}");
        }
    }
}

#[test]
fn a_pick_off_that_shows_only_what_the_other_leaks_is_dead() {
    // In very little noise the leak exceeds it, but a thousandth of the wave does not count as one.
    for leak in [2e-4, 5e-4, 9e-4] {
        for noise in [0.0, 1e-6, 1e-5] {
            for seed in 0..6 {
                let wave = Wave {
                    angle: 0.2 + 0.01 * seed as f64,
                    ..random_wave(seed, 5332.0, 0.2)
                };
                let flaws = noisy(&wave, noise);
                let found = identify_changed(
                    wave,
                    &flaws,
                    windows(10),
                    10_400,
                    seed,
                    |k, [c, d]| match k {
                        ..10_000 => [c, d],
                        _ if seed % 2 == 0 => [c, leak * c],
                        _ => [leak * d, d],
                    },
                );
                // The first of its windows contains only a part of the fault.
                let broken = found.iter().find(|e| e.start >= 10_000).unwrap();
                assert!(
                    broken.flags.contains(Flags::DEAD_CHANNEL),
                    "leak {leak}, noise {noise}, seed {seed}: {}",
                    broken.flags
                );
            }
        }
    }
}

#[test]
fn the_window_in_which_a_dead_pick_off_comes_back_is_flagged_whatever_its_noise() {
    // Its windows raise the residual together, but that must not become a new level of noise.
    for seed in 0..60 {
        let wave = Wave {
            angle: 0.5,
            ..random_wave(seed, 5332.0, 0.3)
        };
        let louder = no_wave();
        let end = 14_000 + 37 * seed as usize;
        let loud = noisy(&wave, 0.03);
        let dead = stream(louder, loud, 20_000, seed + 100);
        let found = identify_changed(
            wave,
            &noisy(&wave, 0.005),
            windows(10),
            20_000,
            seed,
            |k, [c, d]| match k {
                10_000.. if k < end => [c, f64::from(dead[k][1])],
                _ => [c, d],
            },
        );
        // Windows that the fault covers by two blocks or more.
        let touched = |e: &&Estimate| e.start + 76 < end as u64 && e.end() > 10_076;
        let clean = |e: &&Estimate| touched(e) && e.flags.is_empty();
        assert!(found.iter().filter(touched).count() > 20);
        assert_eq!(found.iter().find(clean), None, "seed {seed}");
    }
}

#[test]
fn a_wave_is_found_again_after_a_shock_that_rings_at_another_frequency() {
    // The shock is ten times the wave and dies within 50 ms. Blocks laid out for it see a seventh of the wave, at a third frequency.
    for (ratio, hum) in [
        (0.7, false),
        (1.8, false),
        (1.35, false),
        (1.73, true),
        (2.33, true),
    ] {
        for seed in 0..60 {
            let wave = random_wave(seed, 5332.0, 0.3);
            let mut pairs = stream(wave, noisy(&wave, 0.002), 40_000, seed);
            let (sine, cosine) = (0.7 * seed as f64).sin_cos();
            let turn = TAU * 5332.0 * ratio / RATE;
            for (k, pair) in (0..).zip(&mut pairs[5000 + 13 * seed as usize..]) {
                let size = 10.0 * wave.main_amplitude * (-f64::from(k) / 500.0).exp();
                let shock = size * (turn * f64::from(k) + 0.3 * seed as f64).sin();
                pair[0] += (shock * cosine) as f32;
                pair[1] += (shock * sine) as f32;
            }
            let settings = Settings { hum, ..windows(10) };
            let found = identify_parts(&[&pairs], settings);
            let last = &found[found.len() - 50..];
            for estimate in last {
                assert!(
                    estimate.flags.is_empty() && (estimate.frequency - 5332.0).abs() < 5.0,
                    "{ratio} times the frequency, hum {hum}, seed {seed}: {estimate:?}"
                );
            }
        }
    }
}

#[test]
fn a_pattern_that_turns_far_while_a_pick_off_is_dead_keeps_its_angle() {
    // It turns by more than half the ambiguity, through the axis on which the dead pick-off shows nothing anyway.
    for (seed, angle_rate) in (0..20).zip([4.0, -4.0, 8.0, -8.0].into_iter().cycle()) {
        let (dead, middle) = (0.43 / f64::abs(angle_rate), 0.2);
        let wave = Wave {
            angle: 0.01 * seed as f64 - angle_rate * middle,
            angle_rate,
            ..Wave::default()
        };
        let flaws = Flaws::white(1e-3);
        let [from, to] = [middle - dead, middle + dead].map(|t| (t * RATE) as usize);
        let found = identify_changed(wave, &flaws, windows(10), to + 5000, seed, |k, [c, d]| {
            [c, if (from..to).contains(&k) { 0.0 } else { d }]
        });
        let start = found[0].angle - wave.at(found[0].time).angle;
        let mut after = found.iter().filter(|e| e.start >= to as u64);
        assert!(after.clone().count() > 20);
        let is_right = |e: &Estimate| {
            let off = e.angle - wave.at(e.time).angle - start;
            e.flags.is_empty() && off.abs() < 0.01
        };
        assert!(after.all(is_right), "{angle_rate} rad/s, seed {seed}");
    }
}

#[test]
fn a_fault_that_seems_to_turn_the_pattern_does_not_change_the_angle_after_it() {
    // A tone makes misfits of four windows, in which the pattern seems to turn twice by a third of the angle's ambiguity.
    let settings = Settings {
        frequency: Some(5332.0),
        ..windows(10)
    };
    for seed in 0..20 {
        let wave = random_wave(seed, 5332.0, 0.3);
        let way = if seed % 2 == 0 { 0.5 } else { -0.5 };
        let noise = 1e-3 * wave.main_amplitude;
        let found = identify_signal(noise, settings, 9500, seed, |t| {
            let window = (t * RATE).round() as usize / 190;
            let (turned, tone) = match window {
                30 | 31 => (way, 0.2),
                32 | 33 => (2.0 * way, 0.2),
                _ => (0.0, 0.0),
            };
            let angle = wave.angle + turned;
            let tone = tone * wave.main_amplitude * (12_000.0 * t).sin();
            let [c, d] = Wave { angle, ..wave }.pick_offs(t);
            [c + tone, d + tone]
        });
        let is_misfit = |e: &Estimate| e.flags.contains(Flags::MISFIT);
        assert!(found.len() == 50 && found[30..34].iter().all(is_misfit));
        for estimate in &found[34..] {
            let off = estimate.angle - found[0].angle;
            assert!(
                estimate.flags.is_empty() && off.abs() < 0.02,
                "seed {seed}: {estimate:?}"
            );
        }
    }
}

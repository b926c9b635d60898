//! A step of a single quantity, between two windows or within one, is flagged in a single window.

use antinode::{Estimate, Flags, Settings};
use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::score::{errors, stated};
use host_tests::{Core, RATE, identify_changed, identify_parts, stream, windows};

/// Windows of ten periods before the step.
const BEFORE: usize = 80;

fn flaws(wave: &Wave) -> Flaws {
    Flaws::white(0.002 * wave.main_amplitude)
}

/// Estimates of a stream that from the start of a window on is that of the wave `to`, in the same noise.
fn stepped(wave: Wave, to: Wave, more: Flaws, seed: u64) -> Vec<Estimate> {
    stepped_at(wave, to, more, seed, 0)
}

/// As [`stepped`], with the step `depth` pairs after the start of the window.
fn stepped_at(wave: Wave, to: Wave, more: Flaws, seed: u64, depth: usize) -> Vec<Estimate> {
    let count = 190 * (2 * BEFORE);
    let (one, two) = (
        stream(wave, flaws(&wave), count, seed),
        stream(to, more, count, seed),
    );
    let clean = identify_parts(&[&one], windows(10));
    assert!(clean.iter().all(|e| e.flags.is_empty()));
    let at = clean[BEFORE].start as usize + depth;
    identify_parts(&[&one[..at], &two[at..]], windows(10))
}

fn check(found: &[Estimate], flag: Flags, name: &str) {
    for (i, estimate) in found.iter().enumerate() {
        if i == BEFORE {
            assert!(
                estimate.flags.contains(flag)
                    && (flag == Flags::MISFIT || !estimate.flags.contains(Flags::MISFIT)),
                "{name}: {}",
                estimate.flags
            );
        } else {
            assert!(
                estimate.flags.is_empty(),
                "{name}, window {i}: {}",
                estimate.flags
            );
        }
    }
}

#[test]
fn a_step_of_either_amplitude_or_of_the_angle_is_a_step() {
    for seed in 0..10 {
        let wave = random_wave(seed, 5332.0, 0.3);
        let a = wave.main_amplitude;
        let main = Wave {
            main_amplitude: 1.05 * a,
            ..wave
        };
        let quadrature = Wave {
            quadrature_amplitude: wave.quadrature_amplitude + 0.05 * a,
            ..wave
        };
        let angle = Wave {
            angle: wave.angle + 0.05,
            ..wave
        };
        for (to, name) in [(main, "main"), (quadrature, "quadrature"), (angle, "angle")] {
            let found = stepped(wave, to, flaws(&wave), seed);
            check(&found, Flags::STEP, &format!("{name}, seed {seed}"));
        }
    }
}

#[test]
fn a_step_of_either_offset_is_a_step() {
    for seed in 0..10 {
        let wave = random_wave(seed, 5332.0, 0.3);
        let size = 0.05 * wave.main_amplitude;
        for (offset_c, offset_d) in [(size, 0.0), (0.0, size)] {
            let more = Flaws {
                offset_c,
                offset_d,
                ..flaws(&wave)
            };
            let found = stepped(wave, wave, more, seed);
            let name = format!("offsets of {offset_c} and {offset_d}, seed {seed}");
            check(&found, Flags::STEP, &name);
        }
    }
}

#[test]
fn a_drifting_offset_is_flagged_once_at_most_and_a_step_during_the_drift_is() {
    // From window to window it drifts by more than the smallest step, and each time by as much.
    let wave = Wave {
        main_amplitude: 0.1,
        quadrature_amplitude: 0.01,
        ..Wave::default()
    };
    let wandering = Flaws {
        noise: 1e-3,
        hum: 1.0,
        hum_frequency: 0.02,
        ..Flaws::default()
    };
    for seed in 0..10 {
        let one = stream(wave, wandering.clone(), 100_000, seed);
        let found = identify_parts(&[&one], windows(50));
        let rows = found.len();
        let steps = found.iter().filter(|e| !e.flags.is_empty()).count();
        let moved = (found[rows - 1].offsets[0] - found[0].offsets[0]).abs() / rows as f32;
        println!("seed {seed}: {steps} of {rows} flagged, {moved} a window");
        assert!(rows > 100 && moved > 1.1e-3, "{rows}, {moved}");
        assert!(steps <= 1, "seed {seed}: {steps} of {rows}");

        let at = found[60].start as usize;
        let beyond: Vec<_> = one[at..].iter().map(|[c, d]| [*c, d + 0.01]).collect();
        let found = identify_parts(&[&one[..at], &beyond], windows(50));
        assert_eq!(found[60].flags, Flags::STEP, "seed {seed}");
    }
}

#[test]
fn a_step_of_the_phase_is_a_jump() {
    for seed in 0..10 {
        for step in [0.1, -0.1, 1.0, -3.0] {
            let wave = random_wave(seed, 5332.0, 0.3);
            let to = Wave {
                phase: wave.phase + step,
                ..wave
            };
            let found = stepped(wave, to, flaws(&wave), seed);
            let name = format!("phase by {step}, seed {seed}");
            check(&found, Flags::PHASE_JUMP, &name);
        }
    }
}

#[test]
fn a_step_within_a_window_costs_that_window_only() {
    for seed in 0..10 {
        let wave = random_wave(seed, 5332.0, 0.3);
        let a = wave.main_amplitude;
        let steps = [
            (1.2, 0.0, 0.0, 0.0),
            (1.0, 0.2, 0.0, 0.0),
            (1.0, 0.0, 0.2, 0.0),
            (1.0, 0.0, 0.0, 0.2),
            (1.0, 0.0, 0.0, -0.2),
        ];
        for (gain, quadrature, angle, offset) in steps {
            let to = Wave {
                main_amplitude: gain * a,
                quadrature_amplitude: gain * wave.quadrature_amplitude + quadrature * a,
                angle: wave.angle + angle,
                ..wave
            };
            let more = Flaws {
                offset_c: f64::max(offset, 0.0) * a,
                offset_d: f64::min(offset, 0.0) * a,
                ..flaws(&wave)
            };
            let found = stepped_at(wave, to, more, seed, 95);
            let name = format!("{gain} {quadrature} {angle} {offset}, seed {seed}");
            check(&found, Flags::MISFIT, &name);
        }
    }
}

#[test]
fn a_steadily_growing_quadrature_is_no_step() {
    let wave = Wave {
        main_amplitude: 1.0,
        quadrature_amplitude: 0.0,
        ..Wave::default()
    };
    let full = Wave {
        quadrature_amplitude: 1.0,
        ..wave
    };
    let flaws = Flaws::white(2e-4);
    // By 0.01 a_A a window, up and down, as a control loop may do.
    let found = identify_changed(wave, &flaws, windows(10), 60_000, 1, |k, [c, d]| {
        let time = k as f64 / RATE;
        let share = 0.5 + 0.4 * (12.0 * time).sin();
        let (one, none) = (full.pick_offs(time), wave.pick_offs(time));
        [
            c + share * (one[0] - none[0]),
            d + share * (one[1] - none[1]),
        ]
    });
    assert!(found.len() > 300);
    for estimate in &found {
        assert!(estimate.flags.is_empty(), "{estimate:?}");
    }
}

#[test]
fn a_small_turn_within_a_long_window_is_flagged() {
    // The residual as a whole hardly rises, no amplitude grows, and no block is an outlier.
    for (noise, turn) in [(0.002, 0.002), (0.02, 0.02), (0.02, -0.02)] {
        for seed in 0..10 {
            let wave = random_wave(seed, 5332.0, 0.1);
            let to = Wave {
                angle: wave.angle + turn,
                ..wave
            };
            let flaws = Flaws::white(noise * wave.main_amplitude);
            let (one, two) = (
                stream(wave, flaws.clone(), 15_000, seed),
                stream(to, flaws, 20_000, seed),
            );
            let at = 53 + 950 * 15 + 475;
            let found = identify_parts(&[&one[..at], &two[at..]], windows(50));
            assert!(found.len() > 16, "{}", found.len());
            for (i, estimate) in found.iter().enumerate() {
                let is_told = estimate.flags.contains(Flags::MISFIT);
                assert_eq!(is_told, i == 15, "{turn} rad, seed {seed}: {estimate:?}");
            }
        }
    }
}

#[test]
fn a_step_of_the_angle_does_not_spoil_the_frequencies_after_it() {
    // With quadrature a turning pattern looks like another frequency, and a step looks like a turn.
    for turn in [0.01, 0.02, 0.05] {
        let (mut square, mut count) = (0.0, 0.0);
        for seed in 0..20 {
            let wave = random_wave(seed, 5332.0, 0.1);
            let wave = Wave {
                quadrature_amplitude: 0.6 * wave.main_amplitude,
                ..wave
            };
            let to = Wave {
                angle: wave.angle + turn,
                ..wave
            };
            let found = stepped(wave, to, flaws(&wave), seed);
            for estimate in &found[BEFORE + 1..BEFORE + 7] {
                square += (errors(estimate, &to)[3] / stated(estimate)[3]).powi(2);
                count += 1.0;
            }
        }
        let ratio = f64::sqrt(square / count);
        assert!((0.85..1.2).contains(&ratio), "{turn} rad: {ratio}");
    }
}

#[test]
fn a_drift_of_the_offset_before_a_search_does_not_excuse_a_step_after_it() {
    for seed in 0..5 {
        let wave = random_wave(seed, 5332.0, 0.3);
        let a = wave.main_amplitude;
        let settings = Settings {
            frequency: Some(5332.0),
            ..windows(10)
        };
        let flaws = Flaws::white(0.01 * a);
        let pairs = stream(wave, flaws, 12_000, seed);
        let mut core = Core::new(settings).unwrap();
        let length = pairs.iter().find_map(|&pair| core.push(pair)).unwrap();
        let length = length.samples as usize;
        // Until the search by so much a window, then once by as much between two windows.
        let (search, moved) = (50 * length, 0.02 * a);
        let offset = |k: usize| {
            let wandered = k.min(search) as f64 / length as f64;
            let stepped = if k < search + length { 0.0 } else { 1.0 };
            moved * (wandered + stepped)
        };
        let mut core = Core::new(settings).unwrap();
        let mut found = Vec::new();
        for (k, [c, d]) in pairs.into_iter().enumerate() {
            if k == search {
                core.search();
            }
            found.extend(core.push([c + offset(k) as f32, d]));
        }
        let before = found.iter().take(50);
        assert!(before.skip(2).all(|e| e.flags.is_empty()), "{seed}");
        let at = (search + length) as u64;
        let after = found.iter().find(|e| e.start == at).unwrap();
        assert_eq!(after.flags, Flags::STEP, "{seed}");
    }
}

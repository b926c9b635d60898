//! After a loss, a skip or a change of settings: flags of the next windows, and what they keep from those before.

use std::f64::consts::FRAC_PI_2;

use antinode::{Calibration, Estimate, Flags, Front, Settings, Tracker};
use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::score::errors;
use host_tests::{Core, RATE, gyro, identify_changed, identify_parts, stream, windows};

#[test]
fn reacquired_in_a_misfit_is_flagged_again_with_the_first_row_without_misfit() {
    // The frequency is known: the first window is the one in which the wave comes back at another angle.
    let settings = Settings {
        frequency: Some(5332.0),
        ..windows(10)
    };
    let wave = Wave {
        main_amplitude: 0.5,
        ..Wave::default()
    };
    let turned = Wave {
        angle: wave.angle + 2.0,
        ..wave
    };
    let mut misfits = 0;
    for onset in (20_000..20_190).step_by(10) {
        let mut core = Core::new(settings).unwrap();
        let mut found = Vec::new();
        for k in 0..24_000u32 {
            let noise = 1e-4 * f64::from(k.wrapping_mul(0x9e37_79b9)) / 2f64.powi(32);
            let [c, d] = if k < 10_000 {
                wave.pick_offs(f64::from(k) / RATE)
            } else if k < onset {
                [0.0; 2]
            } else {
                turned.pick_offs(f64::from(k) / RATE)
            };
            found.extend(core.push([(c + noise) as f32, (d - noise) as f32]));
        }
        let mut again = found.iter().filter(|e| e.end() > u64::from(onset));
        let is_misfit = |e: &&Estimate| e.flags.contains(Flags::MISFIT);
        misfits += again.clone().take_while(is_misfit).count();
        let first = again.find(|e| !is_misfit(e)).unwrap().flags;
        assert_eq!(first, Flags::REACQUIRED, "{onset}");
        assert!(again.all(|e| e.flags.is_empty()), "{onset}");
    }
    assert!(misfits > 0);
}

#[test]
fn a_wave_that_comes_back_is_reacquired_once_and_its_angle_continued() {
    // Silence of both pick-offs for 0.1 s, in a pattern whose angle has run over several quarter turns.
    for seed in 0..5 {
        let wave = Wave {
            angle_rate: 8.0,
            ..random_wave(seed, 5332.0, 0.3)
        };
        let flaws = Flaws::white(0.002 * wave.main_amplitude);
        let found = identify_changed(wave, &flaws, windows(10), 150_000, seed, |k, pair| {
            if (90_000..100_000).contains(&k) {
                [0.0; 2]
            } else {
                pair
            }
        });
        let back = found.iter().position(|e| e.start >= 100_000).unwrap();
        let (before, after) = found.split_at(back);
        assert!(after[0].flags.contains(Flags::REACQUIRED), "{:?}", after[0]);
        assert!(after.len() > 200 && after[1..].iter().all(|e| e.flags.is_empty()));
        // Nearest to the last known angle.
        let last = before.iter().rev().find(|e| e.flags.is_empty()).unwrap();
        let apart = (after[0].angle - last.angle).abs();
        assert!(apart < 0.5 * FRAC_PI_2 + 0.05, "seed {seed}: {apart}");
        assert!((last.angle - found[0].angle).abs() > 6.0);
    }
}

/// Runs pairs through a front and a tracker that keep one wave.
fn follow(
    front: &mut Front<f32, 200>,
    tracker: &mut Tracker<16>,
    pairs: &[[f32; 2]],
) -> Vec<Estimate> {
    let mut found = Vec::new();
    front.extend(pairs, |block| found.extend(tracker.push(block)));
    found
}

#[test]
fn a_changed_calibration_applies_from_the_next_window_on() {
    let wave = Wave {
        angle: 0.3,
        ..Wave::default()
    };
    let flaws = Flaws {
        gain_ratio: 1.2,
        noise: 1e-3,
        ..Flaws::default()
    };
    let pairs = stream(wave, flaws, 20_000, 1);
    let settings = Settings {
        start_angle: 7.0,
        ..windows(10)
    };
    let (mut front, mut tracker) = (
        Front::new(settings).unwrap(),
        Tracker::new(settings).unwrap(),
    );
    let before = follow(&mut front, &mut tracker, &pairs[..10_000]);
    let unusable = Calibration {
        gain_ratio: 0.0,
        ..Calibration::IDEAL
    };
    assert!(tracker.calibrate(unusable).is_err());
    tracker
        .calibrate(Calibration {
            gain_ratio: 1.2,
            ..Calibration::IDEAL
        })
        .unwrap();
    let after = follow(&mut front, &mut tracker, &pairs[10_000..]);
    assert!(before.len() > 40 && after.len() > 40);
    assert!(before.iter().all(|e| errors(e, &wave)[2].abs() > 0.03));
    assert_eq!(after[0].flags, Flags::REACQUIRED);
    assert!(after[0].start >= 10_000 - 38);
    for estimate in &after {
        let [main, quadrature, angle, _] = errors(estimate, &wave);
        assert!(
            main.abs() < 1e-3 && quadrature.abs() < 1e-3 && angle.abs() < 1e-3,
            "{estimate:?}"
        );
        assert!((estimate.angle - before[0].angle).abs() < 0.1);
    }
    assert!(after[1..].iter().all(|e| e.flags.is_empty()));
}

#[test]
fn a_tracker_that_has_lost_its_wave_wants_a_search_and_rejects_blocks_of_the_old_one() {
    let (wave, flaws) = gyro(2);
    let mut pairs = stream(wave, flaws, 10_000, 2);
    let (mut front, mut tracker) = (
        Front::new(windows(10)).unwrap(),
        Tracker::new(windows(10)).unwrap(),
    );
    assert!(follow(&mut front, &mut tracker, &pairs).len() > 40);
    assert_eq!(tracker.wanted_search(), 0);
    // One window without a wave is no loss, nor are two that are not successive; windows have the same place relative to each silence.
    let silence = vec![[0.0; 2]; 285];
    for _ in 0..8 {
        let mut found = follow(&mut front, &mut tracker, &silence);
        found.extend(follow(&mut front, &mut tracker, &pairs[..1805]));
        assert!(found.iter().any(|e| e.flags.contains(Flags::LOST)));
        assert_eq!(tracker.wanted_search(), 0);
    }
    follow(&mut front, &mut tracker, &vec![[0.0; 2]; 800]);
    assert_eq!(tracker.wanted_search(), 1);
    assert!(follow(&mut front, &mut tracker, &pairs).is_empty());
    assert_eq!(tracker.wanted_search(), 1);
    assert!(front.search_if_wanted(1) && front.is_searching());
    assert!(!front.search_if_wanted(1));
    pairs.truncate(5000);
    let again = follow(&mut front, &mut tracker, &pairs);
    assert_eq!(again[0].flags, Flags::REACQUIRED);
    assert!(again.len() > 20 && again[1..].iter().all(|e| e.flags.is_empty()));
}

#[test]
fn pairs_lost_during_a_search_restart_it() {
    // Half a period is lost after one and a half: earlier samples have another phase.
    for lost in [5usize, 10] {
        let wave = random_wave(4, 5332.0, 0.3);
        let pairs = stream(wave, Flaws::default(), 3000, 4);
        let mut core = Core::new(windows(5)).unwrap();
        let mut found = Vec::new();
        core.extend(&pairs[..28], |e| found.push(e));
        assert!(core.is_searching());
        core.skip(lost as u64);
        core.extend(&pairs[28 + lost..], |e| found.push(e));
        // As if the stream had begun there.
        let wanted = identify_parts(&[&pairs[28 + lost..]], windows(5));
        let values = |e: &Estimate| (e.main_amplitude, e.angle, e.frequency, e.flags);
        assert_eq!(
            found.iter().map(values).collect::<Vec<_>>(),
            wanted.iter().map(values).collect::<Vec<_>>()
        );
        assert_eq!(found[0].start, wanted[0].start + 28 + lost as u64);
    }
}

#[test]
fn a_wave_with_a_leap_of_its_frequency_is_found_again() {
    // The last three look like a poor wave of the old frequency in some windows, but not in all.
    let near = [4000.0, 5400.0, 5550.0, 6400.0];
    let near = [2, 5, 10, 50]
        .into_iter()
        .flat_map(|n| near.map(|f| (n, f)));
    let far = [(10, 8018.73), (5, 11_441.0), (5, 16_323.0)];
    for (periods, frequency) in near.chain(far) {
        let (wave, flaws) = gyro(41);
        let other = Wave { frequency, ..wave };
        let (one, two) = (
            stream(wave, flaws.clone(), 20_000, 1),
            stream(other, flaws, 60_000, 1),
        );
        let found = identify_parts(&[&one, &two[20_000..]], windows(periods));
        let is_right = |e: &Estimate| (e.frequency - frequency).abs() < 0.01 * frequency;
        let clean = found
            .iter()
            .filter(|e| e.start > 20_000 && e.flags.is_empty());
        assert!(
            clean.clone().all(is_right),
            "{periods} periods, {frequency} Hz"
        );
        let late = clean
            .map(|e| (e.start - 20_000) / (19 * u64::from(periods)))
            .next();
        assert!(
            late.is_some_and(|late| late < 20),
            "{periods} periods, {frequency} Hz: after {late:?} windows"
        );
    }
}

#[test]
fn a_wave_that_leaps_to_a_frequency_hardly_seen_by_blocks_is_found_again() {
    // At these multiples of the frequency blocks show a tenth of the wave, as of a steady wave in much noise.
    for (periods, period, times) in [(20, 72.3, 1.56), (10, 46.43, 1.591), (10, 75.0, 1.44)] {
        for seed in 0..5 {
            let wave = random_wave(seed, RATE / period, 0.3);
            let flaws = Flaws::white(3e-3 * wave.main_amplitude);
            let frequency = times * wave.frequency;
            let other = Wave { frequency, ..wave };
            let at = (12.3 * period * f64::from(periods)) as usize;
            let (one, two) = (
                stream(wave, flaws.clone(), at, seed),
                stream(other, flaws, 4 * at, seed),
            );
            let found = identify_parts(&[&one, &two[at..]], windows(periods));
            let mut after = found
                .iter()
                .filter(|e| e.start > at as u64 && e.flags.is_empty())
                .peekable();
            let late = after.peek().map(|e| e.start - at as u64);
            assert!(
                late.is_some_and(|late| late < at as u64),
                "{times} times, seed {seed}: after {late:?} pairs"
            );
            for estimate in after {
                assert!(
                    (estimate.frequency - frequency).abs() < 0.01 * frequency,
                    "{times} times, seed {seed}: {estimate:?}"
                );
            }
        }
    }
}

#[test]
fn a_front_that_is_configured_during_a_search_forgets_its_samples() {
    let pairs = stream(random_wave(4, 5332.0, 0.3), Flaws::default(), 3000, 4);
    let run = |front: &mut Front<f32, 200>, from: usize| {
        let mut tracker = Tracker::new(windows(10)).unwrap();
        let found = follow(front, &mut tracker, &pairs[from..]);
        let values = |e: &Estimate| (e.main_amplitude, e.angle, e.frequency, e.flags);
        found.iter().map(values).collect::<Vec<_>>()
    };
    let wanted = run(&mut Front::new(windows(10)).unwrap(), 37);
    assert!(wanted.len() > 10);
    // Before there is a candidate, and while one is on trial.
    for seen in 20.. {
        let mut front = Front::new(windows(10)).unwrap();
        let _ = front.push_slice(&pairs[..seen]);
        if !front.is_searching() {
            assert!(seen > 40);
            break;
        }
        front.configure(windows(10)).unwrap();
        assert_eq!(run(&mut front, 37), wanted, "{seen}");
    }
}

#[test]
fn blocks_of_another_layout_begin_a_new_window() {
    let (mut front, mut tracker) = (
        Front::new(windows(10)).unwrap(),
        Tracker::new(windows(10)).unwrap(),
    );
    for (frequency, flag) in [(5332.0, Flags::empty()), (9000.0, Flags::REACQUIRED)] {
        let pairs = stream(random_wave(4, frequency, 0.3), Flaws::default(), 5000, 4);
        front.search();
        let found = follow(&mut front, &mut tracker, &pairs);
        assert!(found.len() > 20 && found[0].flags == flag);
        for estimate in &found {
            assert!((estimate.frequency - frequency).abs() < 0.01);
        }
        assert!(found[1..].iter().all(|e| e.flags.is_empty()));
    }
}

#[test]
fn a_watch_that_is_switched_on_in_place_works() {
    let wave = Wave {
        angle: 0.3,
        ..Wave::default()
    };
    let flaws = Flaws {
        noise: 0.002,
        clip: Some(1.2),
        ..Flaws::default()
    };
    let pairs = stream(wave, flaws, 10_000, 1);
    let blind = Settings {
        watch: false,
        ..windows(10)
    };
    let (mut front, mut tracker) = (Front::new(blind).unwrap(), Tracker::new(blind).unwrap());
    for (settings, is_watched) in [(blind, false), (windows(10), true), (blind, false)] {
        front.configure(settings).unwrap();
        tracker.configure(settings).unwrap();
        front.search_if_wanted(tracker.wanted_search());
        let found = follow(&mut front, &mut tracker, &pairs);
        let clipped = found.iter().filter(|e| e.flags.contains(Flags::CLIPPED));
        assert!(found.len() > 40);
        assert_eq!(clipped.count(), if is_watched { found.len() } else { 0 });
    }
}

#[test]
fn a_glitch_in_overlapping_windows_is_no_lost_wave() {
    // It lies in fifty windows, in which it is larger than the wave.
    for seed in 0..20 {
        let settings = Settings {
            hop: Some(1),
            ..windows(50)
        };
        let (wave, flaws) = gyro(seed);
        let size = 40.0 * wave.main_amplitude;
        let found = identify_changed(wave, &flaws, settings, 12_000, seed, |k, [c, d]| {
            let is_glitch = (6000..6003).contains(&k);
            if is_glitch {
                [c + size, d - size]
            } else {
                [c, d]
            }
        });
        let hops = found.windows(2).map(|pair| pair[1].start - pair[0].start);
        assert!(hops.max() <= Some(19), "seed {seed}: rows are missing");
        let told = found.iter().filter(|e| !e.flags.is_empty());
        assert!(
            told.clone()
                .all(|e| e.start <= 6002 && e.end() > 6000 && e.flags.contains(Flags::MISFIT))
        );
        assert!(told.count() >= 49, "seed {seed}");
    }
}

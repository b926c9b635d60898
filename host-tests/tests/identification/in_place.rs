//! Settings that change in place: nothing else changes with them, and what begins anew is as new.

use antinode::{Calibration, Detection, Estimate, Flags, Front, Settings, Tracker};
use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::{Core, RATE, no_wave, stream, windows};

#[test]
fn a_tracker_without_settings_finds_nothing_and_with_them_it_is_as_new() {
    let wave = random_wave(3, 5332.0, 0.5);
    let pairs = stream(wave, Flaws::default(), 6000, 3);
    let mut front = Front::<f32, 200>::new(windows(5)).unwrap();
    let mut blocks = Vec::new();
    front.extend(&pairs, |block| blocks.push(*block));
    let estimates = |tracker: &mut Tracker<16>| -> Vec<Estimate> {
        let pushed = blocks.iter().filter_map(|block| tracker.push(block));
        pushed.collect()
    };
    let mut tracker = Tracker::UNSET;
    assert_eq!(estimates(&mut tracker), []);
    assert!(tracker.wanted_search() == 0 && !tracker.has_wave());
    tracker.configure(windows(5)).unwrap();
    assert_eq!(*tracker.settings(), windows(5));
    let found = estimates(&mut tracker);
    assert!(found.len() > 40);
    assert_eq!(found, estimates(&mut Tracker::new(windows(5)).unwrap()));
}

#[test]
fn a_change_keeps_all_other_settings() {
    let mut core = Core::new(windows(5)).unwrap();
    let changed = Settings {
        periods: 7,
        ..*core.settings()
    };
    core.change(changed).unwrap();
    assert_eq!(*core.settings(), windows(7));
}

#[test]
fn a_configuration_in_place_gives_what_a_new_start_gives() {
    let wave = random_wave(7, 5332.0, 0.4);
    let flaws = Flaws::white(0.01);
    let pairs = stream(wave, flaws, 8000, 7);
    let run = |front: &mut Front<f32, 200>, tracker: &mut Tracker<40>| {
        let mut found = Vec::new();
        front.search_if_wanted(tracker.wanted_search());
        front.extend(&pairs, |block| {
            let estimate = tracker.push(block);
            found.extend(estimate.map(|e| (e.main_amplitude, e.angle, e.frequency, e.flags)));
        });
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
    // Blocks of a front that has not been configured yet are left out.
    front.clone().extend(&pairs, |block| {
        assert_eq!(tracker.push(block), None);
    });
    let changed = run(&mut front, &mut tracker);
    assert_eq!(front.index(), 16_000);
    let (mut front, mut tracker) = (Front::new(second).unwrap(), Tracker::new(second).unwrap());
    assert_eq!(run(&mut front, &mut tracker), changed);
    assert!(first.len() > 60 && changed.len() > 100);
}

#[test]
fn an_identifier_takes_a_calibration_and_settings_while_it_runs() {
    let wave = Wave::default();
    let calibration = Calibration {
        gain_ratio: 1.1,
        ..Calibration::IDEAL
    };
    let flaws = Flaws {
        gain_ratio: 1.1,
        noise: 0.001,
        ..Flaws::default()
    };
    let pairs = stream(wave, flaws, 3_000, 2);
    let mut core = Core::new(windows(5)).unwrap();
    let run = |core: &mut Core| {
        let mut found = Vec::new();
        core.extend(&pairs, |estimate| found.push(estimate));
        found
    };
    let (raw, ideal) = (run(&mut core), wave.main_amplitude as f32);
    assert!((raw[5].main_amplitude - ideal).abs() > 0.05);
    assert!(
        core.calibrate(Calibration {
            gain_ratio: 0.0,
            ..calibration
        })
        .is_err()
    );
    core.calibrate(calibration).unwrap();
    assert!(!core.is_searching() && core.has_wave());
    let calibrated = run(&mut core);
    assert!(calibrated[0].flags.contains(Flags::REACQUIRED));
    assert!((calibrated[5].main_amplitude - ideal).abs() < 0.01);
    // The calibration is one of the settings.
    assert!(core.configure(windows(1)).is_err() && !core.is_searching());
    core.configure(windows(20)).unwrap();
    assert!(core.is_searching() && core.index() == 6_000);
    let changed = run(&mut core);
    assert!(changed[0].start > 6_000 && changed[0].samples > 370);
    assert!((changed[2].main_amplitude - ideal).abs() > 0.05);
    // Without settings nothing is found; with them the identifier is as new.
    let mut core = Core::UNSET;
    assert!(run(&mut core).is_empty() && !core.is_searching());
    core.configure(windows(20)).unwrap();
    let found = run(&mut core);
    assert_eq!(found.len(), changed.len());
    for (found, changed) in found.iter().zip(&changed) {
        assert_eq!(found.start + 3_000, changed.start);
        assert_eq!(found.main_amplitude, changed.main_amplitude);
        assert_eq!(found.flags, changed.flags);
    }
}

#[test]
fn a_configuration_in_place_forgets_that_the_pattern_vibrated() {
    // By 5 rad/s at 20 Hz: deviations of the frequency allow for an unknown rate then.
    let noise = stream(no_wave(), Flaws::white(1e-3), 20_000, 7);
    let pairs: Vec<[f32; 2]> = (0..)
        .zip(noise)
        .map(|(k, [c, d])| {
            let time = f64::from(k) / RATE;
            let wave = Wave {
                main_amplitude: 1.0,
                quadrature_amplitude: 0.6,
                angle: 0.3 + 0.04 * (std::f64::consts::TAU * 20.0 * time).sin(),
                ..Wave::default()
            };
            let [of_c, of_d] = wave.pick_offs(time);
            [c + of_c as f32, d + of_d as f32]
        })
        .collect();
    let run = |core: &mut Core| {
        let mut found = Vec::new();
        core.extend(&pairs, |e| {
            found.push((e.frequency, e.frequency_std, e.angle, e.flags));
        });
        found
    };
    let mut core = Core::new(windows(10)).unwrap();
    let new = run(&mut core);
    let deviation = |from: usize| new[from..from + 10].iter().map(|e| e.1).sum::<f32>() / 10.0;
    assert!(new.len() > 100 && deviation(90) > 1.4 * deviation(1));
    core.configure(windows(10)).unwrap();
    assert_eq!(run(&mut core), new);
}

#[test]
fn after_a_change_at_a_known_frequency_a_window_begins_at_once() {
    let wave = Wave::default();
    let known = Settings {
        frequency: Some(wave.frequency as f32),
        ..windows(10)
    };
    let pairs = stream(wave, Flaws::white(0.001), 10_000, 2);
    let mut core = Core::new(known).unwrap();
    core.extend(&pairs, |_| {});
    core.change(Settings {
        periods: 20,
        ..known
    })
    .unwrap();
    let mut found = Vec::new();
    core.extend(&pairs, |estimate| found.push(estimate));
    assert_eq!(found[0].start, 10_000);
}

//! The paper's four methods beside every estimate.

use std::f64::consts::TAU;

use antinode::{Estimate, Flags, Front, Tracker};
use antinode_sim::{Dropout, DropoutKind, Flaws, Wave};
use antinode_telemetry::{Command, FrontEnd, Methods, Report};
use firmware::methods::{Gathering, History, Tuning};
use firmware::sampling::DUAL_ADC_RAILS;
use firmware::settings::{LONGEST_PERIOD, RING, configuration};
use host_tests::RATE;

use crate::board::{BYTES, board, windows_of};
use crate::emulator::{Device, bytes};
use crate::told::estimates;
use crate::{mirror, recordings};

fn methods(reports: &[Report]) -> Vec<Methods> {
    let found = |report: &Report| match report {
        Report::Methods(methods) => Some(*methods),
        _ => None,
    };
    reports.iter().filter_map(found).collect()
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn methods_come_with_their_windows() {
    for (name, recording) in recordings::all().into_iter().take(4) {
        let command = bytes(3, Command::SetMethods { on: true });
        let mut device = Device::start("replay", &recording, "hold=1");
        device.send(&command);
        let (reports, lost, took) = device.finish();
        assert_eq!(lost, 0, "{name}");
        let (windows, methods) = (estimates(&reports), methods(&reports));
        println!(
            "{name}: {} windows, {} methods, {} disagree, {took:.1} s",
            windows.len(),
            methods.len(),
            methods.iter().filter(|m| m.disagree).count()
        );
        // All windows except those before the sums were tuned to the wave.
        assert!(
            methods.len() + 60 > windows.len(),
            "{name}: {} of {}",
            methods.len(),
            windows.len()
        );
        assert!(!methods.iter().any(|m| m.disagree), "{name}");
        for m in &methods {
            let e = windows
                .iter()
                .find(|e| e.start == m.start)
                .expect("its window");
            // Algorithms 2 and 4 include quadrature, and a window that does not fit the period costs them only leakage.
            let size = f64::from(e.main_amplitude);
            for method in [&m.methods[1], &m.methods[3]] {
                assert!(
                    (method.main_amplitude - size).abs()
                        < 0.02 * size + 8.0 * f64::from(e.main_amplitude_std),
                    "{name}: {m:?}, {e:?}"
                );
                assert!(
                    (method.angle - e.angle).abs() < 0.02 + 8.0 * f64::from(e.angle_std),
                    "{name}: {m:?}, {e:?}"
                );
            }
            let mut ranks = m.methods.map(|method| method.rank);
            ranks.sort_unstable();
            assert_eq!(ranks, [1, 2, 3, 4], "{name}");
        }
        let host = mirror::reports::<i16>(&recording, &command, 1);
        assert!(
            methods == self::methods(&host),
            "{name}: the emulator and the host differ"
        );
    }
}

#[test]
fn the_first_window_after_a_tuning_is_compared_once_its_sums_are_complete() {
    let recording = recordings::codes(recordings::WAVE, recordings::quiet(), 50_000);
    // A window begins with every block: the first one with sums in all its blocks counts too.
    let mut commands = bytes(1, Command::SetHop { blocks: Some(1) });
    commands.extend(bytes(2, Command::SetMethods { on: true }));
    let methods = methods(&mirror::reports::<i16>(&recording, &commands, 1));
    assert!(methods.len() > 1000, "{}", methods.len());
    let disagree = methods.iter().filter(|m| m.disagree).count();
    assert_eq!(disagree, 0, "of {}", methods.len());
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn methods_are_off_by_default_and_can_be_switched_off_again() {
    let recording = recordings::codes(recordings::WAVE, recordings::quiet(), 50_000);
    let mut device = Device::start("replay", &recording, "hold=2");
    device.command(1, Command::SetMethods { on: true });
    device.command(2, Command::SetMethods { on: false });
    let (reports, ..) = device.finish();
    assert!(methods(&reports).is_empty() && estimates(&reports).len() > 200);
}

#[test]
fn a_tuning_serves_while_offsets_and_frequency_stay_within_their_noise() {
    let recording = recordings::codes(recordings::WAVE, recordings::quiet(), 5000);
    let found = estimates(&mirror::reports::<i16>(&recording, &[], 1))[10];
    let tuning = Tuning::of(&found, RATE);
    let root = f64::from(found.samples).sqrt();
    let offset = 7.0 * found.residual_rms / root as f32;
    let turn = TAU * f64::from(found.samples) / RATE;
    let frequency = 0.01 / turn + 7.0 * f64::from(found.frequency_std);
    for (share, serves) in [
        (0.0, true),
        (0.9, true),
        (-0.9, true),
        (1.1, false),
        (-1.1, false),
    ] {
        let [c, d] = found.offsets;
        let by = share as f32 * offset;
        for offsets in [[c + by, d], [c, d + by]] {
            let other = Estimate { offsets, ..found };
            assert_eq!(tuning.serves(&other, RATE), serves, "{share}");
        }
        let other = Estimate {
            frequency: found.frequency + share * frequency,
            ..found
        };
        assert_eq!(tuning.serves(&other, RATE), serves, "{share}");
    }
    // A frequency that is hardly known: a quarter period is 5 samples, then 6 and 9.
    for (share, serves) in [(0.8, true), (0.5, false)] {
        let other = Estimate {
            frequency: share * found.frequency,
            frequency_std: 1e6,
            ..found
        };
        assert_eq!(tuning.serves(&other, RATE), serves, "{share}");
    }
}

#[test]
fn the_methods_are_tuned_again_to_a_frequency_that_drifts() {
    let wave = Wave {
        frequency_rate: 100.0,
        ..recordings::WAVE
    };
    let recording = recordings::codes(wave, recordings::quiet(), 100_000);
    let on = bytes(1, Command::SetMethods { on: true });
    let methods = methods(&mirror::reports::<i16>(&recording, &on, 1));
    assert!(methods.len() > 400, "{}", methods.len());
    let disagree = methods.iter().filter(|m| m.disagree).count();
    assert_eq!(disagree, 0, "of {}", methods.len());
}

#[test]
fn a_window_without_a_wave_is_not_compared() {
    let flaws = Flaws {
        dropouts: vec![Dropout {
            from: 0.2,
            to: 0.25,
            kind: DropoutKind::NoiseOnly,
            channel: None,
        }],
        ..recordings::quiet()
    };
    let recording = recordings::codes(recordings::WAVE, flaws, 40_000);
    let on = bytes(1, Command::SetMethods { on: true });
    let reports = mirror::reports::<i16>(&recording, &on, 1);
    let lost: Vec<_> = estimates(&reports)
        .iter()
        .filter(|estimate| estimate.flags.contains(Flags::LOST))
        .map(|estimate| estimate.start)
        .collect();
    assert!(!lost.is_empty());
    let methods = methods(&reports);
    assert!(methods.len() > 100, "{}", methods.len());
    assert!(methods.iter().all(|methods| !lost.contains(&methods.start)));
}

#[test]
fn methods_are_told_and_come_again_after_they_were_off() {
    let mut told = Vec::new();
    board(windows_of(10, None), |board| {
        board.wire.pass(100 * BYTES);
        let id = board.half as u16;
        if matches!(id, 100 | 200 | 300) {
            board.command(id, Command::SetMethods { on: id != 200 });
        }
        told.clear();
        for report in &board.wire.reports {
            match (report, told.last_mut()) {
                (Report::Hello(hello), _) => told.push((hello.configuration.methods, 0)),
                (Report::Methods(_), Some((_, count))) => *count += 1,
                _ => {}
            }
        }
        board.half < 400
    });
    let expected = [false, true, false, true];
    assert!(told.iter().map(|&(on, _)| on).eq(expected), "{told:?}");
    assert!(
        told.iter()
            .all(|&(on, count)| if on { count > 50 } else { count == 0 }),
        "{told:?}"
    );
}

#[test]
fn sums_of_different_tunings_are_not_compared() {
    let recording = recordings::codes(recordings::WAVE, recordings::quiet(), 5000);
    let settings = configuration(FrontEnd::Synthetic, DUAL_ADC_RAILS).settings;
    let mut front = Front::<i16, LONGEST_PERIOD>::new(settings).expect("the settings can be");
    let mut tracker = Tracker::<RING>::new(settings).expect("the settings can be");
    let found = estimates(&mirror::reports::<i16>(&recording, &[], 1))[10];
    let other = Estimate {
        offsets: [0.0; 2],
        ..found
    };
    let mut gatherings = [found, other].map(|estimate| {
        let mut gathering = Gathering::new();
        gathering.tune(Some(Tuning::of(&estimate, RATE)));
        gathering
    });
    // Of the first tuning, of the second, and of both in turn.
    let mut histories = [(); 3].map(|()| History::<i16>::new());
    let mut rest = recording.as_slice();
    let mut count = 0;
    while !rest.is_empty() {
        let (taken, block) = front.push_slice(rest);
        let (done, after) = rest.split_at(taken);
        rest = after;
        let [first, second] = gatherings
            .each_mut()
            .map(|gathering| gathering.add(done, block));
        let Some(block) = block else { continue };
        count += 1;
        let mixed = if count % 2 == 0 { &first } else { &second };
        histories[0].keep(&first);
        histories[1].keep(&second);
        histories[2].keep(mixed);
        if let Some(estimate) = tracker.push(block).filter(|_| count > 20) {
            let compared = histories
                .each_ref()
                .map(|history| history.compare(&estimate, RATE).is_some());
            assert_eq!(compared, [true, true, false]);
        }
    }
    assert!(count > 100);
}

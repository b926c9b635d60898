//! Commands over the emulated line.

use antinode::{Calibration, Flags, SettingsError};
use antinode_telemetry::{Acknowledgement, Cause, Command, CommandError, Report, State};
use firmware::settings::{LONGEST_PERIOD, RING};

use crate::emulator::{Device, bytes};
use crate::same::timeless;
use crate::told::{acknowledgements, counters, estimates};
use crate::{mirror, recordings};

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn settings_are_changed_or_refused() {
    let recording = recordings::codes(recordings::WAVE, recordings::quiet(), 50_000);
    let calibration = Calibration {
        gain_ratio: 1.05,
        skew: 20e-9,
        pick_off_angle: 0.01,
    };
    let refused = |error| Err(CommandError::Settings(error));
    let most = RING as u16 - 2;
    let script = [
        (Command::SetWindow { periods: 20 }, Ok(())),
        (Command::SetHop { blocks: Some(5) }, Ok(())),
        (Command::SetCalibration(calibration), Ok(())),
        (
            Command::SetFrequency {
                hertz: Some(5250.0),
            },
            Ok(()),
        ),
        (Command::SetHum { on: true }, Ok(())),
        (Command::SetColoured { on: true }, Ok(())),
        (
            Command::SetFrequency { hertz: Some(400.0) },
            refused(SettingsError::FrequencyTooLow {
                frequency: 400.0,
                most: LONGEST_PERIOD as u16,
            }),
        ),
        (
            Command::SetWindow { periods: 99 },
            refused(SettingsError::PeriodsTooMany { periods: 99, most }),
        ),
        (
            Command::SetHop { blocks: Some(0) },
            refused(SettingsError::Hop),
        ),
        (
            Command::SetMethods { on: true },
            Err(CommandError::Calibrated),
        ),
        (Command::Get, Ok(())),
    ];
    let commands: Vec<u8> = (0..)
        .zip(&script)
        .flat_map(|(id, (command, _))| bytes(id, *command))
        .collect();
    let mut device = Device::start("replay", &recording, &format!("hold={}", script.len()));
    device.send(&commands);
    let (reports, lost, _) = device.finish();
    assert_eq!(lost, 0);
    let answers: Vec<_> = acknowledgements(&reports)
        .iter()
        .map(|a| a.result)
        .collect();
    assert_eq!(answers, script.map(|(_, result)| result));
    assert!(estimates(&reports).iter().all(|e| e.samples > 300));
    // The round in which the first state comes depends on how the line's bytes fall; all else is the same to the bit.
    let settled = |reports: &[Report]| {
        let tracking = |r: &Report| matches!(r, Report::State(State::Tracking));
        let at = reports.iter().position(tracking).expect("it tracks");
        timeless(&reports[at..])
    };
    assert!(settled(&reports) == settled(&mirror::reports::<i16>(&recording, &commands, 1)));
    let hello = |report: &Report| match report {
        Report::Hello(hello) => Some(hello.configuration.settings),
        _ => None,
    };
    let last = reports.iter().filter_map(hello).next_back().expect("one");
    assert_eq!(
        (last.periods, last.hop, last.calibration),
        (20, Some(5), calibration)
    );
    assert_eq!(
        (last.frequency, last.hum, last.coloured),
        (Some(5250.0), true, true)
    );
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn the_window_changes_while_the_device_runs() {
    let recording = recordings::codes(recordings::WAVE, recordings::quiet(), 1_000_000);
    let mut device = Device::start("replay", &recording, "");
    assert!(device.read_until(|reports| estimates(reports).len() > 100));
    device.command(7, Command::SetWindow { periods: 20 });
    let (reports, lost, _) = device.finish();
    assert_eq!(lost, 0);
    let answer = Acknowledgement {
        id: 7,
        result: Ok(()),
    };
    assert_eq!(acknowledgements(&reports), [answer]);
    let at = reports
        .iter()
        .position(|r| *r == Report::Acknowledgement(answer))
        .expect("it is there");
    let (before, after) = (estimates(&reports[..at]), estimates(&reports[at..]));
    assert!(before.iter().all(|e| e.samples == 190));
    assert!(after.iter().all(|e| e.samples == 380) && after.len() > 100);
    // The count of pairs continues.
    assert!(after[0].start > before[before.len() - 1].start);
    assert_eq!(after[0].flags, Flags::REACQUIRED);
    assert!(after[1..].iter().all(|e| e.flags.is_empty()));
    assert!(
        after
            .iter()
            .all(|e| (e.angle - 0.4).abs() < 6.0 * f64::from(e.angle_std))
    );
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn windows_of_two_periods_lose_no_block() {
    let recording = recordings::codes(recordings::WAVE, recordings::quiet(), 100_000);
    let mut device = Device::start("replay", &recording, "hold=1");
    device.command(1, Command::SetWindow { periods: 2 });
    let (reports, lost, _) = device.finish();
    assert_eq!(lost, 0);
    let dropped = counters(&reports).into_iter().map(|c| c.blocks_dropped);
    assert_eq!(dropped.max(), Some(0));
    assert!(estimates(&reports).len() > 2500);
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn a_restart_is_acknowledged_and_reported_with_its_cause() {
    let recording = recordings::codes(recordings::WAVE, recordings::quiet(), 10_000);
    let mut device = Device::start("replay", &recording, "hold=1");
    device.command(1, Command::Restart);
    let restarted = Report::State(State::Started(Cause::Command));
    assert!(device.read_until(|reports| reports.contains(&restarted)));
    let answer = Acknowledgement {
        id: 1,
        result: Ok(()),
    };
    assert_eq!(acknowledgements(&device.reports), [answer]);
    assert!(estimates(&device.reports).is_empty());
    device.command(2, Command::Get);
    let (reports, lost, _) = device.finish();
    assert_eq!(lost, 0);
    assert!(estimates(&reports).len() > 40);
}

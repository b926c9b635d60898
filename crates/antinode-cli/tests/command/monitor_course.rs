//! `antinode monitor` on what a device does meanwhile: holes too long to count, and restarts.

use std::path::Path;

use crate::common::run_with;
use antinode::{Calibration, Settings};
use antinode_telemetry::*;

/// The bytes of a device between its starts: reports, or how many are missing.
fn wire(sessions: &[&[Result<Report, u32>]]) -> Vec<u8> {
    let (mut wire, mut buffer) = (Vec::new(), [0; MAX_FRAME]);
    for session in sessions {
        let mut reporter = Reporter::new();
        for report in *session {
            match report {
                Ok(report) => wire.extend(reporter.frame(report, &mut buffer).unwrap()),
                Err(missing) => (0..*missing).for_each(|_| reporter.skip()),
            }
        }
    }
    wire
}

/// What a monitor of these tells, without the time that it took.
fn told(sessions: &[&[Result<Report, u32>]]) -> Vec<String> {
    let run = run_with(Path::new("."), "monitor -", wire(sessions));
    assert_eq!(run.code, 0, "{}", run.err);
    let (told, _) = run.err.rsplit_once(" bytes in ").unwrap();
    let (told, _) = told.rsplit_once("; ").unwrap();
    told.lines().map(str::to_owned).collect()
}

const STARTED: Result<Report, u32> = Ok(Report::State(State::Started(Cause::Watchdog)));
const SEARCHING: Result<Report, u32> = Ok(Report::State(State::Searching));

fn counters(seconds: u64) -> Result<Report, u32> {
    Ok(Report::Counters(Counters {
        uptime_ms: 1000 * seconds,
        ..Counters::default()
    }))
}

#[test]
fn reports_missing_in_a_long_hole_are_told_as_at_least_so_many() {
    let told = told(&[&[
        counters(1),
        Err(65_300),
        SEARCHING,
        counters(125),
        Err(3),
        counters(126),
    ]]);
    assert_eq!(
        told,
        [
            "counters: up 1.0 s, 0 sample pairs",
            "state: searching for a wave",
            "lost: 65300 in 124 s, or more by a multiple of 65536, as the reports' numbers begin anew there",
            "counters: up 125.0 s, 0 sample pairs",
            "lost: 3 before the next report",
            "counters: up 126.0 s, 0 sample pairs",
            "standard input: 0 estimates and 4 other reports; at least 65303 lost, 0 damaged",
        ]
    );
}

#[test]
fn reports_missing_where_none_tells_the_time_are_told() {
    let told = told(&[&[SEARCHING, Err(40_000), SEARCHING]]);
    assert_eq!(
        told,
        [
            "state: searching for a wave",
            "state: searching for a wave",
            "lost: 40000 by the reports' numbers, but none of them tells the time: the device may have restarted",
            "standard input: 0 estimates and 2 other reports; at least 0 lost, 0 damaged",
        ]
    );
}

#[test]
fn a_restart_whose_start_is_not_received_is_told_and_costs_no_reports() {
    let told = told(&[
        &[Err(40_000), counters(80)],
        // Hello and the cause of the start.
        &[Err(2), SEARCHING, counters(1)],
    ]);
    assert_eq!(
        told,
        [
            "counters: up 80.0 s, 0 sample pairs",
            "state: searching for a wave",
            "restarted: by its reports' numbers and times the device has begun anew, but its start was not received; reports lost about it \
             are not counted",
            "counters: up 1.0 s, 0 sample pairs",
            "standard input: 0 estimates and 3 other reports; 0 lost, 0 damaged",
        ]
    );
}

fn hello(settings: Settings) -> Result<Report, u32> {
    let configuration = Configuration::new(settings, FrontEnd::DualAdc);
    Ok(Report::Hello(Hello::new("0.1.0", configuration)))
}

/// Warnings of a monitor.
fn warnings(sessions: &[&[Result<Report, u32>]]) -> Vec<String> {
    let mut told = told(sessions);
    told.retain(|line| line.starts_with("warning: "));
    told
}

#[test]
fn settings_that_a_restart_changes_are_warned_of() {
    let built = hello(Settings::new(1e5));
    let commanded = hello(Settings {
        periods: 20,
        hop: Some(5),
        frequency: Some(5332.0),
        hum: true,
        coloured: true,
        calibration: Calibration {
            gain_ratio: 1.02,
            skew: 15e-9,
            ..Calibration::IDEAL
        },
        ..Settings::new(1e5)
    });
    let told = warnings(&[
        &[built.clone(), STARTED, commanded.clone(), SEARCHING],
        &[built.clone(), STARTED, SEARCHING],
        // Nothing differs any more.
        &[built.clone(), STARTED, SEARCHING],
    ]);
    assert_eq!(
        told,
        [
            "warning: since its restart the device has other settings: window 10 periods, no hop, gain ratio 1, skew 0 ns, frequency \
             searched for, no hum, white noise; before: window 20 periods, hop 5 blocks, gain ratio 1.02, skew 15 ns, frequency 5332 Hz, \
             hum, coloured noise; commands last until a reset only: send them again, and do not use rows before and after it together"
        ]
    );
    // The Hello of the start is damaged, and with it the cause of the start; a later one tells.
    for missing in [&[Err(1), STARTED][..], &[Err(2), SEARCHING]] {
        let after = [missing, &[counters(1), built.clone(), SEARCHING]].concat();
        let told = warnings(&[&[commanded.clone(), Err(40_000), counters(80)], &after]);
        assert_eq!(told.len(), 2, "{told:?}");
        assert!(told[0].contains("settings since the restart of the device were not received"));
        assert!(told[1].contains("has other settings: window 10 periods, no hop"));
    }
    // Commands that change settings are no restart, nor is it one to begin with.
    assert_eq!(
        warnings(&[&[built.clone(), commanded.clone(), built]]),
        [""; 0]
    );
    assert_eq!(
        warnings(&[&[commanded.clone(), STARTED], &[commanded, STARTED]]),
        [""; 0]
    );
}

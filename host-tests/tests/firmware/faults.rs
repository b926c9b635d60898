//! Faults are counted and reported, and no wrong estimate is without a flag.

use std::fs;

use antinode::{Estimate, Packed};
use antinode_telemetry::{Cause, Command, Report, State};
use firmware::settings::QUEUE;

use crate::emulator::Device;
use crate::image::output;
use crate::told::{estimates, last_counters};
use crate::{mirror, recordings};

fn steady(pairs: usize) -> Vec<Packed> {
    recordings::codes(recordings::WAVE, recordings::quiet(), pairs)
}

/// Asserts that every window without a flag is right.
fn assert_right(estimates: &[Estimate]) {
    for e in estimates.iter().filter(|e| e.flags.is_empty()) {
        let near = |value: f64, truth: f64, std: f32| (value - truth).abs() < 6.0 * f64::from(std);
        assert!(near(e.angle, 0.4, e.angle_std), "{e:?}");
        assert!(
            near(f64::from(e.main_amplitude), 1500.0, e.main_amplitude_std),
            "{e:?}"
        );
        assert!(
            near(
                f64::from(e.quadrature_amplitude),
                80.0,
                e.quadrature_amplitude_std
            ),
            "{e:?}"
        );
        assert!(near(e.frequency, 5332.0, e.frequency_std), "{e:?}");
    }
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn garbage_on_the_line_is_counted_and_does_no_harm() {
    let recording = steady(1_000_000);
    let mut device = Device::start("replay", &recording, "");
    assert!(device.read_until(|reports| estimates(reports).len() > 10));
    let mut seed = 1u32;
    for k in 0..16 {
        let mut noise = [0; 512];
        for byte in &mut noise {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *byte = (seed >> 24) as u8;
        }
        device.send(&noise);
        device.send(&[0]);
        device.command(k, Command::Get);
    }
    let (reports, lost, _) = device.finish();
    assert_eq!(lost, 0);
    assert_eq!(
        estimates(&reports),
        estimates(&mirror::reports::<i16>(&recording, &[], 1))
    );
    let answered = reports
        .iter()
        .filter(|r| matches!(r, Report::Acknowledgement(a) if a.result.is_ok()));
    // The recording may end before the last of them.
    assert!(answered.count() >= 1);
    assert!(last_counters(&reports).commands_damaged >= 16);
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn a_reader_that_stops_costs_reports_but_no_samples() {
    let recording = steady(100_000);
    let (reports, lost, _) = Device::start("replay", &recording, "shut=200:500").finish();
    let counters = last_counters(&reports);
    assert_eq!(counters.pairs, 100_000);
    assert_eq!(counters.blocks_dropped, 0);
    assert_eq!(u64::from(counters.reports_dropped), lost);
    assert!(lost > 100);
    let (got, expected) = (
        estimates(&reports),
        estimates(&mirror::reports::<i16>(&recording, &[], 1)),
    );
    // The reports that arrive are those that would have arrived, up to the last window.
    assert!(got.iter().all(|e| expected.contains(e)));
    assert_eq!(got.last(), expected.last());
    assert!(got.len() as u64 + lost >= expected.len() as u64);
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn a_reader_that_sleeps_costs_reports_but_no_samples() {
    let recording = steady(300_000);
    let mut device = Device::start("replay", &recording, "");
    assert!(device.read_until(|reports| estimates(reports).len() > 10));
    std::thread::sleep(std::time::Duration::from_secs(2));
    let (reports, lost, _) = device.finish();
    assert_eq!(lost, 0);
    assert_eq!(
        estimates(&reports),
        estimates(&mirror::reports::<i16>(&recording, &[], 1))
    );
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn a_main_loop_that_is_too_slow_drops_counted_blocks() {
    let recording = steady(300_000);
    let mut device = Device::start("replay", &recording, "hold=1 slow=88");
    // The outbox holds the estimates of a round.
    device.command(1, Command::SetWindow { periods: 22 });
    let (reports, lost, _) = device.finish();
    assert_eq!(lost, 0);
    let last = last_counters(&reports);
    // 88 halves are 296 blocks, of which the queue holds 127.
    assert!(last.blocks_dropped > 2_500, "{last:?}");
    assert_eq!(last.pairs, 300_000);
    let first = reports
        .iter()
        .position(|r| matches!(r, Report::Counters(c) if c.blocks_dropped > 0))
        .expect("it is told");
    // The loss is reported in the same round, not with the counters of the next second.
    assert!(estimates(&reports[..first]).len() < QUEUE / 8);
    let estimates = estimates(&reports);
    assert!(estimates.len() > 100);
    assert_right(&estimates);
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn lost_pairs_cost_only_the_windows_around_them() {
    let recording = steady(100_000);
    let (reports, lost, _) = Device::start("replay", &recording, "lapse=300:777").finish();
    assert_eq!(lost, 0);
    let counters = last_counters(&reports);
    assert_eq!(
        (counters.pairs_lost, counters.overruns, counters.restarts),
        (777, 1, 1)
    );
    assert_eq!(counters.pairs + counters.pairs_lost, 100_000);
    let restarted = Report::State(State::SamplingRestarted(Cause::Overrun));
    assert_eq!(reports.iter().filter(|r| **r == restarted).count(), 1);
    let estimates = estimates(&reports);
    assert!(estimates.len() > 500);
    // Time includes the gap: no window lies in it, and all others are right, phase and frequency among them.
    let hole = 300 * 128..300 * 128 + 777;
    assert!(
        estimates
            .iter()
            .all(|e| e.end() <= hole.start || e.start >= hole.end)
    );
    assert_right(&estimates);
    assert!(estimates.iter().all(|e| e.flags.is_empty()));
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn a_panic_restarts_the_instrument() {
    let recording = steady(50_000);
    let device = Device::start("replay", &recording, "panic=100");
    let log = device.log.clone();
    let (reports, _, _) = device.finish();
    let started = |cause| Report::State(State::Started(cause));
    let panicked = reports
        .iter()
        .position(|r| *r == started(Cause::Panic))
        .expect("it says so");
    assert!(matches!(reports[panicked - 1], Report::Hello(_)));
    assert!(reports[..panicked].contains(&started(Cause::Unknown)));
    assert!(estimates(&reports[..panicked]).len() > 20);
    let after = estimates(&reports[panicked..]);
    assert_eq!(
        after,
        estimates(&mirror::reports::<i16>(&recording, &[], 1))
    );
    // A defmt frame: the message's number, its argument, a mask of their zero bytes, and an end.
    let source = include_str!("../../../firmware/src/replay.rs");
    let line = source.lines().position(|line| line.contains("panic!("));
    let line = line.expect("it panics") as u8 + 1;
    let frame = [message("antinode started: panic, at line {=u32}"), line];
    let log = fs::read(log).expect("there is a log");
    let is_told = |bytes: &[u8]| bytes[..2] == frame && bytes[3] == 0;
    assert!(log.windows(4).any(is_told), "no {frame:x?} in {log:x?}");
}

/// Number of a message of the log.
fn message(text: &str) -> u8 {
    let symbols = output("nm", &[], "replay");
    let symbol = symbols.lines().find(|symbol| symbol.contains(text));
    let (number, _) = symbol.and_then(|s| s.split_once(' ')).expect("it is said");
    u8::from_str_radix(number, 16).expect("there are few")
}

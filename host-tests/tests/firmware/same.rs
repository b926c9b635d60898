//! The same codes give the same telemetry in the emulator and on the host.

use std::collections::HashMap;

use antinode::{Estimate, Flags, Identifier, Packed};
use antinode_telemetry::{Report, State};
use firmware::sampling::{DUAL_ADC_RAILS, is_at_rail_12};
use firmware::settings::{RING, configuration};

use crate::emulator::Device;
use crate::told::{estimates, last_counters};
use crate::{mirror, recordings};

/// All but the counters, whose time is that of the emulator, as bits.
pub fn timeless(reports: &[Report]) -> Vec<Vec<u8>> {
    reports
        .iter()
        .filter(|report| !matches!(report, Report::Counters(_)))
        .map(|report| {
            let mut buffer = [0; antinode_telemetry::MAX_FRAME];
            let mut reporter = antinode_telemetry::Reporter::new();
            let frame = reporter.frame(report, &mut buffer);
            frame.expect("it fits").to_vec()
        })
        .collect()
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn fixed_point_reports_are_the_same_to_the_bit() {
    for (name, recording) in recordings::all() {
        let (reports, lost, took) = Device::start("replay", &recording, "").finish();
        let expected = mirror::reports::<i16>(&recording, &[], 1);
        assert_eq!(lost, 0, "{name}");
        let counters = last_counters(&reports);
        let at_rail = recording.iter().filter(|&&pair| is_at_rail_12(pair));
        let at_rail = at_rail.count();
        assert_eq!(counters.saturated_pairs, at_rail as u64, "{name}");
        let is_railed = counters.saturated_blocks > 1000 && at_rail > 1000;
        assert_eq!(is_railed, name == "clipping", "{name}: {counters:?}");
        assert!(took < 30.0, "{name}: a second took {took} s");
        assert!(estimates(&reports).len() > 400, "{name}");
        assert!(
            timeless(&reports) == timeless(&expected),
            "{name}: the emulator and the host differ"
        );
        println!(
            "{name}: {} estimates in {took:.2} s",
            estimates(&reports).len()
        );
    }
}

#[test]
fn the_pipeline_gives_the_estimates_of_the_core() {
    for (name, recording) in recordings::all().into_iter().take(4) {
        let reports = mirror::reports::<i16>(&recording, &[], 1);
        assert_eq!(estimates(&reports), core(&recording), "{name}");
    }
}

/// The core in one thread.
fn core(recording: &[Packed]) -> Vec<Estimate> {
    let front_end = antinode_telemetry::FrontEnd::Synthetic;
    let settings = configuration(front_end, DUAL_ADC_RAILS).settings;
    let mut core = Identifier::<i16, 200, RING>::new(settings).expect("the settings can be");
    let mut estimates = Vec::new();
    core.extend(recording, |estimate| estimates.push(estimate));
    estimates
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn f32_reports_agree_to_a_millionth() {
    for (name, recording) in recordings::all() {
        let (reports, ..) = Device::start("replay_f32", &recording, "").finish();
        let expected = estimates(&mirror::reports::<f32>(&recording, &[], 1));
        let reports = estimates(&reports);
        assert_eq!(reports.len(), expected.len(), "{name}");
        for (got, expected) in reports.iter().zip(&expected) {
            assert_eq!(
                (got.start, got.flags),
                (expected.start, expected.flags),
                "{name}"
            );
            let size = f64::from(expected.main_amplitude);
            for (got, expected, unit) in [
                (
                    f64::from(got.main_amplitude),
                    f64::from(expected.main_amplitude),
                    size,
                ),
                (
                    f64::from(got.quadrature_amplitude),
                    f64::from(expected.quadrature_amplitude),
                    size,
                ),
                (got.angle, expected.angle, 1.0),
                (f64::from(got.phase), f64::from(expected.phase), 1.0),
                (got.frequency, expected.frequency, expected.frequency),
            ] {
                assert!(
                    (got - expected).abs() <= 1e-6 * unit,
                    "{name}: {got}, host {expected}"
                );
            }
        }
    }
}

#[test]
fn flags_of_recordings_are_those_of_their_content() {
    let recordings: HashMap<_, _> = recordings::all().into_iter().collect();
    let flagged = |name| mirror::reports::<i16>(&recordings[name], &[], 1);
    let with = |reports: &[Report], flag| {
        let estimates = estimates(reports);
        estimates.iter().filter(|e| e.flags.contains(flag)).count()
    };
    assert!(
        estimates(&flagged("clean"))
            .iter()
            .all(|e| e.flags.is_empty())
    );
    let dropout = flagged("dropout");
    // A value held for 4 ms, and 50 ms without a wave: in both the wave is lost and found again.
    assert_eq!(with(&dropout, Flags::REACQUIRED), 2);
    assert!(with(&dropout, Flags::LOST) >= 1 && with(&dropout, Flags::MISFIT) >= 1);
    let states: Vec<_> = dropout
        .iter()
        .filter(|r| matches!(r, Report::State(_)))
        .collect();
    let (searching, tracking) = (
        Report::State(State::Searching),
        Report::State(State::Tracking),
    );
    assert_eq!(states[1..], [&searching, &tracking].repeat(3));
    assert!(with(&flagged("clipping"), Flags::CLIPPED) > 200);
}

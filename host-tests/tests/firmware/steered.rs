//! The pipeline on the host: commands and torn halves during tracking.

use antinode::{Calibration, Estimate, Flags};
use antinode_sim::Wave;
use antinode_telemetry::{Command, Report, State};
use firmware::settings::HALF;

use crate::emulator::bytes;
use crate::mirror::{MISSED, Recorded, reports_of};
use crate::told::{estimates, last_counters};
use crate::{mirror, recordings};

/// Round in which the command comes.
const ROUND: usize = 200;

#[test]
fn a_command_leaves_the_angle_continued_or_flagged() {
    let wave = Wave {
        angle_rate: 20.0,
        ..recordings::WAVE
    };
    let recording = recordings::codes(wave, recordings::quiet(), 60_000);
    let calibration = Calibration {
        gain_ratio: 1.001,
        ..Calibration::IDEAL
    };
    for command in [
        Command::SetWindow { periods: 20 },
        Command::SetHop { blocks: Some(5) },
        Command::SetCalibration(calibration),
        Command::SetFrequency {
            hertz: Some(5250.0),
        },
        Command::SetHum { on: true },
        Command::SetColoured { on: true },
    ] {
        let sent = bytes(1, command);
        let reports = reports_of::<i16>(Recorded::new(&recording), (ROUND, &sent), 1);
        let is_answer = |report: &Report| matches!(report, Report::Acknowledgement(_));
        let at = reports.iter().position(is_answer).expect("it answers");
        let (before, after) = (estimates(&reports[..at]), estimates(&reports[at..]));
        assert!(before.len() > 100 && after.len() > 50);
        assert_eq!(after[0].flags, Flags::REACQUIRED, "{command:?}");
        assert!(after[1..].iter().all(|estimate| estimate.flags.is_empty()));
        for estimate in before.iter().chain(&after) {
            let off = estimate.angle - wave.angle - wave.angle_rate * estimate.time;
            assert!(off.abs() < 0.01, "{command:?}: {off}");
        }
        // A search is reported.
        let is_state = |state| move |report: &&Report| **report == Report::State(state);
        let searches = reports[at..].iter().filter(is_state(State::Searching));
        let keeps_blocks = matches!(
            command,
            Command::SetCalibration(_) | Command::SetHum { .. } | Command::SetColoured { .. }
        );
        assert_eq!(searches.count(), usize::from(!keeps_blocks));
    }
}

#[test]
fn a_wave_that_no_search_finds_is_tracked_at_a_given_frequency() {
    let frequency = 30_000.0;
    let wave = Wave {
        frequency,
        ..recordings::WAVE
    };
    let recording = recordings::codes(wave, recordings::quiet(), 20_000);
    let hertz = Some(frequency as f32);
    let given = bytes(1, Command::SetFrequency { hertz });
    let found = |commands: &[u8]| estimates(&mirror::reports::<i16>(&recording, commands, 1));
    assert_eq!(found(&[]), []);
    let found = found(&given);
    assert!(found.len() > 400, "{}", found.len());
    // The first window begins with the first pair.
    assert_eq!(found[0].start, 0);
    assert!(
        found
            .iter()
            .all(|estimate| (estimate.angle - wave.angle).abs() < 0.01)
    );
}

#[test]
fn blocks_have_the_length_for_a_given_window_and_hop() {
    let recording = recordings::codes(recordings::WAVE, recordings::quiet(), 40_000);
    for (command, samples, step) in [
        (Command::SetWindow { periods: 5 }, 90, 90),
        (Command::SetHop { blocks: Some(1) }, 190, 19),
        (Command::SetHop { blocks: Some(5) }, 190, 95),
    ] {
        let reports = mirror::reports::<i16>(&recording, &bytes(1, command), 1);
        let found = estimates(&reports);
        assert!(found.len() > 400, "{command:?}: {}", found.len());
        assert!(found.iter().all(|estimate| estimate.samples == samples));
        let steps = |pair: &[Estimate]| pair[1].start - pair[0].start == step;
        assert!(found.windows(2).all(steps), "{command:?}");
    }
}

#[test]
fn every_pair_of_a_torn_half_is_counted_as_taken_or_lost() {
    let recording = recordings::codes(recordings::WAVE, recordings::quiet(), 40_000);
    // During the search for a period, and later: in each half, blocks end at other places.
    for half in (1..4).chain(100..130) {
        let source = Recorded::torn(&recording, half);
        let reports = reports_of::<i16>(source, (0, &[]), 1);
        let counters = last_counters(&reports);
        assert_eq!(counters.overruns, 1);
        assert!(counters.pairs_lost >= u64::from(MISSED));
        let announced = (half * HALF) as u64 + u64::from(MISSED);
        assert_eq!(counters.pairs + counters.pairs_lost, announced, "{half}");
        let estimates = estimates(&reports);
        // Once the period is known, a window begins right after the gap.
        let is_next = |estimate: &Estimate| estimate.start == announced;
        assert!(half < 100 || estimates.iter().any(is_next), "{half}");
        let last = estimates.last().expect("there are some");
        assert!(last.flags.is_empty() && last.time > 0.38);
        let is_right = |angle: f64| (angle - recordings::WAVE.angle).abs() < 0.01;
        assert!(estimates.iter().all(|estimate| is_right(estimate.angle)));
    }
}

#[test]
fn pairs_at_a_rail_during_the_search_belong_to_no_block() {
    // 5 ms at the lower rail, then a wave.
    let mut recording = recordings::codes(recordings::WAVE, recordings::quiet(), 40_000);
    recording[..500].fill(antinode::Packed(0));
    let reports = reports_of::<i16>(Recorded::torn(&recording, 300), (0, &[]), 1);
    let counters = last_counters(&reports);
    assert_eq!(
        (counters.saturated_pairs, counters.saturated_blocks),
        (500, 0)
    );
}

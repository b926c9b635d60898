//! Every message arrives as it was sent, to the bit, and none is longer than a frame may be.

use crate::any::{bytes, command_frame, decode, estimate, report_frame};
use antinode::{Calibration, Estimate, Flags, Settings, SettingsError};
use antinode_telemetry::*;
use proptest::prelude::*;

/// What arrives of one message: NaN differs from itself, so frames are compared.
fn returns<M: Frame>(message: &M) {
    let sent = bytes(message);
    let got = decode::<M>(&sent);
    assert_eq!(got.len(), 1);
    assert_eq!(bytes(got[0].as_ref().unwrap()), sent);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4096))]

    #[test]
    fn every_report_returns(report in report_frame()) {
        returns(&report);
    }

    #[test]
    fn every_command_returns(command in command_frame()) {
        returns(&command);
    }

    #[test]
    fn an_estimate_keeps_every_bit(estimate in estimate()) {
        let sent = bytes(&ReportFrame { number: 0, report: estimate.into() });
        let Some(Ok(ReportFrame { report: Report::Estimate(got), .. })) = decode(&sent).pop() else { panic!() };
        // Debug shows every field in its shortest form that reads back the same; NaN's bits are compared above.
        prop_assert_eq!(format!("{got:?}"), format!("{estimate:?}"));
    }
}

/// Values that take the most bytes in postcard's format; COBS adds one to any frame below 254.
fn longest() -> [Report; 6] {
    let settings = Settings {
        periods: u16::MAX,
        hop: Some(u16::MAX),
        rails: Some([-1.1, 1.1]),
        resolution: Some(1.1),
        frequency: Some(1.1),
        calibration: Calibration::IDEAL,
        ..Settings::new(1.1)
    };
    let method = MethodValues {
        rank: u8::MAX,
        ..MethodValues::default()
    };
    [
        Report::Hello(Hello::new(
            &"9".repeat(99),
            Configuration {
                methods: true,
                ..Configuration::new(settings, FrontEnd::Synthetic)
            },
        )),
        Report::Estimate(Estimate {
            start: u64::MAX,
            samples: u32::MAX,
            time: 0.0,
            main_amplitude: 0.0,
            quadrature_amplitude: 0.0,
            angle: 0.0,
            phase: 0.0,
            frequency: 0.0,
            angle_rate: 0.0,
            decay_rate: 0.0,
            offsets: [0.0; 2],
            main_amplitude_std: 0.0,
            quadrature_amplitude_std: 0.0,
            angle_std: 0.0,
            phase_std: 0.0,
            frequency_std: 0.0,
            angle_rate_std: 0.0,
            decay_rate_std: 0.0,
            residual_rms: 0.0,
            flags: Flags::from_bits_truncate(u16::MAX),
        }),
        Report::State(State::Fault(Cause::Unknown)),
        Report::Counters(Counters {
            uptime_ms: u64::MAX,
            pairs: u64::MAX,
            pairs_lost: u64::MAX,
            saturated_pairs: u64::MAX,
            saturated_blocks: u32::MAX,
            overruns: u32::MAX,
            blocks_dropped: u32::MAX,
            reports_dropped: u32::MAX,
            commands_damaged: u32::MAX,
            restarts: u32::MAX,
        }),
        Report::Acknowledgement(Acknowledgement {
            id: u16::MAX,
            result: Err(CommandError::Settings(SettingsError::SampleRate(1.1))),
        }),
        Report::Methods(Methods {
            start: u64::MAX,
            methods: [method; 4],
            disagree: true,
        }),
    ]
}

#[test]
fn the_longest_frame_is_as_long_as_stated() {
    let lengths = longest().map(|report| {
        let number = u16::MAX;
        bytes(&ReportFrame { number, report }).len()
    });
    assert_eq!(lengths.into_iter().max(), Some(MAX_FRAME), "{lengths:?}");
    let command = CommandFrame {
        id: u16::MAX,
        command: Command::SetCalibration(Calibration::IDEAL),
    };
    assert!(bytes(&command).len() < MAX_FRAME);
}

#[test]
fn a_buffer_too_small_is_told_and_the_number_is_spent() {
    let mut reporter = Reporter::new();
    for room in 0..24 {
        let report = Report::Counters(Counters::default());
        let mut buffer = vec![0; room];
        let result = reporter.frame(&report, &mut buffer);
        assert_eq!(result.is_err(), room < 20, "{room}: {result:?}");
    }
    let mut receiver = Receiver::new();
    let mut buffer = [0; MAX_FRAME];
    let mut send = |reporter: &mut Reporter, report| {
        for &byte in reporter.frame(&report, &mut buffer).unwrap() {
            receiver.push(byte);
        }
        receiver.lost()
    };
    assert_eq!(send(&mut reporter, Report::State(State::Tracking)), 0);
    reporter
        .frame(&Report::State(State::Tracking), &mut [])
        .unwrap_err();
    assert_eq!(send(&mut reporter, Report::State(State::Tracking)), 1);
    // A device that starts anew has lost nothing.
    let hello = Hello::new(
        "1",
        Configuration::new(Settings::new(1e5), FrontEnd::DualAdc),
    );
    assert_eq!(send(&mut Reporter::new(), Report::Hello(hello)), 1);
}

#[test]
fn a_frame_is_laid_out_as_documented() {
    let sent = bytes(&ReportFrame {
        number: 0,
        report: Report::State(State::Tracking),
    });
    // Python: zlib.crc32(bytes([16, 0, 2, 2])) is 0xad658b2d.
    let expected = [0, 2, 16, 7, 2, 2, 0x2d, 0x8b, 0x65, 0xad, 0];
    assert_eq!(sent, expected);
}

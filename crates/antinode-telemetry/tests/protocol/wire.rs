//! What is on the wire changes only with its version: ends of two releases must not take each other's bytes for something else.

use crate::any::{CAUSES, DETECTIONS, bytes};
use antinode::{Calibration, Detection, Estimate, Flags, Settings, SettingsError};
use antinode_telemetry::*;

/// Numbers that differ, for every field its own: fields that change places change bytes.
struct Distinct(u8);

impl Distinct {
    fn next(&mut self) -> u8 {
        self.0 += 1;
        self.0
    }

    fn single(&mut self) -> f32 {
        f32::from(self.next())
    }

    fn double(&mut self) -> f64 {
        f64::from(self.next())
    }

    fn calibration(&mut self) -> Calibration {
        Calibration {
            gain_ratio: self.single(),
            skew: self.single(),
            pick_off_angle: self.single(),
        }
    }

    fn estimate(&mut self) -> Estimate {
        Estimate {
            start: self.next().into(),
            samples: self.next().into(),
            time: self.double(),
            main_amplitude: self.single(),
            quadrature_amplitude: self.single(),
            angle: self.double(),
            phase: self.single(),
            frequency: self.double(),
            angle_rate: self.single(),
            decay_rate: self.single(),
            offsets: [self.single(), self.single()],
            main_amplitude_std: self.single(),
            quadrature_amplitude_std: self.single(),
            angle_std: self.single(),
            phase_std: self.single(),
            frequency_std: self.single(),
            angle_rate_std: self.single(),
            decay_rate_std: self.single(),
            residual_rms: self.single(),
            flags: Flags::from_bits_truncate(0),
        }
    }

    fn settings(&mut self, detection: Detection, [watch, hum, coloured]: [bool; 3]) -> Settings {
        let mut settings = Settings::new(self.double());
        settings.periods = self.next().into();
        settings.hop = Some(self.next().into());
        settings.start_angle = self.single();
        settings.rails = Some([self.single(), self.single()]);
        settings.resolution = Some(self.single());
        settings.frequency = Some(self.single());
        (settings.detection, settings.watch) = (detection, watch);
        (settings.hum, settings.coloured) = (hum, coloured);
        settings.calibration = self.calibration();
        settings
    }

    fn counters(&mut self) -> Counters {
        Counters {
            uptime_ms: self.next().into(),
            pairs: self.next().into(),
            pairs_lost: self.next().into(),
            saturated_pairs: self.next().into(),
            saturated_blocks: self.next().into(),
            overruns: self.next().into(),
            blocks_dropped: self.next().into(),
            reports_dropped: self.next().into(),
            commands_damaged: self.next().into(),
            restarts: self.next().into(),
        }
    }

    fn methods(&mut self) -> Methods {
        let mut method = || MethodValues {
            main_amplitude: self.double(),
            quadrature_amplitude: self.double(),
            angle: self.double(),
            rank: self.next(),
        };
        Methods {
            methods: [(); 4].map(|()| method()),
            start: self.next().into(),
            disagree: true,
        }
    }
}

fn reports() -> Vec<Report> {
    let mut n = Distinct(0);
    let mut reports = vec![
        Report::Counters(n.counters()),
        Report::Methods(n.methods()),
        Report::State(State::Searching),
        Report::State(State::Tracking),
    ];
    let flags = [
        Flags::CLIPPED,
        Flags::LOST,
        Flags::PHASE_JUMP,
        Flags::STEP,
        Flags::CIRCULAR,
        Flags::MISFIT,
        Flags::DEAD_CHANNEL,
        Flags::REACQUIRED,
        Flags::NOT_FINITE,
    ];
    for flags in flags {
        reports.push(Report::Estimate(Estimate {
            flags,
            ..Distinct(0).estimate()
        }));
    }
    for cause in CAUSES {
        let states = [State::Started, State::SamplingRestarted, State::Fault];
        reports.extend(states.map(|state| Report::State(state(cause))));
    }
    let front_ends = [
        (
            FrontEnd::DualAdc,
            Detection::Difference,
            [true, false, false],
        ),
        (FrontEnd::SequencedAdc, DETECTIONS[0], [false, true, false]),
        (FrontEnd::Spi, Detection::Difference, [false, false, true]),
        (FrontEnd::Sai, Detection::Difference, [false; 3]),
        (FrontEnd::Dfsdm, Detection::Difference, [false; 3]),
        (FrontEnd::Synthetic, Detection::Difference, [true; 3]),
    ];
    for (front_end, detection, on) in front_ends {
        let settings = Distinct(0).settings(detection, on);
        let configuration = Configuration::new(settings, front_end);
        reports.push(Report::Hello(Hello::new("0.1.0", configuration)));
    }
    let errors = [
        SettingsError::SampleRate(1.0),
        SettingsError::PeriodsTooFew(1),
        SettingsError::PeriodsTooMany {
            periods: 2,
            most: 1,
        },
        SettingsError::Hop,
        SettingsError::StartAngle(1.0),
        SettingsError::Rails([2.0, 1.0]),
        SettingsError::Resolution(1.0),
        SettingsError::Frequency(1.0),
        SettingsError::GainRatio(1.0),
        SettingsError::Skew(1.0),
        SettingsError::PickOffAngle(1.0),
        SettingsError::HumPeriods {
            periods: 4,
            least: 5,
        },
        SettingsError::FrequencyTooLow {
            frequency: 1.0,
            most: 2,
        },
    ];
    let mut results = vec![
        Ok(()),
        Err(CommandError::Unsupported),
        Err(CommandError::Calibrated),
        Err(CommandError::Busy),
    ];
    results.extend(errors.map(|error| Err(CommandError::Settings(error))));
    let answers = results.into_iter().map(|result| {
        let answer = Acknowledgement { id: 7, result };
        Report::Acknowledgement(answer)
    });
    reports.extend(answers);
    reports
}

fn commands() -> [Command; 11] {
    [
        Command::Get,
        Command::SetWindow { periods: 20 },
        Command::SetHop { blocks: None },
        Command::SetHop { blocks: Some(5) },
        Command::SetCalibration(Distinct(0).calibration()),
        Command::SetFrequency { hertz: None },
        Command::SetFrequency {
            hertz: Some(5332.0),
        },
        Command::SetHum { on: true },
        Command::SetColoured { on: false },
        Command::SetMethods { on: true },
        Command::Restart,
    ]
}

#[test]
#[cfg_attr(
    not(feature = "mean-return"),
    ignore = "one message has a detector of the feature mean-return"
)]
fn the_bytes_of_every_message_are_those_of_the_version() {
    let reports = reports()
        .into_iter()
        .map(|report| bytes(&ReportFrame { number: 1, report }));
    let commands = commands().map(|command| bytes(&CommandFrame { id: 2, command }));
    let wire: Vec<u8> = reports.chain(commands).flatten().collect();
    // Not the frames' own CRC, which is the same over whatever ends with itself.
    let sum = crc::Crc::<u64>::new(&crc::CRC_64_XZ).checksum(&wire);
    assert_eq!(
        (PROTOCOL_VERSION, wire.len(), sum),
        (8, 2329, 6229996079505654109),
        "where the bytes differ and the version does not, count PROTOCOL_VERSION up; then put in what is on the left"
    );
}

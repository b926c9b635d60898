//! What the tests share: any message, to the bit.

use antinode::{Calibration, Detection, Estimate, Flags, Settings, SettingsError};
use antinode_telemetry::*;
use proptest::prelude::*;

/// The period detectors, of which firmware may leave one out.
pub const DETECTIONS: &[Detection] = &[
    #[cfg(feature = "mean-return")]
    Detection::MeanReturn,
    Detection::Difference,
];

/// Any single-precision value, NaN and infinities among them.
pub fn single() -> impl Strategy<Value = f32> + Clone {
    any::<u32>().prop_map(f32::from_bits)
}

/// Any double-precision value, NaN and infinities among them.
pub fn double() -> impl Strategy<Value = f64> + Clone {
    any::<u64>().prop_map(f64::from_bits)
}

pub fn estimate() -> impl Strategy<Value = Estimate> {
    (
        any::<(u64, u32, u16)>(),
        [double(), double(), double()],
        proptest::array::uniform15(single()),
    )
        .prop_map(|((start, samples, flags), d, s)| Estimate {
            start,
            samples,
            time: d[0],
            main_amplitude: s[0],
            quadrature_amplitude: s[1],
            angle: d[1],
            phase: s[2],
            frequency: d[2],
            angle_rate: s[3],
            decay_rate: s[4],
            offsets: [s[5], s[6]],
            main_amplitude_std: s[7],
            quadrature_amplitude_std: s[8],
            angle_std: s[9],
            phase_std: s[10],
            frequency_std: s[11],
            angle_rate_std: s[12],
            decay_rate_std: s[13],
            residual_rms: s[14],
            flags: Flags::from_bits_truncate(flags),
        })
}

pub fn calibration() -> impl Strategy<Value = Calibration> {
    [single(), single(), single()].prop_map(|s| Calibration {
        gain_ratio: s[0],
        skew: s[1],
        pick_off_angle: s[2],
    })
}

fn front_end() -> impl Strategy<Value = FrontEnd> {
    prop_oneof![
        Just(FrontEnd::DualAdc),
        Just(FrontEnd::SequencedAdc),
        Just(FrontEnd::Spi),
        Just(FrontEnd::Sai),
        Just(FrontEnd::Dfsdm),
        Just(FrontEnd::Synthetic),
    ]
}

fn configuration() -> impl Strategy<Value = Configuration> {
    (
        (
            double(),
            any::<(u16, Option<u16>, bool, bool, bool, [bool; 2])>(),
            single(),
        ),
        proptest::option::of([single(), single()]),
        [single(), single()].map(proptest::option::of),
        calibration(),
        front_end(),
    )
        .prop_map(
            |(plain, rails, [resolution, frequency], calibration, front_end)| {
                let (
                    sample_rate,
                    (periods, hop, detection, methods, watch, [hum, coloured]),
                    start_angle,
                ) = plain;
                Configuration {
                    settings: Settings {
                        sample_rate,
                        periods,
                        hop,
                        start_angle,
                        rails,
                        resolution,
                        frequency,
                        detection: DETECTIONS[usize::from(detection) % DETECTIONS.len()],
                        watch,
                        hum,
                        coloured,
                        calibration,
                    },
                    front_end,
                    methods,
                }
            },
        )
}

pub const CAUSES: [Cause; 13] = [
    Cause::PowerOn,
    Cause::BrownOut,
    Cause::ResetPin,
    Cause::Software,
    Cause::Command,
    Cause::Watchdog,
    Cause::Panic,
    Cause::HardFault,
    Cause::Overrun,
    Cause::Dma,
    Cause::Converter,
    Cause::Clock,
    Cause::Unknown,
];

fn state() -> impl Strategy<Value = State> {
    let cause = || proptest::sample::select(&CAUSES);
    prop_oneof![
        cause().prop_map(State::Started),
        Just(State::Searching),
        Just(State::Tracking),
        cause().prop_map(State::SamplingRestarted),
        cause().prop_map(State::Fault),
    ]
}

fn counters() -> impl Strategy<Value = Counters> {
    any::<([u64; 4], [u32; 6])>().prop_map(|(long, short)| Counters {
        uptime_ms: long[0],
        pairs: long[1],
        pairs_lost: long[2],
        saturated_pairs: long[3],
        saturated_blocks: short[0],
        overruns: short[1],
        blocks_dropped: short[2],
        reports_dropped: short[3],
        commands_damaged: short[4],
        restarts: short[5],
    })
}

fn command_error() -> impl Strategy<Value = CommandError> {
    prop_oneof![
        Just(CommandError::Unsupported),
        Just(CommandError::Calibrated),
        Just(CommandError::Busy),
        (0..13, single(), double(), any::<(u16, u16)>()).prop_map(|(kind, s, d, (n, most))| {
            CommandError::Settings(match kind {
                0 => SettingsError::SampleRate(d),
                1 => SettingsError::PeriodsTooFew(n),
                2 => SettingsError::PeriodsTooMany { periods: n, most },
                3 => SettingsError::Hop,
                4 => SettingsError::StartAngle(s),
                5 => SettingsError::Rails([s, -s]),
                6 => SettingsError::Resolution(s),
                7 => SettingsError::GainRatio(s),
                8 => SettingsError::Skew(s),
                9 => SettingsError::Frequency(s),
                10 => SettingsError::PickOffAngle(s),
                11 => SettingsError::HumPeriods {
                    periods: n,
                    least: most,
                },
                _ => SettingsError::FrequencyTooLow { frequency: s, most },
            })
        }),
    ]
}

fn methods() -> impl Strategy<Value = Methods> {
    let values = || {
        ([double(), double(), double()], any::<u8>()).prop_map(|(d, rank)| MethodValues {
            main_amplitude: d[0],
            quadrature_amplitude: d[1],
            angle: d[2],
            rank,
        })
    };
    (
        any::<(u64, bool)>(),
        [values(), values(), values(), values()],
    )
        .prop_map(|((start, disagree), methods)| Methods {
            start,
            methods,
            disagree,
        })
}

pub fn report() -> impl Strategy<Value = Report> {
    prop_oneof![
        ("[ -~]{0,30}|.{0,30}", configuration())
            .prop_map(|(name, c)| Report::Hello(Hello::new(&name, c))),
        estimate().prop_map(Report::Estimate),
        state().prop_map(Report::State),
        counters().prop_map(Report::Counters),
        (
            any::<u16>(),
            proptest::result::maybe_ok(Just(()), command_error())
        )
            .prop_map(|(id, result)| Report::Acknowledgement(Acknowledgement { id, result })),
        methods().prop_map(Report::Methods),
    ]
}

pub fn report_frame() -> impl Strategy<Value = ReportFrame> {
    (any::<u16>(), report()).prop_map(|(number, report)| ReportFrame { number, report })
}

pub fn command_frame() -> impl Strategy<Value = CommandFrame> {
    let command = prop_oneof![
        Just(Command::Get),
        any::<u16>().prop_map(|periods| Command::SetWindow { periods }),
        any::<Option<u16>>().prop_map(|blocks| Command::SetHop { blocks }),
        calibration().prop_map(Command::SetCalibration),
        any::<Option<f32>>().prop_map(|hertz| Command::SetFrequency { hertz }),
        any::<bool>().prop_map(|on| Command::SetHum { on }),
        any::<bool>().prop_map(|on| Command::SetColoured { on }),
        any::<bool>().prop_map(|on| Command::SetMethods { on }),
        Just(Command::Restart),
    ];
    (any::<u16>(), command).prop_map(|(id, command)| CommandFrame { id, command })
}

/// The bytes of a message's frame.
pub fn bytes(message: &impl Frame) -> Vec<u8> {
    frame(message, &mut [0; MAX_FRAME]).unwrap().to_vec()
}

/// All that a decoder gives for some bytes.
pub fn decode<M: Frame>(bytes: &[u8]) -> Vec<Result<M, Damage>> {
    let mut decoder = Decoder::new();
    let mut given: Vec<_> = bytes.iter().filter_map(|&b| decoder.push(b)).collect();
    given.extend(decoder.finish().map(Err));
    given
}

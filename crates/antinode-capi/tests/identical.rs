//! The C ABI gives the core's rows, bit for bit, however samples reach it, and refuses what the header says it refuses.
#![allow(unsafe_code, reason = "the functions of a C ABI")]

use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

use antinode::{Identifier, Sample, SamplePair};
use antinode_capi::*;

/// A ringing gyro in 16-bit codes, followed by a pause and a wave of another frequency.
fn codes() -> Vec<[i16; 2]> {
    let mut seed = 7u32;
    (0..30_000)
        .map(|k| {
            let (scale, frequency) = match k {
                0..12_000 => (1.0, 5_332.0),
                12_000..16_000 => (0.0, 0.0),
                _ => (0.8, 4_100.0),
            };
            let (s, c) = (std::f64::consts::TAU * frequency / 1e5 * f64::from(k)).sin_cos();
            let (s2, c2) = 0.7f64.sin_cos();
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let noise = |shift: u32| f64::from(seed >> shift & 31) - 15.5;
            let (a, b) = (scale * 20_000.0 * c, scale * 1_500.0 * s);
            [
                (a * c2 - b * s2 + noise(27)) as i16,
                (a * s2 + b * c2 + noise(20)) as i16,
            ]
        })
        .collect()
}

/// The core's rows for the pairs, with a known frequency or without.
fn core<S: Sample, P: SamplePair<S>>(pairs: &[P], frequency: Option<f32>) -> Vec<Estimate> {
    let settings = antinode::Settings {
        frequency,
        ..antinode::Settings::new(1e5)
    };
    let mut identifier = Box::new(
        Identifier::<S, ANTINODE_LONGEST_PERIOD, { ANTINODE_MOST_PERIODS + 2 }>::new(settings)
            .unwrap(),
    );
    let mut all = Vec::new();
    identifier.extend(pairs, |estimate| all.push(estimate.into()));
    // With a known frequency the second wave is not found.
    assert!(all.len() > if frequency.is_some() { 60 } else { 120 });
    all
}

fn same(name: &str, ours: &[Estimate], cores: &[Estimate]) {
    assert_eq!(ours.len(), cores.len(), "{name}");
    for (our, core) in ours.iter().zip(cores) {
        // Compared as text, so that NaN equals NaN.
        assert_eq!(format!("{our:?}"), format!("{core:?}"), "{name}");
    }
}

macro_rules! arithmetic {
    ($test:ident, $state:ty, $sample:ty, $from:expr, $init:ident, $push:ident, $block:ident, $interleaved:ident, $packed:ident,
     $solve:ident, $identify:ident, $reset:ident) => {
        #[test]
        fn $test() {
            let pairs: Vec<[$sample; 2]> = codes().iter().map(|pair| pair.map($from)).collect();
            let words: Vec<u32> = codes()
                .iter()
                .map(|[c, d]| u32::from(*c as u16) | u32::from(*d as u16) << 16)
                .collect();
            let (c, d): (Vec<_>, Vec<_>) = pairs.iter().map(|pair| (pair[0], pair[1])).unzip();
            let mut state = Box::new(<$state>::ZERO);
            let state: *mut $state = &mut *state;
            for frequency in [None, Some(5_400.0)] {
                let expected = core::<$sample, _>(&pairs, frequency);
                let settings = Settings {
                    frequency_hz: frequency.unwrap_or(0.0),
                    ..antinode_settings_default(1e5)
                };
                // SAFETY: the state is there, and this thread alone uses it.
                unsafe {
                    assert_eq!($init(state, &settings), Status::Ok);
                    // Pairs go in one by one, so that the search after a loss begins at the same sample as in one thread.
                    let run = |name: &str, feed: &dyn Fn(usize) -> Status, step: usize| {
                        assert_eq!($reset(state), Status::Ok);
                        let (mut all, mut estimate) = (Vec::new(), MaybeUninit::uninit());
                        for at in (0..pairs.len()).step_by(step) {
                            let status = feed(at);
                            assert!(
                                status == Status::Ok || status == Status::Ready,
                                "{name} {status:?}"
                            );
                            while $solve(state, estimate.as_mut_ptr()) == Status::Estimate {
                                all.push(estimate.assume_init());
                            }
                        }
                        same(name, &all, &expected);
                    };
                    run("push", &|at| $push(state, c[at], d[at]), 1);
                    run("separate", &|at| $block(state, &c[at], &d[at], 1), 1);
                    run(
                        "interleaved",
                        &|at| $interleaved(state, pairs[at..].as_ptr().cast(), 1),
                        1,
                    );
                    run("packed", &|at| $packed(state, &words[at], 1), 1);

                    assert_eq!($reset(state), Status::Ok);
                    let (mut all, mut estimate, mut at) = (Vec::new(), MaybeUninit::uninit(), 0);
                    while at < pairs.len() {
                        let (mut taken, rest) = (0, &pairs[at..]);
                        let status = $identify(
                            state,
                            rest.as_ptr().cast(),
                            rest.len(),
                            &mut taken,
                            estimate.as_mut_ptr(),
                        );
                        at += taken;
                        if status == Status::Estimate {
                            all.push(estimate.assume_init());
                        }
                    }
                    same("identify", &all, &expected);
                }
            }
        }
    };
}

arithmetic!(
    fixed_point_equals_the_core,
    Fixed,
    i16,
    |code| code,
    antinode_fixed_init,
    antinode_fixed_push,
    antinode_fixed_push_block,
    antinode_fixed_push_block_interleaved,
    antinode_fixed_push_block_packed,
    antinode_fixed_solve,
    antinode_fixed_identify,
    antinode_fixed_reset
);
arithmetic!(
    single_precision_equals_the_core,
    Float,
    f32,
    f32::from,
    antinode_float_init,
    antinode_float_push,
    antinode_float_push_block,
    antinode_float_push_block_interleaved,
    antinode_float_push_block_packed,
    antinode_float_solve,
    antinode_float_identify,
    antinode_float_reset
);

#[test]
fn settings_out_of_range_are_named() {
    let mut state = Box::new(Fixed::ZERO);
    let mut refused = |change: &dyn Fn(&mut Settings)| {
        let mut settings = antinode_settings_default(1e5);
        change(&mut settings);
        // SAFETY: both exist.
        unsafe { antinode_fixed_init(&mut *state, &settings) }
    };
    assert_eq!(refused(&|_| ()), Status::Ok);
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300] {
        assert_eq!(
            refused(&|s| s.sample_rate_hz = rate),
            Status::ErrorSampleRate
        );
    }
    for periods in [0, 1, 51, 65_536 + 10, u32::MAX] {
        assert_eq!(refused(&|s| s.periods = periods), Status::ErrorPeriods);
    }
    assert_eq!(refused(&|s| s.periods = 50), Status::Ok);
    assert_eq!(refused(&|s| s.hop_blocks = 65_536), Status::ErrorHop);
    assert_eq!(
        refused(&|s| s.start_angle_rad = f32::NAN),
        Status::ErrorStartAngle
    );
    assert_eq!(refused(&|s| s.rail_low = 1.0), Status::ErrorRails);
    assert_eq!(refused(&|s| s.rail_high = f32::NAN), Status::ErrorRails);
    assert_eq!(refused(&|s| s.resolution = -1.0), Status::ErrorResolution);
    for frequency in [f32::NAN, -1.0, 40_001.0, 498.0] {
        assert_eq!(
            refused(&|s| s.frequency_hz = frequency),
            Status::ErrorFrequency
        );
    }
    assert_eq!(refused(&|s| s.frequency_hz = 500.0), Status::Ok);
    assert_eq!(refused(&|s| s.detection = 2), Status::ErrorDetection);
    assert_eq!(refused(&|s| s.watch = 2), Status::ErrorWatch);
    assert_eq!(refused(&|s| s.hum = 2), Status::ErrorHum);
    assert_eq!(refused(&|s| s.coloured = 2), Status::ErrorColoured);
    assert_eq!(
        refused(&|s| s.calibration.gain_ratio = 0.0),
        Status::ErrorGainRatio
    );
    assert_eq!(refused(&|s| s.calibration.skew_s = 1.0), Status::ErrorSkew);
    assert_eq!(
        refused(&|s| s.calibration.pick_off_angle_rad = 1.0),
        Status::ErrorPickOffAngle
    );
}

/// Values that no call writes.
const UNWRITTEN: Health = Health {
    searching: 9,
    has_wave: 9,
    waiting: 9,
    dropped: 9,
};

#[test]
fn a_known_frequency_is_not_searched() {
    let mut state = Box::new(Fixed::ZERO);
    let mut health = UNWRITTEN;
    let mut settings = antinode_settings_default(1e5);
    for (frequency, searching) in [(0.0, 1), (5_300.0, 0), (0.0, 1)] {
        settings.frequency_hz = frequency;
        // SAFETY: all exist.
        unsafe {
            assert_eq!(antinode_fixed_init(&mut *state, &settings), Status::Ok);
            assert_eq!(antinode_fixed_health(&*state, &mut health), Status::Ok);
        }
        assert_eq!((health.searching, health.waiting), (searching, 0));
    }
}

#[test]
fn health_shows_whether_there_is_a_wave_with_and_without_a_search() {
    let mut state = Box::new(Fixed::ZERO);
    let mut health = UNWRITTEN;
    let mut estimate = MaybeUninit::uninit();
    let mut settings = antinode_settings_default(1e5);
    let pairs = codes();
    for (frequency, is_there) in [(0.0, 1), (5_300.0, 1), (6_500.0, 0)] {
        settings.frequency_hz = frequency;
        // SAFETY: all is there, and this thread alone uses it.
        unsafe {
            assert_eq!(antinode_fixed_init(&mut *state, &settings), Status::Ok);
            let mut told = Vec::new();
            let silence = vec![[0i16; 2]; 5_000];
            for pairs in [&pairs[..0], &pairs[..5_000], &silence] {
                for pairs in pairs.chunks(128) {
                    let samples = pairs.as_ptr().cast();
                    let status =
                        antinode_fixed_push_block_interleaved(&mut *state, samples, pairs.len());
                    assert!(status == Status::Ok || status == Status::Ready);
                    while antinode_fixed_solve(&mut *state, estimate.as_mut_ptr())
                        == Status::Estimate
                    {}
                }
                assert_eq!(antinode_fixed_health(&*state, &mut health), Status::Ok);
                told.push(health.has_wave);
            }
            assert_eq!(told, [0, is_there, 0], "{frequency} Hz");
        }
    }
}

#[test]
fn a_full_queue_drops_blocks_and_says_so() {
    let mut state = Box::new(Fixed::ZERO);
    let mut health = UNWRITTEN;
    let settings = antinode_settings_default(1e5);
    let pairs = codes();
    // SAFETY: all is there, and this thread alone uses it.
    unsafe {
        assert_eq!(antinode_fixed_init(&mut *state, &settings), Status::Ok);
        let status =
            antinode_fixed_push_block_interleaved(&mut *state, pairs.as_ptr().cast(), 10_000);
        assert_eq!(status, Status::Dropped);
        assert_eq!(antinode_fixed_health(&*state, &mut health), Status::Ok);
        assert_eq!((health.searching, health.waiting), (0, 16));
        assert!((230..260).contains(&health.dropped), "{health:?}");
        let mut estimate = MaybeUninit::uninit();
        // 16 blocks make three windows.
        for _ in 0..3 {
            assert_eq!(
                antinode_fixed_solve(&mut *state, estimate.as_mut_ptr()),
                Status::Estimate
            );
        }
        // The block after the gap begins a new window.
        assert_eq!(
            antinode_fixed_solve(&mut *state, estimate.as_mut_ptr()),
            Status::Ok
        );
    }
}

#[test]
fn a_new_calibration_is_used_and_keeps_the_angle() {
    let mut state = Box::new(Fixed::ZERO);
    let settings = antinode_settings_default(1e5);
    let pairs: Vec<_> = codes()
        .into_iter()
        .take(12_000)
        .map(|[c, d]| [c, (f32::from(d) * 0.5) as i16])
        .collect();
    let mut last = MaybeUninit::<Estimate>::uninit();
    // SAFETY: all is there, and this thread alone uses it.
    unsafe {
        assert_eq!(antinode_fixed_init(&mut *state, &settings), Status::Ok);
        let mut run = |state: &mut Fixed, pairs: &[[i16; 2]]| {
            for pair in pairs {
                antinode_fixed_push(state, pair[0], pair[1]);
                antinode_fixed_solve(state, last.as_mut_ptr());
            }
            last.assume_init()
        };
        let wrong = run(&mut state, &pairs[..6_000]);
        assert!((wrong.angle_rad - 0.35).abs() > 0.1);
        let mut calibration = settings.calibration;
        calibration.gain_ratio = 0.0;
        assert_eq!(
            antinode_fixed_set_calibration(&mut *state, &calibration),
            Status::ErrorGainRatio
        );
        calibration.gain_ratio = 0.5;
        assert_eq!(
            antinode_fixed_set_calibration(&mut *state, &calibration),
            Status::Ok
        );
        let right = run(&mut state, &pairs[6_000..]);
        assert!((right.angle_rad - 0.35).abs() < 1e-3, "{right:?}");
        // A reset keeps the calibration.
        assert_eq!(antinode_fixed_reset(&mut *state), Status::Ok);
        let again = run(&mut state, &pairs);
        assert!((again.angle_rad - 0.35).abs() < 1e-3, "{again:?}");
    }
}

#[test]
fn bad_pointers_and_states_are_refused() {
    let mut state = Box::new(Float::ZERO);
    let odd = (&raw mut *state)
        .cast::<u8>()
        .wrapping_add(1)
        .cast::<Float>();
    // SAFETY: bad pointers are refused.
    unsafe {
        assert_eq!(antinode_float_push(null_mut(), 0.0, 0.0), Status::ErrorNull);
        assert_eq!(antinode_float_push(odd, 0.0, 0.0), Status::ErrorAlignment);
        assert_eq!(
            antinode_float_push(&mut *state, 0.0, 0.0),
            Status::ErrorNotInitialised
        );
        assert_eq!(antinode_float_init(&mut *state, null()), Status::ErrorNull);
        let settings = antinode_settings_default(1e5);
        assert_eq!(antinode_float_init(&mut *state, &settings), Status::Ok);
        let other: *mut Fixed = (&raw mut *state).cast();
        assert_eq!(
            antinode_fixed_push(other, 0, 0),
            Status::ErrorNotInitialised
        );
        let one = 0u32;
        assert_eq!(
            antinode_float_push_block_packed(&mut *state, &one, usize::MAX),
            Status::ErrorCount
        );
        // Refused settings leave the state not initialised.
        let mut wrong = settings;
        wrong.periods = 1;
        assert_eq!(
            antinode_float_init(&mut *state, &wrong),
            Status::ErrorPeriods
        );
        assert_eq!(
            antinode_float_push(&mut *state, 0.0, 0.0),
            Status::ErrorNotInitialised
        );
    }
}

//! Shared helpers of the host tests: scores against the Cramér–Rao bound, an independent oracle, and streams through the core.

pub mod codes;
pub mod methods;
pub mod oracle;
pub mod printed;
pub mod random;
pub mod score;
pub mod table;

use std::ops::Range;

use antinode::{Calibration, Estimate, Identifier, Settings};
use antinode_sim::{Flaws, Gyro, Wave, random_wave};

#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;

/// Sample rate of all tests, Hz.
pub const RATE: f64 = 100_000.0;

/// The core of most tests: periods up to 256 samples, windows up to 254 periods.
pub type Core = Identifier<f32, 256, 256>;

/// Identifies `samples` sample pairs of a gyro, from cold; gives all estimates.
pub fn identify(
    wave: Wave,
    flaws: &Flaws,
    settings: Settings,
    samples: usize,
    seed: u64,
) -> Vec<Estimate> {
    identify_changed(wave, flaws, settings, samples, seed, |_, pair| pair)
}

/// As [`identify`], with `change` applied to the index and samples of every pair.
pub fn identify_changed(
    wave: Wave,
    flaws: &Flaws,
    settings: Settings,
    samples: usize,
    seed: u64,
    change: impl Fn(usize, [f64; 2]) -> [f64; 2],
) -> Vec<Estimate> {
    let mut core = Core::new(settings).expect("the test's settings are valid");
    let gyro = Gyro::new(wave, flaws.clone(), RATE, seed).expect("the test's gyro is valid");
    gyro.take(samples)
        .enumerate()
        .map(|(k, pair)| change(k, pair))
        .filter_map(|pair| core.push(pair.map(|x| x as f32)))
        .collect()
}

/// Identifies parts of streams, one behind the other, from cold; gives all estimates.
pub fn identify_parts(parts: &[&[[f32; 2]]], settings: Settings) -> Vec<Estimate> {
    let mut core = Core::new(settings).expect("the test's settings are valid");
    let mut found = Vec::new();
    for part in parts {
        core.extend(part, |estimate| found.push(estimate));
    }
    found
}

/// Settings with windows of `periods`.
pub fn windows(periods: u16) -> Settings {
    Settings {
        periods,
        ..Settings::new(RATE)
    }
}

/// Settings with windows of `periods`, and the calibration for the pick-offs of `flaws`.
pub fn calibrated(flaws: &Flaws, periods: u16) -> Settings {
    Settings {
        calibration: Calibration {
            gain_ratio: flaws.gain_ratio as f32,
            skew: flaws.skew as f32,
            pick_off_angle: flaws.pick_off_angle as f32,
        },
        ..windows(periods)
    }
}

/// The difference of two pattern angles, modulo π/2, rad.
pub fn angle_error(found: f64, truth: f64) -> f64 {
    let quarter = std::f64::consts::FRAC_PI_2;
    let error = found - truth;
    error - (error / quarter).round() * quarter
}

/// The difference of two phases, modulo π (as the choice of the angle is modulo π/2), rad.
pub fn phase_error(found: f64, truth: f64) -> f64 {
    let error = found - truth;
    error - (error / std::f64::consts::PI).round() * std::f64::consts::PI
}

/// A gyro that turns and decays, in 0.5 % noise.
pub fn gyro(seed: u64) -> (Wave, Flaws) {
    let wave = Wave {
        angle_rate: 0.3,
        decay_rate: 0.05,
        ..random_wave(seed, 5332.0, 0.2)
    };
    let a = wave.main_amplitude;
    (
        wave,
        Flaws {
            noise: 0.005 * a,
            offset_c: 0.05 * a,
            offset_d: -0.02 * a,
            ..Flaws::default()
        },
    )
}

/// A resonator at rest: its amplitude, which must be above zero, is lost in any noise.
pub fn no_wave() -> Wave {
    Wave {
        main_amplitude: 1e-12,
        quadrature_amplitude: 0.0,
        ..Wave::default()
    }
}

/// The first `samples` pairs of a gyro, in f32.
pub fn stream(wave: Wave, flaws: Flaws, samples: usize, seed: u64) -> Vec<[f32; 2]> {
    stream_part(wave, flaws, 0..samples, seed)
}

/// These of a gyro's pairs, in f32.
pub fn stream_part(wave: Wave, flaws: Flaws, range: Range<usize>, seed: u64) -> Vec<[f32; 2]> {
    let gyro = Gyro::new(wave, flaws, RATE, seed).unwrap();
    gyro.skip(range.start)
        .take(range.len())
        .map(|pair| pair.map(|x| x as f32))
        .collect()
}

/// Identifies [`gyro`] with this noise, as a share of a_A, and with `change` applied to every pair; gives all estimates.
pub fn changed(
    seed: u64,
    noise: f64,
    periods: u16,
    samples: usize,
    change: impl Fn(usize, [f64; 2]) -> [f64; 2],
) -> Vec<Estimate> {
    let (wave, mut flaws) = gyro(seed);
    flaws.noise = noise * wave.main_amplitude;
    identify_changed(wave, &flaws, windows(periods), samples, seed, change)
}

/// Identifies `signal`, a function of time in s that gives both pick-offs, in this noise; gives all estimates.
pub fn identify_signal(
    noise: f64,
    settings: Settings,
    samples: usize,
    seed: u64,
    signal: impl Fn(f64) -> [f64; 2],
) -> Vec<Estimate> {
    let flaws = Flaws::white(noise);
    identify_changed(no_wave(), &flaws, settings, samples, seed, |k, [c, d]| {
        let [of_c, of_d] = signal(k as f64 / RATE);
        [c + of_c, d + of_d]
    })
}

/// The windows that overlap the samples from `from` to `to` by more than a period.
pub fn touched(estimates: &[Estimate], from: usize, to: usize) -> Vec<&Estimate> {
    let block = 19;
    estimates
        .iter()
        .filter(|e| e.start + block < to as u64 && e.end() > from as u64 + block)
        .collect()
}

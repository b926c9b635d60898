//! Waves of few codes, from cold: found soon from a dozen on, perhaps never below.

use antinode::period::DifferenceDetector;
use antinode::{Sample, SamplePair};
use antinode_sim::{Flaws, Gyro};
use host_tests::RATE;

use crate::detector::wave;

/// Periods after which a wave of so many codes is found in noise of `noise` codes, if it is within so many periods.
fn found_after<S: Sample>(
    (seed, codes): (u64, f64),
    (noise, offsets): (f64, [f64; 2]),
    periods: f64,
    code: fn(f64) -> S,
) -> Option<f64>
where
    [S; 2]: SamplePair<S>,
{
    let (wave, period) = wave(seed);
    let scale = codes / wave.main_amplitude;
    let flaws = Flaws::white(noise / scale);
    let mut detector = DifferenceDetector::<S>::new();
    let gyro = Gyro::new(wave, flaws, RATE, seed).unwrap();
    let found = gyro
        .take((periods * period) as usize)
        .map(|[c, d]| [scale * c + offsets[0], scale * d + offsets[1]])
        .position(|pair| detector.push(pair.map(|x| code(x.round()))).is_some());
    found.map(|at| at as f64 / period)
}

#[test]
fn a_wave_of_a_dozen_codes_is_found_soon() {
    let (mut latest, mut sum) = (0f64, 0.0);
    for seed in 0..4000 {
        let time = found_after((seed, 12.0), (0.5, [31.0, 0.0]), 30.0, |x| x as i16).unwrap();
        latest = latest.max(time);
        sum += time;
    }
    let mean = sum / 4000.0;
    println!("a dozen codes: mean {mean:.2} periods, latest {latest:.1}");
    assert!(mean < 3.2 && latest < 8.0);
}

/// Share of waves of so many codes, in noise of 0.3 codes, that are not found within 60 periods.
fn missed<S: Sample>(codes: f64, code: fn(f64) -> S) -> f64
where
    [S; 2]: SamplePair<S>,
{
    const WAVES: u64 = 500;
    let is_missed = |&seed: &u64| {
        let offset = (seed as f64 * 0.569_84).fract();
        found_after((seed, codes), (0.3, [offset; 2]), 60.0, code).is_none()
    };
    (0..WAVES).filter(is_missed).count() as f64 / WAVES as f64
}

#[test]
fn waves_of_fewer_codes_may_not_be_found() {
    for (codes, of_i16, of_i32) in [
        (4.0, 0.05..0.2, 0.99..1.01),
        (6.0, 1e-3..0.03, 0.9..1.01),
        (8.0, 0.0..5e-3, 0.2..0.5),
        (12.0, 0.0..1e-9, 0.0..0.02),
        (16.0, 0.0..1e-9, 0.0..1e-9),
    ] {
        let [short, long] = [missed(codes, |x| x as i16), missed(codes, |x| x as i32)];
        println!("{codes} codes: {short:.3} missed in i16, {long:.3} in i32");
        assert!(
            of_i16.contains(&short) && of_i32.contains(&long),
            "{codes} codes: {short} {long}"
        );
    }
}

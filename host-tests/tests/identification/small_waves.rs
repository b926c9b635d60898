//! Waves of few codes, from cold: found soon from a dozen on, perhaps never below.

use antinode::period::DifferenceDetector;
use antinode::{Sample, SamplePair};
use antinode_sim::{Flaws, Gyro};
use host_tests::RATE;

use crate::detector::wave;

#[test]
fn a_wave_of_a_dozen_codes_is_found_soon() {
    let (mut latest, mut sum) = (0f64, 0.0);
    for seed in 0..4000 {
        let (wave, period) = wave(seed);
        let scale = 12.0 / wave.main_amplitude;
        let flaws = Flaws {
            noise: 0.5 / scale,
            offset_c: 31.0 / scale,
            ..Flaws::default()
        };
        let mut detector = DifferenceDetector::<i16>::new();
        let gyro = Gyro::new(wave, flaws, RATE, seed).unwrap();
        let codes = gyro.map(|pair| pair.map(|x| (scale * x).round() as i16));
        let found = codes
            .take((30.0 * period) as usize)
            .position(|pair| detector.push(pair).is_some());
        let time = found.unwrap() as f64 / period;
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
    let count = (0..WAVES)
        .filter(|&seed| {
            let (wave, period) = wave(seed);
            let scale = codes / wave.main_amplitude;
            let flaws = Flaws {
                noise: 0.3 / scale,
                ..Flaws::default()
            };
            let offset = (seed as f64 * 0.569_84).fract();
            let mut detector = DifferenceDetector::<S>::new();
            let gyro = Gyro::new(wave, flaws, RATE, seed).unwrap();
            !gyro
                .take((60.0 * period) as usize)
                .map(|pair| pair.map(|x| code((scale * x + offset).round())))
                .any(|pair| detector.push(pair).is_some())
        })
        .count();
    count as f64 / WAVES as f64
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

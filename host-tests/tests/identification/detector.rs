//! The period from cold: found soon, never in noise, and never a fraction or a multiple.

use antinode::period::{DifferenceDetector, MeanReturnDetector};
use antinode::{Detection, Identifier, Sample, SamplePair, Settings};
use antinode_sim::{Flaws, Gyro, Wave, random_wave};
use host_tests::{Core, RATE, identify, no_wave, stream, windows};

/// A wave with a period of 4 to 200 samples, spaced evenly in its logarithm.
pub fn wave(seed: u64) -> (Wave, f64) {
    let period = 4.0 * 50f64.powf((seed as f64 * 0.618_034).fract());
    (random_wave(seed, RATE / period, 0.5), period)
}

/// Searches of 10 000 waves with `push`, each over `periods` periods: the largest relative error, and the periods after which each was found,
/// in order.
fn starts(
    noise: f64,
    offset: f64,
    periods: f64,
    mut detector: impl FnMut() -> Box<dyn FnMut([f32; 2]) -> Option<f32>>,
) -> (f64, Vec<f64>) {
    let (mut worst, mut times) = (0f64, Vec::new());
    for seed in 0..10_000 {
        let (wave, period) = wave(seed);
        let a = wave.main_amplitude;
        let flaws = Flaws {
            noise: noise * a,
            offset_c: offset * a,
            offset_d: -offset * a,
            ..Flaws::default()
        };
        let mut push = detector();
        let gyro = Gyro::new(wave, flaws, RATE, seed).unwrap();
        let found = gyro
            .take((periods * period) as usize)
            .zip(1..)
            .find_map(|(pair, taken)| {
                push(pair.map(|x| x as f32)).map(|found| (f64::from(taken), f64::from(found)))
            });
        if let Some((taken, found)) = found {
            worst = worst.max((found / period - 1.0).abs());
            times.push(taken / period);
        }
    }
    times.sort_by(f64::total_cmp);
    (worst, times)
}

fn mean(times: &[f64]) -> f64 {
    times.iter().sum::<f64>() / times.len() as f64
}

#[test]
fn difference_detector_finds_every_wave_and_no_multiple() {
    for (noise, offset, error, latest) in [
        (0.0, 0.9, 1e-3, 3.2),
        (0.02, 0.9, 0.01, 3.2),
        (0.02, 20.0, 0.01, 3.3),
        (0.02, 98.0, 0.02, 4.3),
        (0.2, 0.9, 0.08, 8.0),
    ] {
        let (worst, times) = starts(noise, offset, 20.0, || {
            let mut detector = DifferenceDetector::new();
            Box::new(move |pair| detector.push(pair))
        });
        let (mean, first, last) = (mean(&times), times[0], times[times.len() - 1]);
        println!(
            "(10), noise {noise}, offset {offset}: worst {worst:.4}, time {first:.2} to {last:.2} periods, mean {mean:.2}"
        );
        assert_eq!(times.len(), 10_000, "noise {noise}");
        assert!(worst < error, "noise {noise}: {worst}");
        assert!(
            first > 2.3 && last < latest && mean < 3.0,
            "noise {noise}, offset {offset}: {first} {last} {mean}"
        );
    }
}

#[test]
fn mean_return_detector_finds_no_multiple() {
    for (noise, error, most) in [(0.0, 2e-3, 15), (0.02, 0.02, 40), (0.2, 0.08, 3700)] {
        let (worst, times) = starts(noise, 0.5, 40.0, || {
            let mut detector = MeanReturnDetector::new();
            Box::new(move |pair| detector.push(pair))
        });
        let (mean, none) = (mean(&times), 10_000 - times.len());
        println!(
            "(9), noise {noise}: worst {worst:.4}, mean time {mean:.2} periods, none {none} of 10 000"
        );
        assert!(worst < error, "noise {noise}: {worst}");
        assert!(none < most, "noise {noise}: {none}");
    }
}

#[test]
fn noise_is_no_wave() {
    for seed in 0..10_000 {
        let wave = no_wave();
        let flaws = Flaws {
            noise: 1.0,
            offset_c: 0.5,
            ..Flaws::default()
        };
        let mut difference = DifferenceDetector::new();
        let mut mean_return = MeanReturnDetector::new();
        for pair in Gyro::new(wave, flaws, RATE, seed).unwrap().take(2000) {
            let pair = pair.map(|x| x as f32);
            assert_eq!(difference.push(pair), None, "seed {seed}");
            assert_eq!(mean_return.push(pair), None, "seed {seed}");
        }
    }
}

/// Count of waves found in a million pairs of this noise, in codes; none of them is ever reported.
fn waves_in_noise<S: Sample>(noise: f64, code: fn(f64) -> S) -> usize
where
    [S; 2]: SamplePair<S>,
{
    let wave = no_wave();
    let flaws = Flaws::white(noise);
    let mut core = Identifier::<S, 200, 16>::new(windows(10)).unwrap();
    let mut found = 0;
    let gyro = Gyro::new(wave, flaws, RATE, 7).unwrap();
    for (k, pair) in gyro.take(1_000_000).enumerate() {
        // Offsets that drift from code to code.
        let offset = 2e-5 * k as f64;
        let was_searching = core.is_searching();
        let codes = [pair[0] + offset, pair[1] - offset].map(|x| code(x.round()));
        assert_eq!(core.push(codes), None, "noise of {noise} codes");
        found += usize::from(was_searching && !core.is_searching());
    }
    found
}

#[test]
fn noise_of_a_code_or_less_is_no_wave() {
    // Samples of two or three values would now and then look like a wave, if their rounding were not known.
    for noise in [0.3, 0.5, 0.8, 1.6] {
        assert_eq!(waves_in_noise(noise, |x| x as i16), 0, "{noise}");
        // The search uses all bits of these.
        let noise = noise / 4.0;
        assert_eq!(waves_in_noise(noise, |x| x as i32), 0, "{noise}");
    }
    // In f32 the rounding is not known: the first window shows that there is no wave.
    let found = waves_in_noise(0.1, |x| x as f32);
    println!("noise of 0.1 in f32: {found} waves found in a million pairs");
    assert!(found < 100);
}

#[test]
fn waves_beyond_4_to_200_samples_a_period_are_not_found() {
    for period in [3.75, 240.0] {
        let wave = random_wave(1, RATE / period, 0.3);
        let (mut difference, mut mean_return) =
            (DifferenceDetector::new(), MeanReturnDetector::new());
        for pair in stream(wave, Flaws::default(), 10_000, 1) {
            assert_eq!(difference.push(pair), None, "{period}");
            assert_eq!(mean_return.push(pair), None, "{period}");
        }
    }
}

#[test]
fn silence_is_no_wave() {
    let mut core = Core::new(windows(10)).unwrap();
    for k in 0..100_000 {
        let offset = if k < 50_000 { 0.0 } else { 0.7 };
        assert_eq!(core.push([offset, -offset]), None);
    }
    assert!(core.is_searching());
}

#[test]
fn the_first_estimate_comes_within_four_periods_of_its_window() {
    for seed in 0..300 {
        let (wave, period) = wave(seed);
        for periods in [2u16, 10, 50] {
            let flaws = Flaws::white(0.02 * wave.main_amplitude);
            let samples = ((f64::from(periods) + 6.0) * period) as usize;
            let estimates = identify(wave, &flaws, windows(periods), samples, seed);
            let end = estimates.first().map(|e| e.end() as f64 / period);
            let late = end.expect("a first window") - f64::from(periods);
            assert!(
                late < 4.0,
                "seed {seed}, {period} samples a period, {periods} periods: {late}"
            );
        }
    }
}

#[test]
fn a_wave_that_begins_late_is_found_as_soon() {
    // After silence, or after a drift too slow for any octave.
    for slope in [0.0, 0.02] {
        let (mut worst, mut latest, mut sum) = (0f64, 0f64, 0.0);
        for seed in 0..4000 {
            let (wave, period) = wave(seed);
            // At every place in a frame of any octave.
            let before = (seed as f64 * 0.381_966).fract() * 34.0 * (period / 4.0).max(1.0);
            let drift = |k: usize| slope * wave.main_amplitude * (k as f64 - before) / period;
            let mut detector = DifferenceDetector::<f32>::new();
            let gyro = Gyro::new(wave, Flaws::default(), RATE, seed).unwrap();
            let pairs = (0..before as usize)
                .map(|k| [drift(k), -drift(k)])
                .chain(gyro)
                .take((before + 40.0 * period) as usize);
            let found = pairs.enumerate().find_map(|(k, pair)| {
                let found = detector.push(pair.map(|x| x as f32))?;
                Some((k, f64::from(found)))
            });
            let (k, found) = found.unwrap();
            let time = (k as f64 - before) / period;
            worst = worst.max((found / period - 1.0).abs());
            latest = latest.max(time);
            sum += time;
        }
        let mean = sum / 4000.0;
        println!(
            "late, drift {slope}: worst {worst:.3}, mean {mean:.2} periods, latest {latest:.1}"
        );
        // A frame in which the wave began late looks slow, and begins anew.
        assert!(worst < 0.1 && mean < 3.0 && latest < 5.5);
    }
}

#[test]
fn mean_return_detection_finds_a_wave_that_begins_late() {
    for noise in [1e-3, 0.01] {
        let mut times = Vec::new();
        for seed in 0..2000 {
            let period = 4.6 * 40f64.powf((seed as f64 * 0.618_034).fract());
            let wave = random_wave(seed, RATE / period, 0.5);
            let flaws = Flaws {
                noise: noise * wave.main_amplitude,
                ..Flaws::default()
            };
            // After noise, whose mean is not the wave's.
            let before = (seed as f64 * 0.381_966).fract() * 25.0 * period;
            let silent = Gyro::new(no_wave(), flaws.clone(), RATE, seed).unwrap();
            let gyro = Gyro::new(wave, flaws, RATE, seed + 10_000).unwrap();
            let mut core = Core::new(Settings {
                detection: Detection::MeanReturn,
                ..Settings::new(RATE)
            })
            .unwrap();
            let clean = silent
                .take(before as usize)
                .chain(gyro.take((400.0 * period) as usize))
                .find_map(|pair| {
                    let row = core.push(pair.map(|x| x as f32))?;
                    row.flags.is_empty().then_some(row)
                });
            let clean = clean.unwrap();
            let off = clean.frequency - RATE / period;
            assert!(
                off.abs() < 6.0 * f64::from(clean.frequency_std),
                "{seed}: {clean:?}"
            );
            times.push((clean.start as f64 - before) / period);
        }
        times.sort_by(f64::total_cmp);
        let (mean, latest) = (mean(&times), times[times.len() - 1]);
        println!("(9) late, noise {noise}: mean {mean:.2} periods, latest {latest:.1}");
        assert!(
            mean < 14.0 && latest < 40.0,
            "noise {noise}: {mean} {latest}"
        );
    }
}

#[test]
fn a_wave_that_begins_after_two_tones_is_found_soon() {
    // Two tones of the wave's size look like a wave for ever: by then the search leaves looks out.
    let (mut latest, mut sum) = (0f64, 0.0);
    for seed in 0..4000 {
        let (wave, period) = wave(seed);
        let before = 2000 + seed as usize % 97;
        let tones = |k: usize| {
            let tone = |period: f64| (std::f64::consts::TAU * k as f64 / period).sin();
            wave.main_amplitude * (tone(4.5) + tone(7.65))
        };
        let mut detector = DifferenceDetector::<f32>::new();
        let gyro = Gyro::new(wave, Flaws::default(), RATE, seed).unwrap();
        let pairs = (0..before)
            .map(|k| [tones(k), 0.6 * tones(k)])
            .chain(gyro)
            .take(before + (40.0 * period) as usize);
        let found = pairs.enumerate().find_map(|(k, pair)| {
            let found = detector.push(pair.map(|x| x as f32))?;
            Some((k, f64::from(found)))
        });
        let (k, _) = found.unwrap();
        assert!(k >= before, "seed {seed}: found in two tones");
        let time = (k - before) as f64 / period;
        latest = latest.max(time);
        sum += time;
    }
    let mean = sum / 4000.0;
    println!("after two tones: mean {mean:.2} periods, latest {latest:.1}");
    assert!(mean < 4.0 && latest < 12.0);
}

#[test]
fn no_call_both_tries_many_samples_and_judges() {
    // Of a frame of 10 to 20 samples twelve are tried per call. The next call judges, unless the last ones were only two: then
    // their own call does.
    for (period, frame, calls) in [
        (4.1, 10, 2),
        (5.0, 12, 2),
        (6.2, 14, 2),
        (7.0, 16, 3),
        (8.5, 20, 3),
    ] {
        for seed in 0..50 {
            let wave = random_wave(seed, RATE / period, 0.5);
            let mut detector = DifferenceDetector::<f32>::new();
            let found = Gyro::new(wave, Flaws::default(), RATE, seed)
                .unwrap()
                .take(100)
                .position(|pair| detector.push(pair.map(|x| x as f32)).is_some());
            let pushed = found.expect("a period") + 1;
            assert_eq!(pushed, frame + calls, "{period} samples, seed {seed}");
        }
    }
}

#[test]
fn a_ramp_beside_a_pick_off_that_alternates_is_no_wave_and_no_overflow() {
    let mut detector = MeanReturnDetector::new();
    for k in 0..20_000u16 {
        let d = if k % 2 == 0 { 1.0 } else { -1.0 };
        assert_eq!(detector.push([f32::from(k), d]), None);
    }
}

//! Every arithmetic of the core on converter codes: error over the bound with the quantisation noise counted in, search, faults.

use antinode::period::DifferenceDetector;
use antinode::{Estimate, Flags, Settings};
use antinode_sim::{Flaws, random_wave};
use host_tests::codes::{codes, converted, identify, settings};
use host_tests::score::{Score, errors};
use host_tests::{RATE, gyro};

/// Period of the paper's gyro, samples.
const PERIOD: f64 = RATE / 5332.0;
/// The wave's share of full scale: offsets and noise of 20 % need the rest.
const SHARE: f64 = 0.42;

/// Estimates of one stream in f32, 16 bits and 32 bits.
fn each(codes: &[[i32; 2]], settings: Settings) -> [(&'static str, Vec<Estimate>); 3] {
    [
        ("f32", identify(codes, settings, |code| code as f32)),
        ("i16", identify(codes, settings, |code| code as i16)),
        ("i32", identify(codes, settings, |code| code)),
    ]
}

#[test]
fn every_arithmetic_reaches_the_bound_on_codes() {
    for bits in [12, 16] {
        for (periods, runs) in [(2, 400), (4, 400), (10, 400), (50, 250)] {
            for noise in [0.001, 0.02, 0.2] {
                let mut scores = [("", Score::default()); 3];
                for seed in 0..runs {
                    let wave = random_wave(seed, 5332.0, 0.5);
                    let a = wave.main_amplitude;
                    let flaws = Flaws {
                        noise: noise * a,
                        offset_c: 0.3 * a,
                        offset_d: -0.1 * a,
                        ..Flaws::default()
                    };
                    let (wave, flaws) = converted(&wave, &flaws, bits, SHARE);
                    let sigma = (flaws.noise.powi(2) + 1.0 / 12.0).sqrt();
                    let samples = (PERIOD * (f64::from(periods) * 8.6 + 12.0)) as usize;
                    let stream = codes(wave, &flaws, samples, seed + 1000);
                    let found = each(&stream, settings(bits, periods));
                    for ((name, score), (arithmetic, estimates)) in scores.iter_mut().zip(found) {
                        *name = arithmetic;
                        for estimate in estimates.iter().take(8) {
                            score.add(estimate, &wave, sigma);
                        }
                    }
                }
                let limit = if periods == 2 && noise == 0.2 {
                    1.15
                } else {
                    1.08
                };
                for (arithmetic, score) in scores {
                    let label =
                        format!("{arithmetic}, {bits} bits, {periods} periods, noise {noise}");
                    assert!(score.windows() >= 7 * runs as usize, "{label}");
                    score.check(&label, 0.0..limit, 0.9..1.12);
                }
            }
        }
    }
}

#[test]
fn codes_of_30_bits_without_noise_are_exact() {
    let mut worst = [0f64; 4];
    for seed in 0..200 {
        let period = 4.3 * (190.0f64 / 4.3).powf((seed as f64 * 0.618_034).fract());
        let periods = 2 + (seed % 30) as u16;
        let wave = random_wave(seed, RATE / period, 0.5);
        let flaws = Flaws {
            offset_c: 0.8 * wave.main_amplitude,
            offset_d: -0.3 * wave.main_amplitude,
            ..Flaws::default()
        };
        let (wave, flaws) = converted(&wave, &flaws, 30, SHARE);
        let samples = (period * (f64::from(periods) * 3.2 + 10.0)) as usize;
        let stream = codes(wave, &flaws, samples, seed);
        let estimates = identify(&stream, settings(30, periods), |code| code);
        assert!(
            estimates.len() >= 3,
            "seed {seed}: {} windows",
            estimates.len()
        );
        for estimate in &estimates {
            assert!(estimate.flags.is_empty(), "seed {seed}: {}", estimate.flags);
            let [main, quadrature, angle, frequency] = errors(estimate, &wave);
            let a = wave.main_amplitude;
            let relative = [main / a, quadrature / a, angle, frequency / wave.frequency];
            for (worst, error) in worst.iter_mut().zip(relative) {
                *worst = worst.max(error.abs());
            }
        }
    }
    println!("worst errors: {worst:?}");
    assert!(
        worst[0] < 1e-6 && worst[1] < 1e-6 && worst[2] < 1e-6,
        "{worst:?}"
    );
    assert!(worst[3] < 2e-7, "{worst:?}");
}

#[test]
fn codes_are_found_from_cold_whatever_their_size() {
    for (bits, share) in [(16, 0.9), (16, 0.01), (12, 0.9), (12, 0.1)] {
        let mut latest = 0f64;
        for seed in 0..2_000 {
            let period = 4.0 * 50f64.powf((seed as f64 * 0.618_034).fract());
            let wave = random_wave(seed, RATE / period, 0.5);
            let flaws = Flaws::white(0.02 * wave.main_amplitude);
            let (wave, flaws) = converted(&wave, &flaws, bits, share);
            let mut detector = DifferenceDetector::<i16>::new();
            let stream = codes(wave, &flaws, (20.0 * period) as usize, seed);
            let found = stream
                .iter()
                .enumerate()
                .find_map(|(k, pair)| Some((k, detector.push(pair.map(|code| code as i16))?)));
            let (k, found) =
                found.unwrap_or_else(|| panic!("{bits} bits, {share}, seed {seed}: none"));
            assert!(
                (f64::from(found) / period - 1.0).abs() < 0.02,
                "{bits} bits, seed {seed}: {found} for {period}"
            );
            latest = latest.max(k as f64 / period);
        }
        println!("{bits} bits, {share} of full scale: latest {latest:.1} periods");
        assert!(latest < 4.0, "{bits} bits, {share}: {latest}");
    }
}

#[test]
fn faults_on_codes_are_flagged_in_every_arithmetic() {
    for seed in 0..10 {
        let (wave, flaws) = gyro(seed);
        let (wave, flaws) = converted(&wave, &flaws, 12, 0.8);
        let clean = codes(wave, &flaws, 60_000, seed);
        let (from, to) = (30_000, 30_400);
        let changed = |change: &dyn Fn(i32) -> i32| {
            let mut stream = clean.clone();
            stream[from..to]
                .iter_mut()
                .for_each(|pair| *pair = pair.map(change));
            stream
        };
        let dropout = changed(&|_| 3);
        let clipped = changed(&|code| (code * 2).clamp(-2048, 2047));
        for (arithmetic, estimates) in each(&clean, settings(12, 10)) {
            assert!(estimates.len() > 300, "{arithmetic}");
            assert!(
                estimates.iter().all(|e| e.flags.is_empty()),
                "{arithmetic}, seed {seed}"
            );
        }
        for (fault, stream, flag) in [
            ("dropout", dropout, Flags::empty()),
            ("clipping", clipped, Flags::CLIPPED),
        ] {
            for (arithmetic, estimates) in each(&stream, settings(12, 10)) {
                let mut touched = 0;
                for estimate in &estimates {
                    let (start, end) = (estimate.start as usize, estimate.end() as usize);
                    let shared = end.min(to).saturating_sub(start.max(from));
                    if shared > 20 {
                        touched += 1;
                        assert!(
                            !estimate.flags.is_empty() && estimate.flags.contains(flag),
                            "{fault}, {arithmetic}, seed {seed}: {estimate:?}"
                        );
                    }
                }
                let after = estimates.iter().filter(|e| e.start as usize > to + 1_500);
                let clean = after.clone().filter(|e| e.flags.is_empty()).count();
                assert!(
                    touched > 0 && after.count() == clean,
                    "{fault}, {arithmetic}, seed {seed}"
                );
            }
        }
    }
}

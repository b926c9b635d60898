//! Every arithmetic of the core on converter codes: error over the bound with the quantisation noise counted in, overflow, faults.

use antinode::block::Demodulator;
use antinode::period::DifferenceDetector;
use antinode::phase::PhaseStep;
use antinode::{Estimate, Flags, Packed, Sample, SamplePair, Settings};
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

/// The sums of one block of codes at full scale, with the signs that make them largest.
fn sums_at_full_scale<S: Sample>(length: u16, least: S, most: S) -> [[f64; 3]; 2]
where
    [S; 2]: SamplePair<S>,
{
    let step = PhaseStep::from_period(f32::from(length.max(4)));
    let mut demodulator = Demodulator::<S, 256>::new(step, length, 0, true);
    let middle = f64::from(length - 1) / 2.0;
    let mut block = None;
    for k in 0..length {
        let phase = std::f64::consts::TAU * (f64::from(k) - middle) / f64::from(length.max(4));
        let pick = |weight: f64| if weight < 0.0 { least } else { most };
        block = demodulator
            .push([pick(phase.cos()), pick(phase.sin())])
            .copied();
    }
    let block = block.expect("the block is whole");
    block.sums.map(|sums| {
        [sums.cosine, sums.sine, sums.sum]
            .map(|sum| f64::from(S::sum_to_f32(sum)) / f64::from(block.layout.scale.max(1)))
    })
}

#[test]
fn nothing_overflows_at_full_scale() {
    for length in 1..=256u16 {
        // f32 never overflows with the same signs: the integers must agree with it.
        let float = sums_at_full_scale(length, -1f32, 1.0);
        let short = sums_at_full_scale(length, i16::MIN, i16::MAX);
        let long = sums_at_full_scale(length, i32::MIN, i32::MAX);
        for (codes, full_scale) in [(short, 32_768.0), (long, 2_147_483_648.0)] {
            for channel in 0..2 {
                for i in 0..2 {
                    let error = (codes[channel][i] / full_scale - float[channel][i]).abs();
                    let room =
                        1e-4 * f64::from(length) + 2.0 * f64::from(length).powi(2) / 65_535.0;
                    assert!(
                        error < room,
                        "length {length}, channel {channel}, sum {i}: {error}"
                    );
                }
            }
        }
        // With all samples at the rail the plain sum is at its limit.
        let step = PhaseStep::from_period(20.0);
        let mut demodulator = Demodulator::<i16, 256>::new(step, length, 0, false);
        let rail = vec![Packed(0x8000_8000); usize::from(length)];
        let (_, block) = demodulator.push_slice(&rail);
        let sums = block.expect("the block is whole").sums;
        assert_eq!(sums[0].sum, i32::from(i16::MIN) * i32::from(length));
    }
}

#[test]
fn packed_codes_and_single_words_give_the_same_blocks() {
    let step = PhaseStep::from_period(18.75);
    let pairs: Vec<[i16; 2]> = (0..2_000)
        .map(|k: i32| [(k * 7_919) as i16, (k * 104_729) as i16])
        .collect();
    let packed: Vec<Packed> = pairs.iter().map(|&pair| pair.into()).collect();
    let mut single = Demodulator::<i16, 64>::new(step, 19, 0, true);
    let expected: Vec<_> = pairs
        .iter()
        .filter_map(|&pair| single.push(pair).copied())
        .collect();
    // Cut at every length, so that slices begin at even and at odd samples, and mixed with single pushes.
    for cut in 1..40 {
        let mut mixed = Demodulator::<i16, 64>::new(step, 19, 0, true);
        let mut found = Vec::new();
        for (i, part) in packed.chunks(cut).enumerate() {
            if i % 3 == 2 {
                found.extend(part.iter().filter_map(|word| mixed.push(word.0).copied()));
                continue;
            }
            let mut part = part;
            while !part.is_empty() {
                let (taken, block) = mixed.push_slice(part);
                found.extend(block.copied());
                part = &part[taken..];
            }
        }
        assert_eq!(found, expected, "slices of {cut}");
    }
}

#[test]
fn codes_are_found_from_cold_whatever_their_size() {
    for (bits, share) in [(16, 0.9), (16, 0.01), (12, 0.9), (12, 0.1)] {
        let mut latest = 0f64;
        for seed in 0..2_000 {
            let period = 4.0 * 50f64.powf((seed as f64 * 0.618_034).fract());
            let wave = random_wave(seed, RATE / period, 0.5);
            let flaws = Flaws {
                noise: 0.02 * wave.main_amplitude,
                ..Flaws::default()
            };
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

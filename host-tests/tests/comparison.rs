//! All methods side by side: silent in white noise, loud where the signal is not one steady wave, ranked by J and conditions.

use std::f64::consts::TAU;

use antinode::methods::comparison::{Comparison, Reference, Sums, compare};
use antinode::methods::{Delayed, Moments, Products, algorithm2};
use antinode_sim::{Flaws, Gyro, Wave, random_wave};
use host_tests::{Core, RATE, windows};

/// Every window of a gyro, `spoil` having had its samples first.
fn comparisons(
    wave: Wave,
    flaws: &Flaws,
    periods: u16,
    samples: usize,
    seed: u64,
    spoil: impl Fn(usize, [f64; 2]) -> [f64; 2],
) -> Vec<Comparison> {
    let gyro = Gyro::new(wave, flaws.clone(), RATE, seed).expect("a valid gyro");
    let pairs: Vec<[f32; 2]> = gyro
        .take(samples)
        .enumerate()
        .map(|(k, pair)| spoil(k, [pair.c, pair.d]).map(|x| x as f32))
        .collect();
    let mut core = Box::new(Core::new(windows(periods)).expect("valid settings"));
    let mut found = Vec::new();
    core.extend(&pairs, |estimate| {
        let omega = TAU * estimate.frequency / RATE;
        let (start, end) = (
            estimate.start as usize,
            estimate.start as usize + estimate.samples as usize,
        );
        let offsets = estimate.offsets;
        let centred: Vec<[f32; 2]> = pairs[start - 20..end]
            .iter()
            .map(|p| [p[0] - offsets[0], p[1] - offsets[1]])
            .collect();
        let sums = Sums {
            moments: Moments::of(&centred[20..]),
            delayed: Delayed::of(&centred, 20, algorithm2::quarter_lag((TAU / omega) as f32)),
            products: Products::of(&centred[20..], omega),
        };
        found.push(compare(&sums, &Reference::of(&estimate, RATE)));
    });
    found
}

/// Of the windows, how many disagree.
fn disagree(found: &[Comparison]) -> usize {
    found
        .iter()
        .filter(|comparison| comparison.disagree)
        .count()
}

#[test]
fn methods_agree_in_white_noise() {
    let mut total = 0;
    for noise in [0.0, 1e-4, 0.001, 0.02, 0.1, 0.2] {
        for periods in [2, 4, 10, 50] {
            let (mut count, mut loud) = (0, 0);
            for seed in 0..30 {
                let wave = Wave {
                    angle_rate: 0.5,
                    decay_rate: 0.3,
                    ..random_wave(seed, 5332.0, 0.5)
                };
                let flaws = Flaws {
                    noise: noise * wave.main_amplitude,
                    offset_c: 0.2,
                    ..Flaws::default()
                };
                let found = comparisons(wave, &flaws, periods, 9000, seed, |_, pair| pair);
                count += found.len();
                loud += disagree(&found);
            }
            total += count;
            println!("noise {noise}, {periods} periods: {loud} of {count} windows disagree");
            assert!(
                loud * 1000 <= count,
                "noise {noise}, {periods} periods: {loud}"
            );
        }
    }
    assert!(total > 10_000);
}

#[test]
fn methods_part_company_where_the_signal_is_not_one_wave() {
    let flaws = Flaws {
        noise: 0.002,
        ..Flaws::default()
    };
    let loud = |spoil: &dyn Fn(usize, [f64; 2]) -> [f64; 2]| {
        let found = comparisons(Wave::default(), &flaws, 10, 9000, 1, spoil);
        disagree(&found) as f64 / found.len() as f64
    };
    // A second tone of 10 % beyond the demodulator's band, a third harmonic of 10 %, a limiter at 60 %.
    let tone = loud(&|k, [c, d]| {
        let beside = 0.2 * (TAU * 0.137 * k as f64).sin();
        [c + beside, d - beside]
    });
    let harmonic = loud(&|k, [c, d]| {
        let third = 0.2 * (3.0 * TAU * 0.05332 * k as f64).sin();
        [c + third, d]
    });
    let limited = loud(&|_, pair| pair.map(|x| x.clamp(-0.6, 0.6)));
    println!(
        "share of windows that disagree: second tone {tone}, third harmonic {harmonic}, limiter {limited}"
    );
    assert_eq!([tone, harmonic, limited], [1.0; 3]);
}

#[test]
fn ranks_follow_conditions_and_j() {
    let noisy = Flaws {
        noise: 0.2,
        ..Flaws::default()
    };
    // (8) holds to within the noise.
    for comparison in comparisons(Wave::default(), &noisy, 10, 9000, 3, |_, pair| pair) {
        let mut ranks = comparison.methods.map(|method| method.rank);
        let methods = comparison.methods;
        for a in &methods {
            for b in &methods {
                let better = a.conditions_hold && !b.conditions_hold;
                let equal = a.conditions_hold == b.conditions_hold;
                if better || equal && a.j < b.j {
                    assert!(a.rank < b.rank);
                }
            }
        }
        ranks.sort_unstable();
        assert_eq!(ranks, [1, 2, 3, 4]);
        assert!(methods[3].conditions_hold && comparison.leakage < 2e-2);
        // Noise of 0.2 makes J about 2·0.04; a wrong wave makes more.
        assert!((methods[3].j / 0.08 - 1.0).abs() < 0.5, "{}", methods[3].j);
    }
    // A quadrature far above noise fails the condition of algorithm 1 alone: last.
    let wave = Wave {
        quadrature_amplitude: 0.8,
        ..Wave::default()
    };
    for comparison in comparisons(wave, &noisy, 10, 9000, 3, |_, pair| pair) {
        assert!(!comparison.methods[0].conditions_hold);
        assert_eq!(comparison.methods[0].rank, 4);
    }
}

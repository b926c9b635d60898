//! Common parts of the four methods: sums of a stream, the functional J, the search for the frequency, and the exact solution.

use std::f64::consts::{PI, TAU};

use antinode::block::Demodulator;
use antinode::methods::{
    Delayed, DelayedSums, MomentSums, Moments, Products, Wave as Found, algorithm1, algorithm3,
    algorithm4, exact, frequency, functional, phase,
};
use antinode::phase::PhaseStep;
use antinode_sim::{Wave, random_wave};
use host_tests::methods::{LEAD, list, numbers, omega, samples};
use host_tests::printed::Window;
use host_tests::{RATE, angle_error};

#[test]
fn j_from_sums_equals_j_from_samples() {
    for seed in 0..50 {
        let wave = random_wave(seed, 5332.0, 0.5);
        let pairs = samples(&wave, 1 + seed as usize % 10);
        let window = &pairs[LEAD..];
        let doubles: Vec<[f64; 2]> = window.iter().map(|p| p.map(f64::from)).collect();
        // A wrong frequency makes J large.
        let omega = omega(&wave) * 1.01;
        let plain = Window {
            pairs: &doubles,
            lead: 0,
            omega,
        };
        let (moments, products) = (Moments::of(window), Products::of(window, omega));
        let found = algorithm4::wave(&products);
        let j = functional::squares(&found, &moments, &products);
        let truth = plain.j(numbers(&found));
        assert!(
            (j - truth).abs() < 1e-7 * moments.power(),
            "{j:e} {truth:e}"
        );
        assert!(truth > 1e-5 * moments.power());
        let other = Found {
            phase: found.phase + PI,
            ..found
        };
        assert!(functional::squares(&other, &moments, &products) > j);
    }
}

#[test]
fn frequency_is_refined_on_a_grid_and_exactly() {
    let wave = Wave::default();
    let hertz = TAU / RATE;
    for periods in [1usize, 4, 10] {
        let pairs = samples(&wave, periods);
        let window = &pairs[LEAD..];
        let moments = Moments::of(window);
        let third = algorithm3::shape(&moments, 1.0);
        let j = |omega: f64| {
            let products = Products::of(window, omega);
            functional::squares(&phase::align(&third, &products), &moments, &products)
        };
        let start = TAU / 19.0;
        let near = frequency::on_grid(start, hertz, 400, j);
        // Trying every grid point finds the same.
        let each = (-400..=400)
            .map(|i| start + f64::from(i) * hertz)
            .min_by(|a, b| j(*a).total_cmp(&j(*b)))
            .unwrap();
        assert!((near - each).abs() < 1e-9, "{near} {each}");
        let fine = frequency::exact(near, window.len() as u32, j);
        assert!((fine - near).abs() < 0.51 * hertz);
        assert!(j(fine) <= j(near));
        // (15) has its minimum near it.
        let first = algorithm1::shape(&moments);
        let sharp = frequency::on_grid(start, hertz, 400, |omega| {
            let wave = phase::align(&first, &Products::of(window, omega));
            functional::absolutes(&wave, window, omega)
        });
        let solved = exact::solve(window, near);
        let errors = [near, fine, sharp, solved.omega].map(|w| w / hertz - 5332.0);
        println!(
            "{periods} periods: 1 Hz grid, exact, (15), least squares: {} Hz",
            list(&errors)
        );
        assert!(errors[0].abs() < 25.0);
        // Over one period, quadrature and the grid keep (15) at its start.
        assert!(periods == 1 || errors[2].abs() < 25.0);
        assert!(errors[3].abs() < 2e-3 * 4.0 / periods as f64, "{errors:?}");
    }
}

#[test]
fn the_exact_solution_has_no_leakage_and_fits_offsets() {
    for seed in 0..60 {
        let wave = random_wave(seed, 5332.0, 0.5);
        for periods in [1, 2, 3, 10] {
            let mut pairs = samples(&wave, periods);
            for pair in &mut pairs {
                pair[0] += 0.3;
                pair[1] -= 0.1;
            }
            let solved = exact::solve(&pairs[LEAD..], omega(&wave) * 1.01);
            let [a, b, theta, _] = numbers(&solved.wave);
            // Rounding of f32 samples, amplified by one period with free offsets and frequency.
            let share = if periods == 1 { 1e-5 } else { 2e-6 };
            let size = wave.main_amplitude;
            assert!((a - size).abs() < share * size, "{seed} {periods}: {a}");
            assert!((b - wave.quadrature_amplitude).abs() < share * size);
            assert!(angle_error(theta, wave.angle).abs() < share);
            assert!((solved.offsets[0] - 0.3).abs() < share * size);
            assert!((solved.offsets[1] + 0.1).abs() < share * size);
        }
    }
}

#[test]
fn sums_of_codes_are_exact_at_full_scale() {
    // Codes over the whole range, every tenth at its end: there the subtracted offset takes some beyond 16 bits, and they are limited.
    let offsets = [7.0f32, -3.0];
    let codes: Vec<[i16; 2]> = (0..40_000u32)
        .map(|k| {
            let word = k.wrapping_mul(2_654_435_761) ^ k << 9;
            match k % 10 {
                0 => [i16::MIN, i16::MAX],
                5 => [i16::MIN, i16::MIN],
                _ => [word as i16, (word >> 16) as i16],
            }
        })
        .collect();
    let centred = |pair: [i16; 2]| {
        [
            (f64::from(pair[0]) - 7.0).clamp(-32_768.0, 32_767.0),
            (f64::from(pair[1]) + 3.0).clamp(-32_768.0, 32_767.0),
        ]
    };
    let (mut moments, mut delayed) = (
        MomentSums::<i16>::new(offsets),
        DelayedSums::<50, i16>::new(5, offsets),
    );
    let (mut cut_moments, mut cut_delayed) = (moments.clone(), delayed.clone());
    moments.extend(&codes);
    delayed.extend(&codes);
    for part in codes.chunks(37) {
        cut_moments.extend(part);
        cut_delayed.extend(part);
    }
    let (moments, delayed) = (moments.take(), delayed.take());
    assert_eq!(moments, cut_moments.take());
    assert_eq!(delayed, cut_delayed.take());
    let sum = |of: &dyn Fn([f64; 2]) -> f64| codes.iter().map(|&p| of(centred(p))).sum::<f64>();
    assert_eq!(moments.cc, sum(&|[c, _]| c * c));
    assert_eq!(moments.dd, sum(&|[_, d]| d * d));
    assert_eq!(moments.cd, sum(&|[c, d]| c * d));
    let pairs = || {
        codes
            .iter()
            .skip(5)
            .zip(&codes)
            .map(|(&a, &b)| (centred(a), centred(b)))
    };
    assert_eq!(delayed.cd, pairs().map(|(a, b)| a[0] * b[1]).sum::<f64>());
    let own = |(a, b): ([f64; 2], [f64; 2])| a[0] * b[0] + a[1] * b[1];
    assert_eq!(delayed.own, pairs().map(own).sum::<f64>());
    assert!(moments.cc > 40_000.0 * 5.0e8);
}

#[test]
fn streaming_sums_equal_those_of_the_slice() {
    let wave = Wave::default();
    let (offsets, length) = ([0.4f32, -0.2f32], 19u16);
    let raw: Vec<[f32; 2]> = samples(&wave, 12);
    let shifted: Vec<[f32; 2]> = raw
        .iter()
        .map(|p| [p[0] + offsets[0], p[1] + offsets[1]])
        .collect();
    let step = PhaseStep::from_period(18.754_688);
    let mut blocks = Vec::new();
    let mut demodulator = Demodulator::<f32, 64>::new(step, length, 0, true);
    let mut moment_sums = MomentSums::new(offsets);
    let mut delayed_sums = DelayedSums::<50>::new(5, offsets);
    let (mut moments, mut delayed) = (
        Moments::default(),
        Delayed {
            lag: 5,
            ..Delayed::default()
        },
    );
    for &pair in shifted.iter().take(190) {
        moment_sums.push(pair);
        delayed_sums.push(pair);
        if let Some(block) = demodulator.push(pair) {
            blocks.push(*block);
            moments = moments.with(&moment_sums.take());
            delayed = delayed.with(&delayed_sums.take());
        }
    }
    assert_eq!((blocks.len(), moments.count, delayed.count), (10, 190, 185));
    // However the slice is cut, the sums are the same to the bit.
    let (mut by_one, mut by_slice) = (
        (MomentSums::new(offsets), DelayedSums::<50>::new(5, offsets)),
        (MomentSums::new(offsets), DelayedSums::<50>::new(5, offsets)),
    );
    for (i, part) in shifted.chunk_by(|a, b| a[0] < b[0]).enumerate() {
        for &pair in part {
            by_one.0.push(pair);
            by_one.1.push(pair);
        }
        by_slice.0.extend(part);
        by_slice.1.extend(part);
        if i % 3 == 0 {
            assert_eq!(by_one.0.take(), by_slice.0.take());
            assert_eq!(by_one.1.take(), by_slice.1.take());
        }
    }
    assert_eq!(by_one.0.take(), by_slice.0.take());
    assert_eq!(by_one.1.take(), by_slice.1.take());
    let near = |a: f64, b: f64| assert!((a - b).abs() < 3e-6, "{a} {b}");
    let whole = Moments::of(&raw[..190]);
    let (cc, dd, cd) = moments.means();
    let (wc, wd, wcd) = whole.means();
    near(cc, wc);
    near(dd, wd);
    near(cd, wcd);
    near(delayed.q(), Delayed::of(&raw[..190], 5, 5).q());
    let offsets = offsets.map(f64::from);
    let products = Products::from_blocks(&blocks).unwrap().centred(offsets);
    let direct = Products::of(&raw[..190], products.omega);
    for i in 0..2 {
        near(products.cosine[i], direct.cosine[i]);
        near(products.sine[i], direct.sine[i]);
        near(products.mean[i], direct.mean[i]);
    }
    assert!(Products::from_blocks::<f32>([]).is_none());
}

#[test]
fn products_of_codes_allow_for_the_rounded_reference() {
    let step = PhaseStep::from_period(18.754);
    for length in [5, 19, 38, 75] {
        let mut demodulator = Demodulator::<i16, 200>::new(step, length, 0, false);
        let wave =
            |k: usize, phase: f64| (1500.0 * (0.335 * k as f64 + phase).sin()).round() as i16;
        // About mid-scale, as a converter with unsigned codes gives them.
        let codes: Vec<[i16; 2]> = (0..10 * usize::from(length))
            .map(|k| [2048 + wave(k, 0.3), 2040 - wave(k, 1.9)])
            .collect();
        let blocks: Vec<_> = codes
            .iter()
            .filter_map(|&pair| demodulator.push(pair).copied())
            .collect();
        let products = Products::from_blocks(&blocks).unwrap();
        let pairs: Vec<[f32; 2]> = codes.iter().map(|pair| pair.map(f32::from)).collect();
        let direct = Products::of(&pairs, products.omega);
        for i in 0..2 {
            for (found, wanted) in [
                (products.cosine[i], direct.cosine[i]),
                (products.sine[i], direct.sine[i]),
            ] {
                assert!(
                    (found - wanted).abs() < 2e-3,
                    "blocks of {length}: {found} {wanted}"
                );
            }
        }
    }
}

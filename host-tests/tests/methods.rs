//! The four methods against an independent double-precision evaluation of the printed formulas, and against the wave itself.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use antinode::block::{Demodulator, Layout};
use antinode::methods::{
    Delayed, DelayedSums, MomentSums, Moments, Products, Ratio, Wave as Found, algorithm1,
    algorithm2, algorithm3, algorithm4, exact, frequency, functional, phase,
};
use antinode::phase::PhaseStep;
use antinode_sim::{Wave, random_wave};
use host_tests::printed::Window;
use host_tests::{RATE, angle_error, phase_error};

/// Samples before a window's time zero, enough for a quarter period.
const LEAD: usize = 10;

/// A window of `periods` of a wave, `LEAD` samples before it.
fn samples(wave: &Wave, periods: usize) -> Vec<[f32; 2]> {
    let n = (periods as f64 * RATE / wave.frequency).round() as usize;
    (0..n + LEAD)
        .map(|k| {
            let (c, d) = wave.pick_offs((k as f64 - LEAD as f64) / RATE);
            [c as f32, d as f32]
        })
        .collect()
}

/// What the core finds, algorithm by algorithm; 2 with the printed delay.
fn found(pairs: &[[f32; 2]], omega: f64) -> [Found; 4] {
    let window = &pairs[LEAD..];
    let (moments, products) = (Moments::of(window), Products::of(window, omega));
    let lag = algorithm2::choose_lag(pairs, LEAD, algorithm2::quarter_lag((TAU / omega) as f32));
    let delayed = Delayed::of(pairs, LEAD, lag);
    [
        phase::align(&algorithm1::shape(&moments), &products),
        phase::align(&algorithm2::shape(&moments, delayed.q()), &products),
        phase::align(&algorithm3::shape(&moments, products.q()), &products),
        algorithm4::wave(&products),
    ]
}

fn numbers(wave: &Found) -> [f64; 4] {
    let s = wave.shape;
    [
        s.main_amplitude,
        s.quadrature_amplitude,
        s.angle,
        wave.phase,
    ]
}

fn omega(wave: &Wave) -> f64 {
    TAU * wave.frequency / RATE
}

#[test]
fn agree_with_double_precision_to_1e_minus_5() {
    let mut worst = [0f64; 4];
    let mut waves = vec![
        Wave::default(),
        Wave {
            quadrature_amplitude: -0.1,
            ..Wave::default()
        },
    ];
    waves.extend((0..100).map(|seed| random_wave(seed, 5332.0, 0.5)));
    // A relative error of a_B or an angle near 0 says nothing.
    waves.retain(|w| (w.quadrature_amplitude / w.main_amplitude).abs() > 0.03);
    assert!(waves.len() > 80);
    for wave in &waves {
        for periods in 1..=10 {
            let pairs = samples(wave, periods);
            let doubles: Vec<[f64; 2]> = (0..pairs.len())
                .map(|k| wave.pick_offs((k as f64 - LEAD as f64) / RATE).into())
                .collect();
            let omega = omega(wave);
            let window = Window {
                pairs: &doubles,
                lead: LEAD,
                omega,
            };
            let lag = (0..=1).map(|i| 4 + i).min_by(|&a, &b| {
                let miss = |m: usize| (omega * m as f64).cos().abs();
                miss(a).total_cmp(&miss(b))
            });
            let q = window.q(lag.unwrap());
            let fourth = window.algorithm4();
            let truths = [
                window.algorithm1(),
                window.algorithm2(q),
                window.algorithm3(fourth[1]),
                fourth,
            ];
            for (i, (found, truth)) in found(&pairs, omega).iter().zip(truths).enumerate() {
                let found = numbers(found);
                let errors = [
                    (found[0] - truth[0]) / truth[0],
                    if i == 0 {
                        found[1]
                    } else {
                        (found[1] - truth[1]) / truth[1]
                    },
                    angle_error(found[2], truth[2]) / truth[2].abs().max(0.1),
                    phase_error(found[3], truth[3]) / truth[3].abs().max(0.1),
                ];
                for error in errors {
                    worst[i] = worst[i].max(error.abs());
                }
            }
        }
    }
    println!(
        "worst relative difference of algorithms 1 to 4: {}",
        list(&worst)
    );
    assert!(worst.iter().all(|&w| w < 1e-5), "{}", list(&worst));
}

#[test]
fn errors_are_the_reference_values() {
    let wave = Wave::default();
    let table = [
        (1, [3.5e-3, 1.8e-4, 1.8e-2], [7.2e-3, 3.8e-4, 3.6e-2]),
        (4, [4.6e-5, 2.3e-6, 3.6e-4], [9.2e-5, 4.6e-6, 7.2e-4]),
        (10, [8.2e-4, 4.1e-5, 3.3e-3], [1.6e-3, 8.2e-5, 6.6e-3]),
    ];
    for (periods, third, fourth) in table {
        let found = found(&samples(&wave, periods), omega(&wave));
        for (name, found, wanted) in [("3", found[2], third), ("4", found[3], fourth)] {
            let shape = found.shape;
            let errors = [
                (shape.main_amplitude - 2.0).abs(),
                (shape.quadrature_amplitude.abs() - 0.1).abs(),
                (shape.angle - wave.angle).abs().to_degrees(),
            ];
            println!(
                "N = {periods}, algorithm {name}: {} for {}",
                list(&errors),
                list(&wanted)
            );
            for (error, wanted) in errors.iter().zip(wanted) {
                assert!((error / wanted - 1.0).abs() < 0.04, "{error:e} {wanted:e}");
            }
        }
    }
}

#[test]
fn quadrants_signs_and_phases_are_right_all_around() {
    for i in 0..64 {
        for ratio in [-0.4, -0.05, 0.05, 0.4] {
            for j in 0..8 {
                let wave = Wave {
                    main_amplitude: 1.5,
                    quadrature_amplitude: 1.5 * ratio,
                    angle: PI * (f64::from(i) + 0.5) / 32.0,
                    phase: FRAC_PI_4 * f64::from(j) - 3.0,
                    ..Wave::default()
                };
                // Four periods fit the grid; the fractional delay fits the quarter.
                let pairs = samples(&wave, 4);
                let window = &pairs[LEAD..];
                let (moments, products) = (Moments::of(window), Products::of(window, omega(&wave)));
                let q = Delayed::of(&pairs, LEAD, 5).quarter(&moments, omega(&wave));
                let second = algorithm2::shape(&moments, q);
                let third = algorithm3::shape(&moments, -q);
                let all = [
                    phase::align(&second, &products),
                    phase::align(&third, &products),
                    algorithm4::wave(&products),
                    exact::solve(window, omega(&wave)).wave,
                ];
                for (which, found) in all.iter().enumerate() {
                    let [a, b, theta, alpha] = numbers(found);
                    assert!((a - 1.5).abs() < 2e-3, "{which}: {wave:?} {found:?}");
                    assert!(
                        (b - 1.5 * ratio).abs() < 2e-3,
                        "{which}: {wave:?} {found:?}"
                    );
                    let turned = (theta - wave.angle) / (PI / 2.0);
                    assert!((turned - turned.round()).abs() < 2e-3, "{which}: {wave:?}");
                    // (θ + π/2, α + π) is the same motion: both must be moved alike.
                    let move_by = PI * turned.round();
                    let miss = (alpha - wave.phase - move_by).sin().abs();
                    let right = (alpha - wave.phase - move_by).cos() > 0.0;
                    assert!(miss < 3e-3 && right, "{which}: {wave:?} {found:?}");
                }
                let first = algorithm1::shape(&moments);
                let off = angle_error(first.angle, wave.angle).abs();
                assert!(off < 0.5 * ratio.abs() + 1e-3, "{wave:?} {first:?}");
            }
        }
    }
}

#[test]
fn a_fractional_delay_removes_the_grid_error() {
    let wave = Wave::default();
    let pairs = samples(&wave, 4);
    let moments = Moments::of(&pairs[LEAD..]);
    let delayed = Delayed::of(&pairs, LEAD, 5);
    let error = |q| (algorithm2::shape(&moments, q).quadrature_amplitude - 0.1).abs();
    let (whole, fractional) = (
        error(delayed.q()),
        error(delayed.quarter(&moments, omega(&wave))),
    );
    println!("a_B error of algorithm 2: {whole:.1e} on the grid, {fractional:.1e} between");
    assert!(whole > 0.08 && fractional < 3e-4);
    // (17) tells how far the delay is from a quarter.
    let told = delayed.imbalance(&moments);
    assert!((told - (5.0 * omega(&wave)).cos()).abs() < 1e-2, "{told}");
}

#[test]
fn the_monitor_tells_the_phase_difference() {
    for (ratio, angle) in [(0.1, 0.5), (-0.2, 0.3), (0.3, 1.2), (0.05, -0.4)] {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: ratio,
            angle,
            ..Wave::default()
        };
        let pairs = samples(&wave, 8);
        let moments = Moments::of(&pairs[LEAD..]);
        let q = Delayed::of(&pairs, LEAD, 5).quarter(&moments, omega(&wave));
        // φ_C − φ_D from the phasors of (3): S = Re(z e^{jωt}), φ = −arg z.
        let (s2, c2) = (2.0 * angle).sin_cos();
        let phase_c = f64::atan2(ratio * -s2, c2);
        let phase_d = f64::atan2(ratio * c2, s2);
        let truth = phase_c - phase_d;
        let found = algorithm2::phase_difference(&moments, q);
        assert!((found - truth).sin().abs() < 1e-3, "{found} {truth}");
        assert!((found - truth).cos() > 0.0, "{found} {truth}");
    }
}

#[test]
fn the_rough_angle_is_an_order_rougher_and_small_samples_spoil_it() {
    let wave = Wave::default();
    let pairs = samples(&wave, 4);
    let window = &pairs[LEAD..];
    let error = |angle: f64| (angle - wave.angle).abs().to_degrees();
    let fine = error(algorithm1::shape(&Moments::of(window)).angle);
    let gated = error(algorithm1::rough_angle(&Ratio::of(window, 0.2)));
    let all = error(algorithm1::rough_angle(&Ratio::of(window, 0.0)));
    println!(
        "(12) {fine:.2e}°, (13) with small samples left out {gated:.2e}°, with all {all:.2e}°"
    );
    assert!(gated < all && fine < all);
    assert!(algorithm1::rough_angle(&Ratio::of(window, 9.0)).is_nan());
}

#[test]
fn j_from_sums_is_j_from_samples() {
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
        // Trying each grid point finds the same.
        let each = (-400..=400)
            .map(|i| start + f64::from(i) * hertz)
            .min_by(|a, b| j(*a).total_cmp(&j(*b)))
            .unwrap();
        assert!((near - each).abs() < 1e-9, "{near} {each}");
        let fine = frequency::exact(near, window.len() as u32, j);
        assert!((fine - near).abs() < 0.51 * hertz);
        assert!(j(fine) <= j(near));
        // (15) has its minimum nearby.
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
        // Over one period, quadrature and grid leave (15) where it began.
        assert!(periods == 1 || errors[2].abs() < 25.0);
        assert!(errors[3].abs() < 2e-3 * 4.0 / periods as f64, "{errors:?}");
    }
}

#[test]
fn the_exact_solution_has_no_leakage_and_takes_offsets() {
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
            // Rounding of f32 samples, which one period with free offsets and frequency amplifies.
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
fn streaming_sums_are_those_of_the_slice() {
    let wave = Wave::default();
    let (offsets, length) = ([0.4f32, -0.2f32], 19u16);
    let raw: Vec<[f32; 2]> = samples(&wave, 12);
    let shifted: Vec<[f32; 2]> = raw
        .iter()
        .map(|p| [p[0] + offsets[0], p[1] + offsets[1]])
        .collect();
    let layout = Layout {
        step: PhaseStep::from_period(18.754_688),
        length,
    };
    let mut blocks = Vec::new();
    let mut demodulator = Demodulator::<64>::new(layout, 0);
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
            blocks.push(block);
            moments = moments.with(&moment_sums.take());
            delayed = delayed.with(&delayed_sums.take());
        }
    }
    assert_eq!((blocks.len(), moments.count, delayed.count), (10, 190, 185));
    // Cut in any way, the sums are the same to the bit.
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
    assert!(Products::from_blocks([]).is_none());
}

/// Numbers to read.
fn list(numbers: &[f64]) -> String {
    let texts: Vec<String> = numbers.iter().map(|x| format!("{x:.1e}")).collect();
    texts.join(", ")
}

//! The four methods against an independent double-precision evaluation of the printed formulas, and against the wave itself.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use antinode::methods::{
    Delayed, Moments, Products, Ratio, Wave as Found, algorithm1, algorithm2, algorithm3,
    algorithm4, exact, frequency, functional, phase,
};
use antinode_sim::{Wave, random_wave};
use host_tests::methods::{LEAD, list, numbers, omega, samples};
use host_tests::printed::Window;
use host_tests::{RATE, angle_error, phase_error};

/// Results of the core, algorithm by algorithm; algorithm 2 with the printed delay.
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
    // A relative error of an a_B or an angle near 0 has no meaning.
    waves.retain(|w| (w.quadrature_amplitude / w.main_amplitude).abs() > 0.03);
    assert!(waves.len() > 80);
    for wave in &waves {
        for periods in 1..=10 {
            let pairs = samples(wave, periods);
            let doubles: Vec<[f64; 2]> = (0..pairs.len())
                .map(|k| wave.pick_offs((k as f64 - LEAD as f64) / RATE))
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
fn quadrants_signs_and_phases_are_right_at_all_angles() {
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
                // Four periods fit the grid, and the fractional delay is a quarter period exactly.
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
                    // (θ + π/2, α + π) is the same motion: both must be changed together.
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
    // (17) shows how far the delay is from a quarter.
    let told = delayed.imbalance(&moments);
    assert!((told - (5.0 * omega(&wave)).cos()).abs() < 1e-2, "{told}");
}

#[test]
fn the_monitor_gives_the_phase_difference() {
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
fn without_a_gate_the_rough_angle_is_ten_times_rougher() {
    let [mut rougher, mut count] = [0; 2];
    for i in 0..100 {
        for periods in 1..=10 {
            let wave = Wave {
                phase: PI / 6.0 + PI * f64::from(i) / 100.0,
                ..Wave::default()
            };
            let pairs = samples(&wave, periods);
            let window = &pairs[LEAD..];
            let error = |angle: f64| (angle - wave.angle).abs();
            let fine = error(algorithm1::shape(&Moments::of(window)).angle);
            let rough = error(algorithm1::rough_angle(&Ratio::of(window, 0.0)));
            let ratio = rough / fine;
            // The paper's own phase.
            assert!(i != 0 || ratio > 10.0, "{periods} periods: {ratio}");
            rougher += u32::from(ratio > 10.0);
            count += 1;
        }
    }
    println!("(13) is ten times rougher than (12) in {rougher} of {count} windows");
    assert!(f64::from(rougher) > 0.8 * f64::from(count));
}

#[test]
fn with_any_gate_the_rough_angle_has_a_bias_of_its_own() {
    for angle in [0.2, PI / 6.0, 0.6] {
        // The bias of a quadrature of a twentieth.
        let biases = [-(2.0 * angle).tan(), 1.0 / (4.0 * angle).tan()].map(|x| 0.5 * 0.0025 * x);
        for gate in [0.1f32, 0.2, 0.3] {
            let (mut sums, mut count) = ([0.0; 2], 0.0);
            for i in 0..200 {
                for periods in 1..=10 {
                    let wave = Wave {
                        angle,
                        phase: PI * f64::from(i) / 200.0,
                        ..Wave::default()
                    };
                    let pairs = samples(&wave, periods);
                    let window = &pairs[LEAD..];
                    let by_ratio = algorithm1::rough_angle(&Ratio::of(window, 2.0 * gate));
                    let by_roots = algorithm1::shape(&Moments::of(window)).angle;
                    sums[0] += by_ratio - angle;
                    sums[1] += by_roots - angle;
                    count += 1.0;
                }
            }
            let means = sums.map(|sum| sum / count);
            println!(
                "angle {angle:.2}, gate {gate}: (13) and (12) off by {} rad in the mean, for {}",
                list(&means),
                list(&biases)
            );
            for (mean, bias) in means.into_iter().zip(biases) {
                assert!((mean / bias - 1.0).abs() < 0.05, "{mean:e} {bias:e}");
            }
        }
    }
    assert!(algorithm1::rough_angle(&Ratio::of(&[[1.0, 1.0]], 9.0)).is_nan());
}

#[test]
fn the_frequency_of_formula_10_costs_algorithm_4_amplitude() {
    let wave = Wave::default();
    // The whole number of samples nearest to the period: 5263 Hz instead of 5332.
    let rough = TAU / 19.0;
    for (periods, wanted) in [(4, 1.989), (10, 1.943)] {
        let pairs = samples(&wave, periods);
        let window = &pairs[LEAD..];
        let found = algorithm4::wave(&Products::of(window, rough));
        let moments = Moments::of(window);
        let refined = frequency::on_grid(rough, TAU / RATE, 400, |omega| {
            let products = Products::of(window, omega);
            functional::squares(&algorithm4::wave(&products), &moments, &products)
        });
        let after = algorithm4::wave(&Products::of(window, refined));
        let [before, after] = [found, after].map(|wave| wave.shape.main_amplitude);
        println!("{periods} periods: a_A {before:.4} at (10), {after:.4} refined");
        assert!((before - wanted).abs() < 1e-3, "{before}");
        assert!((after - 2.0).abs() < 2e-3, "{after}");
    }
}

#[test]
fn a_nan_sample_gives_nan_amplitudes() {
    let wave = Wave::default();
    let mut pairs = samples(&wave, 4);
    pairs[LEAD + 30][1] = f32::NAN;
    let omega = omega(&wave);
    for (index, found) in found(&pairs, omega).iter().enumerate() {
        let shape = found.shape;
        assert!(shape.main_amplitude.is_nan(), "{}: {found:?}", index + 1);
    }
    let solution = exact::solve(&pairs[LEAD..], omega);
    assert!(
        solution.wave.shape.main_amplitude.is_nan(),
        "{:?}",
        solution.wave
    );
}

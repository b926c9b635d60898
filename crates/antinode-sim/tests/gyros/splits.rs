//! Waves on a resonator with splits: against its modes' own equations of motion, and their truth against differences.

use antinode_sim::{Flaws, Gyro, Truth, Wave};
use nalgebra::{Matrix2, Matrix4, Vector4};
use std::f64::consts::{FRAC_PI_4, FRAC_PI_8, PI, TAU};

/// A wave of a_B, rotation, and the splits of damping and of frequency with their angles.
fn wave([b, rotation, delta, damped_at, split, highest_at]: [f64; 6]) -> Wave {
    Wave {
        main_amplitude: 1.0,
        quadrature_amplitude: b,
        angle: 0.35,
        phase: -2.0,
        frequency: 1000.0,
        angle_rate: rotation,
        // Of a large split one mode grows.
        decay_rate: 0.05 + 0.45 * delta.abs(),
        damping_split: delta,
        damping_angle: damped_at,
        frequency_split: split,
        frequency_angle: highest_at,
        ..Wave::default()
    }
}

/// Rotation and splits that cancel: s = 0, to the bit and nearly.
fn cancelling() -> [Wave; 2] {
    [
        [0.2, 0.125, 0.5, -0.2, 0.0, 0.0],
        [0.2, 0.0, 0.06 * TAU, 1.0 + FRAC_PI_8, 0.06, 1.0],
    ]
    .map(wave)
}

/// Waves of every kind.
fn waves() -> Vec<Wave> {
    let mut waves = [
        [0.2, 0.0, 0.15, 2.0, 0.0, 0.0],
        [-0.3, 0.0, 0.0, 0.0, 0.06, -0.4],
        [0.2, 0.0, 0.15, -0.2, 0.06, 1.0],
        [0.2, 0.15, 0.15, -0.2, 0.06, 1.0],
        [-0.1, -0.9, 0.15, -0.2, 0.06, 1.0],
        // Both splits are told from their other ends.
        [0.2, 0.05, -0.5, -0.2, -0.02, 1.0],
        // What turns one way dies out before what turns the other way, after many turns.
        [0.2, 1.5, 1.5, 1.0, 0.24, 1.0],
        [0.2, -1.5, 1.5, 1.0, -0.24, 1.0],
        // One mode alone is left.
        [0.2, 0.3, 7.0, -0.2, 0.06, 1.0],
    ]
    .map(wave)
    .to_vec();
    waves.extend(cancelling());
    waves
}

/// A symmetric matrix of these values along a pattern angle and 45 degrees from there.
fn matrix(along: f64, across: f64, angle: f64) -> Matrix2<f64> {
    let (mean, half) = (0.5 * (along + across), 0.5 * (along - across));
    let (s, c) = (4.0 * angle).sin_cos();
    Matrix2::new(mean + half * c, half * s, half * s, mean - half * c)
}

/// The velocities of the pick-off signals at t = 0, by differences.
fn speeds(wave: &Wave) -> [f64; 2] {
    let h = 2e-6;
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|steps| wave.pick_offs(steps * h));
    [0, 1].map(|i| (a[i] - d[i] + 8.0 * (c[i] - b[i])) / (12.0 * h))
}

/// The exponential of a matrix, by its series for a 256th of it: nalgebra's needs its `std`, which takes long to build.
fn exponential(matrix: Matrix4<f64>) -> Matrix4<f64> {
    let mut term = Matrix4::identity();
    let mut power = term;
    for n in 1..=12 {
        term *= matrix / (256.0 * f64::from(n));
        power += term;
    }
    (0..8).fold(power, |power, _| power * power)
}

#[test]
fn as_the_two_modes_move() {
    for (index, wave) in waves().iter().enumerate() {
        let omega = TAU * wave.frequency;
        let split = 0.5 * TAU * wave.frequency_split;
        // A mode whose amplitude decays with d has 2 d in its equation of motion.
        let damping = matrix(
            2.0 * wave.decay_rate + wave.damping_split,
            2.0 * wave.decay_rate - wave.damping_split,
            wave.damping_angle,
        );
        // Coriolis' force on what moves in the pattern's plane, which turns by twice the pattern's angle.
        let coriolis = 4.0 * wave.angle_rate;
        // Damping lowers the frequency that a mode shows, and rotation raises the mean of both.
        let shown = matrix(
            (omega + split).powi(2),
            (omega - split).powi(2),
            wave.frequency_angle,
        );
        let stiffness = shown + damping * damping * 0.25
            - Matrix2::from_diagonal_element(0.25 * coriolis * coriolis);
        let turning = Matrix2::new(0.0, -coriolis, coriolis, 0.0);
        // Of the signals, and of their velocities over omega.
        let mut motion = Matrix4::zeros();
        motion
            .fixed_view_mut::<2, 2>(0, 2)
            .copy_from(&Matrix2::from_diagonal_element(omega));
        motion
            .fixed_view_mut::<2, 2>(2, 0)
            .copy_from(&(stiffness / -omega));
        motion
            .fixed_view_mut::<2, 2>(2, 2)
            .copy_from(&(turning - damping));
        let step = 1.0337e-3;
        let moved = exponential(motion * step);
        let ([c, d], [vc, vd]) = (wave.pick_offs(0.0), speeds(wave));
        let mut state = Vector4::new(c, d, vc / omega, vd / omega);
        let mut worst = 0.0f64;
        for k in 1..=2900u32 {
            state = moved * state;
            let [c, d] = wave.pick_offs(step * f64::from(k));
            worst = worst.max((c - state[0]).abs()).max((d - state[1]).abs());
        }
        // What the second order leaves out: squares of the rates over omega, and their cubes over omega squared with time.
        let rates = wave.decay_rate
            + 0.5 * wave.damping_split.abs()
            + split.abs()
            + 2.0 * wave.angle_rate.abs();
        let left_out = 1e-9 + 0.05 * (rates / omega).powi(2) * (1.0 + 3.0 * rates);
        assert!(worst < left_out, "{index}: {worst} {left_out}");
    }
}

/// (1)-(3) at the moment of a truth.
fn seen(truth: &Truth) -> (f64, f64) {
    let (s2, c2) = (2.0 * truth.angle).sin_cos();
    let (s, c) = (-truth.phase).sin_cos();
    let (p, q) = (truth.main_amplitude * c, truth.quadrature_amplitude * s);
    (p * c2 - q * s2, p * s2 + q * c2)
}

/// `x` less whole `of`.
fn rest(x: f64, of: f64) -> f64 {
    x - of * (x / of).round()
}

#[test]
fn the_truth_describes_the_wave_and_its_rates_are_those_of_differences() {
    let h = 2e-5;
    for (index, wave) in waves().into_iter().enumerate() {
        let wave = Wave {
            frequency_rate: 0.7,
            ..wave
        };
        let start = wave.at(0.0);
        assert_eq!((start.angle, start.phase), (wave.angle, wave.phase));
        for k in 0..500 {
            let t = 0.0301 * f64::from(k) - 1.0;
            let [before, truth, after] = [t - h, t, t + h].map(|t| wave.at(t));
            let [c, d] = wave.pick_offs(t);
            let (c0, d0) = seen(&truth);
            let size = truth.main_amplitude;
            assert!(
                (c - c0).abs() < 1e-13 * size && (d - d0).abs() < 1e-13 * size,
                "{index}, {t}: {c} {c0} {d} {d0}"
            );
            assert!(truth.quadrature_amplitude.abs() <= size && truth.time == t);
            // Near a circle the angle turns too fast for differences.
            let ratio = truth.quadrature_amplitude.abs() / size;
            if ratio > 0.95 {
                continue;
            }
            let decay = (before.main_amplitude - after.main_amplitude) / (2.0 * h * size);
            let angle_rate = (after.angle - before.angle) / (2.0 * h);
            let tau = before.phase - after.phase;
            let frequency = truth.frequency
                + rest(tau - TAU * 2.0 * h * truth.frequency, TAU) / (TAU * 2.0 * h);
            for (name, found, difference) in [
                ("decay", truth.decay_rate, decay),
                ("angle", truth.angle_rate, angle_rate),
                ("frequency", truth.frequency, frequency),
            ] {
                assert!(
                    (found - difference).abs() < 1e-6,
                    "{index}, {t}, {name}: {found} {difference}"
                );
            }
        }
    }
}

#[test]
fn a_circle_has_a_truth() {
    for b in [1.0, -1.0] {
        for split in [[0.2, 0.15, -0.2, 0.06, 1.0], [0.0, 0.15, 0.0, 0.0, 0.0]] {
            let [rotation, delta, damped_at, split, highest_at] = split;
            let wave = wave([b, rotation, delta, damped_at, split, highest_at]);
            for t in [0.0, 1e-6, 0.01, 1.0] {
                let truth = wave.at(t);
                let rates = [truth.angle_rate, truth.decay_rate, truth.frequency];
                assert!(rates.iter().all(|rate| rate.is_finite()), "{truth:?}");
                let ([c, d], (c0, d0)) = (wave.pick_offs(t), seen(&truth));
                assert!(
                    (c - c0).abs() < 1e-13 && (d - d0).abs() < 1e-13,
                    "{t}: {c} {c0} {d} {d0}"
                );
            }
        }
    }
}

#[test]
fn the_angle_is_continuous() {
    for (index, wave) in waves().into_iter().enumerate() {
        let step = 0.002;
        for direction in [step, -step] {
            let mut last = wave.at(0.0);
            let mut circles = 0;
            for k in 1..20_000 {
                let truth = wave.at(direction * f64::from(k));
                let turned = (truth.angle - last.angle).abs();
                let rate = truth.angle_rate.abs().max(last.angle_rate.abs());
                let ratio = |truth: &Truth| truth.quadrature_amplitude.abs() / truth.main_amplitude;
                if ratio(&truth).max(ratio(&last)) > 0.99 {
                    // Through a circle it turns by 45 degrees at once, and no more.
                    circles += 1;
                    assert!(turned < FRAC_PI_4 + 0.01, "{index}, {k}: {turned}");
                } else {
                    assert!(turned < 1.5 * step * rate + 1e-9, "{index}, {k}: {turned}");
                }
                last = truth;
            }
            assert!(circles < 2000, "{index}: {circles}");
        }
    }
}

#[test]
fn nothing_is_special_where_the_splits_and_the_rotation_cancel() {
    for wave in cancelling() {
        let near = |by: f64| Wave {
            damping_split: wave.damping_split * (1.0 + by),
            ..wave
        };
        for t in [0.0, 1e-6, 0.3, 7.0, 40.0] {
            let (middle, size) = (wave.pick_offs(t), wave.at(t).main_amplitude);
            let [low, high] = [-1e-6, 1e-6].map(|by| near(by).pick_offs(t));
            let bent = (low[0] + high[0] - 2.0 * middle[0]).abs()
                + (low[1] + high[1] - 2.0 * middle[1]).abs();
            // Smooth in the splits: second differences of a millionth are rounding.
            assert!(bent < 1e-9 * size, "{t}: {bent}");
        }
    }
}

#[test]
fn small_splits_are_nearly_none() {
    let none = Wave {
        angle_rate: 0.3,
        decay_rate: 0.1,
        ..Wave::default()
    };
    let some = Wave {
        damping_split: 1e-12,
        frequency_split: 1e-12,
        ..none
    };
    // Within a period, rotation and damping make one travelling wave decay faster than the other.
    let apart = 2.0 * none.angle_rate * none.decay_rate / (TAU * none.frequency);
    for t in [0.0, 0.01, 3.0, 50.0, -2.0] {
        let (a, b) = (some.at(t), none.at(t));
        let (sinh, cosh) = ((apart * t).sinh(), (apart * t).cosh());
        let main = b.main_amplitude * cosh - b.quadrature_amplitude * sinh;
        let quadrature = b.quadrature_amplitude * cosh - b.main_amplitude * sinh;
        for (a, b) in [
            (a.main_amplitude, main),
            (a.quadrature_amplitude, quadrature),
            (a.angle, b.angle),
            (rest(a.phase - b.phase, TAU), 0.0),
            (a.frequency, b.frequency),
            (a.angle_rate, b.angle_rate),
            (a.decay_rate, b.decay_rate + apart * quadrature / main),
        ] {
            assert!((a - b).abs() < 1e-9, "{t}: {a} {b}");
        }
    }
}

#[test]
fn what_grows_and_decays_beyond_all_measure_stays_finite() {
    // The greater mode's cosh alone would be infinite.
    let wave = Wave {
        damping_split: 4000.0,
        decay_rate: 2000.0,
        damping_angle: 0.0,
        angle: 0.1,
        ..Wave::default()
    };
    let truth = wave.at(10.0);
    // Undamped is what stands at 45 degrees: cos of 90 degrees less 2 theta of the main wave.
    let left = (0.2f64).sin() * wave.main_amplitude;
    assert!((rest(truth.angle - FRAC_PI_4, PI / 2.0)).abs() < 1e-9);
    assert!(
        (truth.main_amplitude / left - 1.0).abs() < 0.05,
        "{truth:?}"
    );
    assert!(truth.decay_rate.abs() < 1e-9);
    let [c, d] = wave.pick_offs(10.0);
    assert!(c.is_finite() && d.is_finite());
}

#[test]
fn the_stream_is_the_formulas() {
    for wave in waves() {
        let flaws = Flaws {
            skew: 2e-6,
            ..Flaws::default()
        };
        for drift in [0.0, 0.5] {
            let wave = Wave {
                frequency_rate: drift,
                ..wave
            };
            let rate = 20_000.0;
            let mut gyro = Gyro::new(wave, flaws.clone(), rate, 1).expect("a good gyro");
            for skip in [0, 1, 62, 1, 5000, 30_000] {
                let pair = gyro.nth(skip).expect("it is endless");
                let index = gyro.index() - 1;
                let t = index as f64 / rate;
                let size = wave.at(t).main_amplitude;
                let (c, d) = (wave.pick_offs(t)[0], wave.pick_offs(t + flaws.skew)[1]);
                assert!(
                    (pair[0] - c).abs() < 1e-11 * size && (pair[1] - d).abs() < 1e-11 * size,
                    "{index}: {pair:?} {c} {d}"
                );
                assert!((gyro.truth_at(index).angle - wave.at(t).angle).abs() < 1e-12);
            }
        }
    }
}

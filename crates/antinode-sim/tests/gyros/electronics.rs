//! The flaws of the electronics against their first-order formulas: what an exact least-squares fit finds too much of.

use antinode_sim::{Flaws, Gyro, Wave};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::{PI, TAU};

const RATE: f64 = 100_000.0;
const SAMPLES: usize = 1_000;

/// The least-squares phasor z of S = Re(z exp(j 2 pi f t)) + offset, by its normal equations.
fn phasor(samples: &[f64], frequency: f64) -> (f64, f64) {
    let (mut m, mut v) = (Matrix3::zeros(), Vector3::zeros());
    for (k, s) in samples.iter().enumerate() {
        let phase = TAU * frequency * k as f64 / RATE;
        let base = Vector3::new(phase.cos(), -phase.sin(), 1.0);
        m += base * base.transpose();
        v += *s * base;
    }
    let z = m.lu().solve(&v).expect("many samples");
    (z.x, z.y)
}

struct Found {
    a: f64,
    b: f64,
    theta: f64,
}

/// (24), (25) of the paper on the fitted phasors, in the form of its two counter-running waves.
fn identify(wave: Wave, flaws: Flaws) -> Found {
    let pairs: Vec<_> = Gyro::new(wave, flaws, RATE, 9)
        .expect("a good gyro")
        .take(SAMPLES)
        .collect();
    let c = phasor(
        &pairs.iter().map(|s| s[0]).collect::<Vec<_>>(),
        wave.frequency,
    );
    let d = phasor(
        &pairs.iter().map(|s| s[1]).collect::<Vec<_>>(),
        wave.frequency,
    );
    let plus = (c.0 - d.1, c.1 + d.0);
    let minus = (c.0 + d.1, c.1 - d.0);
    let (p, m) = (plus.0.hypot(plus.1), minus.0.hypot(minus.1));
    let four_theta = plus.1.atan2(plus.0) - minus.1.atan2(minus.0);
    // theta is known modulo pi/2: the branch nearest the truth
    let off = (four_theta / 4.0 - wave.angle) / (PI / 2.0);
    Found {
        a: (p + m) / 2.0,
        b: (p - m) / 2.0,
        theta: wave.angle + (off - off.round()) * PI / 2.0,
    }
}

/// Excess of a_A, a_B and theta that a flaw brings, on waves of many angles and quadratures, for a check of each.
fn excess(flaws: &Flaws, check: impl Fn(&Wave, [f64; 3])) {
    for quadrature_amplitude in [0.1, -0.7] {
        for angle in [0.0, 0.2, 0.5, 0.9, 1.4] {
            let wave = Wave {
                quadrature_amplitude,
                angle,
                ..Wave::default()
            };
            let (with, without) = (
                identify(wave, flaws.clone()),
                identify(wave, Flaws::default()),
            );
            assert!(
                (without.a - wave.main_amplitude).abs() < 1e-12,
                "a_A {}",
                without.a
            );
            assert!(
                (without.b - quadrature_amplitude).abs() < 1e-12,
                "a_B {}",
                without.b
            );
            assert!(
                (without.theta - angle).abs() < 1e-12,
                "theta {}",
                without.theta
            );
            check(
                &wave,
                [
                    with.a - without.a,
                    with.b - without.b,
                    with.theta - without.theta,
                ],
            );
        }
    }
}

/// E/D and Q/D.
fn ratios(wave: &Wave) -> (f64, f64) {
    let (a, b) = (wave.main_amplitude, wave.quadrature_amplitude);
    let d = a * a - b * b;
    ((a * a + b * b) / d, 2.0 * a * b / d)
}

fn near(name: &str, found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() < tolerance,
        "{name}: {found} against {expected}"
    );
}

/// The size of the flaws, and what the terms of second order may come to.
const SMALL: f64 = 1e-5;
const SECOND: f64 = 1e-9;

#[test]
fn gain() {
    excess(
        &Flaws {
            gain_ratio: 1.0 + SMALL,
            ..Flaws::default()
        },
        |wave, [a, _, theta]| {
            let four = 4.0 * wave.angle;
            near(
                "a_A",
                a,
                0.5 * SMALL * wave.main_amplitude * (1.0 - four.cos()),
                SECOND,
            );
            near(
                "theta",
                theta,
                0.25 * SMALL * ratios(wave).0 * four.sin(),
                SECOND,
            );
        },
    );
}

#[test]
fn skew() {
    let skew = SMALL / (TAU * Wave::default().frequency);
    excess(
        &Flaws {
            skew,
            ..Flaws::default()
        },
        |wave, [_, b, theta]| {
            let four = 4.0 * wave.angle;
            near(
                "a_B",
                b,
                -0.5 * SMALL * wave.main_amplitude * four.sin(),
                SECOND,
            );
            near(
                "theta",
                theta,
                0.25 * SMALL * ratios(wave).1 * four.cos(),
                SECOND,
            );
        },
    );
}

#[test]
fn pick_off() {
    excess(
        &Flaws {
            pick_off_angle: SMALL,
            ..Flaws::default()
        },
        |wave, [a, _, theta]| {
            let four = 4.0 * wave.angle;
            near("a_A", a, -SMALL * wave.main_amplitude * four.sin(), SECOND);
            near(
                "theta",
                theta,
                -0.5 * SMALL * (1.0 + ratios(wave).0 * four.cos()),
                SECOND,
            );
        },
    );
}

#[test]
fn a_turned_pick_off_sees_the_wave_turned() {
    let (wave, eps) = (Wave::default(), 0.3);
    let turned = Wave {
        angle: wave.angle - eps,
        ..wave
    };
    let flaws = Flaws {
        pick_off_angle: eps,
        ..Flaws::default()
    };
    for (k, pair) in Gyro::new(wave, flaws, RATE, 0)
        .expect("a good gyro")
        .take(100)
        .enumerate()
    {
        let t = k as f64 / RATE;
        near("C", pair[0], wave.pick_offs(t)[0], 1e-13);
        near("D", pair[1], turned.pick_offs(t)[1], 1e-13);
    }
}

#[test]
fn offset_is_all_the_offset_there_is() {
    excess(
        &Flaws {
            offset_c: 0.5,
            offset_d: -0.25,
            ..Flaws::default()
        },
        |_, found| {
            found.iter().for_each(|x| near("excess", *x, 0.0, 1e-12));
        },
    );
    let flaws = Flaws {
        offset_c: 0.5,
        offset_d: -0.25,
        ..Flaws::default()
    };
    // 5332 Hz comes back to itself after 25000 samples
    let sum = |f: Flaws| {
        let pairs = Gyro::new(Wave::default(), f, RATE, 0)
            .expect("a good gyro")
            .take(25_000);
        pairs.fold((0.0, 0.0), |(c, d), s| {
            (c + s[0] / 25_000.0, d + s[1] / 25_000.0)
        })
    };
    let (c, d) = sum(flaws);
    near("mean of C", c, 0.5, 1e-12);
    near("mean of D", d, -0.25, 1e-12);
}

#[test]
fn clipping_lowers_the_fundamental() {
    // theta = 0 and a_B = 0: all of the wave is in channel C. 1000.01 Hz: the samples fall everywhere in the period.
    let wave = Wave {
        quadrature_amplitude: 0.0,
        angle: 0.0,
        frequency: 1000.01,
        ..Wave::default()
    };
    for r in [0.3, 0.7, 0.95] {
        let clipped = Flaws {
            clip: Some(r * wave.main_amplitude),
            ..Flaws::default()
        };
        let samples: Vec<f64> = Gyro::new(wave, clipped, RATE, 0)
            .expect("a good gyro")
            .take(1_000_000)
            .map(|s| s[0])
            .collect();
        let (re, im) = phasor(&samples, wave.frequency);
        let expected = 2.0 / PI * (f64::asin(r) + r * (1.0 - r * r).sqrt());
        near("factor", re.hypot(im) / wave.main_amplitude, expected, 1e-4);
    }
}

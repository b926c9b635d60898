//! Each flaw adds what is documented, and nothing else.

use super::*;

fn first(wave: Wave, flaws: Flaws, n: u64) -> Vec<[f64; 2]> {
    let mut front = Front::new(wave, &flaws, 100_000.0, 1);
    (0..n).map(|k| front.at(k).signal).collect()
}

#[test]
fn hum_is_added_to_both() {
    let wave = Wave::default();
    let flaws = Flaws {
        hum: 0.1,
        hum_frequency: 60.0,
        ..Flaws::default()
    };
    let clean = first(wave, Flaws::default(), 3000);
    for (k, (a, b)) in clean.iter().zip(first(wave, flaws, 3000)).enumerate() {
        let hum = 0.1 * libm::sin(core::f64::consts::TAU * 60.0 * k as f64 / 100_000.0);
        assert!((b[0] - a[0] - hum).abs() < 1e-12 && (b[1] - a[1] - hum).abs() < 1e-12);
    }
}

#[test]
fn noise_has_its_rms_and_is_independent_in_the_channels() {
    let wave = Wave::default();
    let clean = first(wave, Flaws::default(), 200_000);
    let noisy = first(wave, Flaws::white(0.25), 200_000);
    let (mut cc, mut dd, mut cd) = (0.0, 0.0, 0.0);
    for (a, b) in clean.iter().zip(&noisy) {
        let (c, d) = (b[0] - a[0], b[1] - a[1]);
        cc += c * c;
        dd += d * d;
        cd += c * d;
    }
    let n = clean.len() as f64;
    // Standard errors: of an rms sigma / sqrt(2n) = 0.16 %, of a correlation 1 / sqrt n = 0.22 %.
    assert!(
        ((cc / n).sqrt() / 0.25 - 1.0).abs() < 0.007,
        "{}",
        (cc / n).sqrt()
    );
    assert!(
        ((dd / n).sqrt() / 0.25 - 1.0).abs() < 0.007,
        "{}",
        (dd / n).sqrt()
    );
    assert!((cd / n / 0.0625).abs() < 0.01, "{}", cd / n);
}

#[test]
fn jitter_moves_both_channels_together() {
    let wave = Wave::default();
    let jitter = 1e-8;
    let n = 100_000;
    let moved = first(
        wave,
        Flaws {
            jitter,
            ..Flaws::default()
        },
        n,
    );
    let mut squares = 0.0;
    for (k, pair) in moved.iter().enumerate() {
        let t = k as f64 / 100_000.0;
        let ([c, d], [c1, d1]) = (wave.pick_offs(t), wave.pick_offs(t + 1e-7));
        let (slope_c, slope_d) = ((c1 - c) / 1e-7, (d1 - d) / 1e-7);
        // The shift that explains both channels by least squares, and its residual.
        let shift = ((pair[0] - c) * slope_c + (pair[1] - d) * slope_d)
            / (slope_c.powi(2) + slope_d.powi(2));
        let left = (pair[0] - c - shift * slope_c)
            .abs()
            .max((pair[1] - d - shift * slope_d).abs());
        // A shift of 5e-8 s at most, against a slope taken over 1e-7 s: omega^2 a (1e-7 + 5e-8) 5e-8 / 2
        assert!(left < 1e-5, "sample {k}: {left}");
        squares += shift * shift;
    }
    let rms = (squares / n as f64).sqrt();
    assert!((rms / jitter - 1.0).abs() < 0.02, "{rms}");
}

#[test]
fn jitter_leaves_the_noise_as_it_was() {
    let wave = Wave {
        frequency_rate: 1.0,
        ..Wave::default()
    };
    let mut with = Front::new(
        wave,
        &Flaws {
            noise: 0.1,
            jitter: 1e-7,
            ..Flaws::default()
        },
        1e5,
        3,
    );
    let mut without = Front::new(wave, &Flaws::white(0.1), 1e5, 3);
    for k in 0..100 {
        assert_eq!(with.at(k).floor, without.at(k).floor);
    }
}

#[test]
fn formulas_and_rotation_agree_for_a_negligible_drift() {
    let flaws = Flaws {
        skew: 1e-6,
        pick_off_angle: 0.01,
        ..Flaws::default()
    };
    let steady = first(Wave::default(), flaws.clone(), 500);
    let drifting = first(
        Wave {
            frequency_rate: 1e-12,
            ..Wave::default()
        },
        flaws,
        500,
    );
    for (a, b) in steady.iter().zip(&drifting) {
        assert!((a[0] - b[0]).abs() < 1e-14 && (a[1] - b[1]).abs() < 1e-14);
    }
}

#[test]
fn the_cubic_bends_by_the_third_harmonic() {
    // At theta = 0 with a_B = 0, S_C = a cos tau: c S^3 / a^2 = c a (3/4 cos tau + 1/4 cos 3 tau).
    let wave = Wave {
        quadrature_amplitude: 0.0,
        angle: 0.0,
        phase: 0.0,
        frequency: 1000.0,
        ..Wave::default()
    };
    let bent = first(
        wave,
        Flaws {
            cubic: 0.01,
            gain_ratio: 2.0,
            offset_c: 5.0,
            offset_d: -1.0,
            ..Flaws::default()
        },
        100,
    );
    for (k, pair) in bent.iter().enumerate() {
        let tau = std::f64::consts::TAU * k as f64 / 100.0;
        let expected = 5.0 + 2.0 * (1.0075 * tau.cos() + 0.0025 * (3.0 * tau).cos());
        assert!((pair[0] - expected).abs() < 1e-13, "{k}");
        assert!((pair[1] + 1.0).abs() < 1e-13, "{k}");
    }
}

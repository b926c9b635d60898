//! Comparison with the two modes' own equations of motion, and of derivatives with differences.

use nalgebra::{Matrix2, Vector2};

use super::*;

/// A resonator with splits: 1/τ, δ c_τ, δ s_τ, Δω c_ω, Δω s_ω, γ, κ.
const RATES_OF_ALL: [f64; RATES] = [0.11, 0.05, -0.03, 0.2, 0.13, 0.1, 0.3];

/// The parameters of the motion with these rates, for a wave that starts with these values.
fn parameters(main: f64, quadrature: f64, angle: f64) -> [f64; PARAMETERS] {
    let mut parameters = [0.0; PARAMETERS];
    parameters[..RATES].copy_from_slice(&RATES_OF_ALL);
    parameters[RATES..].copy_from_slice(&[main, quadrature, angle]);
    parameters
}

impl Motion {
    /// a_A, a_B and θ (−π/4 to π/4) now.
    pub fn wave(&self) -> Vector3<f64> {
        let [e, r, s, q] = self.state.into();
        let main = (0.5 * (e + r.hypot(s))).sqrt();
        Vector3::new(main, 0.5 * q / main, 0.25 * s.atan2(r))
    }

    /// Moves the state alone by this time, s: where no derivatives are wanted, that costs a fraction.
    pub fn move_state(&mut self, seconds: f64) {
        self.state = self.state_after(seconds);
    }
}

/// A row with this a_A, a_B and θ, whose window has this length, s.
fn row(values: [f64; 3], seconds: f64) -> Row {
    Row {
        seconds,
        ..Row::of(0.0, values, [1e-6; 3])
    }
}

#[test]
fn the_motion_is_that_of_the_two_modes() {
    // Modes 1 and 2 stand along an angle ϑ and across it; what pick-off C sees is x, what D sees y.
    let omega = std::f64::consts::TAU * 200.0;
    let [decay, dc, ds, wc, ws, gamma, kappa] = RATES_OF_ALL;
    let (delta, split) = (dc.hypot(ds), wc.hypot(ws));
    let (damped, fast) = (0.5 * ds.atan2(dc), 0.5 * ws.atan2(wc));
    // A symmetric matrix of these values along an angle and across it.
    let matrix = |along: f64, across: f64, angle: f64| {
        let (sine, cosine) = angle.sin_cos();
        let (mean, half) = (0.5 * (along + across), 0.5 * (along - across));
        let (c2, s2) = (cosine * cosine - sine * sine, 2.0 * sine * cosine);
        [[mean + half * c2, half * s2], [half * s2, mean - half * c2]]
    };
    // 1/τ₁ = 1/τ + ½δ and 1/τ₂ = 1/τ − ½δ; a mode decays with 2/τ in its equation.
    let damping = matrix(2.0 * decay + delta, 2.0 * decay - delta, damped);
    let (fastest, slowest) = (omega + 0.5 * split, omega - 0.5 * split);
    let stiffness = matrix(fastest * fastest, slowest * slowest, fast);
    let acceleration = |[x, y, vx, vy]: [f64; 4]| {
        // Stiffness ω²(1 + βr²), γ being βω/8.
        let stiffer = 8.0 * gamma * omega * (x * x + y * y);
        [
            vx,
            vy,
            -damping[0][0] * vx - damping[0][1] * vy - stiffness[0][0] * x - stiffness[0][1] * y
                + 2.0 * kappa * vy
                - stiffer * x,
            -damping[1][0] * vx
                - damping[1][1] * vy
                - stiffness[1][0] * x
                - stiffness[1][1] * y
                - 2.0 * kappa * vx
                - stiffer * y,
        ]
    };
    let (main, quadrature, angle) = (1.0f64, 0.2f64, 0.35f64);
    let (sine, cosine) = (2.0 * angle).sin_cos();
    // (1) and (3) at τ = 0.
    let mut state = [
        main * cosine,
        main * sine,
        -omega * quadrature * sine,
        omega * quadrature * cosine,
    ];
    let mut motion = Motion::new(&parameters(main, quadrature, angle));
    let step = 1.0 / (200.0 * 200.0);
    for second in 0..4 {
        let mut means = [0.0; 4];
        let steps = 40_000;
        for index in 0..steps {
            let along =
                |rates: [f64; 4], by: f64| std::array::from_fn(|i| state[i] + by * rates[i]);
            let k1 = acceleration(state);
            let k2 = acceleration(along(k1, 0.5 * step));
            let k3 = acceleration(along(k2, 0.5 * step));
            let k4 = acceleration(along(k3, step));
            state = std::array::from_fn(|i| {
                state[i] + step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])
            });
            // Over the last period only: E, R, S and Q wobble within each.
            if index >= steps - 200 {
                let [x, y, vx, vy] = state;
                let (vx, vy) = (vx / omega, vy / omega);
                for (mean, now) in means.iter_mut().zip([
                    x * x + y * y + vx * vx + vy * vy,
                    x * x + vx * vx - y * y - vy * vy,
                    2.0 * (x * y + vx * vy),
                    2.0 * (x * vy - vx * y),
                ]) {
                    *mean += now / 200.0;
                }
            }
        }
        // The means are those of half a period earlier.
        motion.advance(if second == 0 { 1.0 - 0.0025 } else { 1.0 });
        let averaged: [f64; 4] = motion.state.into();
        for (averaged, mean) in averaged.iter().zip(means) {
            assert!(
                (averaged - mean).abs() < 3e-4,
                "{second}: {averaged} {mean}"
            );
        }
    }
}

/// A pattern near a line, and both ways round near a circle.
const QUADRATURES: [f64; 4] = [-0.1, 0.0, 0.7999, -0.8];

/// The motion 3.5 s after its start.
fn after(parameters: &[f64; PARAMETERS]) -> Motion {
    let mut motion = Motion::new(parameters);
    for _ in 0..5 {
        motion.advance(0.7);
    }
    motion
}

#[test]
fn a_state_stays_that_of_a_pattern() {
    let parameters = parameters(0.8, -0.1, 0.6);
    // E² = R² + S² + Q², in whatever steps.
    let mut motion = Motion::new(&parameters);
    // No rows fit so long a time.
    assert!(motion.state_after(100.0)[0].is_nan());
    let mut lost = motion.clone();
    lost.advance(100.0);
    assert!(lost.derivatives.iter().all(|by| by.is_nan()));
    lost.turn_to(0.6);
    assert!(lost.state.iter().all(|value| value.is_nan()));
    let then = motion.state_after(3.5);
    motion.advance(3.5);
    assert_eq!(motion.state, then);
    let [e, r, s, q] = then.into();
    assert!((e * e - r * r - s * s - q * q).abs() < 1e-13 * e * e);
    let apart = (motion.wave() - after(&parameters).wave()).norm();
    assert!(apart < 1e-12, "{apart:e}");
}

#[test]
fn derivatives_agree_with_differences() {
    for quadrature in QUADRATURES {
        let parameters = parameters(0.8, quadrature, 0.6);
        let wave = after(&parameters).wave();
        let row = row([wave[0] + 0.003, wave[1] - 0.002, wave[2] + 0.1], 0.0);
        let (_, derivatives) = after(&parameters).residuals(&row);
        for parameter in 0..PARAMETERS {
            let moved = |by: f64| {
                let mut parameters = parameters;
                parameters[parameter] += by;
                after(&parameters).residuals(&row).0
            };
            let difference = (moved(-1e-5) - moved(1e-5)) / 2e-5;
            let apart = (difference - derivatives.column(parameter)).norm();
            assert!(apart < 1e-7, "{quadrature}, {parameter}: {apart:e}");
        }
    }
}

#[test]
fn residuals_are_what_was_added_to_the_wave() {
    for quadrature in QUADRATURES {
        let motion = Motion::new(&parameters(0.8, quadrature, 0.6));
        let wave = motion.wave();
        let added = Vector3::new(1e-9, 2e-9, 3e-9);
        let (rest, _) = motion.residuals(&row((wave + added).into(), 0.0));
        // A circle does not show its angle.
        let known = if wave[0] - wave[1].abs() < 1e-6 { 2 } else { 3 };
        let apart = (rest - added).rows(0, known).norm();
        assert!(apart < 1e-11, "{quadrature}: {rest}");
        // After an eighth of a turn the signs change; a circle is the same pattern.
        let turned = Vector3::new(0.0, 0.0, std::f64::consts::FRAC_PI_4);
        let (rest, _) = motion.residuals(&row((wave + turned).into(), 0.0));
        let lesser = wave[0] - wave[1].abs();
        assert!(
            (rest[0] - lesser).abs() < 1e-9 + 1e-9 * lesser,
            "{quadrature}: {rest}"
        );
    }
}

#[test]
fn windows_average_an_uneven_motion() {
    // The last wave changes by more than its size.
    for (quadrature, seconds) in [(-0.1, 0.0), (-0.1, 0.1), (-0.1, 0.4), (-0.799, 0.1)] {
        let motion = Motion::new(&parameters(0.8, quadrature, 0.6));
        let now = motion.state;
        let (greater, lesser) = Motion::travelling(&now, -1.0);
        // The means of both, or of their logarithms, over 200 parts of the window.
        let parts = 200;
        let (mut of_greater, mut of_lesser, mut of_log) =
            (0.0, Complex::new(0.0, 0.0), Complex::new(0.0, 0.0));
        for part in 0..parts {
            let by = seconds * ((f64::from(part) + 0.5) / f64::from(parts) - 0.5);
            let state = motion.state_after(by);
            let (plus, minus) = Motion::travelling(&state, -1.0);
            of_greater += plus.ln() / f64::from(parts);
            of_lesser += minus / f64::from(parts);
            of_log += (minus / lesser).ln() / f64::from(parts);
        }
        let wanted = if quadrature == -0.1 {
            lesser * of_log.exp()
        } else {
            of_lesser
        };
        let averaged = motion.averaged(seconds, -1.0);
        let size = (wanted - lesser).norm() + (of_greater.exp() - greater).abs();
        let apart = (averaged.1 - wanted).norm() + (averaged.0 - of_greater.exp()).abs();
        assert!(
            apart < 0.01 * size + 1e-9,
            "{quadrature}, {seconds}: {apart:e} of {size:e}"
        );
    }
    // A wave that only decays and turns does both evenly.
    let mut even = Motion::new(&[0.11, 0.0, 0.0, 0.0, 0.0, 0.0, 0.3, 0.8, -0.1, 0.6]);
    even.advance(1.3);
    let (greater, lesser) = even.averaged(1.0, -1.0);
    let now = Motion::travelling(&even.state, -1.0);
    assert!((greater - now.0).abs() < 1e-9 && (lesser - now.1).norm() < 1e-9);
}

#[test]
fn the_splits_move_the_frequency_as_they_turn_the_phase() {
    // The phasors (1 to 3) in a frame that turns at the mean frequency: C + jS of each pick-off.
    let [decay, dc, ds, wc, ws, ..] = RATES_OF_ALL;
    let (main, quadrature, angle) = (0.8f64, -0.3f64, 0.6f64);
    let motion = Motion::new(&[decay, dc, ds, wc, ws, 0.0, 0.0, main, quadrature, angle]);
    let (sine, cosine) = (2.0 * angle).sin_cos();
    let wave = [
        Complex::new(main * cosine, quadrature * sine),
        Complex::new(main * sine, -quadrature * cosine),
    ];
    let part = |c: f64, s: f64| [c * wave[0] + s * wave[1], s * wave[0] - c * wave[1]];
    let (damped, faster) = (part(-0.5 * dc, -0.5 * ds), part(0.5 * wc, 0.5 * ws));
    let slope = [0, 1].map(|i| damped[i] + faster[i] * Complex::i());
    // 2Φ = arg z₊ + arg z₋ of both travelling waves.
    let rate = |sign: f64| {
        let of = |[c, d]: [Complex<f64>; 2]| c + d * Complex::new(0.0, sign);
        (of(slope) / of(wave)).im
    };
    let expected = 0.5 * (rate(1.0) + rate(-1.0));
    let by = motion.frequency_by_splits(0.0);
    let found: f64 = by
        .iter()
        .zip([dc, ds, wc, ws])
        .map(|(by, of)| by * of)
        .sum();
    assert!((found - expected).abs() < 1e-12, "{found} {expected}");
}

#[test]
fn the_turn_to_an_angle_is_returned_with_its_derivatives() {
    let turned = |parameters: &[f64; PARAMETERS]| {
        let mut motion = Motion::new(parameters);
        motion.steer(0.2);
        motion.advance(0.7);
        let [main, quadrature, _] = motion.wave().into();
        let (beyond, derivatives) = motion.turn_to(1.1);
        let wave = motion.wave();
        assert!((wave - Vector3::new(main, quadrature, turn(1.1))).norm() < 1e-12);
        // The parameters no longer change the angle.
        let (rest, by) = motion.residuals(&row([main, quadrature, 1.1], 0.0));
        assert!(rest.norm() < 1e-9, "{rest}");
        assert!(by.row(2).norm() < 1e-9, "{by}");
        (beyond, derivatives)
    };
    let parameters = parameters(0.8, -0.1, 0.6);
    let (beyond, derivatives) = turned(&parameters);
    assert!(beyond.abs() > 0.1);
    for i in (0..PARAMETERS).filter(|&i| i != KAPPA) {
        let moved = |by: f64| {
            let mut parameters = parameters;
            parameters[i] += by;
            turned(&parameters).0
        };
        let difference = (moved(1e-5) - moved(-1e-5)) / 2e-5;
        assert!(
            (derivatives[i] - difference).abs() < 1e-7,
            "{i}: {difference} {}",
            derivatives[i]
        );
    }
}

#[test]
fn rotation_acts_within_a_period() {
    // Travelling waves u of both modes obey ü + 2Mu̇ + (ω² + ωN)u = 0, and u̇ = (jω + A)u, so that A² + 2jωA + 2M(jω + A) + ωN = 0.
    let omega = 2000.0;
    let [decay, dc, ds, wc, ws, _, kappa] = RATES_OF_ALL;
    let (damping, split) = (Complex::new(dc, ds), Complex::new(wc, ws));
    let slope = |kappa: f64| {
        let own = Complex::new(decay, kappa);
        let half = damping * 0.5;
        let m = Matrix2::new(own, half, half.conj(), own.conj());
        let n = Matrix2::new(0.0.into(), split, split.conj(), 0.0.into());
        let first = n * Complex::new(0.0, 0.5) - m;
        let mut a = first;
        for _ in 0..20 {
            a = first + (a + m * Complex::from(2.0)) * a * Complex::new(0.0, 0.5 / omega);
        }
        // z₊ and z₋ of a_A = 0.8, a_B = 0.3 and θ = 0.6.
        let wave = Vector2::new(
            Complex::from_polar(1.1, 1.2),
            Complex::from_polar(0.5, -1.2),
        );
        let slope = a * wave;
        let of_squares = [0, 1].map(|i| 2.0 * (wave[i].conj() * slope[i]).re);
        let of_product = slope[0] * wave[1].conj() + wave[0] * slope[1].conj();
        Vector4::new(
            0.5 * (of_squares[0] + of_squares[1]),
            of_product.re,
            of_product.im,
            0.5 * (of_squares[0] - of_squares[1]),
        )
    };
    let found = |kappa: f64| {
        let parameters = [decay, dc, ds, wc, ws, 0.0, kappa, 0.8, 0.3, 0.6];
        let motion = Motion::new(&parameters).of_frequency(omega);
        motion.series.slope(&motion.state)
    };
    // Terms that do not change sign with κ are parts of Δω, f and κ.
    let apart = found(kappa) - found(-kappa) - (slope(kappa) - slope(-kappa));
    assert!(apart.norm() < 1e-7, "{apart:e}");
}

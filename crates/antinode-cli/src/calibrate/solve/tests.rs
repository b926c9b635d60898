//! Histories made from the averaged equations of a resonator, with splits, flawed pick-offs and noise.

use super::*;
use crate::calibrate::moments::Moment;
use crate::deviates::Deviates;

/// Seconds of a run, and rows in it.
const SECONDS: f64 = 20.0;
const ROWS: usize = 2000;

/// A resonator: 1/τ, the splits of damping and frequency (1/s, rad/s), each along cos and sin of 4θ.
struct Resonator {
    decay: f64,
    damping: [f64; 2],
    frequency: [f64; 2],
}

const ROUND: Resonator = Resonator {
    decay: 0.02,
    damping: [0.0; 2],
    frequency: [0.0; 2],
};

/// Splits that turn the pattern's quadrature by some per cent while it turns once.
const SPLIT: Resonator = Resonator {
    decay: 0.02,
    damping: [0.004, -0.003],
    frequency: [0.01, 0.006],
};

impl Resonator {
    /// The rates of E, R, S and Q while the pattern turns at κ/2 rad/s.
    fn rates(&self, [e, r, s, q]: [f64; 4], kappa: f64) -> [f64; 4] {
        let [c_tau, s_tau] = self.damping;
        let [c_omega, s_omega] = self.frequency;
        [
            -2.0 * self.decay * e - c_tau * r - s_tau * s,
            -2.0 * self.decay * r - c_tau * e + 2.0 * kappa * s - s_omega * q,
            -2.0 * self.decay * s - s_tau * e - 2.0 * kappa * r + c_omega * q,
            -2.0 * self.decay * q + s_omega * r - c_omega * s,
        ]
    }

    /// The phasors of a free decay, row by row, by Runge and Kutta's fourth order.
    fn decay(&self, kappa: f64) -> Vec<[Complex<f64>; 2]> {
        let step = SECONDS / ROWS as f64;
        let (main, quadrature, angle) = (1.0f64, 0.03f64, 0.4f64);
        let apart = main * main - quadrature * quadrature;
        let mut state = [
            main * main + quadrature * quadrature,
            apart * (4.0 * angle).cos(),
            apart * (4.0 * angle).sin(),
            2.0 * main * quadrature,
        ];
        (0..ROWS)
            .map(|_| {
                let now = state;
                let along =
                    |rates: [f64; 4], by: f64| std::array::from_fn(|i| state[i] + by * rates[i]);
                let k1 = self.rates(state, kappa);
                let k2 = self.rates(along(k1, 0.5 * step), kappa);
                let k3 = self.rates(along(k2, 0.5 * step), kappa);
                let k4 = self.rates(along(k3, step), kappa);
                state = std::array::from_fn(|i| {
                    state[i] + step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])
                });
                phasors(now)
            })
            .collect()
    }
}

/// The phasors of E, R, S and Q, that of C real.
fn phasors([e, r, s, q]: [f64; 4]) -> [Complex<f64>; 2] {
    let c = (0.5 * (e + r)).max(1e-12).sqrt();
    [
        Complex::new(c, 0.0),
        Complex::new(0.5 * s / c, -0.5 * q / c),
    ]
}

/// A run as pick-offs show it; `kappa` turns the pattern by κ/2 rad/s backwards.
fn run(resonator: &Resonator, kappa: f64, pick_offs: &PickOffs, noise: f64, seed: u64) -> Run {
    let mut random = Deviates(seed);
    let omega = std::f64::consts::TAU * 5332.0;
    let moments = resonator
        .decay(kappa)
        .into_iter()
        .enumerate()
        .map(|(index, ideal)| {
            let mut raw = pick_offs.distort(ideal, omega);
            for z in &mut raw {
                *z += Complex::new(random.draw(), random.draw()) * noise;
            }
            Moment {
                time: SECONDS / ROWS as f64 * index as f64,
                raw,
                omega,
                variance: noise.max(1e-9).powi(2),
                corrected: PickOffs::IDEAL,
                seconds: 0.0,
            }
        })
        .collect();
    Run {
        moments,
        turns: {
            let turned = -0.5 * kappa * SECONDS;
            [turned.min(0.0), turned.max(0.0)]
        },
    }
}

/// Errors of gain ratio, phase (rad) and angle (rad).
fn errors(found: &PickOffs, truth: &PickOffs) -> [f64; 3] {
    [
        found.gain_ratio / truth.gain_ratio - 1.0,
        (found.skew - truth.skew) * std::f64::consts::TAU * 5332.0,
        found.angle - truth.angle,
    ]
}

#[test]
fn pick_offs_are_found_however_flawed() {
    for (gain_ratio, skew, angle) in [
        (1.003, 32e-9, 0.002),
        (0.5, -8e-6, 0.1),
        (2.0, 12e-6, -0.15),
        (9.0, 3e-6, 0.05),
        (0.12, -6e-6, 0.16),
    ] {
        let truth = PickOffs {
            gain_ratio,
            skew,
            angle,
        };
        // 1.25 and 2 turns of 4θ.
        for kappa in [0.2, -0.32] {
            let found = solve(&[run(&ROUND, kappa, &truth, 0.0, 1)], PickOffs::IDEAL).unwrap();
            assert!(!found.knows_splits);
            for error in errors(&found.pick_offs, &truth) {
                assert!(error.abs() < 1e-7, "{truth:?}: {found:?}");
            }
        }
    }
}

#[test]
fn a_split_resonator_is_told_from_flaws_by_turning_both_ways() {
    let truth = PickOffs {
        gain_ratio: 1.02,
        skew: 300e-9,
        angle: -0.01,
    };
    let one_way = run(&SPLIT, 0.25, &truth, 0.0, 1);
    let other_way = run(&SPLIT, -0.2, &truth, 0.0, 1);
    let found = solve(&[one_way.clone(), other_way], PickOffs::IDEAL).unwrap();
    assert!(found.knows_splits);
    for error in errors(&found.pick_offs, &truth) {
        assert!(error.abs() < 2e-5, "{found:?}");
    }
    let found = solve(&[one_way], PickOffs::IDEAL).unwrap();
    assert!(!found.knows_splits);
    let [gain, skew, angle] = errors(&found.pick_offs, &truth);
    assert!(gain.abs() > 1e-3 && skew.abs() > 1e-3 && angle.abs() > 1e-3);
}

#[test]
fn stated_deviations_are_the_rms_errors() {
    // What is little of noise on one pick-off is much on the other.
    for gain_ratio in [1.02, 3.0, 0.33] {
        let truth = PickOffs {
            gain_ratio,
            skew: 300e-9,
            angle: -0.01,
        };
        let mut squares = [0.0; 3];
        let mut residuals = 0.0;
        let runs = 60;
        for seed in 0..runs {
            let both = [
                run(&SPLIT, 0.25, &truth, 1e-3, 2 * seed + 1),
                run(&SPLIT, -0.2, &truth, 1e-3, 2 * seed + 2),
            ];
            let found = solve(&both, PickOffs::IDEAL).unwrap();
            let [gain, phase, angle] = errors(&found.pick_offs, &truth);
            let [of_gain, of_skew, of_angle] = found.deviations;
            let of_phase = of_skew * std::f64::consts::TAU * 5332.0;
            for (sum, (error, deviation)) in squares.iter_mut().zip([
                (gain * truth.gain_ratio, of_gain),
                (phase, of_phase),
                (angle, of_angle),
            ]) {
                *sum += (error / deviation).powi(2) / runs as f64;
            }
            residuals += found.residual / runs as f64;
        }
        // Of 60 runs the rms scatters by 9 %.
        for square in squares {
            assert!(
                (0.75..1.25).contains(&square.sqrt()),
                "{gain_ratio}: {squares:?}"
            );
        }
        assert!((residuals - 1.0).abs() < 0.01, "{gain_ratio}: {residuals}");
    }
}

#[test]
fn what_else_moves_widens_the_deviations() {
    let honest = run(&ROUND, 0.2, &PickOffs::IDEAL, 1e-3, 1);
    let mut boastful = honest.clone();
    for moment in &mut boastful.moments {
        moment.variance *= 0.01;
    }
    let [honest, boastful] = [honest, boastful].map(|run| solve(&[run], PickOffs::IDEAL).unwrap());
    assert!((boastful.residual / honest.residual - 10.0).abs() < 1e-6);
    for (wide, deviation) in boastful.deviations.iter().zip(honest.deviations) {
        assert!((wide / deviation - 1.0).abs() < 0.05, "{boastful:?}");
    }
}

#[test]
fn what_cannot_be_known_is_refused() {
    let still = run(&ROUND, 0.1, &PickOffs::IDEAL, 1e-3, 1);
    assert!(
        matches!(solve(&[still], PickOffs::IDEAL), Err(Fault::Still(turned)) if (turned - 1.0).abs() < 1e-9)
    );
}

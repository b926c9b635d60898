//! Tests with runs from the averaged equations of a resonator, with splits, flawed pick-offs and noise.

use num_complex::Complex;

use super::*;
use crate::calibration::moments::Moment;
use crate::resonator::motion::Motion;
use antinode_sim::Deviates;

/// Length of a run, s, and rows in it.
const SECONDS: f64 = 20.0;
const ROWS: usize = 2000;
/// 2πf, rad/s.
const OMEGA: f64 = std::f64::consts::TAU * 5332.0;

/// 1/τ, δ c_τ, δ s_τ, Δω c_ω, Δω s_ω and γ of a resonator, as [`Motion`] has them.
type Resonator = [f64; 6];

const ROUND: Resonator = [0.02, 0.0, 0.0, 0.0, 0.0, 0.0];
/// Splits that turn the pattern's quadrature by some per cent while it turns once.
const SPLIT: Resonator = [0.02, 0.004, -0.003, 0.01, 0.006, 0.0];
/// A split that makes circles of lines meanwhile.
const WIDE_SPLIT: Resonator = [0.02, 0.004, -0.003, 0.4, 0.5, 0.0];

/// The phasors (1) to (3) of a free decay, row by row.
fn decay(resonator: &Resonator, kappa: f64, omega: f64) -> Vec<[Complex<f64>; 2]> {
    decay_turned(resonator, |_| kappa, omega)
}

/// The same where κ is another from row to row.
fn decay_turned(
    resonator: &Resonator,
    kappa: impl Fn(usize) -> f64,
    omega: f64,
) -> Vec<[Complex<f64>; 2]> {
    let [decay, dc, ds, wc, ws, gamma] = *resonator;
    let parameters = [decay, dc, ds, wc, ws, gamma, 0.0, 1.0, 0.03, 0.4];
    let mut motion = Motion::new(&parameters).of_frequency(omega);
    let row = |index| {
        let [main, quadrature, angle] = motion.wave().into();
        motion.steer(-0.5 * kappa(index));
        motion.move_state(SECONDS / ROWS as f64);
        let (sine, cosine) = (2.0 * angle).sin_cos();
        [
            Complex::new(main * cosine, quadrature * sine),
            Complex::new(main * sine, -quadrature * cosine),
        ]
    };
    (0..ROWS).map(row).collect()
}

/// A run as pick-offs show it; `kappa` turns the pattern by κ/2 rad/s backwards.
fn run(resonator: &Resonator, kappa: f64, pick_offs: &PickOffs, noise: f64, seed: u64) -> Run {
    run_at(OMEGA, resonator, kappa, pick_offs, noise, seed)
}

/// The same for a wave of this 2πf, rad/s.
fn run_at(
    omega: f64,
    resonator: &Resonator,
    kappa: f64,
    pick_offs: &PickOffs,
    noise: f64,
    seed: u64,
) -> Run {
    let turned = -0.5 * kappa * SECONDS;
    let turns = [turned.min(0.0), turned.max(0.0)];
    seen(
        decay(resonator, kappa, omega),
        turns,
        omega,
        pick_offs,
        noise,
        seed,
    )
}

/// A run of these phasors, whose pattern turns so far, as pick-offs show it.
fn seen(
    phasors: Vec<[Complex<f64>; 2]>,
    turns: [f64; 2],
    omega: f64,
    pick_offs: &PickOffs,
    noise: f64,
    seed: u64,
) -> Run {
    let mut random = Deviates::new(seed);
    let moments = phasors
        .into_iter()
        .enumerate()
        .map(|(index, ideal)| {
            let mut raw = pick_offs.at(omega).distort(ideal);
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
    Run { moments, turns }
}

/// Errors of gain ratio, phase (rad) and angle (rad).
fn errors(found: &PickOffs, truth: &PickOffs) -> [f64; 3] {
    [
        found.gain_ratio / truth.gain_ratio - 1.0,
        (found.skew - truth.skew) * OMEGA,
        found.angle - truth.angle,
    ]
}

#[test]
fn calibrations_are_found_however_flawed_the_pick_offs_are() {
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
fn turning_both_ways_distinguishes_splits_from_flaws() {
    let truth = PickOffs {
        gain_ratio: 1.02,
        skew: 300e-9,
        angle: -0.01,
    };
    let one_way = run(&SPLIT, 0.25, &truth, 0.0, 1);
    // The other way by 115° and by 26°.
    for kappa in [-0.2, -0.045] {
        let other_way = run(&SPLIT, kappa, &truth, 0.0, 1);
        let found = solve(&[one_way.clone(), other_way], PickOffs::IDEAL).unwrap();
        assert!(found.knows_splits);
        for error in errors(&found.pick_offs, &truth) {
            assert!(error.abs() < 2e-5, "{kappa}: {found:?}");
        }
    }
    let found = solve(&[one_way], PickOffs::IDEAL).unwrap();
    assert!(!found.knows_splits);
    let [gain, skew, angle] = errors(&found.pick_offs, &truth);
    assert!(gain.abs() > 1e-3 && skew.abs() > 1e-3 && angle.abs() > 1e-3);
}

#[test]
fn an_unsteady_rotation_does_not_look_like_a_skew() {
    // A travelling wave that turns with the pattern decays otherwise than the other: by 10⁻⁵ of a_A here.
    let resonator = [0.2, 0.004, -0.003, 0.01, 0.006, 0.0];
    let truth = PickOffs {
        gain_ratio: 1.02,
        skew: 1e-7,
        angle: 0.01,
    };
    let runs = [(1.0, 0.006), (-1.0, 0.0035)].map(|(way, steps)| {
        let kappa = |index| way * (0.3 + 0.9 * (steps * index as f64).sin());
        let phasors = decay_turned(&resonator, kappa, OMEGA);
        seen(phasors, [-4.0, 4.0], OMEGA, &truth, 1e-7, 3)
    });
    let found = solve(&runs, PickOffs::IDEAL).unwrap();
    let [_, phase, _] = errors(&found.pick_offs, &truth);
    let is_explained = found.residual < 1.2;
    assert!(phase.abs() < 2e-7 && is_explained, "{phase}: {found:?}");
}

#[test]
fn modes_of_unlike_frequencies_do_not_look_like_unlike_pick_offs() {
    let truth = PickOffs::IDEAL;
    let both = [0.25, -0.2].map(|kappa| run_at(3000.0, &WIDE_SPLIT, kappa, &truth, 0.0, 1));
    let found = solve(&both, PickOffs::IDEAL).unwrap();
    // One mode moves less than the other by the share Δω/2ω, which is 10⁻⁴.
    let [gain, _, angle] = errors(&found.pick_offs, &truth);
    assert!(gain.abs() < 1e-5 && angle.abs() < 1e-5, "{found:?}");
}

#[test]
fn stated_deviations_are_the_rms_errors() {
    // With unlike gains, noise that is small on one pick-off is large on the other.
    for (gain_ratio, resonator) in [
        (1.02, SPLIT),
        (3.0, SPLIT),
        (0.33, SPLIT),
        (1.02, WIDE_SPLIT),
    ] {
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
                run(&resonator, 0.25, &truth, 1e-3, 2 * seed + 1),
                run(&resonator, -0.2, &truth, 1e-3, 2 * seed + 2),
            ];
            let found = solve(&both, PickOffs::IDEAL).unwrap();
            let [gain, phase, angle] = errors(&found.pick_offs, &truth);
            let [of_gain, of_skew, of_angle] = found.deviations;
            let of_phase = of_skew * OMEGA;
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
fn a_residual_beyond_noise_widens_the_deviations() {
    let honest = run(&ROUND, 0.2, &PickOffs::IDEAL, 1e-3, 1);
    let [boastful, modest] = [0.01, 4.0].map(|by| {
        let mut run = honest.clone();
        for moment in &mut run.moments {
            moment.variance *= by;
        }
        run
    });
    let [honest, boastful, modest] =
        [honest, boastful, modest].map(|run| solve(&[run], PickOffs::IDEAL).unwrap());
    assert!((boastful.residual / honest.residual - 10.0).abs() < 1e-6);
    for (wide, deviation) in boastful.deviations.iter().zip(honest.deviations) {
        assert!((wide / deviation - 1.0).abs() < 0.05, "{boastful:?}");
    }
    // One below noise does not make them smaller.
    for (wide, deviation) in modest.deviations.iter().zip(honest.deviations) {
        assert!((wide / deviation - 2.0).abs() < 0.1, "{modest:?}");
    }
}

#[test]
fn a_pattern_that_turns_too_little_is_refused() {
    let still = run(&ROUND, 0.1, &PickOffs::IDEAL, 1e-3, 1);
    let told = solve(&[still], PickOffs::IDEAL).unwrap_err();
    // One radian.
    assert!(
        told.to_string()
            .starts_with("the pattern turns by only 57.3°, "),
        "{told}"
    );
}

#[test]
fn damping_that_changes_falsifies_nothing() {
    let truth = PickOffs {
        gain_ratio: 1.02,
        skew: 300e-9,
        angle: -0.01,
    };
    // 1/τ rises by 0, 1 and 10 % meanwhile.
    for (change, decay) in [
        (0.0, Decay::Straight),
        (0.01, Decay::Bent),
        (0.1, Decay::Bent),
    ] {
        let mut squares = [0.0; FLAWS];
        let trials = 60;
        for seed in 0..trials {
            let runs = [0.3, -0.2].map(|kappa| {
                let mut run = run(
                    &SPLIT,
                    kappa,
                    &truth,
                    2e-5,
                    2 * seed + u64::from(kappa > 0.0),
                );
                for moment in &mut run.moments {
                    let drift = change * SPLIT[0] / SECONDS;
                    let by = (-0.5 * drift * moment.time.powi(2)).exp();
                    moment.raw = moment.raw.map(|z| z * by);
                }
                run
            });
            let found = solve(&runs, PickOffs::IDEAL).unwrap();
            assert_eq!(found.decay, decay, "{change}: {}", found.bent);
            assert!(
                !found.is_alike() && !found.is_beyond_noise(),
                "{change}: {}",
                found.alike
            );
            let [of_gain, of_skew, of_angle] = found.deviations;
            let deviations = [of_gain / truth.gain_ratio, of_skew * OMEGA, of_angle];
            let errors = errors(&found.pick_offs, &truth).into_iter().zip(deviations);
            for (square, (error, deviation)) in squares.iter_mut().zip(errors) {
                *square += (error / deviation).powi(2) / trials as f64;
            }
        }
        // Of 60 trials the rms scatters by 9 %.
        for square in squares {
            assert!(
                (0.72..1.3).contains(&square.sqrt()),
                "{change}: {squares:?}"
            );
        }
    }
}

#[test]
fn residuals_that_are_alike_from_row_to_row_are_seen() {
    // A gain of both pick-offs is greater by four deviations of a row from the middle on, in one run or in both; noise hides one of 0.05.
    let seen = |gains: [f64; 2], scatter: f64| {
        let runs = [(0.3, gains[0]), (-0.2, gains[1])].map(|(kappa, gain)| {
            let mut run = run(&SPLIT, kappa, &PickOffs::IDEAL, 2e-5 * scatter, 5);
            let half = run.moments.len() / 2;
            for (index, moment) in run.moments.iter_mut().enumerate() {
                let by = if index < half { 1.0 } else { 1.0 + 2e-5 * gain };
                moment.raw = moment.raw.map(|z| z * by);
                moment.variance = 4e-10;
            }
            run
        });
        solve(&runs, PickOffs::IDEAL).unwrap()
    };
    for (gains, scatter, is_alike) in [
        ([4.0, 4.0], 1.0, true),
        ([0.0, 6.0], 1.0, true),
        ([0.05, -0.05], 1.0, false),
        // What is far below the rows' own deviations does no harm.
        ([0.3, 0.3], 0.02, false),
    ] {
        let found = seen(gains, scatter);
        assert_eq!(found.is_alike(), is_alike, "{gains:?}: {found:?}");
        assert_eq!(found.is_beyond_noise(), is_alike, "{gains:?}: {found:?}");
        assert!(found.residual < EXPLAINED, "{gains:?}: {found:?}");
    }
}

//! Damping that changes while waves ring down.

use super::*;
use crate::resonator::curve::MAX_IN_TIME;
use crate::resonator::model::Damping;

/// A drift of 1/τ by 5 % in the 39.9 s of a run of 400 rows, 1/s².
const DRIFT: f64 = 0.05 * RESONATOR[0] / 39.9;

/// p for that, which leaves the mean decay as it is.
pub(super) fn drifting(time: f64, _: f64) -> f64 {
    0.5 * DRIFT * time * (time - 39.9)
}

/// The runs with waves smaller by e^−p, where p is given for the time since the first row, s, and ∫(a_A² + a_B²) dt of the wave as it was.
pub(super) fn damped(runs: Vec<Run>, p: impl Fn(f64, f64) -> f64) -> Vec<Run> {
    let damped = |mut run: Run| {
        let (mut last, mut integral) = ((0.0, 0.0), 0.0);
        let first = run.rows[0].time;
        for row in &mut run.rows {
            let (time, energy) = (row.time - first, row.main.powi(2) + row.quadrature.powi(2));
            let (before, energy_before) = std::mem::replace(&mut last, (time, energy));
            integral += 0.5 * (time - before) * (energy + energy_before);
            let by = (-p(time, integral)).exp();
            row.main *= by;
            row.quadrature *= by;
        }
        run
    };
    runs.into_iter().map(damped).collect()
}

/// Ring-downs of patterns that turn both ways.
fn turning_both_ways(seed: u64) -> Vec<Run> {
    let runs = [(0.2, 0.3), (-0.2, 0.9)].into_iter().zip(2 * seed..);
    runs.map(|((kappa, angle), seed)| {
        let start = [1.0, 0.03, angle];
        run(&RESONATOR, kappa, start, 400, 0.1, NOISE, seed)
    })
    .collect()
}

/// Asserts that the splits' errors are their deviations, and that the decay is this one, in runs with such a damping.
fn check(
    runs: impl Fn(u64) -> Vec<Run> + Sync,
    decay: f64,
    is_found: impl Fn(&Found) -> bool + Sync,
) {
    let trials = 60;
    let errors = (0..trials).into_par_iter().map(|seed| {
        let found = fit(&runs(seed)).unwrap();
        assert!(is_found(&found), "{:?}, {}", found.model, found.residual);
        assert!((found.residual - 1.0).abs() < 0.06, "{}", found.residual);
        let (value, std) = found.resonator().unwrap().decay;
        let [damping, _] = found.model.splits_at();
        std::array::from_fn(|i| match i.checked_sub(4) {
            None => {
                let at = damping + i;
                (found.values[at] - RESONATOR[1 + i]) / found.variance(at).sqrt()
            }
            Some(_) => (value - decay) / std,
        })
    });
    let errors: Vec<[f64; 5]> = errors.collect();
    for (i, rms) in rms(&errors).into_iter().enumerate() {
        // The rms of 60 trials scatters by 9 %.
        assert!((0.72..1.3).contains(&rms), "{i}: {rms}");
    }
}

#[test]
fn a_drift_of_the_damping_falsifies_nothing() {
    for runs in [turning_both_ways, |seed| at_three_angles(NOISE, seed)] {
        let is_found = |found: &Found| {
            let (value, std) = found.decay_drift(1, 39.9).unwrap();
            found.model.curves() > 0 && (value - DRIFT).abs() < 5.0 * std
        };
        check(|seed| damped(runs(seed), drifting), RESONATOR[0], is_found);
    }
}

#[test]
fn a_damping_that_settles_falsifies_nothing() {
    // 1/τ is 2 % greater at first. The straight line through what this takes off the logarithm has these weights, 6x(1−x) of the time.
    let more = 0.02 * RESONATOR[0];
    let p = |time: f64, _| -more * 15.0 * (-time / 15.0).exp_m1();
    let weighted = (0..4000).map(|k| {
        let x = (k as f64 + 0.5) / 4000.0;
        6.0 * x * (1.0 - x) * (-39.9 * x / 15.0).exp() / 4000.0
    });
    let decay = RESONATOR[0] + more * weighted.sum::<f64>();
    let is_found = |found: &Found| found.model.curves() > 1;
    check(|seed| damped(turning_both_ways(seed), p), decay, is_found);
}

#[test]
fn decays_that_differ_from_run_to_run_falsify_no_split() {
    // By a thousandth and by a twentieth: the runs share all else.
    for more in [1e-3, 0.05] {
        let more = more * RESONATOR[0];
        let trials = 60;
        let errors = (0..trials).into_par_iter().map(|seed| {
            let mut runs = turning_both_ways(seed);
            let other = damped(runs.split_off(1), |time, _| more * time);
            let found = fit(&[runs, other].concat()).unwrap();
            assert_eq!(found.model.damping, Damping::InTime(0), "{more}");
            // The smaller wave has less noise too.
            assert!((0.85..1.06).contains(&found.residual), "{}", found.residual);
            let [damping, _] = found.model.splits_at();
            let errors: [f64; 5] = std::array::from_fn(|i| match i.checked_sub(4) {
                None => {
                    let at = damping + i;
                    (found.values[at] - RESONATOR[1 + i]) / found.variance(at).sqrt()
                }
                Some(_) => {
                    let at = found.model.decay_at(1);
                    (found.values[at] - RESONATOR[0] - more) / found.variance(at).sqrt()
                }
            });
            // The mean says how far the runs lie apart: of two, half of that.
            let (mean, std) = found.resonator().unwrap().decay;
            assert!((mean - RESONATOR[0] - 0.5 * more).abs() < 0.1 * more);
            assert!((0.45..0.6).contains(&(std / more)), "{std} {more}");
            errors
        });
        for (i, rms) in rms(&errors.collect::<Vec<_>>()).into_iter().enumerate() {
            assert!((0.72..1.3).contains(&rms), "{i}: {rms}");
        }
    }
}

#[test]
fn no_turning_by_amplitudes_is_stated_where_the_damping_changes() {
    // As a gain that drifts, of one pick-off or of both, may look like it.
    let found = Found {
        unseen_turning: Some((0.01, 0.001)),
        ..fit(&damped(turning_both_ways(1), drifting)).unwrap()
    };
    assert!(found.model.curves() > 0 && !found.is_beyond_noise());
    let resonator = found.resonator().unwrap();
    assert!(resonator.turning_by_amplitudes.is_none() && found.withholds_turning());
}

#[test]
fn the_decays_of_both_modes_have_their_own_deviations() {
    let trials = 60;
    let errors = (0..trials).into_par_iter().map(|seed| {
        let resonator = fit(&turning_both_ways(seed)).unwrap().resonator().unwrap();
        let split = 0.5 * RESONATOR[1].hypot(RESONATOR[2]);
        let truths = [RESONATOR[0] + split, RESONATOR[0] - split];
        std::array::from_fn(|i| {
            let (value, std) = resonator.decays[i];
            (value - truths[i]) / std
        })
    });
    let errors: Vec<[f64; 2]> = errors.collect();
    for rms in rms(&errors) {
        assert!((0.72..1.3).contains(&rms), "{rms}");
    }
}

#[test]
fn damping_that_depends_on_the_amplitude_is_determined() {
    // 1/τ is 1 % greater at an amplitude of 1.
    let by_energy = 0.01 * RESONATOR[0];
    let p = |_, integral: f64| 0.5 * (2.0 * by_energy * integral).ln_1p();
    let is_found = |found: &Found| {
        let (value, std) = found.decay_by_energy().unwrap();
        (value - by_energy).abs() < 5.0 * std && std < 0.1 * by_energy
    };
    check(
        |seed| damped(turning_both_ways(seed), p),
        RESONATOR[0],
        is_found,
    );
}

#[test]
fn a_steady_damping_is_not_given_up() {
    // It determines the decay better. Some rows reach the noise, where the last form many runs.
    let mut runs: Vec<_> = (0..20).map(|seed| at_three_angles(NOISE, seed)).collect();
    runs.extend((0..20).map(turning_both_ways));
    for seed in 0..4 {
        let whole = run(
            &RESONATOR,
            0.2,
            [1.0, 0.03, 0.3],
            1500,
            0.1,
            20.0 * NOISE,
            seed,
        );
        let clean = |row: &Row| row.main - row.quadrature.abs() > 8.0 * row.deviations[0];
        let pieces = whole.rows.chunk_by(|row, next| clean(row) == clean(next));
        let pieces = pieces.filter(|rows| rows.len() >= MIN_ROWS && clean(&rows[0]));
        runs.push(pieces.map(|rows| whole.with(rows.to_vec())).collect());
    }
    for runs in runs {
        let found = fit(&runs).unwrap();
        assert_eq!(found.model.damping, Damping::Steady, "{} runs", runs.len());
    }
}

#[test]
fn what_damping_does_not_explain_is_not_taken_for_it() {
    // A ripple, of which some curves take a part.
    let p = |time: f64, _| 0.003 * (time / 2.0).sin();
    let found = fit(&damped(turning_both_ways(1), p)).unwrap();
    assert_eq!(found.model.damping, Damping::Steady);
    assert!(found.residual > 2.0, "{}", found.residual);
}

#[test]
fn a_table_may_turn_unsteadily_meanwhile() {
    let slower = |time: f64| 0.2 * (-0.05 * time).exp();
    let is_found = |found: &Found| found.model.is_unsteady() && found.model.curves() > 0;
    let runs = |seed| {
        let one = |way: f64, angle, seed| {
            let start = [1.0, 0.03, angle];
            run_turned(
                &RESONATOR,
                |t| way * slower(t),
                start,
                400,
                0.1,
                NOISE,
                seed,
            )
        };
        damped(
            vec![one(1.0, 0.2, 2 * seed), one(-1.0, 0.9, 2 * seed + 1)],
            drifting,
        )
    };
    check(runs, RESONATOR[0], is_found);
}

#[test]
fn the_run_that_knows_its_decay_best_counts_most() {
    let drift = 0.2 * RESONATOR[0] / 39.9;
    let p = |time: f64, _| 0.5 * drift * time * time;
    let mut runs = turning_both_ways(1);
    runs[1].rows.truncate(60);
    let found = fit(&damped(runs, p)).unwrap();
    let (value, std) = found.resonator().unwrap().decay;
    let decay = RESONATOR[0] + 0.5 * drift * 39.9;
    assert!((value / decay - 1.0).abs() < 0.01, "{value} {decay}");
    let [best, other] = [0, 1].map(|run| found.variance(found.model.decay_at(run)).sqrt());
    assert!(best < 0.25 * other, "{best} {other}");
    // The runs have different decays, which makes their mean less certain than noise does.
    let [of_best, of_other] = [0, 1].map(|run| found.values[found.model.decay_at(run)]);
    assert!(
        std > 10.0 * best && std < 0.2 * (of_best - of_other).abs(),
        "{std} {best}"
    );
}

#[test]
fn the_equations_are_the_slope_of_the_squares_also_in_noise() {
    let start = [1.0, 0.03, 0.3];
    let runs = [run(&RESONATOR, 0.2, start, 200, 0.1, 500.0 * NOISE, 1)];
    for damping in [Damping::ByEnergy, Damping::InTime(MAX_IN_TIME)] {
        let kind = Kind::Shared;
        let model = Model { kind, damping };
        let steady = Model::steady(kind);
        let values = found(&runs, steady).unwrap().values;
        let values = model.values_from(steady, &values, 1);
        let normal = Normal::of(&runs, model, &values);
        let places = match damping {
            Damping::InTime(_) => model.curves_at(0)..model.unknowns(1),
            _ => model.by_energy_at()..model.by_energy_at() + 1,
        };
        for place in places {
            let squares = |by: f64| {
                let mut moved = values.clone();
                moved[place] += by;
                Normal::of(&runs, model, &moved).squares
            };
            let slope = (squares(1e-5) - squares(-1e-5)) / 2e-5;
            let stated = -2.0 * normal.equations.right()[place];
            assert!(
                (slope - stated).abs() < 0.01 * stated.abs().max(10.0),
                "{place}: {slope} {stated}"
            );
        }
    }
}

#[test]
fn splits_that_only_a_shared_decay_shows_are_kept() {
    // Patterns at rest for so short a time that they hardly move: their decays show the split of damping.
    let at_rest = |angle, seed| run(&RESONATOR, 0.0, [1.0, 0.02, angle], 60, 0.01, NOISE, seed);
    let runs = vec![at_rest(0.2, 1), at_rest(0.59, 2), at_rest(0.98, 3)];
    let p = |time: f64, _| 0.02 * time * (time - 0.59);
    for runs in [runs.clone(), damped(runs, p)] {
        let found = fit(&runs).unwrap();
        assert_eq!(found.model.damping, Damping::Steady);
        let [damping, _] = found.resonator().unwrap().damping_split;
        assert!(damping.1 < 0.002, "{damping:?}");
    }
}

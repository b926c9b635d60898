//! Patterns that are turned unsteadily.

use super::*;
use crate::runs::way::bow;

/// Unsteady rates of tables, rad/s, over time: a ripple, a start, one that slows down, to and fro.
const UNSTEADY: [fn(f64) -> f64; 4] = [
    |time| 0.2 + 0.002 * time.sin(),
    |time| 0.2 * (time / 0.5).min(1.0),
    |time| 0.2 * (-0.05 * time).exp(),
    |time| if time < 20.0 { 0.15 } else { -0.15 },
];

#[test]
fn deviations_hold_however_patterns_are_turned() {
    for (index, rate) in UNSTEADY.into_iter().enumerate() {
        // Mean over the 39.8 s of a run.
        let rates = (0..3980).map(|k| rate(0.01 * (k as f64 + 0.5)));
        let mean = rates.sum::<f64>() / 3980.0;
        let trials = 100;
        let errors = (1000..1000 + trials).into_par_iter().map(|seed| {
            let one = |way: f64, angle: f64, seed| {
                let start = [1.0, 0.03, angle];
                run_turned(&RESONATOR, |t| way * rate(t), start, 200, 0.2, NOISE, seed)
            };
            let found = fit(&[one(1.0, 0.2, 2 * seed), one(-1.0, 0.9, 2 * seed + 1)]).unwrap();
            assert!(found.model.is_unsteady());
            assert!((found.residual - 1.0).abs() < 0.15, "{}", found.residual);
            let rotations = found.resonator().unwrap().rotations;
            std::array::from_fn(|i| match i.checked_sub(5) {
                None => (found.values[i] - RESONATOR[i]) / found.variance(i).sqrt(),
                Some(run) => {
                    let (rotation, deviation) = rotations[run];
                    assert!(deviation < 1e-5, "{deviation}");
                    (rotation - [mean, -mean][run]) / deviation
                }
            })
        });
        let errors: Vec<[f64; 7]> = errors.collect();
        for (i, rms) in rms(&errors).into_iter().enumerate() {
            // The rms of 100 trials scatters by 7 %.
            assert!((0.75..1.25).contains(&rms), "{index}, {i}: {rms}");
        }
    }
}

#[test]
fn a_steady_rotation_is_not_given_up() {
    // It determines the splits better, as they also turn the patterns.
    for seed in 0..20 {
        assert!(
            !fit(&at_three_angles(NOISE, seed))
                .unwrap()
                .model
                .is_unsteady()
        );
        let turned = [0.2, -0.2].map(|kappa| {
            let start = [1.0, 0.03, 0.5];
            run(
                &RESONATOR,
                kappa,
                start,
                400,
                0.1,
                NOISE,
                7 * seed + u64::from(kappa > 0.0),
            )
        });
        assert!(!fit(&turned).unwrap().model.is_unsteady());
    }
}

#[test]
fn one_pattern_that_hardly_swings_determines_no_splits() {
    let swing = |time: f64| 0.02 * (3.0 * time).sin();
    let run = run_turned(&RESONATOR, swing, [1.0, 0.03, 0.2], 30, 0.2, NOISE, 1);
    let found = fit(&[run]).unwrap();
    assert!(found.model.is_unsteady() && found.resonator().is_none());
    // Nor do splits change its frequency.
    assert_eq!(found.splits(&[1.0; 4]), (0.0, 0.0));
}

#[test]
fn a_table_may_speed_up_among_rows_left_out() {
    let rate = |time: f64| 0.2 * (time - 8.13).clamp(0.0, 1.0);
    let errors = |is_shown: bool| {
        let trials = (0..6).into_par_iter().map(|seed| {
            let one = |way: f64, angle: f64, seed| {
                let start = [1.0, 0.03, angle];
                let turns = |time| way * rate(time);
                let mut all = run_turned(&RESONATOR, turns, start, 800, 0.05, NOISE, seed);
                let begun = all.rows[0].time;
                let is_between = |row: &&Row| (8.0..9.3).contains(&(row.time - begun));
                let between = all.rows.iter().filter(is_between);
                let between: Vec<_> = between.map(|row| [row.time, row.angle]).collect();
                all.rows.retain(|row| !is_between(&row));
                let next = all.rows.partition_point(|row| row.time < begun + 9.0);
                if is_shown {
                    all.rows[next].bow = bow(&all.rows[next - 1], &all.rows[next], &between);
                }
                all
            };
            let found = fit(&[one(1.0, 0.2, 2 * seed), one(-1.0, 0.9, 2 * seed + 1)]).unwrap();
            assert!(found.model.is_unsteady());
            (0..5)
                .map(|i| ((found.values[i] - RESONATOR[i]) / found.variance(i).sqrt()).powi(2))
                .sum::<f64>()
        });
        (trials.sum::<f64>() / 30.0).sqrt()
    };
    let [steadily, shown] = [false, true].map(errors);
    assert!(steadily > 3.0 && shown < 1.4, "{steadily} {shown}");
}

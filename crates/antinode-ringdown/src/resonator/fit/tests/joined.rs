//! Many rows, whose means tell which model explains them.

use super::damping::{damped, drifting};
use super::*;

/// Two runs of 30 000 rows in 40 s, whose patterns are turned at these rates, rad/s, one way and the other.
fn many(resonator: &[f64; 6], rate: impl Fn(f64) -> f64, seed: u64) -> Vec<Run> {
    let runs = [(1.0, 0.2), (-1.0, 0.9)].into_iter().zip(2 * seed..);
    runs.map(|((way, angle), seed)| {
        let start = [1.0, 0.05, angle];
        let count = 30_000;
        let step = 40.0 / count as f64;
        run_turned(resonator, |t| way * rate(t), start, count, step, 1e-3, seed)
    })
    .collect()
}

#[test]
fn a_fit_by_means_is_that_to_all_rows() {
    const STIFF: [f64; 6] = [0.05, 0.006, -0.008, 0.03, 0.04, 2e-3];
    let cases: [fn(u64) -> Vec<Run>; 6] = [
        |seed| many(&RESONATOR, |_| 0.1, seed),
        |seed| many(&RESONATOR, |_| 0.0, seed),
        |seed| many(&RESONATOR, |time| 0.1 + 0.01 * time.sin(), seed),
        // To and fro in six rows, of which no mean shows anything.
        |seed| {
            many(
                &RESONATOR,
                |time| 0.1 + 4.0 * (125.0 * TAU * time).sin(),
                seed,
            )
        },
        |seed| many(&STIFF, |_| 0.1, seed),
        |seed| damped(many(&RESONATOR, |_| 0.1, seed), drifting),
    ];
    (0..cases.len()).into_par_iter().for_each(|index| {
        let runs = cases[index](2);
        let means = joined(&runs).unwrap();
        assert!(means.iter().all(|run| run.rows.len() < 6000));
        let (found, all) = (fit(&runs).unwrap(), fit_all(&runs).unwrap());
        assert_eq!(found.model, all.model, "{index}");
        let residuals = [found.residual, all.residual];
        assert!(
            (residuals[0] / residuals[1] - 1.0).abs() < 1e-6,
            "{index}: {residuals:?}"
        );
        for at in 0..all.values.len() {
            let [deviation, of_all] = [&found, &all].map(|fit| fit.variance(at).sqrt());
            let apart = (found.values[at] - all.values[at]) / of_all;
            assert!(apart.abs() < 0.02, "{index}, {at}: {apart}");
            assert!((deviation / of_all - 1.0).abs() < 1e-3, "{index}, {at}");
        }
    });
}

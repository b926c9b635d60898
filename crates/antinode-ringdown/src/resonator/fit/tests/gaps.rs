//! Runs with gaps in which splits move the patterns far.

use super::*;

/// Three ring-downs of 600 s, of which the first and the last 20 s are kept, of a resonator whose split of frequency is 1 mHz.
fn sparse(seed: u64) -> Vec<Run> {
    let mut random = Deviates::new(1000 + seed);
    let mut axis = |size: f64| {
        let (sine, cosine) = (4.0 * random.draw()).sin_cos();
        [size * cosine, size * sine]
    };
    let ([dc, ds], [wc, ws]) = (axis(2e-4), axis(6.3e-3));
    let resonator = [1.0 / 300.0, dc, ds, wc, ws, 0.0];
    let runs = [0.0, 0.39, 0.785].into_iter().enumerate();
    runs.map(|(index, angle)| {
        let quadrature = 0.05 * random.draw();
        let start = [0.8, quadrature, angle];
        let seed = 3 * seed + index as u64;
        let mut run = run(&resonator, 0.0, start, 1200, 0.5, 2e-5, seed);
        // Few rows between count as none.
        let is_kept = |time| !(27.0..587.0).contains(&time) || (300.0..302.0).contains(&time);
        run.rows.retain(|row| is_kept(row.time));
        run
    })
    .collect()
}

#[test]
fn a_gap_in_which_patterns_move_far_is_bridged() {
    for seed in 0..20 {
        let found = fit(&sparse(seed)).unwrap();
        assert!(
            found.residual < 1.2 && found.resonator().is_some(),
            "{seed}: {}",
            found.residual
        );
    }
}

//! Runs with gaps in which splits move the patterns far.

use super::*;

/// Three ring-downs of 600 s, of which the first and the last 20 s are kept, of a resonator whose frequencies are so far apart, rad/s.
fn sparse(split: f64, seed: u64) -> Vec<Run> {
    let mut random = Deviates::new(1000 + seed);
    let mut axis = |size: f64| {
        let (sine, cosine) = (4.0 * random.draw()).sin_cos();
        [size * cosine, size * sine]
    };
    let ([dc, ds], [wc, ws]) = (axis(2e-4), axis(split));
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
    // 1 mHz, which a search finds by itself, and 2 mHz, which it does not.
    for (split, is_found) in [(6.3e-3, true), (12.6e-3, false)] {
        for seed in 0..20 {
            let runs = sparse(split, seed);
            let plain = searched(&runs, Model::steady(Kind::Shared)).unwrap();
            assert_eq!(
                plain.residual < 1.2,
                is_found,
                "{split}, {seed}: {}",
                plain.residual
            );
            let found = fit(&runs).unwrap();
            assert!(
                found.residual < 1.2 && found.resonator().is_some(),
                "{split}, {seed}: {}",
                found.residual
            );
        }
    }
}

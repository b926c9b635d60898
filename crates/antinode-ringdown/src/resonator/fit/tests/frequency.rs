//! What the frequency uses of a fit.

use super::super::super::frequency::{Frequency, frequency, moved};
use super::*;

/// The mean frequency of three ring-downs whose rows have these frequencies, Hz, at a time, s, and state this deviation.
fn of_rows(mut at: impl FnMut(f64) -> f64, deviation: f64) -> Frequency {
    let mut runs =
        [0.2, 0.59, 0.98].map(|angle| run(&ROUND, 0.0, [1.0, 0.02, angle], 400, 0.1, NOISE, 1));
    for row in runs.iter_mut().flat_map(|run| &mut run.rows) {
        row.frequency = at(row.time);
        row.frequency_deviation = deviation;
        row.phase = None;
    }
    let found = fit(&runs).unwrap();
    frequency(&mut runs, &found)
}

#[test]
fn frequencies_that_scatter_by_more_than_their_deviations_widen_that_of_the_mean() {
    let [honest, boastful] = [0.01, 0.002].map(|deviation| {
        let mut random = Deviates::new(1);
        of_rows(|_| 5332.0 + 0.01 * random.draw(), deviation)
    });
    assert_eq!([honest.moves, boastful.moves], [None; 2]);
    let [(_, honest), (_, boastful)] = [honest.mean, boastful.mean];
    assert!((boastful / honest - 1.0).abs() < 0.1, "{boastful} {honest}");
}

#[test]
fn a_frequency_that_goes_to_and_fro_is_seen() {
    let mut random = Deviates::new(1);
    let swinging = |time: f64| 5332.0 + 0.02 * time.sin() + 0.01 * random.draw();
    let rms = of_rows(swinging, 0.01).moves.unwrap();
    assert!((rms / (0.02 / 2f64.sqrt()) - 1.0).abs() < 0.2, "{rms}");
}

#[test]
fn the_splits_part_of_the_frequency_is_averaged_across_rows_left_out() {
    // A period of the splits has 157 rows, of which 20 are left out.
    let resonator = [0.05, 0.006, -0.008, 1.2, 1.6, 0.0];
    let whole = run(&resonator, 0.0, [0.8, 0.1, 0.3], 620, 0.02, 1e-9, 1);
    let mut few = whole.clone();
    few.rows = (0..620)
        .filter(|k| *k == 0 || k % 157 > 20)
        .map(|k| whole.rows[k])
        .collect();
    // Their part of the phase, rad: from these averages, and from the rows alone.
    let phases = |run: Run| {
        let runs = [run];
        let found = found(&runs, Model::steady(Kind::Shared)).unwrap();
        let moved = moved(&found, &runs);
        let mut phases = [0.0; 2];
        for (pair, moved) in runs[0].rows.windows(2).zip(moved.windows(2)) {
            let seconds = pair[1].time - pair[0].time;
            let of = |by: &[f64; 4]| found.splits(by).0 * seconds;
            phases[0] += of(&moved[1].by_splits_since);
            phases[1] += 0.5 * (of(&moved[0].by_splits) + of(&moved[1].by_splits));
        }
        phases
    };
    let ([whole, _], [averaged, of_rows]) = (phases(whole), phases(few));
    assert!((averaged - whole).abs() < 1e-3, "{averaged} {whole}");
    assert!((of_rows - whole).abs() > 1e-2, "{of_rows} {whole}");
}

#[test]
fn turning_by_amplitudes_is_known_though_it_is_no_unknown() {
    let quadrature = [0.3, -0.3].map(|quadrature| [1.0, quadrature, 0.3]);
    let runs = quadrature.map(|start| run(&RESONATOR, 0.3, start, 400, 0.1, NOISE, 1));
    let found = fit(&runs).unwrap();
    assert_eq!(found.model, Model::steady(Kind::Shared));
    let (turning, std) = found.turning_by_amplitudes().unwrap();
    assert!(turning.abs() < 4.0 * std && std < 1e-3, "{turning} {std}");
}

#[test]
fn a_pattern_that_turns_moves_the_frequency_if_it_has_quadrature() {
    let [main, quadrature, kappa] = [1.0, 0.3, -0.4];
    let motion = Motion::new(&[0.05, 0.0, 0.0, 0.0, 0.0, 0.0, kappa, main, quadrature, 0.2]);
    // 2 θ̇ Q/E at θ̇ = −κ/2.
    let expected = -kappa * 2.0 * quadrature / (1.0 + quadrature * quadrature);
    assert!((motion.frequency_by_turning() - expected).abs() < 1e-12);
}

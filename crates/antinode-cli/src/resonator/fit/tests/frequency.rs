//! What the frequency uses of a fit.

use super::*;

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
        let moved = found.frequency_moved(&runs);
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

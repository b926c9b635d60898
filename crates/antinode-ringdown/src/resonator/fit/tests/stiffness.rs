//! Stiffness that depends on the amplitude.

use super::*;

#[test]
fn stiffness_that_depends_on_the_amplitude_is_determined_beside_the_splits() {
    // The frequency falls by 1 mHz meanwhile: γ is a third of that at E of one, rad/s.
    let gamma = 1e-3 * TAU / 3.0;
    let mut stiff = RESONATOR;
    stiff[5] = gamma;
    for kappas in [[4e-5; 3], [0.2, -0.2, 0.1]] {
        let mut squares = [0.0; 6];
        let trials = 100;
        for seed in 0..trials {
            let runs: Vec<_> = [0.2, 0.59, 0.98]
                .into_iter()
                .zip(kappas)
                .enumerate()
                .map(|(index, (angle, kappa))| {
                    let start = [1.0, 0.05, angle];
                    run(
                        &stiff,
                        kappa,
                        start,
                        400,
                        0.1,
                        NOISE,
                        3 * seed + index as u64,
                    )
                })
                .collect();
            let found = fit(&runs).unwrap();
            for (i, (square, truth)) in squares.iter_mut().zip(stiff).enumerate() {
                let error = (found.values[i] - truth) / found.variance(i).sqrt();
                *square += error * error / trials as f64;
            }
            let (turning, deviation) = found.resonator().unwrap().turning_by_amplitudes.unwrap();
            assert!((turning + gamma).abs() < 5.0 * deviation);
            assert!(deviation < 0.1 * gamma, "{deviation}");
            assert!((found.residual - 1.0).abs() < 0.06, "{}", found.residual);
        }
        // Of 100 trials the rms scatters by 7 %.
        for square in squares {
            assert!(
                (0.79..1.21).contains(&square.sqrt()),
                "{kappas:?}: {squares:?}"
            );
        }
    }
}

#[test]
fn turning_by_amplitudes_is_not_reported_if_residuals_are_more_than_noise() {
    // Pick-offs whose gains differ by 1 %.
    let runs = [0.3, -0.3].map(|kappa| {
        let mut run = run(&RESONATOR, kappa, [1.0, 0.1, 0.3], 400, 0.1, NOISE, 1);
        for row in &mut run.rows {
            let sine = (2.0 * row.angle).sin();
            row.main *= 1.0 + 0.01 * sine * sine;
            row.angle += 0.0025 * (4.0 * row.angle).sin();
        }
        run
    });
    let mut found = fit(&runs).unwrap();
    assert!(found.is_beyond_noise(), "{}", found.residual);
    let (turning, std) = found.turning_by_amplitudes().unwrap();
    assert!(turning.abs() > 3.0 * std, "{turning} {std}");
    assert_eq!(found.resonator().unwrap().turning_by_amplitudes, None);
    assert!(found.withholds_turning());
    // With fewer deviations it would not be reported in any case.
    found.widening *= (turning.abs() / std / 2.9).powi(2);
    assert!(found.is_nonlinear() && !found.withholds_turning());
}

#[test]
fn a_single_step_shows_the_turning_by_amplitudes_as_a_whole_fit_does() {
    for seed in 0..10 {
        let quadrature = [0.3, -0.3].map(|quadrature| [1.0, quadrature, 0.3]);
        let runs = quadrature.map(|start| run(&RESONATOR, 0.3, start, 400, 0.1, NOISE, seed));
        let linear = found(&runs, Model::steady(Kind::Shared)).unwrap();
        let whole = found(&runs, Model::steady(Kind::Nonlinear));
        let [(step, of_step), (whole, of_whole)] = [turned(&runs, &linear), whole]
            .map(|found| found.unwrap().turning_by_amplitudes().unwrap());
        assert!((step - whole).abs() < 0.1 * of_whole, "{step} {whole}");
        assert!(
            (of_step / of_whole - 1.0).abs() < 0.02,
            "{of_step} {of_whole}"
        );
    }
}

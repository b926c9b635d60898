//! Whether rows determine the splits.

use super::*;

#[test]
fn noise_is_no_spread() {
    for seed in 0..20 {
        // 4θ scatters by 0.12 rad at first and 0.2 at the end: a circular variance of 0.013.
        let noisy = [run(&ROUND, 0.0, [1.0, 0.01, 0.2], 1000, 0.01, 0.06, seed)];
        assert!(
            spread(&noisy).abs() < 0.3 * MIN_SPREAD,
            "{}",
            spread(&noisy)
        );
    }
    let apart = [0.2, 0.2 + 3f64.to_radians()]
        .map(|angle| run(&ROUND, 0.0, [1.0, 0.0, angle], 20, 0.1, 0.0, 1));
    assert!(
        (spread(&apart) / MIN_SPREAD - 1.1).abs() < 0.02,
        "{}",
        spread(&apart)
    );
}

#[test]
fn the_motion_of_one_pattern_by_splits_determines_them() {
    // Most damped where it stands: it is moved by the split of frequency alone, by way of the quadrature.
    let angle = 0.25 * (-0.8f64).atan2(0.6);
    let runs = [run(
        &RESONATOR,
        0.0,
        [1.0, 0.02, angle],
        800,
        0.01,
        NOISE,
        1,
    )];
    assert!(spread(&runs) < MIN_SPREAD, "{}", spread(&runs));
    let found = fit(&runs).unwrap();
    let resonator = found.resonator().unwrap();
    let [(split, deviation), _] = resonator.frequency_split;
    assert!(
        (split - 0.05).abs() < 4.0 * deviation && deviation < 1e-3,
        "{split} {deviation}"
    );
    assert!((found.residual - 1.0).abs() < 0.1, "{}", found.residual);
}

#[test]
fn two_angles_for_a_short_time_do_not_determine_the_splits() {
    let runs =
        [0.2, 0.59].map(|angle| run(&RESONATOR, 0.0, [1.0, 0.02, angle], 100, 0.02, NOISE, 1));
    assert!(spread(&runs) > MIN_SPREAD);
    assert!(fit(&runs).unwrap().resonator().is_none());
}

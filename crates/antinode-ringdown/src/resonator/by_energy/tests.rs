//! Tests with frequencies that consist of a decaying energy, a drift and noise.

use super::*;
use antinode_sim::Deviates;

/// A row's standard deviation of the frequency, Hz.
const NOISE: f64 = 1e-3;
const TRIALS: u64 = 72;

/// Change of a run's frequency, Hz, after a time, s.
type Drift = dyn Fn(usize, f64) -> f64;

/// Two runs of 30 s and 1600 rows that decay at `decay` 1/s; the frequency changes by `by` Hz per energy, and by `drift` Hz with time.
fn runs(decay: f64, by: f64, drift: impl Fn(usize, f64) -> f64, seed: u64) -> Vec<Vec<Point>> {
    let mut random = Deviates::new(seed);
    let mut run = |index: usize| {
        let rows = (0..1600).map(|k| {
            let time = 30.0 / 1600.0 * f64::from(k);
            let energy = 0.25 * (-2.0 * decay * time).exp();
            Point {
                time: 5.0 + time,
                weight: NOISE.powi(-2),
                energy,
                excess: 0.1 + by * energy + drift(index, time) + NOISE * random.draw(),
            }
        });
        rows.collect()
    };
    vec![run(0), run(1)]
}

fn found(runs: &[Vec<Point>], are_weighted: bool, by_turning: Option<Measured>) -> ByEnergy {
    by_energy(runs, without_mean(runs), are_weighted, by_turning)
}

/// Rms error over the stated deviation, in trials that determine the value, and the number of these.
fn rms(decay: f64, by: f64, drift: impl Fn(usize, f64) -> f64) -> (f64, u64) {
    let (mut squares, mut determined) = (0.0, 0);
    for seed in 0..TRIALS {
        let runs = runs(decay, by, &drift, seed);
        if let Some((value, std)) = found(&runs, true, None).value() {
            squares += ((value - by) / std).powi(2);
            determined += 1;
        }
    }
    ((squares / determined as f64).sqrt(), determined)
}

#[test]
fn stated_deviations_are_the_rms_errors_whatever_the_drift() {
    let none = |_, _| 0.0;
    let weak = |_, time: f64| 2e-5 * time;
    let linear = |_, time: f64| 1e-4 * time;
    let cooling = |run, time: f64| 1e-3 * run as f64 - 2e-4 * time;
    // As after a step of the temperature, and as with one that comes and goes.
    let curved = |_, time: f64| 6e-3 * (1.0 - (-time / 60.0).exp());
    let wave = |run, time: f64| 0.01 * (time / 40.0 + run as f64).sin();
    let all: [(&str, &Drift); 6] = [
        ("none", &none),
        ("weak", &weak),
        ("linear", &linear),
        ("cooling", &cooling),
        ("curved", &curved),
        ("wave", &wave),
    ];
    for (name, drift) in all {
        for (decay, by) in [(0.03, 0.3), (0.1, 0.03)] {
            let (rms, determined) = rms(decay, by, drift);
            assert!((0.8..1.25).contains(&rms), "{name}, {by}: {rms}");
            assert!(10 * determined >= 9 * TRIALS, "{name}, {by}: {determined}");
        }
        let (_, determined) = rms(0.03, 0.0, drift);
        assert_eq!(determined, 0, "{name}");
    }
}

#[test]
fn if_the_turning_of_patterns_agrees_there_is_no_drift_unless_one_is_seen() {
    let of = |drift: f64, said: f64| {
        let runs = runs(0.03, 0.3, |_, time| drift * time, 2);
        found(&runs, true, Some((said, 0.01)))
    };
    let ByEnergy::Alone((value, std), hidden) = of(0.0, 0.31) else {
        panic!("{:?}", of(0.0, 0.31));
    };
    assert!((value - 0.3).abs() < 4.0 * std && std < 4e-4);
    let ByEnergy::Alone((moved, _), _) = of(hidden, 0.31) else {
        panic!("{:?}", of(hidden, 0.31));
    };
    assert!(((moved - value).abs() / std - 1.0).abs() < 1e-6);
    assert!((1e-7..1e-5).contains(&hidden), "{hidden}");
    assert!(matches!(of(1e-4, 0.3), ByEnergy::Beside(_)));
    assert_eq!(of(0.0, 0.34), ByEnergy::Denied);
    let falling = runs(0.03, -0.3, |_, _| 0.0, 2);
    let falls = found(&falling, true, Some((-0.31, 0.01)));
    assert!(matches!(falls, ByEnergy::Alone(..)), "{falls:?}");
}

#[test]
fn a_settling_temperature_is_not_taken_for_the_energy_if_patterns_do_not_turn() {
    let settling = |_, time: f64| 0.02 * (-time / 10.0).exp();
    let runs = runs(0.05, 0.0, settling, 3);
    let of = |by_turning| found(&runs, true, by_turning);
    // Nothing else distinguishes them.
    assert!(matches!(of(None), ByEnergy::Beside(_)));
    assert!(matches!(of(Some((0.01, 0.5))), ByEnergy::Beside(_)));
    assert_eq!(of(Some((1e-3, 1e-3))), ByEnergy::Denied);
}

#[test]
fn frequencies_without_deviations_give_the_same_result() {
    let known = runs(0.03, 0.3, |_, time| 1e-4 * time, 1);
    let mut unknown = known.clone();
    for point in unknown.iter_mut().flatten() {
        point.weight = 1.0;
    }
    let [Some(known), Some(unknown)] = [(known, true), (unknown, false)]
        .map(|(runs, are_weighted)| found(&runs, are_weighted, None).value())
    else {
        panic!();
    };
    assert!((known.0 - unknown.0).abs() < 1e-9 && (unknown.1 / known.1 - 1.0).abs() < 0.1);
}

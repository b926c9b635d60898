//! `antinode calibrate`: rows in which something drives the wave, between the ring-downs of one recording.

use crate::common::ring_downs::in_one;
use crate::common::run_with;

#[test]
fn driven_rows_are_left_out_of_the_calibration() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // Amplitude, angle and phase are continuous, as 2 s are whole periods.
    let waves = [(1, "0.7"), (2, "-0.6")].into_iter().flat_map(|(seed, rate)| {
        [
            "--seconds 2 --decay-rate 0".to_owned(),
            format!("--seconds 3 --decay-rate 0.1 --angle-rate {rate}"),
        ]
        .map(|wave| {
            format!("{wave} --noise 0.002 --frequency 5332 --gain-ratio 1.03 --angle 0.3 --seed {seed}")
        })
    });
    let found = run_with(here, "calibrate - --output csv", in_one(here, waves));
    assert_eq!(found.code, 0, "{}", found.err);
    for (line, (quantity, truth, most)) in found.out.lines().skip(1).zip([
        ("gain_ratio", 1.03, 1e-4),
        ("skew_ns", 0.0, 2.0),
        ("pick_off_angle_rad", 0.0, 5e-5),
    ]) {
        let fields: Vec<_> = line.split(',').collect();
        let [value, std] = [1, 2].map(|i: usize| fields[i].parse::<f64>().unwrap());
        assert_eq!(fields[0], quantity);
        assert!((value - truth).abs() < 4.0 * std && std < most, "{line}");
    }
    assert!(
        found.err.starts_with("warning: left out: 2 runs")
            && found.err.matches("warning").count() == 1,
        "{}",
        found.err
    );
}

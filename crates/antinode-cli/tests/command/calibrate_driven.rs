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

#[test]
fn driven_rows_that_leave_no_calibration_are_left_out_too() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let mut rows = "time_s,main_amplitude,quadrature_amplitude,angle_rad,frequency_hz,main_amplitude_std,quadrature_amplitude_std,\
                    angle_std_rad,flags,file\n"
        .to_owned();
    for (file, rate) in [("one", 0.6), ("other", -0.6)] {
        for row in 0..220 {
            // For 5 s a drive holds the wave, but lets quadrature grow; then the wave decays, and the table turns.
            let time = 0.05 * f64::from(row);
            let later = (time - 5.0).max(0.0);
            let main = (-0.2 * later).exp();
            let quadrature = (0.02 + 0.15 * time.min(5.0)) * main;
            let angle = 0.4 + rate * later;
            rows += &format!("{time},{main},{quadrature},{angle},5332,1e-4,1e-4,1e-4,,{file}\n");
        }
    }
    std::fs::write(here.join("rows.csv"), rows).unwrap();
    let found = run_with(here, "calibrate rows.csv --output csv", Vec::new());
    assert_eq!(found.code, 0, "{}", found.err);
    assert!(
        found.out.contains("gain_ratio,1.0000") || found.out.contains("gain_ratio,0.9999"),
        "{}",
        found.out
    );
    assert!(
        found.err.starts_with("warning: left out: 2 runs"),
        "{}",
        found.err
    );
}

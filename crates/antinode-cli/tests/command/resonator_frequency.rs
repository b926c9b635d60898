//! `antinode resonator`: the mean frequency, and its variation with time and with the energy.

use std::fs;

use crate::common::ring_downs::{joined, of_resonator, of_run, rows};
use crate::common::{done, rms, run, run_with};

#[test]
fn the_mean_frequency_of_a_ring_down_that_ends_in_noise_is_found_to_its_deviation() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let mut all = Vec::new();
    for seed in 1..=12 {
        // 18 s: the amplitude falls to a ten-thousandth.
        let simulated =
            format!("--seconds 18 --decay-rate 0.5 --noise 0.002 --sample i24 --seed {seed}");
        rows(here, &simulated, "--periods 100");
        let found = run(here, "resonator rows.csv --output csv");
        let (frequency, std) = of_resonator(&found.out, "frequency_hz");
        assert!(std < 1e-3, "{}", found.out);
        all.push((frequency - 5332.0) / std);
        let (residual, of_residual) = of_resonator(&found.out, "residual_over_noise");
        assert!((residual - 1.0).abs() < 5.0 * of_residual, "{}", found.out);
    }
    let rms = rms(&all);
    assert!((0.6..1.5).contains(&rms), "{rms}: {all:.1?}");
}

#[test]
fn the_mean_frequency_is_found_to_its_deviation_if_times_are_dates() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let mut all = Vec::new();
    for seed in 1..=8 {
        let simulated =
            format!("--seconds 6 --decay-rate 0.1 --noise 1e-4 --sample f32 --seed {seed}");
        rows(here, &simulated, "--periods 20");
        let text = fs::read_to_string(here.join("rows.csv")).unwrap();
        let (header, lines) = text.split_once('\n').unwrap();
        let since_1970 = lines.lines().map(|line| {
            let (time, rest) = line.split_once(',').unwrap();
            let time = 1.7e9 + 0.1 * f64::from(seed) + time.parse::<f64>().unwrap();
            format!("{time},{rest}\n")
        });
        let text = format!("{header}\n{}", since_1970.collect::<String>());
        let found = run_with(here, "resonator - --output csv", text.into());
        let (frequency, std) = of_resonator(&found.out, "frequency_hz");
        assert!(std < 1e-4, "{}", found.out);
        all.push((frequency - 5332.0) / std);
    }
    let rms = rms(&all);
    assert!((0.5..1.6).contains(&rms), "{rms}: {all:.1?}");
}

#[test]
fn the_mean_frequency_is_that_of_both_modes_at_any_pattern_angle() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (simulated, angles, windows, most) in [
        // Along these patterns it is 10 mHz, 4 mHz and 0.3 mHz higher.
        (
            "--seconds 4 --frequency-split 0.02 --frequency-angle -0.3",
            ["-0.3", "0", "0.1"],
            "--periods 50",
            1e-3,
        ),
        // On average it is lower along these, by many deviations of a row: phases are used all the same.
        (
            "--seconds 8 --frequency-split 0.005 --frequency-angle 0.39",
            ["0", "0.3927", "0.7854"],
            "--periods 1000",
            1e-4,
        ),
    ] {
        let all = (0..).zip(angles).map(|(seed, angle)| {
            format!("{simulated} --noise 0.002 --decay-rate 0.1 --angle {angle} --seed {seed}")
        });
        let all = joined(here, all, windows);
        let found = run_with(here, "resonator - --output csv", all);
        assert_eq!(found.err, "");
        let (frequency, std) = of_resonator(&found.out, "frequency_hz");
        assert!(
            (frequency - 5332.0).abs() < 4.0 * std && std < most,
            "{}",
            found.out
        );
    }
}

#[test]
fn a_frequency_that_moves_is_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (rate, is_told) in [("0", false), ("0.05", true), ("-0.3", true)] {
        rows(
            here,
            &format!(
                "--seconds 4 --noise 0.002 --decay-rate 0.1 --angle-rate 0.4 --frequency-rate {rate}"
            ),
            "--periods 50",
        );
        let found = done(here, "resonator rows.csv --output csv");
        for part in ["the frequency varies by", "the sample clock drifts"] {
            assert_eq!(found.err.contains(part), is_told, "{rate}: {}", found.err);
        }
        let (drift, std) = of_run(&found.out, "1", "frequency_drift_hz_s");
        let rate: f64 = rate.parse().unwrap();
        assert!(
            (drift - rate).abs() < 4.0 * std && std < 2e-3,
            "{}",
            found.out
        );
        // At the first sample it is 5332 Hz; in the middle of the recording it has moved by two seconds of its rate.
        let (frequency, std) = of_resonator(&found.out, "frequency_hz");
        let mean = 5332.0 + 2.0 * rate;
        assert!((frequency - mean).abs() < 4.0 * std, "{}", found.out);
    }
}

#[test]
fn a_drift_with_time_is_not_taken_for_a_dependence_on_the_energy() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for seed in 1..=4 {
        let both = ["0.2", "-0.2"].map(|rate| {
            format!(
                "--seconds 20 --rate 25000 --noise 0.0005 --decay-rate 0.03 --angle-rate {rate} --frequency-rate 0.0002 --seed {seed}"
            )
        });
        let both = joined(here, both, "--periods 100");
        let found = run_with(here, "resonator - --output csv", both);
        assert!(
            found.err.contains("a drift with time") && !found.out.contains("by_energy"),
            "{}{}",
            found.out,
            found.err
        );
        let (frequency, std) = of_resonator(&found.out, "frequency_hz");
        assert!((frequency - 5332.002).abs() < 2.0 * std, "{}", found.out);
    }
}

#[test]
fn csv_and_json_lines_show_two_digits_of_the_deviation_of_a_frequency() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // Only with a split, however small, does a simulated wave show what rotation does within a period: in so little noise it is seen.
    rows(
        here,
        "--seconds 60 --rate 25000 --noise 1e-7 --sample f32 --decay-rate 0.02 --angle-rate 0.02 --damping-split 1e-9",
        "--periods 50",
    );
    let found = run(here, "resonator rows.csv --output csv");
    let (_, std) = of_resonator(&found.out, "frequency_hz");
    // The twelfth digit of 5332 is 1e-8.
    assert!(std > 1e-9 && std < 5e-9, "{}", found.out);
    let line = found
        .out
        .lines()
        .find_map(|line| line.strip_prefix(",frequency_hz,"));
    let (value, _) = line.unwrap().split_once(',').unwrap();
    let (_, decimals) = value.split_once('.').unwrap();
    assert_eq!(decimals.len(), 10, "{value} {std}");
    let lines = run(here, "resonator rows.csv --output jsonl").out;
    assert!(
        lines.contains(&format!("\"frequency_hz\",\"value\":{value},")),
        "{lines}"
    );
}

#[test]
fn rows_without_a_true_frequency_show_the_splits_all_the_same() {
    let directory = tempfile::tempdir().unwrap();
    let turning = [0.4, -0.4].map(|rate| {
        format!(
            "--seconds 4 --noise 0.002 --decay-rate 0.1 --frequency-split 0.01 --angle-rate {rate}"
        )
    });
    let rows = joined(directory.path(), turning, "--periods 50");
    let rows = String::from_utf8(rows).unwrap();
    let names: Vec<_> = rows.lines().next().unwrap().split(',').collect();
    let place = names.iter().position(|name| *name == "frequency_hz");
    for frequency in ["0", "1e-30"] {
        let mut text = String::new();
        for line in rows.lines() {
            let mut fields: Vec<_> = line.split(',').collect();
            if fields != names {
                fields[place.unwrap()] = frequency;
            }
            text += &(fields.join(",") + "\n");
        }
        let found = run_with(
            directory.path(),
            "resonator - --output csv",
            text.into_bytes(),
        );
        assert_eq!(found.code, 0, "{}", found.err);
        let (split, std) = of_resonator(&found.out, "frequency_split_hz");
        assert!((split - 0.01).abs() < 4.0 * std, "{}", found.out);
    }
}

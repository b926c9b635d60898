//! `antinode resonator`: its warnings if rows differ from the motion by more than their noise, or by less.

use std::fs;
use std::path::Path;

use crate::common::ring_downs::{
    damped, four_seconds, identified, of_resonator, record, resonator, rows,
};
use crate::common::{done, run};

#[test]
fn rows_that_differ_by_less_than_their_noise_are_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let told = "times their noise: if noise is below half a converter step";
    for (noise, bits, is_told) in [
        // 0.01, 0.13 and 0.5 of the steps of 8 bits.
        ("1e-4", "--bits 8", true),
        ("1e-3", "--bits 8", true),
        ("4e-3", "--bits 8", false),
        ("1e-3", "", false),
    ] {
        for seed in 1..=3 {
            let simulated = format!(
                "--seconds 4 --frequency 5321.7 --decay-rate 0.1 --angle-rate 0.4 --noise {noise} {bits} --seed {seed}"
            );
            rows(here, &simulated, "--periods 50");
            let found = done(here, "resonator rows.csv");
            assert_eq!(
                found.err.contains(told),
                is_told,
                "{noise} {bits}: {}",
                found.err
            );
        }
    }
}

#[test]
fn feed_through_of_a_drive_is_named_among_the_causes() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let rows = four_seconds(
        here,
        "--decay-rate 0.5 --angle-rate 0.4 --hum 0.005 --hum-frequency 5332",
    );
    let fed = resonator(here, &rows, "").err;
    for part in ["times their noise", "feed-through"] {
        assert!(fed.contains(part), "{fed}");
    }
}

/// The columns of a residual that `--residual` wrote, without empty cells.
fn left(here: &Path) -> [Vec<f64>; 4] {
    let text = fs::read_to_string(here.join("left.csv")).unwrap();
    let mut lines = text.lines();
    let columns =
        "time_s,run,main_amplitude_off_sigma,quadrature_amplitude_off_sigma,angle_off_sigma,file";
    assert_eq!(lines.next(), Some(columns));
    let cells = lines.map(|line| line.split(',').map(str::to_owned).collect());
    let cells: Vec<Vec<String>> = cells.collect();
    [0, 2, 3, 4].map(|column| {
        cells
            .iter()
            .filter_map(|cells| cells[column].parse().ok())
            .collect()
    })
}

#[test]
fn what_the_motion_leaves_of_each_row_is_written() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let steady = four_seconds(here, "--decay-rate 0.2 --angle-rate 0.4");
    // With a damping that changes, rows are compared with the motion as if it did not.
    let drifting = damped(&steady, |time| 0.005 * time * (time - 4.0));
    for rows in [&steady, &drifting] {
        fs::write(here.join("rows.csv"), rows).unwrap();
        let found = done(here, "resonator rows.csv --output csv --residual left.csv");
        let (residual, _) = of_resonator(&found.out, "residual_over_noise");
        let [times, main, quadrature, angle] = left(here);
        let count = rows.lines().count() - 1;
        assert!(
            [&times, &main, &quadrature, &angle]
                .iter()
                .all(|column| column.len() == count)
        );
        let squares = [main, quadrature, angle]
            .concat()
            .iter()
            .map(|x| x * x)
            .sum::<f64>();
        let rms = (squares / (3 * count) as f64).sqrt();
        assert!((rms / residual - 1.0).abs() < 0.02, "{rms} {residual}");
        assert!((residual - 1.0).abs() < 0.1);
    }
    // The row that differs most is the one that was changed.
    let mut lines: Vec<String> = steady.lines().map(str::to_owned).collect();
    let names = lines[0].split(',');
    let place = names
        .clone()
        .position(|name| name == "main_amplitude")
        .unwrap();
    let mut cells: Vec<String> = lines[200].split(',').map(str::to_owned).collect();
    cells[place] = (cells[place].parse::<f64>().unwrap() + 0.0015).to_string();
    lines[200] = cells.join(",");
    fs::write(here.join("rows.csv"), lines.join("\n") + "\n").unwrap();
    done(here, "resonator rows.csv --residual left.csv");
    let [times, main, ..] = left(here);
    let most = (0..main.len()).max_by(|&one, &other| main[one].abs().total_cmp(&main[other].abs()));
    assert!(main[most.unwrap()] > 8.0, "{}", main[most.unwrap()]);
    assert_eq!(times[most.unwrap()].to_string(), cells[0]);
}

#[test]
fn rows_of_a_residual_have_the_number_of_their_run() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (name, rate) in [("one.wav", "0.4"), ("other.wav", "-0.4")] {
        record(here, name, &format!("--decay-rate 0.2 --angle-rate {rate}"));
    }
    fs::write(here.join("rows.csv"), identified(here, "one.wav other.wav")).unwrap();
    done(here, "resonator rows.csv --residual left.csv");
    let text = fs::read_to_string(here.join("left.csv")).unwrap();
    let mut runs: Vec<_> = text
        .lines()
        .skip(1)
        .map(|line| {
            let cells: Vec<_> = line.split(',').collect();
            (cells[1], cells[5])
        })
        .collect();
    runs.dedup();
    assert_eq!(runs, [("1", "one.wav"), ("2", "other.wav")]);
}

#[test]
fn a_residual_overwrites_neither_the_rows_nor_the_result() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let rows = four_seconds(here, "--decay-rate 0.2 --angle-rate 0.4");
    fs::write(here.join("rows.csv"), &rows).unwrap();
    for (options, told) in [
        (
            "--residual rows.csv",
            "--residual: rows.csv has rows to be read",
        ),
        ("--residual it.csv -o it.csv", "are the same file"),
        ("--residual none/it.csv", "there is no directory"),
        ("--residual it.csv --each", "cannot be used with"),
    ] {
        let found = run(here, &format!("resonator rows.csv {options}"));
        assert!(
            found.code > 0 && found.err.contains(told),
            "{options}: {}",
            found.err
        );
        assert_eq!(found.out, "");
    }
    assert_eq!(fs::read_to_string(here.join("rows.csv")).unwrap(), rows);
}

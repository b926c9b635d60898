//! `antinode identify` on text whose time column shows that samples are missing: rows go on behind them, at the right times.

use std::fs;
use std::path::Path;

use crate::common::{Row, WAVE, beside_flagged, fault, rows, text};

/// The lines of a whole recording of `pairs` pairs, and its rows.
fn whole(directory: &Path, pairs: usize) -> (Vec<String>, Vec<Row>) {
    let text = text(&WAVE.codes(pairs));
    fs::write(directory.join("whole.csv"), &text).unwrap();
    let lines = text.lines().map(str::to_owned).collect();
    (lines, rows(directory, "whole.csv"))
}

/// Asserts that rows are true and without a flag, but for those about a gap, and end at the same time.
fn go_on(found: &[Row], expected: &[Row]) {
    assert!(found.len() + 4 >= expected.len(), "{}", found.len());
    let flagged = found.iter().filter(|row| !row.text("flags").is_empty());
    assert!(flagged.count() <= 2);
    for row in found.iter().filter(|row| row.text("flags").is_empty()) {
        let (time, frequency) = (row.number("time_s"), row.number("frequency_hz"));
        let main = WAVE.main * WAVE.decay(time);
        let angle = WAVE.angle + WAVE.angle_rate * time;
        assert!((row.number("main_amplitude") - main).abs() < 0.005);
        assert!((row.number("angle_rad") - angle).abs() < 0.01);
        assert!((frequency - WAVE.frequency).abs() < 10.0);
    }
    let end = |rows: &[Row]| rows.last().unwrap().number("time_s");
    assert!((end(found) - end(expected)).abs() < 0.004);
}

#[test]
fn a_missing_line_costs_the_rows_about_it() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (mut lines, expected) = whole(here, 20_000);
    lines.remove(9_001);
    fs::write(here.join("a.csv"), lines.join("\n")).unwrap();
    let told = [
        "error: a.csv:9002: 1 sample is lost before this line (time goes from 0.08999 s to 0.09001 s)",
        "ignore the time column with --columns 2,3 --rate HZ",
    ];
    let found = fault(here, "a.csv", Vec::new(), &told);
    go_on(&found, &expected);
    for (found, expected) in found.iter().zip(&expected).take(40) {
        assert_eq!(found.unnamed()[..15], expected.unnamed()[..15]);
    }
    // The same from a pipe, and with a known frequency.
    let input = lines.join("\n").into_bytes();
    let told = ["standard input:9002: 1 sample is lost"];
    assert_eq!(fault(here, "-", input, &told).len(), found.len());
    go_on(
        &fault(here, "a.csv --frequency 5320", Vec::new(), &["1 sample"]),
        &expected,
    );
}

#[test]
fn a_line_whose_time_alone_is_wrong_costs_the_rows_about_it() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (lines, expected) = whole(here, 20_000);
    for time in ["0.08990", "0.090035", "9.9E37"] {
        let mut lines = lines.clone();
        lines[9_001] = format!("{time},0.1,0.1");
        fs::write(here.join("a.csv"), lines.join("\n")).unwrap();
        let told = [
            "a.csv:9002:1: the time `",
            "` does not follow that of the line before, but the lines behind do: the line is left out",
        ];
        go_on(&fault(here, "a.csv", Vec::new(), &told), &expected);
        let told = ["standard input:9002:1: the time `"];
        go_on(
            &fault(here, "- --rate 100000", lines.join("\n").into(), &told),
            &expected,
        );
    }
}

#[test]
fn all_that_is_missing_is_counted() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // The gaps are far beyond the lines that are read ahead.
    let (mut lines, expected) = whole(here, 150_000);
    lines.drain(140_001..140_301);
    lines.drain(9_001..9_004);
    fs::write(here.join("a.csv"), lines.join("\n")).unwrap();
    let told = [
        "a.csv:9002: 3 samples are lost before this line (time goes from 0.08999 s to 0.09003 s), the first of 2 gaps with 303 samples",
    ];
    go_on(&fault(here, "a.csv", Vec::new(), &told), &expected);
}

#[test]
fn the_paper_s_methods_go_on_too() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (mut lines, _) = whole(here, 20_000);
    lines.drain(9_001..9_101);
    fs::write(here.join("a.csv"), lines.join("\n")).unwrap();
    let found = fault(here, "a.csv --methods all", Vec::new(), &["100 samples"]);
    assert!(found.len() > 95);
    // The first window behind the gap has no sample before it.
    let is_without = |row: &&Row| row.text("method4_main_amplitude").is_empty();
    assert!(found.iter().filter(is_without).count() <= 1);
    for row in found.iter().filter(|row| !is_without(row)) {
        let apart = row.number("method4_main_amplitude") - row.number("main_amplitude");
        assert!(apart.abs() < 0.01, "{apart}");
    }
}

#[test]
fn a_missing_line_and_a_bad_sample_are_both_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (mut lines, _) = whole(here, 20_000);
    lines[15_001] = "0.15000,nan,0.1".to_owned();
    lines.remove(9_001);
    fs::write(here.join("a.csv"), lines.join("\n")).unwrap();
    let run = crate::common::run(here, "identify a.csv --output csv");
    let told = beside_flagged(&Row::all(&run.out), &run.err);
    assert_eq!((run.code, told.len()), (1, 2), "{}", run.err);
    assert!(run.err.contains("error: a.csv:9002: 1 sample is lost"));
    assert!(run.err.contains("error: a.csv:15001:2: sample pair 14999"));
    assert!(Row::all(&run.out).len() > 98);
}

#[test]
fn time_that_stays_back_or_between_samples_ends_the_rows() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (lines, _) = whole(here, 20_000);
    for (shift, told) in [(-1e-3, "must increase"), (3.5e-5, "time steps by")] {
        let mut lines = lines.clone();
        for (at, line) in lines.iter_mut().enumerate().skip(9_001) {
            let (_, signals) = line.split_once(',').unwrap();
            *line = format!("{:.6},{signals}", (at - 1) as f64 * 1e-5 + shift);
        }
        fs::write(here.join("a.csv"), lines.join("\n")).unwrap();
        let found = fault(here, "a.csv", Vec::new(), &["a.csv:9002: ", told]);
        assert!((45..49).contains(&found.len()), "{}", found.len());
    }
}

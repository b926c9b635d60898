//! `antinode identify` on text with fields that are no numbers: they cost the rows of their window, and no more.

use std::fs;

use crate::common::{Row, WAVE, fault, rows, text};

/// The lines of a recording.
fn lines() -> Vec<String> {
    let text = text(&WAVE.codes(20_000));
    text.lines().map(str::to_owned).collect()
}

/// Asserts that all `count` rows are there, and only the one about pair 12000 is flagged.
fn one_is_flagged(found: &[Row], count: usize) {
    assert_eq!(found.len(), count);
    let flagged: Vec<&Row> = found
        .iter()
        .filter(|row| !row.text("flags").is_empty())
        .collect();
    assert_eq!(flagged.len(), 1);
    assert!((flagged[0].number("time_s") - 0.12).abs() < 0.001);
    assert!(flagged[0].text("flags").contains("not_finite"));
}

#[test]
fn a_field_without_a_number_costs_a_row() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("good.csv"), lines().join("\n")).unwrap();
    let count = rows(here, "good.csv").len();
    for (word, told) in [
        ("", "the value is missing"),
        ("∞", "the value is `∞`"),
        ("-∞", "the value is `-∞`"),
        ("-inf", "the value is -inf"),
        ("OVER", "the value is `OVER`"),
        ("overrange", "the value is `overrange`"),
        ("---", "the value is `---`"),
        ("#N/A", "the value is `#N/A`"),
        // A field that does not even stand for a missing number.
        ("0.1x7", "the value is `0.1x7`"),
    ] {
        let mut lines = lines();
        lines[12_001] = format!("0.12000,0.1,{word}");
        fs::write(here.join("a.csv"), lines.join("\n")).unwrap();
        let place =
            format!("error: a.csv:12002:3: sample pair 12000 (from 0), S_D (right): {told}");
        one_is_flagged(&fault(here, "a.csv", Vec::new(), &[&place]), count);
        let body: Vec<&str> = lines[1..]
            .iter()
            .map(|line| line.split_once(',').unwrap().1)
            .collect();
        let input = body.join("\n").into_bytes();
        let place =
            format!("standard input:12001:2: sample pair 12000 (from 0), S_D (right): {told}");
        one_is_flagged(&fault(here, "- --rate 1e5", input, &[&place]), count);
    }
}

#[test]
fn recordings_may_begin_with_missing_samples() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for word in ["", "OVER", "x.1", "-∞"] {
        let mut lines = lines();
        lines[1] = format!("0.00000,0.1,{word}");
        fs::write(here.join("a.csv"), lines.join("\n")).unwrap();
        let found = fault(here, "a.csv", Vec::new(), &["a.csv:2:3: sample pair 0 "]);
        assert!(found.len() > 95);
    }
}

#[test]
fn text_that_is_mostly_no_numbers_is_no_recording() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for every in [1, 3] {
        let lines: Vec<String> = lines()
            .iter()
            .enumerate()
            .map(|(index, line)| match line.split_once(',') {
                Some((time, _)) if index > 0 && (every == 1 || index % every != 1) => {
                    format!("{time},low,high")
                }
                _ => line.clone(),
            })
            .collect();
        fs::write(here.join("a.csv"), lines.join("\n")).unwrap();
        let line = if every == 1 { 2 } else { 3 };
        let told = format!("error: a.csv:{line}:2: S_C is `low`, not a number; correct");
        assert!(fault(here, "a.csv", Vec::new(), &[&told]).is_empty());
    }
}

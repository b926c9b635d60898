//! `antinode identify` on text with broken lines: each costs no more than the rows about it, and is reported once all is read.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::Command;
use std::thread;

use crate::common::{Row, WAVE, fault, piped, rows, rows_of, run_with, same_later, text};

/// The lines of a recording, whose rows go to `good.csv`.
fn lines(directory: &Path) -> (Vec<String>, Vec<Row>) {
    let text = text(&WAVE.codes(20_000));
    fs::write(directory.join("good.csv"), &text).unwrap();
    (
        text.lines().map(str::to_owned).collect(),
        rows(directory, "good.csv"),
    )
}

/// Asserts that all rows are there and right, but for at most `lost`, which are missing or flagged.
fn are_kept(found: &[Row], expected: &[Row], lost: usize) {
    let good: Vec<&Row> = found
        .iter()
        .filter(|row| row.text("flags").is_empty())
        .collect();
    assert!(good.len() + lost >= expected.len(), "{}", good.len());
    for row in good {
        let time = row.number("time_s");
        let angle = WAVE.angle + WAVE.angle_rate * time;
        assert!((row.number("angle_rad") - angle).abs() < 0.01, "{time}");
        let main = WAVE.main * WAVE.decay(time);
        assert!(
            (row.number("main_amplitude") - main).abs() < 0.005,
            "{time}"
        );
    }
    let end = |rows: &[Row]| rows.last().unwrap().number("time_s");
    assert!((end(found) - end(expected)).abs() < 0.004);
}

#[test]
fn a_line_in_the_place_of_another_costs_the_rows_about_it() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (lines, expected) = lines(here);
    let left_out = "the line is left out; rows whose window lacks a sample are missing";
    let pair = "sample pair 12000 (from 0), a line of 2 fields where the first has 3, so a sample is missing, the first of 2;";
    let joined = format!("{}{}", lines[12_001], lines[12_002]);
    for (line, place, told) in [
        ("0.12000,0.1", "12002: ", pair),
        (
            "0.12",
            "12002: a line of 1 field where the first has 3",
            left_out,
        ),
        (
            &joined,
            "12002: a line of 5 fields where the first has 3",
            left_out,
        ),
        (
            "battery low",
            "12002: a line of 1 field where the first has 3",
            left_out,
        ),
        (
            "\0\0\0\0\0\0\0",
            "12002: a line of 1 field where the first has 3",
            left_out,
        ),
        (
            "0.1x,0.1,0.2",
            "12002:1: the time is `0.1x`, not a finite number",
            left_out,
        ),
        (
            ",0.1,0.2",
            "12002:1: the time is missing: the line is left out",
            left_out,
        ),
    ] {
        let mut lines = lines.clone();
        lines[12_001] = line.to_owned();
        let text = lines.join("\n");
        fs::write(here.join("a.csv"), &text).unwrap();
        let place = format!("error: a.csv:{place}");
        let found = fault(here, "a.csv", Vec::new(), &[&place, told]);
        are_kept(&found, &expected, 2);
        // The same from a pipe.
        let place = place.replace("a.csv", "standard input");
        let piped = fault(here, "-", text.into_bytes(), &[&place, told]);
        assert_eq!(piped.len(), found.len());
    }
}

#[test]
fn a_line_between_others_costs_no_row() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (mut lines, expected) = lines(here);
    lines.push("0.200".to_owned());
    lines.insert(15_001, "rebooting, for once, with commas".to_owned());
    lines.insert(12_001, "time_s,c,d".to_owned());
    fs::write(here.join("a.csv"), lines.join("\n")).unwrap();
    let told = [
        "error: a.csv:12002:1: the time is `time_s`, not a finite number: the line is left out, the first of 3; ",
    ];
    let found = fault(here, "a.csv", Vec::new(), &told);
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!(found.unnamed(), expected.unnamed());
    }
    // Outside of the span that is asked for it is not reported.
    let part = rows(here, "a.csv --from 0.13 --to 0.14");
    assert_eq!(
        part.len(),
        rows(here, "good.csv --from 0.13 --to 0.14").len()
    );
}

#[test]
fn a_first_line_that_lacks_its_beginning_costs_itself_alone() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (lines, _) = lines(here);
    let untimed = |line: &String| line.split_once(',').unwrap().1.to_owned();
    // From 0.1 s on, with times and without.
    let timed = lines[10_001..].to_vec();
    let untimed: Vec<String> = timed.iter().map(untimed).collect();
    for (lines, begin) in [
        (timed, 2),
        (untimed.clone(), untimed[0].find(',').unwrap() + 1),
    ] {
        let expected = rows_of(here, &lines[1..].join("\n"), "--rate 1e5");
        let text = lines.join("\n");
        for at in begin..lines[0].len() {
            let told = "input: line 1 seems to lack its beginning, as if the logger had been attached in the middle of it, and is left out";
            let text = text.as_bytes()[at..].to_vec();
            let run = run_with(here, "identify - --rate 1e5 --output csv", text);
            assert_eq!(
                (run.code, run.err.lines().count()),
                (0, 1),
                "{at}: {}",
                run.err
            );
            assert!(run.err.contains(told), "{at}: {}", run.err);
            same_later(&Row::all(&run.out), &expected, 0.0);
        }
    }
}

#[test]
fn the_last_line_may_be_cut_off() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (mut lines, expected) = lines(here);
    let last = lines.pop().unwrap();
    for (length, told) in [
        (
            4,
            "a.csv:20001: a line of 1 field where the first has 3: the line is left out; ",
        ),
        (
            9,
            "a.csv:20001: sample pair 19999 (from 0), a line of 2 fields where",
        ),
    ] {
        let text = format!("{}\n{}", lines.join("\n"), &last[..length]);
        fs::write(here.join("a.csv"), text).unwrap();
        let found = fault(here, "a.csv", Vec::new(), &[told]);
        are_kept(&found, &expected, 1);
    }
}

#[test]
fn without_times_a_broken_line_is_one_pair() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (lines, expected) = lines(here);
    let mut lines: Vec<&str> = lines[1..]
        .iter()
        .map(|line| line.split_once(',').unwrap().1)
        .collect();
    for line in ["0.1", "0.1,0.20.1,0.2", "battery low"] {
        lines[12_000] = line;
        fs::write(here.join("a.csv"), lines.join("\n")).unwrap();
        let told = [
            "error: a.csv:12001: sample pair 12000 (from 0), a line of ",
            "the first of 2;",
        ];
        let found = fault(here, "a.csv --rate 1e5", Vec::new(), &told);
        assert_eq!(found.len(), expected.len());
        are_kept(&found, &expected, 1);
    }
}

#[test]
fn a_decimal_comma_between_commas_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (lines, _) = lines(here);
    let body = lines[1..].join("\n").replace(',', ", ").replace('.', ",");
    for header in ["time,c,d", "time,c,d\n0,0,0"] {
        fs::write(here.join("a.csv"), format!("{header}\n{body}")).unwrap();
        let line = 1 + header.lines().count();
        let told = format!(
            "error: a.csv:{line}: found 6 fields where the first line has 3; use another separator than the decimal mark"
        );
        assert!(fault(here, "a.csv", Vec::new(), &[&told]).is_empty());
    }
}

#[test]
fn a_pipe_gives_its_rows_before_a_broken_line_is_followed() {
    // The broken line is beyond those that are read ahead.
    let count = 1 << 16;
    let whole = text(&WAVE.codes(count + 5000));
    let mut command = Command::new(env!("CARGO_BIN_EXE_antinode"));
    let mut run = piped(command.args(["identify", "-", "--output", "csv"]));
    let mut input = run.stdin.take().unwrap();
    let writing = thread::spawn(move || {
        input.write_all(whole.as_bytes()).unwrap();
        input.write_all(b"battery low\n").unwrap();
        input
    });
    // The pipe stays open: rows up to its last samples come all the same.
    let wanted = (count + 4500) as f64 / 1e5;
    let mut output = BufReader::new(run.stdout.take().unwrap())
        .lines()
        .skip(1)
        .map(Result::unwrap);
    let time = |line: &str| line.split(',').next().unwrap().parse::<f64>().unwrap();
    assert!(output.any(|line| time(&line) > wanted));
    drop(writing.join().unwrap());
    output.for_each(drop);
    assert_eq!(run.wait().unwrap().code(), Some(1));
}

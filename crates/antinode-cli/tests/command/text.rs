//! `antinode identify` on text: where it may come from, and how it is recognised.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::Command;

use crate::common::{Row, WAVE, fault, piped, rows, run_with, text};

/// Runs `identify --output csv`, which must succeed.
fn good(directory: &Path, arguments: &str, input: &str) -> Vec<Row> {
    let arguments = format!("identify --output csv {arguments}");
    let run = run_with(directory, &arguments, input.as_bytes().to_vec());
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{arguments}");
    Row::all(&run.out)
}

/// Asserts that the rows are equal but for the name of the file.
fn same(found: &[Row], expected: &[Row]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert_eq!(found.unnamed(), expected.unnamed());
    }
}

#[test]
fn text_may_come_from_anywhere() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let whole = text(&WAVE.codes(5000));
    let body = whole.split_once('\n').unwrap().1;
    fs::write(here.join("a.csv"), &whole).unwrap();
    let expected = rows(here, "a.csv");
    assert!(expected.len() > 20);
    for name in ["log", "log.dat"] {
        fs::write(here.join(name), &whole).unwrap();
        same(&rows(here, name), &expected);
    }
    same(&good(here, "-", &whole), &expected);
    same(&good(here, "-", body), &expected);
    same(&good(here, "- --columns 2,3 --rate 1e5", body), &expected);
    fault(
        here,
        "- --columns 2,3",
        body.into(),
        &["give it as --rate HZ; or,", "--columns TIME,2,3"],
    );
    // With --columns a stream is text, even if its first line does not show it; the line names one of the columns.
    let odd = format!("at {}\n{body}", "level ".repeat(2));
    same(
        &good(here, "- --columns at,2,3", &odd.replace(',', " ")),
        &expected,
    );
    #[cfg(target_os = "linux")]
    same(&good(here, "/dev/stdin", &whole), &expected);
}

#[test]
fn input_that_is_no_pairs_of_numbers_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    for (input, told) in [
        (
            "these are no samples at all",
            "give their format with --raw",
        ),
        ("1\n2\n", "standard input:1: found 1 column"),
        ("1,2\nx,4\nx,4\n", "standard input:2:1: S_C is `x`"),
    ] {
        let run = run_with(directory.path(), "identify - --rate 1e5", input.into());
        assert_eq!((run.code, run.out.as_str()), (1, ""));
        assert!(run.err.contains(told), "{}", run.err);
    }
}

#[test]
fn a_row_is_there_as_soon_as_its_lines() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_antinode"));
    let mut child = piped(command.args(["identify", "-", "--rate", "1e5", "--output", "csv"]));
    let mut input = child.stdin.take().unwrap();
    for pair in WAVE.codes(1000) {
        writeln!(input, "{},{}", pair[0], pair[1]).unwrap();
    }
    // The pipe stays open: the rows come all the same.
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    assert!(lines.next().unwrap().unwrap().starts_with("time_s,"));
    assert!(lines.next().unwrap().unwrap().ends_with("standard input"));
    drop(input);
    assert!(child.wait().unwrap().success());
}

//! `antinode identify --from --to`: a part of a recording.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::Command;

use crate::common::{
    self, RATE, Row, WAVE, fault, npy, printed, raw, rows, run, run_with, same_later, wav,
};

const PAIRS: usize = 20_000;

/// Text with a time column that begins at `start`, s, and one line for each pair of codes.
fn timed(codes: &[[i16; 2]], start: f64) -> String {
    printed("time,c,d\n", codes, |k, [c, d]| {
        format!("{:.5},{c},{d}", start + k as f64 / RATE)
    })
}

/// The rows of a stream that raises no message.
fn piped(here: &Path, bytes: &[u8], arguments: &str) -> Vec<Row> {
    let arguments = format!("identify --output csv - {arguments}");
    let run = run_with(here, &arguments, bytes.to_vec());
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{arguments}");
    Row::all(&run.out)
}

#[test]
fn only_the_rows_of_the_span_are_given() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(PAIRS);
    let part = &codes[7000..12_000];
    for (name, whole, alone, start, arguments) in [
        ("a.wav", wav(&codes), wav(part), 0.0, ""),
        ("a.npy", npy(&codes), npy(part), 0.0, "--rate 1e5"),
        ("a.raw", raw(&codes), raw(part), 0.0, "--raw i16 --rate 1e5"),
        (
            "a.csv",
            timed(&codes, 5.0).into(),
            timed(part, 0.0).into(),
            5.0,
            "",
        ),
        (
            "a.csv",
            timed(&codes, -1.0).into(),
            timed(part, 0.0).into(),
            -1.0,
            "--resolution 1e-9",
        ),
        (
            "a.csv",
            timed(&codes, 5.0).into(),
            timed(part, 0.0).into(),
            0.0,
            "--columns 2,3 --rate 1e5",
        ),
    ] {
        fs::write(here.join(name), whole.clone()).unwrap();
        fs::write(here.join(format!("part_{name}")), alone).unwrap();
        let expected = rows(here, &format!("part_{name} {arguments}"));
        assert!(expected.len() > 20);
        let span = format!("--from {} --to {}", start + 0.07, start + 0.12);
        let found = rows(here, &format!("{name} {arguments} {span}"));
        same_later(&found, &expected, start + 0.07);
        if name != "a.wav" && name != "a.npy" {
            same_later(
                &piped(here, &whole, &format!("{arguments} {span}")),
                &found,
                0.0,
            );
        } else {
            // The converter's step is not known from a pipe.
            assert_eq!(
                piped(here, &whole, &format!("{arguments} {span}")).len(),
                found.len()
            );
        }
        let last = rows(here, &format!("{name} {arguments} --from {}", start + 0.19));
        assert!((4..6).contains(&last.len()), "{}", last.len());
        assert!(last[0].number("time_s") > start + 0.19);
        let first = rows(here, &format!("{name} {arguments} --to {}", start + 0.01));
        assert!((4..6).contains(&first.len()), "{}", first.len());
        assert!(first[0].number("time_s") < start + 0.002);
    }
    let both = rows(here, "a.wav part_a.wav --from 0.01 --to 0.02");
    for name in ["a.wav", "part_a.wav"] {
        let of_one = both.iter().filter(|row| row.text("file") == name);
        assert!((4..6).contains(&of_one.count()));
    }
}

#[test]
fn lost_samples_count_in_the_times() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = timed(&WAVE.codes(PAIRS), 0.0);
    let mut lines: Vec<&str> = text.lines().collect();
    fs::write(here.join("whole.csv"), lines.join("\n")).unwrap();
    lines.drain(5001..6001);
    fs::write(here.join("gap.csv"), lines.join("\n")).unwrap();
    // The gap is before the span, and not reported.
    for span in ["--from 0.1 --to 0.15", "--from 0.055 --to 0.1", "--to 0.05"] {
        let expected = rows(
            here,
            &format!("whole.csv {}", span.replace("0.055", "0.06")),
        );
        same_later(&rows(here, &format!("gap.csv {span}")), &expected, 0.0);
    }
    let told = ["gap.csv:5002: 1000 samples are lost before this line"];
    assert!(fault(here, "gap.csv --from 0.03 --to 0.1", Vec::new(), &told).len() > 20);
    let told = ["gap.csv: --from 0.052 --to 0.058: all samples in this span are lost"];
    fault(here, "gap.csv --from 0.052 --to 0.058", Vec::new(), &told);
}

#[test]
fn faults_outside_the_span_are_not_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = timed(&WAVE.codes(PAIRS), 0.0);
    let mut lines: Vec<&str> = text.lines().collect();
    for (line, bad) in [
        (2001, "0.02000,nan,0"),
        (10_001, "0.10000,0,x"),
        (15_001, "0.15000,0,OVER"),
    ] {
        lines[line] = bad;
    }
    fs::write(here.join("a.csv"), lines.join("\n")).unwrap();
    assert!(rows(here, "a.csv --from 0.021 --to 0.1").len() > 35);
    assert!(rows(here, "a.csv --from 0.16").len() > 15);
    let told = ["sample pair 10000 (from 0), S_D (right): the value is NaN, not"];
    fault(here, "a.csv --from 0.021 --to 0.12", Vec::new(), &told);
    let told = [
        "a.csv:2002:2: sample pair 2000 (from 0)",
        "the first of 2; ",
    ];
    fault(here, "a.csv --to 0.12", Vec::new(), &told);
}

#[test]
fn a_span_outside_the_recording_is_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(PAIRS);
    fs::write(here.join("a.wav"), wav(&codes)).unwrap();
    fs::write(here.join("a.csv"), timed(&codes, 5.0)).unwrap();
    for (arguments, told) in [
        (
            "a.wav --from 0.2",
            "a.wav: --from 0.2 s: the recording goes from 0 s to 0.200000 s; give a time within it",
        ),
        (
            "a.csv --from 6",
            "a.csv: --from 6 s: the recording goes from 5 s to 5.200000 s; give a time within it",
        ),
        (
            "a.csv --to 5",
            "a.csv: --to 5 s: the recording begins only at 5 s; give a later time",
        ),
        (
            "a.csv --from 1 --to 2",
            "a.csv: --to 2 s: the recording begins only at 5 s",
        ),
        (
            "a.wav --from 0.1 --to 0.101",
            "a.wav: a period was found, but 100 sample pairs (0.0010 s) hold no window",
        ),
    ] {
        assert!(fault(here, arguments, Vec::new(), &[told]).is_empty());
    }
    for (arguments, told) in [
        (
            "a.wav --from 0.2 --to 0.1",
            "error: --to: 0.1 s must be later than --from, 0.2 s",
        ),
        (
            "a.wav --from 0.1 --to 0.1",
            "error: --to: 0.1 s must be later than --from, 0.1 s",
        ),
        ("a.wav --from x", "it must be a number of seconds"),
        ("a.wav --to inf", "it must be a number of seconds"),
    ] {
        let run = run(here, &format!("identify {arguments}"));
        assert_eq!((run.code, run.out.as_str()), (2, ""));
        assert!(run.err.contains(told), "{}", run.err);
    }
    // The part of the span that the recording has is identified.
    let run = crate::common::run(here, "identify --output csv a.csv --from 4.5 --to 5.3");
    assert_eq!((run.code, Row::all(&run.out)), (0, rows(here, "a.csv")));
    assert_eq!(
        run.err,
        "warning: a.csv: the recording begins at 5 s, after --from 4.5 s, and ends at 5.200000 s, before --to 5.3 s\n"
    );
    // Nothing is missing before the first sample.
    rows(here, "a.csv --from 4.999998");
    // A recording that is cut short ends there for that reason.
    let whole = wav(&codes);
    fs::write(here.join("a.wav"), &whole[..whole.len() - 4000]).unwrap();
    let cut = crate::common::run(here, "identify a.wav --to 0.3");
    assert_eq!((cut.code, cut.err.lines().count()), (1, 1), "{}", cut.err);
}

#[test]
fn the_command_does_not_wait_for_a_pipe_beyond_the_span() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_antinode"));
    let mut child = common::piped(command.args([
        "identify", "-", "--raw", "i16", "--rate", "1e5", "--to", "0.05",
    ]));
    let mut input = child.stdin.take().unwrap();
    input.write_all(&raw(&WAVE.codes(6000))).unwrap();
    assert!(child.wait().unwrap().success());
    drop(input);
}

#[test]
fn a_span_begins_with_the_line_that_is_named_by_its_time_since_1970() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(PAIRS);
    let start = 1_764_337_501.0;
    fs::write(here.join("whole.csv"), timed(&codes, start)).unwrap();
    // Doubles are 0.024 samples apart there.
    for first in [1001, 4004, 5003, 7777] {
        fs::write(here.join("part.csv"), timed(&codes[first..], 0.0)).unwrap();
        let part = rows(here, "part.csv");
        let from = format!("{:.5}", start + first as f64 / RATE);
        let run = run(
            here,
            &format!("identify --output csv whole.csv --from {from}"),
        );
        assert_eq!(run.code, 0, "{}", run.err);
        let found = Row::all(&run.out);
        assert_eq!(found.len(), part.len(), "{from}");
        for (found, part) in found.iter().zip(&part) {
            assert_eq!(found.unnamed()[1..], part.unnamed()[1..], "{from}");
        }
    }
}

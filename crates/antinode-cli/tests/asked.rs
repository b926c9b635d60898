//! `antinode identify` where what was asked cannot be.

mod common;

use std::fs;
use std::path::Path;

use common::{RATE, WAVE, npy, raw, rows, run, run_with, wav};

/// Runs `identify`, which must exit 1 without a row, with one message that holds all of these.
fn fault(directory: &Path, arguments: &str, input: Vec<u8>, told: &[&str]) {
    let run = run_with(directory, &format!("identify {arguments}"), input);
    assert_eq!(
        (run.code, run.out.as_str()),
        (1, ""),
        "{arguments}: {}",
        run.err
    );
    assert_eq!(run.err.lines().count(), 1, "{}", run.err);
    for part in told {
        assert!(
            run.err.contains(part),
            "{arguments}: `{part}` is not in {}",
            run.err
        );
    }
}

#[test]
fn a_rate_that_cannot_be_is_told() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(2000);
    fs::write(here.join("a.wav"), wav(&codes)).unwrap();
    fs::write(here.join("a.npy"), npy(&codes)).unwrap();
    let mut wrong = wav(&codes);
    wrong[24..28].fill(0);
    fs::write(here.join("zero.wav"), wrong).unwrap();
    for rate in ["-5", "0", "nan", "inf", "1e20"] {
        fault(
            here,
            &format!("a.wav --rate {rate}"),
            Vec::new(),
            &["a.wav: ", "absurd", "give --rate in Hz"],
        );
    }
    fault(
        here,
        "a.npy",
        Vec::new(),
        &["a.npy: ", "rate is not known", "give --rate HZ"],
    );
    fault(here, "zero.wav", Vec::new(), &["zero.wav: ", "--rate"]);
    fault(
        here,
        "- --raw i16",
        raw(&codes),
        &["standard input: ", "give --rate HZ"],
    );
    // The file is good all the same.
    assert!(!rows(here, &format!("zero.wav --rate {RATE}")).is_empty());
}

#[test]
fn options_that_make_no_sense_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.wav"), wav(&WAVE.codes(2000))).unwrap();
    let cases = [
        ("--periods 1", "--periods <N>': 1 is not in 2..=1022"),
        ("--periods 1023", "1023 is not in 2..=1022"),
        ("--hop 0", "--hop <BLOCKS>': 0 is not in 1.."),
        ("--rate fast", "'fast' for '--rate <HZ>'"),
        ("--gain-ratio 0", "--gain-ratio: "),
        ("--gain-ratio -1", "--gain-ratio: "),
        ("--skew-ns 1e9", "--skew-ns: "),
        ("--pick-off-angle 1", "--pick-off-angle: "),
        ("--full-scale -1", "--full-scale: "),
        ("--resolution 0", "--resolution: "),
        ("--start-angle nan", "--start-angle: "),
        ("--output xml", "table, csv, jsonl"),
        ("--columns a", "two (S_C, S_D) or three"),
        ("--raw i8", "i16, i32, f32"),
        ("--nonsense", "--nonsense"),
    ];
    for (arguments, told) in cases {
        let run = run(here, &format!("identify a.wav {arguments}"));
        assert_eq!(
            (run.code, run.out.as_str()),
            (2, ""),
            "{arguments}: {}",
            run.err
        );
        assert!(run.err.contains(told), "{arguments}: {}", run.err);
    }
    assert_eq!(run(here, "identify").code, 2);
    assert_eq!(run(here, "nonsense").code, 2);
}

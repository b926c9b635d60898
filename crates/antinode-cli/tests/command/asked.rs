//! `antinode identify` with options that cannot be fulfilled.

use std::fs;

use crate::common::{RATE, WAVE, done, no_rows as fault, npy, raw, rows, run, wav};

#[test]
fn an_impossible_rate_is_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(2000);
    fs::write(here.join("a.wav"), wav(&codes)).unwrap();
    fs::write(here.join("a.npy"), npy(&codes)).unwrap();
    let mut wrong = wav(&codes);
    wrong[24..28].fill(0);
    fs::write(here.join("zero.wav"), wrong).unwrap();
    fs::write(here.join("slow.csv"), "t,c,d\n0,1,2\n5,3,4\n").unwrap();
    fault(
        here,
        "slow.csv",
        Vec::new(),
        &["slow.csv: ", "absurd sample rate of 0.2 Hz", "--rate HZ"],
    );
    fault(
        here,
        "a.npy",
        Vec::new(),
        &[
            "a.npy: ",
            "does not state its sample rate",
            "give it as --rate HZ",
        ],
    );
    fault(here, "zero.wav", Vec::new(), &["zero.wav: ", "--rate"]);
    fault(
        here,
        "- --raw i16",
        raw(&codes),
        &["standard input: ", "give it as --rate HZ"],
    );
    // The file itself is good.
    assert!(!rows(here, &format!("zero.wav --rate {RATE}")).is_empty());
}

#[test]
fn rows_are_the_same_at_any_rate() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.npy"), npy(&WAVE.codes(20_000))).unwrap();
    let expected = rows(here, "a.npy --rate 1e5");
    for rate in ["1e-3", "12.8e9", "1e12"] {
        let found = rows(here, &format!("a.npy --rate {rate}"));
        assert_eq!(found.len(), expected.len());
        let rate: f64 = rate.parse().unwrap();
        for (found, expected) in found.iter().zip(&expected) {
            let samples = found.number("time_s") * rate - expected.number("time_s") * RATE;
            assert!(samples.abs() < 1e-4, "{rate}: {samples}");
            let apart = found.number("frequency_hz") / expected.number("frequency_hz") * RATE;
            assert!((apart / rate - 1.0).abs() < 1e-7, "{rate}: {apart}");
            for name in ["main_amplitude", "angle_rad", "phase_rad", "angle_std_rad"] {
                let apart = found.number(name) - expected.number(name);
                assert!(apart.abs() < 1e-4, "{rate} {name}: {apart}");
            }
        }
    }
    let range = "it must be 0.0000009765625 to 0.0004 Hz";
    let refused = run(here, "identify a.npy --rate 1e-3 --frequency 1");
    assert!(refused.err.contains(range), "{}", refused.err);
}

#[test]
fn counts_may_have_an_exponent() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.wav"), wav(&WAVE.codes(20_000))).unwrap();
    let plain = rows(here, "a.wav --periods 500 --hop 20");
    assert!(!plain.is_empty());
    assert_eq!(rows(here, "a.wav --periods 5e2 --hop 2e1"), plain);
}

#[test]
fn options_that_make_no_sense_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.wav"), wav(&WAVE.codes(2000))).unwrap();
    let cases = [
        (
            "--periods 1",
            "--periods <N>': it must be a whole number from 2 to 1022",
        ),
        ("--periods 1023", "it must be a whole number from 2 to 1022"),
        ("--periods 2.5", "it must be a whole number from 2 to 1022"),
        ("--periods nan", "it must be a whole number from 2 to 1022"),
        ("--periods 4 --hum", "--hum: 4 periods a window"),
        (
            "--hop 0",
            "--hop <BLOCKS>': it must be a whole number from 1 to 65535",
        ),
        ("--rate fast", "'fast' for '--rate <HZ>'"),
        (
            "--rate 0",
            "'--rate <HZ>': it must be 0.001 to 1000000000000 Hz",
        ),
        ("--rate -5", "'--rate <HZ>': it must be 0.001 to"),
        ("--rate nan", "'--rate <HZ>': it must be 0.001 to"),
        ("--rate 1e20", "'--rate <HZ>': it must be 0.001 to"),
        (
            "--gain-ratio 0",
            "'--gain-ratio <RATIO>': it must be 0.1 to 10",
        ),
        ("--gain-ratio -1", "it must be 0.1 to 10"),
        (
            "--skew-ns 1e9",
            "'--skew-ns <NS>': it must be -1000000 to 1000000 ns",
        ),
        ("--pick-off-angle 1", "it must be -0.3 to 0.3 rad"),
        (
            "--full-scale -1",
            "'--full-scale <LEVEL|LOW,HIGH>': it must be a number above 0, or two numbers as LOW,HIGH",
        ),
        ("--full-scale 0", "it must be a number above 0"),
        ("--full-scale nan", "it must be a number above 0"),
        ("--full-scale 3,3", "LOW must lie below HIGH"),
        ("--full-scale 1,-1", "LOW must lie below HIGH"),
        ("--full-scale nan,1", "LOW and HIGH must be finite"),
        ("--full-scale 0,inf", "LOW and HIGH must be finite"),
        ("--full-scale 0,", "LOW and HIGH must be numbers"),
        ("--full-scale 0,1,2", "LOW and HIGH must be numbers"),
        (
            "--resolution 0",
            "'--resolution <STEP>': it must be a number above 0",
        ),
        ("--start-angle nan", "it must be -10000 to 10000 rad"),
        ("--format xml", "table, csv, jsonl"),
        ("--output xml", "table, csv, jsonl"),
        (
            "--output rows.csv",
            "error: --output is the format, but rows.csv is a file: give -o rows.csv",
        ),
        (
            "--channels 4",
            "--channels is only for raw samples, with --raw FORMAT; ",
        ),
        ("--columns a", "two (S_C, S_D) or three"),
        ("--raw u32", "u8, i8, u16, i16, i24, i32, f16, f32, f64"),
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
    // The ends of a range belong to it.
    let ends =
        "--skew-ns 1000000 --gain-ratio 10 --pick-off-angle -0.3 --rate 1e5 --full-scale -1,1";
    let ends = run(here, &format!("identify a.wav --format csv {ends}"));
    assert_eq!((ends.code, ends.err.as_str()), (0, ""));
    assert!(ends.out.starts_with("time_s,"));
    let help = run(here, "identify --help").out;
    for range in [
        "0.1 to 10",
        "within ±1000000",
        "within ±0.3",
        "0.001 to 1e12",
    ] {
        assert!(help.contains(range), "{range}");
    }
    assert!(help.contains("[possible values: table, csv, jsonl]") || help.contains("- jsonl:"));
    assert!(help.contains("16 times as long"));
    assert!(run(here, "--help").out.contains("The exit code is 0 if"));
    assert_eq!(run(here, "identify").code, 2);
    assert_eq!(run(here, "nonsense").code, 2);
}

#[test]
fn shells_complete_every_command() {
    let directory = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let made = done(directory.path(), &format!("completions {shell}"));
        for word in ["identify", "resonator", "pick-off-angle"] {
            assert!(made.out.contains(word), "{shell}: no {word}");
        }
    }
    assert_eq!(run(directory.path(), "completions cmd").code, 2);
}

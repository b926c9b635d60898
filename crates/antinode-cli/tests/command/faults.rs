//! `antinode identify` on bad input: the rows before the fault, then what is wrong, where, and what to do.

use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use crate::common::{RATE, Row, WAVE, fault, npy, raw, rows, run, wav};

#[test]
fn input_that_is_no_recording_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let write = |name, bytes: &[u8]| fs::write(here.join(name), bytes).unwrap();
    let codes = WAVE.codes(2000);
    let mut mono = wav(&codes);
    mono[22] = 1;
    mono[32] = 2;
    write("mono.wav", &mono);
    write("empty.wav", b"");
    write("header.wav", &wav(&[]));
    write("text.wav", b"these are no samples at all");
    write("other.bin", b"these are no samples at all");
    write("words.csv", b"time,C,D\n0,half,0.2\n0.00001,half,0.2\n");
    write("one.csv", b"C\n0.1\n0.2\n");
    write("short.csv", b"C,D\n0.1,0.2\n0.3\n0.4\n");
    let cases: [(&str, &[&str]); 10] = [
        (
            "none.wav",
            &["none.wav: ", "no such file", "check the path"],
        ),
        (".", &[".: ", "directory", "name the file"]),
        ("empty.wav", &["empty.wav: ", "nothing in it", "check"]),
        ("header.wav", &["header.wav: ", "no sample pairs", "check"]),
        (
            "mono.wav",
            &[
                "mono.wav: WAV header: ",
                "1 channel,",
                "put S_C on the left",
            ],
        ),
        (
            "text.wav",
            &["text.wav: ", "not a WAV file", "export it again"],
        ),
        (
            "other.bin",
            &[
                "other.bin: ",
                "--raw u8, i8, u16, i16, i24, i32, f16, f32 or f64",
            ],
        ),
        (
            "words.csv",
            &["words.csv:2:2: ", "`half`", "correct or delete the line"],
        ),
        (
            "one.csv",
            &["one.csv:1: ", "found 1 column", "`paste -d, c.csv d.csv`"],
        ),
        (
            "short.csv --rate 1e5",
            &["short.csv:3", "missing", "complete or delete the line"],
        ),
    ];
    for (arguments, told) in cases {
        let rows = fault(here, arguments, Vec::new(), told);
        assert!(rows.is_empty(), "{arguments}");
    }
    fault(
        here,
        "- --raw i16 --rate 1e5",
        Vec::new(),
        &["standard input: ", "nothing in it"],
    );
    fault(
        here,
        "- --rate 1e5",
        raw(&codes),
        &["standard input: ", "give their format with --raw"],
    );
}

#[cfg(windows)]
#[test]
fn a_device_of_windows_is_read_without_being_asked_what_it_is() {
    let directory = tempfile::tempdir().unwrap();
    let told = ["NUL: ", "nothing in it"];
    assert!(fault(directory.path(), "NUL", Vec::new(), &told).is_empty());
}

#[test]
fn a_truncated_recording_gives_its_good_rows() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(20_000);
    let good = 15_000;
    fs::write(here.join("good.wav"), wav(&codes[..good])).unwrap();
    let expected = rows(here, "good.wav");
    assert!(expected.len() > 70);
    let same = |found: Vec<Row>| {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(&expected) {
            assert_eq!(found.unnamed(), expected.unnamed());
        }
    };
    fs::write(here.join("cut.wav"), &wav(&codes)[..44 + 4 * good]).unwrap();
    let promise = [
        "cut.wav: at its end: ",
        "20000 sample pairs",
        "there are 15000",
        "copy or record it again",
    ];
    same(fault(here, "cut.wav", Vec::new(), &promise));
    // Cut in the middle of a pair.
    fs::write(here.join("half.wav"), &wav(&codes)[..46 + 4 * good]).unwrap();
    same(fault(
        here,
        "half.wav",
        Vec::new(),
        &["half.wav: ", "there are 15000"],
    ));
    fs::write(here.join("cut.npy"), &npy(&codes)[..128 + 4 * good]).unwrap();
    same(fault(
        here,
        "cut.npy --rate 1e5",
        Vec::new(),
        &["cut.npy: ", "there are 15000"],
    ));
    let mut half = raw(&codes[..good]);
    half.push(0);
    same(fault(
        here,
        "- --raw i16 --rate 1e5",
        half,
        &["standard input: sample pair 15000", "middle of it"],
    ));
}

#[test]
fn a_bad_file_does_not_keep_the_good_ones_from_being_read() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(5000);
    fs::write(here.join("a.wav"), wav(&codes)).unwrap();
    fs::write(here.join("b.wav"), "bad").unwrap();
    fs::write(here.join("c.npy"), npy(&codes)).unwrap();
    let run = run(
        here,
        "identify --output csv --rate 1e5 a.wav b.wav none.wav c.npy",
    );
    assert_eq!(run.code, 1);
    let told: Vec<&str> = run.err.lines().collect();
    assert_eq!(told.len(), 2, "{}", run.err);
    assert!(
        told[0].starts_with("error: b.wav: ") && told[1].starts_with("error: none.wav: "),
        "{}",
        run.err
    );
    let found = Row::all(&run.out);
    let alone = rows(here, "a.wav");
    for name in ["a.wav", "c.npy"] {
        let rows: Vec<&Row> = found
            .iter()
            .filter(|row| row.text("file") == name)
            .collect();
        assert_eq!(rows.len(), alone.len(), "{name}");
        assert!(
            rows.iter()
                .zip(&alone)
                .all(|(row, alone)| row.unnamed() == alone.unnamed())
        );
    }
    assert_eq!(found.len(), 2 * alone.len());
}

#[test]
fn the_command_ends_quietly_if_the_reader_of_its_output_goes() {
    let directory = tempfile::tempdir().unwrap();
    // More rows than a pipe holds.
    fs::write(directory.path().join("a.wav"), wav(&WAVE.codes(300_000))).unwrap();
    for arguments in [
        &["identify", "a.wav", "--output", "csv"][..],
        &["identify", "a.wav", "--output", "jsonl"],
        &["identify", "a.wav", "--output", "table"],
    ] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_antinode"))
            .args(arguments)
            .current_dir(directory.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut first = String::new();
        // The reader is dropped at the end of the statement, and the pipe has none any more.
        BufReader::new(child.stdout.take().unwrap())
            .read_line(&mut first)
            .unwrap();
        assert!(first.ends_with('\n'));
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{arguments:?}");
    }
}

#[test]
fn a_time_without_a_name_is_no_signal() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(5000);
    let lines = |first: &dyn Fn(usize) -> f64| -> String {
        let line = |(k, pair): (usize, &[i16; 2])| format!("{},{}\n", first(k), pair[1]);
        codes.iter().enumerate().map(line).collect()
    };
    fs::write(here.join("one.csv"), lines(&|k| k as f64 / RATE)).unwrap();
    let told = ["one.csv:1: found the time and one signal", "--columns C,D"];
    assert!(fault(here, "one.csv --rate 100000", Vec::new(), &told).is_empty());
    // The slowest possible wave, without noise, goes up for as long, but not as evenly.
    let slow = |k: usize| (k as f64 / RATE * 614.0).sin();
    fs::write(here.join("two.csv"), lines(&slow)).unwrap();
    let run = run(here, "identify two.csv --rate 100000");
    assert!(!run.err.contains("found the time"), "{}", run.err);
}

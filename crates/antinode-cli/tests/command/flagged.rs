//! `antinode identify` tells once a recording how many of its rows are flagged, and by what.

use std::fs;

use crate::common::{Row, WAVE, beside_flagged, run, wav};

/// A wave with a hole in it.
fn torn() -> Vec<u8> {
    let mut codes = WAVE.codes(60_000);
    codes[20_000..30_000].fill([0, 0]);
    wav(&codes)
}

#[test]
fn flagged_rows_are_told_in_every_format() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("torn.wav"), torn()).unwrap();
    fs::write(here.join("good.wav"), wav(&WAVE.codes(20_000))).unwrap();
    let csv = run(here, "identify --output csv torn.wav good.wav");
    assert_eq!(csv.code, 0);
    assert_eq!(beside_flagged(&Row::all(&csv.out), &csv.err), [""; 0]);
    assert!(csv.err.starts_with("warning: torn.wav: "), "{}", csv.err);
    for arguments in ["--output table", "--output jsonl", "--methods all"] {
        let told = run(here, &format!("identify torn.wav good.wav {arguments}"));
        assert_eq!((told.code, told.err.as_str()), (0, csv.err.as_str()));
    }
    // A fault behind them is told last, and its code stays.
    fs::write(here.join("torn.wav"), &torn()[..200_003]).unwrap();
    let cut = run(here, "identify --output csv torn.wav none.wav");
    assert_eq!(cut.code, 1);
    let others = beside_flagged(&Row::all(&cut.out), &cut.err);
    assert_eq!(others.len(), 2, "{}", cut.err);
    assert!(cut.err.starts_with("warning: torn.wav: "), "{}", cut.err);
    assert!(others[0].starts_with("error: torn.wav: at its end: "));
    assert!(others[1].starts_with("error: none.wav: "));
}

#[cfg(unix)]
#[test]
fn an_interruption_tells_them_too() {
    use std::io::{BufRead, BufReader, Write};
    use std::process::{Command, Stdio};

    for (signal, goes_on) in [("-INT", false), ("-TERM", true)] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_antinode"))
            .args(["identify", "-", "--output", "csv"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut input = child.stdin.take().unwrap();
        input.write_all(&torn()[..150_000]).unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let mut text = String::new();
        // The wave comes again at 0.3 s.
        while !text.contains("\n0.3") {
            text += &(lines.next().unwrap().unwrap() + "\n");
        }
        let id = child.id().to_string();
        let sent = Command::new("kill").args([signal, &id]).status();
        assert!(sent.unwrap().success());
        if goes_on {
            // What comes meanwhile is not identified.
            let _ = input.write_all(&torn()[150_000..]);
        }
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{signal}");
        for line in lines {
            text += &(line.unwrap() + "\n");
        }
        let told = String::from_utf8(output.stderr).unwrap();
        let others = beside_flagged(&Row::all(&text), &told);
        assert_eq!(
            others,
            ["error: interrupted: the rows up to there are good"]
        );
        drop(input);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_command_begun_by_nohup_outlives_its_terminal() {
    use std::io::{BufRead, BufReader, Read, Write};
    use std::process::{Command, Stdio};

    let command = format!(
        "exec nohup {} identify - --output csv",
        env!("CARGO_BIN_EXE_antinode")
    );
    let mut child = Command::new("sh")
        .args(["-c", &command])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let (mut input, torn) = (child.stdin.take().unwrap(), torn());
    input.write_all(&torn[..150_000]).unwrap();
    let mut rows = BufReader::new(child.stdout.take().unwrap());
    let mut text = String::new();
    while !text.contains("\n0.3") {
        assert_ne!(rows.read_line(&mut text).unwrap(), 0);
    }
    let id = child.id().to_string();
    let sent = Command::new("kill").args(["-HUP", &id]).status();
    assert!(sent.unwrap().success());
    input.write_all(&torn[150_000..]).unwrap();
    drop(input);
    rows.read_to_string(&mut text).unwrap();
    let whole = Row::all(&text);
    assert!(whole.last().unwrap().number("time_s") > 0.59, "{text}");
    assert_ne!(child.wait().unwrap().code(), Some(130));
}

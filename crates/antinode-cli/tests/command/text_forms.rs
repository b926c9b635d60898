//! `antinode identify` on numbers as other programs write them: read if unambiguous, else refused with a command that makes plain ones.

use std::fs;

use crate::common::{Row, WAVE, no_rows, rows_of, run_with, same_later, text};

/// The pairs of a recording as plain text.
fn pairs() -> Vec<[String; 2]> {
    let text = text(&WAVE.codes(5000));
    let pair = |line: &str| {
        let mut fields = line.split(',').skip(1).map(str::to_owned);
        std::array::from_fn(|_| fields.next().unwrap())
    };
    text.lines().skip(1).map(pair).collect()
}

/// The lines that `write` makes of them.
fn lines(write: impl Fn(usize, &[String; 2]) -> String) -> String {
    let pairs = pairs();
    let lines = pairs
        .iter()
        .enumerate()
        .map(|(k, pair)| write(k, pair) + "\n");
    lines.collect()
}

/// The rows of the pairs in plain text, one a line, without a time.
fn expected() -> Vec<Row> {
    let directory = tempfile::tempdir().unwrap();
    let plain = lines(|_, [c, d]| format!("{c},{d}"));
    rows_of(directory.path(), &plain, "--rate 1e5")
}

#[test]
fn signs_and_exponents_of_others_are_read() {
    let directory = tempfile::tempdir().unwrap();
    let expected = expected();
    let fortran = |x: &String| {
        let x: f64 = x.parse().unwrap();
        format!("{x:.12e}").replace("e-", "D-").replace('e', "D+")
    };
    for text in [
        lines(|_, [c, d]| format!("{c},{d}").replace('-', "−")),
        lines(|_, [c, d]| format!("{c} {d}").replace('-', "−")),
        lines(|_, [c, d]| format!(" {} {}", fortran(c), fortran(d))),
        "c,d\n".to_owned() + &lines(|_, [c, d]| format!("{},{}", fortran(c), fortran(d))),
    ] {
        let found = rows_of(directory.path(), &text, "--rate 1e5");
        same_later(&found, &expected, 0.0);
    }
    let time = |k: usize| format!("{:.5}D-01", k as f64 * 1e-4);
    let timed = lines(|k, [c, d]| format!("{},{c},{d}", time(k)));
    same_later(&rows_of(directory.path(), &timed, ""), &expected, 0.0);
}

#[test]
fn decimal_commas_in_quotes_are_read() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = expected();
    let quoted = |x: &str| format!("\"{}\"", x.replace('.', ","));
    let untimed = lines(|_, [c, d]| format!("{},{}", quoted(c), quoted(d)));
    let above = format!("Model,X\n{}c,d\n{untimed}", "Gain,7\n".repeat(40));
    for text in [&untimed, &format!("\"c\",\"d\"\n{untimed}"), &above] {
        same_later(&rows_of(here, text, "--rate 1e5"), &expected, 0.0);
    }
    // A line that lacks a quote costs no other.
    let mut broken: Vec<&str> = untimed.lines().collect();
    broken[4000] = "\"0,4,\"0,3\"";
    let run = run_with(
        here,
        "identify --rate 1e5 --output csv -",
        broken.join("\n").into(),
    );
    assert!(run.err.contains("standard input:4001"), "{}", run.err);
    assert_eq!(Row::all(&run.out).len(), expected.len());
    let timed = lines(|k, [c, d]| {
        format!(
            "{},{},{}",
            quoted(&format!("{:.5}", k as f64 / 1e5)),
            quoted(c),
            quoted(d)
        )
    });
    same_later(
        &rows_of(here, &format!("time,c,d\n{timed}"), ""),
        &expected,
        0.0,
    );
}

#[test]
fn the_head_of_a_putty_log_is_no_title() {
    let directory = tempfile::tempdir().unwrap();
    let code = |x: &String| (2048.0 + 2000.0 * x.parse::<f64>().unwrap()).round();
    let codes = lines(|_, [c, d]| format!("{},{}", code(c), code(d)));
    let expected = rows_of(directory.path(), &codes, "--rate 1e5");
    let head = "=~=~=~=~=~=~= PuTTY log 2026.11.26 10:00:00 =~=~=~=~=~=~=\r\n";
    let found = rows_of(directory.path(), &(head.repeat(2) + &codes), "--rate 1e5");
    same_later(&found, &expected, 0.0);
}

/// Runs the command that the message names, without its pipe to `antinode`, on the file.
#[cfg(unix)]
fn converted(here: &std::path::Path, told: &str) -> String {
    let command = told.rsplit('`').nth(1).unwrap();
    let (command, end) = command.rsplit_once(" | ").unwrap();
    assert_eq!(end, "antinode identify -");
    let output = std::process::Command::new("sh")
        .args(["-c", command])
        .current_dir(here)
        .output()
        .unwrap();
    assert!(output.status.success(), "{command}");
    String::from_utf8(output.stdout).unwrap()
}

#[cfg(unix)]
#[test]
fn the_command_in_the_message_makes_plain_numbers() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = expected();
    let milli = |x: &String| (1e3 * x.parse::<f64>().unwrap()).to_string();
    let small = |x: &String| {
        if x.contains("0.0") {
            format!("{} mV", milli(x))
        } else {
            format!("{x} V")
        }
    };
    let time = |k: usize| k as f64 / 1e5;
    for (place, told, text) in [
        ("1:1", "units", lines(|_, [c, d]| format!("{c}V,{d}V"))),
        (
            "2:1",
            "units",
            "c,d\n".to_owned() + &lines(|_, [c, d]| format!("{c}V,{d}V")),
        ),
        (
            "1:1",
            "units",
            lines(|_, [c, d]| format!("{},{}", small(c), small(d))),
        ),
        (
            "2:1",
            "units",
            "Time,c,d\n".to_owned() + &lines(|k, [c, d]| format!("{} sec,{c},{d}", time(k))),
        ),
        (
            "2:1",
            "units",
            "Time,c,d\n".to_owned() + &lines(|k, [c, d]| format!("{} ms,{c},{d}", 1e3 * time(k))),
        ),
        ("1:1", "brackets", lines(|_, [c, d]| format!("> {c},{d}"))),
        ("1:1", "brackets", lines(|_, [c, d]| format!("> {c} {d}"))),
        (
            "1:1",
            "stamps",
            lines(|_, [c, d]| format!("[12:00:01.123]{c},{d}")),
        ),
        (
            "1:1",
            "stamps",
            lines(|_, [c, d]| format!("Thu Nov 26 10:00:00 2026 {c},{d}")),
        ),
        (
            "1:1",
            "stamps",
            lines(|_, [c, d]| format!("[Thu Nov 26 10:00:00.460 2026] {c},{d}")),
        ),
        (
            "1:1",
            "stamps",
            lines(|_, [c, d]| format!("2026-11-26 10:00:00\t{c},{d}")),
        ),
        (
            "1:1",
            "logger",
            lines(|k, [c, d]| format!("I ({k}) adc: {c},{d}")),
        ),
    ] {
        fs::write(here.join("a.csv"), &text).unwrap();
        let place = format!("a.csv:{place}: ");
        let run = run_with(here, "identify --rate 1e5 a.csv", Vec::new());
        assert!(
            run.out.lines().count() < 2 && run.err.contains(&place),
            "{}",
            run.err
        );
        assert!(run.err.contains(told), "{}", run.err);
        let text = converted(here, &run.err);
        let rate = if text.contains("Time") {
            ""
        } else {
            "--rate 1e5"
        };
        same_later(&rows_of(here, &text, rate), &expected, 0.0);
    }
}

#[cfg(unix)]
#[test]
fn the_command_in_the_message_reads_frames_of_candump() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(5000);
    let plain: String = codes.iter().map(|[c, d]| format!("{c},{d}\n")).collect();
    let frame = |[c, d]: &[i16; 2]| {
        let [c, d] = [c, d].map(|code| {
            code.to_le_bytes()
                .map(|byte| format!("{byte:02X}"))
                .concat()
        });
        format!("(1600000000.123456) can0 123#{c}{d}00\n")
    };
    let log: String = codes.iter().map(frame).collect();
    fs::write(here.join("a.log"), log).unwrap();
    let run = run_with(here, "identify a.log", Vec::new());
    assert!(
        run.err.contains("a.log: this is a log of candump"),
        "{}",
        run.err
    );
    assert_eq!(converted(here, &run.err), plain);
}

#[test]
fn a_column_of_stamps_may_be_left_out() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = expected();
    for (stamp, mark) in [
        ("[12:00:01.123]", ' '),
        ("[12:00:01.123]", '\t'),
        ("Thu Nov 26 10:00:00 2026", ','),
    ] {
        let text = lines(|_, [c, d]| format!("{stamp}{mark}{c}{mark}{d}"));
        fs::write(here.join("a.csv"), &text).unwrap();
        let told = [stamp, "ignore the time column with --columns 2,3 --rate HZ"];
        no_rows(here, "a.csv", Vec::new(), &told);
        same_later(
            &rows_of(here, &text, "--columns 2,3 --rate 1e5"),
            &expected,
            0.0,
        );
    }
}

//! `antinode identify` on text with a time column: how it is used, and how it can be ignored.

use std::fs;
use std::path::Path;

use crate::common::{RATE, Row, WAVE, done, rows, rows_of, run, run_with, same_later, text};

/// The pairs of [`WAVE`], each with its time as `print` gives it.
fn timed(header: &str, pairs: usize, print: impl Fn(f64) -> String) -> String {
    let mut lines = header.to_owned();
    for (k, line) in text(&WAVE.codes(pairs)).lines().skip(1).enumerate() {
        let samples = line.split_once(',').unwrap().1;
        lines += &format!("{},{samples}\n", print(k as f64 / RATE));
    }
    lines
}

#[test]
fn times_too_large_to_resolve_the_phase_are_warned_of() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(5000)), "");
    for (start, step) in [(1.7e9, "4e-7"), (2e8, "4e-8")] {
        let late = timed("time,c,d\n", 5000, |t| format!("{:.6}", start + t));
        fs::write(here.join("a.csv"), late).unwrap();
        let run = run(here, "identify --output csv a.csv");
        same_later(&Row::all(&run.out), &expected, start);
        let told = format!(
            "warning: a.csv: time begins at {start} s, where `time_s` has steps of {step} s, too coarse for use with `phase_rad`"
        );
        assert!(run.err.starts_with(&told), "{}", run.err);
    }
}

#[test]
fn dates_have_all_their_digits() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let samples = WAVE.codes(5000);
    let expected = rows_of(here, &text(&samples), "");
    // Times of samples in the last digit, or in few of them, and of a double.
    type Print = fn(u64) -> String;
    let prints: [(&str, Print); 4] = [
        ("s", |k| format!("1700000000.{k:05}")),
        ("ms", |k| format!("1700000000{:03}.{:02}", k / 100, k % 100)),
        ("ns", |k| format!("170000000{:010}", 10_000 * k)),
        ("s", |k| format!("{:.9}", 1.7e9 + k as f64 / RATE)),
    ];
    for (unit, print) in prints {
        let header = format!("time ({unit}),c,d\n");
        let dated = timed(&header, 5000, |t| print((t * RATE).round() as u64));
        fs::write(here.join("a.csv"), &dated).unwrap();
        let rows = run(here, "identify --output csv a.csv").out;
        same_later(&Row::all(&rows), &expected, 1.7e9);
        // A gap, and a time that goes back, are told as they stand there.
        let lines = dated.lines().count();
        let lost: Vec<&str> = dated
            .lines()
            .take(900)
            .chain(dated.lines().skip(907))
            .collect();
        fs::write(here.join("a.csv"), lost.join("\n")).unwrap();
        let told = run(here, "identify a.csv").err;
        let gap = "7 samples are lost before this line (time goes from 1700000000.00";
        assert!(told.contains(gap), "{unit}: {told}");
        let cut: Vec<&str> = dated.lines().take(lines - 200).collect();
        let again = cut[100..].join("\n");
        fs::write(here.join("a.csv"), cut.join("\n") + "\n" + &again).unwrap();
        let told = run(here, "identify a.csv").err;
        assert!(told.contains(" s to 1700000000.000"), "{unit}: {told}");
    }
}

#[test]
fn rows_have_the_recordings_own_time() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(5000)), "");
    assert!((0.001..0.003).contains(&expected[0].number("time_s")));
    for start in [-0.5, 3e7] {
        let text = timed("time,c,d\n", 5000, |t| format!("{:.6}", start + t));
        same_later(&rows_of(here, &text, ""), &expected, start);
        same_later(
            &rows_of(here, &text, "--columns 2,3 --rate 1e5"),
            &expected,
            0.0,
        );
        let table = run(here, "identify a.csv").out;
        let first = table.lines().nth(1).unwrap().split_whitespace().next();
        let shown: f64 = first.unwrap().parse().unwrap();
        assert!((shown - start - expected[0].number("time_s")).abs() < 1e-6);
    }
    let milliseconds = timed("time,c,d\nms,V,V\n", 5000, |t| {
        format!("{:.3}", 1e3 * t + 250.0)
    });
    same_later(&rows_of(here, &milliseconds, ""), &expected, 0.25);
}

#[test]
fn single_precision_is_as_good() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(200_000)), "");
    // At 20 s single precision has steps of a fifth of a sample.
    let text = timed("time,c,d\n", 200_000, |t| format!("{}", (20.0 + t) as f32));
    same_later(&rows_of(here, &text, ""), &expected, 20.0);
}

#[test]
fn times_in_steps_of_several_samples_are_as_good() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(90_000)), "");
    let digits = timed("time,c,d\n", 90_000, |t| format!("{t:.3e}"));
    fs::write(here.join("a.csv"), &digits).unwrap();
    let run = done(here, "identify a.csv --output csv");
    let told = "warning: a.csv: times are given to 1e-4 s only: gaps of up to 10 samples are seen late or not at all; print more digits";
    assert!(
        run.err.starts_with(told) && run.err.lines().count() == 1,
        "{}",
        run.err
    );
    same_later(&Row::all(&run.out), &expected, 0.0);
    // A line sent twice is left out, and one whose time is wrong.
    let lines: Vec<&str> = digits.lines().collect();
    let mut faulty = lines.clone();
    faulty.insert(60_000, lines[60_000]);
    faulty[30_000] = "7.5,0.1,0.1";
    fs::write(here.join("a.csv"), faulty.join("\n")).unwrap();
    let run = crate::common::run(here, "identify a.csv --output csv");
    let told = "error: a.csv:30001:1: the time `7.5` does not follow that of the line before, but the lines behind do: the line is left out, the first of 2";
    assert!(run.code == 1 && run.err.contains(told), "{}", run.err);
    assert!(Row::all(&run.out).len() + 6 > expected.len());
}

#[test]
fn a_counter_that_begins_anew_goes_on() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(100_000)), "");
    let wrap = f64::from(u32::MAX) + 1.0;
    for lines in [1000.0, 80_000.0] {
        // From so many lines before the counter begins anew.
        let start = wrap - 10.0 * lines - 3.0;
        let count = |t: f64| format!("{:.0}", (start + 1e6 * t) % wrap);
        let text = timed("time_us,c,d\n", 100_000, count);
        same_later(&rows_of(here, &text, ""), &expected, 1e-6 * start);
        // One that is reset before is not taken for it.
        let reset = text.replace(&format!("\n{:.0},", wrap - 13.0), "\n5,");
        let early = timed("time_us,c,d\n", 100_000, |t| {
            format!(
                "{:.0}",
                (0.5 * wrap + 1e6 * t) % (0.5 * wrap + 10.0 * lines)
            )
        });
        assert_ne!(reset, text);
        fs::write(here.join("a.csv"), early).unwrap();
        let run = crate::common::run(here, "identify a.csv --output csv");
        assert!(
            run.code == 1 && run.err.contains("must increase"),
            "{}",
            run.err
        );
        fs::write(here.join("a.csv"), reset).unwrap();
        let run = crate::common::run(here, "identify a.csv --output csv");
        assert!(run.err.contains("the line is left out"), "{}", run.err);
    }
}

#[test]
fn a_clock_that_warms_up_is_warned_of_and_costs_no_row() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let steady = text(&WAVE.codes(400_000));
    let expected = rows_of(here, &steady, "");
    // The clock drifts by 3 ppm a second, 12 ppm in the end.
    let text = timed("time,c,d\n", 400_000, |t| {
        format!("{:.9}", t - 1.5e-6 * t * t)
    });
    fs::write(here.join("a.csv"), text).unwrap();
    let run = done(here, "identify a.csv --output csv");
    let told = "warning: a.csv: the sample rate in the time column drifts slowly from 100000.";
    assert!(
        run.err.starts_with(told) && run.err.lines().count() == 1,
        "{}",
        run.err
    );
    assert!(
        run.err.contains(" s later than the time column"),
        "{}",
        run.err
    );
    let rows = Row::all(&run.out);
    assert_eq!(rows.len(), expected.len());
    for (row, expected) in rows.iter().zip(&expected) {
        let off = row.number("time_s") / expected.number("time_s") - 1.0;
        assert!(off.abs() < 2e-6, "{off}");
    }
}

#[test]
fn a_rate_that_is_nearly_round_is_warned_of_with_its_option() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = timed("time,c,d\n", 600_000, |t| format!("{:.6}", t / 1.000_002));
    fs::write(here.join("a.csv"), text).unwrap();
    let rough = done(here, "identify a.csv --output csv");
    let (_, option) = rough.err.split_once("give --rate ").expect(&rough.err);
    let (rate, _) = option.split_once(' ').unwrap();
    assert_eq!(rate, "100000.2");
    let mean = |rows: &[Row]| {
        let sum: f64 = rows.iter().map(|row| row.number("frequency_hz")).sum();
        sum / rows.len() as f64
    };
    let exact = rows(here, &format!("a.csv --rate {rate}"));
    let share = mean(&exact) / mean(&Row::all(&rough.out)) - 1.0;
    assert!((share - 2e-6).abs() < 1e-7, "{share}");
}

#[test]
fn every_fault_of_the_time_names_the_way_around_it() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let good = |t: f64| format!("{t:.5}");
    let lines: Vec<String> = timed("zeit,c,d\n", 5000, good)
        .lines()
        .map(str::to_owned)
        .collect();
    let lost = [&lines[..3000], &lines[3003..]].concat().join("\n");
    let jitter = |t: f64| format!("{:.9}", t + 2e-6 * (1e5 * t).sin());
    let cases = [
        (lost, "3 samples are lost"),
        (timed("zeit,c,d\n", 5000, jitter), "time steps by"),
        (
            timed("zeit,c,d\n", 5000, |t| format!("{t:.2}")),
            "too coarse",
        ),
        (
            timed("zeit,c,d\n", 5000, |t| format!("05/01/2024 00:00:{t:08.5}")),
            "the time is `05/01/2024 00:00:00.00000`",
        ),
        (timed("time_min,c,d\n", 5000, good), "`time_min`"),
    ];
    for (text, told) in cases {
        fs::write(here.join("a.csv"), text).unwrap();
        let fault = run(here, "identify a.csv --rate 1e5 --output csv");
        assert_eq!(fault.code, 1, "{told}");
        assert!(fault.err.contains(told), "{}", fault.err);
        let way = "ignore the time column with --columns 2,3 --rate HZ\n";
        assert!(fault.err.ends_with(way), "{}", fault.err);
        // From a pipe the way is the same, with --rate or without.
        for arguments in ["identify --rate 1e5 -", "identify -"] {
            let piped = run_with(here, arguments, fs::read(here.join("a.csv")).unwrap());
            assert!(piped.err.contains(told), "{}", piped.err);
        }
        // The way around works.
        assert!(rows(here, "a.csv --columns 2,3 --rate 1e5").len() > 20);
    }
}

/// The one warning of a run that succeeds, and its rows.
fn warned(directory: &Path, arguments: &str) -> (String, Vec<Row>) {
    let run = run(
        directory,
        &format!("identify a.csv --output csv {arguments}"),
    );
    assert_eq!((run.code, run.err.lines().count()), (0, 1), "{}", run.err);
    (run.err, Row::all(&run.out))
}

#[test]
fn an_index_is_warned_of() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(5000)), "");
    let index = |t: f64| format!("{:.0}", 1e5 * t + 500_000.0);
    fs::write(here.join("a.csv"), timed("zeit,c,d\n", 5000, index)).unwrap();
    let (told, _) = warned(here, "");
    assert!(told.starts_with("warning: a.csv: the time column increases by 1 per line"));
    assert!(told.ends_with("with --columns 2,3 --rate HZ\n"), "{told}");
    // With --rate it is an index, and times begin at 0.
    let (told, rows) = warned(here, "--rate 1e5");
    assert!(
        told.contains("read as an index") && told.contains("count from the first sample"),
        "{told}"
    );
    same_later(&rows, &expected, 0.0);
    // An index has no decimals.
    let decimals = |t: f64| format!("{:.1}", 1e5 * t + 500_000.5);
    rows_of(here, &timed("time,c,d\n", 5000, decimals), "");
    fs::write(here.join("a.csv"), timed("zeit,c,d\n", 5000, index)).unwrap();
    // With --rate 1 the column is still seconds.
    let seconds = crate::common::rows(here, "a.csv --rate 1");
    assert!(seconds[0].number("time_s") > 500_000.0);
}

#[test]
fn times_that_contradict_the_rate_are_warned_of() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(5000)), "");
    let (told, rows) = warned(here, "--rate 100200");
    let both = "the sample rate is 100000 Hz by the time column and 100200 Hz by --rate";
    assert!(
        told.contains(both) && told.ends_with("--columns 2,3 --rate HZ\n"),
        "{told}"
    );
    assert_eq!(rows.len(), expected.len());
    same_later(
        &crate::common::rows(here, "a.csv --rate 1e5"),
        &expected,
        0.0,
    );
    assert_eq!(
        crate::common::rows(here, "a.csv --rate 100050").len(),
        expected.len()
    );
    assert_eq!(
        crate::common::rows(here, "a.csv --columns 2,3 --rate 100200").len(),
        expected.len()
    );
}

#[test]
fn a_halved_rate_is_reported_as_lost_samples() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // From sample 3000 on, every other one is missing.
    let lines: Vec<String> = text(&WAVE.codes(6000))
        .lines()
        .enumerate()
        .filter(|&(at, _)| at < 3001 || at % 2 == 0)
        .map(|(_, line)| line.to_owned())
        .collect();
    fs::write(here.join("a.csv"), lines.join("\n")).unwrap();
    let run = run(here, "identify a.csv --output csv");
    assert_eq!((run.code, run.err.lines().count()), (1, 2), "{}", run.err);
    let told = "error: a.csv:3002: 1 sample is lost before this line (time goes from 0.02999 s to 0.03001 s), the first of 1500 gaps with 1500";
    assert!(run.err.contains(told), "{}", run.err);
    assert!(
        run.err
            .starts_with("warning: a.csv: no wave was found in the last 0.0310 s")
    );
    let last = Row::all(&run.out).last().unwrap().number("time_s");
    assert!((0.027..0.03).contains(&last), "{last}");
}

#[test]
fn times_rounded_to_several_samples_are_read_from_a_pipe_of_a_known_rate_too() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // Ten samples have the same time.
    let codes = WAVE.codes(70_000);
    let lines = codes
        .iter()
        .enumerate()
        .map(|(k, [c, d])| format!("{:.4},{c},{d}\n", k as f64 * 1e-5));
    let text = format!("time,c,d\n{}", lines.collect::<String>());
    fs::write(here.join("a.csv"), &text).unwrap();
    let expected = run(here, "identify --output csv --rate 1e5 a.csv");
    let found = run_with(here, "identify --output csv --rate 1e5 -", text.into());
    assert_eq!(
        (expected.code, found.code),
        (0, 0),
        "{} {}",
        expected.err,
        found.err
    );
    let (expected, found) = (Row::all(&expected.out), Row::all(&found.out));
    assert!(expected.len() > 360);
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!(found.text("frequency_hz"), expected.text("frequency_hz"));
    }
}

//! `antinode identify` on text whose time column holds clock times.

use crate::common::{
    RATE, Row, WAVE, fault, no_rows, printed, rows_of, run_with, same_later, text,
};

/// The seconds from midnight to 13:45:01, from 1970 to that clock on 28 November 2026, and in a day.
const CLOCK: u64 = 49_501;
const DATE: u64 = 1_795_873_501;
const DAY: u64 = 86_400;

/// `13:45:01` and its hundred thousandths, as they stand so many samples after this second of a day.
fn clock(second: u64, k: usize) -> (String, u64) {
    let (second, k) = (second + k as u64 / 100_000, k % 100_000);
    let [hour, minute] = [second / 3600 % 24, second / 60 % 60];
    (
        format!("{hour:02}:{minute:02}:{:02}", second % 60),
        k as u64,
    )
}

/// The pairs of [`WAVE`] below this header, each line as `print` has its number and its samples.
fn timed(header: &str, print: impl Fn(usize, [f64; 2]) -> String) -> String {
    printed(header, &WAVE.codes(5000), print)
}

#[test]
fn clock_times_are_as_good_as_seconds() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(5000)), "");
    let at = |k| clock(CLOCK, k);
    type Print<'a> = &'a dyn Fn(usize) -> String;
    let date = |k, mark: char, zone: &str| {
        let (clock, rest) = at(k);
        format!("2026-11-28{mark}{clock}.{rest:05}{zone}")
    };
    let prints: [(&str, u64, Print); 9] = [
        ("time,c,d\n", DATE, &|k| date(k, 'T', "")),
        ("", DATE, &|k| date(k, ' ', "")),
        ("Time (UTC),x,y\n", DATE, &|k| date(k, 'T', "0Z")),
        ("when,x,y\n", DATE - 7200, &|k| date(k, ' ', "0000+02:00")),
        ("Date and time,x,y\n", DATE, &|k| {
            format!("28.11.2026 {}.{:05}", at(k).0, at(k).1)
        }),
        ("Time,x,y\n", DATE, &|k| {
            format!("2026/11/28 1{}.{:05} PM", &at(k).0[2..], at(k).1)
        }),
        // The name tells no unit of such times.
        ("time_ms,c,d\n", CLOCK, &|k| {
            format!("{}.{:05}", at(k).0, at(k).1)
        }),
        ("Time (hh:mm:ss.ms),c,d\n", CLOCK, &|k| {
            format!("\"{}.{:05}\"", at(k).0, at(k).1)
        }),
        // Nor is a line of units one of samples.
        ("Clock,c,d\nhh:mm:ss,V,V\n", CLOCK, &|k| {
            format!("{}.{:06}", at(k).0, 10 * at(k).1)
        }),
    ];
    for (header, later, print) in prints {
        let text = timed(header, |k, [c, d]| format!("{},{c},{d}", print(k)));
        std::fs::write(here.join("a.csv"), &text).unwrap();
        let run = run_with(here, "identify --output csv a.csv", Vec::new());
        same_later(&Row::all(&run.out), &expected, later as f64);
        // Of dates it is told that `time_s` has too few digits for them.
        assert_eq!(
            run.err.contains("warning"),
            later >= DATE - 7200,
            "{}",
            run.err
        );
        let alone = rows_of(here, &text, "--columns 2,3 --rate 1e5");
        same_later(&alone, &expected, 0.0);
    }
    for mark in [';', '\t'] {
        let comma = |x: f64| x.to_string().replace('.', ",");
        let text = timed("", |k, [c, d]| {
            let (clock, rest) = at(k);
            format!("{clock},{rest:05}{mark}{}{mark}{}", comma(c), comma(d))
        });
        same_later(&rows_of(here, &text, ""), &expected, CLOCK as f64);
    }
    // Blanks leave the date by itself. From a pipe it is the same.
    for date in ["", "2026-11-28 ", "28.11.2026 "] {
        let text = timed("", |k, [c, d]| {
            let (clock, rest) = at(k);
            format!("{date}{clock}.{rest:05} {c} {d}")
        });
        same_later(&rows_of(here, &text, ""), &expected, CLOCK as f64);
        let run = run_with(here, "identify --output csv -", text.into_bytes());
        same_later(&Row::all(&run.out), &expected, CLOCK as f64);
    }
}

#[test]
fn units_of_the_signals_stand_beside_that_of_a_clock() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(5000)), "");
    let text = timed("Clock,c,d\nhh:mm:ss,V,mV\n", |k, [c, d]| {
        let (clock, rest) = clock(CLOCK, k);
        format!("{clock}.{rest:05},{c},{}", 1000.0 * d)
    });
    std::fs::write(here.join("a.csv"), &text).unwrap();
    let run = run_with(here, "identify --output csv a.csv", Vec::new());
    same_later(&Row::all(&run.out), &expected, CLOCK as f64);
    assert_eq!(
        run.err,
        "warning: a.csv: S_C is in V and S_D in mV: both are converted to V\n"
    );
}

#[test]
fn a_clock_beside_a_time_is_not_used() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(5000)), "");
    // Once a second, it shows no rate.
    for header in ["", "Date,Time,c,d\n", "when,Time (s),x,y\n"] {
        let text = timed(header, |k, [c, d]| {
            format!("{},{:.5},{c},{d}", clock(CLOCK, k).0, k as f64 / RATE)
        });
        same_later(&rows_of(here, &text, ""), &expected, 0.0);
    }
}

#[test]
fn midnight_may_pass() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(5000)), "");
    // Where the rate is found, and far behind: 0.02 s and 0.69 s before midnight.
    for before in [2_000, 69_000] {
        let line = |k: usize, [c, d]: [f64; 2]| {
            let (clock, rest) = clock(DAY - 1, 100_000 - before + k);
            format!("{clock}.{rest:05},{c},{d}")
        };
        let codes = WAVE.codes(if before < 5_000 { 5_000 } else { 80_000 });
        let midnight = printed("time,c,d\n", &codes, line);
        let start = DAY as f64 - before as f64 / 1e5;
        let found = rows_of(here, &midnight, "");
        same_later(
            &found[..expected.len() - 1],
            &expected[..expected.len() - 1],
            start,
        );
        let last = found[found.len() - 1].number("time_s");
        assert!(
            (last - start - codes.len() as f64 / 1e5).abs() < 4e-3,
            "{last}"
        );
        // A gap that spans it.
        let lines: Vec<&str> = midnight.lines().collect();
        let lost = [&lines[..before - 1], &lines[before + 6..]]
            .concat()
            .join("\n");
        let told =
            format!("a.csv:{before}: 7 samples are lost before this line (time goes from 86399.99");
        std::fs::write(here.join("a.csv"), lost).unwrap();
        fault(here, "a.csv", Vec::new(), &[&told]);
    }
    // With dates a day back is no midnight.
    let text = timed("time,c,d\n", |k, [c, d]| {
        let day = if k < 2_000 { 28 } else { 27 };
        let (clock, rest) = clock(CLOCK, k);
        format!("2026-11-{day}T{clock}.{rest:05},{c},{d}")
    });
    std::fs::write(here.join("a.csv"), text).unwrap();
    let run = run_with(here, "identify --output csv a.csv", Vec::new());
    let told = format!(
        "a.csv:2002: time goes from {DATE}.01999 s to {}.02 s, but must",
        DATE - DAY
    );
    assert!(run.code == 1 && run.err.contains(&told), "{}", run.err);
}

#[test]
fn faults_of_clock_times_cost_their_lines_alone() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = timed("time,c,d\n", |k, [c, d]| {
        let (clock, rest) = clock(CLOCK, k);
        format!("{clock}.{rest:05},{c},{d}")
    });
    let lines: Vec<&str> = text.lines().collect();
    let time = |at: usize| lines[at].split(',').next().unwrap();
    for (wrong, told) in [
        (
            "13:4x:01.00899",
            "the time is `13:4x:01.00899`, not a finite number",
        ),
        (
            "13:45:07.00899",
            "the time `49507.00899` does not follow that of the line before",
        ),
        (
            "00:00:00.00000",
            "the time `0.00000` does not follow that of the line before",
        ),
    ] {
        let text = text.replace(time(900), wrong);
        std::fs::write(here.join("a.csv"), text).unwrap();
        let rows = fault(here, "a.csv", Vec::new(), &["a.csv:901", told]);
        assert!(rows.len() > 20, "{}", rows.len());
    }
    // Those that no rate explains are refused, and so are other forms, with what is right.
    let coarse = timed("time,c,d\n", |_, [c, d]| format!("13:45:01,{c},{d}"));
    std::fs::write(here.join("a.csv"), coarse).unwrap();
    fault(
        here,
        "a.csv",
        Vec::new(),
        &[
            "a.csv:3: time goes from 49501 s to 49501 s",
            "--columns 2,3",
        ],
    );
    let other = timed("time,c,d\n", |_, [c, d]| {
        format!("11/28/2026 13:45:01,{c},{d}")
    });
    std::fs::write(here.join("a.csv"), other).unwrap();
    let told = "give it in seconds or as 2026-11-28T13:45:01.5";
    no_rows(
        here,
        "a.csv",
        Vec::new(),
        &["a.csv:2:1: the time is `11/28/2026", told],
    );
}

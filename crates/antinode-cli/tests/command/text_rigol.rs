//! `antinode identify` on the CSV of newer oscilloscopes of Rigol, whose first line gives the time of the first sample and the step.

use crate::common::{Row, WAVE, fault, printed, rows_of, run_with, same_later, text};

/// From memory, by an MHO98, as `csv_export.py` of <https://github.com/uberjay/rigol-fastrec> reads it.
const MHO: &str = "CH1V,CH2V,t0 =-5.000000e-02, tInc = 1.000000e-05,\n";

/// The same by an MSO5000, whose numbers have a unit as in the next.
const MSO: &str = "CH1(V),CH2(V),t0 = -0.05s, tInc = 1e-05s,\n";

/// From the screen of an MSO5000, as the README of <https://github.com/brainstorm/rigolcsv2vcd> has it.
const SCREEN: &str = "Time(s),CH1(V),CH2(V),t0 = -0.05s, tInc = 1e-05,\n";

/// The time of the first sample, s.
const START: f64 = -0.05;

/// A recording under this header, with a column of times or without.
fn recording(header: &str) -> String {
    let is_timed = header.starts_with("Time");
    printed(header, &WAVE.codes(5000), |k, [c, d]| {
        let time = format!("{:.6E},", START + k as f64 * 1e-5);
        let time = if is_timed { &time } else { "" };
        format!("{time}{c:+e},{d:+e},,")
    })
}

#[test]
fn the_step_in_the_names_gives_the_rate() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(5000)), "");
    for (header, names, numbers) in [
        (MHO, "--columns CH1V,CH2V", "--columns 1,2"),
        (MSO, "--columns CH1,CH2", "--columns 1,2"),
        (SCREEN, "--columns Time,CH1,CH2", "--columns 2,3"),
    ] {
        let text = recording(header);
        for arguments in ["", "--rate 1e5", names, numbers] {
            same_later(&rows_of(here, &text, arguments), &expected, START);
        }
        let piped = run_with(here, "identify - --output csv", text.into_bytes());
        assert_eq!((piped.code, piped.err.as_str()), (0, ""), "{header}");
        same_later(&Row::all(&piped.out), &expected, START);
    }
}

#[test]
fn another_rate_than_that_of_the_names_is_warned_of() {
    let directory = tempfile::tempdir().unwrap();
    let told = "the sample rate is 100000 Hz by its settings and 50000 Hz by --rate, which takes precedence";
    let arguments = "identify - --rate 5e4";
    let run = run_with(directory.path(), arguments, recording(MHO).into_bytes());
    assert!(run.code == 0 && run.err.contains(told), "{}", run.err);
}

#[test]
fn start_and_step_are_no_columns() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let refused = |text: String, told: &str| {
        assert!(fault(here, "-", text.into(), &[told]).is_empty(), "{told}");
    };
    let one = "CH1V,t0 =-5e-02, tInc = 1e-05,\n0.1,,\n0.2,,\n";
    refused(one.to_owned(), "input:1: found 1 column, but two");
    // Of three channels none is taken for a time.
    let three = MHO.replace("CH2V", "CH2V,CH3V");
    let three = recording(MHO)
        .replace(MHO, &three)
        .replace(",,\n", ",0.5,,\n");
    refused(three, "input:1: found 3 columns, but two");
    // A name without a step is a column's name like any other.
    for step in ["tInc = 0", "tInc = -1e-05", "tInc = auto", "tInc"] {
        let text = recording(&MHO.replace("tInc = 1.000000e-05", step));
        refused(text, "input:1: found 4 columns, but two");
    }
}

//! The digits of rows: only meaningful ones, and no sign of zeros.

use std::fs;

use crate::common::{RATE, WAVE, Wave, printed, rows, run, wav};

#[test]
fn a_table_has_no_sign_of_zeros() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // Rates that are only noise, of either sign.
    let still = Wave {
        angle_rate: 0.0,
        decay_rate: 0.0,
        noise: 1e-5,
        ..WAVE
    };
    fs::write(here.join("a.wav"), wav(&still.codes(200_000))).unwrap();
    let identified = "identify a.wav --periods 100";
    let rates = rows(here, "a.wav --periods 100");
    assert!(
        rates
            .iter()
            .any(|row| row.text("decay_rate_s").starts_with("-0.000"))
    );
    let table = run(here, identified).out;
    let mut words = table.split_whitespace();
    let negative =
        words.find(|word| word.starts_with('-') && word.trim_matches(['-', '0', '.']).is_empty());
    assert_eq!(negative, None, "{table}");
}

#[test]
fn a_time_has_no_meaningless_digits() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = printed("time,C,D\n", &WAVE.codes(20_000), |k, [c, d]| {
        format!("{:.5},{c},{d}", 8051.37 + k as f64 / RATE)
    });
    fs::write(here.join("a.csv"), text).unwrap();
    for row in rows(here, "a.csv") {
        // A sample lasts 10 µs, so that the middle of a window is a multiple of 5 µs.
        let (_, decimals) = row.text("time_s").split_once('.').unwrap();
        assert!(decimals.len() <= 6, "{}", row.text("time_s"));
    }
}

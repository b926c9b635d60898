//! The digits of rows: only meaningful ones, and no sign of zeros.

use std::fs;

use crate::common::{RATE, WAVE, Wave, done, no_rows, npy, printed, rows, run, silence, wav};

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

#[test]
fn times_at_a_high_rate_have_the_digits_that_tell_them_apart() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.npy"), npy(&WAVE.codes(20_000))).unwrap();
    let run = run(here, "identify a.npy --rate 2e9 --methods all --to 1");
    let ends = "the recording ends at 0.0000100000 s, before --to 1 s";
    assert!(run.err.contains(ends), "{}", run.err);
    let column = |line: &str| line.chars().take(15).collect::<String>();
    let lines: Vec<String> = run.out.lines().skip(2).map(column).collect();
    assert!(lines[0].ends_with(" time, s ") && lines[2].ends_with("method 1 "));
    let times: Vec<f64> = lines
        .iter()
        .filter_map(|time| time.trim().parse().ok())
        .collect();
    assert!(times.len() > 90);
    // Ten periods of 19 samples.
    for pair in times.windows(2) {
        let apart = pair[1] - pair[0];
        assert!((9.2e-8..9.6e-8).contains(&apart), "{apart}");
    }
    let few = "100 sample pairs (0.000000050 s) hold no window";
    fs::write(here.join("few.npy"), npy(&WAVE.codes(100))).unwrap();
    no_rows(here, "few.npy --rate 2e9", Vec::new(), &[few]);
    let silent = silence(0.005).codes(20_000);
    fs::write(
        here.join("late.npy"),
        npy(&[silent, WAVE.codes(20_000)].concat()),
    )
    .unwrap();
    let late = done(here, "identify late.npy --rate 2e9").err;
    let told = "no wave was found in the first 0.000010 s of 0.000020 s: rows with a wave go from 0.0000100 s to 0.0000199 s";
    assert!(late.contains(told), "{late}");
    // A stretch so short that its ends differ in more digits.
    let silent = silence(0.005).codes(20_000);
    let short = [silent.clone(), WAVE.codes(300), silent].concat();
    fs::write(here.join("short.npy"), npy(&short)).unwrap();
    let short = done(here, "identify short.npy --rate 2e9").err;
    let (_, ends) = short.split_once(" go from 0.0000100").expect(&short);
    let (begin, end) = ends.split_once(" s to 0.000010").expect(&short);
    assert!(
        begin.len() == 2 && end[..3].parse::<u32>().is_ok(),
        "{short}"
    );
}

//! `antinode identify` on samples that are not finite numbers: their rows are flagged, all others are there.

use std::fs;

use crate::common::{Row, WAVE, fault, rows, run_with, text, wav};

/// Pairs as consecutive 32-bit floats.
fn floats(pairs: &[[f32; 2]]) -> Vec<u8> {
    let values = pairs.as_flattened();
    values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

/// A WAV file of 32-bit floats.
fn float_wav(pairs: &[[f32; 2]]) -> Vec<u8> {
    let mut bytes = wav(&[]);
    let data = 8 * pairs.len() as u32;
    bytes[4..8].copy_from_slice(&(36 + data).to_le_bytes());
    bytes[20] = 3;
    bytes[28..32].copy_from_slice(&800_000u32.to_le_bytes());
    bytes[32..36].copy_from_slice(&[8, 0, 32, 0]);
    bytes[40..44].copy_from_slice(&data.to_le_bytes());
    bytes.extend(floats(pairs));
    bytes
}

/// An NPY file of 32-bit floats of shape (N, 2).
fn float_npy(pairs: &[[f32; 2]]) -> Vec<u8> {
    let mut bytes = crate::common::npy(&vec![[0; 2]; pairs.len()])[..128].to_vec();
    let kind = bytes.windows(3).position(|three| three == b"<i2").unwrap();
    bytes[kind..kind + 3].copy_from_slice(b"<f4");
    bytes.extend(floats(pairs));
    bytes
}

/// The clean rows that do not hold pair `bad` are those of the recording without it; those that hold it are flagged.
fn one_row_is_flagged(found: &[Row], clean: &[Row], bad: f64) {
    assert_eq!(found.len(), clean.len());
    let mut flagged = 0;
    for (found, clean) in found.iter().zip(clean) {
        let (middle, samples) = (clean.number("time_s") * 1e5, clean.number("samples"));
        assert_eq!(found.text("time_s"), clean.text("time_s"));
        if (middle - bad).abs() <= 0.5 * samples {
            assert!(found.text("flags").contains("not_finite"));
            flagged += 1;
            continue;
        }
        assert_eq!(found.text("flags"), "");
        if middle < bad {
            assert_eq!(found.unnamed()[..15], clean.unnamed()[..15]);
        }
        let apart = found.number("main_amplitude") - clean.number("main_amplitude");
        assert!(apart.abs() < 0.1 * clean.number("main_amplitude_std"));
    }
    assert_eq!(flagged, 1);
}

#[test]
fn rows_before_and_after_are_present_and_clean() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(20_000);
    let mut pairs: Vec<[f32; 2]> = codes
        .iter()
        .map(|pair| pair.map(|code| f32::from(code) / 32_768.0))
        .collect();
    fs::write(here.join("good.wav"), float_wav(&pairs)).unwrap();
    let clean = rows(here, "good.wav");
    assert!(clean.len() > 90);
    let what = "not a finite number";

    let mut lines: Vec<String> = text(&codes).lines().map(str::to_owned).collect();
    // The header is line 1, so the pair of index 12000 is on line 12002.
    lines[12_001] = "0.12000,0.1,NaN".to_owned();
    fs::write(here.join("bad.csv"), lines.join("\n")).unwrap();
    let place = "bad.csv:12002:3: sample pair 12000 (from 0), S_D (right): the value is NaN";
    let found = fault(here, "bad.csv", Vec::new(), &[place, what]);
    one_row_is_flagged(&found, &clean, 12_000.0);

    pairs[12_000] = [f32::INFINITY, 0.0];
    pairs[12_001] = [f32::NAN, f32::NEG_INFINITY];
    fs::write(here.join("bad.wav"), float_wav(&pairs)).unwrap();
    fs::write(here.join("bad.npy"), float_npy(&pairs)).unwrap();
    let runs = [
        ("bad.wav", "bad.wav", Vec::new()),
        ("bad.npy --rate 1e5", "bad.npy", Vec::new()),
        ("- --raw f32 --rate 1e5", "standard input", floats(&pairs)),
    ];
    for (arguments, name, input) in runs {
        let place = format!("{name}: sample pair 12000 (from 0), S_C (left): the value is inf");
        let found = fault(
            here,
            arguments,
            input,
            &[&place, what, ", the first of 3; ", "check the instrument"],
        );
        one_row_is_flagged(&found, &clean, 12_000.0);
    }
}

#[test]
fn the_search_recovers_from_one_among_the_first() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let good: Vec<[f32; 2]> = WAVE
        .codes(5000)
        .iter()
        .map(|pair| pair.map(|code| f32::from(code) / 32_768.0))
        .collect();
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for at in [0, 1, 7, 20, 29, 60] {
            let mut pairs = good.clone();
            pairs[at][1] = value;
            let place = format!("sample pair {at} (from 0), S_D (right): the value is {value}");
            let found = fault(here, "- --raw f32 --rate 1e5", floats(&pairs), &[&place]);
            // At 18.8 samples a period, one or two windows are missing.
            assert!(found.len() >= 24, "{at}: {}", found.len());
            assert!(found.iter().all(|row| row.text("flags").is_empty()));
        }
    }
}

#[test]
fn a_record_that_is_not_filled_begins_later_and_ends_earlier() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(30_000);
    let within = 20_000..29_975;
    // Behind more pairs than are read at once.
    let lines = codes.iter().enumerate().map(|(k, [c, d])| {
        let time = k as f64 * 1e-5;
        if within.contains(&k) {
            format!("{time:.5},{c},{d}\n")
        } else {
            format!("{time:.5},,\n")
        }
    });
    let text: String = lines.collect();
    fs::write(here.join("a.csv"), format!("time,c,d\n{text}")).unwrap();
    let pairs = codes.iter().enumerate().map(|(k, pair)| {
        let value = pair.map(f32::from);
        if within.contains(&k) {
            value
        } else {
            [f32::NAN; 2]
        }
    });
    let floats = floats(&pairs.collect::<Vec<_>>());
    let alone: Vec<_> = codes[within.clone()]
        .iter()
        .map(|pair| pair.map(f32::from))
        .collect();
    fs::write(here.join("alone.wav"), float_wav(&alone)).unwrap();
    let alone = rows(here, "alone.wav");
    for (arguments, name, input) in [
        ("a.csv", "a.csv", Vec::new()),
        ("- --raw f32 --rate 1e5", "standard input", floats),
    ] {
        let run = run_with(here, &format!("identify --output csv {arguments}"), input);
        assert_eq!(run.code, 0, "{}", run.err);
        for told in [
            "the first 20000 sample pairs have no values: the recording begins behind them",
            "the last 25 sample pairs have no values: the recording ends before them",
        ] {
            let warning = format!("warning: {name}: {told}");
            assert!(run.err.lines().any(|line| line == warning), "{}", run.err);
        }
        assert!(!run.err.contains("error"), "{}", run.err);
        let found = Row::all(&run.out);
        let (clean, flagged): (Vec<_>, Vec<_>) =
            found.iter().partition(|row| row.text("flags").is_empty());
        assert!(
            flagged.iter().all(|row| row.number("time_s") > 0.299),
            "{}",
            run.out
        );
        assert!(
            clean.len() + 2 >= alone.len(),
            "{} {}",
            clean.len(),
            alone.len()
        );
        assert!(
            clean
                .iter()
                .all(|row| (0.2..0.29975).contains(&row.number("time_s")))
        );
    }
}

#[test]
fn a_column_without_numbers_at_first_is_no_time() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let lines = WAVE.codes(5000);
    let good: String = lines.iter().map(|[c, d]| format!("{c},{d}\n")).collect();
    for missing in ["nan,nan\n", "inf,inf\n", "nan,0.1\n"] {
        fs::write(here.join("a.csv"), missing.repeat(64) + &good).unwrap();
        let run = run_with(here, "identify --output csv --rate 1e5 a.csv", Vec::new());
        assert_eq!(
            run.code,
            i32::from(missing != "nan,nan\n"),
            "{missing}: {}",
            run.err
        );
        assert!(Row::all(&run.out).len() > 20, "{missing}: {}", run.err);
    }
}

#[test]
fn a_later_fault_is_reported_too() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let endless = "5".repeat(70_000);
    fs::write(here.join("a.csv"), format!("1,2\n3,nan\n{endless}\n")).unwrap();
    let run = run_with(here, "identify a.csv --rate 1e5", Vec::new());
    assert_eq!((run.code, run.out.as_str()), (1, ""), "{}", run.err);
    let lines: Vec<&str> = run.err.lines().collect();
    assert_eq!(lines.len(), 2, "{}", run.err);
    assert!(lines[0].starts_with("error: a.csv:2:2: sample pair 1 (from 0), S_D"));
    assert!(lines[1].starts_with("error: a.csv:3: more than 65536 bytes"));
}

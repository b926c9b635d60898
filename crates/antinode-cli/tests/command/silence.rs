//! `antinode identify` on recordings whose wave begins late or ends early.

use std::fs;
use std::path::Path;

use crate::common::{Row, WAVE, beside_flagged, done, silence, wav};

/// A recording of a wave that rings in these pairs alone; the others hold a little noise.
fn ringing(pairs: usize, rings: impl Fn(usize) -> bool) -> Vec<u8> {
    let mut codes = WAVE.codes(pairs);
    for (k, code) in silence(1e-4).codes(pairs).into_iter().enumerate() {
        if !rings(k) {
            codes[k] = code;
        }
    }
    wav(&codes)
}

/// The warnings other than the count of flags, and the time at which the rows with a wave end, s.
fn told(here: &Path, recording: Vec<u8>, arguments: &str) -> (String, f64) {
    fs::write(here.join("a.wav"), recording).unwrap();
    let run = done(here, &format!("identify --output csv a.wav {arguments}"));
    let rows = Row::all(&run.out);
    let last = rows
        .iter()
        .rfind(|row| !row.text("flags").contains("lost"))
        .unwrap();
    (
        beside_flagged(&rows, &run.err).join("\n"),
        last.number("time_s") + last.number("samples") / 2e5,
    )
}

/// The number of seconds after a word of a message.
fn seconds(text: &str, word: &str) -> f64 {
    let (_, rest) = text
        .split_once(word)
        .unwrap_or_else(|| panic!("{word}: {text}"));
    rest.split(' ').next().unwrap().parse().unwrap()
}

#[test]
fn a_wave_that_ends_early_or_begins_late_is_reported_once() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (from, to) in [(0, 60_000), (30_000, 100_000), (30_000, 60_000)] {
        let (said, last) = told(here, ringing(100_000, |k| (from..to).contains(&k)), "");
        assert!(
            said.starts_with("warning: a.wav: no wave was found in the "),
            "{said}"
        );
        assert_eq!(said.lines().count(), 1, "{said}");
        assert!(
            said.contains(" of 1.0000 s: rows with a wave go from "),
            "{said}"
        );
        assert_eq!(said.contains("the first "), from > 0, "{said}");
        assert_eq!(said.contains("the last "), to < 100_000, "{said}");
        assert!((seconds(&said, " s to ") - last).abs() < 1e-4, "{said}");
        if from > 0 {
            assert!((seconds(&said, "the first ") - 0.3).abs() < 0.005, "{said}");
            assert!((seconds(&said, "go from ") - 0.3).abs() < 0.005, "{said}");
        }
        if to < 100_000 {
            assert!((seconds(&said, "the last ") - 0.4).abs() < 0.005, "{said}");
        }
    }
    let (said, _) = told(here, ringing(100_000, |k| k > 2000), "");
    assert!(
        (seconds(&said, "the first ") - 0.02).abs() < 0.005,
        "{said}"
    );
    // Windows that begin with the first sample.
    let (said, _) = told(here, ringing(100_000, |k| k < 60_000), "--frequency 5332");
    assert!(said.contains(" go from 0.0000 s to "), "{said}");
    // In the recording's own times, for the span that was asked for.
    let (said, _) = told(
        here,
        ringing(100_000, |k| k < 60_000),
        "--from 0.5 --to 0.8",
    );
    assert!(
        said.contains("the last 0.19") || said.contains("the last 0.2"),
        "{said}"
    );
    assert!(
        said.contains(" of 0.3000 s: rows with a wave go from 0.5"),
        "{said}"
    );
}

#[test]
fn usual_silence_raises_no_warning() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // Silence between two ring-downs is flagged; at the ends, a few windows without a wave are usual.
    for (pairs, silent, arguments) in [
        (100_000, 30_000..60_000, ""),
        (100_000, 0..300, ""),
        (100_000, 0..300, "--periods 2"),
        (100_000, 0..700, ""),
        (100_000, 90_000..100_000, "--periods 300"),
        (20_000, 0..250, "--periods 2"),
        (100_000, 0..0, "--periods 300"),
        (100_000, 0..0, "--hop 1000"),
        (100_000, 0..0, "--frequency 5321 --periods 1000"),
    ] {
        let recording = ringing(pairs, |k| !silent.contains(&k));
        assert_eq!(told(here, recording, arguments).0, "", "{arguments}");
    }
}

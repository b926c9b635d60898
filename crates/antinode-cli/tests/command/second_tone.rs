//! `antinode identify` on a wave beside a second tone, as of a neighbouring mode: its warning, and that the remedy it names works.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use crate::common::{RATE, WAVE, Wave, identified, wav};

/// A steady wave.
const STEADY: Wave = Wave {
    angle_rate: 0.0,
    decay_rate: 0.0,
    ..WAVE
};

/// Records the wave in this noise, and a tone 300 Hz above it, of this share of a_A, on both pick-offs.
fn record(directory: &Path, pairs: usize, noise: f64, share: f64) {
    record_at(STEADY.frequency + 300.0, directory, pairs, noise, share);
}

/// The same with a tone at this frequency.
fn record_at(frequency: f64, directory: &Path, pairs: usize, noise: f64, share: f64) {
    let mut codes = Wave { noise, ..STEADY }.codes(pairs);
    for (k, pair) in codes.iter_mut().enumerate() {
        let turns = frequency * k as f64 / RATE;
        let tone = 32_768.0 * STEADY.main * share * (TAU * turns).cos();
        pair[0] += (0.8 * tone).round() as i16;
        pair[1] += (0.6 * tone).round() as i16;
    }
    fs::write(directory.join("a.wav"), wav(&codes)).unwrap();
}

/// Asserts that one tone is named, with this frequency and these amplitudes on both pick-offs, and no general remedy beside it.
fn assert_tone(err: &str, frequency: f64, amplitudes: [f64; 2]) {
    let (_, tone) = err
        .split_once(": beside the wave there is a tone of ")
        .unwrap_or_else(|| panic!("{err}"));
    let mut numbers = tone
        .split([' ', '(', ','])
        .filter_map(|word| word.parse::<f64>().ok());
    let mut near = |truth: f64, off: f64| {
        let number = numbers.next().unwrap();
        assert!((number - truth).abs() <= off, "{number} for {truth}: {err}");
    };
    near(frequency, 0.2);
    // Two digits are told.
    for truth in amplitudes {
        near(truth, 0.05 * truth);
    }
    assert!(!err.contains("if there is"), "{err}");
}

#[test]
fn a_second_tone_is_named_and_the_remedy_works() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    record(here, 200_000, 0.0006, 0.01);
    let (told, rows, flagged) = identified(here, "");
    assert!(2 * flagged > rows.len(), "{flagged} of {}", rows.len());
    let frequency = STEADY.frequency + 300.0;
    let amplitudes = [0.8, 0.6].map(|share| share * 0.01 * STEADY.main);
    assert_tone(&told.err, frequency, amplitudes);
    // 3.2 beats of 1/300 s.
    let periods = (3.2 * STEADY.frequency / 300.0).ceil();
    let remedy = format!(
        ": remove its cause, or give --coloured and --periods {periods}, so that a window holds several beats with it\n"
    );
    assert!(told.err.ends_with(&remedy), "{}", told.err);
    let (told, rows, flagged) = identified(here, &format!("--coloured --periods {periods}"));
    assert_eq!((told.err.as_str(), flagged), ("", 0));
    for row in &rows {
        for (name, deviation, truth) in [
            ("main_amplitude", "main_amplitude_std", STEADY.main),
            (
                "quadrature_amplitude",
                "quadrature_amplitude_std",
                STEADY.quadrature,
            ),
            ("frequency_hz", "frequency_std_hz", STEADY.frequency),
        ] {
            let deviation = row.number(deviation);
            assert!((row.number(name) - truth).abs() < 5.0 * deviation, "{name}");
        }
    }
}

#[test]
fn a_remedy_is_named_for_a_few_long_windows_too() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    record(here, 50_000, 0.0006, 0.01);
    let (told, rows, flagged) = identified(here, "--periods 300");
    assert!((4..20).contains(&rows.len()) && flagged == rows.len());
    assert!(told.err.contains("rows are flagged: misfit "));
}

#[test]
fn scatter_between_misfits_or_below_a_step_is_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // With --coloured a third of the windows is flagged, and the others are off by several deviations.
    record(here, 200_000, 0.0006, 0.01);
    let (told, rows, flagged) = identified(here, "--coloured");
    assert!(flagged > 0 && flagged < rows.len(), "{flagged}");
    assert!(told.err.contains("rows scatter by more"), "{}", told.err);
    // A tone of little more than a step of the converter, with a residual below one.
    record(here, 200_000, 0.000_01, 0.000_07);
    let (told, _, flagged) = identified(here, "");
    assert_eq!(flagged, 0);
    for part in ["rows scatter by more", "second tone", "--periods"] {
        assert!(told.err.contains(part), "{}", told.err);
    }
    let (told, _, flagged) = identified(here, "--periods 100");
    assert_eq!((told.err.as_str(), flagged), ("", 0));
}

#[test]
fn longer_windows_distinguish_a_tone_from_the_third_harmonic_near_it() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    record_at(3.0 * STEADY.frequency + 60.0, here, 200_000, 0.0006, 0.01);
    let (told, rows, flagged) = identified(here, "");
    assert_eq!(flagged, rows.len());
    for part in [
        "rows are flagged: clipped ",
        "a larger --periods",
        "there is a tone of 16025.1 Hz (amplitude ",
        "): remove its cause, or give --periods 98, so that a window holds a beat with its third harmonic\n",
    ] {
        assert!(told.err.contains(part), "{}", told.err);
    }
    let (told, _, flagged) = identified(here, "--periods 98");
    assert_eq!((told.err.as_str(), flagged), ("", 0));
}

#[test]
fn a_tone_is_named_wherever_it_lies() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (frequency, remedy) in [
        (60.0, "--hum"),
        (700.0, "--coloured"),
        (4000.0, "--coloured --periods 13"),
        (5150.0, "--coloured --periods 100"),
        (5450.0, "--coloured --periods 133"),
        (6200.0, "--coloured --periods 20"),
    ] {
        record_at(frequency, here, 100_000, 0.0006, 0.02);
        let (told, _, _) = identified(here, "");
        assert_tone(
            &told.err,
            frequency,
            [0.8, 0.6].map(|share| share * 0.02 * STEADY.main),
        );
        let (_, given) = told.err.trim_end().split_once(", or give ").unwrap();
        let given = given.split(", ").next().unwrap().replace(" and ", " ");
        assert_eq!(given, remedy, "{}", told.err);
        let (told, _, flagged) = identified(here, remedy);
        assert_eq!(flagged, 0, "{frequency}: {}", told.err);
    }
}

#[test]
fn a_tone_is_named_in_few_samples_and_where_it_begins_late() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    record_at(6200.0, here, 3000, 0.0006, 0.02);
    let (told, _, _) = identified(here, "");
    // The spectrum of 2048 pairs has lines 49 Hz apart.
    assert!(
        told.err.contains("beside the wave there is a tone of 620"),
        "{}",
        told.err
    );
    // Nothing is told of fewer pairs than a spectrum needs.
    record_at(6200.0, here, 1000, 0.0006, 0.02);
    let (told, _, flagged) = identified(here, "");
    assert!(flagged > 3 && told.err.contains("if there is a second tone"));
    let mut codes = Wave {
        noise: 0.0006,
        ..STEADY
    }
    .codes(400_000);
    for (k, [c, _]) in codes.iter_mut().enumerate().skip(250_000) {
        *c += (200.0 * (TAU * 4000.0 * k as f64 / RATE).cos()).round() as i16;
    }
    fs::write(here.join("a.wav"), wav(&codes)).unwrap();
    let (told, _, _) = identified(here, "");
    assert!(
        told.err
            .contains("there is a tone of 4000.0 Hz (amplitude 0.0"),
        "{}",
        told.err
    );
}

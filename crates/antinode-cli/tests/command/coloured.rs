//! `antinode identify` on recordings whose noise is not white: its warnings, and the effect of `--coloured` and `--hum`.

use std::fs;
use std::path::Path;

use crate::common::{RATE, WAVE, Wave, identified, run, silence, wav};

/// A quiet wave, and noise of both pick-offs through a recursive filter: y = Σ a_i·y_i + x, plus `plain` of x.
fn record(directory: &Path, feedback: [f64; 2], plain: f64, rms: f64) {
    let quiet = Wave { noise: 0.0, ..WAVE };
    let pairs = 200_000;
    let mut past = [[0.0; 2]; 2];
    let mut squares = 0.0;
    let noise: Vec<[f64; 2]> = silence(0.05)
        .codes(pairs)
        .iter()
        .map(|pair| {
            core::array::from_fn(|i| {
                let x = f64::from(pair[i]);
                let y = feedback[0] * past[i][0] + feedback[1] * past[i][1] + x;
                past[i] = [y, past[i][0]];
                squares += (y + plain * x).powi(2);
                y + plain * x
            })
        })
        .collect();
    let scale = 32_768.0 * rms / (squares / (2 * pairs) as f64).sqrt();
    let codes: Vec<[i16; 2]> = quiet
        .codes(pairs)
        .iter()
        .zip(noise)
        .map(|(pair, noise)| {
            core::array::from_fn(|i| (f64::from(pair[i]) + scale * noise[i]).round() as i16)
        })
        .collect();
    fs::write(directory.join("a.wav"), wav(&codes)).unwrap();
}

/// A pole pair at the wave's frequency: a front end tuned to it.
fn tuned(radius: f64) -> [f64; 2] {
    let turn = std::f64::consts::TAU * WAVE.frequency / RATE;
    [2.0 * radius * turn.cos(), -radius * radius]
}

#[test]
fn noise_of_a_tuned_front_end_is_named_and_is_no_misfit_with_its_option() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    record(here, tuned(0.95), 0.0, 0.005);
    let (plain, rows, flagged) = identified(here, "--periods 50");
    assert!(rows.len() > 200 && flagged > rows.len() / 2, "{flagged}");
    assert!(
        plain.err.starts_with("warning: a.wav: ") && plain.err.contains("give --coloured"),
        "{}",
        plain.err
    );
    let (told, _, flagged) = identified(here, "--periods 50 --coloured");
    assert_eq!(flagged, 0);
    assert!(!told.err.contains("--coloured"), "{}", told.err);
}

#[test]
fn rows_that_scatter_more_than_they_state_are_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    record(here, tuned(0.95), 8.0, 0.005);
    let (plain, rows, flagged) = identified(here, "");
    assert!(rows.len() > 1000 && flagged < 10, "{flagged}");
    for part in [
        "warning: a.wav: rows scatter by more",
        "angle 1.",
        "--coloured",
    ] {
        assert!(plain.err.contains(part), "{}", plain.err);
    }
    // Overlapping rows scatter together: of every tenth row the same is reported.
    let (overlapping, ..) = identified(here, "--hop 1");
    assert!(
        overlapping.err.contains("rows scatter by more"),
        "{}",
        overlapping.err
    );
    let (told, ..) = identified(here, "--coloured");
    assert_eq!(told.err, "");
}

#[test]
fn rows_that_scatter_less_than_they_state_are_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    record(here, [0.98, 0.0], 5.0, 0.01);
    let (plain, rows, flagged) = identified(here, "");
    assert!(rows.len() > 1000 && flagged < 10, "{flagged}");
    for part in ["warning: a.wav: rows scatter by only 0.", "--hum"] {
        assert!(plain.err.contains(part), "{}", plain.err);
    }
    let (told, ..) = identified(here, "--hum");
    assert_eq!(told.err, "");
}

#[test]
fn white_noise_and_too_few_rows_raise_no_warning() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (feedback, arguments) in [
        ([0.0; 2], ""),
        ([0.0; 2], "--periods 2"),
        ([0.0; 2], "--hop 1"),
        ([0.0; 2], "--periods 50"),
        ([0.0; 2], "--coloured"),
        (tuned(0.9), "--periods 100"),
    ] {
        record(here, feedback, 5.0, 0.005);
        let (told, ..) = identified(here, arguments);
        assert_eq!(told.err, "", "{arguments}");
    }
}

#[test]
fn coloured_noise_is_simulated() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let made = run(
        here,
        "simulate -o a.wav --seconds 4 --noise 0.002 --coloured-noise 0.01 --coloured-corner 300",
    );
    assert_eq!((made.code, made.err.as_str()), (0, ""));
    let truth = fs::read_to_string(here.join("a.wav.json")).unwrap();
    for told in ["\"coloured_noise\": 0.01,", "\"coloured_corner\": 300.0,"] {
        assert!(truth.contains(told), "{truth}");
    }
    let (plain, ..) = identified(here, "");
    assert!(plain.err.contains("--hum"), "{}", plain.err);
    let (told, ..) = identified(here, "--coloured");
    assert_eq!(told.err, "");
}

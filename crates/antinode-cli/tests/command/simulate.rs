//! `antinode simulate`: its recordings and their truth, read back by `antinode identify`.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use crate::common::{Row, done, rows, run};
use serde_json::Value;

/// Runs `simulate`, which must succeed.
fn simulate(directory: &Path, arguments: &str) {
    let run = run(directory, &format!("simulate {arguments}"));
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{arguments}");
}

/// The largest error of four quantities, in stated deviations, against this truth.
fn worst(rows: &[Row], truth: &Value) -> f64 {
    let wave = |name: &str| truth["wave"][name].as_f64().unwrap();
    let mut worst = 0f64;
    for row in rows {
        let time = row.number("time_s");
        let decay = (-wave("decay_rate") * time).exp();
        let phase =
            wave("phase") - TAU * (wave("frequency") + wave("frequency_rate") * time / 2.0) * time;
        let turns = (row.number("phase_rad") - phase) / TAU;
        for (error, std) in [
            (
                row.number("main_amplitude") - wave("main_amplitude") * decay,
                "main_amplitude_std",
            ),
            (
                row.number("quadrature_amplitude") - wave("quadrature_amplitude") * decay,
                "quadrature_amplitude_std",
            ),
            (
                row.number("angle_rad") - wave("angle") - wave("angle_rate") * time,
                "angle_std_rad",
            ),
            (
                row.number("frequency_hz") - wave("frequency") - wave("frequency_rate") * time,
                "frequency_std_hz",
            ),
            ((turns - turns.round()) * TAU, "phase_std_rad"),
        ] {
            worst = worst.max(error.abs() / row.number(std));
        }
    }
    worst
}

fn truth(directory: &Path, name: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(directory.join(name)).unwrap()).unwrap()
}

#[test]
fn a_small_negative_number_is_read_however_it_is_written() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    simulate(
        here,
        "-o a.wav --seconds 0.01 --pick-off-angle -9e-05 --quadrature-amplitude -.125",
    );
    let truth = truth(here, "a.wav.json");
    assert_eq!(truth["flaws"]["pick_off_angle"], -9e-5, "{truth}");
    assert_eq!(truth["wave"]["quadrature_amplitude"], -0.125);
}

#[test]
fn the_truth_agrees_with_what_is_identified() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let options = "--seconds 0.5 --noise 0.003 --seed 7 --main-amplitude 0.7 --quadrature-amplitude -0.05 --angle 0.9 \
                   --phase -2 --frequency 4987.6 --frequency-rate 0.8 --angle-rate -0.6 --decay-rate 0.4 --offset-c 0.02";
    for (name, rate) in [("a.wav", ""), ("b.csv", ""), ("c.npy", "--rate 1e5")] {
        simulate(here, &format!("-o {name} {options}"));
        let truth = truth(here, &format!("{name}.json"));
        assert_eq!(truth["sample_rate_hz"], 100_000.0);
        assert_eq!(truth["sample_pairs"], 50_000);
        assert_eq!(truth["seed"], 7);
        assert_eq!(truth["wave"]["frequency"], 4987.6);
        assert_eq!(truth["wave"]["angle"], 0.9);
        assert_eq!(truth["flaws"]["noise"], 0.003);
        assert_eq!(truth["flaws"]["offset_c"], 0.02);
        let rows = rows(here, &format!("{name} {rate}"));
        assert!(rows.len() > 240);
        assert!(rows.iter().all(|row| row.text("flags").is_empty()));
        let worst = worst(&rows, &truth);
        assert!((2.0..5.0).contains(&worst), "{name}: {worst}");
        let offset = rows.iter().map(|row| row.number("offset_c")).sum::<f64>() / rows.len() as f64;
        assert!((offset - 0.02).abs() < 1e-4, "{offset}");
    }
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for extension in ["wav", "csv", "npy"] {
        for (name, seed) in [("a", 3), ("b", 3), ("c", 4)] {
            simulate(
                here,
                &format!(
                    "-o {name}.{extension} --seconds 0.02 --noise 0.01 --jitter-ns 20 --seed {seed}"
                ),
            );
        }
        let bytes = |name: &str| fs::read(here.join(format!("{name}.{extension}"))).unwrap();
        assert_eq!(bytes("a"), bytes("b"), "{extension}");
        assert_ne!(bytes("a"), bytes("c"), "{extension}");
    }
    // Each recording has a truth of its own.
    simulate(here, "-o a.wav --seconds 0.02 --seed 9");
    assert_eq!(truth(here, "a.wav.json")["seed"], 9);
    assert_eq!(truth(here, "a.csv.json"), truth(here, "b.npy.json"));
    assert!(!here.join("a.json").exists());
}

#[test]
fn calibration_undoes_the_flaws() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    simulate(
        here,
        "-o plain.wav --seconds 0.3 --noise 0.002 --angle-rate 1",
    );
    let ideal = truth(here, "plain.wav.json");
    for option in [
        "--gain-ratio 1.05",
        "--skew-ns 700",
        "--pick-off-angle 0.03",
        "--gain-ratio 0.9 --skew-ns -400 --pick-off-angle -0.02",
    ] {
        simulate(
            here,
            &format!("-o flawed.wav --seconds 0.3 --noise 0.002 --angle-rate 1 {option}"),
        );
        let blind = worst(&rows(here, "flawed.wav"), &ideal);
        assert!(blind > 15.0, "{option}: {blind}");
        let calibrated = worst(&rows(here, &format!("flawed.wav {option}")), &ideal);
        assert!(calibrated < 5.0, "{option}: {calibrated}");
    }
}

/// Rows whose window touches a span of time, and those well away from it.
fn split(rows: &[Row], from: f64, to: f64) -> (Vec<&Row>, Vec<&Row>) {
    let half = 0.001;
    let touches = |row: &&Row| (from - half..to + half).contains(&row.number("time_s"));
    // The wave is found again within some windows.
    let far = |row: &&Row| row.number("time_s") < from - half || row.number("time_s") > to + 0.02;
    (
        rows.iter().filter(touches).collect(),
        rows.iter().filter(far).collect(),
    )
}

#[test]
fn flaws_are_flagged_where_they_are() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let cases = [
        ("--clip-span 0.2:0.25:0.3", 0.2, 0.25, "clipped"),
        // Within a window; between two windows it is a jump of the phase.
        ("--lost 20000:7", 0.2, 0.2, "misfit"),
        ("--dropout 0.2:0.25:zero", 0.2, 0.25, "lost"),
        ("--dropout 0.2:0.25:noise", 0.2, 0.25, "lost"),
        ("--dropout 0.2:0.25:hold:d", 0.2, 0.25, "dead_channel"),
    ];
    for (option, from, to, flag) in cases {
        simulate(
            here,
            &format!("-o a.wav --seconds 0.5 --noise 0.002 {option}"),
        );
        let rows = rows(here, "a.wav");
        let (touched, far) = split(&rows, from, to);
        let flags: Vec<&str> = touched.iter().map(|row| row.text("flags")).collect();
        let names = || flags.iter().flat_map(|flags| flags.split('+'));
        assert!(names().any(|name| name == flag), "{option}: {flags:?}");
        assert!(far.len() > 200, "{option}: {}", far.len());
        for row in far {
            assert_eq!(row.text("flags"), "", "{option}: {}", row.text("time_s"));
        }
    }
    // From beginning to end: no row may be clean.
    simulate(here, "-o a.wav --seconds 0.2 --noise 0.002 --clip 0.3");
    let rows = rows(here, "a.wav");
    assert!(rows.len() > 90);
    assert!(rows.iter().all(|row| row.text("flags").contains("clipped")));
}

#[test]
fn lost_samples_make_a_recording_last_longer() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let flaws = "--seconds 0.1 --lost 1000:5000 --dropout 0.12:0.14:zero";
    simulate(here, &format!("-o a.wav {flaws}"));
    let rows = rows(here, "a.wav");
    assert!(rows.iter().any(|row| row.text("flags").contains("lost")));
}

#[test]
fn integers_that_reach_the_rail_are_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let told = done(
        here,
        "simulate -o a.wav --seconds 0.05 --main-amplitude 1.5",
    );
    assert!(
        told.err.contains("warning: ") && told.err.contains("--sample f32"),
        "{}",
        told.err
    );
    assert!(
        rows(here, "a.wav")
            .iter()
            .all(|row| row.text("flags").contains("clipped"))
    );
    simulate(
        here,
        "-o a.wav --seconds 0.05 --main-amplitude 1.5 --sample f32",
    );
    assert!(
        rows(here, "a.wav")
            .iter()
            .all(|row| row.text("flags").is_empty())
    );
}

#[test]
fn steps_of_a_converter_are_not_taken_for_a_rail_in_any_format() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // At the end the crests are a few codes high, and flat.
    let options = "--seconds 12 --noise 2e-5 --decay-rate 0.7 --main-amplitude 0.9 --quadrature-amplitude 0.01";
    simulate(here, &format!("-o a.wav {options}"));
    simulate(here, &format!("-o a.csv {options}"));
    let clean = |row: &Row| row.text("flags").is_empty();
    let codes = rows(here, "a.wav");
    assert!(codes.len() > 6000 && codes.iter().all(clean));
    let text = rows(here, "a.csv");
    assert_eq!(text.len(), codes.len());
    for (text, codes) in text.iter().zip(&codes) {
        assert_eq!(text.unnamed(), codes.unnamed());
    }
    // An option takes precedence over what the samples show.
    let given = rows(here, "a.csv --resolution 1e-9");
    assert!(given.iter().any(|row| row.text("flags") == "clipped"));
}

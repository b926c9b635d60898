//! `antinode resonator`: what it makes of rows that overlap, that end in noise, that come twice, or of which one is wild.

mod common;

use std::fs;
use std::path::Path;

use common::run;

/// Rows of a simulated ring-down, in a file.
fn rows(here: &Path, simulated: &str, identified: &str) {
    let made = run(here, &format!("simulate -o it.wav {simulated}"));
    assert_eq!(made.code, 0, "{}", made.err);
    let rows = run(here, &format!("identify --output csv {identified} it.wav"));
    assert_eq!(rows.code, 0, "{}", rows.err);
    fs::write(here.join("rows.csv"), rows.out).unwrap();
}

/// A quantity of the resonator as CSV tells it, and its deviation.
fn of_resonator(out: &str, quantity: &str) -> (f64, f64) {
    let line = out
        .lines()
        .find_map(|line| line.strip_prefix(&format!(",{quantity},")));
    let (value, std) = line.and_then(|line| line.split_once(',')).expect(out);
    (value.parse().unwrap(), std.parse().unwrap())
}

#[test]
fn the_mean_frequency_of_a_ring_down_that_ends_in_noise_is_found_to_its_deviation() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let mut all = Vec::new();
    for seed in 1..=12 {
        // 18 s: the amplitude falls to a ten-thousandth.
        let simulated =
            format!("--seconds 18 --decay-rate 0.5 --noise 0.002 --sample i24 --seed {seed}");
        rows(here, &simulated, "--periods 100");
        let found = run(here, "resonator rows.csv --output csv");
        let (frequency, std) = of_resonator(&found.out, "frequency_hz");
        assert!(std < 1e-3, "{}", found.out);
        all.push((frequency - 5332.0) / std);
        let (residual, of_residual) = of_resonator(&found.out, "residual_over_noise");
        assert!((residual - 1.0).abs() < 5.0 * of_residual, "{}", found.out);
    }
    let rms = (all.iter().map(|error| error * error).sum::<f64>() / all.len() as f64).sqrt();
    assert!((0.6..1.5).contains(&rms), "{rms}: {all:.1?}");
}

#[test]
fn rows_that_overlap_do_not_make_it_seem_better_known() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let mut deviations = Vec::new();
    for (hop, told) in [
        ("", false),
        ("--hop 5", true),
        ("--hop 50", false),
        ("--hop 120", false),
    ] {
        rows(
            here,
            "--seconds 4 --noise 0.002 --angle-rate 0.4 --decay-rate 0.1",
            &format!("--periods 50 {hop}"),
        );
        let found = run(here, "resonator rows.csv --output csv");
        assert_eq!(
            found.err.contains("overlap the one before"),
            told,
            "{hop}: {}",
            found.err
        );
        let (decay_time, std) = of_resonator(&found.out, "decay_time_s");
        assert!((decay_time - 10.0).abs() < 4.0 * std, "{}", found.out);
        deviations.push(std);
        let calibrated = run(here, "calibrate rows.csv");
        assert_eq!(calibrated.err.contains("overlap the one before"), told);
    }
    let [plain, overlapping, following, apart] = deviations[..] else {
        unreachable!()
    };
    assert!(
        (0.9..1.2).contains(&(overlapping / plain)),
        "{deviations:?}"
    );
    assert!((0.9..1.2).contains(&(following / plain)), "{deviations:?}");
    assert!(apart > 1.3 * plain, "{deviations:?}");
}

#[test]
fn a_wild_row_and_rows_given_twice_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    rows(
        here,
        "--seconds 2 --noise 0.002 --decay-rate 0.5",
        "--periods 200",
    );
    let text = fs::read_to_string(here.join("rows.csv")).unwrap();
    let mut lines: Vec<_> = text.lines().map(str::to_owned).collect();
    let mut fields: Vec<_> = lines[20].split(',').map(str::to_owned).collect();
    fields[2] += "e6";
    lines[20] = fields.join(",");
    fs::write(here.join("wild.csv"), lines.join("\n")).unwrap();
    let found = run(here, "resonator wild.csv");
    assert_eq!(found.code, 1);
    assert!(found.err.contains("far off all others"), "{}", found.err);
    let found = run(here, "resonator rows.csv rows.csv");
    assert_eq!(found.code, 1);
    assert!(
        found.err.contains("rows.csv is given twice"),
        "{}",
        found.err
    );
}

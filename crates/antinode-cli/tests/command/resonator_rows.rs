//! `antinode resonator` on rows that overlap, that are given twice or have an outlier, and on
//! recordings that are not one ring-down.

use std::fs;
use std::path::Path;

use crate::common::ring_downs::{joined, of_resonator, of_run, rows};
use crate::common::{done, rms, run, run_with};

#[test]
fn overlapping_rows_do_not_make_deviations_smaller() {
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
fn an_outlier_is_left_out_or_refused_and_rows_given_twice_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    rows(
        here,
        "--seconds 2 --noise 0.002 --decay-rate 0.5",
        "--periods 200",
    );
    let text = fs::read_to_string(here.join("rows.csv")).unwrap();
    let with_wild = |index: usize| {
        let mut lines: Vec<_> = text.lines().map(str::to_owned).collect();
        let mut fields: Vec<_> = lines[index].split(',').map(str::to_owned).collect();
        fields[2] += "e6";
        lines[index] = fields.join(",");
        run_with(
            here,
            "resonator - --output csv",
            lines.join("\n").into_bytes(),
        )
    };
    // Too near to the beginning to be taken for a step.
    let found = with_wild(5);
    assert_eq!(found.code, 1);
    assert!(
        found.err.contains("leave out outlying rows"),
        "{}",
        found.err
    );
    // Among other rows it is taken for a step, and is in no run.
    let found = with_wild(20);
    assert_eq!(found.code, 0, "{}", found.err);
    assert!(
        found.err.contains("a gain or the wave steps at 0."),
        "{}",
        found.err
    );
    for run in ["1", "2"] {
        let (value, std) = of_run(&found.out, run, "decay_time_s");
        assert!(
            (value - 2.0).abs() < 4.0 * std && std < 2e-3,
            "{}",
            found.out
        );
    }
    let found = run(here, "resonator rows.csv rows.csv");
    assert_eq!(found.code, 1);
    assert!(
        found.err.contains("rows.csv is given twice"),
        "{}",
        found.err
    );
}

/// Samples of a simulated ring-down of 3 s, as `--raw i16` takes them.
fn samples(here: &Path, simulated: &str) -> Vec<u8> {
    done(
        here,
        &format!("simulate -o it.wav --seconds 3 --noise 0.002 --decay-rate 0.1 {simulated}"),
    );
    // After the header.
    fs::read(here.join("it.wav")).unwrap().split_off(44)
}

#[test]
fn ring_downs_in_one_recording_are_runs_of_their_own() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let [first, second] =
        ["--angle 0.3", "--angle 0.4 --phase 2 --seed 2"].map(|wave| samples(here, wave));
    // With nothing between them, and with exact silence, whose rows contain `NaN`.
    for silence in [0, 400_000] {
        let recording = [first.clone(), vec![0; silence], second.clone()].concat();
        let rows = run_with(
            here,
            "identify - --raw i16 --rate 100000 --periods 50 --output csv",
            recording,
        );
        assert_eq!(rows.code, 0, "{}", rows.err);
        assert_eq!(rows.out.contains("NaN"), silence > 0);
        let found = run_with(here, "resonator - --output csv", rows.out.clone().into());
        assert!(
            found.code == 0 && !found.err.contains("warning"),
            "{}",
            found.err
        );
        for run in ["1", "2"] {
            let (value, std) = of_run(&found.out, run, "decay_time_s");
            assert!(
                (value - 10.0).abs() < 4.0 * std && std < 0.02,
                "{}",
                found.out
            );
        }
        let calibrated = run_with(here, "calibrate -", rows.out.into());
        assert!(
            calibrated.err.contains("must turn by 90° or more"),
            "{}",
            calibrated.err
        );
    }
}

#[test]
fn missing_samples_do_not_falsify_the_rates() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // A hundredth of the time, in two places: the rest would seem to turn and decay faster.
    rows(
        here,
        "--seconds 6 --noise 0.002 --decay-rate 0.1 --angle-rate 0.4 --lost 200000:3007 --lost 400000:3007",
        "--periods 50",
    );
    let found = done(here, "resonator rows.csv --output csv");
    for run in ["1", "2", "3"] {
        let (value, std) = of_run(&found.out, run, "rotation_rad_s");
        assert!(
            (value - 0.4).abs() < 4.0 * std && std < 2e-3,
            "{}",
            found.out
        );
    }
}

#[test]
fn uncalibrated_pick_offs_are_reported_long_before_rows_are_far_off() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (gain, is_told) in [("1", false), ("1.001", true)] {
        let both = ["0.4", "-0.4"].map(|rate| {
            format!(
                "--seconds 6 --noise 0.002 --decay-rate 0.1 --angle-rate {rate} --gain-ratio {gain}"
            )
        });
        let both = joined(here, both, "--periods 50");
        let found = run_with(here, "resonator - --output csv", both);
        let (residual, _) = of_resonator(&found.out, "residual_over_noise");
        assert!(residual < 2.0, "{}", found.out);
        assert_eq!(
            found.err.contains("not calibrated"),
            is_told,
            "{}",
            found.err
        );
    }
}

#[test]
fn rows_that_overlap_by_a_block_are_not_taken_for_a_change() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // Blocks of 7 or 8 samples for a period of 7.5: now and then ten of them are less than a window of ten periods.
    rows(
        here,
        "--seconds 8 --rate 40000 --noise 0.002 --decay-rate 0.1 --frequency 5340",
        "--periods 10 --hum --hop 10",
    );
    let found = done(here, "resonator rows.csv");
    assert!(!found.err.contains("warning"), "{}", found.err);
}

#[test]
fn a_pattern_that_becomes_a_circle_determines_the_resonator() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let mut all = Vec::new();
    for seed in 1..=6 {
        // Between the axes of frequency a line becomes a circle and a line again, four times.
        rows(
            here,
            &format!(
                "--seconds 8 --noise 0.002 --decay-rate 0.08 --damping-split 0.012 --damping-angle 0.5 --frequency-split 0.25 \
                 --frequency-angle -0.3 --angle 0.1 --seed {seed}"
            ),
            "--periods 100",
        );
        let found = run(here, "resonator rows.csv --output csv");
        assert_eq!((found.code, found.err.as_str()), (0, ""));
        for (quantity, truth) in [
            ("frequency_hz", 5332.0),
            ("decay_time_s", 12.5),
            ("damping_split_s", 0.012),
            ("most_damped_at_rad", 0.5),
            ("frequency_split_hz", 0.25),
            ("highest_at_rad", -0.3),
        ] {
            let (value, std) = of_resonator(&found.out, quantity);
            assert!((value - truth).abs() < 5.0 * std, "{}", found.out);
            assert!(std < 0.02 * truth.abs(), "{}", found.out);
            all.push((value - truth) / std);
        }
    }
    let rms = rms(&all);
    assert!((0.7..1.4).contains(&rms), "{rms}: {all:.1?}");
}

#[test]
fn short_runs_in_noise_are_reported_in_one_line() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (seed, turning) in [(1, "0"), (2, "0.4"), (3, "0")] {
        // 30 s: the amplitude falls to where one row in a few is lost.
        let simulated = format!(
            "--seconds 30 --decay-rate 0.3 --angle-rate {turning} --noise 0.001 --main-amplitude 0.8 --sample i24 --seed {seed}"
        );
        rows(here, &simulated, "");
        let found = run(here, "resonator rows.csv");
        let line = found.err.lines().find_map(|line| {
            let (runs, rest) = line
                .strip_prefix("not listed: ")?
                .split_once(" runs with ")?;
            let (rows, _) = rest.split_once(" rows, too short or too noisy")?;
            Some([runs, rows].map(|count| count.parse::<usize>().unwrap()))
        });
        let [runs, of_them] = line.expect(&found.err);
        assert!(runs >= 2 && of_them >= 12 * runs, "{}", found.err);
        assert!(
            found.out.contains("\nrun 1: ") && !found.out.contains("\nrun 2: "),
            "{}",
            found.out
        );
        assert!(!found.err.contains("of run "), "{}", found.err);
        assert_eq!(found.err.contains("only one way"), turning != "0");
    }
}

#[test]
fn a_recording_in_windows_of_two_lengths_is_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let wave = "--seconds 4 --noise 0.002 --decay-rate 0.1 --angle-rate 0.4";
    let rows = |simulated: &str, identified: &str| {
        rows(here, &format!("{wave} {simulated}"), identified);
        fs::read_to_string(here.join("rows.csv")).unwrap()
    };
    let is_told = |text: String| {
        let found = run_with(here, "resonator -", text.clone().into());
        assert_eq!(found.code, 0, "{}", found.err);
        let told = found
            .err
            .contains("rows of it.wav cover the same time twice");
        let calibrated = run_with(here, "calibrate -", text.into());
        assert_eq!(calibrated.err.contains("cover the same time twice"), told);
        told
    };
    let long = rows("", "--periods 100");
    assert!(!is_told(long.clone()));
    for seed in 1..=4 {
        let wave = format!("--seed {seed}");
        let [long, short] = ["--periods 100", "--periods 50"].map(|windows| rows(&wave, windows));
        assert!(is_told(long.clone() + &short) && is_told(short + &long));
        // Not for other ring-downs under the same name, at the same angle or not.
        let other = format!("--seed {seed} --phase {}", 1 + seed);
        assert!(!is_told(long.clone() + &rows(&other, "--periods 50")));
        let other = format!("--seed {seed} --angle {}", 0.1 * f64::from(seed));
        assert!(!is_told(long + &rows(&other, "--periods 50")));
    }
}

#[test]
fn times_that_were_rounded_do_not_falsify_the_frequency() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    done(
        here,
        "simulate -o ring.wav --seconds 5 --noise 0.002 --decay-rate 0.2 --frequency 5332",
    );
    done(here, "identify ring.wav --periods 100 -o rows.csv");
    let text = fs::read_to_string(here.join("rows.csv")).unwrap();
    for digits in [2, 3, 6] {
        let lines = text.lines().enumerate().map(|(at, line)| {
            let (time, rest) = line.split_once(',').unwrap();
            let time = time
                .parse::<f64>()
                .map_or(time.to_owned(), |time| format!("{time:.digits$}"));
            assert_eq!(at == 0, time == "time_s");
            format!("{time},{rest}\n")
        });
        let rounded: String = lines.collect();
        let run = run_with(here, "resonator - --output csv", rounded.into());
        let told = run
            .err
            .contains("warning: the phases of rows at their times give ");
        assert_eq!(told, digits < 4, "{digits}: {}", run.err);
        let line = run.out.lines().find(|line| line.contains("frequency_hz"));
        let numbers = line
            .unwrap()
            .split(',')
            .filter_map(|field| field.parse::<f64>().ok());
        let numbers: Vec<f64> = numbers.filter(|number| number.fract() != 0.0).collect();
        let [found, std, ..] = numbers[..] else {
            panic!("{line:?}")
        };
        assert!(
            (found - 5332.0).abs() < 4.0 * std && std < 0.05,
            "{digits}: {found} {std}"
        );
    }
}

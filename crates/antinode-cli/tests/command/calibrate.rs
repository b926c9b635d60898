//! `antinode calibrate`: the flaws of simulated pick-offs are found, and the options that it prints remove them.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use crate::common::ring_downs::damped;
use crate::common::{Row, Run, done, rms, rows, run, run_with};

const FLAWS: &str =
    "--gain-ratio 1.012 --skew-ns 130 --pick-off-angle 0.008 --noise 0.003 --decay-rate 0.05";

/// Records two patterns that turn by more than 90°, one way and the other.
fn record(here: &Path) {
    for turning in [
        "-o one.wav --angle-rate 0.7 --seed 1",
        "-o other.wav --angle-rate -0.6 --angle 1.1 --seed 2",
    ] {
        done(here, &format!("simulate {turning} --seconds 3 {FLAWS}"));
    }
}

/// Runs `calibrate` on the rows of these recordings.
fn calibrate(here: &Path, recordings: &str, options: &str) -> Run {
    let rows = run(
        here,
        &format!("identify --output csv {recordings} {options}"),
    );
    assert_eq!((rows.code, rows.err.as_str()), (0, ""));
    run_with(here, &format!("calibrate - {options}"), rows.out.into())
}

/// Records a pattern that turns at this rate, and another that turns the other way.
fn record_both_ways(here: &Path, simulated: &str, rate: f64) {
    for (name, rate) in [("one", rate), ("other", -rate)] {
        done(
            here,
            &format!("simulate -o {name}.wav --angle-rate {rate} {simulated}"),
        );
    }
}

/// Runs `calibrate` on both, identified in these windows.
fn of_windows(here: &Path, windows: &str, options: &str) -> Run {
    let rows = done(
        here,
        &format!("identify --output csv one.wav other.wav {windows} {options}"),
    );
    run_with(here, &format!("calibrate - {options}"), rows.out.into())
}

/// The numbers of the options printed, and their deviations in the report.
fn numbers(run: &Run) -> ([f64; 3], [f64; 3]) {
    assert_eq!(run.code, 0, "{}", run.err);
    let words: Vec<_> = run.out.split_whitespace().collect();
    let names = ["--gain-ratio", "--skew-ns", "--pick-off-angle"];
    assert_eq!([words[0], words[2], words[4]], names);
    let told: Vec<f64> = run
        .err
        .lines()
        .filter_map(|line| line.split_once('±')?.1.trim().parse().ok())
        .collect();
    (
        [1, 3, 5].map(|i: usize| words[i].parse().unwrap()),
        told.try_into().unwrap(),
    )
}

/// Errors of the numbers printed, in their deviations.
fn errors(run: &Run, truth: [f64; 3]) -> [f64; 3] {
    let (values, deviations) = numbers(run);
    [0, 1, 2].map(|i| (values[i] - truth[i]) / deviations[i])
}

/// Fails if a number printed is four deviations off.
fn assert_found(run: &Run, truth: [f64; 3]) {
    let errors = errors(run, truth);
    assert!(
        errors.iter().all(|error| error.abs() < 4.0),
        "{errors:.1?}: {}",
        run.err
    );
}

#[test]
fn windows_in_which_the_pattern_turns_far_give_the_same_result() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for seed in 1..=4 {
        let simulated = format!(
            "--sample f32 --seconds 4 --seed {seed} --noise 5e-4 --decay-rate 0.1 --gain-ratio 1.03 --skew-ns 800 --pick-off-angle 0.02"
        );
        record_both_ways(here, &simulated, 1.5);
        // 4° in each: the average over a window shows half a per cent less of the flaws.
        for options in ["", "--gain-ratio 0.98 --skew-ns -100"] {
            let found = of_windows(here, "--periods 250", options);
            assert_found(&found, [1.03, 800.0, 0.02]);
        }
    }
}

#[test]
fn very_unlike_gains_are_found_to_their_deviations() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (gain, amplitude) in [("3", "0.25"), ("0.33", "0.75")] {
        let mut all = Vec::new();
        for seed in 1..=6 {
            let simulated = format!(
                "--main-amplitude {amplitude} --quadrature-amplitude 0.01 --seconds 3 --seed {seed} --noise 5e-4 --decay-rate 0.1 \
                 --gain-ratio {gain} --skew-ns 800 --pick-off-angle 0.02"
            );
            record_both_ways(here, &simulated, 0.8);
            // The pattern seems to turn by 0.4° to 3.9° in each.
            let found = of_windows(here, "--periods 50", "");
            assert!(!found.err.contains("warning"), "{}", found.err);
            all.extend(errors(&found, [gain.parse().unwrap(), 800.0, 0.02]));
        }
        let rms = rms(&all);
        assert!((0.6..1.5).contains(&rms), "{gain}: {all:.1?}");
    }
}

#[test]
fn modes_of_unlike_frequency_do_not_look_like_flaws() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let mut all = Vec::new();
    // The mode of the higher frequency moves less: by 10⁻⁴ here, which would be a skew of 20 to 40 ns or a gain.
    for (seed, angle) in [(1, "0"), (2, "0.4"), (3, "0.8"), (4, "-0.4")] {
        let simulated = format!(
            "--rate 10000 --seconds 20 --frequency 500 --quadrature-amplitude 0.1 --noise 2e-4 --decay-rate 0.05 --seed {seed} \
             --frequency-split 0.1 --frequency-angle {angle}"
        );
        record_both_ways(here, &simulated, 0.7);
        let found = of_windows(here, "--periods 5", "");
        assert!(!found.err.contains("warning"), "{}", found.err);
        all.extend(errors(&found, [1.0, 0.0, 0.0]));
    }
    let rms = rms(&all);
    assert!((0.6..1.5).contains(&rms), "{all:.1?}");
}

#[test]
fn flaws_are_found_to_their_deviations_and_removed() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    record(here);
    let both = calibrate(here, "one.wav other.wav", "");
    assert_found(&both, [1.012, 130.0, 0.008]);
    let (found, deviations) = numbers(&both);
    // Three digits of the deviation, and no more.
    let digits = both.out.split_whitespace().map(|word| {
        word.split_once('.')
            .map_or(0, |(_, decimals)| decimals.len())
    });
    let digits: Vec<_> = digits.collect();
    assert_eq!([digits[1], digits[3], digits[5]], [7, 2, 7], "{}", both.out);
    let limits = [1e-4, 3.0, 5e-5];
    assert!(deviations.iter().zip(limits).all(|(std, most)| *std < most));
    assert!(!both.err.contains("warning"), "{}", both.err);

    // One file of rows for each recording gives the same result.
    for name in ["one", "other"] {
        let rows = run(here, &format!("identify --output csv {name}.wav"));
        fs::write(here.join(format!("{name}.csv")), rows.out).unwrap();
    }
    assert_eq!(run(here, "calibrate one.csv other.csv").out, both.out);

    // Rows made with a calibration lead to the same one.
    let again = calibrate(
        here,
        "one.wav other.wav",
        "--gain-ratio 0.98 --skew-ns -400 --pick-off-angle 0.02",
    );
    for ((again, found), deviation) in numbers(&again).0.iter().zip(found).zip(deviations) {
        assert!((again - found).abs() < 0.3 * deviation, "{found}, {again}");
    }

    let share = |row: &Row| row.number("quadrature_amplitude") / row.number("main_amplitude");
    let spread = |options: &str| {
        let rows = rows(here, &format!("one.wav --periods 50 {options}"));
        let [least, most] = rows
            .iter()
            .fold([f64::MAX, f64::MIN], |[least, most], row| {
                [least.min(share(row)), most.max(share(row))]
            });
        most - least
    };
    // The skew makes 4 mrad of quadrature as the pattern turns, and noise some 2 in this many windows.
    let [before, after] = ["", both.out.trim()].map(spread);
    assert!(before > 2.0 * after && after < 2.5e-3, "{before} {after}");
}

#[test]
fn a_program_reads_the_same_numbers_with_their_deviations() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    record(here);
    let rows = run(here, "identify --output csv one.wav other.wav").out;
    let [options, csv, jsonl] = ["options", "csv", "jsonl"].map(|how| {
        let arguments = format!("calibrate - --output {how}");
        run_with(here, &arguments, rows.clone().into())
    });
    assert_eq!([&csv.err, &jsonl.err], [&options.err; 2]);
    let (values, deviations) = numbers(&options);
    let mut lines = csv.out.lines();
    assert_eq!(lines.next(), Some("quantity,value,std"));
    let lines: Vec<_> = lines.collect();
    assert_eq!([lines.len(), jsonl.out.lines().count()], [3; 2]);
    // Gain and phase are known about equally well.
    let of_phase = deviations[1] * 1e-9 * TAU * 5332.0;
    assert!(
        (0.7..1.4).contains(&(of_phase / deviations[0])),
        "{}",
        csv.out
    );
    let names = ["gain_ratio", "skew_ns", "pick_off_angle_rad"];
    for (i, (line, json)) in lines.iter().zip(jsonl.out.lines()).enumerate() {
        let fields: Vec<_> = line.split(',').collect();
        let json: serde_json::Value = serde_json::from_str(json).unwrap();
        assert_eq!(
            [fields[0], json["quantity"].as_str().unwrap()],
            [names[i]; 2]
        );
        let [value, std] = [fields[1], fields[2]].map(|field| field.parse::<f64>().unwrap());
        assert_eq!(
            [json["value"].as_f64(), json["std"].as_f64()],
            [Some(value), Some(std)]
        );
        // The options and the report are rounded.
        assert!((value - values[i]).abs() <= 0.006 * std, "{line}");
        assert!((std / deviations[i] - 1.0).abs() < 0.05, "{line}");
    }
}

#[test]
fn rows_that_were_already_calibrated_are_noticed() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    record(here);
    let first = calibrate(here, "one.wav other.wav", "");
    let told = "the pick-offs look ideal: if the rows were identified with a calibration, give it";
    assert!(!first.err.contains(told), "{}", first.err);
    // The note appears whenever no calibration is given.
    let plain = "\nif the rows were identified with a calibration, give it here too: the printed options replace it\n";
    assert!(first.err.ends_with(plain), "{}", first.err);
    let arguments = format!("identify --output csv one.wav other.wav {}", first.out);
    let rows = run(here, &arguments).out;
    let forgotten = run_with(here, "calibrate -", rows.clone().into());
    assert!(forgotten.err.contains(told), "{}", forgotten.err);
    let given = run_with(here, &format!("calibrate - {}", first.out), rows.into());
    assert!(!given.err.contains("give it here too"), "{}", given.err);
    let help = run(here, "calibrate --help").out;
    let (options, pick_offs) = help.split_once("Pick-offs:").unwrap();
    assert!(options.contains("--output") && !pick_offs.contains("--output"));
}

#[test]
fn there_is_a_warning_if_the_pattern_turns_one_way_only() {
    let directory = tempfile::tempdir().unwrap();
    record(directory.path());
    let one = calibrate(directory.path(), "one.wav", "");
    numbers(&one);
    assert!(
        one.err.contains("warning: the pattern turns only one way"),
        "{}",
        one.err
    );
}

#[test]
fn there_is_a_warning_if_no_calibration_explains_the_rows() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // Amplitudes that a nonlinear amplifier changes with the angle.
    done(
        here,
        &format!("simulate -o bent.wav --angle-rate 0.7 --seconds 3 --cubic -0.1 {FLAWS}"),
    );
    let rows = run(here, "identify --output csv bent.wav");
    let bent = run_with(here, "calibrate -", rows.out.replace("clipped", "").into());
    assert!(
        ["times their noise", "converter is nonlinear", "further off"]
            .iter()
            .all(|part| bent.err.contains(part)),
        "{}{}",
        bent.err,
        bent.out
    );
}

#[test]
fn rows_that_do_not_allow_a_calibration_are_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    done(here, "simulate -o still.wav --angle-rate 0.1 --noise 0.003");
    let still = calibrate(here, "still.wav", "");
    assert_eq!((still.code, still.out.as_str()), (1, ""));
    assert!(
        still
            .err
            .contains("turns by only 5.7°, but must turn by 90°"),
        "{}",
        still.err
    );
    for (arguments, told) in [
        ("calibrate none.csv", ["error: none.csv: ", "no such file"]),
        (
            "calibrate still.wav",
            ["error: still.wav: ", "identify --output csv"],
        ),
    ] {
        let run = run(here, arguments);
        assert_eq!((run.code, run.out.as_str()), (1, ""));
        assert!(
            run.err.starts_with(told[0]) && run.err.contains(told[1]),
            "{}",
            run.err
        );
    }
}

#[test]
fn damping_that_changes_is_told_and_does_not_look_like_flaws() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    record(here);
    let rows = run(here, "identify --output csv one.wav other.wav --periods 20");
    // 1/τ rises by a fifth in 3 s.
    let drift = 0.01 / 3.0;
    for (drift, is_told) in [(0.0, false), (drift, true)] {
        let rows = damped(&rows.out, |time| 0.5 * drift * time * time);
        let found = run_with(here, "calibrate -", rows.into());
        assert_eq!(
            found.err.contains("the damping changes"),
            is_told,
            "{}",
            found.err
        );
        assert_found(&found, [1.012, 130.0, 0.008]);
    }
}

#[test]
fn rows_that_differ_alike_are_warned_of_instead_of_allowed_for() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    record(here);
    let rows = run(here, "identify --output csv one.wav other.wav --periods 20");
    // Beside 1/τ that rises, a gain of both pick-offs wanders by 1.4 deviations of a row, twice a second.
    let told = |wander: f64| {
        let by = |time: f64| 0.005 / 3.0 * time * time + wander * (TAU * 2.0 * time).sin();
        let found = run_with(here, "calibrate -", damped(&rows.out, by).into());
        assert_eq!(found.code, 0, "{}", found.err);
        [
            "consecutive rows differ from the calibrated wave",
            "this is allowed for",
        ]
        .map(|text| found.err.contains(text))
    };
    assert_eq!(told(0.0), [false, true]);
    assert_eq!(told(6e-4), [true, false]);
}

//! `antinode resonator`: quantities of simulated resonators are found to their deviations, in every format, and faults are reported.

use std::collections::HashMap;
use std::fs;

use crate::common::ring_downs::{four_seconds, identified, is_one_way, numbers, resonator};
use crate::common::{RATE, Run, WAVE, run, wav};

/// Decay time and quality factor of a decay rate of 0.08 1/s at 5332 Hz.
const TRUTH: [(&str, f64); 2] = [("decay_time_s", 12.5), ("quality_factor", 209_387.2)];

#[test]
fn a_pattern_that_turns_determines_all_quantities() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let rows = four_seconds(here, "--decay-rate 0.08 --angle-rate 0.4");
    let found = resonator(here, &rows, "--output csv");
    is_one_way(&found.err);
    let numbers = numbers(&found);
    let of = |run: &str, quantity: &str| numbers[&(run.to_owned(), quantity.to_owned())];
    for run in ["1", ""] {
        for (quantity, truth) in TRUTH {
            let (value, std) = of(run, quantity);
            let std = std.unwrap();
            assert!(
                (value - truth).abs() < 4.0 * std && std < 3e-4 * truth,
                "{}",
                found.out
            );
        }
    }
    let (rotation, std) = of("1", "rotation_rad_s");
    assert!((rotation - 0.4).abs() < 4.0 * std.unwrap() && std.unwrap() < 2e-5);
    // A resonator without splits: their sizes are not far beyond their deviations.
    for (quantity, most) in [("damping_split_s", 3e-4), ("frequency_split_hz", 5e-5)] {
        let (value, std) = of("", quantity);
        assert!(
            value < 4.0 * std.unwrap() && std.unwrap() < most,
            "{}",
            found.out
        );
    }
    let (frequency, std) = of("", "frequency_hz");
    let std = std.unwrap();
    assert!((frequency - 5332.0).abs() < 4.0 * std && std < 0.01);

    // The same as JSON lines, and as a table.
    let lines = resonator(here, &rows, "--output jsonl").out;
    assert_eq!(lines.lines().count(), numbers.len());
    for line in lines.lines() {
        let object: serde_json::Value = serde_json::from_str(line).unwrap();
        let run = object["run"]
            .as_u64()
            .map_or(String::new(), |run| run.to_string());
        let (value, std) = of(&run, object["quantity"].as_str().unwrap());
        assert_eq!(
            (object["value"].as_f64(), object["std"].as_f64()),
            (Some(value), std)
        );
    }
    let table = resonator(here, &rows, "").out;
    for part in [
        "standard input: ",
        "run 1: ",
        "turned by rotation, °/s",
        "resonator\n",
        "±",
        "deviations cover noise only, not a nonlinear pick-off or converter",
    ] {
        assert!(table.contains(part), "{table}");
    }
}

#[test]
fn the_unit_of_every_quantity_is_in_the_help() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let help = run(here, "resonator --help").out;
    let units: HashMap<_, _> = help
        .lines()
        .filter_map(|line| line.trim().split_once(' '))
        .map(|(name, unit)| (name, unit.trim()))
        .collect();
    let rows = four_seconds(
        here,
        "--decay-rate 0.08 --angle-rate 0.4 --damping-split 0.012 --frequency-split 0.004",
    );
    let found = numbers(&resonator(here, &rows, "--output csv"));
    assert_eq!(found.len(), 6 + 14, "{found:?}");
    for (_, quantity) in found.keys() {
        let unit = units.get(quantity.as_str()).expect(quantity);
        let is_time = quantity.ends_with("decay_time_s");
        assert_eq!(unit.starts_with("s "), is_time, "{quantity}: {unit}");
    }
    assert!(units["damping_split_s"].starts_with("1/s,"), "{help}");
}

#[test]
fn a_pattern_at_rest_determines_its_decay_alone_and_the_report_says_so() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(
        here.join("rest.csv"),
        four_seconds(here, "--decay-rate 0.08 --angle 0.3"),
    )
    .unwrap();
    let found = run(here, "resonator rest.csv --output csv");
    assert!(
        found
            .err
            .contains("do not determine the splits of damping and frequency")
            && found.err.contains("22.5° and 45°"),
        "{}",
        found.err
    );
    let numbers = numbers(&found);
    assert_eq!(numbers.len(), 7, "{}", found.out);
    let (value, std) = numbers[&("1".to_owned(), "decay_time_s".to_owned())];
    assert!((value - 12.5).abs() < 4.0 * std.unwrap());
}

#[test]
fn faults_of_the_rows_are_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // A wave that is driven holds its amplitude.
    let driven = four_seconds(here, "--decay-rate 0");
    let found = resonator(here, &driven, "");
    assert!(
        found.code == 0 && found.err.contains("run 1 does not decay significantly"),
        "{}",
        found.err
    );
    let grown = resonator(here, &four_seconds(here, "--decay-rate -0.05"), "");
    assert!(
        grown.code == 0 && grown.err.contains("run 1 grows: something drives it"),
        "{}",
        grown.err
    );
    // An amplitude that jumps is no decay, nor is one that bends.
    let rows = four_seconds(here, "--decay-rate 0.08");
    let lines: Vec<_> = rows.lines().collect();
    let changed = |by: &dyn Fn(f64) -> f64| {
        let change = |(index, line): (usize, &&str)| {
            let mut fields: Vec<_> = line.split(',').map(str::to_owned).collect();
            let behind_half = 2.0 * index as f64 / lines.len() as f64 - 1.0;
            if behind_half > 0.0 {
                fields[2] = (by(behind_half) * fields[2].parse::<f64>().unwrap()).to_string();
            }
            fields.join(",")
        };
        let lines: Vec<_> = lines.iter().enumerate().map(change).collect();
        resonator(here, &lines.join("\n"), "").err
    };
    let jumped = changed(&|_| 0.97);
    assert!(
        jumped.contains("a gain or the wave steps at 1.9"),
        "{jumped}"
    );
    let bent = changed(&|time| 1.0 - 0.03 * time * time);
    assert!(
        ["times their noise", "converter is nonlinear", "further off"]
            .iter()
            .all(|part| bent.contains(part)),
        "{bent}"
    );
    // It might as well turn the other way.
    let leaping = lines.iter().enumerate().map(|(index, line)| {
        let mut fields: Vec<_> = line.split(',').map(str::to_owned).collect();
        if index > 0 {
            fields[4] = (0.45 * index as f64).to_string();
        }
        fields.join(",")
    });
    let leaping: Vec<_> = leaping.collect();
    for (rows, told) in [
        (
            leaping.join("\n"),
            "the pattern turns by less than 22.5° from row to row",
        ),
        (lines[0].to_owned(), "no run of 12 clean rows"),
        ("a,b\n1,2\n".to_owned(), "no column time_s"),
    ] {
        let found = resonator(here, &rows, "");
        assert_eq!((found.code, found.out.as_str()), (1, ""));
        assert!(
            found.err.starts_with("error: standard input: ") && found.err.contains(told),
            "{}",
            found.err
        );
    }
}

#[test]
fn a_table_may_turn_unsteadily() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // It turns by 100° and back, and ripples: it differs from a steady rotation by 500 times the noise.
    for (name, way) in [("a.wav", 1.0), ("b.wav", -1.0)] {
        let codes = WAVE.codes_as(400_000, |time| {
            let angle = 0.9 * (1.6 * time).cos() + 1e-3 * (9.0 * time).sin();
            (0.4 + way * angle, WAVE.decay(time))
        });
        fs::write(here.join(name), wav(&codes)).unwrap();
    }
    let found = resonator(here, &identified(here, "a.wav b.wav"), "--output csv");
    assert!(
        found
            .err
            .starts_with("no steady rotation explains the rows: ")
            && found.err.lines().count() == 1,
        "{}",
        found.err
    );
    let numbers = numbers(&found);
    let of = |quantity: &str| numbers[&(String::new(), quantity.to_owned())];
    let (time, std) = of("decay_time_s");
    let std = std.unwrap();
    assert!(
        (time - 1.0 / WAVE.decay_rate).abs() < 4.0 * std && std < 1e-3,
        "{}",
        found.out
    );
    for (quantity, most) in [("damping_split_s", 5e-4), ("frequency_split_hz", 1e-4)] {
        let (value, std) = of(quantity);
        let std = std.unwrap();
        assert!(value < 4.0 * std && std < most, "{}", found.out);
    }
    // It turns both ways in each recording, which is all that a calibration needs.
    fs::write(here.join("rows.csv"), identified(here, "a.wav")).unwrap();
    let calibrated = run(here, "calibrate rows.csv");
    assert!(
        calibrated.code == 0 && !calibrated.err.contains("warning"),
        "{}",
        calibrated.err
    );
    let ratio = calibrated.out.split_whitespace().nth(1).unwrap();
    assert!(
        (ratio.parse::<f64>().unwrap() - 1.0).abs() < 2e-4,
        "{ratio}"
    );
    for run in ["1", "2"] {
        let (residual, _) = numbers[&(run.to_owned(), "residual_over_noise".to_owned())];
        assert!((residual - 1.0).abs() < 0.2, "{}", found.out);
    }
}

#[test]
fn rows_from_before_the_drive_ended_are_left_out() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // It rings down from 1 s on.
    for (name, way) in [("a.wav", 1.0), ("b.wav", -1.0)] {
        let codes = WAVE.codes_as((5.0 * RATE) as usize, |time| {
            (0.4 + way * 0.4 * time, WAVE.decay((time - 1.0).max(0.0)))
        });
        fs::write(here.join(name), wav(&codes)).unwrap();
    }
    let rows = identified(here, "a.wav b.wav");
    let all = resonator(here, &rows, "--output csv");
    assert!(
        all.err
            .contains("left out: 2 runs in which something drives the wave"),
        "{}",
        all.err
    );
    let decay_time = |found: &Run| numbers(found)[&(String::new(), "decay_time_s".to_owned())];
    let (time, std) = decay_time(&all);
    assert!(
        (time - 1.0 / WAVE.decay_rate).abs() < 4.0 * std.unwrap(),
        "{}",
        all.out
    );
    let found = resonator(here, &rows, "--output csv --from 1 --to 4.9");
    assert_eq!(found.err, "");
    let (time, std) = decay_time(&found);
    assert!(
        (time - 1.0 / WAVE.decay_rate).abs() < 4.0 * std.unwrap(),
        "{}",
        found.out
    );
    for line in found
        .out
        .lines()
        .filter(|line| line.starts_with(['1', '2']))
    {
        let times: Vec<f64> = line
            .rsplit(',')
            .take(2)
            .map(|text| text.parse().unwrap())
            .collect();
        assert!(
            (4.85..4.9).contains(&times[0]) && (1.0..1.02).contains(&times[1]),
            "{line}"
        );
    }

    // `calibrate` does the same, or finds the rows by itself; if none is left, that is reported.
    fs::write(here.join("rows.csv"), &rows).unwrap();
    let told = |options: &str| run(here, &format!("calibrate rows.csv {options}")).err;
    assert!(
        told("").starts_with("warning: left out: 2 runs"),
        "{}",
        told("")
    );
    assert!(
        !told("--from 1").contains("times their noise"),
        "{}",
        told("--from 1")
    );
    for command in ["resonator", "calibrate"] {
        let none = run(here, &format!("{command} rows.csv --from 7"));
        assert!(
            none.code == 1
                && none
                    .err
                    .contains("no row lies between --from and --to: the rows' times go from 0.0"),
            "{}",
            none.err
        );
        assert_eq!(
            run(here, &format!("{command} rows.csv --from 7 --to 6")).code,
            2
        );
    }
}

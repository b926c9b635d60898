//! `antinode resonator --each`: a line for each recording of a batch, with what the command finds in that recording alone.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use crate::common::ring_downs::{identified, numbers, resonator};
use crate::common::{done, run_with};

/// Records ring-downs of three gyros, of one whose pattern rests, and of one that is too short, and returns the rows of all.
fn batch(here: &Path) -> String {
    let turning = "--seconds 4 --noise 0.002 --angle-rate 0.4 --damping-split 0.012";
    for (name, wave) in [
        (
            "a.wav",
            format!("{turning} --decay-rate 0.1 --frequency 5312 --frequency-split 0.004"),
        ),
        (
            "b.wav",
            format!("{turning} --decay-rate 0.2 --frequency 5322 --frequency-split 0.006"),
        ),
        ("short.wav", "--seconds 0.05 --noise 0.002".to_owned()),
        (
            "rest.wav",
            "--seconds 4 --noise 0.002 --decay-rate 0.3 --angle 0.3".to_owned(),
        ),
    ] {
        done(here, &format!("simulate -o {name} {wave}"));
    }
    identified(here, "a.wav b.wav short.wav rest.wav")
}

/// The cells of each line by the names of their columns, by recording.
fn lines(csv: &str) -> HashMap<String, HashMap<String, String>> {
    let mut lines = csv.lines().map(|line| line.split(','));
    let names: Vec<_> = lines.next().unwrap().collect();
    lines
        .map(|cells| {
            let cells = names
                .iter()
                .map(|name| (*name).to_owned())
                .zip(cells.map(str::to_owned));
            let cells: HashMap<_, _> = cells.collect();
            (cells["file"].clone(), cells)
        })
        .collect()
}

#[test]
fn each_recording_has_the_line_of_its_own_resonator() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let rows = batch(here);
    let all = resonator_of_each(here, &rows, "--output csv");
    let lines = lines(&all.1);
    assert_eq!(lines.len(), 4, "{}", all.1);
    for name in ["a.wav", "b.wav", "rest.wav"] {
        let of_one: String = rows
            .lines()
            .filter(|row| row.starts_with("time_s") || row.ends_with(name))
            .map(|row| format!("{row}\n"))
            .collect();
        let alone = numbers(&resonator(here, &of_one, "--output csv"));
        let line = &lines[name];
        let runs = if name == "rest.wav" { "1" } else { "" };
        for (quantity, std, run) in [
            ("frequency_hz", "frequency_std_hz", ""),
            ("decay_time_s", "decay_time_std_s", runs),
            ("quality_factor", "quality_factor_std", runs),
            ("damping_split_s", "damping_split_std_s", ""),
            ("most_damped_at_rad", "most_damped_at_std_rad", ""),
            (
                "most_damped_quality_factor",
                "most_damped_quality_factor_std",
                "",
            ),
            (
                "least_damped_quality_factor",
                "least_damped_quality_factor_std",
                "",
            ),
            ("frequency_split_hz", "frequency_split_std_hz", ""),
            ("highest_at_rad", "highest_at_std_rad", ""),
        ] {
            let found = [quantity, std].map(|cell| line[cell].parse::<f64>().ok());
            let expected = alone.get(&(run.to_owned(), quantity.to_owned()));
            let same = |found: Option<f64>, expected: Option<f64>| match (found, expected) {
                (Some(found), Some(expected)) => (found / expected - 1.0).abs() < 1e-5,
                (found, expected) => found == expected,
            };
            let [value, std] = found;
            assert!(
                same(value, expected.map(|one| one.0)) && same(std, expected.and_then(|one| one.1)),
                "{name}, {quantity}: {found:?}, {expected:?}"
            );
        }
        assert_eq!(line["runs"], "1");
        assert!(line["rows"].parse::<usize>().unwrap() > 300);
        assert!((line["residual_over_noise"].parse::<f64>().unwrap() - 1.0).abs() < 0.1);
    }
    // The table shows the same, with angles in degrees.
    let table = resonator_of_each(here, &rows, "").1;
    let degrees = 1f64.to_degrees();
    for (line, name) in table.lines().skip(1).zip(["a.wav", "b.wav"]) {
        let cells: Vec<_> = line.split("  ").filter(|cell| !cell.is_empty()).collect();
        let shown = [
            ("frequency_hz", 1.0),
            ("decay_time_s", 1.0),
            ("quality_factor", 1.0),
            ("damping_split_s", 1.0),
            ("most_damped_at_rad", degrees),
            ("frequency_split_hz", 1.0),
            ("highest_at_rad", degrees),
        ];
        assert_eq!((cells[0], cells.len()), (name, shown.len() + 2), "{table}");
        for (cell, (quantity, unit)) in cells[1..].iter().zip(shown) {
            let (value, std) = cell.split_once(" ±").unwrap();
            let [value, std] = [value, std].map(|text| text.parse::<f64>().unwrap());
            let expected = lines[name][quantity].parse::<f64>().unwrap() * unit;
            assert!((value - expected).abs() < 0.1 * std, "{cell}: {expected}");
        }
    }
    // Of a pattern at rest, the note is no warning; those of a pattern that turns one way are.
    assert_eq!(
        ["a.wav", "b.wav", "rest.wav"].map(|name| lines[name]["warnings"].as_str()),
        ["1", "1", "0"]
    );
    assert!(
        all.2
            .contains("a.wav: warning: the pattern turns only one way"),
        "{}",
        all.2
    );
    assert!(
        all.2
            .contains("rest.wav: the rows do not determine the splits"),
        "{}",
        all.2
    );
}

/// Exit code, output and messages of the command for all recordings.
fn resonator_of_each(here: &Path, rows: &str, options: &str) -> (i32, String, String) {
    let run = run_with(here, &format!("resonator --each - {options}"), rows.into());
    (run.code, run.out, run.err)
}

#[test]
fn a_recording_without_a_resonator_costs_the_others_nothing() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let rows = batch(here);
    for (format, line) in [
        ("csv", "short.wav,0,0,,,,"),
        (
            "jsonl",
            "{\"file\":\"short.wav\",\"rows\":0,\"runs\":0,\"frequency_hz\":null,",
        ),
        ("table", "short.wav  –  "),
    ] {
        let (code, out, err) = resonator_of_each(here, &rows, &format!("--output {format}"));
        assert_eq!(code, 1);
        assert!(err.ends_with("error: short.wav: no run of 12 clean rows; see the rows' flags, shorten the windows, or record longer\n"), "{err}");
        let lines: Vec<_> = out.lines().collect();
        let header = usize::from(format != "jsonl");
        assert_eq!(lines.len(), 4 + header, "{out}");
        assert!(lines[2 + header].starts_with(line), "{out}");
        for (at, name) in [(0, "a.wav"), (1, "b.wav"), (3, "rest.wav")] {
            assert!(lines[at + header].contains(name), "{out}");
        }
    }
    fs::write(here.join("rows.csv"), rows.replace("short.wav", "a.wav")).unwrap();
    let found = done(here, "resonator --each rows.csv -o batch.csv");
    assert_eq!(found.out, "");
    let written = fs::read_to_string(here.join("batch.csv")).unwrap();
    assert_eq!(lines(&written).len(), 3, "{written}");
}

#[test]
fn recordings_of_one_name_in_two_files_of_rows_are_two() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (gyro, frequency) in [("g1", 5332), ("g2", 5378)] {
        fs::create_dir(here.join(gyro)).unwrap();
        let made = format!(
            "simulate -o ring.wav --seconds 2 --noise 0.002 --frequency {frequency} --decay-rate 0.2"
        );
        done(&here.join(gyro), &made);
        done(
            &here.join(gyro),
            "identify ring.wav --periods 50 -o rows.csv",
        );
    }
    let found = done(
        here,
        "resonator --each --output csv g1/rows.csv g2/rows.csv",
    );
    let lines = lines(&found.out);
    for (name, frequency) in [
        ("g1/rows.csv: ring.wav", 5332.0),
        ("g2/rows.csv: ring.wav", 5378.0),
    ] {
        let found: f64 = lines[name]["frequency_hz"].parse().unwrap();
        assert!((found - frequency).abs() < 0.01, "{name}: {found}");
    }
}

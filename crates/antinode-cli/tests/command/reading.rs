//! What a person reads: the demonstration, the table and the help.

use std::fs;

use crate::common::{WAVE, done, rows, run, run_with, wav};

/// The lines, none wider than a terminal has room for and none that ends in spaces.
fn lines(text: &str, width: usize) -> Vec<&str> {
    for line in text.lines() {
        assert_eq!(line, line.trim_end());
        assert!(line.chars().count() <= width, "{line}");
    }
    text.lines().collect()
}

#[test]
fn the_demonstration_ends_near_the_bound() {
    let directory = tempfile::tempdir().unwrap();
    let run = run(directory.path(), "");
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let lines = lines(&run.out, 100);
    assert!(lines.len() <= 30);
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 0);
    // Every estimate has its truth below, in the same places.
    let truths: Vec<usize> = (0..lines.len())
        .filter(|&i| lines[i].starts_with("    truth"))
        .collect();
    assert!(truths.len() >= 5);
    for &i in &truths {
        let number = |text: &str| text.trim().parse::<f64>().unwrap();
        let [found, truth] =
            [lines[i - 1], lines[i]].map(|line| line.chars().collect::<Vec<char>>());
        for column in 0..4 {
            let from = 10 + 19 * column;
            let cut = |line: &[char], from: usize, to: usize| {
                line[from..to.min(line.len())].iter().collect::<String>()
            };
            let (value, right) = (
                number(&cut(&found, from, from + 9)),
                number(&cut(&truth, from, from + 9)),
            );
            let std = number(
                cut(&found, from + 9, from + 18)
                    .trim()
                    .trim_start_matches('±'),
            );
            // Rounding adds to what is stated.
            assert!(
                (value - right).abs() < 4.5 * std,
                "{}\n{}",
                lines[i - 1],
                lines[i]
            );
        }
    }
    let head = lines
        .iter()
        .position(|line| line.ends_with("rms error   Cramér–Rao bound    ratio"))
        .unwrap();
    for line in &lines[head + 1..head + 5] {
        let numbers: Vec<f64> = line
            .split_whitespace()
            .rev()
            .take(3)
            .map(|word| word.parse().unwrap())
            .collect();
        assert!((0.9..1.1).contains(&numbers[0]), "{line}");
        assert!(
            (numbers[2] / numbers[1] / numbers[0] - 1.0).abs() < 0.01,
            "{line}"
        );
    }
}

/// Where a line of a table has its deviations.
fn places(line: &str) -> Vec<usize> {
    let signs = line.chars().enumerate().filter(|&(_, c)| c == '±');
    signs.map(|(i, _)| i).collect()
}

#[test]
fn a_table_is_aligned() {
    let directory = tempfile::tempdir().unwrap();
    let codes = WAVE.codes(5000);
    for name in ["a.wav", "b.wav"] {
        fs::write(directory.path().join(name), wav(&codes)).unwrap();
    }
    let one = run(directory.path(), "identify a.wav");
    let table = lines(&one.out, 120);
    assert!(table[0].trim_start().starts_with("time, s") && table[0].ends_with("flags"));
    for line in &table[1..] {
        assert_eq!(places(line), places(table[1]));
        assert_eq!(places(line).len(), 4);
    }
    // Several recordings have a table each, under their names.
    let two = run(directory.path(), "identify a.wav b.wav");
    let body = one.out.as_str();
    let title = |name| format!("{name}: WAV of 16-bit integers, 5000 sample pairs at 100000 Hz\n");
    assert_eq!(
        two.out,
        format!("{}{body}\n{}{body}", title("a.wav"), title("b.wav"))
    );
}

#[test]
fn a_table_shows_the_numbers_of_the_rows_with_angles_in_degrees() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let wave = "--noise 0.005 --angle-rate 2 --decay-rate 3";
    done(here, &format!("simulate -o a.wav --seconds 0.1 {wave}"));
    let rows = rows(here, "a.wav");
    let run = run(here, "identify a.wav");
    let table = lines(&run.out, 120);
    assert_eq!(table.len(), 1 + rows.len());
    for (line, row) in table[1..].iter().zip(&rows) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let shown = |i: usize| words[i].trim_start_matches('±').parse::<f64>().unwrap();
        let degrees = |name: &str| row.number(name).to_degrees();
        for (i, value) in [
            (0, row.number("time_s")),
            (1, row.number("main_amplitude")),
            (3, row.number("quadrature_amplitude")),
            (5, degrees("angle_rad")),
            (7, row.number("frequency_hz")),
            (9, degrees("angle_rate_rad_s")),
            (10, row.number("decay_rate_s")),
        ] {
            // To the last digit.
            let decimals = words[i].split('.').nth(1).unwrap().len() as i32;
            let unit = 10f64.powi(-decimals);
            assert!((shown(i) - value).abs() < 0.51 * unit, "{i}: {line}");
        }
        for (i, value) in [
            (2, row.number("main_amplitude_std")),
            (4, row.number("quadrature_amplitude_std")),
            (6, degrees("angle_std_rad")),
            (8, row.number("frequency_std_hz")),
            (11, row.number("residual_rms")),
        ] {
            assert!((shown(i) / value - 1.0).abs() < 0.06, "{i}: {line}");
        }
    }
}

#[test]
fn a_table_shows_small_amplitudes() {
    let directory = tempfile::tempdir().unwrap();
    // Volts at the input of a charge amplifier, say.
    let scale = 1e-9 / 32_768.0;
    let codes = WAVE.codes(5000);
    let samples = codes.as_flattened().iter();
    let bytes = samples.flat_map(|&code| (scale * f32::from(code)).to_le_bytes());
    let run = run_with(
        directory.path(),
        "identify - --raw f32 --rate 1e5",
        bytes.collect(),
    );
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let table = lines(&run.out, 120);
    assert!(table.len() > 20);
    for line in &table[1..] {
        assert_eq!(places(line), places(table[1]));
        let words: Vec<&str> = line.split_whitespace().collect();
        let number = |i: usize| words[i].trim_start_matches('±').parse::<f64>().unwrap();
        // Each pick-off's noise of 0.005 over 190 pairs.
        for (i, value) in [(1, WAVE.main), (3, WAVE.quadrature)] {
            let (value, std) = (value * 1e-9, number(i + 1));
            assert!((3e-13..8e-13).contains(&std), "{line}");
            assert!(
                (number(i) - value).abs() < 0.05 * WAVE.main * 1e-9,
                "{line}"
            );
        }
    }
}

#[test]
fn help_names_every_option_and_its_unit() {
    let directory = tempfile::tempdir().unwrap();
    let help = |arguments| {
        let run = run(directory.path(), arguments);
        assert_eq!((run.code, run.err.as_str()), (0, ""));
        run.out
    };
    assert!(help("--help").contains("Examples:"));
    let identify = help("identify --help");
    for option in [
        "--periods <N>",
        "--hop <BLOCKS>",
        "--rate <HZ>",
        "--channels <N>",
        "--gain-ratio <RATIO>",
        "--skew-ns <NS>",
        "--output <FORMAT>",
    ] {
        assert!(identify.contains(option), "{option}");
    }
    let simulate = help("simulate --help");
    for option in [
        "-o, --out <FILE>",
        "--seconds <S>",
        "--frequency-rate <HZ/S>",
        "--jitter-ns <NS>",
    ] {
        assert!(simulate.contains(option), "{option}");
    }
    assert!(help("--version").starts_with("antinode "));
}

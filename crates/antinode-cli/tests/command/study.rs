//! `antinode study`: its files, and its messages if they cannot be written.

use std::fs;
use std::path::Path;

use crate::common::run;

/// Width of a chart, pixels, and of a letter of a wide font, in units of the font's size.
const WIDTH: f64 = 740.0;
const LETTER: f64 = 0.55;

#[test]
fn captions_fit_and_a_file_that_cannot_be_written_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // The last file, written after all those with long captions.
    fs::create_dir_all(here.join("it/figure-3d.png")).unwrap();
    let made = run(here, "study --out it --runs 1");
    assert_eq!(
        (
            made.code,
            made.out.as_str(),
            made.err.replace('\\', "/").as_str()
        ),
        (
            1,
            "",
            "error: it/figure-3d.png: cannot be written: the image is not stored whole; check that its directory exists, is \
             writable and has free space\n"
        )
    );
    for name in ["figure-1b.svg", "figure-2b.svg"] {
        let svg = fs::read_to_string(here.join("it").join(name)).unwrap();
        let (before, caption) = svg.split_once("\nFigure ").unwrap();
        let (caption, _) = caption.split_once('\n').unwrap();
        let (_, size) = before.rsplit_once("font-size=\"").unwrap();
        let size: f64 = size.split('"').next().unwrap().parse().unwrap();
        let letters = "Figure ".len() + caption.chars().count();
        assert!(size * LETTER * (letters as f64) < WIDTH, "{name}: {size}");
    }
}

/// The points of a curve in a study's panel: x and value.
fn curve(here: &Path, table: &str, panel: &str, curve: &str) -> Vec<(f64, f64)> {
    let rows = fs::read_to_string(here.join(table)).unwrap();
    let fields = rows.lines().map(|row| row.split(',').collect::<Vec<_>>());
    // A title may have commas within quotation marks: the curve and all fields after it are counted from the end.
    fields
        .filter(|row| row[1] == panel && row.contains(&curve))
        .map(|row| {
            let [x, y] = [2, 1].map(|back| row[row.len() - back].parse().unwrap());
            (x, y)
        })
        .collect()
}

#[test]
fn another_wave_is_studied_without_checking_the_papers_conclusions() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let made = run(
        here,
        "study -o new/it --runs 400 --quadrature-amplitude -0.3 --angle 0.2 --phase 1 --rate 140000 --periods 10 --noise 0.5",
    );
    assert_eq!((made.code, made.err.as_str()), (0, ""));
    for told in [
        "a_B = -0.3, angle 0.2000 rad, phase 1.0000 rad",
        "5332 Hz sampled at 140000 Hz",
        "windows of 10 periods, white noise of 0 to 0.5 %",
        "conclusions are not checked",
    ] {
        assert!(made.out.contains(told), "{}", made.out);
    }
    assert!(!made.out.contains("onfirmed") && !made.out.contains("CONFIRMED"));

    // From an independent implementation, in double precision.
    for (table, panel, name, x, value) in [
        ("figure-1.csv", "a", "1: algorithm 1", 10.0, 2.151378e-2),
        ("figure-1.csv", "b", "2: algorithm 2", 10.0, 7.683052e-2),
        ("figure-1.csv", "c", "4: algorithm 4", 10.0, 1.238611e-2),
        ("figure-2.csv", "a", "3: algorithm 3", 263.0, 7.076813e-4),
    ] {
        let table = format!("new/it/{table}");
        let points = curve(here, &table, panel, name);
        let found = points.iter().find(|point| point.0 == x).unwrap().1;
        assert!((found / value - 1.0).abs() < 1e-3, "{name}: {found}");
    }
    // The files themselves state the conditions.
    for (table, made_with) in [
        ("new/it/figure-2.csv", ["1400000", "1", "", ""]),
        ("new/it/figure-3.csv", ["140000", "10", "400", "1"]),
    ] {
        let mut table = csv::Reader::from_path(here.join(table)).unwrap();
        let names = table.headers().unwrap().clone();
        let row = table.records().last().unwrap().unwrap();
        let of = |name| &row[names.iter().position(|column| column == name).unwrap()];
        let wave = [
            "main_amplitude",
            "quadrature_amplitude",
            "angle_rad",
            "phase_rad",
            "frequency_hz",
        ];
        assert_eq!(wave.map(of), ["2", "-0.3", "0.2", "1", "5332"]);
        let beside = ["sample_rate_hz", "periods", "runs", "seed"];
        assert_eq!(beside.map(of), made_with);
    }
    // 10 periods of 26.26 samples: a_A at the bound of noise of 0.5 %.
    let noise = curve(here, "new/it/figure-3.csv", "a", "exact solution");
    let (greatest, rms) = noise[20];
    assert_eq!(noise.len(), 21);
    assert!((greatest - 0.5).abs() < 1e-12);
    assert!(
        (rms / (0.5 * (2.0f64 / 263.0).sqrt()) - 1.0).abs() < 0.15,
        "{rms}"
    );
    // Labels show no rounding errors, though the noise has steps of 0.025 %.
    let svg = fs::read_to_string(here.join("new/it/figure-3b.svg")).unwrap();
    assert!(
        !svg.contains("0000000") && !svg.contains("9999999"),
        "{svg}"
    );
}

#[test]
fn an_impossible_study_is_refused_before_the_computation() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("taken"), "").unwrap();
    let run = |arguments: &str| run(directory.path(), arguments);
    let taken = run("study --out taken --runs 10000000");
    assert_eq!((taken.code, taken.out.as_str()), (1, ""));
    assert!(taken.err.contains("taken: ") && taken.err.contains("--out"));
    assert_eq!(run("study --runs 0").code, 2);
}
